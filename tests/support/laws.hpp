// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <pulsecast/base/scratch_memory.hpp>
#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/transport/transport_input.hpp>

#include "support/checksum.hpp"
#include "support/detect.hpp"
#include "support/generators.hpp"

/// The laws of `concepts.hpp` that a compiler cannot check. Each function names the first law that it finds broken, and
/// returns an empty string if all are kept: `CHECK(support::motion_laws(mirror, ticks) == "");`
namespace pulsecast::support {

namespace detail {

template <class... Parts>
[[nodiscard]] std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.precision(17);
  (text << ... << parts);
  return text.str();
}

inline bool same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same(const Vec3& a, const Vec3& b) noexcept { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }
inline bool same(const Tick& a, const Tick& b) noexcept { return a.second == b.second && same(a.fraction, b.fraction); }

template <class From, class To>
bool same(const Pose<From, To>& a, const Pose<From, To>& b) noexcept {
  return same(a.position, b.position) && same(a.rotation.w, b.rotation.w) && same(a.rotation.x, b.rotation.x) &&
         same(a.rotation.y, b.rotation.y) && same(a.rotation.z, b.rotation.z);
}

inline bool same(const Derivatives& a, const Derivatives& b) noexcept {
  return same(a.velocity, b.velocity) && same(a.acceleration, b.acceleration) && same(a.angular_rate, b.angular_rate) &&
         same(a.angular_acceleration, b.angular_acceleration);
}

template <class From, class To>
bool same(const std::optional<Pose<From, To>>& a, const std::optional<Pose<From, To>>& b) noexcept {
  return a && b ? same(*a, *b) : !a && !b;
}

inline bool same(const Laser& a, const Laser& b) noexcept {
  return same(a.wavelength, b.wavelength) && same(a.peak_power, b.peak_power) && same(a.pulse_length, b.pulse_length) &&
         same(a.divergence.across, b.divergence.across) && same(a.divergence.up, b.divergence.up) &&
         same(a.waist_diameter, b.waist_diameter) && same(a.waist_range, b.waist_range);
}

inline bool same(const Emitter& a, const Emitter& b) noexcept {
  return same(a.laser, b.laser) && same(a.footprint_scale, b.footprint_scale) && a.receiver == b.receiver &&
         a.channel == b.channel;
}

inline bool same(const std::vector<Emitter>& a, const std::vector<Emitter>& b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Emitter& x, const Emitter& y) { return same(x, y); });
}

template <class Frame>
bool same(const std::optional<Pulse<Frame>>& a, const std::optional<Pulse<Frame>>& b) noexcept {
  if (!a || !b) return !a && !b;
  if constexpr (std::is_same_v<Frame, frame::World>)
    if (!same(a->reported, b->reported) || !same(a->scan_angle, b->scan_angle) || a->leg != b->leg) return false;
  return same(a->tick, b->tick) && same(a->pose, b->pose) && a->emitter == b->emitter;
}

inline bool same(const Echo& a, const Echo& b) noexcept {
  return same(a.range, b.range) && same(a.amplitude, b.amplitude) && same(a.reflectance, b.reflectance) &&
         same(a.width, b.width) && a.object == b.object && a.classification == b.classification && a.number == b.number;
}

template <class From, class To>
bool rigid(const Pose<From, To>& p) noexcept {
  return std::fabs(length(p.rotation) - 1) <= 1e-12 && finite(p.position);
}

/// Asks a pure function of n numbers in every way that must not matter. `answer(model, k)` is compared by `same`.
template <class Model, class Answer>
[[nodiscard]] std::string purity_laws(const Model& model, std::size_t n, Answer answer) {
  using Value = decltype(answer(model, std::size_t{}));
  std::vector<Value> forwards;
  for (std::size_t k = 0; k < n; ++k) forwards.push_back(answer(model, k));
  for (std::size_t k = n; k-- > 0;)
    if (!same(answer(model, k), forwards[k])) return sentence("number ", k, " differs when asked backwards");
  for (std::size_t k = 0; k < n; ++k) {
    const Value once = answer(model, k), twice = answer(model, k);
    if (!same(once, forwards[k]) || !same(twice, forwards[k]))
      return sentence("number ", k, " differs when asked twice");
  }
  const Model copy = model;  // NOLINT: the copy is what is asked
  for (std::size_t k = 0; k < n; ++k)
    if (!same(answer(copy, k), forwards[k])) return sentence("number ", k, " differs when a copy is asked");
  std::vector<Value> there = forwards, back = forwards;
  std::thread other([&] {
    for (std::size_t k = 0; k < n; ++k) there[k] = answer(model, k);
  });
  for (std::size_t k = n; k-- > 0;) back[k] = answer(model, k);
  other.join();
  for (std::size_t k = 0; k < n; ++k)
    if (!same(there[k], forwards[k]) || !same(back[k], forwards[k]))
      return sentence("number ", k, " differs when two threads ask");
  return {};
}

}  // namespace detail

