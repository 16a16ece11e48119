// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Two scanners on the roof of a car in a small town. The car turns right, reverses to turn round where the street is
// too narrow for a curve, and drives on. Writes cloud.las, cloud.png and trajectory.txt.

#include <cmath>
#include <iostream>
#include <optional>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "street.hpp"
#include "summary.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// One of the scanners: its beam rotates in a vertical plane at `angle` to the driving direction [rad].
auto scanner(const GroundVehicleDrive& drive, double angle, double pulse_rate) {
  const Laser laser{.wavelength = 905_nm, .peak_power = 75_W, .pulse_length = 5_ns, .divergence = 0.5_mrad};
  const auto pulses = static_cast<PulseIndex>(drive.duration().seconds() * pulse_rate);
  return Platform{drive, Mount{.lever_arm = {0, 1.1, 2.1}, .boresight = rotation_about(axis::up, angle)},
                  Deflector{PolygonMirror{.line_rate = 60_Hz, .sweep = 180_deg},
                            Scanner{.pulse_rate = pulse_rate, .pulses = pulses, .laser = laser}}};
}

int main(int argc, char** argv) {
  CommandLine line("Scans the streets of a generated small town from a car.");
  double speed_kmh = 30, pulse_rate_kHz = 40;
  line.add_number("--speed", speed_kmh, 1, 100, "KM/H", "Speed of the car on straight roads");
  line.add_number("--pulse-rate", pulse_rate_kHz, 1, 1000, "kHz", "Pulse rate of each of the two scanners");

  return line.run(argc, argv, [&] {
    const auto scene = street::scene(line.seed);
    const std::vector<Vec2> way{{1.9, -80}, {1.9, -1.9}, {40, -1.9}, {48, -0.6}, {38, 1.9}, {1.9, 1.9}, {1.9, 80}};
    const auto ground = [&](const Vec2& place, auto... near) { return scene.ground_height(place, near...); };
    const GroundVehicleDrive drive = plan_ground_vehicle(way, ground, {.speed = speed_kmh / 3.6});
    const double pulse_rate = 1e3 * pulse_rate_kHz;
    const Channels both{std::vector{scanner(drive, 45_deg, pulse_rate), scanner(drive, -45_deg, pulse_rate)}};

    const Survey survey{both, SingleRay{}, scene, Receiver{.range_min = 1.5}, FullWaveform{}, line.seed};
    io::LasWriter las(line.output / "cloud.las");
    io::ImageWriter image(line.output / "cloud.png",
                          {.azimuth = 65_deg, .elevation = 42_deg, .colour_by = io::ColourBy::classification});
    const RunSummary summary = run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image);

    las.close();
    image.close();
    io::TrajectoryWriter trajectory(line.output / "trajectory.txt");
    trajectory.add(drive, {}, drive.duration(), 0.1);
    trajectory.close();

    const auto& last = drive.sections().back();
    std::cout << "Drove " << std::round(last.start + last.path.length) << " m in "
              << std::round(drive.duration().seconds()) << " s; the results are in " << line.output.string() << ".\n";
    print(summary);
  });
}
