// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/run_errors.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>

/// Small scenes of many kinds, and small surveys of each, for the coverage of the stated errors of runs.
namespace stated {

using namespace pulsecast;
using namespace pulsecast::literals;

/// Random numbers, the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * uniform({.seed = seed_, .pulse = number_++, .purpose = Purpose{129}});
  }
  double log(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }

 private:
  std::uint64_t seed_, number_ = 0;
};

/// Mesh that grows by parallelograms; the material of what follows is `material`.
struct Builder {
  MeshData data{};
  std::uint16_t material = 0;

  Builder& of(std::uint16_t next) {
    material = next;
    return *this;
  }
  /// From a corner along two edges.
  Builder& quad(const Vec3& at, const Vec3& u, const Vec3& v) {
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    data.vertices.insert(data.vertices.end(), {at, at + u, at + u + v, at + v});
    data.triangles.push_back({first, first + 1, first + 2});
    data.triangles.push_back({first, first + 2, first + 3});
    data.materials.insert(data.materials.end(), {material, material});
    return *this;
  }
  Builder& box(const Vec3& a, const Vec3& b) {
    const Vec3 x{b.x - a.x, 0, 0}, y{0, b.y - a.y, 0}, z{0, 0, b.z - a.z};
    quad(a, x, y).quad(a, x, z).quad(a, y, z);
    return quad(b, -x, -y).quad(b, -x, -z).quad(b, -y, -z);
  }
  /// Wall across the view at a distance `y`.
  Builder& wall(double y, double x0, double x1, double z0, double z1) {
    return quad({x0, y, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0});
  }
  Builder& ellipsoid(const Vec3& middle, const Vec3& radii, int steps = 12) {
    const auto at = [&](int i, int j) {
      const double theta = pi * i / steps, phi = 2 * pi * j / (2 * steps);
      return Vec3{middle.x + radii.x * std::sin(theta) * std::cos(phi),
                  middle.y + radii.y * std::sin(theta) * std::sin(phi), middle.z + radii.z * std::cos(theta)};
    };
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < 2 * steps; ++j) {
        const auto first = static_cast<std::uint32_t>(data.vertices.size());
        data.vertices.insert(data.vertices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        data.triangles.push_back({first, first + 1, first + 2});
        data.triangles.push_back({first, first + 2, first + 3});
        data.materials.insert(data.materials.end(), {material, material});
      }
    return *this;
  }
  /// Leaves of a size, anywhere in an ellipsoid.
  Builder& leaves(Dice& dice, const Vec3& middle, const Vec3& radii, int number, double size) {
    for (int k = 0; k < number; ++k) {
      Vec3 p;
      do p = {dice(-1, 1), dice(-1, 1), dice(-1, 1)};
      while (dot(p, p) > 1);
      const Vec3 u = normalize(Vec3{dice(-1, 1), dice(-1, 1), dice(-1, 1)}),
                 v = normalize(cross(u, Vec3{dice(-1, 1), dice(-1, 1), dice(-1, 1)}));
      quad(middle + Vec3{p.x * radii.x, p.y * radii.y, p.z * radii.z}, size * u, size * v);
    }
    return *this;
  }
  /// Ground of squares of a side about the origin.
  template <class Height>
  Builder& ground(double extent, double side, const Height& height) {
    const int n = static_cast<int>(extent / side);
    for (int i = -n; i < n; ++i)
      for (int j = -n; j < n; ++j) {
        const double x = i * side, y = j * side;
        const auto at = [&](double px, double py) { return Vec3{px, py, height(px, py)}; };
        const auto first = static_cast<std::uint32_t>(data.vertices.size());
        data.vertices.insert(data.vertices.end(), {at(x, y), at(x + side, y), at(x + side, y + side), at(x, y + side)});
        data.triangles.push_back({first, first + 1, first + 2});
        data.triangles.push_back({first, first + 2, first + 3});
        data.materials.insert(data.materials.end(), {material, material});
      }
    return *this;
  }
};

