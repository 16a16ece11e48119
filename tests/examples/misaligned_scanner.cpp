// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "../../examples/misaligned_scanner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/uncertainty.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace misaligned;

namespace {

/// Deviations of a scanner that was not calibrated for long.
constexpr Parameters typical{0.2e-3, 0.2e-3, 0.2e-3, 0.2e-3, 50e-6, 50e-6, 50e-6, 50e-6, 50e-6, 0.5e-3};
const double noise_of_range = 0.3_mm, noise_of_angle = 20e-6;

/// What the encoders and the rangefinder read.
struct Reading {
  double range, horizontal, zenith;

  [[nodiscard]] Rotation head() const { return rotation_about(axis::up, horizontal); }
  /// Range, horizontal arc, and arc of the zenith angle, of a displacement, each over its noise.
  [[nodiscard]] std::array<double, 3> over_noise(const Vec3& displacement) const {
    const Vec3 d = conjugate(head()) * displacement;
    const double across = range * std::fabs(std::sin(zenith));
    return {dot(d, beam_at(zenith)) / noise_of_range, dot(d, left) / (across * noise_of_angle),
            dot(d, ahead_at(zenith)) / (range * noise_of_angle)};
  }
  [[nodiscard]] Vec3 place(const Parameters& x) const { return head() * true_beam(x, zenith).point({0, range, 0}); }
  /// Displacement of the place by each parameter.
  [[nodiscard]] Vec3 form(std::size_t k) const { return head() * forms_at(zenith)[k].at(range * beam_at(zenith)); }
};

/// Reading at which the beam of a misaligned scanner ends at a place.
Reading aimed_at_place(const Vec3& place, bool second_face, const Parameters& x) {
  const double horizontal = std::atan2(-place.x, place.y), zenith = std::acos(place.z / length(place));
  Reading r{length(place), second_face ? horizontal + pi : horizontal, second_face ? 2 * pi - zenith : zenith};
  for (int step = 0; step < 6; ++step) {
    const Vec3 d = conjugate(r.head()) * (place - r.place(x));
    r.range += dot(d, beam_at(r.zenith));
    r.horizontal += dot(d, left) / (r.range * std::sin(r.zenith));
    r.zenith += dot(d, ahead_at(r.zenith)) / r.range;
  }
  return r;
}

Reading with_noise(const Reading& r, support::Generator& random) {
  return {r.range + noise_of_range * random.normal(), r.horizontal + noise_of_angle * random.normal(),
          r.zenith + noise_of_angle * random.normal()};
}

using Matrix = std::array<Parameters, parameter_count>;

/// Eigenvalues of a symmetric matrix, and eigenvectors in rows. Source: cyclic method of Jacobi, Golub & Van Loan 2013,
/// sec. 8.5.
struct Eigen {
  Parameters values{};
  Matrix vectors{};

  explicit Eigen(Matrix a) {
    for (std::size_t k = 0; k < a.size(); ++k) vectors[k][k] = 1;
    for (int sweep = 0; sweep < 12; ++sweep)
      for (std::size_t p = 0; p + 1 < a.size(); ++p)
        for (std::size_t q = p + 1; q < a.size(); ++q) annihilate(a, p, q);
    for (std::size_t k = 0; k < a.size(); ++k) values[k] = a[k][k];
  }

 private:
  void annihilate(Matrix& a, std::size_t p, std::size_t q) {
    if (a[p][q] == 0) return;
    const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]), c = std::cos(angle), s = std::sin(angle);
    const auto turn = [=](double& x, double& y) {
      const double old = x;
      x = c * old - s * y;
      y = s * old + c * y;
    };
    for (std::size_t k = 0; k < a.size(); ++k) turn(a[k][p], a[k][q]);
    for (std::size_t k = 0; k < a.size(); ++k) turn(a[p][k], a[q][k]);
    for (std::size_t k = 0; k < a.size(); ++k) turn(vectors[p][k], vectors[q][k]);
  }
};

/// Least squares, in units of the typical deviations.
struct NormalEquations {
  Matrix matrix{};
  Parameters right{};

  /// Adds those of an observed displacement, by its forms, to which so many equal noises contributed.
  void add(const Reading& r, const Vec3& observed, const auto& form, double noises = 1) {
    const auto value = r.over_noise(observed);
    std::array<std::array<double, 3>, parameter_count> row{};
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = r.over_noise(typical[k] * form(k));
    for (std::size_t of = 0; of < 3; ++of)
      for (std::size_t k = 0; k < row.size(); ++k) {
        right[k] += row[k][of] * value[of] / noises;
        for (std::size_t m = 0; m < row.size(); ++m) matrix[k][m] += row[k][of] * row[m][of] / noises;
      }
  }
};

