// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/png.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <stb/stb_image.h>

#include <pulsecast/base/random.hpp>
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

namespace {

const support::TemporaryFolder folder;
const std::filesystem::path path = folder.path() / "cloud.png";

struct Point {
  Vec3 at{};
  ObjectId object = 0;
  double reflectance = 0.5;
  std::uint8_t number = 1;
  ReflectionKind kind = ReflectionKind::surface;
};

/// Gives the points to a sink, so many a batch, each as the one echo of a shot from above.
void give(ImageWriter& writer, const std::vector<Point>& points, std::size_t a_batch = 1000) {
  for (std::size_t begin = 0; begin < points.size(); begin += a_batch) {
    std::vector<Shot> shots;
    std::vector<Echo> echoes;
    for (std::size_t i = begin; i < std::min(begin + a_batch, points.size()); ++i) {
      const Point& p = points[i];
      shots.push_back({.index = i,
                       .origin = p.at + axis::up * 8.0,
                       .direction = -axis::up,
                       .first_echo = static_cast<std::uint32_t>(echoes.size()),
                       .echoes = 1});
      echoes.push_back(
          {.range = 8, .reflectance = p.reflectance, .object = p.object, .number = p.number, .kind = p.kind});
    }
    EchoBatch batch;
    batch.shots = shots;
    batch.echoes = echoes;
    writer(batch);
  }
}

/// The bytes of the picture of these points.
std::string png(const std::vector<Point>& points, const ImageSettings& settings = {}, std::size_t a_batch = 1000) {
  ImageWriter writer(path, settings);
  give(writer, points, a_batch);
  writer.close();
  std::string bytes = support::content(path);
  std::filesystem::remove(path);
  return bytes;
}

struct Picture {
  int width = 0, height = 0;
  std::vector<Srgb> pixels;

  Srgb at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
  double share_of(const Srgb& colour) const {
    return static_cast<double>(std::count(pixels.begin(), pixels.end(), colour)) / static_cast<double>(pixels.size());
  }
};

Picture decoded(const std::string& bytes) {
  Picture picture;
  int channels = 0;
  unsigned char* data =
      stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()),
                            &picture.width, &picture.height, &channels, 3);
  REQUIRE(data != nullptr);
  CHECK(channels == 3);
  for (int i = 0; i < picture.width * picture.height; ++i)
    picture.pixels.push_back({data[3 * i], data[3 * i + 1], data[3 * i + 2]});
  stbi_image_free(data);
  return picture;
}

/// A square field with bumps, 10 m wide.
std::vector<Point> field(std::size_t n, Vec3 corner = {0, 0, 0}) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = 10 * uniform({.seed = 1, .pulse = i, .subray = 0}),
                 y = 10 * uniform({.seed = 1, .pulse = i, .subray = 1});
    points.push_back({corner + Vec3{x, y, std::sin(x) * std::cos(y)}, static_cast<ObjectId>(i % 3), x / 10,
                      static_cast<std::uint8_t>(1 + i % 4), static_cast<ReflectionKind>(i % reflection_kind_count)});
  }
  return points;
}

const Srgb white{255, 255, 255};

/// A map with north up, in which a square of the given points' frame fills the height.
const ImageSettings map{.width = 200,
                        .height = 100,
                        .azimuth = 0,
                        .elevation = pi / 2,
                        .field_of_view = 0,
                        .point_size = 3,
                        .background = white};

}  // namespace