/// Pulses in lines, from a standpoint or from above; some with errors of their reported pose.
struct Lines {
  static constexpr double interval = 1e-3;  ///< of pulses [s]
  Vec3 from{};                              ///< [m]
  Vec3 step{};                              ///< from a pulse to the next [m]
  Rotation base = no_rotation;              ///< of the first pulse
  double across = 0, up = 0;                ///< from a pulse of a line to the next, from a line to the next [rad]
  PulseIndex in_line = 32, slots = 1;       ///< pulses in a line, and in all
  double moved = 0, turned = 0;             ///< deviation of reported poses [m], [rad]
  std::uint64_t seed = 0;
  Laser laser{};

  PulseIndex size() const noexcept { return slots; }
  Tick duration() const noexcept { return Tick::of_seconds(interval * static_cast<double>(slots)); }
  std::vector<Emitter> emitters() const { return {{.laser = laser}}; }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    Pulse<frame::World> p;
    const double column = static_cast<double>(i % in_line) - 0.5 * static_cast<double>(in_line),
                 line = static_cast<double>(i / in_line) - 0.5 * static_cast<double>(slots / in_line);
    p.tick = Tick::of_seconds(interval * static_cast<double>(i));
    p.pose.position = from + static_cast<double>(i) * step;
    p.pose.rotation = base * rotation_about(axis::up, column * across) * rotation_about(axis::right, line * up);
    if (moved > 0 || turned > 0) {
      const auto drawn = [&](std::uint32_t k) { return normal({seed, i, k, Purpose{130}}); };
      p.reported = p.pose;
      p.reported->position += moved * Vec3{drawn(0), drawn(1), drawn(2)};
      p.reported->rotation = p.pose.rotation * rotation_about(axis::up, turned * drawn(3));
    }
    return p;
  }
};
static_assert(WorldSource<Lines>);

/// A scene, and how it is surveyed.
struct ErrorScene {
  std::string name;
  std::function<void(Builder&, Dice&)> build;  ///< the objects, some 50 m along y from the origin, or under z = 100 m
  bool from_above = false;
  double divergence = 1e-3, spacing = 1.2e-3;  ///< [rad]
  std::size_t subrays = 7;
  double noise = 0.003;     ///< of ranges [m]
  double receiver = 0;      ///< noise of the receiver [W/sqrt(Hz)]
  double threshold = 2e-9;  ///< of echoes [W]
  double moved = 0, turned = 0;
  double speed = 0;  ///< of a part that moves: a box before what is built [m/s]
};

/// Surveys of the same slots: as they are run, and at reference quality.
struct SurveyPair {
  AnySurvey run, reference;
};

/// A scene, built once, for many small surveys.
class Surveyed {
 public:
  using Map = MovingScene<TriangleMesh<>>;
  static constexpr PulseIndex slots = 1024;
  static constexpr double duration = Lines::interval * static_cast<double>(slots);  ///< [s]

