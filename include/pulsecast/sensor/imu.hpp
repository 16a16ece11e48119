// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_IMU_HPP
#define PULSECAST_SENSOR_IMU_HPP

#include <pulsecast/platform/derivatives.hpp>

namespace PULSECAST_NAMESPACE {

/// What an inertial sensor measures, in its own axes, at `tick` and in the interval that ends there.
///
/// Increments are those of a strapdown system after compensation of coning, sculling and rotation (Savage 1998, parts 1
/// and 2): the angle increment is the rotation vector between the attitudes at both ends, and the velocity increment is
/// in the axes at the begin of the interval. So `v += R dv + g dt; R *= rotation_by(dtheta)` returns velocity and
/// attitude exactly, and the trapezoidal rule the path. Integrals in the moving axes differ from these by half the
/// cross product of two increments.
struct ImuSample {
  Tick tick{};                ///< end of the interval
  double interval = 0;        ///< length of the interval [s]
  Vec3 angle_increment{};     ///< angular rate, integrated over the interval: a rotation vector [rad]
  Vec3 velocity_increment{};  ///< specific force, integrated over the interval, in the axes at its begin [m/s]
  Vec3 angular_rate{};        ///< at `tick` [rad/s]
  Vec3 specific_force{};      ///< acceleration less gravity, at `tick` [m/s2]

  [[nodiscard]] Tick middle() const noexcept { return tick - Tick::of_seconds(interval / 2); }  ///< of the interval
  /// Means over the interval, as the filter of a real sensor gives, with what happens between: rates [rad/s], and
  /// specific forces in the axes in the middle [m/s^2]. The midpoint rule integrates them as exactly as the increments.
  [[nodiscard]] Vec3 mean_angular_rate() const noexcept { return angle_increment / interval; }
  [[nodiscard]] Vec3 mean_specific_force() const noexcept {
    return rotation_by(-0.5 * angle_increment) * velocity_increment / interval;
  }
};

/// Gravity and rotation of the earth, both constant over the map, whose z is up along the plumb line.
///
/// Left out: the turn of the map as it follows the curved earth (transport rate, 1.6e-7 rad/s per m/s), and the change
/// of gravity over the map. Source: Groves 2013, Principles of GNSS, Inertial, and Multisensor Integrated Navigation
/// Systems, sec. 5.4.
struct Earth {
  double gravity = standard_gravity;  ///< with the centrifugal acceleration [m/s^2]
  double angular_rate = 0;            ///< of the earth; 0 for a map that does not turn [rad/s]
  double latitude = 0;                ///< geodetic, positive to the north [rad]