TEST_CASE("a picture is a PNG of the size that was asked for") {
  const std::string bytes = png(field(1000), {.width = 123, .height = 45});
  CHECK(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n");  // source: PNG specification, ISO 15948
  const Picture picture = decoded(bytes);
  CHECK(picture.width == 123);
  CHECK(picture.height == 45);
}

TEST_CASE("points land where a map shows them") {
  // 40 m by 20 m: what fits is 0.95 * 200 px / 40 m = 4.75 px/m, about the middle
  const std::vector<Point> points{{{0, 0, 0}}, {{40, 0, 0}}, {{40, 20, 0}}, {{0, 20, 0}}, {{30, 15, 0}}};
  for (const Vec3& offset : {Vec3{0, 0, 0}, Vec3{477000, 5429000, 300}}) {
    std::vector<Point> moved = points;
    for (Point& p : moved) p.at += offset;
    const Picture picture = decoded(png(moved, map));
    for (const Point& p : points) {
      const int x = static_cast<int>(100 + 4.75 * (p.at.x - 20)), y = static_cast<int>(50 - 4.75 * (p.at.y - 10));
      CAPTURE(x);
      CAPTURE(y);
      CHECK(picture.at(x, y) != white);
      CHECK(picture.at(x, y > 50 ? y - 5 : y + 5) == white);
    }
    CHECK(picture.share_of(white) > 1 - 5 * 16.0 / 20000);
  }
}

TEST_CASE("a picture may be filled by what stands on the ground, if anything does") {
  std::vector<Point> points;  // wavy ground of 200 m by 200 m, and a flat roof of 10 m by 10 m
  for (int x = 0; x <= 200; x += 2)
    for (int y = 0; y <= 200; y += 2) points.push_back({{double(x), double(y), 2 * std::sin(0.05 * x)}});
  const std::size_t ground = points.size();
  for (int x = 0; x <= 40; ++x)
    for (int y = 0; y <= 40; ++y) points.push_back({{120 + 0.25 * x, 60 + 0.25 * y, 8}});
  const auto drawn_in_row = [&](int row, FrameOn frame_on) {
    ImageSettings settings = map;
    settings.frame_on = frame_on;
    const Picture picture = decoded(png(points, settings));
    int count = 0;
    for (int x = 0; x < picture.width; ++x) count += picture.at(x, row) != white;
    return count;
  };
  CHECK(drawn_in_row(50, FrameOn::all) > 90);       // the ground, 0.475 px/m
  CHECK(drawn_in_row(50, FrameOn::standing) > 78);  // the roof, 8 px/m
  CHECK(drawn_in_row(95, FrameOn::standing) < 60);  // ground points, 16 px apart
  points.resize(ground + 50);                       // fewer than one in a hundred: all again
  CHECK(drawn_in_row(50, FrameOn::standing) == drawn_in_row(50, FrameOn::all));
}

TEST_CASE("the azimuth turns the map, so that what it names is up") {
  const std::vector<Point> points{{{0, 0, 0}}, {{10, 0, 0}, 1}};  // the second lies east of the first
  ImageSettings settings = map;
  settings.azimuth = pi / 2;
  const Picture picture = decoded(png(points, settings));
  CHECK(picture.at(100, 3) != white);
  CHECK(picture.at(100, 97) != white);
  CHECK(picture.at(4, 50) == white);
}

TEST_CASE("what is nearer hides what is behind") {
  ImageSettings settings = map;
  settings.colour_by = ColourBy::object;
  const std::vector<Point> frame{{{0, 0, 0}, 7}, {{10, 10, 0}, 7}};
  for (const bool top_first : {true, false}) {
    std::vector<Point> points = frame;
    points.push_back({{5, 5, top_first ? 3.0 : 0.0}, top_first ? 1u : 2u});
    points.push_back({{5, 5, top_first ? 0.0 : 3.0}, top_first ? 2u : 1u});
    std::vector<Point> alone = frame;
    alone.push_back({{5, 5, 3}, 1});
    CHECK(decoded(png(points, settings)).at(100, 50) == decoded(png(alone, settings)).at(100, 50));
  }
}

TEST_CASE("in perspective, what is near is larger") {
  ImageSettings settings = map;
  settings.field_of_view = radians(60);
  settings.point_size = 4;
  const std::vector<Point> points{{{0, 0, 10}}, {{20, 0, 0}}, {{0, 10, 0}}, {{20, 10, 0}}};
  const Picture picture = decoded(png(points, settings));
  int west = 0, east = 0;  // pixels of the two southern points, of which the western one is higher
  for (int y = 50; y < 100; ++y)
    for (int x = 0; x < 200; ++x) (x < 100 ? west : east) += picture.at(x, y) != white;
  CHECK(west > 1.3 * east);
  CHECK(east > 0);
}

TEST_CASE("the same points give the same bytes, however they come") {
  const std::vector<Point> points = field(5000);
  const ImageSettings settings{.width = 160, .height = 90};
  const std::string bytes = png(points, settings);
  CHECK(png(points, settings) == bytes);
  CHECK(png(points, settings, 7) == bytes);
  CHECK(png(points, settings, 5000) == bytes);
}

TEST_CASE("colours differ by what they tell") {
  const std::vector<Point> points = field(3000);
  std::set<std::string> pictures;
  for (const ColourBy by :
       {ColourBy::height, ColourBy::intensity, ColourBy::object, ColourBy::return_number, ColourBy::kind})
    pictures.insert(png(points, {.width = 160, .height = 90, .colour_by = by}));
  CHECK(pictures.size() == 5);

  ImageSettings settings = map;
  settings.point_size = 6;
  const std::vector<Point> pair{{{0, 0, 0}, 1, 0.1, 1}, {{40, 0, 4}, 2, 0.9, 2, ReflectionKind::water}};
  for (const ColourBy by :
       {ColourBy::height, ColourBy::intensity, ColourBy::object, ColourBy::return_number, ColourBy::kind}) {
    settings.colour_by = by;
    const Picture picture = decoded(png(pair, settings));
    CHECK(picture.at(5, 50) != picture.at(195, 50));
  }
  settings.colour_by = ColourBy::intensity;
  const Picture picture = decoded(png(pair, settings));
  CHECK(picture.at(5, 50)[0] == picture.at(5, 50)[2]);
  CHECK(picture.at(195, 50)[0] > picture.at(5, 50)[0] + 50);
}

TEST_CASE("points that are not finite are passed over") {
  const std::vector<Point> sound = field(1000);
  std::vector<Point> damaged;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const Point& p : sound) {
    damaged.push_back({{nan, 0, 0}});
    damaged.push_back(p);
    damaged.push_back({{0, -infinity, 0}});
  }
  const ImageSettings settings{.width = 160, .height = 90, .points_max = 500};
  CHECK(png(damaged, settings) == png(sound, settings));
}

