// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SIMULATION_HPP
#define PULSECAST_HELIOS_SIMULATION_HPP

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/helios/detail/city_reader.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/point_columns.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Surveys of XML documents, ready to run. `make_simulation` makes them; running them needs only this header.
namespace PULSECAST_NAMESPACE::helios {

/// Receiver settings that trade accuracy for speed, for all channels. Default: those of the survey.
struct ReceiverOverrides {
  std::optional<int> rings{};        ///< rings of subrays: `beamSampleQuality`
  std::optional<double> bin_size{};  ///< `binSize_ns` [s]
  bool ideal = false;                ///< no noise, no echo widths, no waveforms

  bool operator==(const ReceiverOverrides&) const = default;
};

/// Consecutive slots of a sample. Slots before `from` are simulated to warm the caches, but do not count.
struct SampleBlock {
  PulseIndex first = 0, from = 0, end = 0;  ///< first slot, first that counts, one past the last
  bool empty_shots = true;  ///< false: shots without echoes are counted, not kept, as in a run whose sinks read none
};

/// Results of the counted slots of a block.
struct Sample : ResultBuffer {
  double seconds = 0;          ///< processor time [s]
  double sample_interval = 0;  ///< sample spacing of the waveforms [s]

  /// Results as a batch, valid until they change.
  [[nodiscard]] EchoBatch batch() const { return ResultBuffer::batch(sample_interval); }
};

/// Result of a single slot.
struct SlotCount {
  Fate fate = Fate::blocked;  ///< fate of the slot
  std::uint8_t echoes = 0;    ///< number of its echoes
};

/// Survey with its scene loaded and its legs planned. `run`, `sample` and `count` may be called by several threads at
/// once.
class Simulation {
 public:
  /// Triangles of one material, in addition to the survey's own parts.
  struct Mesh {
    MeshData data{};          ///< triangles, in the world [m]
    Material material{};      ///< material of all triangles
    ObjectId object = 0;      ///< object number of its points
    Attributes attributes{};  ///< named numbers of its points; empty without
  };

  /// Options of a simulation.
  struct Settings {
    std::uint64_t seed = 0;        ///< seed of all random numbers
    bool echo_width = false;       ///< fit echo widths
    bool waveforms = false;        ///< keep the waveforms of echoes
    bool las_waveforms = false;    ///< cut and sample waveforms to the limits of LAS
    bool waveform_noise = false;   ///< add receiver noise
    bool fixed_incidence = false;  ///< perpendicular incidence on all surfaces, for scattering
    bool library_physics = false;  ///< true: the library's own physics, not that of HELIOS++: docs/surveys.md
    bool light_paths = false;  ///< true: multi-bounce light from smooth surfaces, also without `<light>` or `<medium>`
    bool platform_noise = true;                   ///< true: as in the survey; false: none
    bool leg_noise = true;                        ///< true: random leg offsets as in the survey; false: none
    std::vector<std::filesystem::path> assets{};  ///< folders; a folder `spectra` in one describes materials
    std::vector<Mesh> meshes{};                   ///< meshes in addition to the survey's own parts
    std::vector<std::string> leg_places{};        ///< places of the legs in their document, for messages; may be empty
    std::string place{};                          ///< place of the survey in its document, for messages; may be empty
    unsigned threads = 0;                         ///< threads that build the scene; 0: all
    CityReader city_models{};                     ///< reader of CityGML files; empty: they are an error
  };

  /// Sink of a run: any `EchoSink`. One that is passed by reference must outlive the run.
  class Sink {
   public:
    /// Hands on what the sink says about empty shots, if it `ChoosesShots`.
    template <EchoSink Any>
    requires(!std::same_as<std::remove_cvref_t<Any>, Sink>)
        Sink(Any&& sink)  // NOLINT(google-explicit-constructor): implicit by purpose
        : empty_shots_(pulsecast::detail::reads_empty_shots(sink)), take_(held(std::forward<Any>(sink))) {}

    void operator()(const EchoBatch& batch) const { take_(batch); }
    /// As the concept ChoosesShots describes.
    [[nodiscard]] bool reads_empty_shots() const noexcept { return empty_shots_; }

   private:
    template <class Any>
    static decltype(auto) held(Any&& sink) {
      if constexpr (std::is_lvalue_reference_v<Any>)
        return std::ref(sink);
      else
        return std::move(sink);
    }

    bool empty_shots_;
    std::function<void(const EchoBatch&)> take_;
  };

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

  /// Number of repetitions of the survey, each with its own scene.
  [[nodiscard]] virtual int runs() const = 0;
  /// Loads the scene of a repetition, from 0, and plans its legs. Throws as `make_simulation`.
  virtual void begin(int run) = 0;

  /// Legs of the current repetition, and their pulses.
  [[nodiscard]] virtual const CompiledSurvey& compiled() const = 0;
  /// Size of the current scene.
  [[nodiscard]] virtual Scene scene() const = 0;
  /// Surfaces, colours and attributes of points of the current scene, as `io::points_of`; valid until `begin`.
  /// @throws SettingError if two parts of one object have different attributes of a name
  [[nodiscard]] virtual io::PointSettings points() const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& warnings()
      const = 0;  ///< warnings of scene, legs and receivers, each once

  /// Simulates the pulses as `pulsecast::run` does. The sink gets the echoes in the order of their pulses.
  virtual RunSummary run(const RunOptions& options, const Sink& sink) const = 0;

  /// Replaces the receivers. Scene and legs remain.
  virtual void receive(const ReceiverOverrides& overrides) = 0;
  /// Simulates blocks, in any order. Equal blocks give equal samples, except for the time, on any number of threads.
  [[nodiscard]] virtual std::vector<Sample> sample(std::span<const SampleBlock> blocks, unsigned threads) const = 0;
  /// Counts the echoes of single slots.
  [[nodiscard]] virtual std::vector<SlotCount> count(std::span<const PulseIndex> slots, unsigned threads) const = 0;
};

/// Checks legs and scanner, without loading the scene. Throws a `SettingError` or `FileError`; returns warnings.
[[nodiscard]] std::vector<std::string> check_without_scene(const SurveySettings& survey,
                                                           const std::vector<std::string>& leg_places = {});

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_SIMULATION)
#include <algorithm>

#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/scanner/footprint.hpp>

namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE std::vector<std::string> check_without_scene(const SurveySettings& survey,
                                                              const std::vector<std::string>& leg_places) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  std::vector<std::string> warnings = compile_survey(survey, ground, {.leg_places = leg_places}).warnings;
  for (const ChannelSettings& channel : survey.scanner.channels) {
    const Receiver receiver = survey_receiver(channel);
    receiver.validate();
    const std::string odd = air_warning(channel.wavelength, receiver);
    if (!odd.empty() && std::find(warnings.begin(), warnings.end(), odd) == warnings.end()) warnings.push_back(odd);
    survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
  return warnings;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif

#endif