/// Solution of least length, and its covariance; what is not observable is left out of both.
struct Solution {
  Parameters values{};
  Matrix covariance{};

  explicit Solution(const NormalEquations& equations) {
    const Eigen eigen(equations.matrix);
    const double largest = *std::max_element(eigen.values.begin(), eigen.values.end());
    for (std::size_t e = 0; e < parameter_count; ++e) {
      if (eigen.values[e] < 1e-6 * largest) continue;  // the noise of readings makes 1e-10 of zero
      const Parameters& v = eigen.vectors[e];
      for (std::size_t k = 0; k < parameter_count; ++k)
        for (std::size_t m = 0; m < parameter_count; ++m) {
          values[k] += v[k] * v[m] * equations.right[m] / eigen.values[e];
          covariance[k][m] += v[k] * v[m] / eigen.values[e];
        }
    }
  }
};

/// 20 places around a scanner, from 2 to 25 m away and up to 60 degrees above or below it.
std::vector<Vec3> targets() {
  support::Generator random(40);
  std::vector<Vec3> places;
  while (places.size() < 20)
    if (const Vec3 toward = random.unit(); std::fabs(toward.z) < 0.87)
      places.push_back(random.log_uniform(2, 25) * toward);
  return places;
}

/// Scanner on a tilted tripod, with misalignments of so many times the typical ones.
auto scanner(double size, std::uint64_t seed) {
  Parameters deviations = typical;
  for (double& d : deviations) d *= size;
  const MirrorUnit unit{.scanner = {.pulse_rate = 1_kHz, .pulses = 2000},
                        .rotation_rate = 7,
                        .misalignments = drawn(deviations, seed),
                        .deviations = deviations};
  const Mount mount{.lever_arm = {0, 0, 1.7}, .boresight = rotation_about({1, 2, 3}, 0.1)};
  return Platform{Tripod{.position = {10, 20, 30}, .heading = 1}, mount,
                  Deflector{RotatingHead{.angular_rate = pi}, unit}};
}

/// Mirror unit that says nothing of its errors.
struct Silent {
  MirrorUnit unit;
  PulseIndex size() const noexcept { return unit.size(); }
  Tick duration() const noexcept { return unit.duration(); }
  std::vector<Emitter> emitters() const { return unit.emitters(); }
  std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept { return unit.pulse(i); }
  std::optional<Pose<frame::Beam, frame::Instrument>> measured(PulseIndex i, Tick t) const noexcept {
    return unit.measured(i, t);
  }
};

/// Mean and variance of normalised errors.
struct Normalised {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double error) {
    sum += error;
    squares += error * error;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double variance() const { return squares / count - mean() * mean(); }
  [[nodiscard]] bool as_stated() const { return std::fabs(mean()) < 0.25 && variance() > 0.7 && variance() < 1.35; }
};

}  // namespace

TEST_CASE("the forms are the derivatives of the traced beam") {
  support::Generator random(1);
  for (int round = 0; round < 1000; ++round) {
    const double zenith = random.uniform(0, 2 * pi), range = random.log_uniform(0.5, 50), step = 1e-4;
    for (std::size_t k = 0; k < parameter_count; ++k) {
      Parameters more{}, less{};
      more[k] = step;
      less[k] = -step;
      const auto after = true_beam(more, zenith), before = true_beam(less, zenith);
      const Form form = forms_at(zenith)[k];
      const Vec3 turned = after.direction(axis::forward) - before.direction(axis::forward);
      const Vec3 moved = after.point({0, range, 0}) - before.point({0, range, 0});
      CAPTURE(round);
      CAPTURE(std::string(names[k]));
      // by a parameter of 0.1 mm or 0.1 mrad, as those of the paper
      CHECK(length(turned / 2.0 - step * cross(form.turned, beam_at(zenith))) < 1e-9);
      CHECK(length(moved / 2.0 - step * form.at(range * beam_at(zenith))) < 1e-9);
    }
  }
}

