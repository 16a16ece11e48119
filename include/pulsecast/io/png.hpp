// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PNG_HPP
#define PULSECAST_IO_PNG_HPP

#include <stb/stb_image_write.h>

#include <pulsecast/io/detail/png/camera.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Canvas of points as discs, with depth buffer and shading by the relief of the depth; of twice
/// the picture's resolution. `ground`, in shades of grey, is seen where there is no point.
class Canvas {
 public:
  Canvas(const ImageSettings& s, std::span<const ImagePoint> points, std::span<const ImagePoint> ground)
      : settings_(s), points_(points), camera_(s, points.empty() ? ground : points) {
    nearest_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    if (!ground.empty()) {
      draw(ground, 1.5 * closing_diameter(ground));  // by eye: closed on slopes, too
      behind_.assign(nearest_.size(), 0);
      for (std::size_t i = 0; i < nearest_.size(); ++i)
        if (depth_[i] != nothing) behind_[i] = static_cast<std::uint8_t>(ground[nearest_[i]].value);
    }
    draw(points, s.point_size > 0 ? s.point_size : closing_diameter(points));
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
            sum += depth_[i] == nothing ? behind(i, background) : colours[nearest_[i]] * light(x + dx, y + dy);
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

  /// Colour of the ground, or the background without.
  [[nodiscard]] Colour behind(std::size_t i, const Colour& background) const {
    const std::uint8_t shade = behind_.empty() ? std::uint8_t{0} : behind_[i];
    return shade == 0 ? background : from_srgb({shade, shade, shade});
  }

  /// Diameter of discs that just touch in mid-scene: root of the covered area per point [px].
  [[nodiscard]] double closing_diameter(std::span<const ImagePoint> all) const {
    constexpr int cell = 4;  // follows an outline, and appears closed [px]
    const int columns = settings_.width / cell + 1, rows = settings_.height / cell + 1;
    std::vector<bool> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    std::size_t cells = 0, points = 0;
    for (const ImagePoint& point : all) {
      const Vec3 p = camera_.pixel(point);
      if (!(p.x >= 0 && p.x < settings_.width && p.y >= 0 && p.y < settings_.height)) continue;
      const std::size_t i = static_cast<std::size_t>(p.y / cell) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(p.x / cell);
      cells += !taken[i];
      taken[i] = true;
      ++points;
    }
    const auto share = static_cast<double>(cells) / static_cast<double>(std::max<std::size_t>(points, 1));
    const double spacing = cell * std::sqrt(share);
    return std::clamp(2.2 * spacing, 1.2, 8.0);  // by eye
  }

  /// Draws points on an empty canvas.
  void draw(std::span<const ImagePoint> all, double diameter) {
    depth_.assign(nearest_.size(), nothing);
    for (std::size_t i = 0; i < all.size(); ++i) draw(all[i], static_cast<std::uint32_t>(i), diameter);
  }

  void draw(const ImagePoint& point, std::uint32_t i, double diameter) {
    const Vec3 p = camera_.pixel(point) * Vec3{2, 2, 1};
    if (!(p.x > -max_disc && p.x < width_ + max_disc && p.y > -max_disc && p.y < height_ + max_disc)) return;
    const double radius = std::clamp(diameter * camera_.magnification(p.z), 0.75, max_disc);
    const auto first = [](double low) { return std::max(0, static_cast<int>(std::ceil(low - 0.5))); };
    const auto last = [](double high, int size) {
      return std::min(size - 1, static_cast<int>(std::floor(high - 0.5)));
    };
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

  /// Brightness of a pixel: light from the upper left, darker behind the surroundings. Source: the
  /// idea of Luft, Colditz & Deussen 2006, unsharp masking of the depth buffer; amounts by eye.
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
    for (const ImagePoint& p : points_) colours.push_back(colour(p, low, range));
    return colours;
  }

  [[nodiscard]] Colour colour(const ImagePoint& p, double low, double range) const {
    switch (settings_.colour_by) {
      case ColourBy::height:
        return along(viridis, (p.z - low) / range);
      case ColourBy::intensity:
        return along(greys, (p.value - low) / range);
      case ColourBy::object:
        return of_hue(p.value);
      case ColourBy::classification:
        return from_srgb(of_class(static_cast<std::uint16_t>(p.value)));
      case ColourBy::return_number:
        return from_srgb(okabe_ito[static_cast<std::size_t>(std::max(p.value, 1.0f) - 1) % okabe_ito.size()]);
      case ColourBy::kind:
        break;
    }
    return from_srgb(kind_colours[static_cast<std::size_t>(p.value)]);
  }

  ImageSettings settings_;
  std::span<const ImagePoint> points_;
  Camera camera_;
  int width_ = 2 * settings_.width, height_ = 2 * settings_.height;
  std::vector<float> depth_;            // along the view [m]
  std::vector<std::uint32_t> nearest_;  // index of the point
  std::vector<std::uint8_t> behind_;    // shade of the ground, 0 without
};

}  // namespace detail