TEST_CASE("values that are not finite harm no picture") {
  std::vector<Point> points = field(100);
  points[3].reflectance = std::numeric_limits<double>::quiet_NaN();
  points[4].reflectance = std::numeric_limits<double>::infinity();
  points[5].number = 0;
  points[6].at = {1e300, 1e300, -1e300};
  for (const ColourBy by :
       {ColourBy::height, ColourBy::intensity, ColourBy::object, ColourBy::return_number, ColourBy::kind})
    CHECK(decoded(png(points, {.width = 16, .height = 9, .colour_by = by})).width == 16);
}

TEST_CASE("no points give a picture of the background") {
  const Picture picture = decoded(png({}, {.width = 20, .height = 10, .background = {1, 2, 3}}));
  CHECK(picture.share_of({1, 2, 3}) == 1);
}

TEST_CASE("a single point is in the middle, and so are many in one place") {
  for (const std::size_t n : {1u, 1000u}) {
    const Picture picture = decoded(png(std::vector<Point>(n, Point{{3, 4, 5}}), map));
    CHECK(picture.at(100, 50) != white);
    CHECK(picture.share_of(white) > 0.99);
  }
}

TEST_CASE("a few outliers do not shrink the picture") {
  std::vector<Point> points = field(20000);
  for (int k = 0; k < 10; ++k) points.push_back({{1e5 * k, -1e5, 1e4 * k}});
  for (const double field_of_view : {0.0, radians(30)}) {
    const ImageSettings settings{
        .width = 160, .height = 90, .elevation = pi / 2, .field_of_view = field_of_view, .background = white};
    CHECK(decoded(png(points, settings)).share_of(white) <
          0.75);  // a square of 0.95 * 90 px, turned by 30 degrees, leaves 0.70
  }
}

TEST_CASE("discs close the gaps of a surface, however dense it is") {
  for (const std::size_t n : {2000u, 20000u, 100000u}) {
    CAPTURE(n);
    ImageSettings settings = map;
    settings.point_size = 0;
    const Picture picture = decoded(png(field(n), settings));
    int empty = 0;
    for (int y = 10; y < 90; ++y)
      for (int x = 60; x < 140; ++x) empty += picture.at(x, y) == white;
    CHECK(empty < 0.02 * 80 * 80);
  }
}

TEST_CASE("too many points are thinned evenly") {
  std::vector<Point> row;
  for (int k = 0; k < 10000; ++k) row.push_back({{0.01 * k, 0, 0}});
  ImageSettings settings = map;
  settings.points_max = 128;
  const Picture picture = decoded(png(row, settings));
  for (int x = 10; x < 190; x += 10) {
    CAPTURE(x);
    bool drawn = false;
    for (int k = 0; k < 10; ++k) drawn = drawn || picture.at(x + k, 50) != white;
    CHECK(drawn);
  }
}

TEST_CASE("there is no file before close, and none without it") {
  {
    ImageWriter writer(path);
    give(writer, field(10));
    CHECK_FALSE(std::filesystem::exists(path));
  }
  CHECK_FALSE(std::filesystem::exists(path));
  CHECK_THROWS_AS(ImageWriter(path / "no" / "folder.png"), FileError);
}

