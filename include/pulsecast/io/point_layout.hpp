// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_LAYOUT_HPP
#define PULSECAST_IO_POINT_LAYOUT_HPP

#include <pulsecast/io/point_columns.hpp>

/// Layouts of point records, as of PCD, PLY, NPZ and PointCloud2: fields, types and offsets.
namespace PULSECAST_NAMESPACE::io {

/// Size of a number [byte].
[[nodiscard]] constexpr std::uint32_t size_of(NumberType type) noexcept {
  using enum NumberType;
  return type <= uint8 ? 1 : type <= uint16 ? 2 : type <= float32 ? 4 : 8;
}

/// Field of a point record: a column times a scale.
struct PointField {
  std::string name{};                          ///< name in the file; that of an attribute
  NumberType type = NumberType::float32;       ///< integers are rounded, and limited to its range
  const PointColumn* column = &absent_column;  ///< column; by default not simulated
  double scale = 1;                            ///< number in the record per unit of the column
  std::uint32_t offset = 0;                    ///< position in the record [byte]
};

/// Layout of a point record. Numbers are little-endian.
struct PointLayout {
  std::vector<PointField> fields{};  ///< fields in ascending order of their offsets
  std::uint32_t size = 0;            ///< size of a record, which may be padded [byte]

  /// Layout of fields one after another, without gaps.
  [[nodiscard]] static PointLayout packed(const std::vector<PointField>& all) { return PointLayout{}.with(all); }

  /// This layout with further fields at its end, without gaps.
  [[nodiscard]] PointLayout with(const std::vector<PointField>& more) const {
    PointLayout layout = *this;
    for (const PointField& field : more) {
      layout.fields.push_back(field);
      layout.fields.back().offset = layout.size;
      layout.size += size_of(field.type);
    }
    return layout;
  }

  /// @throws SettingError for fields that overlap or leave the record
  void validate() const {
    require_within("PointLayout::fields (number)", fields.size(), 0, 1000, "");
    require_positive("PointLayout::size", size, "byte");
    std::uint32_t end = 0;
    for (const PointField& field : fields) {
      require_within("PointField::offset of " + field.name, field.offset, end,
                     static_cast<double>(size) - size_of(field.type), "byte");
      require_finite("PointField::scale of " + field.name, field.scale, "");
      end = field.offset + size_of(field.type);
    }
  }

  /// True if a column of a field has this need.
  [[nodiscard]] bool needs(PointNeed need) const noexcept {
    return std::ranges::any_of(fields, [need](auto& f) { return f.column->needs == need; });
  }

