// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// User-defined optic: two rotating prisms draw a rosette. Writes custom_deflector.png.

#include <cmath>

#include <pulsecast/io/png.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "summary.hpp"
#include "wood.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Two thin prisms in series. Each bends the beam by the same angle towards its own rotation angle.
struct Rosette {
  double bend;           ///< deflection by each prism [rad]
  double first, second;  ///< rotation rates of the prisms, negative for the opposite direction [Hz]

  /// The only function that the `Optic` concept requires.
  Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept {
    const double a = 2 * pi * t.phase(first), b = 2 * pi * t.phase(second);
    const double aside = bend * (std::cos(a) + std::cos(b)), upwards = bend * (std::sin(a) + std::sin(b));
    return {rotation_about(axis::up, -aside) * rotation_about(axis::right, upwards), {}};
  }
};
static_assert(Optic<Rosette>);

int main(int argc, char** argv) {
  CommandLine line("Scans a wood from a captive balloon through a user-defined optic.");
  return line.run(argc, argv, [&] {
    const auto scene = wood::scene(line.seed);
    const Scanner scanner{.pulse_rate = 200_kHz, .pulses = 400'000};
    const Deflector deflector{Rosette{.bend = 11_deg, .first = 41.5_Hz, .second = -23_Hz}, scanner};
    const Mount downwards{.boresight = rotation_about(axis::right, -90_deg)};
    const Platform balloon{Tripod{.position = {0, 0, 80}}, downwards, deflector};
    const Survey survey{balloon, LatticeFootprint{19}, scene, Receiver{}, FullWaveform{}, line.seed};

    io::ImageWriter map(line.output / "custom_deflector.png",
                        {.width = 1200, .height = 1200, .azimuth = 0, .elevation = 90_deg});
    print(run(survey, {.threads = line.threads, .progress = ProgressLine{}}, map));
    map.close();
  });
}
