// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>

/// Surveys of XML documents, ready to run. `make_simulation` makes them; who only runs them needs no more than this header.
namespace pulsecast::helios {

/// What a survey may trade for speed, of all channels. What is not given is as the survey says.
struct Receiving {
  std::optional<int> rings{};        ///< of subrays: `beamSampleQuality`
  std::optional<double> bin_size{};  ///< `binSize_ns` [s]
  bool ideal = false;                ///< without any noise, and without widths and waveforms

  bool operator==(const Receiving&) const = default;
};

/// Consecutive slots of a sample. Those before `from` are simulated, but do not count: they leave caches as slots of a run find them.
struct SampleBlock {
  PulseIndex first = 0, from = 0, end = 0;
};

/// What came of the slots of a block that count.
struct Sample : ResultBuffer {
  double seconds = 0;          ///< of one processor [s]
  double sample_interval = 0;  ///< [s]

  [[nodiscard]] EchoBatch batch() const { return ResultBuffer::batch(sample_interval); }
};

/// What came of a single slot.
struct SlotCount {
  Fate fate = Fate::blocked;
  std::uint8_t echoes = 0;
};

/// A survey with its scene loaded and its legs planned. `run`, `sample` and `count` may be called by several threads at a time.
class Simulation {
 public:
  /// Triangles of one material that stand in the scene beside the survey's own parts.
  struct Mesh {
    MeshData data{};
    Material material{};
    ObjectId object = 0;  ///< carried by the points on it
  };

  struct Settings {
    std::uint64_t seed = 0;                       ///< of all that is random
    bool echo_width = false;                      ///< widths of echoes are fitted
    bool waveforms = false;                       ///< echoes keep their waveforms
    bool las_waveforms = false;                   ///< waveforms are cut and sampled as LAS can hold them
    bool waveform_noise = false;                  ///< the receiver is noisy
    bool fixed_incidence = false;                 ///< all surfaces scatter as if they were met squarely
    bool platform_noise = true;                   ///< as the survey says; else none
    bool leg_noise = true;                        ///< legs begin elsewhere than they should, as the survey says
    std::vector<std::filesystem::path> assets{};  ///< folders; those that hold a folder `spectra` describe materials
    std::vector<Mesh> meshes{};
    std::vector<std::string> leg_places{};  ///< places of the legs in their document, for messages; may be empty
    std::string place{};                    ///< place of the survey in its document, for messages; may be empty
    unsigned threads = 0;                   ///< that build the scene; 0 for all
  };

  /// Size of a loaded scene.
  struct Scene {
    Vec3 least{}, most{};  ///< corners of its box, in the world [m]
    std::size_t parts = 0, moving = 0, triangles = 0;
    std::size_t memory = 0;  ///< [byte]
    bool empty = true;       ///< there is no box
  };

  Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  virtual ~Simulation() = default;

  /// Number of repetitions of the survey, each with another scene.
  [[nodiscard]] virtual int runs() const = 0;
  /// Loads the scene of a repetition, from 0, and plans its legs. Throws as `make_simulation`.
  virtual void begin(int run) = 0;

  [[nodiscard]] virtual const CompiledSurvey& compiled() const = 0;
  [[nodiscard]] virtual Scene scene() const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;  ///< of scene, legs and receivers, each once

  /// Simulates the pulses as `pulsecast::run` does. The sink gets the echoes in the order of their pulses.
  virtual RunSummary run(const RunOptions& options, const std::function<void(const EchoBatch&)>& sink) const = 0;

  /// Goes on with other receivers. Scene and legs stay as they are.
  virtual void receive(const Receiving& how) = 0;
  /// Simulates blocks, in any order. The same blocks give the same samples, but for the time, on any number of threads.
  [[nodiscard]] virtual std::vector<Sample> sample(std::span<const SampleBlock> blocks, unsigned threads) const = 0;
  /// Counts the echoes of single slots.
  [[nodiscard]] virtual std::vector<SlotCount> count(std::span<const PulseIndex> slots, unsigned threads) const = 0;
};

/// Checks all that can be checked without the scene: legs and scanner. Throws a `SettingError` or `FileError`; returns warnings.
[[nodiscard]] inline std::vector<std::string> check_without_scene(const SurveySettings& survey,
                                                                  const std::vector<std::string>& leg_places = {}) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  std::vector<std::string> warnings = compile_survey(survey, ground, {.leg_places = leg_places}).warnings;
  for (const ChannelSettings& channel : survey.scanner.channels) {
    survey_receiver(channel).validate();
    survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
  return warnings;
}

}  // namespace pulsecast::helios
