// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A plugin: a shared library that simulates one of several sensors in one of several maps, behind a function of C.
#include <cstring>
#include <memory>
#include <stdexcept>

#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scene/any_target.hpp>
#include <pulsecast/shape/height_field.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

using Sensor = AnySource<Deflector<PolygonMirror, Scanner>, Deflector<RisleyPrisms, Scanner>>;
using Map = AnyTarget<Scene<TriangleMesh<>>, Scene<HeightField>>;

static Sensor sensor_named(const char* name) {
  const Scanner scanner{.pulses = 10'000};
  if (std::strcmp(name, "mirror") == 0) return Deflector{PolygonMirror{}, scanner};
  if (std::strcmp(name, "rosette") == 0)
    return Deflector{
        RisleyPrisms{.prisms = {{.wedge = 18_deg, .rotation_rate = -121.6}, {.wedge = 18_deg, .rotation_rate = 77.7}}},
        scanner};
  throw std::invalid_argument("no such sensor");
}

static Map map_named(const char* name) {
  if (std::strcmp(name, "mesh") == 0) {
    const MeshData ground{.vertices = {{-30, -30, 0}, {30, -30, 0}, {30, 30, 1}, {-30, 30, 0}},
                          .triangles = {{0, 1, 2}, {0, 2, 3}}};
    return Scene<TriangleMesh<>>({{.geometry = std::make_shared<const TriangleMesh<>>(ground)}});
  }
  if (std::strcmp(name, "raster") == 0) {
    const Raster raster{
        .columns = 3, .rows = 3, .first = {-20, 20}, .pixel = {20, 20}, .heights = {0, 0, 1, 0, 2, 0, 1, 0, 0}};
    return Scene<HeightField>({{.geometry = std::make_shared<const HeightField>(raster)}});
  }
  throw std::invalid_argument("no such map");
}

/// Writes x, y and z of at most `capacity` points [m], and returns the number of all; -1 for names that it does not
/// have.
extern "C" long scan(const char* sensor, const char* map, double* points, long capacity) {
  try {
    const Platform platform{Tripod{.position = {0, 0, 9}}, Mount{.boresight = rotation_about(axis::right, -60_deg)},
                            sensor_named(sensor)};
    const Map chosen = map_named(map);
    Cloud cloud;
    run(Survey{platform, SingleRay{}, chosen, Receiver{}, FirstHit{}}, {}, cloud);
    for (long i = 0; i < capacity && i < static_cast<long>(cloud.size()); ++i)
      for (int axis = 0; axis < 3; ++axis) points[3 * i + axis] = cloud.points[static_cast<std::size_t>(i)][axis];
    return static_cast<long>(cloud.size());
  } catch (const std::exception&) {
    return -1;
  }
}