TEST_CASE("in spherical coordinates the forms are those of the paper, in both faces") {
  support::Generator random(2);
  for (int round = 0; round < 1000; ++round) {
    const double V = random.uniform(0.1, pi - 0.1), R = random.log_uniform(0.5, 50);
    for (const double k : {1.0, -1.0}) {  // faces, as in the paper
      const double zenith = k > 0 ? V : 2 * pi - V;
      Parameters x{};
      for (double& value : x) value = random.uniform(-1, 1);
      Vec3 moved{};
      for (std::size_t p = 0; p < parameter_count; ++p) moved += x[p] * forms_at(zenith)[p].at(R * beam_at(zenith));
      // Source: Muralikrishnan et al. 2015, without encoders and wobble
      const double range = k * x[x2] * std::sin(V) + x[x10];
      const double horizontal = k * (x[x1z] / (R * std::tan(V)) + x[x3] / (R * std::sin(V)) +
                                     (x[x5z] - x[x7]) / std::tan(V) + 2 * x[x6] / std::sin(V)) +
                                x[x1n] / R + x[x5n];
      const double vertical =
          k * ((x[x1n] + x[x2]) * std::cos(V) / R + x[x4] + x[x5n] * std::cos(V)) - (x[x1z] / R + x[x5z]) * std::sin(V);
      CAPTURE(round);
      CAPTURE(k);
      CHECK(dot(moved, beam_at(zenith)) == doctest::Approx(range).epsilon(1e-12));
      CHECK(dot(moved, left) / (R * std::sin(zenith)) == doctest::Approx(horizontal).epsilon(1e-12));
      CHECK(k * dot(moved, ahead_at(zenith)) / R == doctest::Approx(vertical).epsilon(1e-12));
    }
  }
}

TEST_CASE("the errors that the scanner states, each times its draw, sum to what it misreports") {
  const auto residual = [&](double size, std::uint64_t seed) {
    const auto platform = scanner(size, seed);
    Parameters ones{};
    ones.fill(1);
    const Parameters draws = drawn(ones, seed);
    double largest = 0;
    for (PulseIndex i = 0; i < platform.size(); i += 31) {
      const auto p = platform.pulse(i);
      const Vec3 ray{0, 10, 0}, from_exit = p->pose.direction(ray);
      Vec3 misreported = p->reported->point(ray) - p->pose.point(ray);
      std::size_t k = 0;
      platform.visit_errors(i, p->tick, [&](const PoseError<frame::World>& error) noexcept {
        CHECK(error.scope == ErrorScope::survey);
        misreported -= draws[k++] * (error.moved + cross(error.turned, from_exit));
      });
      CHECK(k == parameter_count);
      largest = std::max(largest, length(misreported));
    }
    return largest;
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CAPTURE(seed);
    CHECK(residual(0.1, seed) < 1e-8);                    // of some 0.1 mm at 10 m
    CHECK(residual(1, seed) > 50 * residual(0.1, seed));  // all that is left is of second order
    CHECK(residual(1, seed) < 200 * residual(0.1, seed));
  }
  CHECK(support::source_laws(scanner(1, 1)) == "");
}

TEST_CASE("points of a survey are as uncertain as its scanners err") {
  for (const PulseIndex i : {PulseIndex{3}, PulseIndex{40}, PulseIndex{777}, PulseIndex{1500}}) {
    CAPTURE(i);
    CHECK(support::error_laws([](std::uint64_t seed) { return scanner(1, seed); }, i, 10, 1000) == "");
  }
  const MeshData ground{.vertices = {{-90, -90, 0}, {110, -90, 0}, {110, 110, 0}, {-90, 110, 0}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground)}});
  const Survey survey{scanner(1, 1), SingleRay{}, scene, Receiver{}, FirstHit{}};
  const UncertaintyQuery uncertainty = uncertainty_of(survey);
  std::size_t points = 0;
  run(survey, {}, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const auto pulse = survey.source().pulse(shot.index);
        const Vec3 point = pulse->pose.point({0, echo.range, 0});
        Covariance stated;
        survey.source().visit_errors(shot.index, shot.tick, [&](const PoseError<frame::World>& error) noexcept {
          stated.add(support::detail::displaced(error, *pulse, point));
        });
        const PointUncertainty u = uncertainty(shot, echo);
        CHECK(u.flags == 0);
        for (const Vec3& along : {axis::right, axis::forward, axis::up, normalize(Vec3{1, -2, 3})})
          CHECK(u.systematic.along(along) == support::relative(stated.along(along), 0.01));
        ++points;
      }
  });
  CHECK(points > 500);
}

