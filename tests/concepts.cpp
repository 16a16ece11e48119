// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/concepts.hpp>

#include <functional>
#include <memory>
#include <span>

#include <pulsecast/base/require.hpp>

#include <doctest/doctest.h>

#include <pulsecast/transport/direct_light.hpp>

#include "support/archetypes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

// Every concept accepts its least model, and refuses what misses it by one thing.
namespace {

// ----------------------------------------------------------------------------------------- motions

static_assert(Optic<LeastOptic> && Head<LeastHead> && Trajectory<LeastTrajectory>);
static_assert(Motion<LeastOptic, frame::Beam, frame::Instrument>);
static_assert(!Head<LeastOptic> && !Trajectory<LeastOptic> && !Optic<LeastHead> && !Optic<LeastTrajectory>,
              "the frames are others");
static_assert(!Motion<LeastOptic, frame::Instrument, frame::Beam>, "the frames are the wrong way round");

struct MayThrow {
  Pose<frame::Beam, frame::Instrument> at(Tick) const { return {}; }
};
static_assert(!Optic<MayThrow>, "at() is not noexcept");

struct Steps {
  Pose<frame::Beam, frame::Instrument> at(Tick) noexcept { return {}; }
};
static_assert(!Optic<Steps>, "at() is not const");

struct Lends {
  Pose<frame::Beam, frame::Instrument> pose;
  const Pose<frame::Beam, frame::Instrument>& at(Tick) const noexcept { return pose; }
};
static_assert(!Optic<Lends>, "at() returns a reference, not a pose");

struct OnlyTurns {
  Rotation at(Tick) const noexcept { return no_rotation; }
};
static_assert(!Optic<OnlyTurns>, "at() returns a rotation, not a pose");

struct Unique {
  Unique() = default;
  Unique(const Unique&) = delete;
  Unique& operator=(const Unique&) = delete;
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
};
static_assert(!Optic<Unique>, "it cannot be copied");

struct Timeless {
  Pose<frame::Beam, frame::Instrument> at() const noexcept { return {}; }
};
static_assert(!Optic<Timeless>, "at() does not ask for the time");

struct Shutter : LeastOptic {
  bool open(Tick) const noexcept { return true; }
};
static_assert(Optic<Shutter> && Gated<Shutter>);
static_assert(!Gated<LeastOptic>, "it never closes");

struct ShutterMayThrow : LeastOptic {
  bool open(Tick) const { return true; }
};
static_assert(!Gated<ShutterMayThrow>, "open() is not noexcept");

struct ShutterChanges : LeastOptic {
  bool open(Tick) noexcept { return true; }
};
static_assert(!Gated<ShutterChanges>, "open() is not const");

struct HowOpen : LeastOptic {
  double open(Tick) const noexcept { return 1; }
};
static_assert(!Gated<HowOpen>, "open() returns how far, not whether");

// ------------------------------------------------------------------------------------------ ground

struct Level {
  double operator()(Vec2) const { return 0; }
};
static_assert(Ground<Level>);

struct LevelChanges {
  double operator()(Vec2) { return 0; }
};
static_assert(!Ground<LevelChanges>, "asking it changes it");

struct LevelOfPoint {
  double operator()(Vec3) const { return 0; }
};
static_assert(!Ground<LevelOfPoint>, "it wants to know the height");

// ------------------------------------------------------------------------------------- echo widths

struct AlwaysWide {
  double width(std::span<const double>, double) const noexcept { return 1; }
};
static_assert(EchoWidth<AlwaysWide>);

struct WidthMayThrow {
  double width(std::span<const double>, double) const { return 1; }
};
static_assert(!EchoWidth<WidthMayThrow>, "width() is not noexcept");

// ----------------------------------------------------------------------------------- pulse sources

static_assert(BeamSource<LeastSource<frame::Beam>> && InstrumentSource<LeastSource<frame::Instrument>>);
static_assert(WorldSource<LeastSource<frame::World>>);
static_assert(!InstrumentSource<LeastSource<frame::Beam>> && !WorldSource<LeastSource<frame::Instrument>>,
              "the frame is another");
static_assert(!BeamSource<LeastSource<frame::World>> && !WorldSource<LeastSource<frame::Body>>, "the frame is another");

struct Sizeless : LeastSource<frame::Beam> {
  void size() const = delete;
};
static_assert(!BeamSource<Sizeless>, "it has no size");

struct IntSize : LeastSource<frame::Beam> {
  int size() const noexcept { return 10; }
};
static_assert(!BeamSource<IntSize>, "a size is a PulseIndex");

struct SizeMayThrow : LeastSource<frame::Beam> {
  PulseIndex size() const { return 10; }
};
static_assert(!BeamSource<SizeMayThrow>, "size() is not noexcept");

struct Endless : LeastSource<frame::Beam> {
  void duration() const = delete;
};
static_assert(!BeamSource<Endless>, "it has no duration");

struct DurationInSeconds : LeastSource<frame::Beam> {
  double duration() const noexcept { return 10; }
};
static_assert(!BeamSource<DurationInSeconds>, "a duration is a Tick");

struct NeverBlocks : LeastSource<frame::Beam> {
  Pulse<frame::Beam> pulse(PulseIndex) const noexcept { return {}; }
};
static_assert(!BeamSource<NeverBlocks>, "pulse() returns a pulse, not an optional of one");

struct PulseMayThrow : LeastSource<frame::Beam> {
  std::optional<Pulse<frame::Beam>> pulse(PulseIndex) const { return {}; }
};
static_assert(!BeamSource<PulseMayThrow>, "pulse() is not noexcept");

struct PulseChanges : LeastSource<frame::Beam> {
  std::optional<Pulse<frame::Beam>> pulse(PulseIndex) noexcept { return {}; }
};
static_assert(!BeamSource<PulseChanges>, "pulse() is not const");

struct EmittersUnknown : LeastSource<frame::Beam> {
  void emitters() const = delete;
};
static_assert(!BeamSource<EmittersUnknown>, "it does not list its emitters");

struct EmittersChange : LeastSource<frame::Beam> {
  std::vector<Emitter> emitters() { return {}; }
};
static_assert(!BeamSource<EmittersChange>, "emitters() is not const");

struct LasersAlone : LeastSource<frame::Beam> {
  std::vector<Laser> emitters() const { return {}; }
};
static_assert(!BeamSource<LasersAlone>, "a list of lasers is no table of emitters");

// --------------------------------------------------------------------------------------- the scene

static_assert(Accelerator<LeastAccelerator>);

struct BuiltFromNothing : LeastAccelerator {
  BuiltFromNothing() : LeastAccelerator({}) {}
};
static_assert(!Accelerator<BuiltFromNothing>, "it is not built from boxes");

struct BoundsByValue : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  Box bounds() const noexcept { return {}; }
};
static_assert(!Accelerator<BoundsByValue>, "bounds() returns a copy");