/// A motion in lanes has in each lane the pose and the gate that it has at the lane's tick alone, whatever the other
/// lanes are.
template <class M>
[[nodiscard]] std::string lane_laws(const M& motion, std::span<const Tick> ticks) {
  if constexpr (MovesInLanes<M>)
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      TickLanes together;
      const auto tick_of = [&](std::size_t lane) { return ticks[(k + 7 * lane) % ticks.size()]; };
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) together.set(lane, tick_of(lane));
      pulsecast::detail::PosesOf<M> poses;
      const simd::Mask open = motion.poses(together, poses);
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
        bool is_open = true;
        if constexpr (Gated<M>) is_open = motion.open(tick_of(lane));
        if (is_open != (open[lane] != 0))
          return detail::sentence("the gate in lane ", lane, " differs at ", tick_of(lane).seconds(), " s");
        if (is_open && !detail::same(poses[lane], motion.at(tick_of(lane))))
          return detail::sentence("the pose in lane ", lane, " differs at ", tick_of(lane).seconds(), " s");
      }
    }
  return {};
}

/// Same tick, same pose and same gate, bit for bit: forwards, backwards, twice, from a copy, from two threads, in
/// lanes; the rotation is unit.
template <class M>
[[nodiscard]] std::string motion_laws(const M& motion, std::span<const Tick> ticks) {
  if (auto broken =
          detail::purity_laws(motion, ticks.size(), [&](const M& m, std::size_t k) { return m.at(ticks[k]); });
      !broken.empty())
    return broken;
  if constexpr (Gated<M>) {
    const auto open = [&](const M& m, std::size_t k) { return m.open(ticks[k]) ? 1.0 : 0.0; };
    if (auto broken = detail::purity_laws(motion, ticks.size(), open); !broken.empty()) return "gate: " + broken;
  }
  if (auto broken = lane_laws(motion, ticks); !broken.empty()) return broken;
  if constexpr (ForeseesOpening<M>)
    for (const Tick& t : ticks) {
      const Tick opens = motion.next_open(t);
      if (opens < t) return detail::sentence("the next opening after ", t.seconds(), " s is before it");
      const double wait = static_cast<double>(opens.second - t.second) + (opens.fraction - t.fraction);
      for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999999}) {
        const Tick within = t + Tick::of_seconds(share * wait);
        if (within < opens && motion.open(within))
          return detail::sentence("the gate is open before its opening after ", t.seconds(), " s");
      }
    }
  for (const Tick& t : ticks)
    if (!detail::rigid(motion.at(t))) return detail::sentence("the pose at ", t.seconds(), " s is not rigid");
  return {};
}

/// Derivatives are pure, and those of the poses from a tick on, to a share of them [per unit]: by differences over
/// 1/4096 s and over half of it, where these agree; elsewhere a motion jumps within them. Most ticks must be checked.
template <Differentiable M>
[[nodiscard]] std::string derivative_laws(const M& motion, std::span<const Tick> ticks, double share = 1e-5) {
  if (auto broken =
          detail::purity_laws(motion, ticks.size(), [&](const M& m, std::size_t k) { return m.derivatives(ticks[k]); });
      !broken.empty())
    return broken;
  std::size_t checked = 0;
  for (const Tick& t : ticks) {
    const Derivatives stated = motion.derivatives(t);
    const auto now = motion.at(t);
    const auto slope = [&](const auto& value, double h) {
      const Vec3 here = value(t), next = value(t + Tick::of_seconds(h)), last = value(t + Tick::of_seconds(2 * h));
      return (4.0 * next - 3.0 * here - last) / (2 * h);
    };
    bool smooth = true;
    const auto differs = [&](const Vec3& found, const auto& value) {
      const Vec3 coarse = slope(value, 1.0 / 8192), fine = slope(value, 1.0 / 16384);
      const double most = share * (1 + length(fine));
      if (length(coarse - fine) > most) smooth = false;
      return smooth && !(length(found - fine) <= 3 * most);
    };
    const auto moved = [&](Tick at) { return motion.at(at).position - now.position; };
    const auto turned = [&](Tick at) { return rotation_vector(conjugate(now.rotation) * motion.at(at).rotation); };
    if (differs(stated.velocity, moved)) return detail::sentence("the velocity differs at ", t.seconds(), " s");
    if (differs(stated.angular_rate, turned))
      return detail::sentence("the angular rate differs at ", t.seconds(), " s");
    if (differs(stated.acceleration, [&](Tick at) { return motion.derivatives(at).velocity; }))
      return detail::sentence("the acceleration differs at ", t.seconds(), " s");
    if (differs(stated.angular_acceleration, [&](Tick at) { return motion.derivatives(at).angular_rate; }))
      return detail::sentence("the angular acceleration differs at ", t.seconds(), " s");
    checked += smooth ? 1 : 0;
  }
  if (2 * checked < ticks.size()) return detail::sentence("the motion is smooth at ", checked, " ticks only");
  return {};
}

