// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/transport/direct_light.hpp>

#include "support/aborts.hpp"
#include "support/archetypes.hpp"
#include "support/checksum.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

// Negative controls: the helpers of tests/support notice what they are there to notice.

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

bool names(const std::string& law, const char* what) { return law.find(what) != std::string::npos; }

const std::array<Tick, 4> ticks{Tick{0, 0}, Tick{0, 0.5}, Tick{3, 0.25}, Tick{1000000, 0.75}};

// ------------------------------------------------------------------------------------- bad surveys

/// What a survey remembers in its workspace.
enum class Memo { nothing, slot, neighbours };

/// Pulses that leave from where the program is.
struct Placed {
  Memo memo = Memo::nothing;
  const double* place;
  struct Workspace {
    PulseIndex first = 0, count = 0;
    double place = 0;
  };
  std::shared_ptr<const void> self = std::make_shared<int>();
  PulseIndex size() const noexcept { return 14'000; }
  std::size_t subrays() const noexcept { return 1; }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  const std::shared_ptr<const void>& identity() const noexcept { return self; }
  Workspace workspace() const { return {}; }
  Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    if (memo == Memo::nothing || i < w.first || i >= w.first + w.count)
      w = {i, memo == Memo::neighbours ? PulseIndex{4} : 1, *place};
    Outcome out;
    out.shot.index = i;
    out.shot.fate = Fate::missed;
    out.shot.direction = axis::forward;
    out.shot.origin.x = w.place;
    return out;
  }
};

// ------------------------------------------------------------------------------------- bad motions

using BeamPose = Pose<frame::Beam, frame::Instrument>;

struct Stepping {  // remembers how often it was asked
  mutable int asked = 0;
  BeamPose at(Tick) const noexcept { return {rotation_about(axis::up, 0.1 * asked++), {}}; }
};

struct Wakeful {  // another answer when asked for an earlier time than before
  mutable Tick latest{};
  BeamPose at(Tick t) const noexcept {
    if (t < latest) return {no_rotation, {1, 0, 0}};
    latest = t;
    return {};
  }
};

struct CopyDiffers {
  double shift = 0;
  CopyDiffers() = default;
  CopyDiffers(const CopyDiffers& other) : shift(other.shift + 1e-9) {}
  CopyDiffers& operator=(const CopyDiffers&) = default;
  BeamPose at(Tick) const noexcept { return {no_rotation, {shift, 0, 0}}; }
};

struct ThreadDiffers {
  std::thread::id maker = std::this_thread::get_id();
  BeamPose at(Tick) const noexcept { return {no_rotation, {std::this_thread::get_id() == maker ? 0.0 : 1.0, 0, 0}}; }
};

