// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP
#define PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/mtl.hpp>

namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Files in the settings of scenes.
class SceneFiles {
 public:
  void add(const PartSource& source) {
    for (const std::filesystem::path& file : std::visit([](const auto& s) { return s.files; }, source)) {
      add(file);
      if (std::holds_alternative<ObjSource>(source) || text::lower(file.extension().string()) == ".obj")
        objs.insert(file);
    }
    if (const auto* const raster = std::get_if<GeoTiffSource>(&source)) {
      add_material(raster->material.file);
      add(raster->classes);
    } else if (const auto* const cloud = std::get_if<XyzSource>(&source)) {
      add_material(cloud->material.file);
    } else if (const auto* const voxels = std::get_if<VoxelSource>(&source)) {
      add_material(voxels->material.file);
      add(voxels->leaf_angles);
    } else if (const auto* const mesh = std::get_if<MeshSource>(&source)) {
      add_material(mesh->materials);
    }
  }

  std::set<std::filesystem::path> all{}, objs{}, mtls{};  ///< OBJ and MTL files are among them

 private:
  void add(const std::filesystem::path& file) {
    if (!file.empty()) all.insert(file);
  }
  void add_material(const std::filesystem::path& file) {
    add(file);
    if (!file.empty()) mtls.insert(file);
  }
};

[[nodiscard]] inline SceneFiles files_of(const SceneSettings& scene) {
  SceneFiles files;
  for (const PartSettings& part : scene.parts) {
    files.add(part.source);
    for (const SwapSettings& swap : part.swaps)
      if (swap.source) files.add(*swap.source);
  }
  return files;
}

/// Adds the files of names separated by blanks, and of the whole as one name with blanks.
inline void add_named(std::set<std::filesystem::path>& files, const std::filesystem::path& folder, std::string names) {
  constexpr const char* blanks = " \t\r\n";
  std::replace(names.begin(), names.end(), '\\', '/');
  const std::size_t first = names.find_first_not_of(blanks);
  if (first == names.npos) return;
  files.insert(folder / names.substr(first, names.find_last_not_of(blanks) + 1 - first));
  for (std::size_t word = first; word != names.npos;) {
    const std::size_t end = std::min(names.find_first_of(blanks, word), names.size());
    files.insert(folder / names.substr(word, end - word));
    word = names.find_first_not_of(blanks, end);
  }
}

/// Adds the files that `mtllib` in an OBJ file may name.
inline void add_libraries(std::set<std::filesystem::path>& files, const std::filesystem::path& obj) {
  try {
    const io::MappedFile file(obj);
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()),
        keyword = "mtllib";
    for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at)) {
      at += keyword.size();
      std::size_t end = std::min(text.find('\n', at), text.size());
      while (end < text.size() && text.substr(at, end - at).find_last_of('\\') != text.npos &&
             text.substr(at, end - at).find_last_not_of(" \t\r") == text.substr(at, end - at).find_last_of('\\'))
        end = std::min(text.find('\n', end + 1), text.size());  // continued line
      add_named(files, obj.parent_path(), std::string(text.substr(at, end - at)));
    }
  } catch (const FileError&) {  // unreadable
  }
}

/// True if an MTL file that is there has a ground material, or cannot be read.
inline bool declares_ground(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    const auto materials = io::read_mtl(file).materials;
    return std::any_of(materials.begin(), materials.end(), [](const auto& named) { return named.second.ground; });
  } catch (const FileError&) {
    return true;
  }
}

}  // namespace detail

/// Files in the settings of a scene, in all runs, existing or not. `SceneBuilder::files` returns those that these files
/// name.
[[nodiscard]] inline std::set<std::filesystem::path> scene_files(const SceneSettings& scene) {
  return detail::files_of(scene).all;
}

/// Folders of spectra, there or not: `spectra` in each folder of assets.
[[nodiscard]] inline std::vector<std::filesystem::path> spectra_folders(
    const std::vector<std::filesystem::path>& assets) {
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& folder : assets) folders.push_back(folder / "spectra");
  return folders;
}

/// True if an MTL file declares a ground material, in any run, or cannot be read. A scene without one has no height for
/// `onGround`.
[[nodiscard]] inline bool has_ground(const SceneSettings& scene) {
  detail::SceneFiles files = detail::files_of(scene);
  for (const std::filesystem::path& obj : files.objs) detail::add_libraries(files.mtls, obj);
  return std::any_of(files.mtls.begin(), files.mtls.end(), detail::declares_ground);
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
