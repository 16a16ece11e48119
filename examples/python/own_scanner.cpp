// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A user-defined scanner for Python: two spinning prisms over a floor, as a class of the module `own_scanner`.

#include <memory>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/python/bind.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Two thin prisms in series, each of which bends the beam by the same angle towards its orientation.
struct Rosette {
  using refinements = refines<tag::Validated>;
  double bend;           ///< by each prism [rad]
  double first, second;  ///< turns of the prisms per second, negative for the other way [Hz]

  void validate() const {
    require_within("Rosette::bend", bend, -0.5, 0.5, "rad");
    require_finite("Rosette::first", first, "Hz");
    require_finite("Rosette::second", second, "Hz");
  }

  Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept {
    const double a = 2 * pi * t.phase(first), b = 2 * pi * t.phase(second);
    const double aside = bend * (std::cos(a) + std::cos(b)), upwards = bend * (std::sin(a) + std::sin(b));
    return {rotation_about(axis::up, -aside) * rotation_about(axis::right, upwards), {}};
  }
};

/// 40 m by 40 m, 10 m below.
const Scene<TriangleMesh<>>& floor() {
  static const MeshData mesh{.vertices = {{-20, -20, -10}, {20, -20, -10}, {20, 20, -10}, {-20, 20, -10}},
                             .triangles = {{0, 1, 2}, {0, 2, 3}}};
  static const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(mesh)}});
  return scene;
}

auto over_the_floor(PulseIndex pulses, double bend, double first, double second) {
  const Deflector deflector{Rosette{bend, first, second}, Scanner{.pulse_rate = 200_kHz, .pulses = pulses}};
  const Platform hanging{Tripod{}, Mount{.boresight = rotation_about(axis::right, -90_deg)}, deflector};
  return Survey{hanging, SunflowerFootprint{19}, floor(), Receiver{}, FullWaveform{}};
}

}  // namespace

PYBIND11_MODULE(own_scanner, m) {
  using namespace pybind11::literals;
  python::bind_survey<decltype(over_the_floor(1, 0, 0, 0))>(m, "RosetteSurvey")
      .def(pybind11::init(&over_the_floor), "pulses"_a = 100'000, "bend"_a = 0.2, "first"_a = 41.5, "second"_a = -23.0);
}
