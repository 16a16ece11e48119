// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Scanner under a drone: it rises before a hut in a wood, flies rows over the trees, hovers, and comes down again. It
// banks in turns, and the beam with it. Writes cloud.las, cloud.png, trajectory.txt and page.html, the cloud in a
// browser.

#include <cmath>
#include <iostream>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/page/page.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "summary.hpp"
#include "wood.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Route: up from a glade, over the wood in rows, and down to the glade again.
std::vector<FlightPoint> route(const Vec3& glade, double height) {
  std::vector<FlightPoint> points{{glade}, {glade + height * axis::up}};
  bool north = true;
  for (const double row : {-24.0, -8.0, 8.0, 24.0}) {
    for (const double end : {-30.0, 30.0}) points.push_back({{row, north ? end : -end, glade.z + height}});
    north = !north;
  }
  points.push_back({glade + height * axis::up, 2});
  points.push_back({glade + 1.0 * axis::up});
  return points;
}

int main(int argc, char** argv) {
  CommandLine line("Scans a generated wood from a drone.");
  double height = 45, speed = 6, pulse_rate_kHz = 12;
  bool stop = false;
  line.add_number("--height", height, 35, 500, "M", "Flying height above the glade at the start");
  line.add_number("--speed", speed, 0.5, 25, "M/S", "Maximum speed of the drone");
  line.add_number("--pulse-rate", pulse_rate_kHz, 1, 1000, "kHz", "Pulse rate of the laser");
  line.add_flag("--stop-and-turn", stop, "Hover to turn, instead of banked turns");

  return line.run(argc, argv, [&] {
    const auto scene = wood::scene(line.seed);
    const MulticopterFlight flight =
        plan_multicopter(route(wood::glades(line.seed)[0], height),
                         {.speed = speed,
                          .turn = stop ? MulticopterTurn::stop_and_turn : MulticopterTurn::smooth,
                          .arrival_heading = 0});

    const Laser laser{.wavelength = 1550_nm, .peak_power = 100_W, .pulse_length = 3_ns, .divergence = 0.5_mrad};
    const double pulse_rate = 1e3 * pulse_rate_kHz;
    const Scanner scanner{.pulse_rate = pulse_rate,
                          .pulses = static_cast<PulseIndex>(flight.duration().seconds() * pulse_rate),
                          .laser = laser};
    const PolygonMirror mirror{.line_rate = 40_Hz, .sweep = 45_deg};
    // The instrument looks down; its up axis points to the right of the flight.
    const Platform drone{
        flight,
        Mount{.lever_arm = {0, 0.1, -0.25}, .boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
        Deflector{mirror, scanner}};

    const Survey survey{drone, RingFootprint{2}, scene, Receiver{}, FullWaveform{}, line.seed};
    io::LasWriter las(line.output / "cloud.las");
    io::ImageWriter image(line.output / "cloud.png",
                          {.azimuth = 20_deg, .elevation = 40_deg, .field_of_view = 20_deg, .point_size = 3});
    page::PageWriter page(
        line.output / "page.html",
        {.name = "Wood", .platform = "Drone", .legs = {page::page_leg("flight", flight, {}, flight.duration())}});
    const RunSummary summary = run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image, page);

    las.close();
    image.close();
    page.close();
    io::TrajectoryWriter trajectory(line.output / "trajectory.txt");
    trajectory.add(flight, {}, flight.duration(), 0.1);
    trajectory.close();

    std::cout << "Flew for " << std::round(flight.duration().seconds()) << " s; the results are in "
              << line.output.string() << ".\n";
    print(summary);
  });
}
