// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SIMULATION_HPP
#define PULSECAST_HELIOS_SIMULATION_HPP

#include <pulsecast/any_survey.hpp>
#include <pulsecast/helios/detail/city_reader.hpp>
#include <pulsecast/io/point_columns.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Surveys of XML documents, ready to run. `make_simulation` makes them; running them needs only this header.
namespace PULSECAST_NAMESPACE {
struct Accuracy;
struct ErrorSampleOptions;
struct RunErrors;
struct SettingsChoice;
}  // namespace PULSECAST_NAMESPACE

namespace PULSECAST_NAMESPACE::helios {

struct CompiledSurvey;
struct SurveySettings;

/// Settings that trade accuracy for speed, for all channels. Default: those of the survey.
struct ReceiverOverrides {
  std::optional<int> rings{};        ///< rings of subrays: `beamSampleQuality`
  std::optional<double> bin_size{};  ///< `binSize_ns` [s]
  std::optional<int> orders{};       ///< of `<light>`: surfaces that scatter light in succession
  std::optional<int> paths{};        ///< of `<light>`: random paths of a pulse
  bool ideal = false;                ///< no noise, no echo widths, no waveforms
  bool true_ranges = false;          ///< timed by `EchoTiming::true_range`, but with multi-bounce light

  /// Settings of `Simulation::choose`, by its values: the first four.
  [[nodiscard]] static ReceiverOverrides of(std::span<const double> values) {
    return {static_cast<int>(values[0]), values[1], static_cast<int>(values[2]), static_cast<int>(values[3])};
  }
  bool operator==(const ReceiverOverrides&) const = default;
};

/// Survey with its scene loaded and its legs planned: one of its repetitions. Immutable, and safe
/// for several threads; other repetitions and receivers give other simulations.
class Simulation {
 public:
  /// Triangles of one material, in addition to the survey's own parts.
  struct Mesh {
    MeshData data{};          ///< triangles, in the world [m]
    Material material{};      ///< material of all triangles
    ObjectId object = 0;      ///< object number of its points
    Attributes attributes{};  ///< named numbers of its points; empty without
  };

  /// Options of loading.
  struct Settings {
    std::uint64_t seed = 0;                       ///< seed of all random numbers
    bool echo_width = false;                      ///< fit echo widths
    bool waveforms = false;                       ///< keep the waveforms of echoes
    bool las_waveforms = false;                   ///< cut and sample waveforms to the limits of LAS
    bool waveform_noise = false;                  ///< add receiver noise
    bool fixed_incidence = false;                 ///< perpendicular incidence, for scattering
    bool uncertainty = false;                     ///< `points` have the uncertainty of echoes
    bool library_physics = false;                 ///< not that of HELIOS++: docs/program.md
    bool light_paths = false;                     ///< multi-bounce light, also without `<light>`
    bool platform_noise = true;                   ///< as in the survey; false: none
    bool leg_noise = true;                        ///< random leg offsets as in the survey; false: none
    std::vector<std::filesystem::path> assets{};  ///< their folders `spectra` describe materials
    std::vector<Mesh> meshes{};                   ///< meshes in addition to the survey's own parts
    std::vector<std::string> leg_places{};        ///< places of the legs in their document, for messages
    std::string place{};                          ///< place of the survey in its document, for messages
    unsigned threads = 0;                         ///< threads that build the scene; 0: all
    CityReader city_models{};                     ///< empty: CityGML files are an error
    io::MapProjector projector{};                 ///< of trajectories by longitude and latitude
  };

  /// Size of a loaded scene.
  struct Scene {
    Vec3 min{}, max{};                                 ///< corners of its bounding box, in the world [m]
    std::size_t parts = 0, moving = 0, triangles = 0;  ///< numbers; `moving` of the parts move
    std::size_t memory = 0;                            ///< memory held; shared data counts once [byte]
    bool empty = true;                                 ///< true: no bounding box
  };

  Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  virtual ~Simulation() = default;

  /// Pulses and echoes, for `run`. Copies share the scene, and may outlive the simulation.
  [[nodiscard]] virtual const AnySurvey& survey() const noexcept = 0;
  /// Warnings of the scene, legs and receivers, each once.
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const noexcept = 0;
  [[nodiscard]] virtual const SurveySettings& document() const noexcept = 0;  ///< settings it was loaded from
  [[nodiscard]] virtual const Settings& settings() const noexcept = 0;        ///< options of loading
  /// Legs and their pulses: helios/survey.hpp.
  [[nodiscard]] virtual const CompiledSurvey& compiled() const noexcept = 0;
  [[nodiscard]] virtual Scene scene() const = 0;  ///< size of the scene
  /// Surfaces, colours and attributes of points, as `io::points_of`, and their uncertainty, if it was asked for; may
  /// outlive the simulation.
  /// @throws SettingError if two parts of one object have different attributes of a name
  [[nodiscard]] virtual io::PointSettings points() const = 0;

  /// Number of repetitions of the survey, each with its own scene.
  [[nodiscard]] virtual int repetitions() const = 0;
  /// Loads a repetition, from 0, with the survey's receivers. Throws as `make_simulation`.
  [[nodiscard]] virtual std::unique_ptr<Simulation> repetition(int number) const = 0;
  /// The same scene and legs with other receivers. @throws SettingError for overrides out of range
  [[nodiscard]] virtual std::unique_ptr<Simulation> with_receivers(const ReceiverOverrides& overrides) const = 0;
  /// Errors of a run by sampling, estimator, instrument, and together, against at least 2,030 subrays, true ranges and
  /// 128 bins a pulse: run_errors.hpp. `ErrorSampleOptions::reach` becomes half the length of the shortest pulse. May
  /// be called while a run goes on. @throws SettingError for options out of range
  [[nodiscard]] virtual RunErrors errors(const ErrorSampleOptions& options) const = 0;
  /// Cheapest settings that reach an accuracy, of `ReceiverOverrides::of` its values, without the errors of the
  /// instrument itself: accuracy.hpp. The reference has at least 2,030 subrays, 128 bins a pulse, the survey's timing.
  /// @throws SettingError for an accuracy or options out of range
  [[nodiscard]] virtual SettingsChoice choose(const Accuracy& accuracy, const ErrorSampleOptions& options) const = 0;
  /// Settings of a reference. @param true_ranges as in `ReceiverOverrides`
  [[nodiscard]] virtual ReceiverOverrides reference(bool true_ranges = false) const = 0;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
