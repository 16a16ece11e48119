// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: 'open' has another form here. it must be: bool open.Tick. const noexcept
// error: 'normalize' has another form here. it must be: void normalize.. noexcept
// error: 'draw_for_leg' has another form here. it must be: void draw_for_leg.std::uint32_t.
// error: 'recorded' has another form here. it must be: static constexpr bool recorded = true
// error: 'sample_interval' has another form here. it must be: double sample_interval.. const noexcept
// error: 'validate' has another form here. it must be: void validate.const Laser&. const
// error: 'prepare' has another form here. it must be: void prepare.const Laser&.
// error: 'reads_velocity' has another form here. it must be: static constexpr bool reads_velocity = true
// error: 'measured' has another form here. .*: std::optional<Pose<.*>> measured.PulseIndex, Tick. const noexcept
// error: 'width' has another form here. it must be: double width.const WaveformMoments&. const noexcept
// error: 'uniform_surface' has another form here. it must be: static constexpr bool uniform_surface = true
// error: 'prefetch' has another form here. it must be: void prefetch.std::span<const PrimitiveIndex>. const noexcept
// error: 'is_consistent' has another form here. it must be: bool is_consistent.std::size_t. const
// error: 'identity' has another form here. it must be: std::shared_ptr<const void> identity.. const noexcept
// error: 'misses_cone' has another form here. it must be: bool misses_cone.const RayCone&. const noexcept
// error: 'is_consistent' has another form here. it must be: bool is_consistent.. const
// error: 'scattered' has another form here. it must be: double scattered.const Vec3& in, .*, double or const SurfaceLight&. const noexcept
// error: 'next_open' is promised .* is missing. it must be: Tick next_open.Tick. const noexcept
// error: 'validate' is promised .* is missing. it must be: void validate.. const
// error: 'slot_from' is promised .* is missing. it must be: PulseIndex slot_from.Tick. const noexcept
// error: 'rotates_per_pulse' is promised .* is missing. it must be: static constexpr bool rotates_per_pulse = true
// error: 'runs_without_reflections' is promised .* missing. .*: static constexpr bool runs_without_reflections = true
// error: 'min_share' is promised .* is missing. it must be: double min_share.. const noexcept
// error: 'deterministic' is promised .* is missing. it must be: static constexpr bool deterministic = true
// error: 'misses_cone' is promised .* is missing. it must be: bool misses_cone.const RayCone&. const noexcept
// error: 'reads_empty_shots' is promised .* is missing. it must be: bool reads_empty_shots.. const noexcept
// error: 'sample' is promised .* is missing. it must be: SampledDirection sample.const Vec3& in, .*. const noexcept
// error: 'Validating' is not a member of 'pulsecast::.*tag'|no member named 'Validating' in namespace 'pulsecast::tag'
//
// Each stage checks the optional members that it uses, and the promises of its parts. tests/refinements.cpp has a wrong
// form of each member.
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/io/detail/archive.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "../support/archetypes.hpp"

#ifdef SHOULD_NOT_COMPILE
#define NAME(right, wrong) wrong
#else
#define NAME(right, wrong) right
#endif

using namespace pulsecast;
using namespace pulsecast::support;

