// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Meshes of foreign formats by pulsecast-import, beside this program: it has the libraries for them.

#include "foreign_meshes.hpp"

#include <filesystem>
#include <system_error>

#include <pulsecast/io/detail/mesh_file/file_maker.hpp>
#include <pulsecast/io/mesh_file.hpp>

#include "import_request.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using io::detail::RawScene;

namespace {

RawScene imported(const fs::path& path, const io::MeshFileSettings& settings, bool city) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).replace_filename("pulsecast-import");
  if (!fs::exists(program, error))
    throw FileError(path.string(), "",
                    "needs the program " + program.string() +
                        ", which does not exist: expected it beside pulsecast, from the same build (CMake target: "
                        "pulsecast_import_program; Debian package: pulsecast)");
  const ImportRequest request{.path = path.string(),
                              .city = city,
                              .materials = settings.materials.string(),
                              .up = settings.up,
                              .unit = settings.unit,
                              .texture = settings.texture,
                              .files_elsewhere = settings.files_elsewhere,
                              .memory_per_byte = settings.limits.memory_per_byte};
  return io::detail::ChildProcess::result_of<RawScene>(program, path.string(),
                                                       io::detail::child_limits(path, settings.limits), request);
}

}  // namespace

RawScene io::detail::foreign_scene(const fs::path& path, const MeshFileSettings& settings) {
  return imported(path, settings, false);
}

helios::CityReader city_models() {
  return [](const fs::path& path, const io::MeshFileSettings& settings, unsigned threads) {
    return io::reading(path, [&] {
      const RawScene scene = imported(path, settings, true);
      const io::MeshFileSettings plain{.materials = settings.materials, .spectra = settings.spectra};
      io::MeshFile file = io::detail::MeshFileMaker(path, scene, plain, threads).make();
      io::detail::replace_materials(file, plain);
      return file;
    });
  };
}
