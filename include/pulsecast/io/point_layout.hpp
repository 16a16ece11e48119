// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_LAYOUT_HPP
#define PULSECAST_IO_POINT_LAYOUT_HPP

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/require.hpp>

/// Layouts of point records: fields, types and offsets. PCD, PLY, NPZ and PointCloud2 are headers for such records.
namespace PULSECAST_NAMESPACE::io {

/// Number type of a field. The values are those of the data types of sensor_msgs/PointField.
enum class FieldType : std::uint8_t { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size of a number [byte].
[[nodiscard]] constexpr std::uint32_t size_of(FieldType type) noexcept {
  return type <= FieldType::uint8 ? 1 : type <= FieldType::uint16 ? 2 : type <= FieldType::float32 ? 4 : 8;
}

/// Quantity of a point, in SI units. Positions, normals and velocities are in the frame and axes of `PointSettings`.
enum class PointQuantity : std::uint8_t {
  none,             ///< 0: a field of the layout that is not simulated
  x,                ///< coordinate [m]
  y,                ///< coordinate [m]
  z,                ///< coordinate [m]
  normal_x,         ///< unit normal of the surface; 0 if unknown
  normal_y,         ///< as above
  normal_z,         ///< as above
  velocity_x,       ///< velocity of the surface in the world [m/s]; 0 if unknown
  velocity_y,       ///< as above
  velocity_z,       ///< as above
  range,            ///< range [m]
  azimuth,          ///< angle of the point from the x axis to the y axis, in the frame of the points [rad]
  elevation,        ///< angle of the point above the plane of x and y [rad]
  reflectance,      ///< as `Echo::reflectance`: 1 for a white surface at normal incidence
  reflectivity,     ///< the same as instruments encode it, from 0 to 255: `reflectivity_byte`
  photons,          ///< photons at the echo's peak per pulse length: amplitude by photon energy
  amplitude,        ///< as `Echo::amplitude` [W]
  width,            ///< as `Echo::width` [s]
  cos_incidence,    ///< as `Echo::cos_incidence`
  radial_velocity,  ///< as `Echo::velocity` [m/s]
  time,             ///< emission since the scan's start [s]
  clock,            ///< emission by the clock: `PointSettings::start_time` at tick 0 [s]
  ring,             ///< number of the laser by `PointSettings::rings`
  return_number,    ///< as `Echo::number`, from 1
  returns,          ///< echoes of the pulse
  pulse,            ///< as `Shot::index`
  leg,              ///< as `Shot::leg`
  classification,   ///< class of the material
  object,           ///< object of the part: the instance
  part,             ///< index of the part in its scene; the type's largest number if unknown
  material,         ///< index of the material in the part's table; the type's largest number if unknown
  kind,             ///< as `Echo::kind`
  red,              ///< as `PointColour::red`, from 0 to 1; NaN if unknown, as the other colours
  green,            ///< as above
  blue,             ///< as above
  near_infrared,    ///< as `PointColour::near_infrared`, from 0 to 1; NaN if unknown
  packed_rgb,       ///< 65536 red + 256 green + blue, of 8 bits each; NaN if unknown
  packed_rgb_bits,  ///< float32 of the bits of `packed_rgb`, as PCL and ROS have it; 0 if unknown
  attribute  ///< attribute of the object, by the field's name, see `PointSettings::attributes`; NaN if it has none
};

/// Field of a point record: a quantity times a scale.
struct PointField {
  std::string name{};                   ///< name in the file or message
  FieldType type = FieldType::float32;  ///< number type; integers are rounded, and limited to the range of their type
  PointQuantity quantity = PointQuantity::none;  ///< quantity
  double scale = 1;                              ///< number in the record per unit of the quantity
  std::uint32_t offset = 0;                      ///< position in the record [byte]
};

/// Layout of a point record. Numbers are little-endian.
struct PointLayout {
  std::vector<PointField> fields{};  ///< fields in ascending order of their offsets
  std::uint32_t size = 0;            ///< size of a record, which may be padded [byte]

