// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/pixel_array.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include <pulsecast/cloud.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/survey.hpp>

#include "support/laws.hpp"

namespace pulsecast {
namespace {

using namespace literals;

PixelArray camera() {
  return {.columns = 5, .rows = 3, .horizontal_view = 90_deg, .vertical_view = 60_deg, .frame_rate = 30, .frames = 7};
}

TEST_CASE("pixels are evenly spaced in the tangents, from the upper left on") {
  const PixelArray array = camera();
  CHECK(array.size() == 7 * 15);
  for (std::uint32_t row = 0; row < 3; ++row)
    for (std::uint32_t column = 0; column < 5; ++column) {
      const Vec3 d = array.direction(column, row);
      const Vec3 pulse = array.pulse(2 * 15 + row * 5 + column)->direction();
      CHECK(std::fabs(length(d) - 1) < 1e-15);
      CHECK(std::fabs(d.x / d.y - (column - 2.0) * 0.4) < 1e-15);
      CHECK(std::fabs(d.z / d.y - (1.0 - row) * 2 / 3 * std::tan(30_deg)) < 1e-15);
      CHECK(length(pulse - d) < 1e-15);
    }
  CHECK(length(array.direction(2, 1) - axis::forward) == 0);
}

TEST_CASE("the outer edges of the pixels are the field of view, and a focal length is one") {
  PixelArray array = camera();
  const double focal_length = 320.5;  // pixels
  array.columns = 640;
  array.horizontal_view = 2 * std::atan(array.columns / (2 * focal_length));
  const Vec3 d = array.direction(639, 1);
  CHECK(std::fabs(d.x / d.y - (639 + 0.5 - 320) / focal_length) < 1e-14);
}

TEST_CASE("all pixels of a frame share its time") {
  const PixelArray array = camera();
  for (PulseIndex i = 0; i < array.size(); ++i) {
    CHECK(array.pulse(i)->tick == Tick::of(i / 15, 30));
    CHECK(array.pulse(i)->emitter == 0);
  }
  CHECK(array.emitters().size() == 1);
  CHECK(array.slot_from(Tick{}) == 0);
  CHECK(array.slot_from(Tick::of(4, 30)) == 4 * 15);
  CHECK(array.slot_from(Tick::of_seconds(4.5 / 30)) == 5 * 15);
  CHECK(array.slot_from(Tick::of(100, 1)) == array.size());
}

TEST_CASE("a pixel array keeps the laws of sources") {
  CHECK(support::source_laws(camera()) == "");
  CHECK(support::source_laws(PixelArray{.columns = 1, .rows = 1, .frames = 50}) == "");
  CHECK(support::source_laws(PixelArray{.columns = 333, .rows = 77, .horizontal_view = 2.9, .frames = 1000}) == "");
}

TEST_CASE("settings of a pixel array without meaning are refused") {
  const auto refused = [](auto change, const char* part) {
    PixelArray array = camera();
    change(array);
    CHECK_THROWS_WITH_AS(array.validate(), doctest::Contains(part), SettingError);
  };
  refused([](PixelArray& a) { a.columns = 0; }, "PixelArray::columns");
  refused([](PixelArray& a) { a.rows = 100'001; }, "PixelArray::rows");
  refused([](PixelArray& a) { a.horizontal_view = -0.1; }, "horizontal_view");
  refused([](PixelArray& a) { a.vertical_view = pi; }, "vertical_view");
  refused([](PixelArray& a) { a.frame_rate = 0; }, "PixelArray::frame_rate");
  refused([](PixelArray& a) { a.frames = PulseIndex{1} << 52; }, "PixelArray::frames");
  refused([](PixelArray& a) { a.laser.wavelength = 0; }, "Laser::wavelength");
}

/// Plane y = 10, which faces the camera.
struct Wall {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = (10 - ray.origin.y) / ray.direction.y;
    if (!(range > ray.near && range < ray.far)) return std::nullopt;
    return Hit{.range = range, .cos_incidence = ray.direction.y, .backscatter = 0.5};
  }
};

TEST_CASE("the depth image of a plane that faces the camera is flat") {
  const PixelArray array{.columns = 64, .rows = 48, .frames = 3};
  const Wall wall;
  Cloud cloud;
  run(Survey{Platform{Tripod{.position = {3, 4, 5}}, Mount{}, array}, SingleRay{}, wall, Receiver{}, FirstHit{}}, {},
      cloud);
  REQUIRE(cloud.size() == array.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const PulseIndex pixel = cloud.pulses[k] % array.pixels();
    const double depth =
        length(cloud.points[k] - Vec3{3, 4, 5}) *
        array.direction(static_cast<std::uint32_t>(pixel % 64), static_cast<std::uint32_t>(pixel / 64)).y;
    CHECK(std::fabs(depth - 6) < 1e-9);
  }
}

}  // namespace
}  // namespace pulsecast
