// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Airborne scanner: overlapping strips over hills in alternating directions. Writes cloud.las, cloud.png and
// trajectory.txt.

#include <cmath>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/platform/block_flight.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "hills.hpp"
#include "summary.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Airplane on one pass: an oscillating mirror sweeps the beam across the track. The instrument looks down, its up axis
/// points to the right of the flight. Its lever arm is forward and below the airplane's origin.
auto airplane(const StraightLine& pass, double pulse_rate) {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 2500_W, .pulse_length = 4_ns, .divergence = 0.3_mrad};
  const auto pulses = static_cast<PulseIndex>(std::ceil(pass.duration().seconds() * pulse_rate));
  const OscillatingMirror mirror{.cycle_rate = 50_Hz, .half_angle = 18_deg, .turning_time = 1_ms};
  return Platform{
      pass, Mount{.lever_arm = {0.1, 1.4, -0.8}, .boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
      Deflector{mirror, Scanner{.pulse_rate = pulse_rate, .pulses = pulses, .laser = laser}}};
}

int main(int argc, char** argv) {
  CommandLine line("Scans generated hills from an airplane.");
  double height = 450, overlap_percent = 30, pulse_rate_kHz = 50;
  line.add_number("--height", height, 100, 5000, "M", "Flying height above the hills");
  line.add_number("--overlap", overlap_percent, 0, 90, "%", "Overlap of neighbouring strips");
  line.add_number("--pulse-rate", pulse_rate_kHz, 1, 2000, "kHz", "Pulse rate of the laser");

  return line.run(argc, argv, [&] {
    const auto scene = hills::scene(line.seed);
    const std::vector<StraightLine> strips = plan_block_flight({.area = scene.bounds(),
                                                                .altitude = scene.bounds().centre().z + height,
                                                                .swath = 2 * height * std::tan(18_deg),
                                                                .overlap = overlap_percent / 100});
    const auto pass = [&](const StraightLine& path) { return airplane(path, 1e3 * pulse_rate_kHz); };
    std::vector<Leg<decltype(pass({}))>> legs;
    for (const StraightLine& strip : strips) {
      if (!legs.empty()) {  // turn: takes time, without pulses
        const StraightLine turn{.from = legs.back().platform.trajectory().to, .to = strip.from, .speed = 5};
        legs.push_back({.platform = pass(turn), .active = false});
      }
      legs.push_back({.platform = pass(strip)});
    }

    const Survey survey{Legs{legs}, RingFootprint{2}, scene, Receiver{}, FullWaveform{{.threshold = 20_nW}}, line.seed};
    io::LasWriter las(line.output / "cloud.las");
    io::ImageWriter image(line.output / "cloud.png",
                          {.azimuth = 15_deg, .elevation = 35_deg, .colour_by = io::ColourBy::classification});
    const RunSummary summary = run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image);

    las.close();
    image.close();
    io::TrajectoryWriter trajectory(line.output / "trajectory.txt");
    for (std::size_t k = 0; k < legs.size(); ++k)
      trajectory.add(legs[k].platform.trajectory(), survey.source().start(k), legs[k].platform.duration(), 0.1);
    trajectory.close();

    const Vec3 size = scene.bounds().size();
    std::cout << "Flew " << strips.size() << " strips over " << std::round(size.x) << " m by " << std::round(size.y)
              << " m; the results are in " << line.output.string() << ".\n";
    print(summary);
    std::cout << "  density      " << std::setw(12) << static_cast<double>(summary.echoes) / (size.x * size.y)
              << " points/m^2\n";
  });
}