/// Every n-th pulse in lanes is that of a single call.
template <class S>
[[nodiscard]] std::string stride_laws(const S& source, const auto& slots, PulseIndex emitters) {
  for (const PulseIndex i : slots)
    for (const PulseIndex step : {PulseIndex{2}, PulseIndex{3}, emitters, 2 * emitters}) {
      const std::size_t count = std::min<PulseIndex>(simd::lane_count, (source.size() - i + step - 1) / step);
      const auto pulses = source.pulse_lanes(i, count, step);
      if (pulses.size < 1 || pulses.size > count)
        return detail::sentence("of every ", step, "-th slot from ", i, " on, ", pulses.size, " are made");
      for (std::size_t lane = 0; lane < pulses.size; ++lane)
        if (!detail::same(pulses[lane], source.pulse(i + lane * step)))
          return detail::sentence("pulse ", i + lane * step, " differs in lanes of every ", step, "-th");
    }
  return {};
}

namespace detail {
/// Laws of a source that `FindsSlots` or `SkipsBlocked`, at some slots and their times.
template <class S>
[[nodiscard]] std::string slot_laws(const S& source, std::span<const PulseIndex> slots) {
  const PulseIndex size = source.size();
  if constexpr (FindsSlots<S>)
    for (const PulseIndex i : slots)
      if (const auto pulse = source.pulse(i))
        for (const double later : {-1.0, -1e-9, 0.0, 1e-9, 1.0}) {
          const Tick t = pulse->tick + Tick::of_seconds(later);
          const PulseIndex from = source.slot_from(t);
          if (from > size) return sentence("slot ", from, " is found of ", size);
          for (PulseIndex k = 1; k <= std::min<PulseIndex>(64, from); ++k)
            if (const auto before = source.pulse(from - k); before && !(before->tick < t))
              return sentence("slot ", from, " is found for the time of an earlier one, ", from - k);
          if (const auto found = source.pulse(std::min(from, size - 1)); found && !(found->tick < t)) continue;
          if (from + 4096 < i && !(t < pulse->tick))
            return sentence("slot ", from, " is found for the time of slot ", i, ", far too early");
        }
  if constexpr (SkipsBlocked<S>)
    for (const PulseIndex i : slots) {
      const PulseIndex next = source.next_pulse(i);
      if (next < i || next > size) return sentence("the next pulse after ", i, " is ", next);
      for (PulseIndex k = 0; k < 32 && i + k < next; ++k)  // the first, and the last
        if (source.pulse(i + k) || source.pulse(next - 1 - k))
          return sentence("a pulse between ", i, " and ", next, " is skipped");
    }
  return {};
}
}  // namespace detail

