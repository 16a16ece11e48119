// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "reference_systems.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/ascii_grid.hpp>
#include <pulsecast/io/geotiff.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/png_heights.hpp>
#if defined(PULSECAST_REFERENCE)
#include "parts.hpp"
#else
#include <pulsecast/io/detail/las/reference.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>
#endif

#include "point_formats.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

#if defined(PULSECAST_REFERENCE)
/// Lets readers ask PROJ, as `io/reference.hpp` does.
const bool is_database_set =
    (io::detail::reference_database = [](const io::SpatialReference& codes, const std::string& name) {
      return part<ReferencePart>().complete(codes, name);
    }) != nullptr;
#endif

/// Text of a file on one line.
std::string text_of(const std::filesystem::path& path) {
  const io::MappedFile file(path, "the text (WKT) of a reference system");
  constexpr std::size_t most = 65'534;  // source: LAS 1.4 R15, size of a variable-length record
  if (file.text().size() > most) io::detail::fail(path, "has ", file.text().size(), " bytes: expected at most ", most);
  std::string text(text::trimmed(text::without_byte_order_mark(file.text())));
  std::erase_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\0'; });
  if (text.empty()) io::detail::fail(path, "is blank: expected the text (WKT) of a reference system");
  return text;
}

io::SpatialReference reference_of_rasters(const helios::SceneSettings& scene) {
  std::optional<io::SpatialReference> shared;
  for (const helios::PartSettings& part : scene.parts) {
    const auto* const rasters = std::get_if<helios::GeoTiffSource>(&part.source);
    if (rasters == nullptr || part.transform != helios::TransformSettings{}) continue;
    for (const fs::path& path : rasters->files) {
      const bool names_one = !io::is_ascii_grid(path) && !io::is_png(path);
      const io::SpatialReference one = names_one ? io::read_geotiff_reference(path) : io::SpatialReference{};
      if (shared.value_or(one) != one) return {};
      shared = one;
    }
  }
  const auto is_code = [](std::uint16_t code) { return code >= 1024 && code <= 32766; };  // source: OGC GeoTIFF 1.1
  if (!shared || !is_code(shared->epsg)) return {};
  if (!is_code(shared->vertical_epsg)) shared->vertical_epsg = 0;
  return *shared;
}

}  // namespace

io::SpatialReference reference_system_of(const Options& options, const helios::SceneSettings& scene, Notes& notes) {
  if (!options.geojson && point_format(options.format).kind != PointKind::las) return {};
  io::SpatialReference found = options.reference.value_or(io::SpatialReference{});
  const bool is_given = options.reference || !options.wkt.empty();
  if (!is_given) found = reference_of_rasters(scene);
  if (found == io::SpatialReference{} && options.wkt.empty()) return found;
  try {
    found = completed(found, options.wkt, notes);
  } catch (const std::runtime_error& error) {  // a FileError, or of a part without its library
    if (is_given) throw;
    notes.warn("the scene's rasters: " + std::string(error.what()) + "; results name no reference system");
    return {};
  }
  if (found.unit != 1 && found.vertical_epsg == 0 && found.vertical_unit == 1)
    notes.note("x and y in LAS are in units of " + text::to_text(found.unit) +
               " m, and heights in metres, as the reference system has none of heights: --epsg CODE+CODE names both");
  return found;
}

#if defined(PULSECAST_REFERENCE)
io::SpatialReference completed(const io::SpatialReference& given, const std::filesystem::path& wkt, Notes& /*notes*/) {
  io::SpatialReference all = given;
  if (!wkt.empty()) all.wkt = text_of(wkt);
  return part<ReferencePart>().complete(all, wkt.string());
}

io::MapProjector projector_of(const Options& options) {
  if (options.project_to == 0) return {};
  return part<ReferencePart>().projector(options.project_from, options.project_to);
}
#else
io::SpatialReference completed(const io::SpatialReference& given, const std::filesystem::path& wkt, Notes& notes) {
  io::SpatialReference all = given;
  if (!wkt.empty()) {
    std::vector<std::string> warnings;
    all = io::detail::ReferenceReader(wkt, io::detail::HeightUnit::metre, warnings).by_text(text_of(wkt));
    notes.warn(warnings);
  } else if (io::detail::las_utm(all.epsg).empty() || all.vertical_epsg != 0) {
    notes.warn("built without PROJ (Debian package: libproj-dev): LAS 1.4 does not name EPSG:" +
               std::to_string(all.epsg) + (all.vertical_epsg == 0 ? "" : "+" + std::to_string(all.vertical_epsg)) +
               ", and metres are assumed; --wkt FILE names it");
  }
  return all;
}

io::MapProjector projector_of(const Options& options) {
  if (options.project_to == 0) return {};
  throw FileError("--project", "", "needs PROJ, which this program was built without (Debian package: libproj-dev)");
}
#endif
