// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/pulsecast.hpp>

#include <filesystem>
#include <fstream>
#include <iostream>
#ifdef WITH_io
#include <pulsecast/io/las.hpp>
#endif
#ifdef WITH_obj
#include <pulsecast/io/obj.hpp>
#endif

#ifdef WITH_helios
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/survey.hpp>

/// Builds a survey of a document.
static void build_survey(const std::filesystem::path& folder) {
  using namespace pulsecast::helios;
  std::ofstream(folder / "plane.obj") << "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n";
  std::ofstream(folder / "survey.xml") << R"(<document>
  <scanner id="mirror" optics="rotating" pulseFreqs_Hz="1000" scanAngleMax_deg="60"/>
  <platform id="stand" type="static"/>
  <scene id="plane"><part id="7"><filter type="objloader"><param type="string" key="filepath" value="plane.obj"/></filter></part></scene>
  <survey name="test" scene="#plane" platform="#stand" scanner="#mirror">
    <leg maxDuration_s="0.1"><platformSettings z="1"/><scannerSettings scanFreq_hz="10"/></leg>
  </survey>
</document>)";
  const SurveySettings survey = read_survey(folder / "survey.xml", {.assets = {folder}}).survey;
  const SurveyScene scene(SceneBuilder(survey.scene, {}).parts(), {.to = 1});
  const CompiledSurvey compiled =
      compile_survey(survey, [&](const pulsecast::Vec2& at) { return scene.ground_height(at); });
  std::cout << scene.parts().size() << " parts and " << compiled.source.size() << " pulses\n";
}
#endif

static void unused() {}

int main([[maybe_unused]] int argc, [[maybe_unused]] char** argv) {
#ifdef WITH_helios
  build_survey(std::filesystem::path(argv[0]).parent_path());
#endif
  std::cout << "pulsecast " PULSECAST_VERSION " has a consumer with " TARGETS "\n";
}
