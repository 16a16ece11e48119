// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <stb/stb_image_write.h>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/io/colour.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

/// Meaning of a point's colour.
enum class ColourBy : std::uint8_t { height, intensity, object, classification, return_number };

/// Settings of a picture.
struct ImageSettings {
  int width = 1600;                ///< width of the picture [px]
  int height = 900;                ///< height of the picture [px]
  double azimuth = radians(30);    ///< viewing direction, clockwise from north [rad]
  double elevation = radians(30);  ///< viewing direction below the horizon; a quarter turn with azimuth 0 gives a map with north up [rad]
  double field_of_view = radians(30);  ///< angle across the scene, approximate; 0 for a parallel projection [rad]
  std::optional<Vec3> eye{};           ///< position of the camera, field of view across the width; if empty, chosen to frame all points [m]
  ColourBy colour_by = ColourBy::height;  ///< meaning of the colours
  double point_size = 0;                  ///< diameter in the middle of the scene; 0 to close the gaps [px]
  Srgb background{13, 17, 23};            ///< colour of the background
  std::size_t points_max = 3'000'000;     ///< maximum to draw; of more, every k-th

  void validate() const {
    require_within("ImageSettings::width", width, 1, 4096, "px");
    require_within("ImageSettings::height", height, 1, 4096, "px");
    require_finite("ImageSettings::azimuth", azimuth, "rad");
    require_within("ImageSettings::elevation", elevation, -pi / 2, pi / 2, "rad");
    require_within("ImageSettings::field_of_view", field_of_view, eye ? radians(1) : 0, radians(120), "rad");
    if (eye) require_finite("ImageSettings::eye (length)", length(*eye), "m");
    require_within("ImageSettings::point_size", point_size, 0, 64, "px");
    require_within("ImageSettings::points_max", static_cast<double>(points_max), 2, 1e8, "");
  }
};

namespace detail {

/// Point of a picture.
struct ImagePoint {
  float x, y, z;  ///< relative to a nearby origin [m]
  float value;    ///< quantity shown by the colour

  [[nodiscard]] Vec3 position() const noexcept { return {x, y, z}; }
};

/// Percentiles that leave `share` of all values below, and above; those of a sample for many points.
[[nodiscard]] std::pair<double, double> percentiles(std::span<const ImagePoint> points, double share, const auto& value) {
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

/// Camera, framed so that the picture is full except for outliers, or at a given position.
class Camera {
 public:
  Camera(const ImageSettings& s, std::span<const ImagePoint> points)
      : parallel_(s.field_of_view == 0),
        right_(std::cos(s.azimuth), -std::sin(s.azimuth), 0),
        forward_(std::sin(s.azimuth) * std::cos(s.elevation), std::cos(s.azimuth) * std::cos(s.elevation), -std::sin(s.elevation)),
        up_(cross(right_, forward_)) {
    s.eye ? stand(s, *s.eye) : frame(s, points);
  }

  /// Column and row from the upper left corner of the picture [px], and depth along the view [m]. NaN behind the camera.
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

  /// Places the camera at a given position.
  void stand(const ImageSettings& s, const Vec3& eye) {
    distance_ = 10;  // distance of the set point size [m]
    near_ = 0.3;     // nearer points would fill the picture [m]
    centre_ = eye + distance_ * forward_;
    scale_ = 0.5 * s.width / (distance_ * std::tan(0.5 * s.field_of_view));
    shift_ = {0.5 * s.width, 0.5 * s.height};
  }

  /// Places the camera so that the picture is full except for outliers.
  void frame(const ImageSettings& s, std::span<const ImagePoint> points) {
    constexpr double outliers = 0.001, margin = 0.95;
    double radius = 1e-3;  // minimum, for a scene of one point [m]
    for (const Vec3& axis : {right_, forward_, up_}) {
      const auto [low, high] = percentiles(points, outliers, [&](const ImagePoint& p) { return dot(axis, p.position()); });
      centre_ += axis * (0.5 * (low + high));
      radius = std::max(radius, 0.5 * (high - low));
    }
    distance_ = radius / std::tan(0.5 * (parallel_ ? radians(30) : s.field_of_view));
    const auto [x_low, x_high] = percentiles(points, outliers, [&](const ImagePoint& p) { return seen(p).x; });
    const auto [y_low, y_high] = percentiles(points, outliers, [&](const ImagePoint& p) { return seen(p).y; });
    scale_ = margin * std::min(s.width / std::max(x_high - x_low, 0.01 * radius), s.height / std::max(y_high - y_low, 0.01 * radius));
    shift_ = {0.5 * s.width - scale_ * 0.5 * (x_low + x_high), 0.5 * s.height + scale_ * 0.5 * (y_low + y_high)};
  }

  bool parallel_;
  Vec3 right_, forward_, up_, centre_{};
  double distance_ = 0, near_ = 0, scale_ = 0;
  Vec2 shift_{};
};

/// Canvas of points as discs, with depth buffer and shading by the relief of the depth; twice the picture's resolution, for smooth edges.
class Canvas {
 public:
  Canvas(const ImageSettings& s, std::span<const ImagePoint> points) : settings_(s), points_(points), camera_(s, points) {
    depth_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), nothing);
    nearest_.resize(depth_.size());
    const double diameter = s.point_size > 0 ? s.point_size : closing_diameter();
    for (std::size_t i = 0; i < points.size(); ++i) draw(static_cast<std::uint32_t>(i), diameter);
  }