  void validate() const {
    require_within("Earth::gravity", gravity, 0, 1e3, "m/s^2");
    require_within("Earth::angular_rate", angular_rate, -1, 1, "rad/s");
    require_within("Earth::latitude", latitude, -pi / 2, pi / 2, "rad");
  }
  /// Angular rate of the map, in its axes [rad/s]. Source: Groves 2013, eq. 2.123, here east, north, up.
  [[nodiscard]] Vec3 map_rate() const noexcept {
    return angular_rate * Vec3{0, std::cos(latitude), std::sin(latitude)};
  }
};

/// Rotating earth with normal gravity at a latitude [rad] and a height above the ellipsoid [m]. Throws a
/// `SettingError`. Source: NIMA TR8350.2, WGS 84, 3rd edition 2000, eq. 4-1 and 4-3 (Somigliana), tables 3.1 to 3.4.
[[nodiscard]] inline Earth wgs84_earth(double latitude, double height = 0) {
  constexpr double a = 6378137, flattening = 1 / 298.257223563, m = 0.00344978650684;
  require_within("wgs84_earth (height)", height, -1e4, 1e5, "m");
  const double sine = std::sin(latitude), square = sine * sine;
  const double normal = 9.7803253359 * (1 + 0.00193185265241 * square) / std::sqrt(1 - 0.00669437999014 * square);
  const double up = height / a, less = 2 * (1 + flattening + m - 2 * flattening * square) * up;
  return validated(
      Earth{.gravity = normal * (1 - less + 3 * up * up), .angular_rate = 7.292115e-5, .latitude = latitude});
}

/// Errors of three gyroscopes (x in rad) or accelerometers (x in m/s), none by default. Noise is given by the
/// coefficients of its Allan deviation, by averaging time T [s]. Source: IEEE Std 952-1997, annex C.
struct InertialErrors {
  Vec3 bias{};                  ///< constant error [x/s]
  double bias_deviation = 0;    ///< standard deviation of a further one, drawn once an axis [x/s]
  double random_walk = 0;       ///< N, of angle or velocity: white noise, N / sqrt(T) [x/s^0.5]
  double bias_instability = 0;  ///< B, flicker noise: 0.664 B, the floor; from the start on some 2.6 B [x/s]
  double rate_random_walk = 0;  ///< K: K sqrt(T / 3) [x/s^1.5]
  Matrix3 gain{1};              ///< from true to measured rates: scale factors, and misalignment beside the diagonal
  double range = detail::infinity;  ///< largest rate either way; more is cut off, of increments the mean [x/s]
  double resolution = 0;            ///< step of rates, and of increments by the interval, 0 for none [x/s]

  void validate() const {
    require_finite("InertialErrors::bias (length)", length(bias), "");
    require_not_negative("InertialErrors::bias_deviation", bias_deviation, "");
    require_not_negative("InertialErrors::random_walk", random_walk, "");
    require_not_negative("InertialErrors::bias_instability", bias_instability, "");
    require_not_negative("InertialErrors::rate_random_walk", rate_random_walk, "");
    for (int k = 0; k < 3; ++k) require_finite("InertialErrors::gain (column)", length(gain[k]), "");
    if (!(range > 0)) throw_setting_error("InertialErrors::range", range, "", "greater than 0");
    require_not_negative("InertialErrors::resolution", resolution, "");
  }
};

/// Data sheet of an inertial sensor, exact by default.
struct ImuSettings {
  double sample_rate = 400;        ///< [Hz]
  InertialErrors gyroscope{};      ///< errors of angular rates
  InertialErrors accelerometer{};  ///< errors of specific forces
  Earth earth{};                   ///< gravity, and rotation of the map
  std::uint64_t seed = 0;          ///< of all draws

