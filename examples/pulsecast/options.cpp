// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "options.hpp"

#include <cctype>
#include <charconv>
#include <iostream>
#include <system_error>

#include <CLI/CLI.hpp>
#include <pulsecast/version.hpp>

namespace {

namespace fs = std::filesystem;

/// Folders of assets that belong to the program: beside it in a build, and under its prefix where it is installed.
std::vector<fs::path> own_assets() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> all;
  if (!error)
    for (const char* place : {"catalogue", "../share/pulsecast", "../share/pulsecast/catalogue"}) {
      const fs::path folder = (program.parent_path() / place).lexically_normal();
      if (fs::is_directory(folder, error)) all.push_back(folder);
    }
  return all;
}

/// `fullwaveNoise` and `fullwave-noise`, as CLI11 wants its names.
std::string both(const std::string& name) {
  std::string kebab;
  for (const char c : name) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0) kebab += '-';
    kebab += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return kebab == name ? "--" + name : "--" + name + ",--" + kebab;
}

std::optional<std::uint64_t> seed_of(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Options> read_command_line(int argc, char** argv, int& status) {
  Options o;
  std::vector<std::string> words(argv + 1, argv + argc);
  for (const char* command : {"run", "check", "info", "preview", "catalogue"})
    if (!words.empty() && words.front() == command) {
      o.command = command;
      words.erase(words.begin());
      break;
    }
  std::erase(words, "-vt");
  for (std::string& word : words)
    if (word == "-v2" || word == "-vv") word = "-v";

  CLI::App app(
      "Simulates the survey of an XML document.\n\n"
      "  pulsecast SURVEY.xml            simulates it\n"
      "  pulsecast check SURVEY.xml      says what is wrong with it\n"
      "  pulsecast info SURVEY.xml       says what would be simulated\n"
      "  pulsecast preview SURVEY.xml    draws a quick look of its points\n"
      "  pulsecast catalogue             lists the scanners and platforms that surveys may name\n",
      "pulsecast");
  app.get_formatter()->column_width(46);
  app.set_version_flag("--version", std::string("pulsecast ") + PULSECAST_VERSION);
  app.option_defaults()->ignore_case();
  auto* survey = app.add_option("survey", o.survey, "The document")->type_name("SURVEY.xml");
  if (o.command != "catalogue") survey->required();
  app.add_option("--assets", o.assets, "Folder of what the document names; may be given again")
      ->type_name("DIR")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("-o,--output", o.output, "Folder for the results")->type_name("DIR")->capture_default_str();
  app.add_option("--format", o.format, "Of the points: las, xyz or xyz.gz; xyz if not given")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"las", "xyz", "xyz.gz"}));
  std::string seed;
  app.add_option("--seed", seed, "Of all that is random; the survey's own, or another one each time")
      ->type_name("N")
      ->check([](const std::string& text) {
        return text == "AUTO" || seed_of(text) ? std::string() : "'" + text + "' is no whole number from 0";
      });
  app.add_option("-j,--threads,--nthreads,--njobs", o.threads, "How many compute; 0 for as many as the machine runs at once")
      ->type_name("N")
      ->check(CLI::Range(0U, 1024U));
  app.add_option(both("gpsStartTime"), o.gps_start_time, "When the survey begins: UTC, or seconds since 1970")
      ->type_name("'YYYY-MM-DD hh:mm:ss'");
  bool las = false, zip = false, no_platform_noise = false, no_leg_noise = false;
  app.add_flag(both("lasOutput"), las, "Points as LAS 1.4: --format las");
  app.add_flag("--las10", o.las_1_0, "Points as LAS 1.0, for readers of long ago");
  app.add_option(both("lasScale"), o.las_scale, "Step of the coordinates in LAS [m]")->type_name("M")->check(CLI::Range(1e-9, 1e3));
  app.add_flag(both("zipOutput"), zip, "Points as compressed text: --format xyz.gz");
  app.add_flag(both("writeWaveform"), o.write_waveform, "Leave waveforms, too");
  app.add_flag(both("writePulse"), o.write_pulse, "Leave a table of all pulses, too");
  app.add_flag(both("calcEchowidth"), o.echo_width, "Measure the width of echoes");
  app.add_flag(both("fullwaveNoise"), o.waveform_noise, "Noise in the receiver");
  app.add_flag(both("fixedIncidenceAngle"), o.fixed_incidence, "Surfaces reflect as if they were met squarely");
  app.add_flag(both("splitByChannel"), o.split_by_channel, "A file of points for each channel");
  app.add_flag(both("disablePlatformNoise"), no_platform_noise, "The platform knows where it is");
  app.add_flag(both("disableLegNoise"), no_leg_noise, "Legs begin where they should");
  app.add_flag("--resume", o.resume, "Go on with the newest run of this survey that was not finished");
  app.add_flag("-q,--quiet,--silent", o.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", o.verbose, "Say more");

  // what users of HELIOS++ type, and what makes no sense here
  const std::string unused = "No effect here";
  struct Unused {
    const char* name;
    bool value;
    const char* why;
  };
  static constexpr Unused none[] = {{"parallelization", true, "work is always shared out evenly"},
                                    {"chunkSize", true, "work is always shared out evenly"},
                                    {"warehouseFactor", true, "work is always shared out evenly"},
                                    {"rebuildScene", false, "scenes are always built from their files"},
                                    {"noSceneWriting", false, "scenes are not written"},
                                    {"kdt", true, "there is one search structure"},
                                    {"kdtJobs", true, "there is one search structure"},
                                    {"kdtGeomJobs", true, "there is one search structure"},
                                    {"sahNodes", true, "there is one search structure"},
                                    {"legacyEnergyModel", false, "there is one link budget"},
                                    {"logFile", false, "the log goes to standard error"},
                                    {"logFileOnly", false, "the log goes to standard error"}};
  std::vector<std::string> swallowed(std::size(none));
  std::vector<CLI::Option*> given;
  for (std::size_t i = 0; i < std::size(none); ++i) {
    auto* option = none[i].value ? app.add_option(both(none[i].name), swallowed[i], unused) : app.add_flag(both(none[i].name), unused);
    given.push_back(option->group(""));
  }

  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      status = app.exit(error);
    } else {
      std::cerr << "error: " << error.what() << "\nTry --help.\n";
      status = 2;
    }
    return std::nullopt;
  }
  for (std::size_t i = 0; i < std::size(none); ++i)
    if (given[i]->count() > 0) o.notes.push_back(std::string("--") + none[i].name + " has no effect: " + none[i].why);
  if (o.format.empty()) o.format = las || o.las_1_0 ? "las" : zip ? "xyz.gz" : "xyz";
  if (!seed.empty() && seed != "AUTO") o.seed = seed_of(seed);
  o.platform_noise = !no_platform_noise, o.leg_noise = !no_leg_noise;
  std::error_code error;
  o.assets.push_back(fs::current_path(error));
  for (fs::path& folder : own_assets()) o.assets.push_back(std::move(folder));
  return o;
}