struct OpensEarly : LeastOptic {
  bool open(Tick t) const noexcept { return t.fraction < 0.5; }
  Tick next_open(Tick t) const noexcept { return {t.second + 2, 0}; }
};
struct OpensInThePast : OpensEarly {
  Tick next_open(Tick t) const noexcept { return {t.second - 1, 0}; }
};
struct Skips : LeastSource<frame::Beam> {
  PulseIndex by;
  explicit Skips(int slots) : by(static_cast<PulseIndex>(slots)) {}
  PulseIndex next_pulse(PulseIndex i) const noexcept { return i + by; }
};
struct FindsLate : LeastSource<frame::Beam> {
  PulseIndex slot_from(Tick t) const noexcept { return static_cast<PulseIndex>(std::max(0.0, t.seconds())) + 2; }
};
struct FindsTooMany : LeastSource<frame::Beam> {
  PulseIndex slot_from(Tick) const noexcept { return size() + 1; }
};
struct MixesLanes : LeastOptic {
  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& beams) const noexcept {
    beams.position.x = simd::Doubles{} + 1e-9 * t.fraction[1];
    return all_lanes();
  }
};
struct ClosesLanes : LeastOptic {
  simd::Mask poses(const TickLanes&, PoseLanes<frame::Beam, frame::Instrument>& beams) const noexcept {
    beams = {};
    return first_lanes(1);
  }
};
struct MakesOthers : LeastSource<frame::Beam> {
  PulseLanes<frame::Beam> pulse_lanes(PulseIndex i, std::size_t) const noexcept {
    PulseLanes<frame::Beam> other;
    other.push_back(LeastSource<frame::Beam>::pulse(i + i / 3));
    return other;
  }
};
struct MakesNone : LeastSource<frame::Beam> {
  PulseLanes<frame::Beam> pulse_lanes(PulseIndex, std::size_t) const noexcept { return {}; }
};
/// Motion along a parabola, turning, with derivatives that may be wrong.
struct Differentiated {
  double velocity = 1, acceleration = 1, turn = 1;
  BeamPose at(Tick t) const noexcept {
    const double s = t.seconds();
    return {rotation_about(axis::up, 0.2 * s), {s * s, 0, 0}};
  }
  Derivatives derivatives(Tick t) const noexcept {
    return {{2 * t.seconds() * velocity, 0, 0}, {2 * acceleration, 0, 0}, {0, 0, 0.2 * turn}, {}};
  }
};
struct Jerky : Differentiated {  // jumps all the time
  BeamPose at(Tick t) const noexcept { return {no_rotation, {t.phase(7919), 0, 0}}; }
};
struct NotUnit {
  BeamPose at(Tick t) const noexcept { return {Rotation{1 + 1e-9 * t.seconds(), 0, 0, 0}, {}}; }
};

struct NotFinite {
  BeamPose at(Tick t) const noexcept { return {no_rotation, {0, 0, t.second == 3 ? std::nan("") : 0.0}}; }
};

struct FlickeringGate : LeastOptic {
  mutable bool state = false;
  bool open(Tick) const noexcept { return state = !state; }
};

// ------------------------------------------------------------------------------------- bad sources

using BeamPulse = std::optional<Pulse<frame::Beam>>;

template <class Change>
struct Changed : LeastSource<frame::Beam> {
  Change change;
  explicit Changed(Change c) : change(c) {}
  BeamPulse pulse(PulseIndex i) const noexcept {
    BeamPulse p = LeastSource<frame::Beam>::pulse(i);
    change(i, p);
    return p;
  }
};

struct Hurried : LeastSource<frame::Beam> {
  Tick duration() const noexcept { return {3, 0}; }
};

struct Unlisted : LeastSource<frame::Beam> {
  std::vector<Emitter> emitters() const { return {}; }
};

struct Crowded : LeastSource<frame::Beam> {
  std::vector<Emitter> emitters() const { return std::vector<Emitter>(max_emitters + 1); }
};

struct Retuned : LeastSource<frame::Beam> {
  mutable std::shared_ptr<double> scale = std::make_shared<double>(1);
  std::vector<Emitter> emitters() const { return {{.footprint_scale = ++*scale}}; }
};

struct Longer : LeastSource<frame::Beam> {
  PulseIndex size() const noexcept { return 11; }
};

// ---------------------------------------------------------------------------------- bad footprints

struct Two {
  double first = 0.5, second = 0.5;
  Vec2 place{0, 0};
  std::size_t size() const noexcept { return 2; }
  Vec2 offset(std::size_t) const noexcept { return place; }
  double share(std::size_t j) const noexcept { return j == 0 ? first : second; }
};

// ----------------------------------------------------------------------------------- bad detectors

