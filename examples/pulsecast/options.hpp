// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Where built scenes are kept from run to run, and whether they are.
struct SceneStore {
  std::filesystem::path folder{};  ///< none if empty
  bool read = true, write = true;
};

/// What the command `forecast` is asked.
struct ForecastOptions {
  std::optional<double> range_error{};      ///< at most [m]
  std::optional<double> intensity_error{};  ///< at most, as a share
  std::optional<double> time{};             ///< of a run, at most [s]
  std::optional<double> memory{};           ///< at most [byte]
  bool apply = false;
  std::filesystem::path apply_to{};  ///< the survey itself if empty

  [[nodiscard]] bool asks() const { return range_error || intensity_error || time || memory; }
};

/// What the command line asks for.
struct Options {
  std::string command = "run";  ///< run, check, info, preview, forecast or catalogue
  std::filesystem::path survey{};
  std::vector<std::filesystem::path> assets{};  ///< as given, then where the program finds its own
  std::filesystem::path output = "output";
  std::string format{};  ///< las, laz, xyz or xyz.gz
  std::optional<std::uint64_t> seed{};
  unsigned threads = 0;  ///< 0 for all
  std::string gps_start_time{};
  double las_scale = 1e-4;              ///< [m]
  std::optional<std::uint16_t> epsg{};  ///< of the coordinates in LAS, 0 for none; that of the scene's rasters unless given
  bool las_1_0 = false;                 ///< LAS of version 1.0
  bool write_waveform = false, write_pulse = false, echo_width = false, waveform_noise = false, fixed_incidence = false;
  bool page = false, live = false;  ///< a page of the points: to be left, and to be watched
  std::size_t page_points = 1'000'000;
  bool split_by_channel = false, platform_noise = true, leg_noise = true, resume = false, quiet = false, verbose = false;
  bool strict = false;  ///< notes about the survey and its files are errors
  SceneStore store{};
  ForecastOptions forecast{};
  std::vector<std::string> notes{};  ///< what was accepted but has no effect
};

/// Reads a command line. Empty if nothing is left to do; then `status` is set.
std::optional<Options> read_command_line(int argc, char** argv, int& status);