  explicit Surveyed(const ErrorScene& scene) : scene_(scene) {
    Builder builder;
    Dice dice(17);
    scene.build(builder, dice);
    const auto materials = material_table({{.name = "wall", .reflectance = 0.4, .classification = 6},
                                           {.name = "leaf", .reflectance = 0.25, .classification = 5},
                                           {.name = "ground", .reflectance = 0.2, .classification = 2},
                                           {.name = "dark", .reflectance = 0.05, .classification = 1}});
    std::vector<Map::Part> parts{
        {.geometry = std::make_shared<const TriangleMesh<>>(builder.data), .materials = materials}};
    if (scene.speed > 0) {
      Builder car;
      car.of(3).box({-1, 45, -1.5}, {1, 47, 1.5});
      parts.push_back({.geometry = std::make_shared<const TriangleMesh<>>(car.data),
                       .materials = materials,
                       .placement = {.translation = {-0.5 * scene.speed * duration, 0, 0}},
                       .object = 1,
                       .motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {scene.speed, 0, 0}})});
    }
    map_ = std::make_shared<const Map>(std::move(parts), MovingIndexSettings{.to = duration});
  }

  [[nodiscard]] SurveyPair survey(std::uint64_t number) const {
    Dice dice(1000 + number);
    const double side = 32 * scene_.spacing;
    Lines lines{.slots = slots, .seed = number};
    lines.laser = {.wavelength = 1064_nm, .peak_power = 1000_W, .pulse_length = 4_ns, .divergence = scene_.divergence};
    lines.across = lines.up = scene_.spacing;
    if (scene_.from_above) {
      lines.from = {dice(-15, 15), dice(-15, 15), 100};
      lines.base = rotation_about(axis::up, dice(0, 2 * pi)) * rotation_about(axis::right, -90_deg);
      lines.up = 0;
      lines.step = lines.base * (100 * scene_.spacing / 32 * axis::up);
    } else {
      lines.from = {dice(-3, 3), 0, dice(-1, 1)};
      lines.base = rotation_about(axis::up, dice(-1, 1) * side) * rotation_about(axis::right, dice(-1, 1) * side);
    }
    const auto survey = [&](const Lines& source, std::size_t subrays, const WaveformSettings& settings,
                            const RangeErrors& errors, double receiver_noise) {
      using Detector = FullWaveform<NoWidth, BandLimitedReceiver<>>;
      return AnySurvey(
          pulsecast::Survey(source, LatticeFootprint(subrays), *map_, Receiver{.range_errors = errors},
                            Detector(settings, {}, BandLimitedReceiver<>({.noise_power = receiver_noise})), number),
          map_);
    };
    Lines with_errors = lines;
    with_errors.moved = scene_.moved;
    with_errors.turned = scene_.turned;
    return {
        survey(with_errors, scene_.subrays, {.sample_interval = 0.5e-9, .threshold = scene_.threshold},
               {.deviation = scene_.noise}, scene_.receiver),
        survey(lines, 151,
               {.sample_interval = 0.125e-9, .threshold = scene_.threshold, .timing = EchoTiming::true_range}, {}, 0)};
  }

  [[nodiscard]] const std::shared_ptr<const Map>& map() const noexcept { return map_; }

 private:
  ErrorScene scene_;
  std::shared_ptr<const Map> map_{};
};

/// Limits of one figure, compared with the truth.
struct Coverage {
  std::size_t surveys = 0, held = 0;
  double widths = 0;    ///< sum of half the width of the limits by the value
  bool occurs = false;  ///< false: 0 in all surveys, which every limits hold

  void add(const Estimate& stated, const Estimate& truth) {
    ++surveys;
    const double rounding = 1e-9 * truth.value;
    held += stated.low <= truth.value + rounding && truth.value - rounding <= stated.high ? 1 : 0;
    occurs = occurs || truth.value > 0;
    widths += stated.value > 0 ? 0.5 * (stated.high - stated.low) / stated.value : 0;
  }
  void add(const Coverage& other) {
    surveys += other.surveys;
    held += other.held;
    widths += other.widths;
    occurs = occurs || other.occurs;
  }
  [[nodiscard]] double share() const {
    return surveys > 0 ? static_cast<double>(held) / static_cast<double>(surveys) : 1;
  }
  [[nodiscard]] double width() const { return surveys > 0 ? widths / static_cast<double>(surveys) : 0; }
};

/// Echoes of all slots of a survey, matched, in clusters of so many slots.
inline std::vector<EchoMatch> all_matches(const SurveyPair& surveys, const ErrorSampleOptions& options) {
  ErrorSampleOptions whole = options;
  whole.clusters = Surveyed::slots;
  const ErrorSample every(Surveyed::slots, whole);
  return pulsecast::detail::matches_of(every.simulate(surveys.reference), every.simulate(surveys.run), options.reach);
}

/// Adds what a sample of a survey states, and what is true, to the coverage of each figure.
inline void compare(const std::vector<EchoMatch>& all, const ErrorSampleOptions& options,
                    std::array<Coverage, error_figure_count>& coverage) {
  const std::size_t clusters = Surveyed::slots / options.length;
  const ErrorSample sample(Surveyed::slots, options);
  std::vector<EchoMatch> some;
  for (std::uint32_t k = 0; k < sample.blocks().size(); ++k)
    for (const EchoMatch& match : all)
      if (match.cluster == sample.blocks()[k].from / options.length) {
        some.push_back(match);
        some.back().cluster = k;
      }
  const EchoErrors stated = pulsecast::detail::errors_by_class("", some, sample.blocks().size(), sample.share()).all;
  const EchoErrors truth = pulsecast::detail::errors_by_class("", all, clusters, 1).all;
  for (std::size_t f = 0; f < error_figure_count; ++f)
    if (truth.pairs + truth.lost > 0) coverage[f].add(stated.figures[f], truth.figures[f]);
}

