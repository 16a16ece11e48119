// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// From the laser to the point in the world: the whole pipeline against its closed form, computed on its own in extended
// precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <pulsecast/base/rotation_list.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/waypoints.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

// --------------------------------------------------------------------- the closed form, on its own

using Real = long double;
using Row = std::array<Real, 3>;
using Matrix = std::array<Row, 3>;

Row operator*(const Matrix& m, const Row& v) {
  Row out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  return out;
}

Real radians_of(Real angle_deg) { return angle_deg * std::acos(Real{-1}) / 180; }

/// A right-handed turn about axis 0 (x), 1 (y) or 2 (z).
Matrix turn(std::size_t axis, Real angle_deg) {
  const Real c = std::cos(radians_of(angle_deg)), s = std::sin(radians_of(angle_deg));
  const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
  Matrix m{};
  m[axis][axis] = 1;
  m[j][j] = m[k][k] = c;
  m[k][j] = s;
  m[j][k] = -s;
  return m;
}

// -------------------------------------------------------------------------------------- the flight

const Vec3 start{512345.678, 5403210.987, 1234.5};  // as in UTM [m]
const Vec3 lever_arm{0.3, -1.2, 0.7};
constexpr double rate = 50e3, line_rate = 77.3, speed = 61.7;

/// The instrument looks down and sweeps to the right; then it is off by 1, -2 and 3 degrees about the axes of the body.
Rotation boresight() {
  return extrinsic(
      {{axis::right, -90_deg}, {axis::up, -90_deg}, {axis::right, 1_deg}, {axis::forward, -2_deg}, {axis::up, 3_deg}});
}

Matrix expected_boresight() { return turn(2, 3) * turn(1, -2) * turn(0, 1) * turn(2, -90) * turn(0, -90); }

auto airplane(double heading, const Vec3& climb = {}) {
  const Vec3 way{std::sin(heading), std::cos(heading), 0};
  return Platform{StraightLine{.from = start, .to = start + 500.0 * way + climb, .speed = speed},
                  Mount{lever_arm, boresight()},
                  Deflector{PolygonMirror{.line_rate = line_rate, .sweep = 30_deg},
                            Scanner{.pulse_rate = rate, .pulses = 400'000}}};
}

/// A plane through a place of the world.
struct Plane {
  Vec3 place{};
  Vec3 normal = axis::up;

  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = dot(place - ray.origin, normal) / dot(ray.direction, normal);
    if (!(range > ray.near && range <= ray.far)) return std::nullopt;
    return Hit{.range = range};
  }
};

/// Where the beam of slot i meets a plane, if the body flies with a heading [deg] and does not climb.
Row expected_point(std::uint64_t i, Real heading_deg, const Plane& plane) {
  const Real t = static_cast<Real>(i) / rate, lines = t * static_cast<Real>(line_rate);
  const Real sweep = 30 * (2 * (lines - std::floor(lines)) - 1);  // above forward [deg]
  const Row beam{0, std::cos(radians_of(sweep)), std::sin(radians_of(sweep))};
  const Matrix world_from_body = turn(2, -heading_deg);
  const Row direction = world_from_body * (expected_boresight() * beam);
  const Row arm = world_from_body * Row{lever_arm.x, lever_arm.y, lever_arm.z};
  const Row flown = world_from_body * Row{0, static_cast<Real>(speed) * t, 0};
  Row origin, point;
  Real up_to_plane = 0, along_normal = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    origin[k] = static_cast<Real>(start[axis]) + flown[k] + arm[k];
    up_to_plane += (static_cast<Real>(plane.place[axis]) - origin[k]) * static_cast<Real>(plane.normal[axis]);
    along_normal += direction[k] * static_cast<Real>(plane.normal[axis]);
  }
  for (std::size_t k = 0; k < 3; ++k) point[k] = origin[k] + direction[k] * (up_to_plane / along_normal);
  return point;
}

template <class Source, class Map>
Cloud scan(const Source& source, const Map& map, PulseIndex stride) {
  Cloud cloud;
  run(Survey{source, SingleRay{}, map, Receiver{}, FirstHit{}}, {.threads = 2, .stride = stride}, cloud);
  return cloud;
}

/// The farthest that a point lies from where it should [m].
double largest_error(const Cloud& cloud, Real heading_deg, const Plane& plane) {
  Real error = 0;
  for (std::size_t n = 0; n < cloud.size(); ++n) {
    const Row expected = expected_point(cloud.pulses[n], heading_deg, plane);
    const Vec3& p = cloud.points[n];
    error = std::max(error, std::hypot(p.x - expected[0], p.y - expected[1], p.z - expected[2]));
  }
  return static_cast<double>(error);
}

/// A horizontal square of two triangles around a place.
Scene<TriangleMesh<>> square(const Vec3& middle, double half) {
  MeshData data{.vertices = {middle + Vec3{-half, -half, 0}, middle + Vec3{half, -half, 0},
                             middle + Vec3{half, half, 0}, middle + Vec3{-half, half, 0}},
                .triangles = {{0, 1, 2}, {0, 2, 3}}};
  return Scene<TriangleMesh<>>({{.geometry = std::make_shared<const TriangleMesh<>>(std::move(data))}});
}

}  // namespace

