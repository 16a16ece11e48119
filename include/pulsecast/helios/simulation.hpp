// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SIMULATION_HPP
#define PULSECAST_HELIOS_SIMULATION_HPP

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/any_survey.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>

/// Surveys of XML documents, ready to run. `make_simulation` makes them; running them needs only this header.
namespace PULSECAST_NAMESPACE::helios {

struct CompiledSurvey;

/// Receiver settings that trade accuracy for speed, for all channels. Default: those of the survey.
struct ReceiverOverrides {
  std::optional<int> rings{};        ///< rings of subrays: `beamSampleQuality`
  std::optional<double> bin_size{};  ///< `binSize_ns` [s]
  bool ideal = false;                ///< no noise, no echo widths, no waveforms

  bool operator==(const ReceiverOverrides&) const = default;
};

/// Survey with its scene loaded and its legs planned: one of its repetitions. Immutable; other repetitions and
/// receivers give other simulations. All functions may be called by several threads at once.
class Simulation {
 public:
  struct Mesh;      ///< in make_simulation.hpp, as the next
  struct Settings;  ///< options of a simulation

  /// Size of a loaded scene.
  struct Scene {
    Vec3 min{}, max{};                                 ///< corners of the bounding box, in the world [m]
    std::size_t parts = 0, moving = 0, triangles = 0;  ///< number of parts, of moving ones among them, of triangles
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
  /// Legs and their pulses: helios/survey.hpp.
  [[nodiscard]] virtual const CompiledSurvey& compiled() const noexcept = 0;
  /// Size of the scene.
  [[nodiscard]] virtual Scene scene() const = 0;
  /// Named numbers of the objects of the scene. @throws SettingError if two parts of one object have different ones
  [[nodiscard]] virtual ObjectAttributes attributes() const = 0;
  /// Colours of points, by one more ray a point. They may outlive the simulation.
  [[nodiscard]] virtual PointColours colours() const = 0;

  /// Number of repetitions of the survey, each with its own scene.
  [[nodiscard]] virtual int repetitions() const = 0;
  /// Loads the scene of a repetition, from 0, and plans its legs, with the survey's receivers. Throws as
  /// `make_simulation`.
  [[nodiscard]] virtual std::unique_ptr<Simulation> repetition(int number) const = 0;
  /// The same scene and legs, with the survey's receivers changed. @throws SettingError for overrides out of range
  [[nodiscard]] virtual std::unique_ptr<Simulation> with_receivers(const ReceiverOverrides& overrides) const = 0;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
