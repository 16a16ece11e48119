// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PNG_CAMERA_HPP
#define PULSECAST_IO_DETAIL_PNG_CAMERA_HPP

#include <pulsecast/base/units.hpp>
#include <pulsecast/io/colour.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Meaning of a point's colour.
enum class ColourBy : std::uint8_t { height, intensity, object, classification, return_number, kind };

/// What fills a picture: all points, or, where they are one in a hundred or more, those of what stands on the ground.
enum class FrameOn : std::uint8_t { all, standing };

/// Settings of a picture.
struct ImageSettings {
  int width = 1600;                       ///< width of the picture [px]
  int height = 900;                       ///< height of the picture [px]
  double azimuth = radians(30);           ///< viewing direction, clockwise from north [rad]
  double elevation = radians(30);         ///< viewing direction below the horizon [rad]
  double field_of_view = radians(30);     ///< angle across the scene; 0: parallel projection [rad]
  std::optional<Vec3> eye{};              ///< place of the camera; default: frames the points [m]
  FrameOn frame_on = FrameOn::all;        ///< points that fill the picture, without an eye
  ColourBy colour_by = ColourBy::height;  ///< meaning of the colours
  double point_size = 0;                  ///< diameter in mid-scene; 0 to close the gaps [px]
  Srgb background{13, 17, 23};            ///< colour of the background
  std::size_t points_max = 3'000'000;     ///< maximum to draw; of more, every k-th

  void validate() const {
    require_within("ImageSettings::width", width, 1, 4096, "px");
    require_within("ImageSettings::height", height, 1, 4096, "px");
    require_angle("ImageSettings::azimuth", azimuth);
    require_within("ImageSettings::elevation", elevation, -pi / 2, pi / 2, "rad");
    require_within("ImageSettings::field_of_view", field_of_view, eye ? radians(1) : 0, radians(120), "rad");
    if (eye) require_finite("ImageSettings::eye (length)", length(*eye), "m");
    require_within("ImageSettings::point_size", point_size, 0, 64, "px");
    require_within("ImageSettings::points_max", points_max, 2, 1e8, "");
  }
};

}  // namespace PULSECAST_NAMESPACE::io

namespace PULSECAST_NAMESPACE::io::detail {

struct ImagePoint {
  float x, y, z;  ///< relative to a nearby origin [m]
  float value;    ///< quantity shown by the colour

