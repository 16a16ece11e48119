// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

/// Kinds of point formats, by the columns of their points.
enum class PointKind { text, las, columns, fixed };

/// Format of point files: a value of `--format`, and ending of the files.
struct PointFormat {
  std::string_view name;
  PointKind kind;
  std::string_view missing{};    ///< what this build lacks for it; empty: nothing
  bool shared = false;           ///< several processes can write it
  bool waveform_arrays = false;  ///< waveforms are NPZ, too
  bool colours = true;           ///< points can have colours
  bool in_scans = false;         ///< points are in the frame of the scanner, in scans of equal time
};

#ifdef PULSECAST_PCD
#define PULSECAST_WITHOUT_PCD ""
#else
#define PULSECAST_WITHOUT_PCD "pulsecast::pcd (Debian package: liblzf-dev)"
#endif
#ifdef PULSECAST_NPZ
#define PULSECAST_WITHOUT_NPZ ""
#else
#define PULSECAST_WITHOUT_NPZ "pulsecast::npz (Debian package: libarchive-dev)"
#endif
#ifdef PULSECAST_ROS
#define PULSECAST_WITHOUT_ROS ""
#else
#define PULSECAST_WITHOUT_ROS "pulsecast::ros (Debian package: libfastcdr-dev)"
#endif

/// All formats, the default first.
inline constexpr std::array point_formats{
    PointFormat{.name = "xyz", .kind = PointKind::text, .shared = true, .colours = false},
    PointFormat{.name = "xyz.gz", .kind = PointKind::text, .shared = true, .colours = false},
    PointFormat{.name = "las", .kind = PointKind::las, .shared = true},
    PointFormat{.name = "laz", .kind = PointKind::las, .shared = true},
    PointFormat{.name = "copc.laz", .kind = PointKind::las},
    PointFormat{.name = "ply", .kind = PointKind::columns},
    PointFormat{.name = "pcd", .kind = PointKind::columns, .missing = PULSECAST_WITHOUT_PCD},
    PointFormat{.name = "npz", .kind = PointKind::columns, .missing = PULSECAST_WITHOUT_NPZ, .waveform_arrays = true},
    PointFormat{.name = "kitti", .kind = PointKind::fixed, .colours = false, .in_scans = true},
    PointFormat{.name = "mcap", .kind = PointKind::columns, .missing = PULSECAST_WITHOUT_ROS, .in_scans = true},
    PointFormat{.name = "ptx", .kind = PointKind::fixed, .colours = false}};

/// Row of a name of the table.
[[nodiscard]] inline const PointFormat& point_format(std::string_view name) {
  return *std::ranges::find(point_formats, name, &PointFormat::name);
}

/// Names of the formats for which `has(format)`: "xyz, las or laz".
template <class Has>
[[nodiscard]] std::string names_of_formats(const Has& has) {
  std::string all;
  const PointFormat* last = nullptr;
  for (const PointFormat& format : point_formats) {
    if (!has(format)) continue;
    if (last) all.append(all.empty() ? "" : ", ").append(last->name);
    last = &format;
  }
  return last ? all.append(all.empty() ? "" : " or ").append(last->name) : all;
}