  /// This layout with float64 in place of 64-bit integers: exact up to 2^53.
  [[nodiscard]] PointLayout without_int64() const {
    PointLayout layout = *this;
    for (PointField& field : layout.fields) field.type = std::min(field.type, NumberType::float64);
    return layout;
  }
};

/// Point layouts of drivers and of maps.
namespace layouts {

using enum NumberType;

/// Coordinates about a sensor in single precision, with a spacing of 8 um at 100 m.
[[nodiscard]] inline std::vector<PointField> xyz_float() {
  return {{"x", float32, column("x")}, {"y", float32, column("y")}, {"z", float32, column("z")}};
}

/// Points of a map: coordinates in double precision, and all values of an echo.
[[nodiscard]] inline PointLayout map() {
  return PointLayout::packed({{"x", float64, column("x")},
                              {"y", float64, column("y")},
                              {"z", float64, column("z")},
                              {"reflectance", float32, column("reflectance")},
                              {"time", float64, column("clock")},
                              {"channel", uint16, column("ring")},
                              {"return_number", uint8, column("return_number")},
                              {"returns", uint8, column("number_of_returns")},
                              {"classification", uint16, column("classification")},
                              {"object", uint32, column("object")}});
}

/// Coordinates and intensity, as PCL's PointXYZI.
[[nodiscard]] inline PointLayout xyzi() {
  return PointLayout::packed(xyz_float()).with({{"intensity", float32, column("reflectivity")}});
}

/// Fields of Velodyne's ROS driver, 22 bytes: time in the scan [s]. Source: ros-drivers/velodyne.
[[nodiscard]] inline PointLayout velodyne() {
  return xyzi().with({{"ring", uint16, column("ring")}, {"time", float32, column("time")}});
}

/// Fields of the ROS driver of Hesai, 26 bytes, clock [s]. Source: HesaiTechnology/HesaiLidar_ROS_2.0.
[[nodiscard]] inline PointLayout hesai() {
  return xyzi().with({{"ring", uint16, column("ring")}, {"timestamp", float64, column("clock")}});
}

/// Fields of the ROS driver of Livox, 26 bytes, clock [ns]. Source: Livox-SDK/livox_ros_driver2.
[[nodiscard]] inline PointLayout livox() {
  return xyzi().with({{"tag", uint8}, {"line", uint8, column("ring")}, {"timestamp", float64, column("clock"), 1e9}});
}

/// Fields of the ROS driver of Ouster, 48 bytes: t in the scan [ns], intensity in photons, range
/// [mm], as in a structure aligned to 16 bytes. Source: ouster-lidar/ouster-ros.
[[nodiscard]] inline PointLayout ouster() {
  return {{{"x", float32, column("x"), 1, 0},
           {"y", float32, column("y"), 1, 4},
           {"z", float32, column("z"), 1, 8},
           {"intensity", float32, column("photons"), 1, 16},
           {"t", uint32, column("time"), 1e9, 20},
           {"reflectivity", uint16, column("reflectivity"), 1, 24},
           {"ring", uint16, column("ring"), 1, 26},
           {"ambient", uint16, &absent_column, 1, 28},
           {"range", uint32, column("range"), 1e3, 32}},
          48};
}

/// Fields of Autoware's PointXYZIRCAEDT, 32 bytes. Source: autowarefoundation, data types of point
/// clouds: time_stamp since the scan's start [ns]; return types are left out.
[[nodiscard]] inline PointLayout autoware() {
  return PointLayout::packed(xyz_float())
      .with({{"intensity", uint8, column("reflectivity")},
             {"return_type", uint8},
             {"channel", uint16, column("ring")},
             {"azimuth", float32, column("azimuth")},
             {"elevation", float32, column("elevation")},
             {"distance", float32, column("range")},
             {"time_stamp", uint32, column("time"), 1e9}});
}

/// Columns as in the table, to append to a layout: `columns({column("pulse"), column("leg")})`.
[[nodiscard]] inline std::vector<PointField> columns(std::initializer_list<const PointColumn*> all) {
  std::vector<PointField> fields;
  for (const PointColumn* each : all) fields.push_back({std::string(each->name), each->type, each});
  return fields;
}
/// As above, of consecutive rows of the table, such as all `point_columns`.
[[nodiscard]] inline std::vector<PointField> columns(std::span<const PointColumn> all) {
  std::vector<PointField> fields;
  for (const PointColumn& each : all) fields.push_back({std::string(each.name), each.type, &each});
  return fields;
}

/// As above, by the names of columns or of `attributes`.
/// @throws SettingError for a name that neither a column nor an attribute has
[[nodiscard]] inline std::vector<PointField> columns(std::span<const std::string> names,
                                                     std::span<const std::string> attributes = {}) {
  std::vector<PointField> fields;
  for (const std::string& name : names) {
    const bool is_attribute = std::ranges::find(attributes, name) != attributes.end();
    const PointColumn& of_name = is_attribute ? attribute_column : find_column(name);
    fields.push_back({name, of_name.type, &of_name});
  }
  return fields;
}

/// Labels of a point, to append to another layout: `layouts::velodyne().with(layouts::labels())`.
/// Part, material, normal and velocity need `PointSettings::surfaces`.
[[nodiscard]] inline std::vector<PointField> labels() {
  return columns({column("classification"), column("object"), column("part"), column("material"), column("normal_x"),
                  column("normal_y"), column("normal_z"), column("velocity_x"), column("velocity_y"),
                  column("velocity_z")});
}

/// Red, green and blue of a point in 8 bits each, by the names that readers of PLY expect, to
/// append to another layout. Colours need `PointSettings::colours`. 0 if unknown, which is black.
[[nodiscard]] inline std::vector<PointField> colours() {
  return {{"red", uint8, column("red"), 1 / 257.0},
          {"green", uint8, column("green"), 1 / 257.0},
          {"blue", uint8, column("blue"), 1 / 257.0}};
}

/// Red, green, blue and near infrared of a point in 16 bits each, as LAS has them.
[[nodiscard]] inline std::vector<PointField> deep_colours() {
  return columns({column("red"), column("green"), column("blue"), column("near_infrared")});
}

/// Red, green and blue of a point in one field, as PCL and the viewers of ROS have them.
/// Source: PCL, PointXYZRGB: the bits of 0x00RRGGBB as a float.
[[nodiscard]] inline std::vector<PointField> packed_colour() { return {{"rgb", float32, column("rgb_bits")}}; }

/// Covariance of a point and its flags, to append to another layout. They need `PointSettings::uncertainty`. NaN, and
/// flags of 255, if unknown. Source: PDAL, filters.als_tpu, for the names.
[[nodiscard]] inline std::vector<PointField> uncertainty() {
  return {{"VarianceX", float32, column("variance_x")},
          {"VarianceY", float32, column("variance_y")},
          {"VarianceZ", float32, column("variance_z")},
          {"CovarianceXY", float32, column("covariance_xy")},
          {"CovarianceXZ", float32, column("covariance_xz")},
          {"CovarianceYZ", float32, column("covariance_yz")},
          {"UncertaintyFlags", uint8, column("uncertainty_flags")}};
}

/// Attributes of a point's object by `ObjectAttributes::names`. NaN if it has none, 0 in integers.
[[nodiscard]] inline std::vector<PointField> attributes(std::span<const std::string> names, NumberType type = float64) {
  std::vector<PointField> fields;
  for (const std::string& name : names) fields.push_back({name, type, &attribute_column});
  return fields;
}

}  // namespace layouts

}  // namespace PULSECAST_NAMESPACE::io

#endif