/// Pure in i, in order of time, rigid, of an emitter in the table. Asks `samples` slots evenly spread over the source
/// and those next to them.
template <class S>
[[nodiscard]] std::string source_laws(const S& source, std::size_t samples = 200) {
  const PulseIndex size = source.size();
  std::vector<PulseIndex> slots;
  for (std::size_t k = 0; k < samples; ++k) {
    const PulseIndex i = size / samples * k + size % samples * k / samples;
    for (const PulseIndex slot : {i, i + 1})
      if (slot < size) slots.push_back(slot);
  }
  if (size > 0) slots.push_back(size - 1);
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());

  if (auto broken =
          detail::purity_laws(source, slots.size(), [&](const S& s, std::size_t k) { return s.pulse(slots[k]); });
      !broken.empty())
    return broken;
  if (auto broken = detail::purity_laws(source, 1, [](const S& s, std::size_t) { return s.emitters(); });
      !broken.empty())
    return "emitters: " + broken;
  const std::vector<Emitter> emitters = source.emitters();
  if (emitters.size() > max_emitters) return detail::sentence("there are ", emitters.size(), " emitters");
  std::optional<Tick> first, last;
  for (const PulseIndex i : slots) {
    const auto pulse = source.pulse(i);
    if (!pulse) continue;
    if (pulse->emitter >= emitters.size())
      return detail::sentence("pulse ", i, " is of emitter ", pulse->emitter, ", which is not listed");
    if (!detail::rigid(pulse->pose)) return detail::sentence("the pose of pulse ", i, " is not rigid");
    if (!(pulse->tick.fraction >= 0 && pulse->tick.fraction < 1))
      return detail::sentence("the tick of pulse ", i, " is not normal");
    if (last && pulse->tick < *last) return detail::sentence("time decreases at pulse ", i);
    if (!first) first = pulse->tick;
    last = pulse->tick;
  }
  if constexpr (MakesLanes<S>)
    for (const PulseIndex i : slots)
      for (std::size_t count = 1; count <= simd::lane_count && i + count <= size; ++count) {
        const auto pulses = source.pulse_lanes(i, count);
        if (pulses.size < 1 || pulses.size > count)
          return detail::sentence("of ", count, " slots from ", i, " on, ", pulses.size, " are made");
        for (std::size_t lane = 0; lane < pulses.size; ++lane)
          if (!detail::same(pulses[lane], source.pulse(i + lane)))
            return detail::sentence("pulse ", i + lane, " differs in lanes from ", i);
      }
  if constexpr (StridesLanes<S>)
    if (const std::string broken = stride_laws(source, slots, emitters.size()); !broken.empty()) return broken;
  if (const std::string broken = detail::slot_laws(source, slots); !broken.empty()) return broken;
  if (last && source.duration().seconds() < last->seconds() - first->seconds())
    return "pulses leave after the source's duration";
  return {};
}

namespace detail {
/// Displacement of a point of a pulse by an error [m].
inline Vec3 displaced(const PoseError<frame::World>& error, const Pulse<frame::World>& pulse, const Vec3& point) {
  return error.moved + cross(error.turned, point - error.about.value_or(pulse.origin()));
}
/// Adds the covariance of that point by an error [m^2].
inline void add_to(Covariance& covariance, const PoseError<frame::World>& error, const Pulse<frame::World>& pulse,
                   const Vec3& point) {
  covariance.add(displaced(error, pulse, point));
  for (const Vec3& axis : {axis::right, axis::forward, axis::up}) {
    covariance.add(error.moved_any_way * axis);
    covariance.add(displaced({.turned = error.turned_any_way * axis, .about = error.about}, pulse, point));
  }
}
}  // namespace detail

/// Reported less true points of pulse i, at a range [m], have the covariance that the source states, over the seeds of
/// its draws: along each of some directions to 5 standard deviations of such a mean. `make(seed)` gives the source.
template <class Make>
[[nodiscard]] std::string error_laws(const Make& make, PulseIndex i, double range, std::uint64_t seeds = 3000) {
  Covariance found, stated;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto source = make(seed);
    const auto pulse = source.pulse(i);
    if (!pulse) return "the pulse is blocked";
    const Vec3 ray{0, range, 0}, point = pulse->pose.point(ray);
    found.add(pulse->reported.value_or(pulse->pose).point(ray) - point);
    source.visit_errors(i, pulse->tick, [&](const PoseError<frame::World>& error) noexcept {
      detail::add_to(stated, error, *pulse, point);
    });
  }
  const double share = 5 * std::sqrt(2 / static_cast<double>(seeds));
  const double second_order = 1e-5 * (stated.xx + stated.yy + stated.zz);
  Generator random(i);
  for (int k = 0; k < 20; ++k) {
    const Vec3 along = random.unit();
    const double stated_here = stated.along(along), found_here = found.along(along);
    if (!(std::fabs(found_here - stated_here) <= share * stated_here + second_order))
      return detail::sentence("along (", along.x, ", ", along.y, ", ", along.z, ") the variance is ",
                              found_here / stated_here, " times the stated one");
  }
  return {};
}

/// What wraps a source keeps its size, its duration, its ticks and its emitters, and opens no slot that is blocked
/// inside.
template <class Outer, class Inner>
[[nodiscard]] std::string wrapped_source_laws(const Outer& outer, const Inner& inner, std::size_t samples = 1000) {
  if (outer.size() != inner.size()) return "the size differs from that of what is inside";
  if (!detail::same(outer.duration(), inner.duration())) return "the duration differs from that of what is inside";
  if (!detail::same(outer.emitters(), inner.emitters())) return "the emitters differ from those of what is inside";
  for (std::size_t k = 0; k < samples && k < outer.size(); ++k) {
    const PulseIndex i = outer.size() <= samples ? k : outer.size() / samples * k;
    const auto out = outer.pulse(i);
    const auto in = inner.pulse(i);
    if (out && !in) return detail::sentence("slot ", i, " is blocked inside but not outside");
    if (out && !detail::same(out->tick, in->tick))
      return detail::sentence("the tick of pulse ", i, " differs from that inside");
    if (out && out->emitter != in->emitter)
      return detail::sentence("the emitter of pulse ", i, " differs from that inside");
  }
  return {};
}