  void validate() const {
    require_rate("ImuSettings::sample_rate", sample_rate);
    naming("ImuSettings::gyroscope", [&] { gyroscope.validate(); });
    naming("ImuSettings::accelerometer", [&] { accelerometer.validate(); });
    earth.validate();
  }
};

namespace detail {
/// Errors by data sheet, where bias instability is the lowest point of the Allan deviation, 0.664 B.
[[nodiscard]] inline InertialErrors errors_on_sheet(double random_walk, double lowest, double range, double step = 0) {
  return {.random_walk = random_walk, .bias_instability = lowest / 0.664, .range = range, .resolution = step};
}
}  // namespace detail

/// Consumer grade: white noise alone, so that it drifts least of the three until its bias is set. Its sheet has no bias
/// instability, and biases as tolerances only, 20 deg/s and 50 to 80 mg. Source: InvenSense
/// MPU-6000/MPU-6050 product specification, rev. 3.4, sec. 6.1, 6.2, for 2000 deg/s and 16 g.
[[nodiscard]] inline ImuSettings mpu_6050(double sample_rate = 400) {
  constexpr double g = standard_gravity;
  return {.sample_rate = sample_rate,
          .gyroscope = detail::errors_on_sheet(radians(0.005), 0, radians(2000), radians(1 / 16.4)),
          .accelerometer = detail::errors_on_sheet(400e-6 * g, 0, 16 * g, g / 2048)};
}
/// Industrial grade. Source: Xsens MTi 1-series, as in Transactions on Aerospace Research 2023, doi
/// 10.2478/tar-2023-0022: 0.007 deg/s/sqrt(Hz), 10 deg/h, 2000 deg/s; 120 ug/sqrt(Hz), 0.03 mg, 16 g.
[[nodiscard]] inline ImuSettings mti_1(double sample_rate = 400) {
  constexpr double g = standard_gravity;
  return {.sample_rate = sample_rate,
          .gyroscope = detail::errors_on_sheet(radians(0.007), radians(10.0 / 3600), radians(2000)),
          .accelerometer = detail::errors_on_sheet(120e-6 * g, 0.03e-3 * g, 16 * g)};
}
/// Tactical grade. Source: Safran (Sensonor) STIM300, data sheet TS1524, for 10 g: 0.15 deg/sqrt(h), 0.5 deg/h,
/// 400 deg/s; 0.06 m/s/sqrt(h), 0.05 mg.
[[nodiscard]] inline ImuSettings stim_300(double sample_rate = 400) {
  constexpr double g = standard_gravity;
  return {.sample_rate = sample_rate,
          .gyroscope = detail::errors_on_sheet(radians(0.15) / 60, radians(0.5 / 3600), radians(400)),
          .accelerometer = detail::errors_on_sheet(0.06 / 60, 0.05e-3 * g, 10 * g)};
}

namespace detail {

/// Noise of one axis of an inertial sensor, as its mean over each interval: a pure function of the sample's number.
/// The Allan deviation of flicker noise is flat within 1 % from 8 samples to 2^27, and 3 % less at one sample.
class InertialNoise {
 public:
  InertialNoise(const InertialErrors& errors, double interval, std::uint64_t seed, std::uint32_t axis)
      : seed_(seed),
        axis_(axis),
        bias_(errors.bias_deviation * draw(0, bias_draw)),
        walk_(errors.rate_random_walk * std::sqrt(interval)),
        // floor of the Allan variance: 2 ln(2) / pi B^2; that of the processes of unit variance below: 0.66571
        flicker_(errors.bias_instability * std::sqrt(2 * std::numbers::ln2 / pi / 0.66571)),
        // and what both have within an interval: the mean of a Brownian bridge has the variance 1/12
        white_(std::sqrt(errors.random_walk * errors.random_walk / interval + walk_ * walk_ / 12 +
                         0.442 * flicker_ * flicker_)) {}

  [[nodiscard]] double mean(PulseIndex i) const noexcept {
    return bias_ + (white_ > 0 ? white_ * draw(i, white_draw) : 0) + (flicker_ > 0 ? flicker_ * flicker(i) : 0) +
           (walk_ > 0 ? walk_ * walk(i) : 0);
  }

 private:
  static constexpr std::uint32_t white_draw = 0, bias_draw = 1, flicker_draw = 64, block_draw = 128, bridge_draw = 192;

  [[nodiscard]] double draw(PulseIndex number, std::uint32_t what) const noexcept {
    return normal({seed_, number, what, Purpose::inertial_noise, axis_});
  }

  /// Flicker noise as a sum of processes, each linear between independent draws every 2^level samples, out of step with
  /// the others. Source: Voss & Clarke 1978, "1/f noise" in music; weight of the first by fit of the Allan variance.
  [[nodiscard]] double flicker(PulseIndex i) const noexcept {
    double sum = 0;
    for (std::uint32_t level = 1; level < 30; level += 2) {
      const PulseIndex place = i + (0x9E3779B97F4A7C15 >> (64 - level)), before = place >> level;
      const double share = std::ldexp(static_cast<double>(place - (before << level)) + 0.5, -static_cast<int>(level));
      const double here = std::lerp(draw(before, flicker_draw + level), draw(before + 1, flicker_draw + level), share);
      sum += level == 1 ? 1.044 * here : here;
    }
    return sum;
  }

