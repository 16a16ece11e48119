// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Runs the survey of an XML document. Writes cloud.las.

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/run.hpp>

#include "command_line.hpp"
#include "summary.hpp"

using namespace pulsecast;

int main(int argc, char** argv) {
  CommandLine line("Runs the survey of an XML document.");
  std::filesystem::path path = "survey.xml";
  std::vector<std::filesystem::path> assets;
  line.add_file("survey", path, "SURVEY.xml", "Survey document");
  line.add_folders("--assets", assets, "Search folder for files of the document; repeatable");

  return line.run(argc, argv, [&] {
    const helios::SurveyDocument document = helios::read_survey(path, {.assets = assets});
    const std::unique_ptr<helios::Simulation> simulation =
        helios::make_simulation(document.survey, {.seed = line.seed, .assets = assets, .threads = line.threads});
    io::LasWriter las(line.output / "cloud.las", {.gps_time = io::GpsTime::week});
    const RunOptions options{.threads = line.threads, .progress = ProgressLine{}};
    const RunSummary summary = run(simulation->survey(), options, las);
    las.close();
    for (const std::string& warning : simulation->warnings()) std::cerr << "note: " << warning << '\n';
    print(summary);
  });
}