struct MemoryUnknown : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  void memory() const = delete;
};
static_assert(!Accelerator<MemoryUnknown>, "it does not tell its size in memory");

struct OrderUnknown : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  void order() const = delete;
};
static_assert(!Accelerator<OrderUnknown>, "it does not tell in which order its primitives stand");

struct TraversalMayThrow : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  template <class Test>
  void closest(const RayBundle&, const Test&, ClosestHits&) const {}
};
static_assert(!Accelerator<TraversalMayThrow>, "closest() is not noexcept");

struct TraversalChanges : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  template <class Test>
  void closest(const RayBundle&, const Test&, ClosestHits&) noexcept {}
};
static_assert(!Accelerator<TraversalChanges>, "closest() is not const");

struct TestsOneByOne : LeastAccelerator {
  using LeastAccelerator::LeastAccelerator;
  template <class Test>
  requires std::invocable<const Test&, PrimitiveIndex>
  void closest(const RayBundle&, const Test&, ClosestHits&) const noexcept {}
};
static_assert(!Accelerator<TestsOneByOne>, "it hands over single primitives, not spans of them");

static_assert(Geometry<LeastGeometry>);

struct Unbounded : LeastGeometry {
  void bounds() const = delete;
};
static_assert(!Geometry<Unbounded>, "it has no bounds");