/// One echo per reflection, after which something goes wrong.
template <class Flaw>
struct Flawed {
  Flaw flaw;
  struct Workspace {
    std::vector<Echo> echoes;
    int uses = 0;
  };
  Workspace workspace(std::size_t subrays) const { return {std::vector<Echo>(subrays + 1), 0}; }
  Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const std::span<Reflection> reflections = input.reflections;
    std::sort(reflections.begin(), reflections.end(),
              [](const Reflection& a, const Reflection& b) { return a.range < b.range; });
    std::size_t n = 0;
    for (const Reflection& r : reflections) {
      w.echoes[n] = Echo{};
      w.echoes[n].range = r.range;
      w.echoes[n].amplitude = r.power;
      w.echoes[n].number = static_cast<std::uint8_t>(n + 1);
      ++n;
    }
    flaw(w, n);
    ++w.uses;
    return {std::span(w.echoes).first(n), {}, 0};
  }
};
template <class Flaw>
Flawed(Flaw) -> Flawed<Flaw>;

template <class Flaw>
std::string flaw_found(Flaw flaw) {
  const std::vector<std::vector<Reflection>> cases{{{5, 1}, {3, 2}}, {}, {{7, 1}}};
  return detector_laws(Flawed{flaw}, Laser{}, cases);
}

// ---------------------------------------------------------------------------------- bad transports

/// Direct light, in whose results something goes wrong.
template <class Flaw>
struct FlawedTransport {
  Flaw flaw;
  struct Workspace {
    DirectLight::Workspace inside;
    int uses = 0;
  };
  std::size_t reflections(std::size_t subrays) const noexcept { return subrays; }
  Workspace workspace(std::size_t) const { return {}; }
  template <class Map>
  TransportResult trace(const Map& map, const TransportInput& light, Workspace& w,
                        std::span<Reflection> reflections) const noexcept {
    TransportResult r = DirectLight{}.trace(map, light, w.inside, reflections);
    flaw(r, reflections, light.record, w.uses++);
    return r;
  }
};
template <class Flaw>
FlawedTransport(Flaw) -> FlawedTransport<Flaw>;

const std::array<Pose<frame::Beam, frame::World>, 2> downwards{
    Pose<frame::Beam, frame::World>{rotation_about(axis::right, -pi / 2), {0, 0, 5}},
    Pose<frame::Beam, frame::World>{rotation_about(axis::right, -pi / 3), {0, 0, 8}}};

template <class Flaw>
std::string transport_flaw_found(Flaw flaw) {
  return transport_laws(FlawedTransport{flaw}, LeastRayTarget{}, downwards, {.range_min = 1, .range_max = 100});
}

// ---------------------------------------------------------------------------------------- bad maps

/// A plane that every cone is said to miss.
struct UnseenPlane : LeastBundleTarget {
  bool misses_cone(const RayCone&) const noexcept { return true; }
};
/// The same, seen by every cone that does not look up from above it.
struct SeenPlane : LeastBundleTarget {
  bool misses_cone(const RayCone& cone) const noexcept { return cone.origin.z > 0 && cone.direction.z > cone.spread; }
};

// ------------------------------------------------------------------------------------- bad callers

/// Two shots with three echoes, kept alive for as long as a batch is needed.
struct Sample {
  std::vector<Echo> echoes{{.range = 1, .number = 1}, {.range = 2, .number = 2}, {.range = 3, .number = 1}};
  std::vector<float> samples;
  std::vector<Shot> shots;
  double interval = 0;
  explicit Sample(PulseIndex first) {
    shots.push_back({.index = first, .direction = axis::forward, .fate = Fate::returned, .first_echo = 0, .echoes = 2});
    shots.push_back(
        {.index = first + 1, .direction = axis::forward, .fate = Fate::returned, .first_echo = 2, .echoes = 1});
  }
  EchoBatch batch() const { return {shots, echoes, samples, interval}; }
};

template <class Change>
std::string broken_by(Change change) {
  Sample sample(4);
  change(sample);
  LawfulSink sink;
  sink(sample.batch());
  return sink.broken();
}

