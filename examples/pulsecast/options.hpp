// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/accuracy.hpp>
#include <pulsecast/io/point_layout.hpp>
#include <pulsecast/io/ptx.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>

/// Folder of built scenes that are kept between runs, and its use.
struct SceneStore {
  std::filesystem::path folder{};  ///< empty: none
  bool read = true, write = true;
};

/// Limits of the command `forecast`.
struct ForecastLimits {
  std::optional<double> time{};    ///< maximum per run [s]
  std::optional<double> memory{};  ///< maximum [byte]
  bool apply = false;
  std::filesystem::path apply_to{};  ///< empty: the survey itself
};

/// Options of the command line.
struct Options {
  std::string command = "run";  ///< run, check, info, preview, forecast, catalogue or doctor
  std::filesystem::path survey{};
  std::vector<std::filesystem::path> assets{};  ///< those given, then those of the program
  std::filesystem::path output = "output";
  std::string format{};             ///< name in `point_formats`
  std::string kitti_classes{};      ///< file of the labels of classes; "own": classes are labels; empty: default table
  double scan_rate = 10;            ///< of formats in scans [Hz]
  std::uint32_t waveform_bins = 0;  ///< samples in a row of waveforms; 0: as they are
  std::optional<std::uint64_t> seed{};
  unsigned threads = 0;  ///< 0: all
  std::string gps_start_time{};
  double las_scale = 1e-4;  ///< [unit of the coordinates]
  /// System of the results, unknown for none; default: that of the scene's rasters
  std::optional<pulsecast::io::SpatialReference> reference{};
  std::filesystem::path wkt{};                     ///< file of its text; empty: by `reference`
  std::uint16_t project_from = 0, project_to = 0;  ///< systems of --project; 0: that of the datum; none
  bool las_1_0 = false;                            ///< write LAS 1.0
  bool write_waveform = false, write_pulse = false, echo_width = false, uncertainty = false, waveform_noise = false,
       fixed_incidence = false, library_physics = false, light_paths = false;
  bool colours = false, near_infrared = false;  ///< columns of points in LAS
  std::vector<std::string> columns{};           ///< further columns of points, in every format
  bool write_misses = false;                    ///< write a table of the pulses without echoes
  std::optional<double> misses_at{};  ///< range of points for pulses without echoes; default: no such points [m]
  bool geojson = false;               ///< write trajectories and footprints
  bool errors = false;                ///< write and print the errors of the run
  std::optional<pulsecast::Accuracy> accuracy{};  ///< settings that reach it are chosen
  bool page = false, live = false;                ///< page of the points: as a file, and live
  std::size_t page_points = 1'000'000;
  bool split_by_channel = false, platform_noise = true, leg_noise = true, resume = false, quiet = false,
       verbose = false;
  bool strict = false;  ///< treat notes about the survey and its files as errors
  SceneStore store{};
  ForecastLimits forecast{};
  std::vector<std::string> notes{};  ///< accepted options without effect

  using Sensor = std::function<pulsecast::Pose<pulsecast::frame::Instrument, pulsecast::frame::World>(pulsecast::Tick)>;
  std::map<std::string, Sensor> sensors{};  ///< poses of the scanner by prefixes of files, once the scene is loaded
  std::map<std::string, std::vector<pulsecast::io::PtxScan>> ptx_scans{};  ///< by such prefixes, for PTX
  pulsecast::Vec3 origin{};                                                ///< of coordinates in single precision [m]
  bool adjusted_time = false;               ///< times are adjusted standard GPS time; else seconds of a GPS week
  pulsecast::PointColours point_colours{};  ///< of the scene, once it is loaded; empty unless `colours`
  std::vector<pulsecast::io::PointField> fields{};                  ///< `columns`, once the scene is loaded
  pulsecast::io::PointSettings points{};                            ///< values of `fields`
  std::shared_ptr<const pulsecast::ObjectAttributes> attributes{};  ///< of the scene, once it is loaded; null without

  /// True if a column of the points is of their uncertainty.
  [[nodiscard]] bool states_uncertainty() const {
    return uncertainty || std::ranges::any_of(columns, [](const std::string& name) {
             const auto* const column = pulsecast::io::detail::column_or_null(name);
             return column && column->needs == pulsecast::io::PointNeed::uncertainty;
           });
  }
};

/// Options that say what is in files, by words as of a command line, `--las-scale=0.001`. Throws std::invalid_argument
/// for a problem, and for the name of any other option.
Options options_of_files(const std::vector<std::string>& words);
/// Names of these options, each with its help.
std::vector<std::pair<std::string, std::string>> file_options();

/// Reads a command line. Empty if nothing remains to be done; then `status` is set.
std::optional<Options> read_command_line(int argc, char** argv, int& status);
