// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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
  [[nodiscard]] std::vector<std::string> notes(bool las_1_0) const;  ///< each a sentence
};

/// File of points in the format of the options; for KITTI a folder.
class PointFile {
 public:
  virtual ~PointFile() = default;
  virtual void operator()(const pulsecast::EchoBatch& batch) = 0;
  virtual void close() = 0;
  virtual void count(LeftOut& /*sum*/) const {}  ///< adds what it does not hold
};

/// File by a writer of the library.
template <class Writer>
class WrittenFile : public PointFile {
 public:
  template <class... Arguments>
  explicit WrittenFile(Arguments&&... arguments) : writer_(std::forward<Arguments>(arguments)...) {}
  void operator()(const pulsecast::EchoBatch& batch) override { writer_(batch); }
  void close() override { writer_.close(); }

 protected:
  Writer writer_;
};

/// Opens a file of the points of a prefix, as `leg000`.
std::unique_ptr<PointFile> point_file(const std::filesystem::path& path, const std::string& prefix,
                                      const Options& options, double start_time);

/// Table of a text file, class and label in each row; or of all classes as they are, for "own". Throws a `FileError`.
pulsecast::io::KittiClasses read_kitti_classes(const std::filesystem::path& path);
