// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: GatedCheck<OwnOptic
// error: it must be: bool open.Tick. const noexcept
// error: ValidatingCheck<OwnMirror
// error: it must be: void validate.. const
// error: NormalizableCheck<OwnTrajectory
// error: it must be: void normalize.. noexcept
// error: DrawsByLegCheck<OwnSource
// error: it must be: void draw_for_leg.std::uint32_t.
// error: RecordedConstantCheck<OwnFootprint
// error: it must be: static constexpr bool recorded = true
// error: SamplesWaveformsCheck<OwnDetector
// error: it must be: double sample_interval.. const noexcept
// error: ValidatesLaserCheck<OtherDetector
// error: it must be: void validate.const Laser&. const
// error: RunsWithoutReflectionsConstantCheck<ListeningDetector
// error: it must be: static constexpr bool runs_without_reflections = true
// error: VelocityConstantCheck<SpeedDetector
// error: it must be: static constexpr bool reads_velocity = true
// error: MeasuresBeamCheck<OwnInstrument
// error: it must be: std::optional<Pose<frame::Beam, frame::Instrument>> measured.PulseIndex, Tick. const noexcept
// error: MomentWidthMeasureCheck<OwnWidth
// error: it must be: double width.const WaveformMoments&. const noexcept
// error: TruncatedWidthMeasureCheck<OwnWidth
// error: it must be: double min_share.. const noexcept
// error: UniformConstantCheck<OwnShape
// error: it must be: static constexpr bool flat = true
// error: PrefetchesPrimitivesCheck<OwnTest
// error: it must be: void prefetch.std::span<const PrimitiveIndex>. const noexcept
// error: SelfCheckingAcceleratorCheck<OwnIndex
// error: it must be: bool is_consistent.std::size_t. const
// error: IdentifiedSurveyCheck<OwnSurvey
// error: it must be: std::shared_ptr<const void> identity.. const noexcept
// error: MissesConesCheck<OwnMap
// error: MissesConesCheck<WideShape
// error: it must be: bool misses_cone.const RayCone&. const noexcept
// error: ChoosesShotsCheck<OwnSink
// error: it must be: bool reads_empty_shots.. const noexcept
// error: ConsistencyCheckingCheck<OwnTable
// error: it must be: bool is_consistent.. const
//
// Each stage checks the optional members that it uses. tests/concepts.cpp has the near names of each.
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
  void NAME(validate, check)() const {}
};
struct OwnTrajectory : LeastTrajectory {
  void NAME(normalize, normalise)() noexcept {}
};
struct OwnSource : LeastSource<frame::World> {
  void NAME(draw_for_leg, draw_leg)(std::uint32_t) {}
};
struct OwnFootprint : LeastFootprint {
  static constexpr NAME(bool, int) recorded = true;
};
struct OwnDetector : LeastDetector {
  double NAME(sample_interval, sampling_interval)() const noexcept { return 1; }
};
struct OtherDetector : LeastDetector {
  void NAME(validate, validate_laser)(const Laser&) const {}
};
struct ListeningDetector : LeastDetector {
  static constexpr bool NAME(runs_without_reflections, always_listens) = true;
};
struct SpeedDetector : LeastDetector {
  static constexpr NAME(bool, int) reads_velocity = NAME(false, 1);
};
struct OwnInstrument : LeastSource<frame::Instrument> {
  std::optional<Pose<frame::Beam, frame::Instrument>> NAME(measured, measured_beam)(PulseIndex, Tick) const noexcept {
    return std::nullopt;
  }
};
struct OwnWidth {
  double width(std::span<const double>, double) const noexcept { return 1; }
  double width(const WaveformMoments&) const NAME(noexcept, ) { return 1; }
  double NAME(min_share, share_min)() const noexcept { return 0.5; }
};
struct OwnShape : LeastGeometry {
  static constexpr bool NAME(flat, is_flat) = true;
};
struct OwnTest {
  void operator()(std::span<const PrimitiveIndex>) const noexcept {}
  void NAME(prefetch, soon)(std::span<const PrimitiveIndex>) const noexcept {}
};
struct OwnIndex : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  bool NAME(is_consistent, sound)(std::size_t) const { return true; }
};
struct OwnSurvey : Survey<LeastSource<frame::World>, LeastFootprint, LeastRayTarget, LeastDetector> {
  using Survey::Survey;
  std::shared_ptr<const void> identity() const NAME(noexcept, ) { return nullptr; }
};
struct OwnMap : LeastRayTarget {
  bool NAME(misses_cone, misses)(const RayCone&) const noexcept { return false; }
};
struct WideShape : LeastGeometry {
  bool misses_cone(const RayCone&) const NAME(noexcept, ) { return false; }
};
struct OwnSink : LeastSink {
  bool NAME(reads_empty_shots, reads_misses)() const noexcept { return false; }
};
struct OwnTable {
  template <class Archive>
  void archive(Archive&) {}
  bool is_consistent() NAME(const, ) { return true; }
};

int main() {
  const Deflector device{OwnOptic{}, Scanner{}};
  const Deflector other{OwnMirror{}, Scanner{}};
  const Platform platform{OwnTrajectory{}, Mount{}, device};
  const Legs legs{std::vector<OwnSource>(2)};
  const LeastRayTarget map;
  const LeastSource<frame::World> source;
  const Survey recording{source, OwnFootprint{}, map, Receiver{}, LeastDetector{}};
  const Survey sampling{source, LeastFootprint{}, map, Receiver{}, OwnDetector{}};
  const Survey validating{source, LeastFootprint{}, map, Receiver{}, OtherDetector{}};
  const Survey listening{source, LeastFootprint{}, map, Receiver{}, ListeningDetector{}};
  const Survey fast{source, LeastFootprint{}, map, Receiver{}, SpeedDetector{}};
  const Platform measuring{Tripod{}, Mount{}, OwnInstrument{}};
  const AnalyticWaveform<OwnWidth> detector;
  (void)tail_of(OwnWidth{});
  const Scene<OwnShape> scene(std::vector<Scene<OwnShape>::Part>{});
  const RayBundle rays;
  ClosestHits nearest(rays);
  Bvh<>(std::span<const Box>{}).closest(rays, OwnTest{}, nearest);
  (void)TriangleMesh<OwnIndex>(MeshData{}).is_consistent();
  run(OwnSurvey({}, {}, map, Receiver{}, {}), {}, [](const EchoBatch&) {});
  const OwnMap own;
  run(Survey{source, LeastFootprint{}, own, Receiver{}, LeastDetector{}}, {}, OwnSink{});
  (void)Scene<WideShape>(std::vector<Scene<WideShape>::Part>{}).misses_cone({});
  OwnTable table;
  io::ArchiveReader({}, nullptr)(table);
}
