// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A program that holds every shape, motion, optic, trajectory, footprint, detector and width, and chooses as it runs:
// `bench_needs_everything first_hit` does what `bench_needs_first_hit` does, and so on.

#include <string_view>

#include <pulsecast/deflector/fiber_array.hpp>
#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/deflector/pattern_table.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/platform/waypoints.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "needs.hpp"

using namespace needs;

namespace {

using AnyScene = MovingScene<TriangleMesh<>, HeightField, VoxelGrid<OpaqueVoxels>, VoxelGrid<ScaledVoxels>,
                             VoxelGrid<TransmissiveVoxels>>;

template <class Optic>
using Behind = Deflector<Optic, Scanner>;
using Instrument = AnySource<Behind<OscillatingMirror>, Behind<PolygonMirror>, Behind<PalmerMirror>, Behind<FiberArray>,
                             Behind<RisleyPrisms>, Behind<PatternTable>, Behind<FixedBeam>>;
using Heads = AnySource<Instrument, Deflector<RotatingHead, Instrument>>;
template <class Path>
using On = Platform<Path, Channels<Heads>>;
using AnyPlatform = AnySource<On<StraightLine>, On<Waypoints>, On<Tripod>>;

template <class Pattern, class Detecting>
int scan(const AnyPlatform& platform, const Pattern& pattern, const AnyScene& scene, const Detecting& detector) {
  return go(Survey{Legs<AnyPlatform>{{Leg<AnyPlatform>{platform}}}, pattern, scene, Receiver{}, detector});
}

template <class Pattern>
int scan(std::string_view detector, const AnyPlatform& platform, const Pattern& pattern, const AnyScene& scene) {
  if (detector == "first_hit") return scan(platform, pattern, scene, FirstHit{});
  if (detector == "full_waveform") return scan(platform, pattern, scene, FullWaveform{});
  if (detector == "full_waveform_moments") return scan(platform, pattern, scene, FullWaveform<MomentWidth>{});
  if (detector == "full_waveform_fit") return scan(platform, pattern, scene, FullWaveform<GaussianFit>{});
  if (detector == "analytic") return scan(platform, pattern, scene, AnalyticWaveform{});
  if (detector == "analytic_moments") return scan(platform, pattern, scene, AnalyticWaveform<MomentWidth>{});
  if (detector == "analytic_fit") return scan(platform, pattern, scene, AnalyticWaveform<GaussianFit>{});
  return 2;
}

}  // namespace

int main(int count, char** words) {
  const std::string_view detector = count > 1 ? words[1] : "first_hit", pattern = count > 2 ? words[2] : detector;
  const AnyScene scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground().mesh())}}, {.to = 60});
  const AnyPlatform platform =
      On<StraightLine>{flight, mount(), Channels<Heads>{{Instrument{Behind<OscillatingMirror>{mirror, laser}}}}};
  if (pattern == "first_hit") return scan(detector, platform, SingleRay{}, scene);
  if (pattern == "rings") return scan(detector, platform, RingFootprint{}, scene);
  return scan(detector, platform, SunflowerFootprint{19}, scene);
}
