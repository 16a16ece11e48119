// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The program that pulsecast starts for meshes of foreign formats, so that itself it loads no library of theirs.

#include <cstdint>
#include <iostream>
#include <optional>
#include <string_view>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/mesh_file.hpp>
#if defined(PULSECAST_CITYGML)
#include <pulsecast/io/citygml.hpp>
#endif
#include <pulsecast/version.hpp>

#include "entry.hpp"
#include "import_request.hpp"

using namespace pulsecast;
using io::detail::ChildProcess;
using io::detail::RawScene;

namespace {

RawScene scene_of(const ImportRequest& request) {
  const std::filesystem::path path = request.path;
  if (request.version != PULSECAST_VERSION)
    throw FileError(request.path, "",
                    "is asked for by version " + request.version +
                        " of pulsecast: expected " PULSECAST_VERSION ", that of this pulsecast-import");
#if defined(PULSECAST_CITYGML)
  const io::CityGmlSettings of_city;
  if (request.city) return io::detail::CityGmlImport(path, of_city).read();
#endif
  if (request.city)
    throw FileError(request.path, "",
                    "is a CityGML file, and pulsecast-import was built without libcitygml (Debian package: "
                    "libcitygml-dev)");
  const io::MeshFileSettings settings{.up = request.up,
                                      .unit = request.unit,
                                      .materials = request.materials,
                                      .texture = request.texture,
                                      .files_elsewhere = request.files_elsewhere};
  const auto opened = [&](std::uint64_t bytes) {
    ChildProcess::allow(request.memory_per_byte * static_cast<double>(bytes));
  };
  return io::detail::MeshImport(path, settings, opened).read();
}

}  // namespace

int pulsecast_main(int argc, char** argv) {
  constexpr int bad_usage = 2;
  const std::string_view argument = argc == 2 ? argv[1] : "";
  if (argument == "--version") {
    std::cout << "pulsecast-import " PULSECAST_VERSION "\n";
    return 0;
  }
  if (const auto file = text::number_in<int>(argument))
    ChildProcess::serve<ImportRequest>(*file, scene_of);
  else
    std::cerr << "pulsecast-import reads mesh files for pulsecast, which starts it: expected --version\n";
  return bad_usage;
}
