// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// An XML survey of HELIOS++, written and run by one program.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include <pulsecast/cloud.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/make_simulation.hpp>

using namespace pulsecast;

int main() {
  std::ofstream("plane.obj") << "v -40 -40 0\nv 40 -40 0\nv 40 40 2\nv -40 40 0\nf 1 2 3\nf 1 3 4\n";
  std::ofstream("survey.xml") << R"(<document>
  <scannerSettings id="common" active="true" pulseFreq_hz="20000" scanFreq_hz="50" scanAngle_deg="30"/>
  <scanner id="mirror" optics="oscillating" pulseFreqs_Hz="20000" scanAngleMax_deg="40" beamDivergence_rad="0.0005">
    <FWFSettings beamSampleQuality="2"/>
  </scanner>
  <platform id="plane" type="linearpath"><scannerMount><rot axis="x" angle_deg="-90"/></scannerMount></platform>
  <scene id="field">
    <part id="7"><filter type="objloader"><param type="string" key="filepath" value="plane.obj"/></filter></part>
  </scene>
  <survey name="strip" scene="survey.xml#field" platform="survey.xml#plane" scanner="survey.xml#mirror">
    <leg><platformSettings x="-30" y="0" z="60" movePerSec_m="20"/><scannerSettings template="common"/></leg>
    <leg><platformSettings x="30" y="0" z="60" movePerSec_m="20"/><scannerSettings active="false"/></leg>
  </survey>
</document>)";
  const std::vector<std::filesystem::path> assets{"."};
  const helios::SurveyDocument document = helios::read_survey("survey.xml", {.assets = assets});
  const auto simulation = helios::make_simulation(document.survey, {.seed = 1, .assets = assets});
  Cloud cloud;
  const RunSummary summary = run(simulation->survey(), {.threads = 2}, cloud);
  double x = 0, y = 0, z = 0;
  for (const Vec3& point : cloud.points) {
    x += point.x;
    y += point.y;
    z += point.z;
  }
  std::cout << document.survey.name << ": " << summary.pulses() << " pulses, " << cloud.size() << " points\n"
            << std::hexfloat << x << ' ' << y << ' ' << z << '\n';
}
