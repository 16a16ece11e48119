// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Scan pattern of each optic on a floor of blue and orange squares, ten metres wide. Writes one picture per optic, seen
// from above.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/deflector/fiber_array.hpp>
#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/deflector/pattern_table.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Plane z = 0 with a chessboard pattern.
struct PaintedFloor {
  enum Class : std::uint16_t { orange = 6, blue = 9 };  // codes of building and water in the colour map of classes

  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range < ray.far)) return std::nullopt;
    const Vec3 p = ray.origin + range * ray.direction;
    const bool even = std::fmod(std::floor(p.x / 10) + std::floor(p.y / 10), 2) == 0;
    const double cosine = -ray.direction.z;
    return Hit{
        .range = range, .cos_incidence = cosine, .backscatter = 0.5 * cosine, .classification = even ? blue : orange};
  }
};
static_assert(Target<PaintedFloor>);

/// Picture that collects the points of several instruments.
class Picture {
 public:
  Picture(const CommandLine& line, const std::string& name)
      : threads_(line.threads),
        image_(line.output / (name + ".png"), {.width = 1000,
                                               .height = 500,
                                               .azimuth = 0,
                                               .elevation = 90_deg,
                                               .field_of_view = 0,
                                               .colour_by = io::ColourBy::classification,
                                               .point_size = 3,
                                               .background = {250, 250, 247}}) {}

  /// Flight to the north at 60 m/s and 100 m height, for the duration of the scanner. The beam points down; the optic's
  /// up axis points to the right.
  Picture& flight(double x, const InstrumentSource auto& instrument) {
    const double way = 60 * instrument.duration().seconds();
    return scan(Platform{StraightLine{.from = {x, -way / 2, 100}, .to = {x, way / 2, 100}, .speed = 60}, looking_down(),
                         instrument});
  }

  /// Fixed position at the same height, looking down.
  Picture& balloon(double x, const InstrumentSource auto& instrument) {
    return scan(Platform{Tripod{.position = {x, 0, 100}}, looking_down(), instrument});
  }

  /// Upright on a tripod of two metres.
  Picture& tripod(double x, const InstrumentSource auto& instrument) {
    return scan(Platform{Tripod{.position = {x, 0, 2}}, Mount{}, instrument});
  }

  void close() { image_.close(); }

 private:
  static Mount looking_down() {
    return {.boresight = rotation_about(axis::up, -90_deg) * rotation_about(axis::right, -90_deg)};
  }

  Picture& scan(const WorldSource auto& device) {
    const PaintedFloor floor;
    run(Survey{device, SingleRay{}, floor, Receiver{}, FirstHit{}}, {.threads = threads_}, image_);
    return *this;
  }

  unsigned threads_;
  io::ImageWriter image_;
};

/// Scanner of 4,000 pulses in one second.
constexpr Scanner slow{.pulse_rate = 4_kHz, .pulses = 4000};

void draw_lines(const CommandLine& line) {
  const OscillatingMirror triangle{.cycle_rate = 7, .half_angle = 20_deg, .turning_time = 20_ms};
  const OscillatingMirror sine{.cycle_rate = 7, .half_angle = 20_deg, .swing = Swing::sine};
  Picture(line, "oscillating_mirror").flight(-45, Deflector{triangle, slow}).flight(45, Deflector{sine, slow}).close();

  const PolygonMirror plain{.line_rate = 30, .sweep = 45_deg, .angle_min = -20_deg, .angle_max = 20_deg};
  PolygonMirror tilted = plain;
  tilted.facet_tilts = {-0.7_deg, 0, 0.7_deg};
  const Scanner fast{.pulse_rate = 9_kHz, .pulses = 9000};  // the gate passes four in nine
  Picture(line, "polygon_mirror").flight(-45, Deflector{plain, fast}).flight(45, Deflector{tilted, fast}).close();

  const FiberArray fibers{.fibers = 64, .fiber_rate = slow.pulse_rate, .half_angle = 20_deg};
  Picture(line, "fiber_array").flight(0, Deflector{fibers, slow}).close();
}

void draw_curves(const CommandLine& line) {
  const PalmerMirror round{.rotation_rate = 12, .half_angle = 18_deg};
  const PalmerMirror flat{.rotation_rate = 12, .half_angle = 18_deg, .half_angle_across = 9_deg};
  Picture(line, "palmer_mirror").flight(-45, Deflector{round, slow}).flight(45, Deflector{flat, slow}).close();

  RisleyPrisms prisms{.prisms = {{.wedge = 18.7_deg, .rotation_rate = -121.6},
                                 {.wedge = 18.0_deg, .rotation_rate = 77.7, .inclined_exit = true}}};
  const Scanner fast{.pulse_rate = 100_kHz, .pulses = 12'000};
  Picture rosettes(line, "risley_prisms");
  rosettes.balloon(-45, Deflector{prisms, fast});
  prisms.prisms.push_back({.wedge = 8_deg, .rotation_rate = 10, .inclined_exit = true});
  rosettes.balloon(55, Deflector{prisms, fast}).close();

  PatternTable sunflower{.entry_rate = slow.pulse_rate};
  for (int k = 0; k < 2000; ++k) {  // Source: Vogel 1979
    const double angle = k * pi * (3 - std::sqrt(5.0)), off = 20_deg * std::sqrt(k / 2000.0);
    sunflower.entries.push_back({.azimuth = off * std::sin(angle), .elevation = off * std::cos(angle)});
  }
  Picture(line, "pattern_table").balloon(0, Deflector{sunflower, slow}).close();
}

void draw_heads(const CommandLine& line) {
  const Deflector circling{RotatingHead{.angular_rate = 37 * 360_deg, .axis = {0, std::cos(10_deg), std::sin(10_deg)}},
                           Deflector{FixedBeam{aimed_at(0, 19_deg)}, Scanner{.pulse_rate = 12_kHz, .pulses = 12'000}}};
  const Deflector circling_in_a_circle{RotatingHead{.angular_rate = -3 * 360_deg, .axis = axis::forward}, circling};
  Picture(line, "rotating_head").balloon(-45, circling).balloon(45, circling_in_a_circle).close();

  std::vector<Deflector<FixedBeam, Scanner>> beams;  // sixteen beams in turn
  for (int k = 0; k < 16; ++k)
    beams.emplace_back(FixedBeam{aimed_at(0, radians(-25 + k))},
                       Scanner{.pulse_rate = 5_kHz, .pulses = 500, .delay = k * 10_us});
  const Deflector spinning{RotatingHead{.angular_rate = -10 * 360_deg}, Channels{beams}};
  const Deflector tilted{RotatingHead{.angular_rate = 0, .start = -4_deg, .axis = axis::right}, spinning};
  Picture(line, "channels").tripod(-14, spinning).tripod(20, tilted).close();
}

int main(int argc, char** argv) {
  CommandLine line("Draws the scan pattern of each optic on a floor.");
  return line.run(argc, argv, [&] {
    draw_lines(line);
    draw_curves(line);
    draw_heads(line);
    std::cout << "The patterns of all optics are in " << line.output.string() << ".\n";
  });
}