struct GeometryMayThrow : LeastGeometry {
  void closest(const RayBundle&, ClosestHits&) const {}
};
static_assert(!Geometry<GeometryMayThrow>, "closest() is not noexcept");

struct GeometryChanges : LeastGeometry {
  void closest(const RayBundle&, ClosestHits&) noexcept {}
};
static_assert(!Geometry<GeometryChanges>, "closest() is not const");

struct Faceless : LeastGeometry {
  void surface(PrimitiveIndex, const RayBundle&, std::size_t) const = delete;
};
static_assert(!Geometry<Faceless>, "it tells no surface");

struct MaterialsUncounted : LeastGeometry {
  void material_count() const = delete;
};
static_assert(!Geometry<MaterialsUncounted>, "it does not tell how many materials it needs");

struct NormalOnly : LeastGeometry {
  Vec3 surface(PrimitiveIndex, const RayBundle&, std::size_t) const noexcept { return axis::up; }
};
static_assert(!Geometry<NormalOnly>, "surface() returns a normal, not a surface");

static_assert(BundleTarget<LeastBundleTarget> && RayTarget<LeastRayTarget>);
static_assert(Target<LeastBundleTarget> && Target<LeastRayTarget>);
static_assert(!RayTarget<LeastBundleTarget> && !BundleTarget<LeastRayTarget>, "each answers in its own way");
static_assert(!Target<LeastGeometry>, "a geometry knows no objects and no reflectance: it needs a scene");

struct BundleMayThrow {
  void closest(const RayBundle&, std::span<Hit>) const {}
};
static_assert(!Target<BundleMayThrow>, "closest() is not noexcept");

struct BundleChanges {
  void closest(const RayBundle&, std::span<Hit>) noexcept {}
};
static_assert(!Target<BundleChanges>, "closest() is not const");

struct RayMayThrow {
  std::optional<Hit> closest_hit(const Ray&) const { return {}; }
};
static_assert(!Target<RayMayThrow>, "closest_hit() is not noexcept");

struct RangeOnly {
  std::optional<double> closest_hit(const Ray&) const noexcept { return {}; }
};
static_assert(!Target<RangeOnly>, "closest_hit() returns a range, not a hit");

struct AlwaysHits {
  Hit closest_hit(const Ray&) const noexcept { return {}; }
};
static_assert(!Target<AlwaysHits>, "closest_hit() cannot say that nothing was met");

// ------------------------------------------------------------------------------------ the detector

static_assert(Footprint<LeastFootprint>);

struct SharesInFloat : LeastFootprint {
  float share(std::size_t) const noexcept { return 1; }
};
static_assert(!Footprint<SharesInFloat>, "a share is a double");

struct OffsetInSpace : LeastFootprint {
  Vec3 offset(std::size_t) const noexcept { return {}; }
};
static_assert(!Footprint<OffsetInSpace>, "an offset is across the beam, in two coordinates");

struct FootprintMayThrow : LeastFootprint {
  double share(std::size_t) const { return 1; }
};
static_assert(!Footprint<FootprintMayThrow>, "share() is not noexcept");

static_assert(Transport<LeastTransport, LeastRayTarget> && Transport<LeastTransport, LeastBundleTarget>);
static_assert(!TracesVelocity<LeastTransport, LeastRayTarget>, "it has no trace<true>");
static_assert(Transport<DirectLight, LeastRayTarget> && TracesVelocity<DirectLight, LeastRayTarget>);
static_assert(!SceneQueries<LeastRayTarget>, "it has no surfaces");

struct UnsizedTransport : LeastTransport {
  void reflections(std::size_t) const = delete;
};
static_assert(!Transport<UnsizedTransport, LeastRayTarget>, "it does not tell how many reflections there may be");

