// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_SPINNING_SENSOR_HPP
#define PULSECAST_SENSOR_SPINNING_SENSOR_HPP

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>

namespace PULSECAST_NAMESPACE {

/// Laser of a spinning sensor, in the frame of its head.
struct SensorLaser {
  double elevation = 0;  ///< angle above the head's equator [rad]
  double azimuth = 0;    ///< angle from the head's heading to the right, as seen from above [rad]
  double height = 0;     ///< exit above the sensor's origin [m]
  double delay = 0;      ///< time after the sequence's begin; does not decrease [s]
};

using SpinningSource = Deflector<RotatingHead, Channels<Deflector<FixedBeam, Scanner>>>;  ///< its source

/// Data sheet of a lidar with a column of lasers on a head that spins about the sensor's up axis.
/// All lasers fire once in each firing sequence. Of n lasers, slot i of its source is laser `i % n`
/// in sequence `i / n`, and the number of the laser is the shot's channel.
struct SpinningSensor {
  std::string name{};                 ///< model
  std::vector<SensorLaser> lasers{};  ///< lasers in the order of firing
  double sequence_rate = 18e3;        ///< firing sequences per second, from 1 to 1e9 [Hz]
  double rotation_rate = 10;          ///< turns of the head, to the right as seen from above [Hz]
  double start = 0;                   ///< first heading, from forward to the right [rad]
  double exit_radius = 0;             ///< distance of the exits from the axis [m]
  Laser beam{};                       ///< every laser's beam
  double range_min = 0;               ///< minimum measured range [m]
  double range_max = 100;             ///< maximum measured range [m]
  double range_deviation = 0;         ///< standard deviation of measured ranges [m]

  void validate() const {
    require_within("SpinningSensor::lasers (number)", lasers.size(), 1, max_emitters, "");
    require_within("SpinningSensor::sequence_rate", sequence_rate, 1, 1e9, "Hz");
    require_within("SpinningSensor::rotation_rate", rotation_rate, -1e6, 1e6, "Hz");
    require_angle("SpinningSensor::start", start);
    require_finite("SpinningSensor::exit_radius", exit_radius, "m");
    for (const SensorLaser& laser : lasers) {
      require_within("SensorLaser::elevation", laser.elevation, -pi / 2, pi / 2, "rad");
      require_angle("SensorLaser::azimuth", laser.azimuth);
      require_finite("SensorLaser::height", laser.height, "m");
    }
  }

  /// Heading of the head at a time: angle from forward to the right, in [0, 2 pi) [rad].
  [[nodiscard]] double heading(Tick t) const noexcept {
    const double angle = start + 2 * pi * t.phase(rotation_rate);
    const double rest = angle - 2 * pi * std::floor(angle / (2 * pi));
    return rest < 2 * pi ? rest : 0;
  }

  /// Begin of a firing sequence.
  [[nodiscard]] Tick sequence_start(PulseIndex sequence) const noexcept { return Tick::of(sequence, sequence_rate); }
  /// First slot of the first firing sequence that begins at a time or after it.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept {
    return lasers.size() * Scanner{.pulse_rate = sequence_rate, .pulses = PulseIndex{1} << 52}.slot_from(t);
  }

  /// Source of all pulses of a time [s], rounded up to whole firing sequences. @throws SettingError
  [[nodiscard]] SpinningSource source(double duration) const {
    validate();
    require_not_negative("SpinningSensor::source (duration)", duration, "s");
    const auto sequences = static_cast<PulseIndex>(std::ceil(duration * sequence_rate * (1 - 1e-15)));
    std::vector<Deflector<FixedBeam, Scanner>> emitters;
    Scanner scanner{.pulse_rate = sequence_rate, .pulses = sequences, .laser = beam};
    for (const SensorLaser& laser : lasers) {
      scanner.delay = laser.delay;
      emitters.push_back({{aimed_at(laser.azimuth, laser.elevation, {0, exit_radius, laser.height})}, scanner});
    }
    return {{.angular_rate = -2 * pi * rotation_rate, .start = -start}, Channels{std::move(emitters)}};
  }

  /// Receiver with the sensor's range gate and noise.
  [[nodiscard]] Receiver receiver() const {
    return {.range_min = range_min, .range_max = range_max, .range_errors = {.deviation = range_deviation}};
  }

  /// Ring of each laser: its place from the lowest elevation up, from 0.
  [[nodiscard]] std::vector<std::uint16_t> rings() const {
    std::vector<std::uint16_t> rings;
    for (const SensorLaser& laser : lasers) {
      const auto lower = [&](const SensorLaser& other) { return other.elevation < laser.elevation; };
      rings.push_back(static_cast<std::uint16_t>(std::count_if(lasers.begin(), lasers.end(), lower)));
    }
    return rings;
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