/// Reports its pulses elsewhere, by offsets along the axes, and states some deviations.
struct Offset : LeastSource<frame::World> {
  std::uint64_t seed;
  Vec3 deviations, stated;
  Offset(std::uint64_t s, const Vec3& d, const Vec3& of) : seed(s), deviations(d), stated(of) {}
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    auto p = LeastSource::pulse(i);
    p->reported = p->pose;
    for (int k = 0; k < 3; ++k)
      p->reported->position[k] += deviations[k] * normal({seed, 0, static_cast<std::uint32_t>(k)});
    return p;
  }
  void visit_errors(PulseIndex, Tick, const auto& visit) const noexcept {
    for (int k = 0; k < 3; ++k) {
      PoseError<frame::World> error;
      error.moved[k] = stated[k];
      visit(error);
    }
  }
};

}  // namespace

TEST_CASE("SHA-256 gives the known answers of FIPS 180-4") {
  Checksum empty, abc, long_message, million;
  CHECK(empty.hex() == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  abc.add("abc");
  CHECK(abc.hex() == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  long_message.add("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq");
  CHECK(long_message.hex() == "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  for (int i = 0; i < 1000; ++i) million.add(std::string(1000, 'a'));
  CHECK(million.hex() == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a checksum does not depend on where the pieces are cut, and asking for it changes nothing") {
  Checksum whole, pieces;
  whole.add("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq");
  pieces.add("abcdbcdecdef");
  CHECK(pieces.hex() != whole.hex());
  pieces.add("defgefghfghighijhijkijkljklmklmnlmnomnopnopq");
  CHECK(pieces.hex() == whole.hex());
  CHECK(pieces.hex() == whole.hex());
}

TEST_CASE("a checksum of a number is that of its bytes, least significant first, and sees the last bit") {
  Checksum number, bytes, one, next, zero, minus_zero;
  number.add(std::uint32_t{0x04030201});
  bytes.add("\x01\x02\x03\x04");
  CHECK(number.hex() == bytes.hex());
  one.add(1.0);
  next.add(std::nextafter(1.0, 2.0));
  CHECK(one.hex() != next.hex());
  zero.add(0.0);
  minus_zero.add(-0.0);
  CHECK(zero.hex() != minus_zero.hex());
}

TEST_CASE("a checksum of a batch sees every field of shots, echoes and samples") {
  Sample sample(4);
  sample.samples = {1.0F};
  sample.shots[1].samples = 1;
  std::set<std::string> sums;
  const auto note = [&] {
    Checksum sum;
    sum.add(sample.batch());
    sums.insert(sum.hex());
  };
  std::size_t changes = 1;
  note();
  const auto after = [&](auto change) {
    change(sample.shots[1], sample.echoes[2]);
    note();
    ++changes;
  };
  after([](Shot& s, Echo&) { s.index = 99; });
  after([](Shot& s, Echo&) { s.tick.fraction = 0.5; });
  after([](Shot& s, Echo&) { s.origin.z = 1; });
  after([](Shot& s, Echo&) { s.direction = axis::up; });
  after([](Shot& s, Echo&) { s.scan_angle = 1; });
  after([](Shot& s, Echo&) { s.leg = 1; });
  after([](Shot& s, Echo&) { s.channel = 1; });
  after([](Shot& s, Echo&) { s.fate = Fate::missed; });
  after([](Shot& s, Echo&) { s.waveform_start = 1; });
  after([](Shot&, Echo& e) { e.range = 9; });
  after([](Shot&, Echo& e) { e.amplitude = 9; });
  after([](Shot&, Echo& e) { e.reflectance = 9; });
  after([](Shot&, Echo& e) { e.width = 9; });
  after([](Shot&, Echo& e) { e.object = 9; });
  after([](Shot&, Echo& e) { e.classification = 9; });
  after([](Shot&, Echo& e) { e.number = 9; });
  after([&](Shot&, Echo&) { sample.samples[0] = 2.0F; });
  after([&](Shot&, Echo&) { sample.interval = 1e-9; });
  CHECK(sums.size() == changes);
}

TEST_CASE("a checksum does not depend on how pulses are cut into batches") {
  const Sample sample(4);
  const std::vector<Echo> last(sample.echoes.begin() + 2, sample.echoes.end());
  std::vector<Shot> second{sample.shots[1]};
  second[0].first_echo = 0;
  LawfulSink together, apart;
  together(sample.batch());
  apart(EchoBatch{std::span(sample.shots).first(1), std::span(sample.echoes).first(2), {}, 0});
  apart(EchoBatch{second, last, {}, 0});
  CHECK(apart.broken() == "");
  CHECK(apart.checksum() == together.checksum());
}

TEST_CASE("motions that keep the law pass, and those that break it do not") {
  CHECK(motion_laws(LeastOptic{}, ticks) == "");
  CHECK(motion_laws(LeastTrajectory{}, ticks) == "");
  CHECK(names(motion_laws(Stepping{}, ticks), "differs"));
  CHECK(names(motion_laws(Wakeful{}, ticks), "backwards"));
  CHECK(names(motion_laws(CopyDiffers{}, ticks), "copy"));
  CHECK(names(motion_laws(ThreadDiffers{}, ticks), "threads"));
  CHECK(names(motion_laws(FlickeringGate{}, std::span(ticks).first(3)), "gate"));
  CHECK(names(motion_laws(OpensEarly{}, ticks), "open before its opening"));
  CHECK(names(motion_laws(OpensInThePast{}, ticks), "is before it"));
  CHECK(names(motion_laws(MixesLanes{}, ticks), "the pose in lane 0 differs"));
  CHECK(names(motion_laws(ClosesLanes{}, ticks), "the gate in lane 1 differs"));
  CHECK(names(motion_laws(NotUnit{}, ticks), "not rigid"));
  CHECK(names(motion_laws(NotFinite{}, ticks), "not rigid"));
}

TEST_CASE("derivatives that keep the law pass, and those that break it do not") {
  const std::vector<Tick> few{{0, 0.5}, {1, 0}, {3, 0.25}};
  CHECK(derivative_laws(Differentiated{}, few) == "");
  CHECK(names(derivative_laws(Differentiated{.velocity = 1.001}, few), "the velocity differs"));
  CHECK(names(derivative_laws(Differentiated{.acceleration = 1.001}, few), "the acceleration differs"));
  CHECK(names(derivative_laws(Differentiated{.turn = 1.001}, few), "the angular rate differs"));
  CHECK(names(derivative_laws(Jerky{}, few), "smooth at"));
}

TEST_CASE("sources that keep the law pass, and those that break it do not") {
  CHECK(source_laws(LeastSource<frame::Beam>{}) == "");
  CHECK(source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p.reset(); })) == "");
  CHECK(names(source_laws(Changed([](PulseIndex i, BeamPulse& p) noexcept { p->emitter = i == 7; })),
              "pulse 7 is of emitter 1"));
  CHECK(names(source_laws(Unlisted{}), "emitter 0, which is not listed"));
  CHECK(names(source_laws(Crowded{}), "65536 emitters"));
  CHECK(names(source_laws(Retuned{}), "emitters"));
  CHECK(names(
      source_laws(Changed([](PulseIndex i, BeamPulse& p) noexcept { p->tick.second = i == 6 ? 4 : p->tick.second; })),
      "decreases"));
  CHECK(names(source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p->tick.fraction = 1; })), "not normal"));
  CHECK(names(source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p->pose.rotation.x = 0.1; })), "not rigid"));
  static int asked = 0;
  CHECK(names(source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p->pose.position.x = 1e-9 * ++asked; })),
              "differs"));
  CHECK(names(source_laws(Hurried{}), "duration"));
  CHECK(names(source_laws(MakesOthers{}), "differs in lanes"));
  CHECK(names(source_laws(MakesNone{}), "0 are made"));
  CHECK(names(source_laws(FindsLate{}), "for the time of an earlier one"));
  CHECK(names(source_laws(FindsTooMany{}), "is found of 10"));
  CHECK(names(source_laws(Skips{+2}), "is skipped"));
  CHECK(names(source_laws(Skips{-1}), "the next pulse after 0 is"));
}

