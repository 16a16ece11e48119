// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_COLUMNS_HPP
#define PULSECAST_IO_POINT_COLUMNS_HPP

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>

/// Table of all columns that a point can have, for every format of points, Python and the page.
namespace PULSECAST_NAMESPACE::io {

/// Number type of a column or field. Values up to float64 are those of sensor_msgs/PointField.
enum class NumberType { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64, int64, uint64 };

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

/// Settings of points: their frame, and what columns read besides pulse and echo.
struct PointSettings {
  /// Pose of the sensor, for points in its frame: see `Platform::instrument_at`; empty: world
  std::function<Pose<frame::Instrument, frame::World>(Tick)> sensor{};
  MotionDistortion distortion = MotionDistortion::kept;  ///< of points in the sensor's frame
  PointAxes axes = PointAxes::right_forward_up;          ///< axes of the coordinates
  Vec3 origin{};                                         ///< place of coordinates 0 in the world [m]
  std::vector<std::uint16_t> rings{};                    ///< see `SpinningSensor::rings`; empty: channel
  double start_time = 0;                                 ///< clock time at tick 0 [s]
  std::vector<Laser> lasers{};     ///< of each channel, the last of all further ones; empty: default
  double power_reference = 1e-9;   ///< power of 0 dB of intensity_level [W]
  SurfaceQuery surfaces{};         ///< of echoes, see `surfaces_of`; empty: unknown
  PointColours colours{};          ///< of echoes, see `colours_of`; empty: unknown
  UncertaintyQuery uncertainty{};  ///< of echoes, see `uncertainty_of`; empty: unknown
  ObjectAttributes attributes{};   ///< attributes of objects