TEST_CASE("points of a scanner that does not state what it misreports are marked, whatever is around it") {
  const MeshData ground{.vertices = {{-90, -90, 0}, {110, -90, 0}, {110, 110, 0}, {-90, 110, 0}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground)}});
  const auto flags_of = [&](const auto& source) {
    const Survey survey{source, SingleRay{}, scene, Receiver{}, FirstHit{}};
    return uncertainty_of(survey)({}, {.range = 1, .cos_incidence = 1}).flags & PointUncertainty::unstated;
  };
  const auto around = [](const auto& unit) { return Platform{Tripod{}, Mount{}, Deflector{RotatingHead{}, unit}}; };
  const MirrorUnit unit{.scanner = {.pulses = 10}, .deviations = typical};
  using Any = AnySource<Deflector<FixedBeam, Scanner>, Silent>;
  CHECK(flags_of(around(unit)) == 0);
  CHECK(flags_of(around(Deflector{FixedBeam{}, unit.scanner})) == 0);
  CHECK(flags_of(around(Silent{unit})) != 0);
  CHECK(flags_of(around(Channels{std::vector<Any>{Silent{unit}}})) != 0);
  CHECK(flags_of(Legs{std::vector{WithPoseErrors{around(Silent{unit}), PoseErrors{.position_noise = 1}}}}) != 0);
  CHECK(flags_of(Legs{std::vector{WithPoseErrors{around(unit), PoseErrors{.position_noise = 1}}}}) == 0);
}

TEST_CASE("places that are known show all ten parameters, as exactly as least squares state") {
  std::array<Normalised, parameter_count> errors;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Parameters truth = drawn(typical, seed);
    support::Generator random(seed);
    std::vector<Reading> readings;
    for (const Vec3& place : targets())
      for (const bool second : {false, true})
        readings.push_back(with_noise(aimed_at_place(place, second, truth), random));
    Parameters found{};
    for (int step = 0; step < 4; ++step) {
      NormalEquations equations;
      for (std::size_t m = 0; m < readings.size(); ++m)
        equations.add(readings[m], targets()[m / 2] - readings[m].place(found),
                      [&](std::size_t k) { return readings[m].form(k); });
      const Solution solution(equations);
      for (std::size_t k = 0; k < parameter_count; ++k) {
        found[k] += typical[k] * solution.values[k];
        if (step == 3) errors[k].add((found[k] - truth[k]) / typical[k] / std::sqrt(solution.covariance[k][k]));
      }
    }
  }
  for (std::size_t k = 0; k < parameter_count; ++k) {
    CAPTURE(std::string(names[k]));
    CAPTURE(errors[k].mean());
    CAPTURE(errors[k].variance());
    CHECK(errors[k].as_stated());
  }
}

TEST_CASE("two faces of unknown places show eight: not the zero of ranges, nor two tilts that raise all beams alike") {
  NormalEquations equations;
  for (const Vec3& place : targets()) {
    const Reading first = aimed_at_place(place, false, {}), second = aimed_at_place(place, true, {});
    equations.add(
        first, {}, [&](std::size_t k) { return first.form(k) - second.form(k); }, 2);
  }
  Parameters ascending = Eigen(equations.matrix).values;
  std::sort(ascending.begin(), ascending.end());
  CHECK(std::fabs(ascending[1]) < 1e-12 * ascending[9]);
  CHECK(ascending[2] > 1e-5 * ascending[9]);
  for (const auto& [unseen, other] : {std::pair{x10, x10}, std::pair{x5z, x7}})
    for (std::size_t k = 0; k < parameter_count; ++k) {
      const double effect = equations.matrix[k][unseen] + equations.matrix[k][other];
      CHECK(std::fabs(effect) < 1e-12 * ascending[9]);
    }
}

TEST_CASE("what two faces show of unknown places is as exact as least squares state") {
  std::array<Normalised, parameter_count> errors;  // that of x5z is of x5z - x7
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Parameters truth = drawn(typical, seed);
    support::Generator random(1000 + seed);
    NormalEquations equations;
    for (const Vec3& place : targets()) {
      const Reading first = with_noise(aimed_at_place(place, false, truth), random),
                    second = with_noise(aimed_at_place(place, true, truth), random);
      const auto difference = [&](std::size_t k) { return first.form(k) - second.form(k); };
      equations.add(first, second.place({}) - first.place({}), difference, 2);
    }
    const Solution solution(equations);
    const auto& c = solution.covariance;
    const auto off = [&](std::size_t k) { return solution.values[k] - truth[k] / typical[k]; };
    for (const std::size_t k : {x1n, x1z, x2, x3, x4, x5n, x6}) errors[k].add(off(k) / std::sqrt(c[k][k]));
    errors[x5z].add((off(x5z) - off(x7)) / std::sqrt(c[x5z][x5z] - 2 * c[x5z][x7] + c[x7][x7]));
  }
  for (const std::size_t k : {x1n, x1z, x2, x3, x4, x5n, x5z, x6}) {
    CAPTURE(std::string(names[k]));
    CAPTURE(errors[k].mean());
    CAPTURE(errors[k].variance());
    CHECK(errors[k].as_stated());
  }
}