TEST_CASE("sources that state their errors pass, and those that state others do not") {
  const auto offset_by = [](const Vec3& deviations, const Vec3& stated) {
    return [=](std::uint64_t seed) { return Offset{seed, deviations, stated}; };
  };
  CHECK(error_laws(offset_by({1, 2, 3}, {1, 2, 3}), 1, 10) == "");
  CHECK(error_laws(offset_by({}, {}), 1, 10) == "");
  CHECK(names(error_laws(offset_by({1, 2, 3}, {1, 2, 3.5}), 1, 10), "the variance is"));
  CHECK(names(error_laws(offset_by({1, 2, 3}, {1, 3, 2}), 1, 10), "the variance is"));
  CHECK(names(error_laws(offset_by({1, 2, 3}, {}), 1, 10), "the variance is inf"));
  CHECK(names(error_laws(offset_by({}, {1, 1, 1}), 1, 10), "the variance is 0"));
}

TEST_CASE("wrappers that keep the law pass, and those that break it do not") {
  const LeastSource<frame::Beam> inner;
  CHECK(wrapped_source_laws(inner, inner) == "");
  CHECK(wrapped_source_laws(Changed([](PulseIndex i, BeamPulse& p) noexcept { i % 2 ? p.reset() : void(); }), inner) ==
        "");
  CHECK(names(wrapped_source_laws(inner, Changed([](PulseIndex, BeamPulse& p) noexcept { p.reset(); })),
              "blocked inside"));
  CHECK(names(wrapped_source_laws(Longer{}, inner), "size"));
  CHECK(names(wrapped_source_laws(Hurried{}, inner), "duration"));
  CHECK(names(wrapped_source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p->tick.fraction = 1e-12; }), inner),
              "tick"));
  CHECK(names(wrapped_source_laws(Changed([](PulseIndex, BeamPulse& p) noexcept { p->emitter = 1; }), inner),
              "emitter of pulse"));
  CHECK(names(wrapped_source_laws(Unlisted{}, inner), "emitters differ"));
}