/// Coverage of each figure in a scene.
inline std::array<Coverage, error_figure_count> coverage_of(const ErrorScene& scene, std::size_t surveys) {
  const Surveyed surveyed(scene);
  std::array<Coverage, error_figure_count> coverage{};
  for (std::uint64_t number = 0; number < surveys; ++number) {
    const ErrorSampleOptions options{.seed = number, .clusters = 64};
    compare(all_matches(surveyed.survey(number), options), options, coverage);
  }
  return coverage;
}

/// Rough height of hills [m].
inline double hills(double x, double y) {
  return 3 * std::sin(x / 9) * std::cos(y / 11) + 0.4 * std::sin(x / 1.3 + y / 2.1) +
         0.1 * std::sin(5 * x) * std::sin(4 * y);
}

inline void wall_behind(Builder& b) { b.of(0).wall(60, -40, 40, -20, 20); }
inline double flat(double, double) { return 0; }

namespace detail {

inline void add_scenes_1(std::vector<ErrorScene>& all) {
  all.push_back({"wall", [](Builder& b, Dice&) { wall_behind(b); }});
  all.push_back({.name = "oblique wall",
                 .build =
                     [](Builder& b, Dice&) {
                       b.quad({-40, -40, -20}, {80, 200, 0}, {0, 0, 40});
                     },
                 .divergence = 2e-3,
                 .spacing = 3e-3});
  all.push_back({"steps", [](Builder& b, Dice&) {
                   wall_behind(b);
                   for (int k = -20; k < 20; k += 2) b.wall(50 + 0.3 * k, k * 0.4, k * 0.4 + 0.4, -20, 20);
                 }});
  all.push_back({"fence", [](Builder& b, Dice&) {
                   wall_behind(b);
                   for (int k = -200; k < 200; ++k) b.of(1).wall(50, k * 0.04, k * 0.04 + 0.01, -20, 20);
                 }});
  all.push_back({"wires before the sky", [](Builder& b, Dice& d) {
                   for (int k = 0; k < 60; ++k) {
                     const double y = d(45, 60), z = d(-4, 4);
                     b.of(3).quad({-40, y, z}, {80, 0, d(-2, 2)}, {0, 0, 0.02});
                   }
                 }});
  all.push_back({.name = "wood from above",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).ground(40, 2, [](double x, double y) { return 0.3 * hills(x, y); });
                       for (int k = 0; k < 60; ++k)
                         b.of(1).leaves(d, {d(-30, 30), d(-30, 30), d(6, 10)}, {2.5, 2.5, 4}, 250, 0.2);
                     },
                 .from_above = true,
                 .spacing = 3e-3});
  all.push_back({"wood", [](Builder& b, Dice& d) {
                   for (int k = 0; k < 30; ++k) {
                     const double x = d(-8, 8), y = d(35, 65);
                     b.of(3).box({x, y, -10}, {x + 0.3, y + 0.3, 10});
                     b.of(1).leaves(d, {x, y, d(-1, 5)}, {1.5, 1.5, 3}, 250, 0.1);
                   }
                 }});
  all.push_back({"facade", [](Builder& b, Dice&) {
                   for (int i = -10; i < 10; ++i)
                     for (int j = -6; j < 6; ++j) {
                       const double x = i * 1.5, z = j * 1.5;
                       b.of(0).wall(50, x, x + 0.5, z, z + 1.5).wall(50, x + 0.5, x + 1.5, z, z + 0.5);
                       b.of(3).wall(50.25, x + 0.5, x + 1.5, z + 0.5, z + 1.5);
                     }
                 }});
}