  /// Layout of fields one after another, without gaps.
  [[nodiscard]] static PointLayout packed(const std::vector<PointField>& fields) { return PointLayout{}.with(fields); }

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
    require_within("PointLayout::fields (number)", static_cast<double>(fields.size()), 1, 1000, "");
    std::uint32_t end = 0;
    for (const PointField& field : fields) {
      require_within("PointField::offset of " + field.name, field.offset, end,
                     static_cast<double>(size) - size_of(field.type), "byte");
      require_finite("PointField::scale of " + field.name, field.scale, "");
      end = field.offset + size_of(field.type);
    }
  }

  /// True if a field holds one of the quantities from `first` to `last`.
  [[nodiscard]] bool has(PointQuantity first, PointQuantity last) const noexcept {
    for (const PointField& field : fields)
      if (field.quantity >= first && field.quantity <= last) return true;
    return false;
  }
};

/// Point layouts of drivers and of maps.
namespace layouts {

/// Coordinates in single precision. Its spacing is 8 um at 100 m, and 0.5 m at 5,000 km: for points about a sensor.
[[nodiscard]] inline std::vector<PointField> xyz_float() {
  return {{"x", FieldType::float32, PointQuantity::x},
          {"y", FieldType::float32, PointQuantity::y},
          {"z", FieldType::float32, PointQuantity::z}};
}

/// Points of a map: coordinates in double precision, and all values of an echo.
[[nodiscard]] inline PointLayout map() {
  return PointLayout::packed({{"x", FieldType::float64, PointQuantity::x},
                              {"y", FieldType::float64, PointQuantity::y},
                              {"z", FieldType::float64, PointQuantity::z},
                              {"reflectance", FieldType::float32, PointQuantity::reflectance},
                              {"time", FieldType::float64, PointQuantity::clock},
                              {"channel", FieldType::uint16, PointQuantity::ring},
                              {"return_number", FieldType::uint8, PointQuantity::return_number},
                              {"returns", FieldType::uint8, PointQuantity::returns},
                              {"classification", FieldType::uint16, PointQuantity::classification},
                              {"object", FieldType::uint32, PointQuantity::object}});
}

/// Coordinates and intensity, as PCL's PointXYZI.
[[nodiscard]] inline PointLayout xyzi() {
  return PointLayout::packed(xyz_float()).with({{"intensity", FieldType::float32, PointQuantity::reflectivity}});
}

/// Fields of Velodyne's ROS driver, 22 bytes. Source: ros-drivers/velodyne, PointcloudXYZIRT: time from scan start [s].
[[nodiscard]] inline PointLayout velodyne() {
  return xyzi().with(
      {{"ring", FieldType::uint16, PointQuantity::ring}, {"time", FieldType::float32, PointQuantity::time}});
}

/// Fields of the ROS driver of Hesai, 26 bytes. Source: HesaiTechnology/HesaiLidar_ROS_2.0: timestamp by the clock [s].
[[nodiscard]] inline PointLayout hesai() {
  return xyzi().with(
      {{"ring", FieldType::uint16, PointQuantity::ring}, {"timestamp", FieldType::float64, PointQuantity::clock}});
}

/// Fields of the ROS driver of Livox, 26 bytes. Source: Livox-SDK/livox_ros_driver2: timestamp by the clock [ns].
[[nodiscard]] inline PointLayout livox() {
  return xyzi().with({{"tag", FieldType::uint8, PointQuantity::none},
                      {"line", FieldType::uint8, PointQuantity::ring},
                      {"timestamp", FieldType::float64, PointQuantity::clock, 1e9}});
}

/// Fields of the ROS driver of Ouster, 48 bytes. Source: ouster-lidar/ouster-ros, its default point type: t since the
/// scan's start [ns], intensity in photons, range [mm], all in the places that a C++ structure aligned to 16 bytes has.
[[nodiscard]] inline PointLayout ouster() {
  return {{{"x", FieldType::float32, PointQuantity::x, 1, 0},
           {"y", FieldType::float32, PointQuantity::y, 1, 4},
           {"z", FieldType::float32, PointQuantity::z, 1, 8},
           {"intensity", FieldType::float32, PointQuantity::photons, 1, 16},
           {"t", FieldType::uint32, PointQuantity::time, 1e9, 20},
           {"reflectivity", FieldType::uint16, PointQuantity::reflectivity, 1, 24},
           {"ring", FieldType::uint16, PointQuantity::ring, 1, 26},
           {"ambient", FieldType::uint16, PointQuantity::none, 1, 28},
           {"range", FieldType::uint32, PointQuantity::range, 1e3, 32}},
          48};
}

/// Fields of Autoware's PointXYZIRCAEDT, 32 bytes. Source: autowarefoundation, data types of point clouds: time_stamp
/// since the scan's start [ns]; return types are left out.
[[nodiscard]] inline PointLayout autoware() {
  return PointLayout::packed(xyz_float())
      .with({{"intensity", FieldType::uint8, PointQuantity::reflectivity},
             {"return_type", FieldType::uint8, PointQuantity::none},
             {"channel", FieldType::uint16, PointQuantity::ring},
             {"azimuth", FieldType::float32, PointQuantity::azimuth},
             {"elevation", FieldType::float32, PointQuantity::elevation},
             {"distance", FieldType::float32, PointQuantity::range},
             {"time_stamp", FieldType::uint32, PointQuantity::time, 1e9}});
}

/// Labels of a point, to append to another layout: `layouts::velodyne().with(layouts::labels())`. Part, material,
/// normal and velocity need `PointSettings::surfaces`.
[[nodiscard]] inline std::vector<PointField> labels() {
  return {{"classification", FieldType::uint16, PointQuantity::classification},
          {"object", FieldType::uint32, PointQuantity::object},
          {"part", FieldType::uint32, PointQuantity::part},
          {"material", FieldType::uint16, PointQuantity::material},
          {"normal_x", FieldType::float32, PointQuantity::normal_x},
          {"normal_y", FieldType::float32, PointQuantity::normal_y},
          {"normal_z", FieldType::float32, PointQuantity::normal_z},
          {"velocity_x", FieldType::float32, PointQuantity::velocity_x},
          {"velocity_y", FieldType::float32, PointQuantity::velocity_y},
          {"velocity_z", FieldType::float32, PointQuantity::velocity_z}};
}

/// Red, green and blue of a point in 8 bits each, by the names that readers of PLY expect, to append to another layout.
/// Colours need `PointSettings::colours`. 0 if unknown, which is black.
[[nodiscard]] inline std::vector<PointField> colours() {
  return {{"red", FieldType::uint8, PointQuantity::red, 255},
          {"green", FieldType::uint8, PointQuantity::green, 255},
          {"blue", FieldType::uint8, PointQuantity::blue, 255}};
}

/// Red, green, blue and near infrared of a point in 16 bits each, as LAS has them.
[[nodiscard]] inline std::vector<PointField> deep_colours() {
  return {{"red", FieldType::uint16, PointQuantity::red, 65535},
          {"green", FieldType::uint16, PointQuantity::green, 65535},
          {"blue", FieldType::uint16, PointQuantity::blue, 65535},
          {"near_infrared", FieldType::uint16, PointQuantity::near_infrared, 65535}};
}

/// Red, green and blue of a point in one field, as PCL and the viewers of ROS have them.
/// Source: PCL, PointXYZRGB: the bits of 0x00RRGGBB as a float.
[[nodiscard]] inline std::vector<PointField> packed_colour() {
  return {{"rgb", FieldType::float32, PointQuantity::packed_rgb_bits}};
}

/// Attributes of a point's object, to append to a layout: `ObjectAttributes::names`. NaN if it has none, 0 in integers.
[[nodiscard]] inline std::vector<PointField> attributes(std::span<const std::string> names,
                                                        FieldType type = FieldType::float64) {
  std::vector<PointField> fields;
  for (const std::string& name : names) fields.push_back({name, type, PointQuantity::attribute});
  return fields;
}

}  // namespace layouts

}  // namespace PULSECAST_NAMESPACE::io

#endif