/// Sink that draws a preview of the cloud as a PNG, framed automatically, of a bounded number of
/// points. It depends on echoes and settings only. Points that are not finite are skipped.
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
        points_.push_back(image_point(point, value(echo)));
        if (points_.size() >= settings_.points_max) thin();
      }
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Draws a raster behind the points, in shades of grey from 1 to 255, see `hillshade`, at some
  /// million places; none beside a pixel of shade 0. Without points it frames the picture. @throws
  /// SettingError for another number of shades, or an invalid raster or placement
  void add_ground(const Raster& raster, std::span<const std::uint8_t> shades, const Placement& placement = {}) {
    raster.validate();
    placement.validate();
    const auto pixels = static_cast<double>(raster.pixels());
    const auto count = static_cast<double>(shades.size());
    require_within("ImageWriter::add_ground (number of shades)", count, pixels, pixels, "");
    const double density = std::sqrt(1e6 / pixels);  // places by pixel, along a row or column
    const auto places = [&](std::uint32_t of) { return static_cast<std::uint32_t>(std::ceil((of - 1) * density)) + 1; };
    const std::uint32_t columns = places(raster.columns), rows = places(raster.rows);
    raster.read([&](const auto& heights) {
      for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
          add_ground(raster.grid(), heights, shades, placement, (raster.columns - 1.0) * column / (columns - 1),
                     (raster.rows - 1.0) * row / (rows - 1));
    });
  }

  /// Draws and writes the picture; the file does not exist before. @throws FileError
  void close() {
    ImageSettings settings = settings_;
    if (settings.eye) *settings.eye -= origin_.value_or(Vec3{});
    const std::vector<Srgb> pixels = detail::Canvas(settings, points_, ground_).picture();
    std::vector<std::byte> png;
    const auto append = [](void* to, void* data, int size) {
      const auto* bytes = static_cast<const std::byte*>(data);
      auto& all = *static_cast<std::vector<std::byte>*>(to);
      all.insert(all.end(), bytes, bytes + size);
    };
    if (stbi_write_png_to_func(append, &png, settings_.width, settings_.height, 3, pixels.data(),
                               3 * settings_.width) == 0)
      throw FileError(file_.path().string(), "", "the picture cannot be compressed: expected enough memory");
    file_.write(png);
    file_.commit();
  }

 private:
  [[nodiscard]] detail::ImagePoint image_point(const Vec3& point, float value) {
    if (!origin_) origin_ = point;
    const Vec3 p = point - *origin_;
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), value};
  }

  /// Adds a place of a raster, in columns and rows from its first pixel.
  template <class Heights>
  void add_ground(const pulsecast::detail::RasterGrid& grid, const Heights& heights,
                  std::span<const std::uint8_t> shades, const Placement& placement, double column, double row) {
    const auto c = std::min(static_cast<std::uint32_t>(column), grid.columns - 2),
               r = std::min(static_cast<std::uint32_t>(row), grid.rows - 2);
    double height = 0, shade = 0;
    for (const std::uint32_t south : {0U, 1U})
      for (const std::uint32_t east : {0U, 1U}) {
        const std::size_t i = grid.index(c + east, r + south);
        const double by_column = east == 1 ? column - c : 1 - (column - c);
        const double weight = by_column * (south == 1 ? row - r : 1 - (row - r));
        if (shades[i] == 0) return;
        height += weight * static_cast<double>(heights[i]);
        shade += weight * shades[i];
      }
    const Vec3 in_raster{grid.first.x + column * grid.pixel.x, grid.first.y - row * grid.pixel.y, height};
    const Vec3 point = placement.point(in_raster);
    if (!finite(point)) return;
    ground_.push_back(image_point(point, static_cast<float>(std::lround(shade))));
    if (ground_.size() >= settings_.points_max) drop_every_other(ground_);
  }

  [[nodiscard]] float value(const Echo& echo) const {
    switch (settings_.colour_by) {
      case ColourBy::intensity:
        return static_cast<float>(echo.reflectance);
      case ColourBy::classification:
        return echo.classification;
      case ColourBy::return_number:
        return echo.number;
      case ColourBy::kind:
        return static_cast<float>(echo.kind);
      // the golden ratio spreads the hues of consecutive numbers; 0, often the ground, is olive
      case ColourBy::object:
        return static_cast<float>(std::fmod(0.3 + echo.object * (std::numbers::phi - 1), 1.0));
      case ColourBy::height:
        break;
    }
    return 0;
  }

  /// Drops every other point, and halves the share of points kept from now on.
  void thin() {
    drop_every_other(points_);
    every_ *= 2;
  }

  static void drop_every_other(std::vector<detail::ImagePoint>& points) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) points[kept++] = points[i];
    points.resize(kept);
  }

  ImageSettings settings_;
  OutputFile file_;
  std::vector<detail::ImagePoint> points_, ground_;
  std::optional<Vec3> origin_{};  // of points and ground: the first of them [m]
  std::uint64_t seen_ = 0;        // number of points so far
  std::uint64_t every_ = 1;       // number of points for each one kept
};

static_assert(EchoSink<ImageWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