TEST_CASE("settings that cannot be are refused") {
  CHECK_THROWS_AS(ImageWriter(path, {.width = 0}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.height = 5000}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.azimuth = std::numeric_limits<double>::infinity()}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.elevation = 2}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.field_of_view = -0.1}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.point_size = std::numeric_limits<double>::quiet_NaN()}), SettingError);
  CHECK_THROWS_AS(ImageWriter(path, {.points_max = 1}), SettingError);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a camera that stands somewhere sees what is before it, where it should be") {
  // 10 m before the camera, a picture of 200 px and 90 degrees is 20 m wide
  ImageSettings settings{.width = 200,
                         .height = 100,
                         .azimuth = 0,
                         .elevation = 0,
                         .field_of_view = radians(90),
                         .eye = Vec3(50, 60, 70),
                         .point_size = 2,
                         .background = white};
  const Picture picture = decoded(png({{{50, 70, 70}}, {{55, 70, 73}}, {{50, 50, 70}}, {{50, 60.1, 70}}}, settings));
  CHECK(picture.at(100, 50) != white);
  CHECK(picture.at(150, 20) != white);
  CHECK(picture.share_of(white) > 0.99);  // neither what is behind nor what is too near
}

TEST_CASE("classes have colours of their own") {
  CHECK(of_class(2) != of_class(5));
  CHECK(of_class(64) != of_class(65));
  CHECK(of_class(0) == of_class(63));
}

TEST_CASE("ground is drawn behind the points, in its shades, wherever it is in depth") {
  // a map with north up of 40 m by 40 m: the west half of the ground is dark, the east half bright, the south is
  // missing
  Raster raster{.columns = 41, .rows = 41, .first = {-20, 20}, .heights = std::vector<float>(41 * 41, 50)};
  std::vector<std::uint8_t> shades;
  for (std::size_t i = 0; i < 41 * 41; ++i) shades.push_back(i / 41 > 30 ? 0 : i % 41 < 20 ? 40 : 200);
  const ImageSettings from_above{
      .width = 100, .height = 100, .azimuth = 0, .elevation = pi / 2, .field_of_view = 0, .point_size = 3};
  ImageWriter writer(path, from_above);
  writer.add_ground(raster, shades);
  // points under the ground, at the corners of the framed square and in its middle
  give(writer, {{{-20, -20, 0}}, {{20, 20, 0}}, {{-20, 20, 0}}, {{20, -20, 0}}, {{0, 5, 0}}});
  writer.close();
  int width = 0, height = 0, channels = 0;
  stbi_uc* const pixels = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(pixels != nullptr);
  const auto at = [&](double east, double north) {  // 95 px are 40 m
    const auto x = static_cast<int>(50 + east * 95 / 40), y = static_cast<int>(50 - north * 95 / 40);
    const stbi_uc* const p = pixels + 3 * (y * width + x);
    return std::vector<int>{p[0], p[1], p[2]};
  };
  CHECK(at(-10, 10) == std::vector<int>{40, 40, 40});
  CHECK(at(-0.5, 12) > std::vector<int>{70, 70, 70});  // between the shades of two pixels
  CHECK(at(-0.5, 12) < std::vector<int>{150, 150, 150});
  CHECK(at(10, 10) == std::vector<int>{200, 200, 200});
  CHECK(at(10, -15) == std::vector<int>{13, 17, 23});
  const std::vector<int> point = at(0, 5);
  CHECK(!(point[0] == point[1] && point[1] == point[2]));  // the colour of a point
  stbi_image_free(pixels);

  // without points, the ground frames the picture
  ImageWriter bare(path, from_above);
  bare.add_ground(raster, shades, {.translation = {4e5, 5e6, 0}});
  bare.close();
  stbi_uc* const again = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(again != nullptr);
  CHECK(again[3 * (50 * width + 10)] == 40);
  CHECK(again[3 * (50 * width + 90)] == 200);
  stbi_image_free(again);

  // so does a raster of few pixels, without gaps
  ImageWriter coarse(path, from_above);
  coarse.add_ground({.columns = 2, .rows = 2, .first = {-20, 20}, .pixel = {40, 40}, .heights = {1, 1, 1, 1}},
                    std::vector<std::uint8_t>{10, 10, 250, 250});
  coarse.close();
  stbi_uc* const few = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(few != nullptr);
  for (int y = 8; y < 92; ++y) CHECK(std::abs(few[3 * (y * width + 37)] - (10 + 240 * (y - 2.5) / 95)) < 3);
  stbi_image_free(few);
  ImageWriter wrong(path, from_above);
  CHECK_THROWS_AS(wrong.add_ground(raster, std::vector<std::uint8_t>(5)), SettingError);
}
