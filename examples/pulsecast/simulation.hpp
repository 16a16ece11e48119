// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/adapters/survey_builder.hpp>
#include <pulsecast/run.hpp>

#include "options.hpp"

/// A scene and the pulses that are sent into it: all that is heavy to compile, behind a few functions.
class Simulation {
 public:
  struct Settings {
    std::uint64_t seed = 0;
    bool echo_width = false, waveforms = false, waveform_noise = false, fixed_incidence = false, platform_noise = true, leg_noise = true;
    std::vector<std::filesystem::path> assets{};
    std::string scene_text{};  ///< says all settings of the scene
    SceneStore store{};
    unsigned threads = 0;  ///< that build the scene; 0 for all
  };
  struct Scene {
    pulsecast::Vec3 least{}, most{};  ///< of its box [m]
    std::size_t parts = 0, moving = 0, triangles = 0, memory = 0;
    bool empty = true;
  };

  Simulation(const pulsecast::adapters::SurveySettings& survey, const Settings& settings);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// How many times the survey is repeated, with another scene each time.
  [[nodiscard]] int runs() const;
  /// Goes to a repetition.
  void begin(int run);

  [[nodiscard]] const pulsecast::adapters::SurveyPlan& plan() const;
  [[nodiscard]] Scene scene() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;
  [[nodiscard]] const std::vector<std::string>& notes() const;  ///< for those who want to know more

  pulsecast::RunSummary run(const pulsecast::RunOptions& options, const std::function<void(const pulsecast::EchoBatch&)>& sink) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Checks all that can be checked without the scene: legs and scanner. Throws what is wrong.
void check_without_scene(const pulsecast::adapters::SurveySettings& survey);