struct OwnOptic : LeastOptic {
  bool open(Tick) const NAME(noexcept, ) { return true; }
};
struct OwnMirror : LeastOptic {
  using refinements = refines<tag::Gated, tag::ForeseesOpening, tag::Validated>;
  bool open(Tick) const noexcept { return true; }
  Tick NAME(next_open, next_opening)(Tick t) const noexcept { return t; }
  void NAME(validate, check)() const {}
};
struct OwnTrajectory : LeastTrajectory {
  void normalize() NAME(noexcept, ) {}
};
struct OwnLaser : LeastSource<frame::Beam> {
  using refinements = refines<tag::FindsSlots>;
  PulseIndex NAME(slot_from, slot_at)(Tick) const noexcept { return 0; }
};
struct OwnSource : LeastSource<frame::World> {
  void draw_for_leg(NAME(std::uint32_t, )) {}
};
struct OwnInstrument : LeastSource<frame::Instrument> {
  using Beam = Pose<frame::Beam, frame::Instrument>;
  NAME(std::optional<Beam>, Beam) measured(PulseIndex, Tick) const noexcept { return {}; }
};
struct OwnFootprint : LeastFootprint {
  static constexpr NAME(bool, int) recorded = true;
};
struct TurningFootprint : LeastFootprint {
  using refinements = refines<tag::RotatesPerPulse>;
  static constexpr bool NAME(rotates_per_pulse, turned_per_pulse) = true;
};
struct OwnDetector : LeastDetector {
  double sample_interval() const NAME(noexcept, ) { return 1; }
  void validate(NAME(const Laser&, Tick)) const {}
  NAME(void, bool) prepare(const Laser&) { return NAME(, true); }
};
struct ListeningDetector : LeastDetector {
  using refinements = refines<tag::RunsWithoutReflections>;
  static constexpr bool NAME(runs_without_reflections, always_listens) = true;
  static constexpr NAME(bool, int) reads_velocity = NAME(false, 1);
};
struct OwnWidth {
  using refinements = refines<tag::TruncatedWidthMeasure>;
  double width(std::span<const double>, double) const noexcept { return 1; }
  double width(const WaveformMoments&) const NAME(noexcept, ) { return 1; }
  double NAME(min_share, share_min)() const noexcept { return 0.5; }
};
struct OwnShape : LeastGeometry {
  using refinements = refines<tag::DeterministicGeometry>;
  static constexpr bool deterministic = NAME(true, false);
  static constexpr NAME(bool, int) uniform_surface = true;
};
struct WideShape : LeastGeometry {
  bool misses_cone(const RayCone&) const NAME(noexcept, ) { return false; }
};
struct OwnLaw : Lambert {
  using refinements = refines<tag::SamplesDirections>;
  double scattered(const Vec3&, const Vec3&, const Vec3&, const SurfaceLight&) const NAME(noexcept, ) { return 0; }
  SampledDirection NAME(sample, draw)(const Vec3&, const Vec3&, double, double) const noexcept { return {}; }
};
struct OwnTest {
  void operator()(std::span<const PrimitiveIndex>) const noexcept {}
  void prefetch(std::span<const PrimitiveIndex>) const NAME(noexcept, ) {}
};
struct OwnIndex : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  bool is_consistent(NAME(std::size_t, )) const { return true; }
};
struct OwnMap : LeastRayTarget {
  using refinements = refines<tag::MissesCones>;
  bool NAME(misses_cone, misses)(const RayCone&) const noexcept { return false; }
};
struct OwnSurvey : Survey<LeastSource<frame::World>, LeastFootprint, LeastRayTarget, LeastDetector> {
  using Survey::Survey;
  std::shared_ptr<const void> identity() const NAME(noexcept, ) { return nullptr; }
};
struct OwnSink : LeastSink {
  using refinements = refines<tag::ChoosesShots>;
  bool NAME(reads_empty_shots, reads_misses)() const noexcept { return false; }
};
struct OwnTable {
  template <class Archive>
  void archive(Archive&) {}
  bool is_consistent() NAME(const, ) { return true; }
};
struct OwnSettings {
  using refinements = refines<NAME(tag::Validated, tag::Validating)>;
  void validate() const {}
};

int main() {
  const Platform platform{OwnTrajectory{}, Mount{}, Deflector{OwnOptic{}, Scanner{}}};
  (void)platform.pulse(0);
  const Deflector other{OwnMirror{}, OwnLaser{}};
  const Legs legs{std::vector<OwnSource>(2)};
  (void)legs.pulse(0);
  (void)Platform{Tripod{}, Mount{}, OwnInstrument{}}.pulse(0);
  const LeastRayTarget map;
  const LeastSource<frame::World> source;
  const Survey recording{source, OwnFootprint{}, map, Receiver{}, OwnDetector{}};
  const Survey turning{source, TurningFootprint{}, map, Receiver{}, ListeningDetector{}};
  (void)detail::tail_of(OwnWidth{});
  const Scene<OwnShape> scene(std::vector<Scene<OwnShape>::Part>{});
  const Scene<WideShape> wide(std::vector<Scene<WideShape>::Part>{});
  const SurfaceLaw law = OwnLaw{};
  const RayBundle rays;
  ClosestHits nearest(rays);
  Bvh<>(std::span<const Box>{}).closest(rays, OwnTest{}, nearest);
  (void)TriangleMesh<OwnIndex>(MeshData{}).is_consistent();
  run(OwnSurvey({}, {}, map, Receiver{}, {}), {}, [](const EchoBatch&) {});
  const OwnMap own;
  run(Survey{source, LeastFootprint{}, own, Receiver{}, LeastDetector{}}, {}, OwnSink{});
  OwnTable table;
  io::ArchiveReader({}, nullptr)(table);
  (void)validated(OwnSettings{});
}