TEST_CASE("points on a plane from a straight flight match the closed form within 0.1 mm, whatever the heading") {
  const Plane slope{start - Vec3{0, 0, 900}, normalize(Vec3{0.1, -0.2, 1})}, level_ground{start - Vec3{0, 0, 900}};
  const auto mesh = square(level_ground.place, 3000);
  for (const double heading_deg : {90.0, 0.0, 225.0, -12.3}) {  // east, north, south-west
    CAPTURE(heading_deg);
    const auto flight = airplane(radians(heading_deg));
    const Cloud on_slope = scan(flight, slope, 61), on_mesh = scan(flight, mesh, 61);
    CHECK(on_slope.size() == 400'000 / 61 + 1);
    CHECK(on_mesh.size() == on_slope.size());
    CHECK(largest_error(on_slope, heading_deg, slope) < 1e-4);
    CHECK(largest_error(on_mesh, heading_deg, level_ground) < 1e-4);
  }
}

TEST_CASE(
    "the closed form is worth the comparison: a lever arm, a boresight or a heading that is off by little shows") {
  const Plane ground{start - Vec3{0, 0, 900}};
  const auto error = [&](const Mount& mount) {
    const auto flight = airplane(90_deg);
    return largest_error(scan(Platform{flight.trajectory(), mount, flight.source()}, ground, 611), 90, ground);
  };
  CHECK(error({lever_arm, boresight()}) < 1e-4);
  CHECK(error({lever_arm + Vec3{0.001, 0, 0}, boresight()}) > 5e-4);
  CHECK(error({{}, boresight()}) > 1);
  CHECK(error({lever_arm, extrinsic({{axis::up, 0.001_deg}}) * boresight()}) > 1e-3);
  CHECK(error({lever_arm, extrinsic({{axis::right, -90_deg},
                                     {axis::up, -90_deg},
                                     {axis::up, 3_deg},
                                     {axis::forward, -2_deg},
                                     {axis::right, 1_deg}})}) > 0.1);
  CHECK(largest_error(scan(airplane(90_deg), ground, 611), Real{90.001}, ground) > 1e-3);
}

TEST_CASE("a lever arm turns with roll and pitch, and so does the beam") {
  // rolled to the right by 90 degrees: what was to the right is below, what was above is to the right
  const Waypoints rolled({{.rotation = rotation_about(axis::forward, 90_deg)}});
  const Platform platform{rolled, Mount{.lever_arm = {2, 3, 5}}, airplane(0).source()};
  const auto p = platform.pulse(0);
  CHECK(length(p->origin() - Vec3{5, 3, -2}) < 1e-14);
  // the first pulse of a line leaves 30 degrees below forward, for the body; now that is to the left
  CHECK(length(p->direction() - Vec3{-0.5, std::sqrt(0.75), 0}) < 1e-14);
}

TEST_CASE("the scan sweeps to the right of the flight, and its angles say so") {
  const auto flight = airplane(225_deg);
  const Vec3 to_the_right{std::cos(225_deg), -std::sin(225_deg), 0};
  for (PulseIndex i = 0; i < 600; ++i) {
    const auto p = flight.pulse(i);
    const double aside = std::atan2(dot(p->direction(), to_the_right), -p->direction().z);
    CHECK(std::fabs(p->scan_angle - aside) < 1e-12);
  }
  CHECK(flight.pulse(0)->scan_angle < -25_deg);
  CHECK(flight.pulse(600)->scan_angle > 20_deg);
}

TEST_CASE("a straight flight through waypoints gives the same points as a straight line") {
  const Plane ground{start - Vec3{0, 0, 900}};
  const auto flight = airplane(225_deg, {0, 0, 30});
  const StraightLine& line = flight.trajectory();
  for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
    const Waypoints path(at_constant_speed({line.from, 0.7 * line.from + 0.3 * line.to, line.to}, line.speed), kind);
    const Cloud a = scan(flight, ground, 997), b = scan(Platform{path, flight.mount(), flight.source()}, ground, 997);
    REQUIRE(a.size() == b.size());
    for (std::size_t n = 0; n < a.size(); ++n) CHECK(length(a.points[n] - b.points[n]) < 1e-6);
  }
}