inline void add_scenes_2(std::vector<ErrorScene>& all) {
  all.push_back({.name = "hills from above",
                 .build = [](Builder& b, Dice&) { b.of(2).ground(45, 0.5, hills); },
                 .from_above = true,
                 .divergence = 3e-3,
                 .spacing = 4e-3,
                 .noise = 0.01,
                 .moved = 0.02});
  all.push_back({"holes", [](Builder& b, Dice& d) {
                   wall_behind(b);
                   for (int i = -150; i < 150; ++i)
                     for (int j = -80; j < 80; ++j)
                       if (d(0, 1) < 0.4) b.of(1).wall(52, 0.05 * i, 0.05 * i + 0.05, 0.05 * j, 0.05 * j + 0.05);
                 }});
  all.push_back({.name = "part that moves", .build = [](Builder& b, Dice&) { wall_behind(b); }, .speed = 10});
  all.push_back({"stairs", [](Builder& b, Dice&) {
                   for (int k = -30; k < 30; ++k) b.box({-20, 50 + 0.15 * k, -20}, {20, 50 + 0.15 * k + 0.15, 0.1 * k});
                 }});
  all.push_back({"balls", [](Builder& b, Dice& d) {
                   wall_behind(b);
                   for (int k = 0; k < 150; ++k) {
                     const double r = d.log(0.05, 0.6);
                     b.of(3).ellipsoid({d(-6, 6), d(45, 58), d(-4, 4)}, {r, r, 1.5 * r}, 8);
                   }
                 }});
  all.push_back({.name = "town from above",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).ground(45, 3, flat);
                       for (int k = 0; k < 150; ++k) {
                         const double x = d(-35, 35), y = d(-35, 35);
                         b.of(0).box({x, y, 0}, {x + d(1, 6), y + d(1, 6), d(0.2, 9)});
                       }
                     },
                 .from_above = true,
                 .spacing = 3e-3,
                 .turned = 1e-4});
  all.push_back({"painted wall", [](Builder& b, Dice& d) {
                   for (int i = -100; i < 100; ++i)
                     b.of(d(0, 1) < 0.5 ? 0 : 3).quad({0.1 * i, 50 + 0.05 * i, -20}, {0.1, 0.05, 0}, {0, 0, 40});
                 }});
  all.push_back({"rare poles", [](Builder& b, Dice& d) {
                   wall_behind(b);
                   for (int k = 0; k < 10; ++k) {
                     const double x = d(-6, 6);
                     b.of(3).wall(d(50, 58), x, x + 0.05, -20, 20);
                   }
                 }});
}

inline void add_scenes_3(std::vector<ErrorScene>& all) {
  all.push_back({.name = "weak echoes",
                 .build =
                     [](Builder& b, Dice& d) {
                       for (int i = -30; i < 30; ++i)
                         b.of(3).quad({0.3 * i, 60 + d(-3, 3), -20}, {0.3, 0, 0}, {0, 0, 40});
                     },
                 .noise = 0.02,
                 .receiver = 2e-13,
                 .threshold = 60e-9});
  all.push_back({"oblique grating", [](Builder& b, Dice&) {
                   wall_behind(b);
                   for (int k = -150; k < 150; ++k) b.of(0).quad({0.12 * k - 20, 52, -20}, {0.04, 0, 0}, {40, 0, 40});
                 }});
  all.push_back({.name = "line over hills",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).ground(45, 1, hills);
                       for (int k = 0; k < 25; ++k)
                         b.of(3).quad({-45, d(-20, 20), d(12, 20)}, {90, d(-8, 8), 0}, {0, 0.03, 0});
                     },
                 .from_above = true,
                 .spacing = 3e-3});
  all.push_back({.name = "grass",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).ground(35, 2, flat);
                       for (int k = 0; k < 30000; ++k)
                         b.of(1).quad({d(-25, 25), d(-25, 25), 0}, {d(-0.05, 0.05), d(-0.05, 0.05), 0},
                                      {d(-0.2, 0.2), d(-0.2, 0.2), d(0.2, 1)});
                     },
                 .from_above = true,
                 .spacing = 2e-3});
  all.push_back({.name = "cones from above",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).ground(45, 3, flat);
                       for (int k = 0; k < 120; ++k) {
                         const double r = d(0.5, 2), z = d(3, 10);
                         b.of(1).ellipsoid({d(-30, 30), d(-30, 30), 0.5 * z}, {r, r, 0.5 * z}, 8);
                       }
                     },
                 .from_above = true,
                 .spacing = 3e-3});
  all.push_back({"room", [](Builder& b, Dice& d) {
                   b.box({-6, -2, -3}, {6, 12, 3});
                   for (int k = 0; k < 40; ++k) {
                     const Vec3 p{d(-5, 5), d(4, 11), d(-2, 2)};
                     b.of(3).box(p, p + Vec3{d(0.05, 0.8), d(0.05, 0.8), d(0.05, 0.8)});
                   }
                 }});
}