  /// Brownian motion of unit variance a sample in the middle of an interval, as if linear there: independent blocks
  /// that double in length, and in the last Levy's construction by midpoints. Source: Karatzas & Shreve 1991, sec. 2.3.
  [[nodiscard]] double walk(PulseIndex i) const noexcept {
    const auto last = static_cast<std::uint32_t>(std::bit_width(i));  // of blocks [0, 1), [1, 2), [2, 4), [4, 8)
    double sum = 0;
    for (std::uint32_t k = 0; k <= last; ++k) {
      const PulseIndex start = k > 0 ? PulseIndex{1} << (k - 1) : 0;
      const double whole = k > 1 ? static_cast<double>(start) : 1;
      sum += std::sqrt(whole) * draw(k, block_draw) * (k < last ? 1 : (static_cast<double>(i - start) + 0.5) / whole);
      if (k < 2) continue;
      const PulseIndex before = i >> (k - 1);
      const double share = (static_cast<double>(i - (before << (k - 1))) + 0.5) / whole;
      sum += 0.5 * std::sqrt(whole) * draw(before, bridge_draw + k) * (1 - std::fabs(2 * share - 1));
    }
    return sum;
  }

  std::uint64_t seed_;
  std::uint32_t axis_;
  double bias_, walk_, flicker_, white_;
};

[[nodiscard]] inline Vec3 rounded_to(double step, const Vec3& v) noexcept {
  return step * Vec3{std::round(v.x / step), std::round(v.y / step), std::round(v.z / step)};
}

}  // namespace detail

/// Inertial sensor on a trajectory: three gyroscopes and three accelerometers in its origin.
///
/// Increments are exact from the poses and velocities at both ends, whatever happens between, such as a corner, as long
/// as the sensor turns by less than half a turn in an interval. Rates are those at its end, from the right where they
/// jump: a jump of the velocity is in the increment and in no rate. Errors are their mean over the interval, the same
/// in increments and rates. Derivatives: `derivatives_of` the trajectory.
///
/// Samples are a pure function of their number, in any order, on any thread.
template <Trajectory Path>
class Imu {
 public:
  /// @throws SettingError for settings out of range
  Imu(Path path, Mount mount, ImuSettings settings = {})
      : path_(validated(std::move(path))), mount_(validated(mount)), settings_(validated(settings)) {
    for (std::uint32_t channel = 0; channel < 6; ++channel)
      noise_.emplace_back(channel < 3 ? settings_.gyroscope : settings_.accelerometer, 1 / settings_.sample_rate,
                          settings_.seed, channel);
  }

  /// Tick of a sample: the end of its interval. The first interval begins at zero: call i of `SensorKit::add_samples`
  /// at the same rate comes when sample i - 1 is complete.
  [[nodiscard]] Tick tick(PulseIndex i) const noexcept { return Tick::of(i + 1, settings_.sample_rate); }

  /// First sample at a time or after it.
  [[nodiscard]] PulseIndex sample_from(Tick t) const noexcept {
    if (t < Tick{}) return 0;
    const double expected = t.seconds() * settings_.sample_rate;
    if (expected > 0x1p52) return PulseIndex{1} << 52;
    auto i = static_cast<PulseIndex>(expected);
    while (i > 0 && !(tick(i - 1) < t)) --i;
    while (tick(i) < t) ++i;
    return i;
  }

  /// As measured.
  [[nodiscard]] ImuSample sample(PulseIndex i) const noexcept {
    ImuSample s = true_sample(i);
    measure(settings_.gyroscope, 0, i, s.interval, s.angle_increment, s.angular_rate);
    measure(settings_.accelerometer, 3, i, s.interval, s.velocity_increment, s.specific_force);
    return s;
  }

