// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_SENSOR_SHEET_HPP
#define PULSECAST_SENSOR_SENSOR_SHEET_HPP

#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>

namespace PULSECAST_NAMESPACE {

/// Source of a sensor whose mirror sweeps one beam, on a head.
using SweptSource = Deflector<RotatingHead, Deflector<RotatingHead, Deflector<PolygonMirror, Scanner>>>;
using PrismSource = Channels<Deflector<RisleyPrisms, Scanner>>;            ///< source of a sensor with prisms
using SensorSource = AnySource<SpinningSource, SweptSource, PrismSource>;  ///< source of any `SensorSheet`

/// Data sheet of a sensor whose kind is known at run time only. With `prisms`, its lasers shine through
/// these. With a `sweep_rate`, a mirror on the head sweeps its one laser. With a field of view of less
/// than a turn, its one laser turns and is blocked outside of it. All others are a `SpinningSensor`.
/// Members without effect on the kind keep their defaults. Slot i is laser `i % n` of n in sequence `i / n`.
struct SensorSheet : SpinningSensor {
  std::string packets{};        ///< format of its packets: `velodyne`, `ouster`; empty without one
  std::vector<Prism> prisms{};  ///< rotating wedges in the order of the beam
  double sweep_rate = 0;        ///< sweeps per second [Hz]
  double elevation_min = 0;     ///< low end of a sweep [rad]
  double elevation_max = 0;     ///< high end of a sweep [rad]
  double azimuth_min = -pi;     ///< field of view to the left of forward, negative [rad]
  double azimuth_max = pi;      ///< field of view to the right of forward [rad]

  void validate() const {
    SpinningSensor::validate();
    require_within("SensorSheet::sweep_rate", sweep_rate, 0, 1e12, "Hz");
    require_within("SensorSheet::azimuth_min", azimuth_min, -pi, pi, "rad");
    require_within("SensorSheet::azimuth_max", azimuth_max, azimuth_min, pi, "rad");
    const bool sweeps = prisms.empty() && sweep_rate > 0, spins = prisms.empty() && !is_swept();
    const auto unused = [](std::initializer_list<std::pair<const char*, double>> differences) {
      for (const auto& [member, difference] : differences)
        if (difference != 0) throw SettingError(member, " has no effect on this kind of sensor: expected its default");
    };
    if (!sweeps)
      unused({{"SensorSheet::sweep_rate", sweep_rate},
              {"SensorSheet::elevation_min", elevation_min},
              {"SensorSheet::elevation_max", elevation_max}});
    if (sweeps || !prisms.empty())
      unused({{"SensorSheet::azimuth_min", azimuth_min + pi}, {"SensorSheet::azimuth_max", azimuth_max - pi}});
    if (spins) return;
    unused({{"SpinningSensor::start", start}, {"SpinningSensor::exit_radius", exit_radius}});
    if (prisms.empty()) {
      require_within("SensorSheet::lasers (number with sweeps or a field of view)", lasers.size(), 1, 1);
      unused({{"SensorLaser::elevation", lasers[0].elevation},
              {"SensorLaser::azimuth", lasers[0].azimuth},
              {"SensorLaser::delay", lasers[0].delay}});
    }
    for (const SensorLaser& laser : lasers) unused({{"SensorLaser::height", laser.height}});
  }

  /// Source of all pulses of a time [s], rounded up to whole firing sequences. @throws SettingError
  [[nodiscard]] SensorSource source(double duration) const {
    validate();
    SpinningSource spinning = SpinningSensor::source(duration);
    const std::vector<Deflector<FixedBeam, Scanner>>& emitters = spinning.source().channels();
    if (prisms.empty()) return is_swept() ? SensorSource(swept(emitters[0].source())) : std::move(spinning);
    std::vector<Deflector<RisleyPrisms, Scanner>> lines;
    for (const auto& e : emitters)
      lines.push_back({{.prisms = prisms, .incident = e.moving().pose.rotation * axis::forward}, e.source()});
    std::size_t k = 0;  // one line after the other, at times without a period
    while (!lines[k % lines.size()].moving().open(Tick::of_seconds(0.618034 * static_cast<double>(k))))
      if (++k == 1000 + lines.size()) throw SettingError("Prism::wedge", " reflects all beams: expected a smaller one");
    return Channels{std::move(lines)};
  }

 private:
  [[nodiscard]] bool is_swept() const noexcept { return sweep_rate > 0 || azimuth_max - azimuth_min < 2 * pi; }

  /// Sweeps from low to high on a head, or turns from behind of a mirror that lies on its side.
  [[nodiscard]] SweptSource swept(const Scanner& scanner) const {
    const bool sweeps = sweep_rate > 0, right = rotation_rate > 0;
    const PolygonMirror mirror{.line_rate = sweeps ? sweep_rate : std::fabs(rotation_rate),
                               .sweep = sweeps ? (elevation_max - elevation_min) / 2 : pi,
                               .angle_min = right ? azimuth_min : -azimuth_max,
                               .angle_max = right ? azimuth_max : -azimuth_min};
    const double tilt = sweeps ? (elevation_min + elevation_max) / 2 : std::copysign(pi / 2, rotation_rate);
    return {{.angular_rate = sweeps ? -2 * pi * rotation_rate : 0},
            {{.angular_rate = 0, .start = tilt, .axis = sweeps ? axis::right : axis::forward}, {mirror, scanner}}};
  }
};
static_assert(InstrumentSource<SensorSource> && FindsSlots<SensorSource>);

}  // namespace PULSECAST_NAMESPACE

#endif