  /// Pixels of the picture, row by row from the top.
  [[nodiscard]] std::vector<Srgb> picture() const {
    const std::vector<Colour> colours = point_colours();
    const Colour background = from_srgb(settings_.background);
    std::vector<Srgb> pixels;
    pixels.reserve(depth_.size() / 4);
    for (int y = 0; y < height_; y += 2)
      for (int x = 0; x < width_; x += 2) {
        Colour sum{};
        for (const int dy : {0, 1})
          for (const int dx : {0, 1}) {
            const std::size_t i = index(x + dx, y + dy);
            sum += depth_[i] == nothing ? background : colours[nearest_[i]] * light(x + dx, y + dy);
          }
        pixels.push_back(to_srgb(sum * 0.25));
      }
    return pixels;
  }

 private:
  static constexpr float nothing = std::numeric_limits<float>::infinity();
  static constexpr double max_disc = 64;  // radius of a disc, in pixels of the canvas

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  /// Diameter at which discs in the middle of the scene just touch: square root of the covered area per point [px].
  [[nodiscard]] double closing_diameter() const {
    constexpr int cell = 4;  // small enough to follow an outline, large enough for a closed appearance [px]
    const int columns = settings_.width / cell + 1, rows = settings_.height / cell + 1;
    std::vector<bool> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    std::size_t cells = 0, points = 0;
    for (const ImagePoint& point : points_) {
      const Vec3 p = camera_.pixel(point);
      if (!(p.x >= 0 && p.x < settings_.width && p.y >= 0 && p.y < settings_.height)) continue;
      const std::size_t i = static_cast<std::size_t>(p.y / cell) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(p.x / cell);
      cells += !taken[i];
      taken[i] = true;
      ++points;
    }
    const double spacing = cell * std::sqrt(static_cast<double>(cells) / static_cast<double>(std::max<std::size_t>(points, 1)));
    return std::clamp(2.2 * spacing, 1.2, 8.0);  // by eye
  }

  void draw(std::uint32_t i, double diameter) {
    const Vec3 p = camera_.pixel(points_[i]) * Vec3{2, 2, 1};
    if (!(p.x > -max_disc && p.x < width_ + max_disc && p.y > -max_disc && p.y < height_ + max_disc)) return;
    const double radius = std::clamp(diameter * camera_.magnification(p.z), 0.75, max_disc);
    const auto first = [](double low) { return std::max(0, static_cast<int>(std::ceil(low - 0.5))); };
    const auto last = [](double high, int size) { return std::min(size - 1, static_cast<int>(std::floor(high - 0.5))); };
    const float depth = static_cast<float>(p.z);
    for (int y = first(p.y - radius); y <= last(p.y + radius, height_); ++y)
      for (int x = first(p.x - radius); x <= last(p.x + radius, width_); ++x) {
        const double dx = x + 0.5 - p.x, dy = y + 0.5 - p.y;
        if (dx * dx + dy * dy > radius * radius || !(depth < depth_[index(x, y)])) continue;
        depth_[index(x, y)] = depth;
        nearest_[index(x, y)] = i;
      }
  }

  /// Depth at a pixel; empty without a point.
  [[nodiscard]] std::optional<double> depth(int x, int y) const {
    if (x < 0 || x >= width_ || y < 0 || y >= height_ || depth_[index(x, y)] == nothing) return std::nullopt;
    return depth_[index(x, y)];
  }

  /// Brightness of a pixel: shading by a light from the upper left, darker where it lies behind its surroundings.
  /// Source: the idea of Luft, Colditz & Deussen 2006, unsharp masking of the depth buffer; amounts by eye.
  [[nodiscard]] double light(int x, int y) const {
    const double here = depth_[index(x, y)];
    const double pixel = 0.5 / camera_.scale(here);  // size of a canvas pixel at this depth [m]
    double relief = 0;
    constexpr std::array<int, 3> reaches{2, 6, 16};
    for (const int r : reaches)
      for (const auto& [dx, dy] : {std::pair{r, 0}, {0, r}, {r * 7 / 10, r * 7 / 10}, {r * 7 / 10, -r * 7 / 10}}) {
        const double mean = 0.5 * (depth(x + dx, y + dy).value_or(here) + depth(x - dx, y - dy).value_or(here));
        relief += std::clamp((here - mean) / (r * pixel), -1.0, 1.0) / (4 * reaches.size());
      }
    const auto slope = [&](int dx, int dy) {
      const double change = depth(x + dx, y + dy).value_or(here) - depth(x - dx, y - dy).value_or(here);
      return std::clamp(change / (2 * std::max(dx, dy) * pixel), -4.0, 4.0);
    };
    const Vec3 normal = normalize(Vec3{slope(5, 0), -slope(0, 5), -1});  // right, up, away
    const double turned = std::max(0.0, dot(normal, normalize(Vec3{-0.5, 0.7, -0.6})));
    return (0.5 + 0.6 * turned) * (relief > 0 ? std::exp(-3.0 * relief) : 1 - 0.4 * relief);
  }