  [[nodiscard]] Vec3 position() const noexcept { return {x, y, z}; }
};

/// Percentiles that leave `share` of all values below, and above; of a sample of many points.
[[nodiscard]] std::pair<double, double> percentiles(std::span<const ImagePoint> points, double share,
                                                    const auto& value) {
  constexpr std::size_t sample = 200'000;
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); i += points.size() / sample + 1)
    if (const double v = value(points[i]); std::isfinite(v)) values.push_back(v);
  if (values.empty()) return {0, 0};
  const auto at = [&](double s) {
    const auto place = values.begin() + std::lround(s * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  return {at(share), at(1 - share)};
}

/// Points that stand out of what is lowest in their cell of a grid of 64 by 64 over all, by 0.5 m and a quarter of the
/// cell: crowns, trunks, walls, masts, but no slopes. None if fewer than one in a hundred do.
[[nodiscard]] inline std::vector<ImagePoint> standing(std::span<const ImagePoint> points) {
  constexpr std::size_t cells = 64;
  const auto x = percentiles(points, 0.001, [](const ImagePoint& p) { return static_cast<double>(p.x); });
  const auto y = percentiles(points, 0.001, [](const ImagePoint& p) { return static_cast<double>(p.y); });
  const double size = std::max({x.second - x.first, y.second - y.first, 1e-3}) / cells;
  const auto cell = [&](const ImagePoint& p) {
    const auto along = [&](double offset) {
      return static_cast<std::size_t>(std::clamp(offset / size, 0.0, cells - 1.0));
    };
    return along(p.y - y.first) * cells + along(p.x - x.first);
  };
  std::vector<float> lowest(cells * cells, std::numeric_limits<float>::infinity());
  for (const ImagePoint& p : points) lowest[cell(p)] = std::min(lowest[cell(p)], p.z);
  std::vector<ImagePoint> out;
  for (const ImagePoint& p : points)
    if (p.z - lowest[cell(p)] > 0.5 + 0.25 * size) out.push_back(p);
  if (out.size() * 100 < points.size()) out.clear();
  return out;
}

/// Camera, framed so that the picture is full except for outliers, or at a given position.
class Camera {
 public:
  Camera(const ImageSettings& s, std::span<const ImagePoint> points)
      : parallel_(s.field_of_view == 0),
        right_(std::cos(s.azimuth), -std::sin(s.azimuth), 0),
        forward_(std::sin(s.azimuth) * std::cos(s.elevation), std::cos(s.azimuth) * std::cos(s.elevation),
                 -std::sin(s.elevation)),
        up_(cross(right_, forward_)) {
    const auto some = !s.eye && s.frame_on == FrameOn::standing ? standing(points) : std::vector<ImagePoint>();
    if (s.eye)
      stand(s, *s.eye);
    else
      some.empty() ? frame(s, points, 0.95) : frame(s, some, 0.8);  // with some of the ground around
  }

  /// Column and row from the upper left [px], and depth along the view [m]; NaN behind the camera.
  [[nodiscard]] Vec3 pixel(const ImagePoint& p) const {
    const Vec3 v = seen(p);
    return {shift_.x + scale_ * v.x, shift_.y - scale_ * v.y, v.z};
  }

  /// Size of a metre across the view at a depth [px/m].
  [[nodiscard]] double scale(double depth) const { return parallel_ ? scale_ : scale_ * distance_ / depth; }

  /// Magnification at a depth relative to the middle of the scene.
  [[nodiscard]] double magnification(double depth) const { return parallel_ ? 1 : distance_ / depth; }

 private:
  [[nodiscard]] Vec3 seen(const ImagePoint& p) const {
    const Vec3 v = p.position() - centre_;
    const double depth = distance_ + dot(v, forward_);
    const double m = depth > near_ ? magnification(depth) : std::numeric_limits<double>::quiet_NaN();
    return {m * dot(v, right_), m * dot(v, up_), depth};
  }

  void stand(const ImageSettings& s, const Vec3& eye) {
    distance_ = 10;  // distance of the set point size [m]
    near_ = 0.3;     // nearer points would fill the picture [m]
    centre_ = eye + distance_ * forward_;
    scale_ = 0.5 * s.width / (distance_ * std::tan(0.5 * s.field_of_view));
    shift_ = {0.5 * s.width, 0.5 * s.height};
  }

  void frame(const ImageSettings& s, std::span<const ImagePoint> points, double margin) {
    constexpr double outliers = 0.001;
    double radius = 1e-3;  // minimum, for a scene of one point [m]
    for (const Vec3& axis : {right_, forward_, up_}) {
      const auto along = [&](const ImagePoint& p) { return dot(axis, p.position()); };
      const auto [low, high] = percentiles(points, outliers, along);
      centre_ += axis * (0.5 * (low + high));
      radius = std::max(radius, 0.5 * (high - low));
    }
    distance_ = radius / std::tan(0.5 * (parallel_ ? radians(30) : s.field_of_view));
    const auto [x_low, x_high] = percentiles(points, outliers, [&](const auto& p) { return seen(p).x; });
    const auto [y_low, y_high] = percentiles(points, outliers, [&](const auto& p) { return seen(p).y; });
    scale_ = margin * std::min(s.width / std::max(x_high - x_low, 0.01 * radius),
                               s.height / std::max(y_high - y_low, 0.01 * radius));
    shift_ = {0.5 * s.width - scale_ * 0.5 * (x_low + x_high), 0.5 * s.height + scale_ * 0.5 * (y_low + y_high)};
  }

  bool parallel_;
  Vec3 right_, forward_, up_, centre_{};
  double distance_ = 0, near_ = 0, scale_ = 0;
  Vec2 shift_{};
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
