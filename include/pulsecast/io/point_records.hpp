// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_RECORDS_HPP
#define PULSECAST_IO_POINT_RECORDS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/io/point_layout.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>
#include <pulsecast/scene/surface_query.hpp>

/// Records of points in a layout, which point files and messages consist of.
namespace PULSECAST_NAMESPACE::io {

/// Axes of the coordinates of points.
enum class PointAxes : std::uint8_t {
  right_forward_up,  ///< x right or east, y forward or north, z up
  forward_left_up    ///< x forward, y left, z up, as ROS has it for robots. Source: ROS REP 103
};

/// Distortion of a scan by the motion of its sensor.
enum class MotionDistortion : std::uint8_t {
  kept,    ///< each point is in the sensor's frame at its emission, as drivers publish it
  removed  ///< all points are in the sensor's frame at the scan's start
};

/// Settings of point records.
struct PointSettings {
  /// Pose of the sensor, for points in its frame, as `Platform::instrument_at` gives it; empty: points are in the world
  std::function<Pose<frame::Instrument, frame::World>(Tick)> sensor{};
  MotionDistortion distortion = MotionDistortion::kept;  ///< distortion of points in the sensor's frame
  PointAxes axes = PointAxes::right_forward_up;          ///< axes of the coordinates
  Vec3 origin{};                       ///< place in the world that has coordinates 0, for points in the world [m]
  std::vector<std::uint16_t> rings{};  ///< ring of each channel, see `SpinningSensor::rings`; empty: the channel
  double start_time = 0;               ///< clock time at tick 0 [s]
  Laser laser{};                       ///< laser, for `PointQuantity::photons`
  SurfaceQuery surfaces{};             ///< surfaces of echoes, see `surfaces_of`; empty: unknown
  PointColours colours{};              ///< colours of echoes, see `colours_of`; empty: unknown
  ObjectAttributes attributes{};       ///< attributes of objects, for `PointQuantity::attribute`

  void validate() const {
    require_finite("PointSettings::origin (length)", length(origin), "m");
    require_finite("PointSettings::start_time", start_time, "s");
    laser.validate();
  }
};

/// Reflectance as instruments encode it in a byte: percents up to white surfaces; above, 10 a doubling, up to 255.
/// Source: Velodyne, VLP-16 user manual 63-9243 rev. D, 6.1, but for the doubling, which no maker publishes.
[[nodiscard]] inline double reflectivity_byte(double reflectance) noexcept {
  if (!(reflectance > 0)) return 0;
  return std::min(255.0, reflectance <= 1 ? 100 * reflectance : 100 + 10 * std::log2(reflectance));
}

/// Photons that a power [W] brings in a laser's pulse length.
[[nodiscard]] inline double photon_count(double power, const Laser& laser) noexcept {
  return power * laser.pulse_length * laser.wavelength / (planck_constant * speed_of_light);
}

namespace detail {

/// Quantities of a point, by `PointQuantity`.
using PointValues = std::array<double, static_cast<std::size_t>(PointQuantity::attribute) + 1>;

/// Writes a number as `Number`: integers are rounded, and limited to their range; NaN becomes 0.
template <class Number>
void store_number(double value, std::byte* to) noexcept {
  Number number;
  if constexpr (std::is_floating_point_v<Number>) {
    number = static_cast<Number>(value);
  } else {
    using Limits = std::numeric_limits<Number>;
    const double least = static_cast<double>(Limits::min()), most = static_cast<double>(Limits::max());
    number = std::isnan(value) ? Number{} : static_cast<Number>(std::nearbyint(std::clamp(value, least, most)));
  }
  std::memcpy(to, &number, sizeof number);
}

template <class Number>
[[nodiscard]] double load_number(const std::byte* from) noexcept {
  Number number;
  std::memcpy(&number, from, sizeof number);
  return static_cast<double>(number);
}

/// Calls `visit.operator()<Number>()` with the number type of a field.
template <class Visitor>
decltype(auto) visit_field_type(FieldType type, const Visitor& visit) {
  switch (type) {
    case FieldType::int8:
      return visit.template operator()<std::int8_t>();
    case FieldType::uint8:
      return visit.template operator()<std::uint8_t>();
    case FieldType::int16:
      return visit.template operator()<std::int16_t>();
    case FieldType::uint16:
      return visit.template operator()<std::uint16_t>();
    case FieldType::int32:
      return visit.template operator()<std::int32_t>();
    case FieldType::uint32:
      return visit.template operator()<std::uint32_t>();
    case FieldType::float32:
      return visit.template operator()<float>();
    default:
      return visit.template operator()<double>();
  }
}

}  // namespace detail

/// Encoder of echoes as point records, in pulse order. Allocates nothing but what the vector of the records needs.
class PointEncoder {
 public:
  /// @throws SettingError for a layout or settings out of range, or a field of an attribute that no object has
  explicit PointEncoder(PointLayout layout, PointSettings settings = {})
      : layout_(validated(std::move(layout))), settings_(validated(std::move(settings))) {
    using enum PointQuantity;
    angles_ = layout_.has(azimuth, elevation);
    places_ = angles_ || layout_.has(x, z);
    surfaces_ = layout_.has(normal_x, velocity_z) || layout_.has(part, material);
    colours_ = layout_.has(red, packed_rgb_bits);
    find_attributes();
    begin_scan({});
  }