/// Shares are not negative and sum to one; offsets are numbers; a copy says the same.
template <class F>
[[nodiscard]] std::string footprint_laws(const F& footprint) {
  const F copy = footprint;  // NOLINT: the copy is what is asked
  long double sum = 0;       // adding up many must not round more than the shares themselves do
  for (std::size_t j = 0; j < footprint.size(); ++j) {
    const double share = footprint.share(j);
    const Vec2 offset = footprint.offset(j);
    if (!(share >= 0)) return detail::sentence("the share of subray ", j, " is ", share);
    if (!std::isfinite(offset.x) || !std::isfinite(offset.y))
      return detail::sentence("the offset of subray ", j, " is not finite");
    if (!detail::same(copy.share(j), share) || copy.offset(j) != offset)
      return detail::sentence("a copy differs at subray ", j);
    sum += share;
  }
  if (!(std::fabs(sum - 1) <= 1e-12L)) return detail::sentence("the shares sum to ", sum);
  return {};
}

namespace detail {
/// Continuous returns ascend, are of positive power and inside the gate; adds their power to `received` [W].
inline std::string continuous_laws(std::span<const ContinuousReturn> returns, const RangeGate& gate, double& received) {
  double before = 0;
  for (const ContinuousReturn& c : returns) {
    if (!(c.begin >= before)) return "continuous returns are not in order";
    if (!(c.begin < c.end && c.at_begin >= 0 && c.at_end >= 0 && c.power() > 0))
      return "a continuous return without light";
    if (!(c.begin >= gate.near * (1 - 1e-12) && c.end <= gate.far * (1 + 1e-12)))
      return "a continuous return outside the gate";
    before = c.begin;
    received += c.power();
  }
  return {};
}
}  // namespace detail

namespace detail {
inline std::string ledger_laws(const EnergyLedger& e, double sent) {
  if (!(std::fabs(e.sent - sent) <= 1e-9 * sent)) return sentence(e.sent, " J are sent, not ", sent);
  for (const double term : {e.missed, e.out_of_range, e.absorbed, e.scattered, e.cut, e.received})
    if (!(term >= 0)) return sentence("a term of ", term, " J");
  const double sum = e.missed + e.out_of_range + e.absorbed + e.scattered + e.cut;
  if (!(std::fabs(sum - sent) <= 1e-6 * sent)) return sentence("the terms sum to ", sum, " J of ", sent);
  if (!(e.received <= e.scattered)) return "more is received than was scattered";
  return {};
}
}  // namespace detail

