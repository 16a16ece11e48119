// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Meshes of foreign formats by pulsecast-import, a program that has the libraries for them.

#include "foreign_meshes.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <sstream>
#include <system_error>

#include <pulsecast/io/detail/mesh_file/file_maker.hpp>
#include <pulsecast/io/mesh_file.hpp>

#include "import_request.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using io::detail::RawScene;

std::vector<fs::path> programs_named(const std::string& name) {
  std::error_code error;
  std::vector<fs::path> folders{fs::read_symlink("/proc/self/exe", error).parent_path()};
  Dl_info code{};  // of the Python module, or of this program
  if (dladdr(reinterpret_cast<const void*>(&programs_named), &code) != 0) {
    const fs::path object = fs::weakly_canonical(code.dli_fname, error);
    folders.push_back(object.parent_path().parent_path().parent_path());  // in a build
    for (fs::path above = object.parent_path(); above.has_relative_path(); above = above.parent_path())
      folders.push_back(above / "bin");
  }
  const char* const path = std::getenv("PATH");
  std::istringstream all(path == nullptr ? "" : path);
  for (std::string folder; std::getline(all, folder, ':');)
    if (fs::path(folder).is_absolute()) folders.emplace_back(folder);
  std::vector<fs::path> found;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / name, error)) found.push_back(folder / name);
  return found;
}

namespace {

RawScene imported(const fs::path& path, const io::MeshFileSettings& settings, bool city) {
  const std::vector<fs::path> programs = programs_named("pulsecast-import");
  if (programs.empty())
    throw FileError(path.string(), "",
                    "needs the program pulsecast-import, which is neither beside pulsecast nor in the PATH: expected "
                    "OBJ or PLY, which need none, or that program of the same version, by a build (CMake target: "
                    "pulsecast_import_program) or pulsecast's own .deb (docs/packaging)");
  const fs::path& program = programs.front();
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
