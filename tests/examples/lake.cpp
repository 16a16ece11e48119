// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The two channels of a bathymetric scanner of the catalogue over a lake, as an XML survey.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/material/pure_water.hpp>
#include <pulsecast/run.hpp>

#include "support/temporary_folder.hpp"

using namespace pulsecast;

namespace {

const std::filesystem::path catalogue = std::filesystem::absolute(__FILE__).parent_path() / "../../examples/catalogue";
constexpr double depth = 5;  // of the lake [m]

struct Lake {
  support::TemporaryFolder folder;

  Lake() {
    std::ofstream(folder.path() / "lake.mtl")
        << "newmtl water\nhelios_reflectance 0.005\nhelios_classification 9\nKd 1\npulsecast_water IB\n"
           "newmtl gravel\nhelios_reflectance 0.2\nhelios_classification 40\nKd 1\n";
    std::ofstream(folder.path() / "lake.obj")
        << "mtllib lake.mtl\nv -300 -300 0\nv 300 -300 0\nv 300 300 0\nv -300 300 0\n"
           "v -300 -300 -5\nv 300 -300 -5\nv 300 300 -5\nv -300 300 -5\n"
           "usemtl water\nf 1 2 3 4\nusemtl gravel\nf 5 6 7 8\n";
  }

  /// Calls `visit(shot, echo)` with all that a flight over it finds.
  template <class Visitor>
  void scan(const std::string& scanner, const std::string& of_scene, const Visitor& visit) const {
    const std::filesystem::path path = folder.path() / "survey.xml";
    std::ofstream(path)
        << "<document><scene id=\"lake\">" + of_scene +
               R"(<part><filter type="objloader"><param type="string" key="filepath" value="lake.obj"/></filter></part></scene>
      <survey name="lake" scene="#lake" platform="data/platforms.xml#sr22" scanner="data/scanners_als.xml#)" +
               scanner + R"(" seed="3"><FWFSettings beamSampleQuality="2"/>
      <leg><platformSettings x="0" y="-2" z="300" movePerSec_m="40"/><scannerSettings pulseFreq_hz="100000" scanAngle_deg="20" scanFreq_hz="40"/></leg>
      <leg><platformSettings x="0" y="2" z="300" movePerSec_m="40"/><scannerSettings pulseFreq_hz="100000" scanAngle_deg="20" scanFreq_hz="40" active="false"/></leg>
      </survey></document>)";
    const std::vector<std::filesystem::path> assets{catalogue, folder.path()};
    const auto document = helios::read_survey(path, {.assets = assets});
    const auto simulation = helios::make_simulation(document.survey, {.assets = assets});
    run(simulation->survey(), {.threads = 1}, [&](const EchoBatch& batch) {
      for (const Shot& shot : batch.shots)
        for (const Echo& echo : batch.echoes_of(shot)) visit(shot, echo);
    });
  }
};

}  // namespace

TEST_CASE(
    "a green scanner finds the bottom of a lake where Snell's law and the group index put it, an infrared one does "
    "not") {
  const Lake lake;
  const double index = water_index(532e-9), group_index = water_group_index(532e-9);
  std::size_t surfaces = 0, bottoms = 0;
  double error = 0;
  lake.scan("riegl_vq-880g", "<light/>", [&](const Shot& shot, const Echo& echo) {
    const double down = -shot.direction.z, sine = std::sqrt(1 - down * down) / index;
    const double above = shot.origin.z / down, below = group_index * depth / std::sqrt(1 - sine * sine);
    if (echo.classification == 40) {
      ++bottoms;
      if (bottoms < 6)
        std::printf("b %d %g %g amp %g refl %g\n", echo.number, echo.range, echo.range - above - below, echo.amplitude,
                    echo.reflectance);
      CHECK(echo.kind == ReflectionKind::water);
      CHECK(std::fabs(echo.range - above - below) < 0.2);
      error += echo.range - above - below;
    } else if (echo.kind == ReflectionKind::surface) {
      ++surfaces;
      CHECK(std::fabs(echo.range - above) < 0.2);
    }
  });
  CHECK(surfaces > 5000);
  CHECK(bottoms > 5000);
  CHECK(std::fabs(error / static_cast<double>(bottoms)) < 0.01);

  std::size_t of_surface = 0;
  const auto sees_no_bottom = [&](const Shot&, const Echo& echo) {
    CHECK(echo.classification == 9);
    ++of_surface;
  };
  lake.scan("riegl_vq-880g-infrared", "<light/>", sees_no_bottom);  // water takes the light
  lake.scan("riegl_vq-880g", "", sees_no_bottom);                   // light ends at the first surface
  CHECK(of_surface > 10000);
}