inline void add_scenes_4(std::vector<ErrorScene>& all) {
  all.push_back({"scaffold", [](Builder& b, Dice&) {
                   b.of(0).wall(52, -40, 40, -20, 20);
                   for (int k = -20; k < 20; ++k) {
                     b.of(3).wall(51, k, k + 0.048, -20, 20);
                     b.of(3).wall(50.9, -40, 40, k, k + 0.048);
                   }
                 }});
  all.push_back(
      {.name = "roofs from above",
       .build =
           [](Builder& b, Dice& d) {
             b.of(2).ground(45, 3, flat);
             for (int k = 0; k < 60; ++k) {
               const double x = d(-30, 30), y = d(-30, 30), w = d(2, 5), h = d(2, 6);
               b.of(0).quad({x, y, h}, {w, 0, 0.8 * w}, {0, 8, 0}).quad({x + 2 * w, y, h}, {-w, 0, 0.8 * w}, {0, 8, 0});
             }
           },
       .from_above = true,
       .spacing = 3e-3,
       .moved = 0.01});
  all.push_back({"bushes", [](Builder& b, Dice& d) {
                   wall_behind(b);
                   for (int k = 0; k < 20; ++k)
                     b.of(1).leaves(d, {d(-6, 6), d(45, 55), d(-3, 3)}, {1, 1, 0.8}, 500, 0.05);
                 }});
  all.push_back({.name = "gravel, grazed",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).quad({-60, 5, -4}, {120, 0, 0}, {0, 80, 9});
                       for (int k = 0; k < 3000; ++k) {
                         const double s = d.log(0.03, 0.3);
                         const double y = d(25, 80);
                         const Vec3 p{d(-6, 6), y, -4 + (y - 5) * 9 / 80};
                         b.of(3).box(p, p + Vec3{s, s, s});
                       }
                     },
                 .spacing = 1e-3});
  all.push_back({.name = "part that moves, wood",
                 .build =
                     [](Builder& b, Dice& d) {
                       for (int k = 0; k < 25; ++k)
                         b.of(1).leaves(d, {d(-6, 6), d(40, 60), d(-3, 3)}, {1.5, 1.5, 1.5}, 300, 0.1);
                     },
                 .speed = 15});
  all.push_back({"blinds", [](Builder& b, Dice&) {
                   wall_behind(b);
                   for (int k = -200; k < 200; ++k) b.of(0).quad({-20, 50, 0.05 * k}, {40, 0, 0}, {0, 0.03, 0.03});
                 }});
}

inline void add_scenes_5(std::vector<ErrorScene>& all) {
  all.push_back({.name = "single rays in a wood",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).wall(65, -40, 40, -20, 20);
                       for (int k = 0; k < 25; ++k)
                         b.of(1).leaves(d, {d(-6, 6), d(40, 60), d(-3, 3)}, {1.5, 1.5, 1.5}, 300, 0.06);
                     },
                 .subrays = 1});
  all.push_back({.name = "fence, trees and hill",
                 .build =
                     [](Builder& b, Dice& d) {
                       b.of(2).quad({-60, 40, -5}, {120, 0, 0}, {0, 40, 15});
                       for (int k = -100; k < 100; ++k) b.of(3).wall(42, k * 0.12, k * 0.12 + 0.04, -5, 1);
                       for (int k = 0; k < 12; ++k)
                         b.of(1).leaves(d, {d(-6, 6), d(45, 60), d(0, 3)}, {1.5, 1.5, 2}, 300, 0.1);
                     },
                 .noise = 0.01,
                 .moved = 0.01});
}

}  // namespace detail

/// The scenes: with the first 15 the method of the limits was chosen, the others are held out.
[[nodiscard]] inline std::vector<ErrorScene> error_scenes() {
  std::vector<ErrorScene> all;
  detail::add_scenes_1(all);
  detail::add_scenes_2(all);
  detail::add_scenes_3(all);
  detail::add_scenes_4(all);
  detail::add_scenes_5(all);
  constexpr std::array<std::size_t, 4> subrays{7, 5, 4, 12};
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].subrays > 1) all[k].subrays = subrays[k % 4];
  return all;
}

}  // namespace stated