  [[nodiscard]] std::vector<Colour> point_colours() const {
    const auto by_height = [](const ImagePoint& p) { return static_cast<double>(p.z); };
    const auto by_value = [](const ImagePoint& p) { return static_cast<double>(p.value); };
    const bool height = settings_.colour_by == ColourBy::height;
    const auto [low, high] = height ? percentiles(points_, 0.005, by_height) : percentiles(points_, 0.02, by_value);
    const double range = std::max(high - low, 1e-9);
    std::vector<Colour> colours;
    colours.reserve(points_.size());
    for (const ImagePoint& p : points_) switch (settings_.colour_by) {
        case ColourBy::height:
          colours.push_back(along(viridis, (p.z - low) / range));
          break;
        case ColourBy::intensity:
          colours.push_back(along(greys, (p.value - low) / range));
          break;
        case ColourBy::object:
          colours.push_back(of_hue(p.value));
          break;
        case ColourBy::classification:
          colours.push_back(from_srgb(of_class(static_cast<std::uint16_t>(p.value))));
          break;
        case ColourBy::return_number:
          colours.push_back(from_srgb(okabe_ito[static_cast<std::size_t>(std::max(p.value, 1.0f) - 1) % okabe_ito.size()]));
      }
    return colours;
  }

  ImageSettings settings_;
  std::span<const ImagePoint> points_;
  Camera camera_;
  int width_ = 2 * settings_.width, height_ = 2 * settings_.height;
  std::vector<float> depth_;            // along the view [m]
  std::vector<std::uint32_t> nearest_;  // index of the point
};

}  // namespace detail

/// Sink that draws a preview of the cloud as a PNG, with automatic framing and a bounded number of points. The picture depends on the
/// echoes and the settings only. Points that are not finite are skipped; without points it is empty.
class ImageWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit ImageWriter(std::filesystem::path path, const ImageSettings& settings = {})
      : settings_(validated(settings)), file_(std::move(path)) {}

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const Vec3 point = point_of(shot, echo);
        if (!finite(point) || seen_++ % every_ != 0) continue;
        if (points_.empty()) origin_ = point;
        const Vec3 p = point - origin_;
        points_.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), value(echo)});
        if (points_.size() >= settings_.points_max) thin();
      }
  }

  /// Draws and writes the picture; the file does not exist before. Throws a `FileError`.
  void close() {
    ImageSettings settings = settings_;
    if (settings.eye) *settings.eye -= origin_;
    const std::vector<Srgb> pixels = detail::Canvas(settings, points_).picture();
    std::vector<std::byte> png;
    const auto append = [](void* to, void* data, int size) {
      const auto* bytes = static_cast<const std::byte*>(data);
      static_cast<std::vector<std::byte>*>(to)->insert(static_cast<std::vector<std::byte>*>(to)->end(), bytes, bytes + size);
    };
    if (stbi_write_png_to_func(append, &png, settings_.width, settings_.height, 3, pixels.data(), 3 * settings_.width) == 0)
      throw FileError(file_.path().string(), "", "the picture cannot be compressed: expected enough memory");
    file_.write(png);
    file_.commit();
  }

 private:
  [[nodiscard]] float value(const Echo& echo) const {
    switch (settings_.colour_by) {
      case ColourBy::intensity:
        return static_cast<float>(echo.reflectance);
      case ColourBy::classification:
        return echo.classification;
      case ColourBy::return_number:
        return echo.number;
      // the golden ratio spreads the hues of consecutive numbers; 0 is olive, as it often is the ground
      case ColourBy::object:
        return static_cast<float>(std::fmod(0.3 + echo.object * (std::numbers::phi - 1), 1.0));
      case ColourBy::height:
        break;
    }
    return 0;
  }

  /// Drops every other point, and halves the share of points kept from now on.
  void thin() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
    points_.resize(kept);
    every_ *= 2;
  }

  ImageSettings settings_;
  OutputFile file_;
  std::vector<detail::ImagePoint> points_;
  Vec3 origin_{};            // of the points: the first of them [m]
  std::uint64_t seen_ = 0;   // number of points so far
  std::uint64_t every_ = 1;  // number of points for each one kept
};

static_assert(EchoSink<ImageWriter>);

}  // namespace pulsecast::io
