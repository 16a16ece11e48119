// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <pulsecast/io/point_layout.hpp>
#include <pulsecast/io/spatial_reference.hpp>
#include <pulsecast/page/page.hpp>
#include <pulsecast/run.hpp>

#include "point_files.hpp"

// Parts of the program that need large libraries are shared objects of their own, which few runs load.

/// Functions of a part, as in the structs below. Loads it at the first call; throws a `std::runtime_error` if it is
/// not there.
template <class Functions>
const Functions& part() {
  const void* loaded_part(const char* name);
  static const auto* const loaded = static_cast<const Functions*>(loaded_part(Functions::name));
  return *loaded;
}

/// Reference systems, by PROJ.
struct ReferencePart {
  static constexpr const char* name = "pulsecast-reference.so";
  pulsecast::io::SpatialReference (*complete)(const pulsecast::io::SpatialReference& given, const std::string& name);
  pulsecast::io::MapProjector (*projector)(std::uint16_t from, std::uint16_t to);
};

/// `page::PageServer`.
class LivePage {
 public:
  virtual ~LivePage() = default;
  [[nodiscard]] virtual std::string address() const = 0;
  virtual void begin(pulsecast::page::PageSurvey survey, const pulsecast::page::PageSettings& settings) = 0;
  virtual void operator()(const pulsecast::EchoBatch& batch) = 0;
  virtual void show(const pulsecast::Progress& progress) = 0;
  [[nodiscard]] virtual bool stop_requested() const = 0;
  virtual void finish(bool complete) = 0;
};

/// Live pages, by cpp-httplib.
struct LivePart {
  static constexpr const char* name = "pulsecast-live.so";
  std::unique_ptr<LivePage> (*page)(const pulsecast::page::PageSurvey& survey,
                                    const pulsecast::page::PageSettings& settings);
};

/// NPZ files of points and of waveforms, by libarchive.
struct ArraysPart {
  static constexpr const char* name = "pulsecast-arrays.so";
  std::unique_ptr<PointFile> (*points)(const std::filesystem::path& path, const pulsecast::io::PointLayout& layout,
                                       const pulsecast::io::PointSettings& points);
  std::unique_ptr<PointFile> (*waveforms)(const std::filesystem::path& path, double start_time);
};
