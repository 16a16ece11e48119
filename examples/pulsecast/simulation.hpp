// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>

#include "options.hpp"

class SceneSharing;
class SurveyInputs;

/// What a survey may trade for speed, of all channels. What is not given is as the survey says.
struct Receiving {
  std::optional<int> rings{};        ///< of subrays: `beamSampleQuality`
  std::optional<double> bin_size{};  ///< `binSize_ns` [s]
  bool ideal = false;                ///< without any noise, and without widths and waveforms

  bool operator==(const Receiving&) const = default;
};

/// Consecutive slots of a sample. Those before `from` are simulated, but do not count: they leave caches as slots of a run find them.
struct SampleBlock {
  pulsecast::PulseIndex first = 0, from = 0, end = 0;
};

/// What came of the slots of a block that count.
struct Sample : pulsecast::ResultBuffer {
  double seconds = 0;          ///< of one processor [s]
  double sample_interval = 0;  ///< [s]

  [[nodiscard]] pulsecast::EchoBatch batch() const { return ResultBuffer::batch(sample_interval); }
};

/// What came of a single slot.
struct SlotCount {
  pulsecast::Fate fate = pulsecast::Fate::blocked;
  std::uint8_t echoes = 0;
};

/// A scene and the pulses that are sent into it: all that is heavy to compile, behind a few functions.
class Simulation {
 public:
  /// Triangles of one material that stand in the scene beside the survey's own parts.
  struct Mesh {
    pulsecast::MeshData data{};
    pulsecast::Material material{};
    pulsecast::ObjectId object = 0;
  };
  struct Settings {
    std::uint64_t seed = 0;
    bool echo_width = false, waveforms = false, waveform_noise = false, fixed_incidence = false, platform_noise = true, leg_noise = true;
    std::vector<std::filesystem::path> assets{};
    std::string scene_text{};               ///< says all settings of the scene
    std::vector<std::string> leg_places{};  ///< where legs stand in their document, for messages
    std::string place{};                    ///< where the survey does
    bool las_waveforms = false;             ///< waveforms are to be written as LAS
    SceneStore store{};
    std::shared_ptr<SurveyInputs> inputs{};  ///< found unless given
    SceneSharing* sharing = nullptr;         ///< if the scene is to be that of other processes, too
    std::vector<Mesh> meshes{};
    unsigned threads = 0;  ///< that build the scene; 0 for all
  };
  struct Scene {
    pulsecast::Vec3 least{}, most{};  ///< of its box [m]
    std::size_t parts = 0, moving = 0, triangles = 0, memory = 0;
    bool empty = true;
  };

  Simulation(const pulsecast::helios::SurveySettings& survey, const Settings& settings);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// How many times the survey is repeated, with another scene each time.
  [[nodiscard]] int runs() const;
  /// Goes to a repetition.
  void begin(int run);

  [[nodiscard]] const pulsecast::helios::CompiledSurvey& compiled() const;
  [[nodiscard]] Scene scene() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  [[nodiscard]] const std::vector<std::string>& notes() const;  ///< for those who want to know more

  pulsecast::RunSummary run(const pulsecast::RunOptions& options, const std::function<void(const pulsecast::EchoBatch&)>& sink) const;

  /// Goes on with another way to receive the pulses. Scene and legs stay as they are.
  void receive(const Receiving& how);
  /// Simulates blocks, in any order. The same blocks give the same samples, but for the time, on any number of threads.
  [[nodiscard]] std::vector<Sample> sample(std::span<const SampleBlock> blocks, unsigned threads) const;
  /// Counts the echoes of single slots.
  [[nodiscard]] std::vector<SlotCount> count(std::span<const pulsecast::PulseIndex> slots, unsigned threads) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Checks all that can be checked without the scene: legs and scanner. Throws what is wrong; what is odd is returned.
std::vector<std::string> check_without_scene(const pulsecast::helios::SurveySettings& survey,
                                             const std::vector<std::string>& leg_places = {});
