// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_MAKE_SIMULATION_HPP
#define PULSECAST_HELIOS_MAKE_SIMULATION_HPP

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/helios/detail/city_reader.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Loading of surveys. Compilation is slow, unless `pulsecast::compiled` is linked: include it in one source file of a
/// program.
namespace PULSECAST_NAMESPACE::helios {

struct BuiltParts;

/// Gives the parts of the scene in a repetition: the result of `build`, or an equal earlier one. Parts:
/// helios/scene.hpp.
using PartProvider = std::function<BuiltParts(int repetition, const std::function<BuiltParts()>& build)>;

/// Triangles of one material, in addition to the survey's own parts.
struct Simulation::Mesh {
  MeshData data{};          ///< triangles, in the world [m]
  Material material{};      ///< material of all triangles
  ObjectId object = 0;      ///< object number of its points
  Attributes attributes{};  ///< named numbers of its points; empty without
};

/// Options of a simulation.
struct Simulation::Settings {
  std::uint64_t seed = 0;        ///< seed of all random numbers
  bool echo_width = false;       ///< fit echo widths
  bool waveforms = false;        ///< keep the waveforms of echoes
  bool las_waveforms = false;    ///< cut and sample waveforms to the limits of LAS
  bool waveform_noise = false;   ///< add receiver noise
  bool fixed_incidence = false;  ///< perpendicular incidence on all surfaces, for scattering
  bool library_physics = false;  ///< true: the library's own physics, not that of HELIOS++: docs/surveys.md
  bool light_paths = false;    ///< true: multi-bounce light from smooth surfaces, also without `<light>` or `<medium>`
  bool platform_noise = true;  ///< true: as in the survey; false: none
  bool leg_noise = true;       ///< true: random leg offsets as in the survey; false: none
  std::vector<std::filesystem::path> assets{};  ///< folders; a folder `spectra` in one describes materials
  std::vector<Mesh> meshes{};                   ///< meshes in addition to the survey's own parts
  std::vector<std::string> leg_places{};        ///< places of the legs in their document, for messages; may be empty
  std::string place{};                          ///< place of the survey in its document, for messages; may be empty
  unsigned threads = 0;                         ///< threads that build the scene; 0: all
  CityReader city_models{};                     ///< reader of CityGML files; empty: they are an error
};

/// Loads the scene of a survey and plans its legs, for the first repetition. Throws a `SettingError` with leg or part
/// and attribute, or a `FileError`.
[[nodiscard]] std::unique_ptr<Simulation> make_simulation(const SurveySettings& survey,
                                                          const Simulation::Settings& settings = {},
                                                          const PartProvider& provider = {});

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_MAKE_SIMULATION)
#include <pulsecast/helios/detail/loaded_simulation.hpp>
#endif

#endif
