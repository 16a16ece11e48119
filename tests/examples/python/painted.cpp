// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A survey for tests of the Python bindings: a beam that sweeps over a floor, whose southern half is object 1, red,
// with the attributes age and species, and whose northern half is object 2, of a blue picture, with the attribute
// species only.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/python/bind.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using World = Scene<TriangleMesh<>>;

/// Half of a floor 10 m below, from one northing to another.
World::Part half(double from, double to, ObjectId object, Material material, Attributes attributes) {
  MeshData mesh{.vertices = {{-20, from, -10}, {20, from, -10}, {20, to, -10}, {-20, to, -10}},
                .triangles = {{0, 1, 2}, {0, 2, 3}}};
  mesh.texture.assign(2, {Vec2(0.5), Vec2(0.5), Vec2(0.5)});
  World::Part part{.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh)), .object = object};
  part.materials = material_table({std::move(material)});
  part.attributes = std::move(attributes);
  return part;
}

const World& floor() {
  static const auto blue = std::make_shared<const Image>(Image{1, 1, 3, std::vector<std::uint8_t>{0, 51, 255}});
  static const World scene(
      {half(-20, 0, 1, {.reflectance = 0.2, .colour = {1, 0, 0}}, attributes({{"age", 80.5}, {"species", 3}})),
       half(0, 20, 2, {.reflectance = 0.4, .picture = blue}, attributes({{"species", 7}}))});
  return scene;
}

/// Floor of an attribute that has the name of a column.
const World& misnamed_floor() {
  static const World scene({half(-20, 20, 1, {}, attributes({{"range", 1}}))});
  return scene;
}

/// A beam that sweeps from south to north over a world.
template <class Footprint>
auto over(const World& world, const Footprint& footprint, PulseIndex pulses) {
  const Scanner scanner{.pulse_rate = 200_kHz, .pulses = pulses};
  const Platform hanging{Tripod{}, Mount{.boresight = rotation_about(axis::right, -90_deg)},
                         Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 40_deg}, scanner}};
  return Survey{hanging, footprint, world, Receiver{}, FirstHit{}};
}
using Sweep = decltype(over(floor(), SingleRay{}, 1));
using MisnamedSweep = decltype(over(floor(), SunflowerFootprint{1}, 1));

}  // namespace

PYBIND11_MODULE(painted, m) {
  using namespace pybind11::literals;
  python::bind_survey<Sweep>(m, "Sweep", [](const Sweep&) {
    return io::points_of(floor());
  }).def(pybind11::init([](PulseIndex pulses) { return over(floor(), SingleRay{}, pulses); }), "pulses"_a);
  python::bind_survey<MisnamedSweep>(m, "MisnamedSweep",
                                     [](const MisnamedSweep&) { return io::points_of(misnamed_floor()); })
      .def(pybind11::init([](PulseIndex pulses) { return over(misnamed_floor(), SunflowerFootprint{1}, pulses); }),
           "pulses"_a);
}