TEST_CASE("footprints that keep the law pass, and those that break it do not") {
  CHECK(footprint_laws(LeastFootprint{}) == "");
  CHECK(footprint_laws(Two{}) == "");
  CHECK(names(footprint_laws(Two{0.5, 0.5 + 1e-11}), "sum"));
  CHECK(names(footprint_laws(Two{1.5, -0.5}), "share of subray 1"));
  CHECK(names(footprint_laws(Two{0.5, std::nan("")}), "share of subray 1"));
  CHECK(names(footprint_laws(Two{0.5, 0.5, {std::nan(""), 0}}), "offset"));
}

TEST_CASE("a map that says too often that a cone meets nothing breaks the law of cones") {
  std::size_t missed = 0;
  CHECK(cone_laws(SeenPlane{}, cones_from(5, 1, 1000), missed) == "");
  CHECK(missed > 100);
  CHECK(names(cone_laws(UnseenPlane{}, cones_from(5, 1, 1000), missed), "said to meet nothing"));
}

TEST_CASE("transports that keep the law pass, and those that break it do not") {
  using R = TransportResult;
  using Found = std::span<Reflection>;
  using Record = std::span<SubrayRecord>;
  CHECK(transport_laws(LeastTransport{}, LeastRayTarget{}, downwards) == "");
  CHECK(transport_flaw_found([](R&, Found, Record, int) {}) == "");
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.sent *= 1.001; }), "are sent"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.scattered *= 1 - 1e-5; }), "sum to"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.cut += 1e-5 * r.energy.sent; }), "sum to"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.missed = -1e-9; }), "a term of"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.received = 2 * r.energy.sent; }),
              "more is received"));
  CHECK(
      names(transport_flaw_found([](R& r, Found, Record, int) { r.energy.received *= 1.001; }), "the reflections are"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { --r.reflections; }), "the reflections are"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) { r.reflections = 100; }), "no room"));
  CHECK(names(transport_flaw_found([](R&, Found found, Record, int) { found.data()[found.size()].power = 1; }),
              "no room"));
  CHECK(names(transport_flaw_found([](R&, Found found, Record, int) { found[3].power = 0; }), "a reflection of 0 W"));
  CHECK(names(transport_flaw_found([](R&, Found found, Record, int) { found[3].range = 0.5; }), "outside the gate"));
  CHECK(names(transport_flaw_found([](R&, Found, Record record, int) {
                if (!record.empty()) record.back().power = -1;
              }),
              "not recorded"));
  CHECK(names(transport_flaw_found([](R& r, Found, Record, int) {
                r = {.energy = {.sent = r.energy.sent, .missed = r.energy.sent}, .fate = Fate::returned};
              }),
              "a fate"));
  CHECK(
      names(transport_flaw_found([](R&, Found found, Record, int uses) { found[0].range += uses; }), "another answer"));
}

