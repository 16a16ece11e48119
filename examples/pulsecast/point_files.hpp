// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <pulsecast/echo.hpp>
#include <pulsecast/io/kitti.hpp>

#include "options.hpp"

/// What files do not hold of the results, for notes at the end of a run.
struct LeftOut {
  std::uint64_t pulses_cut = 0;                         ///< see `LasWriter`
  std::uint64_t classes_cut = 0;                        ///< see `LasWriter`; points
  std::uint64_t echoes = 0;                             ///< see `PtxWriter`
  std::uint64_t waveforms_cut = 0;                      ///< see `WaveformTextWriter`
  std::uint32_t samples_max = 0;                        ///< of a waveform
  std::map<std::uint16_t, std::uint64_t> unlabelled{};  ///< see `KittiWriter`

  void add(const LeftOut& other);
};

/// File of points in the format of the options; for KITTI a folder.
class PointFile {
 public:
  virtual ~PointFile() = default;
  virtual void operator()(const pulsecast::EchoBatch& batch) = 0;
  virtual void close() = 0;
  virtual void count(LeftOut& sum) const = 0;  ///< adds what it does not hold
};

/// Opens a file of the points of a prefix, as `leg000`.
std::unique_ptr<PointFile> point_file(const std::filesystem::path& path, const std::string& prefix,
                                      const Options& options, double start_time);

/// Table of a text file, class and label in each row; or of all classes as they are, for "own". Throws a `FileError`.
pulsecast::io::KittiClasses read_kitti_classes(const std::filesystem::path& path);