/// The terms of the ledger sum to what was sent, none is negative; what is received is that of reflections and
/// continuous returns, which are inside the gate and of positive power, no more than there is room for; every subray is
/// recorded if asked for; the answer depends neither on the record nor on what the workspace was used for before.
/// Pulses of a wide beam leave with each of the poses.
template <class T, class Map>
[[nodiscard]] std::string transport_laws(const T& transport, const Map& map,
                                         std::span<const Pose<frame::Beam, frame::World>> poses,
                                         const Receiver& receiver = {}) {
  const RingFootprint footprint(3);
  const Emitter emitter{.laser = {.divergence = 0.02}};
  const SubrayDirections beam(footprint, emitter);
  const LinkBudget budget(receiver, emitter.laser);
  const std::size_t subrays = footprint.size(), most = transport.reflections(subrays);
  std::vector<Reflection> reflections, others;
  auto used = transport.workspace(subrays);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    Pulse<frame::World> pulse;
    pulse.pose = poses[k];
    const auto trace = [&](auto& workspace, std::vector<Reflection>& found, std::span<SubrayRecord> record) {
      WhiteTarget white;
      found.assign(most + 1, Reflection{.power = -1});
      const TransportInput light{pulse, k, 7, emitter, beam, subrays, budget, white, receiver.gate(), record};
      return transport.trace(map, light, workspace, std::span(found).first(most));
    };
    auto fresh = transport.workspace(subrays);
    SubrayRecord unset;
    unset.power = -1;
    std::vector<SubrayRecord> record(subrays, unset);
    const TransportResult r = trace(fresh, reflections, record);
    const EnergyLedger& e = r.energy;
    if (const std::string broken = detail::ledger_laws(e, emitter.laser.energy()); !broken.empty())
      return detail::sentence("pulse ", k, ": ", broken);
    if (r.reflections > most || reflections[most].power != -1)
      return detail::sentence("pulse ", k, ": there is no room for its reflections");
    double received = 0;
    for (const Reflection& reflection : std::span(reflections).first(r.reflections)) {
      if (!(reflection.power > 0)) return detail::sentence("pulse ", k, ": a reflection of ", reflection.power, " W");
      if (!receiver.gate().contains(reflection.range))
        return detail::sentence("pulse ", k, ": a reflection outside the gate");
      received += reflection.power;
    }
    const std::string of_continuous = detail::continuous_laws(r.continuous, receiver.gate(), received);
    if (!of_continuous.empty()) return detail::sentence("pulse ", k, ": ", of_continuous);
    received *= emitter.laser.pulse_length;
    if (!(std::fabs(received - e.received) <= 1e-6 * received))
      return detail::sentence("pulse ", k, ": the reflections are ", received, " J");
    if (r.dark() && r.fate != Fate::missed && r.fate != Fate::out_of_range && r.fate != Fate::absorbed)
      return detail::sentence("pulse ", k, ": a fate that asks for reflections");
    for (const SubrayRecord& subray : record)
      if (!(subray.power >= 0)) return detail::sentence("pulse ", k, ": a subray is not recorded");
    const TransportResult again = trace(used, others, {});
    const auto equal = [](const Reflection& a, const Reflection& b) {
      return detail::same(a.range, b.range) && detail::same(a.power, b.power);
    };
    if (!(again.energy == e) || again.reflections != r.reflections ||
        !std::equal(reflections.begin(), reflections.begin() + static_cast<std::ptrdiff_t>(r.reflections),
                    others.begin(), equal))
      return detail::sentence("pulse ", k, ": a used workspace, or no record, gives another answer");
  }
  return {};
}

/// Laws of a target that `MissesCones`: of a cone that is said to meet nothing, no ray meets anything, whatever its
/// ends. Counts the cones of which that is said.
template <class T>
requires(Target<T>&& MissesCones<T>) [[nodiscard]] std::string
    cone_laws(const T& target, std::span<const RayCone> cones, std::size_t& missed) {
  Generator any(cones.size());
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const RayCone& cone = cones[k];
    if (!target.misses_cone(cone)) continue;
    ++missed;
    for (const double share : {1.0, 0.5}) {
      RayBundle rays = any.cone(cone.origin, cone.direction, 2 * std::asin(std::min(1.0, share * cone.spread / 2)),
                                RayBundle::capacity);
      rays.tick = cone.tick;
      std::array<Hit, RayBundle::capacity> hits;
      find_hits(target, rays, hits);
      for (std::size_t j = 0; j < rays.size; ++j)
        if (hits[j].met())
          return detail::sentence("cone ", k, ": said to meet nothing, but ray ", j, " meets something at ",
                                  hits[j].range);
    }
  }
  return {};
}

/// Cones from within reach of the origin, of any width.
[[nodiscard]] inline std::vector<RayCone> cones_from(double reach, std::uint64_t seed, std::size_t count) {
  Generator any(seed);
  std::vector<RayCone> cones;
  for (std::size_t k = 0; k < count; ++k)
    cones.push_back({any.point(reach), any.unit(), any.log_uniform(1e-5, 0.5), Tick::of_seconds(any.uniform(0, 12))});
  return cones;
}