  void validate() const {
    require_finite("PointSettings::origin (length)", length(origin), "m");
    require_finite("PointSettings::start_time", start_time, "s");
    require_positive("PointSettings::power_reference", power_reference, "W");
    for (const Laser& laser : lasers) laser.validate();
  }
};

/// Settings of the points of a scene, which must outlive them: surfaces and colours, by one more
/// ray per echo each where a column needs them, and attributes of its parts. @throws SettingError
template <SceneQueries World>
[[nodiscard]] PointSettings points_of(const World& world) {
  const ObjectAttributes attributes(world.parts());
  return {.surfaces = surfaces_of(world), .colours = colours_of(world), .attributes = attributes};
}

/// Reflectance as instruments encode it in a byte: percents up to white, then 10 a doubling, up to
/// 255. Source: Velodyne, VLP-16 user manual 63-9243 rev. D, 6.1, but for the unpublished doubling.
[[nodiscard]] inline double reflectivity_byte(double reflectance) noexcept {
  if (!(reflectance > 0)) return 0;
  return std::min(255.0, reflectance <= 1 ? 100 * reflectance : 100 + 10 * std::log2(reflectance));
}

/// Photons that a power [W] brings in a laser's pulse length.
[[nodiscard]] inline double photon_count(double power, const Laser& laser) noexcept {
  return power * laser.pulse_length * laser.wavelength / (planck_constant * speed_of_light);
}

/// Surface of an echo, as columns read it.
struct PointSurface {
  SurfaceInteraction interaction{};  ///< surface in the world
  Vec3 normal{};                     ///< unit normal, in the axes of the points
  Vec3 velocity{};                   ///< velocity in the world, in the axes of the points [m/s]
};

/// Point of an echo, as columns read it. What no column of a layout needs is empty.
struct PointView {
  const Shot& shot;                               ///< pulse of the echo
  const Echo& echo;                               ///< echo
  const PointSettings& settings;                  ///< settings of the points
  const Tick& scan_start;                         ///< start of the scan
  Vec3 position{};                                ///< position in the frame and axes of the points [m]
  const PointSurface* surface = nullptr;          ///< surface; null if unknown
  const PointColour* colour = nullptr;            ///< colour; null if unknown
  const double* attributes = nullptr;             ///< attributes of the object, in order of their names
  const PointUncertainty* uncertainty = nullptr;  ///< uncertainty, in the axes of the points; null if unknown
};

/// Part of a point that a column needs besides pulse and echo.
enum class PointNeed : std::uint8_t {
  nothing,     ///< pulse and echo suffice
  position,    ///< position in the frame and axes of the points
  surface,     ///< surface, by `PointSettings::surfaces`
  colour,      ///< colour, by `PointSettings::colours`
  attribute,   ///< attribute of the object, by `PointSettings::attributes`
  uncertainty  ///< uncertainty, by `PointSettings::uncertainty`
};

/// Column of a point.
struct PointColumn {
  std::string_view name;                                   ///< name, as in Python
  std::string_view unit;                                   ///< SI symbol; empty for a pure number
  NumberType type;                                         ///< number type that suits it
  double (*get)(const PointView&) noexcept;                ///< value in its unit; NaN if unknown
  std::string_view description;                            ///< meaning, in a few words
  PointNeed needs = PointNeed::nothing;                    ///< what it reads besides pulse and echo
  std::uint64_t (*whole)(const PointView&) noexcept = {};  ///< value of a whole number, exact
};

namespace detail {

/// Level of a ratio of powers [dB]; -200 or more, also for zero.
inline double level_of(double ratio) noexcept { return ratio > 1e-20 ? 10 * std::log10(ratio) : -200.0; }

using View = const PointView&;
template <class T>
constexpr T value_of(View p, T Echo::*member) noexcept {
  return p.echo.*member;
}
template <class T>
constexpr T value_of(View p, T Shot::*member) noexcept {
  return p.shot.*member;
}
/// Column of a member of `Echo` or `Shot`. Whole numbers are exact.
template <auto Member>
constexpr PointColumn member(std::string_view name, std::string_view unit, NumberType type,
                             std::string_view description) noexcept {
  const auto get = [](View p) noexcept { return static_cast<double>(value_of(p, Member)); };
  PointColumn column{name, unit, type, get, description};
  if constexpr (!std::is_floating_point_v<decltype(value_of(std::declval<View>(), Member))>)
    column.whole = [](View p) noexcept { return static_cast<std::uint64_t>(value_of(p, Member)); };
  return column;
}
template <int Axis>
double of_position(View p) noexcept {
  return p.position[Axis];
}
template <auto Vector, int Axis>
double of_surface(View p) noexcept {
  return p.surface ? (p.surface->*Vector)[Axis] : 0;
}
template <auto Channel>
double of_colour(View p) noexcept {
  return p.colour ? (*p.colour).*Channel : std::numeric_limits<double>::quiet_NaN();
}
template <auto Element, bool systematic = false>
double of_uncertainty(View p) noexcept {
  if (!p.uncertainty) return std::numeric_limits<double>::quiet_NaN();
  return p.uncertainty->systematic.*Element + (systematic ? 0 : p.uncertainty->random.*Element);
}
/// Column of an element of a covariance, of the whole error or of its systematic part.
template <auto Element, bool systematic = false>
constexpr PointColumn covariance(std::string_view name) noexcept {
  return {name,
          "m^2",
          NumberType::float32,
          of_uncertainty<Element, systematic>,
          systematic ? "of what neighbours share" : "of the place",
          PointNeed::uncertainty};
}
inline std::uint64_t uncertainty_flags_of(View p) noexcept { return p.uncertainty ? p.uncertainty->flags : 255; }
template <auto Index>
double of_scene(View p) noexcept {
  return p.surface ? p.surface->interaction.*Index : std::numeric_limits<double>::infinity();
}
inline double scan_time(View p) noexcept {
  const Tick &tick = p.shot.tick, &start = p.scan_start;
  return static_cast<double>(tick.second - start.second) + (tick.fraction - start.fraction);
}
inline double clock_time(View p) noexcept {
  return (p.settings.start_time + static_cast<double>(p.shot.tick.second)) + p.shot.tick.fraction;
}
inline double ring_of(View p) noexcept {
  const auto& rings = p.settings.rings;
  return p.shot.channel < rings.size() ? rings[p.shot.channel] : p.shot.channel;
}
inline double incidence_of(View p) noexcept { return std::acos(std::clamp(p.echo.cos_incidence, -1.0, 1.0)); }
inline double azimuth_of(View p) noexcept { return std::atan2(p.position.y, p.position.x); }
inline double elevation_of(View p) noexcept { return std::atan2(p.position.z, std::hypot(p.position.x, p.position.y)); }
inline double reflectivity_of(View p) noexcept { return reflectivity_byte(p.echo.reflectance); }
inline double photons_of(View p) noexcept {
  const std::vector<Laser>& lasers = p.settings.lasers;
  const Laser usual{};
  return photon_count(p.echo.amplitude,
                      lasers.empty() ? usual : lasers[std::min<std::size_t>(p.shot.channel, lasers.size() - 1)]);
}
inline double intensity_level_of(View p) noexcept { return level_of(p.echo.amplitude / p.settings.power_reference); }
inline double reflectance_level_of(View p) noexcept { return level_of(p.echo.reflectance); }
inline double rgb_of(View p) noexcept {
  if (!p.colour) return std::numeric_limits<double>::quiet_NaN();
  const auto byte = [](std::uint16_t channel) { return (channel + 128U) / 257U; };  // to nearest
  return byte(p.colour->red) << 16 | byte(p.colour->green) << 8 | byte(p.colour->blue);
}
inline double rgb_bits_of(View p) noexcept {
  return p.colour ? std::bit_cast<float>(static_cast<std::uint32_t>(rgb_of(p))) : 0;
}
}  // namespace detail

/// Columns of a point, a row each.
inline constexpr std::array point_columns = [] {
  using namespace detail;
  using enum NumberType;
  using enum PointNeed;
  using Rgb = PointColour;
  constexpr auto normal = &PointSurface::normal, velocity = &PointSurface::velocity;
  constexpr auto part = &SurfaceInteraction::part;
  constexpr auto material = &SurfaceInteraction::material_index;
  return std::array{
      PointColumn{"x", "m", float64, of_position<0>, "coordinate along x", position},
      PointColumn{"y", "m", float64, of_position<1>, "coordinate along y", position},
      PointColumn{"z", "m", float64, of_position<2>, "coordinate along z", position},
      PointColumn{"time", "s", float64, scan_time, "emission since the start"},
      member<&Echo::range>("range", "m", float64, "range along the pulse's axis"),
      member<&Echo::amplitude>("intensity", "W", float32, "received power at the peak"),
      member<&Echo::reflectance>("reflectance", "", float32, "relative to a white target"),
      member<&Echo::width>("echo_width", "s", float32, "standard deviation in time"),
      member<&Echo::cos_incidence>("cos_incidence", "", float32, "cosine of incidence"),
      member<&Shot::index>("pulse", "", int64, "number of the pulse, from 0"),
      member<&Echo::object>("object", "", uint32, "number of the object"),
      member<&Echo::classification>("classification", "", uint16, "class of the surface"),
      member<&Shot::leg>("leg", "", uint16, "number of the leg, from 0"),
      member<&Echo::number>("return_number", "", uint8, "return number, from 1"),
      member<&Shot::echoes>("number_of_returns", "", uint8, "returns of the pulse"),
      member<&Shot::channel>("channel", "", uint16, "number of the emitter, from 0"),
      member<&Echo::kind>("kind", "", uint8, "way of the light, 0: direct"),
      PointColumn{"red", "", uint16, of_colour<&Rgb::red>, "red, up to 65535", colour},
      PointColumn{"green", "", uint16, of_colour<&Rgb::green>, "green, up to 65535", colour},
      PointColumn{"blue", "", uint16, of_colour<&Rgb::blue>, "blue, up to 65535", colour},
      PointColumn{"near_infrared", "", uint16, of_colour<&Rgb::near_infrared>, "near infrared, up to 65535", colour},
      PointColumn{"rgb", "", uint32, rgb_of, "65536 red + 256 green + blue", colour},
      PointColumn{"rgb_bits", "", float32, rgb_bits_of, "rgb as the bits of a float", colour},
      PointColumn{"clock", "s", float64, clock_time, "emission by the clock"},
      PointColumn{"ring", "", uint16, ring_of, "number of the laser, by rings"},
      member<&Shot::scan_angle>("scan_angle", "rad", float32, "right of the vertical"),
      PointColumn{"azimuth", "rad", float64, azimuth_of, "angle from x to y", position},
      PointColumn{"elevation", "rad", float64, elevation_of, "angle above x and y", position},
      PointColumn{"incidence", "rad", float32, incidence_of, "angle of incidence"},
      member<&Echo::velocity>("radial_velocity", "m/s", float32, "positive away"),
      PointColumn{"reflectivity", "", uint8, reflectivity_of, "reflectance as a byte"},
      PointColumn{"photons", "", float32, photons_of, "photons in a pulse length"},
      PointColumn{"intensity_level", "dB", float32, intensity_level_of, "power at the peak"},
      PointColumn{"reflectance_level", "dB", float32, reflectance_level_of, "relative to white"},
      PointColumn{"normal_x", "", float32, of_surface<normal, 0>, "normal, 0 if unknown", surface},
      PointColumn{"normal_y", "", float32, of_surface<normal, 1>, "normal, 0 if unknown", surface},
      PointColumn{"normal_z", "", float32, of_surface<normal, 2>, "normal, 0 if unknown", surface},
      PointColumn{"velocity_x", "m/s", float32, of_surface<velocity, 0>, "velocity of surface", surface},
      PointColumn{"velocity_y", "m/s", float32, of_surface<velocity, 1>, "velocity of surface", surface},
      PointColumn{"velocity_z", "m/s", float32, of_surface<velocity, 2>, "velocity of surface", surface},
      PointColumn{"part", "", uint32, of_scene<part>, "part; largest if unknown", surface},
      PointColumn{"material", "", uint16, of_scene<material>, "material; largest if unknown", surface},
      covariance<&Covariance::xx>("variance_x"),
      covariance<&Covariance::yy>("variance_y"),
      covariance<&Covariance::zz>("variance_z"),
      covariance<&Covariance::xy>("covariance_xy"),
      covariance<&Covariance::xz>("covariance_xz"),
      covariance<&Covariance::yz>("covariance_yz"),
      covariance<&Covariance::xx, true>("systematic_variance_x"),
      covariance<&Covariance::yy, true>("systematic_variance_y"),
      covariance<&Covariance::zz, true>("systematic_variance_z"),
      covariance<&Covariance::xy, true>("systematic_covariance_xy"),
      covariance<&Covariance::xz, true>("systematic_covariance_xz"),
      covariance<&Covariance::yz, true>("systematic_covariance_yz"),
      PointColumn{"uncertainty_flags", "", uint8,
                  [](View p) noexcept { return static_cast<double>(uncertainty_flags_of(p)); },
                  "0: error as stated; or 255", PointNeed::uncertainty, uncertainty_flags_of}};
}();

/// Columns of points by default in Python, read from pulse and echo alone: those up to `kind`.
inline constexpr std::span<const PointColumn> usual_point_columns(point_columns.data(), 17);
static_assert(usual_point_columns.back().name == "kind");

/// Column of the attribute of the object with the name of the field. NaN if it has none.
inline constexpr PointColumn attribute_column{
    "", "", NumberType::float64, nullptr, "attribute of the object met", PointNeed::attribute};
/// Column of a field that is not simulated: 0.
inline constexpr PointColumn absent_column{"", "", NumberType::float64, [](const PointView&) noexcept { return 0.0; },
                                           "not simulated"};

namespace detail {

/// Column of a name; null if there is none.
[[nodiscard]] constexpr const PointColumn* column_or_null(std::string_view name) noexcept {
  for (const PointColumn& each : point_columns)
    if (each.name == name) return &each;
  return nullptr;
}
inline void no_point_column_has_this_name() {}  // not constexpr: does not compile in `column`

}  // namespace detail

/// Column of a name, as in `column("range")`. A name that no column has does not compile.
[[nodiscard]] consteval const PointColumn* column(std::string_view name) {
  const PointColumn* const found = detail::column_or_null(name);
  if (!found) detail::no_point_column_has_this_name();
  return found;
}

/// Column of a name. @throws SettingError for a name that no column has
[[nodiscard]] inline const PointColumn& find_column(std::string_view name) {
  if (const PointColumn* const found = detail::column_or_null(name)) return *found;
  std::vector<std::string> names;
  for (const PointColumn& each : point_columns) names.emplace_back(each.name);
  throw SettingError(text::joined({"column '", name, "'"}),
                     text::joined({" is not known", text::suggestion(name, names)}));
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