  /// Without errors of the sensor. Source: specific force f = a - g + 2 w x v (Groves 2013, eq. 5.53) on a map that
  /// turns by w, integrated in axes that do not turn.
  [[nodiscard]] ImuSample true_sample(PulseIndex i) const noexcept {
    const Tick from = Tick::of(i, settings_.sample_rate), to = tick(i);
    const double interval = 1 / settings_.sample_rate;
    const auto begin = instrument_at(from), end = instrument_at(to);
    const Derivatives before = derivatives_at(from), after = derivatives_at(to);
    const Vec3 turning = settings_.earth.map_rate(), lift = settings_.earth.gravity * axis::up;
    const Rotation turn = rotation_by(interval * turning), halfway = rotation_by(0.5 * interval * turning),
                   to_begin = conjugate(begin.rotation), to_end = conjugate(end.rotation);
    const Vec3 change = turn * after.velocity - before.velocity +
                        cross(turning, halfway * (end.position - begin.position)) + interval * (halfway * lift);
    return {to,
            interval,
            rotation_vector(to_begin * turn * end.rotation),
            to_begin * change,
            after.angular_rate + to_end * turning,
            to_end * (after.acceleration + 2.0 * cross(turning, after.velocity) + lift)};
  }

  /// Pose of the sensor in the world, and its derivatives with rates along its axes.
  [[nodiscard]] Pose<frame::Instrument, frame::World> instrument_at(Tick t) const noexcept {
    return path_.at(t) * mount_.pose();
  }
  [[nodiscard]] Derivatives derivatives_at(Tick t) const noexcept { return derivatives_of(path_, mount_, t); }

  [[nodiscard]] const Path& trajectory() const noexcept { return path_; }  ///< of the body
  [[nodiscard]] const Mount& mount() const noexcept { return mount_; }     ///< of the sensor
  [[nodiscard]] const ImuSettings& settings() const noexcept { return settings_; }

 private:
  void measure(const InertialErrors& errors, std::size_t channel, PulseIndex i, double interval, Vec3& increment,
               Vec3& rate) const noexcept {
    Vec3 error = errors.bias;
    for (int k = 0; k < 3; ++k) error[k] += noise_[channel + static_cast<std::size_t>(k)].mean(i);
    const Vec3 most{errors.range, errors.range, errors.range};
    const auto measured = [&](const Vec3& true_rate) {
      const Vec3 found = errors.gain * true_rate + error;
      return max(-most, min(most, errors.resolution > 0 ? detail::rounded_to(errors.resolution, found) : found));
    };
    increment = interval * measured(increment / interval);
    rate = measured(rate);
  }

  Path path_;
  Mount mount_;
  ImuSettings settings_;
  std::vector<detail::InertialNoise> noise_;  ///< three gyroscopes, three accelerometers
};

/// Rounds increments to whole steps, as counters of pulses do, and carries the rest on to the next sample: sums of all
/// increments are right to half a step. It takes samples in order; `Imu` itself, pure in the number, has no rest.
class IncrementQuantizer {
 public:
  /// Steps of angles [rad] and velocities [m/s], as fine as they may be. Throws a `SettingError`.
  IncrementQuantizer(double angle_step, double velocity_step) : angle_step_(angle_step), velocity_step_(velocity_step) {
    require_positive("IncrementQuantizer (angle_step)", angle_step, "rad");
    require_positive("IncrementQuantizer (velocity_step)", velocity_step, "m/s");
  }

  [[nodiscard]] ImuSample operator()(ImuSample sample) noexcept {
    quantize(sample.angle_increment, angle_rest_, angle_step_);
    quantize(sample.velocity_increment, velocity_rest_, velocity_step_);
    return sample;
  }

 private:
  static void quantize(Vec3& increment, Vec3& rest, double step) noexcept {
    const Vec3 whole = increment + rest;
    increment = detail::rounded_to(step, whole);
    rest = whole - increment;
  }
  double angle_step_, velocity_step_;
  Vec3 angle_rest_{}, velocity_rest_{};
};

}  // namespace PULSECAST_NAMESPACE

#endif