/// Echoes ascend in range and are numbered from 1; none is stronger than all that came back together; the answer does
/// not depend on what the workspace was used for before; who brought nothing back gets nothing, unless the detector
/// listens always. `cases` are what the subrays of several pulses brought back.
template <class D>
[[nodiscard]] std::string detector_laws(const D& detector, const Laser& laser,
                                        std::span<const std::vector<Reflection>> cases) {
  std::size_t subrays = 1;
  for (const auto& c : cases) subrays = std::max(subrays, c.size());
  struct Answer {
    std::vector<Echo> echoes;
    std::vector<float> waveform;
    double start;
  };
  const auto detect = [&](std::vector<Reflection> reflections, auto& workspace) {  // a detector may reorder its input
    const Detection d = support::detect(detector, laser, reflections, workspace);
    return Answer{{d.echoes.begin(), d.echoes.end()}, {d.waveform.begin(), d.waveform.end()}, d.waveform_start};
  };
  auto used = detector.workspace(subrays);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    auto fresh = detector.workspace(subrays);
    const Answer answer = detect(cases[k], fresh);
    double power = 0;
    for (const Reflection& r : cases[k]) power += r.power;
    for (std::size_t e = 0; e < answer.echoes.size(); ++e) {
      const Echo& echo = answer.echoes[e];
      if (e > 0 && !(answer.echoes[e - 1].range < echo.range))
        return detail::sentence("case ", k, ": echoes are not sorted by range");
      if (echo.number != e + 1) return detail::sentence("case ", k, ": echo ", e, " has number ", int{echo.number});
      if (!RunsWithoutReflections<D> &&
          !(echo.amplitude <= power * (1 + 1e-4)))  // a peak between two samples is interpolated
        return detail::sentence("case ", k, ": an echo of ", echo.amplitude, " W came out of ", power, " W");
      if (!(echo.amplitude >= 0)) return detail::sentence("case ", k, ": an echo of ", echo.amplitude, " W");
    }
    if (!RunsWithoutReflections<D> && cases[k].empty() && !answer.echoes.empty())
      return detail::sentence("case ", k, ": an echo of nothing");
    for (int time = 0; time < 2; ++time) {
      const Answer again = detect(cases[k], used);
      const bool equal =
          std::equal(answer.echoes.begin(), answer.echoes.end(), again.echoes.begin(), again.echoes.end(),
                     [](const Echo& a, const Echo& b) { return detail::same(a, b); });
      if (!equal || answer.waveform != again.waveform || !detail::same(answer.start, again.start))
        return detail::sentence("case ", k, ": a used workspace gives another answer");
    }
  }
  return {};
}

/// A sink that holds its caller to the law: ascending pulse order, one call at a time, batches that are whole in
/// themselves. It also sums up all that it was given.
class LawfulSink {
 public:
  void operator()(const EchoBatch& batch) {
    if (busy_.exchange(true)) {
      overlap_ = true;
      return;
    }
    check(batch);
    if (broken_.empty()) sum_.add(batch);
    ++batches_;
    busy_ = false;
  }

  /// The first law that was broken; empty if none was.
  [[nodiscard]] std::string broken() const { return overlap_ ? "two calls at a time" : broken_; }

  [[nodiscard]] std::string checksum() const { return sum_.hex(); }
  [[nodiscard]] std::size_t batches() const noexcept { return batches_; }
  [[nodiscard]] PulseIndex shots() const noexcept { return shots_; }
  [[nodiscard]] std::uint64_t echoes() const noexcept { return echoes_; }
  [[nodiscard]] std::optional<PulseIndex> first() const noexcept { return first_; }  ///< first pulse that came
  [[nodiscard]] std::optional<PulseIndex> last() const noexcept { return last_; }    ///< latest pulse that came

 private:
  void check(const EchoBatch& batch) {
    std::size_t next_echo = 0, next_sample = 0;
    for (const Shot& s : batch.shots) {
      if (last_ && s.index <= *last_) break_law(detail::sentence("pulse ", s.index, " follows pulse ", *last_));
      if (!first_) first_ = s.index;
      last_ = s.index;
      if (!(std::fabs(length(s.direction) - 1) <= 1e-12)) break_law("a direction is not unit");
      if ((s.fate == Fate::returned) != (s.echoes > 0))
        break_law(detail::sentence("the fate of pulse ", s.index, " belies its echoes"));
      if (s.echoes > 0 && s.first_echo != next_echo)
        break_law(detail::sentence("echoes before those of pulse ", s.index, " are nobody's"));
      if (s.samples > 0 && s.first_sample != next_sample)
        break_law(detail::sentence("samples before pulse ", s.index, " are nobody's"));
      next_echo += s.echoes;
      next_sample += s.samples;
      if (next_echo > batch.echoes.size() || next_sample > batch.samples.size()) {
        break_law(detail::sentence("pulse ", s.index, " reaches beyond the batch"));
        return;
      }
      const auto echoes = batch.echoes_of(s);
      for (std::size_t e = 0; e < echoes.size(); ++e) {
        if (echoes[e].number != e + 1)
          break_law(detail::sentence("the echoes of pulse ", s.index, " are not numbered from 1"));
        if (e > 0 && echoes[e].range < echoes[e - 1].range)
          break_law(detail::sentence("the echoes of pulse ", s.index, " are not sorted"));
      }
      ++shots_;
      echoes_ += s.echoes;
    }
    if (next_echo != batch.echoes.size() || next_sample != batch.samples.size())
      break_law("echoes or samples are left over");
  }

  void break_law(std::string what) {
    if (broken_.empty()) broken_ = std::move(what);
  }

  std::atomic<bool> busy_ = false, overlap_ = false;
  std::string broken_;
  Checksum sum_;
  std::size_t batches_ = 0;
  PulseIndex shots_ = 0;
  std::uint64_t echoes_ = 0;
  std::optional<PulseIndex> first_, last_;
};