TEST_CASE("laws of scattered light that keep the laws pass, and those that break them do not") {
  struct Uphill : Lambert {  // light goes more easily uphill
    double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
      return Lambert::scattered(in, out, normal, light) * (1 + 0.1 * (dot(out, normal) - dot(in, normal)));
    }
  };
  struct Dim : Lambert {
    double scattered_share(double, const SurfaceLight&) const noexcept { return 0.9; }
  };
  struct Bright : Lambert {
    double backscatter(double cosine, const SurfaceLight&) const noexcept { return 1.1 * cosine; }
  };
  struct Drawn : Lambert {
    SampledDirection sample(const Vec3&, const Vec3& normal, double, double) const noexcept { return {normal, 1 / pi}; }
  };
  CHECK(support::scattering_laws(Lambert{}) == "");
  CHECK(support::scattering_laws(Uphill{}) == "scattered is not reciprocal");
  CHECK(support::scattering_laws(Dim{}) == "scattered does not integrate to scattered_share");
  CHECK(support::scattering_laws(Bright{}) == "backscatter is not scattered(in, in)");
  CHECK(support::scattering_laws(Drawn{}) == "the density of sample does not integrate to 1");
}

TEST_CASE("surveys that keep the law of changes pass, and those that remember do not") {
  double place = 0;
  const auto change = [&](int k) { place = k; };
  CHECK(change_laws(Placed{{}, &place}, change) == "");
  CHECK(names(change_laws(Placed{Memo::slot, &place}, change), "gives what was before"));
  CHECK(names(change_laws(Placed{Memo::neighbours, &place}, change), "gives what was before"));
  CHECK(names(change_laws(Placed{{}, &place}, [](int) {}), "changes nothing"));
}

TEST_CASE("detectors that keep the law pass, and those that break it do not") {
  CHECK(detector_laws(LeastDetector{}, Laser{}, std::vector<std::vector<Reflection>>{{{5, 1}, {3, 2}}, {}}) == "");
  CHECK(flaw_found([](auto&, std::size_t&) {}) == "");
  CHECK(names(flaw_found([](auto& w, std::size_t& n) {
                if (n == 2) std::swap(w.echoes[0].range, w.echoes[1].range);
              }),
              "sorted"));
  CHECK(names(flaw_found([](auto& w, std::size_t& n) {
                if (n == 2) w.echoes[1].range = w.echoes[0].range;
              }),
              "sorted"));
  CHECK(names(flaw_found([](auto& w, std::size_t&) { w.echoes[0].amplitude *= 4; }), "came out of"));
  CHECK(names(flaw_found([](auto& w, std::size_t&) { w.echoes[0].amplitude = -1; }), "an echo of -1 W"));
  CHECK(names(flaw_found([](auto& w, std::size_t&) { w.echoes[0].number = 2; }), "number"));
  CHECK(names(flaw_found([](auto& w, std::size_t& n) {
                if (n == 0) {
                  w.echoes[0] = Echo{};
                  n = 1;
                }
              }),
              "of nothing"));
  CHECK(names(flaw_found([](auto& w, std::size_t&) { w.echoes[0].width = w.uses; }), "used workspace"));
}