  [[nodiscard]] const PointLayout& layout() const noexcept { return layout_; }  ///< layout of the records
  [[nodiscard]] const PointSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] Tick scan_start() const noexcept { return start_; }  ///< start of the scan

  /// Sets the start of the scan, from which its times count. Evaluates the sensor's pose for it now.
  void begin_scan(Tick start) {
    start_ = start;
    if (settings_.sensor && settings_.distortion == MotionDistortion::removed)
      frame_ = settings_.sensor(start).inverse();
  }

  /// Appends a record for each echo of the shots of a batch.
  void encode(const EchoBatch& batch, std::vector<std::byte>& records) const {
    std::size_t count = 0;
    for (const Shot& shot : batch.shots) count += shot.echoes;
    std::size_t at = records.size();
    records.resize(at + count * layout_.size);
    detail::PointValues values{};
    for (const Shot& shot : batch.shots) {
      if (shot.echoes == 0) continue;
      set_shot(shot, values);
      const Pose<frame::World, frame::Instrument> frame = frame_at(shot.tick);
      for (const Echo& echo : batch.echoes_of(shot)) {
        set_echo(echo, values);
        if (places_) set_place(frame.point(point_of(shot, echo)), values);
        if (surfaces_)
          set_surface(settings_.surfaces ? settings_.surfaces(batch, shot, echo) : std::nullopt, frame, values);
        if (colours_) set_colour(settings_.colours ? settings_.colours(batch, shot, echo) : std::nullopt, values);
        store(values, records.data() + at);
        if (!attributes_.empty()) store_attributes(settings_.attributes.of(echo.object), records.data() + at);
        at += layout_.size;
      }
    }
  }

 private:
  static double& value(detail::PointValues& values, PointQuantity quantity) noexcept {
    return values[static_cast<std::size_t>(quantity)];
  }

  /// Frame of the points of a time.
  [[nodiscard]] Pose<frame::World, frame::Instrument> frame_at(Tick tick) const {
    if (!settings_.sensor) return {no_rotation, -settings_.origin};
    return settings_.distortion == MotionDistortion::kept ? settings_.sensor(tick).inverse() : frame_;
  }

  [[nodiscard]] Vec3 in_axes(const Vec3& v) const noexcept {
    return settings_.axes == PointAxes::forward_left_up ? to_forward_left_up(v) : v;
  }

  void set_shot(const Shot& shot, detail::PointValues& values) const noexcept {
    using enum PointQuantity;
    value(values, time) =
        static_cast<double>(shot.tick.second - start_.second) + (shot.tick.fraction - start_.fraction);
    value(values, clock) = (settings_.start_time + static_cast<double>(shot.tick.second)) + shot.tick.fraction;
    value(values, ring) = shot.channel < settings_.rings.size() ? settings_.rings[shot.channel] : shot.channel;
    value(values, returns) = shot.echoes;
    value(values, pulse) = static_cast<double>(shot.index);
    value(values, leg) = shot.leg;
  }

  void set_echo(const Echo& echo, detail::PointValues& values) const noexcept {
    using enum PointQuantity;
    value(values, range) = echo.range;
    value(values, reflectance) = echo.reflectance;
    value(values, reflectivity) = reflectivity_byte(echo.reflectance);
    value(values, photons) = photon_count(echo.amplitude, settings_.laser);
    value(values, amplitude) = echo.amplitude;
    value(values, width) = echo.width;
    value(values, cos_incidence) = echo.cos_incidence;
    value(values, radial_velocity) = echo.velocity;
    value(values, return_number) = echo.number;
    value(values, classification) = echo.classification;
    value(values, object) = echo.object;
    value(values, kind) = static_cast<double>(echo.kind);
  }

  void set_place(const Vec3& in_frame, detail::PointValues& values) const noexcept {
    using enum PointQuantity;
    const Vec3 at = in_axes(in_frame);
    set_vector(x, at, values);
    if (!angles_) return;
    value(values, azimuth) = std::atan2(at.y, at.x);
    value(values, elevation) = std::atan2(at.z, std::hypot(at.x, at.y));
  }