namespace detail {

/// Executor of a user's that keeps memory: all tasks on the caller's thread, the last one first.
struct KeepingExecutor {
  ScratchMemory kept{};
  unsigned threads() const { return 3; }
  void for_each(std::size_t count, const IndexTask& task) {
    while (count-- > 0) task(count);
  }
  ScratchMemory& memory() { return kept; }
};
static_assert(MemoryKeepingExecutor<KeepingExecutor>);

/// Checksum of single calls for the slots of a run, `workspace_of()` being the workspace of each.
template <class Survey, class WorkspaceOf>
[[nodiscard]] std::string checksum_of_calls(const Survey& survey, const RunSlots& slots, WorkspaceOf&& workspace_of) {
  Checksum sum;
  ResultBuffer result;
  for (PulseIndex n = 0; n < slots.count; ++n) {
    auto&& workspace = workspace_of();
    result.clear();
    result.append(survey(slots[n], workspace));
    sum.add(result.batch(survey.sample_interval()));
  }
  return sum.hex();
}

/// Checksum of a part simulated in order.
template <class Survey, class Workspace>
[[nodiscard]] std::string checksum_in_order(const Survey& survey, const RunOptions& part, Workspace& workspace) {
  Checksum sum;
  ResultBuffer result;
  survey.simulate_in_order(part.first, part.end, workspace, [&](const Outcome& outcome) {
    result.clear();
    result.append(outcome);
    sum.add(result.batch(survey.sample_interval()));
    return outcome.shot.index + part.stride;
  });
  return sum.hex();
}

}  // namespace detail

/// Results are those of trajectory, map and clock as they are, whatever they were in the calls before: each of these
/// may change between runs. Memory that is kept, by an executor or in a workspace, gives the bytes that fresh memory
/// gives, for steps of 1, 3 and 1,667 slots: in order, the same ones twice, backwards, with gaps, and every third one.
/// `change(k)` makes all that the survey refers to other than with any other k. The survey has at least 5,001 slots,
/// and echoes from all of them.
template <PulseSurvey Survey, class Change>
[[nodiscard]] std::string change_laws(const Survey& survey, const Change& change) {
  ThreadPool pool(2);
  detail::KeepingExecutor own;
  auto kept = survey.workspace(), kept_in_order = survey.workspace();
  std::string first_of_twice;
  int k = 0;
  struct Place {
    PulseIndex place, stride;
  };
  constexpr std::array places =
      std::to_array<Place>({{0, 1}, {2, 1}, {2, 1}, {1, 1}, {0, 3}, {1, 1}, {0, 1}, {4, 1}, {7, 1}});
  for (const PulseIndex step : {1U, 3U, 1667U})
    for (const Place at : std::span(places).first(step == 1667 ? 5 : places.size())) {
      change(++k);
      const PulseIndex place = at.place, stride = at.stride;
      const PulseIndex first = place * step;
      const RunOptions part{.first = first, .end = first + stride * step, .stride = stride};
      const RunSlots slots = part.slots(survey.size());
      auto fresh = survey.workspace();  // for each slot of short steps, which is dear for transports with much memory
      const std::string expected = detail::checksum_of_calls(
          survey, slots, [&]() -> auto& {
            if (step < 1667) fresh = survey.workspace();
            return fresh;
          });
      const auto differs = [&](const char* what, const std::string& sum) {
        return sum == expected ? std::string{}
                               : detail::sentence(step, " slots from ", first, " on, change ", k, ": ", what,
                                                  " gives what was before");
      };
      const auto run_with = [&](ExecutorRef executor, unsigned threads) {
        RunOptions options = part;
        options.executor = executor;
        options.threads = threads;
        LawfulSink sink;
        run(survey, options, sink);
        return sink.broken() + sink.checksum();
      };
      for (const std::string& broken :
           {differs("a run on one thread", run_with({}, 1)), differs("a run on a pool", run_with(pool, 0)),
            differs("a run on an executor of one's own", run_with(own, 0)),
            differs("a kept workspace", detail::checksum_of_calls(
                                            survey, slots, [&]() -> auto& { return kept; }))})
        if (!broken.empty()) return broken;
      if constexpr (SimulatesInOrder<Survey>) {
        const std::string sum = detail::checksum_in_order(survey, part, kept_in_order);
        if (std::string broken = differs("a kept workspace in order", sum); !broken.empty()) return broken;
      }
      if (step == 1667 && place == 2) {
        if (expected == first_of_twice) return detail::sentence("change ", k, " changes nothing");
        first_of_twice = expected;
      }
    }
  return {};
}

}  // namespace pulsecast::support