struct TransportMayThrow : LeastTransport {
  template <class Map>
  TransportResult trace(const Map&, const TransportInput&, Workspace&, std::span<Reflection>) const {
    return {};
  }
};
static_assert(!Transport<TransportMayThrow, LeastRayTarget>, "trace() is not noexcept");

struct TransportWithoutLedger : LeastTransport {
  template <class Map>
  std::size_t trace(const Map&, const TransportInput&, Workspace&, std::span<Reflection>) const noexcept {
    return 0;
  }
};
static_assert(!Transport<TransportWithoutLedger, LeastRayTarget>, "trace() returns a number of reflections only");

struct TransportOfBundles : LeastTransport {
  template <BundleTarget Map>
  TransportResult trace(const Map&, const TransportInput&, Workspace&, std::span<Reflection>) const noexcept {
    return {};
  }
};
static_assert(Transport<TransportOfBundles, LeastBundleTarget> && !Transport<TransportOfBundles, LeastRayTarget>,
              "a transport may ask more of a map");

static_assert(Detector<LeastDetector> && !RunsWithoutReflections<LeastDetector> && !ReadsVelocity<LeastDetector>);

struct Listener : LeastDetector {
  static constexpr bool runs_without_reflections = true, reads_velocity = true;
};
static_assert(RunsWithoutReflections<Listener> && ReadsVelocity<Listener>);

struct Deaf : LeastDetector {
  static constexpr bool runs_without_reflections = false, reads_velocity = false;
};
static_assert(!RunsWithoutReflections<Deaf> && !ReadsVelocity<Deaf>);

struct NoWorkspace : LeastDetector {
  void workspace(std::size_t) const = delete;
};
static_assert(!Detector<NoWorkspace>, "it makes no workspace");

struct VoidWorkspace : LeastDetector {
  void workspace(std::size_t) const {}
};
static_assert(!Detector<VoidWorkspace>, "its workspace is nothing");

struct DetectorMayThrow : LeastDetector {
  Detection detect(const DetectorInput&, Workspace&) const { return {}; }
};
static_assert(!Detector<DetectorMayThrow>, "detect() is not noexcept");

struct DetectorChanges : LeastDetector {
  Detection detect(const DetectorInput&, Workspace&) noexcept { return {}; }
};
static_assert(!Detector<DetectorChanges>, "detect() is not const");

struct EchoesOnly : LeastDetector {
  std::span<const Echo> detect(const DetectorInput&, Workspace&) const noexcept { return {}; }
};
static_assert(!Detector<EchoesOnly>, "detect() returns echoes, not a detection");

struct ForeignWorkspace : LeastDetector {
  Detection detect(const DetectorInput&, int&) const noexcept { return {}; }
};
static_assert(!Detector<ForeignWorkspace>, "detect() does not take the workspace that it makes");

static_assert(EchoSink<LeastSink>);
static_assert(EchoSink<void (*)(const EchoBatch&)> && EchoSink<std::function<void(const EchoBatch&)>>);
[[maybe_unused]] const auto lambda_sink = [](const EchoBatch&) {};
static_assert(EchoSink<decltype(lambda_sink)>, "a lambda is a sink");

struct TakesNothing {
  void operator()() {}
};
static_assert(!EchoSink<TakesNothing>, "it takes no batch");

struct WantsToChange {
  void operator()(EchoBatch&) {}
};
static_assert(!EchoSink<WantsToChange>, "a batch is not a sink's to change");

struct TakesAnEcho {
  void operator()(const Echo&) {}
};
static_assert(!EchoSink<TakesAnEcho>, "it takes single echoes");

}  // namespace

TEST_CASE("the least models keep to what the concepts say when asked") {
  CHECK(LeastOptic{}.at({}).position == Vec3{});
  CHECK(LeastRayTarget{}.closest_hit({{0, 0, 2}, {0, 0, -1}})->range == 2);
  CHECK_FALSE(LeastRayTarget{}.closest_hit({{0, 0, 2}, {0, 0, 1}}));
}
