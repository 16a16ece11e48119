// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "doctor.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include <pulsecast/base/namespace.hpp>
#include <pulsecast/version.hpp>

#include "foreign_meshes.hpp"
#include "parts.hpp"
#include "point_formats.hpp"
#include "survey_files.hpp"

namespace fs = std::filesystem;

namespace {

#define QUOTED_WORD(word) #word
#define QUOTED(macro) QUOTED_WORD(macro)

std::ostream& line(const char* name) { return std::cout << std::left << std::setw(13) << name; }

/// x86-64 level of this processor; 0: it is another one. Source: x86-64 psABI 1.0, table 3.1.
int processor_level() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("ssse3") || !__builtin_cpu_supports("popcnt"))
    return 1;
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2") || !__builtin_cpu_supports("fma")) return 2;
  const bool has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                       __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return has_512 ? 4 : 3;
#else
  return 0;
#endif
}

/// Problem of a part that is loaded on demand; empty if there is none.
template <class Part>
std::string problem_of() {
  try {
    (void)part<Part>();
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void print_formats() {
  std::string here, missing;
  for (const PointFormat& format : point_formats) {
    std::string problem(format.missing);
    if (problem.empty() && format.name == "npz") problem = problem_of<ArraysPart>();
    if (problem.empty())
      here.append(here.empty() ? "" : ", ").append(format.name);
    else
      missing.append("; missing: ").append(format.name).append(", which needs ").append(problem);
  }
  line("formats") << here << missing << '\n';
}

/// First line that a program prints when asked for its version.
std::string version_of(const fs::path& program) {
  std::string quoted;
  for (const char letter : program.string()) quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  char text[200]{};
  if (std::FILE* const out = popen(("'" + quoted + "' --version 2> /dev/null").c_str(), "r")) {
    if (std::fgets(text, sizeof text, out) == nullptr) text[0] = '\0';
    pclose(out);
  }
  std::string first(text);
  std::erase(first, '\n');
  return first;
}

void print_importer() {
  line("meshes") << "OBJ and PLY";
  const std::vector<fs::path> programs = programs_named("pulsecast-import");
  if (programs.empty()) {
    std::cout << "; missing: glTF, GLB, STL, DAE, FBX and CityGML, which pulsecast-import reads; it is neither beside "
                 "this program nor in the PATH: convert to OBJ or PLY, or take that of a build or of pulsecast's own "
                 ".deb (docs/packaging)\n";
    return;
  }
  const std::string version = version_of(programs.front());
  const bool same = version == "pulsecast-import " PULSECAST_VERSION;
  std::cout << (same ? "; glTF, GLB, STL, DAE, FBX and others by "
                     : "; missing: glTF, GLB, STL, DAE, FBX and CityGML, as this program is ")
            << programs.front().string();
  if (!same)
    std::cout << (version.empty() ? std::string("that does not start") : " of another version, " + version)
              << ": expected pulsecast-import " PULSECAST_VERSION
                 " and its libraries, of a build or of pulsecast's own .deb";
  std::cout << '\n';
}

void print_reference_systems() {
#if defined(PULSECAST_REFERENCE)
  const std::string problem = problem_of<ReferencePart>();
  constexpr const char* package = "libproj25";
#else
  const std::string problem = "this program was built without it";
  constexpr const char* package = "libproj-dev, to build with; pulsecast";
#endif
  line("PROJ") << (problem.empty() ? "reference systems by any EPSG code or text, and --project"
                                   : "missing: --project and reference systems beyond UTM (Debian package: " +
                                         std::string(package) + "): " + problem)
               << '\n';
}

void print_processes() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).replace_filename("pulsecast-mpi");
  line("MPI") << (fs::exists(program, error)
                      ? "mpirun starts " + program.string()
                      : "missing: surveys by mpirun, as there is no " + program.string() +
                            " (build with the Debian package libopenmpi-dev); one process uses all threads")
              << '\n';
}

std::size_t files_in(const fs::path& folder, const char* extension) {
  std::error_code error;
  std::size_t number = 0;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    number += i->path().extension() == extension;
  return number;
}

void print_catalogues(const Options& options) {
  bool any = false;
  for (const fs::path& folder : options.assets) {
    std::size_t scanners = 0, platforms = 0;
    for (const CatalogueDocument& document : read_catalogue(options, {folder})) {
      scanners += document.assets.scanners.size();
      platforms += document.assets.platforms.size();
    }
    const std::size_t sensors = files_in(folder / "data/sensors", ".yaml"),
                      spectra = files_in(folder / "spectra", ".txt");
    if (scanners + platforms + sensors + spectra == 0) continue;
    any = true;
    line("catalogue") << folder.string() << ": " << scanners << " scanners, " << platforms << " platforms, " << sensors
                      << " data sheets of sensors, " << spectra << " spectra\n";
  }
  if (!any)
    line("catalogue") << "missing: documents name their own scanners and platforms, or --assets a folder of some "
                         "(pulsecast's own .deb and wheel bring them)\n";
}

}  // namespace

void print_abilities(const Options& options) {
  line("version") << PULSECAST_VERSION << '\n';
  line("processor");
  if (const int level = processor_level(); level > 0) std::cout << "x86-64 level " << level << "; ";
  std::cout << "instructions in use: " QUOTED(PULSECAST_INSTRUCTIONS) "\n";
  line("threads") << std::max(1U, std::thread::hardware_concurrency()) << '\n';
  print_formats();
  print_importer();
  print_reference_systems();
  const std::string live = problem_of<LivePart>();
  line("live page") << (live.empty() ? "--live" : "missing: --live: " + live) << '\n';
  print_processes();
  print_catalogues(options);
  const char* const python = std::getenv("PULSECAST_PYTHON");  // by `python3 -m pulsecast doctor`
  if (python != nullptr) line("Python") << python << '\n';
}