  void set_surface(const std::optional<SurfaceInteraction>& surface, const Pose<frame::World, frame::Instrument>& frame,
                   detail::PointValues& values) const noexcept {
    using enum PointQuantity;
    const double unknown = std::numeric_limits<double>::infinity();
    set_vector(normal_x, surface ? in_axes(frame.direction(surface->normal)) : Vec3{}, values);
    set_vector(velocity_x, surface ? in_axes(frame.direction(surface->velocity)) : Vec3{}, values);
    value(values, part) = surface ? surface->part : unknown;
    value(values, material) = surface ? surface->material_index : unknown;
  }

  static void set_colour(const std::optional<PointColour>& colour, detail::PointValues& values) noexcept {
    using enum PointQuantity;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto share = [&](std::uint16_t PointColour::*channel) {
      return colour ? (*colour).*channel / 65535.0 : unknown;
    };
    const auto byte = [&](double of_white) { return static_cast<std::uint32_t>(std::lround(255 * of_white)); };
    const double r = share(&PointColour::red), g = share(&PointColour::green), b = share(&PointColour::blue);
    const std::uint32_t packed = colour ? byte(r) << 16 | byte(g) << 8 | byte(b) : 0;
    value(values, red) = r;
    value(values, green) = g;
    value(values, blue) = b;
    value(values, near_infrared) = share(&PointColour::near_infrared);
    value(values, packed_rgb) = colour ? packed : unknown;
    value(values, packed_rgb_bits) = std::bit_cast<float>(packed);
  }

  static void set_vector(PointQuantity first, const Vec3& v, detail::PointValues& values) noexcept {
    double* const to = &value(values, first);
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }

  void store(const detail::PointValues& values, std::byte* record) const noexcept {
    for (const PointField& field : layout_.fields)
      store(field, values[static_cast<std::size_t>(field.quantity)], record);
  }
  static void store(const PointField& field, double value, std::byte* record) noexcept {
    detail::visit_field_type(
        field.type, [&]<class Number>() { detail::store_number<Number>(value * field.scale, record + field.offset); });
  }

  /// Finds the attributes of the layout's fields by their names.
  void find_attributes() {
    const std::vector<std::string>& names = settings_.attributes.names();
    for (std::size_t k = 0; k < layout_.fields.size(); ++k) {
      const PointField& field = layout_.fields[k];
      if (field.quantity != PointQuantity::attribute) continue;
      const auto found = std::find(names.begin(), names.end(), field.name);
      if (found == names.end())
        throw SettingError("PointSettings::attributes (number of names '" + field.name + "')", 0, "",
                           "1: the layout has such a field");
      attributes_.emplace_back(k, static_cast<std::size_t>(found - names.begin()));
    }
  }

  void store_attributes(std::span<const double> of_object, std::byte* record) const noexcept {
    for (const auto& [index, attribute] : attributes_) store(layout_.fields[index], of_object[attribute], record);
  }

  PointLayout layout_;
  PointSettings settings_;
  bool places_ = false, angles_ = false, surfaces_ = false, colours_ = false;  // true: in the layout
  std::vector<std::pair<std::size_t, std::size_t>> attributes_;                // index of a field, and of its attribute
  Tick start_{};
  Pose<frame::World, frame::Instrument> frame_{};  // of a scan without distortion
};

/// Point records in memory: a sink that keeps them, and gives them to the writers of files and messages. Once it has
/// grown to the longest scan, it allocates nothing.
class PointBuffer {
 public:
  /// @throws SettingError for a layout or settings out of range
  explicit PointBuffer(PointLayout layout, PointSettings settings = {})
      : encoder_(std::move(layout), std::move(settings)) {}

  void operator()(const EchoBatch& batch) { encoder_.encode(batch, records_); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< as the concept ChoosesShots describes

  /// Drops all points, and sets the start of the next scan.
  void begin_scan(Tick start) {
    records_.clear();
    encoder_.begin_scan(start);
  }

  [[nodiscard]] std::size_t size() const noexcept { return records_.size() / layout().size; }
  /// Records, one after another.
  [[nodiscard]] std::span<const std::byte> records() const noexcept { return records_; }
  [[nodiscard]] const PointLayout& layout() const noexcept { return encoder_.layout(); }  ///< layout of the records
  [[nodiscard]] const PointSettings& settings() const noexcept { return encoder_.settings(); }
  [[nodiscard]] Tick scan_start() const noexcept { return encoder_.scan_start(); }  ///< start of the scan

  /// Number in a field of this layout of a point, as it is stored.
  [[nodiscard]] double number(std::size_t point, const PointField& field) const noexcept {
    const std::byte* const from = records_.data() + point * layout().size + field.offset;
    return detail::visit_field_type(field.type, [&]<class Number>() { return detail::load_number<Number>(from); });
  }

 private:
  PointEncoder encoder_;
  std::vector<std::byte> records_;
};
static_assert(EchoSink<PointBuffer>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
