// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKETS_RULES_HPP
#define PULSECAST_IO_DETAIL_PACKETS_RULES_HPP

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Keys of a laser in Velodyne calibrations, and of the whole file. Those that are refused may be 0, others of a laser
/// are refused. Source: ros-drivers/velodyne, velodyne_pointcloud.
inline constexpr auto velodyne_rules = std::to_array<FormatRule>({
    {"laser_id, rot_correction, vert_correction, vert_offset_correction", FormatUse::read, "angles and height"},
    {"dist_correction*, horiz_offset_correction, focal_*", FormatUse::refused, "0, as packets have no such correction"},
    {"two_pt_correction_available, min_intensity, max_intensity", FormatUse::read, "nothing: intensities are raw"},
    {"num_lasers, distance_resolution", FormatUse::read, "must be as in the data sheet"},
});

/// Keys of the metadata of Ouster sensors; those that are refused may be so. Source: Ouster, Sensor SDK.
inline constexpr auto ouster_rules = std::to_array<FormatRule>({
    {"prod_line, lidar_mode", FormatUse::read, "OS-1-64, columns and turns a second"},
    {"beam_altitude_angles, beam_azimuth_angles, lidar_origin_to_beam_origin_mm", FormatUse::read, "beams and lenses"},
    {"lidar_to_sensor_transform", FormatUse::refused, "a half turn about the vertical, and a height, which is read"},
    {"beam_to_lidar_transform", FormatUse::refused, "a shift along x by lidar_origin_to_beam_origin_mm"},
    {"extrinsic", FormatUse::refused, "none: the survey places the sensor"},
    {"columns_per_frame, pixels_per_column, column_window, azimuth_window", FormatUse::refused,
     "64 lasers, and the columns of lidar_mode in whole turns"},
    {"signal_multiplier", FormatUse::refused, "signals that are not multiplied"},
    {"*", FormatUse::read, "nothing: other keys tell the state of the sensor"},
});

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