TEST_CASE("a lawful caller of a sink passes, and others do not") {
  LawfulSink lawful;
  lawful(Sample(4).batch());
  lawful(Sample(6).batch());
  CHECK(lawful.broken() == "");
  CHECK(lawful.batches() == 2);
  CHECK(lawful.shots() == 4);
  CHECK(lawful.echoes() == 6);
  CHECK(lawful.first() == 4);
  CHECK(lawful.last() == 7);

  LawfulSink disordered, again;
  disordered(Sample(4).batch());
  disordered(Sample(2).batch());
  CHECK(names(disordered.broken(), "pulse 2 follows pulse 5"));
  again(Sample(4).batch());
  again(Sample(5).batch());
  CHECK(names(again.broken(), "pulse 5 follows pulse 5"));

  CHECK(names(broken_by([](Sample& s) { std::swap(s.shots[0].index, s.shots[1].index); }), "follows"));
  CHECK(names(broken_by([](Sample& s) { s.shots[0].direction *= 2; }), "not unit"));
  CHECK(names(broken_by([](Sample& s) { s.shots[1].fate = Fate::missed; }), "belies"));
  CHECK(names(broken_by([](Sample& s) { s.shots[1].first_echo = 1; }), "nobody's"));
  CHECK(names(broken_by([](Sample& s) { s.shots[1].echoes = 2; }), "beyond"));
  CHECK(names(broken_by([](Sample& s) { s.shots[1].samples = 1; }), "beyond"));
  CHECK(names(broken_by([](Sample& s) { s.samples = {1.0F}; }), "left over"));
  CHECK(names(broken_by([](Sample& s) { s.shots.pop_back(); }), "left over"));
  CHECK(names(broken_by([](Sample& s) { std::swap(s.echoes[0].range, s.echoes[1].range); }), "not sorted"));
  CHECK(names(broken_by([](Sample& s) { s.echoes[1].number = 1; }), "not numbered"));
}

TEST_CASE("a sink that is called while it is busy says so") {
  const Sample sample(4);
  LawfulSink sink;
  std::atomic<bool> stop = false;
  // Two threads call until they meet; on one processor that needs a switch inside of a call, which comes soon.
  const auto call = [&] {
    while (!stop) {
      sink(sample.batch());
      if (sink.broken() == "two calls at a time") stop = true;
    }
  };
  std::thread other(call);
  call();
  other.join();
  CHECK(sink.broken() == "two calls at a time");
}

TEST_CASE("a call that aborts is told from one that returns, or ends otherwise") {
  CHECK(aborts([] { std::abort(); }));
  CHECK_FALSE(aborts([] {}));
  CHECK_FALSE(aborts([] { std::raise(SIGKILL); }));
}

TEST_CASE("relative comparison goes by size, where doctest's own does not") {
  CHECK(1.0001e-9 == relative(1e-9, 1.1e-4));
  CHECK_FALSE(1.0001e-9 == relative(1e-9, 0.9e-4));
  CHECK(1.0001e9 == relative(1e9, 1.1e-4));
  CHECK_FALSE(1.0001e9 == relative(1e9, 0.9e-4));
  CHECK(2e-9 == doctest::Approx(1e-9));
}
