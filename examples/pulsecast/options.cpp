// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "options.hpp"

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <system_error>

#include <CLI/CLI.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/helios/detail/xml/document.hpp>
#include <pulsecast/version.hpp>

#include "quantity.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* all_commands[] = {"run", "check", "info", "preview", "forecast", "catalogue"};

/// "; did you mean '--format'?"
std::string nearest_option(const CLI::App& app, const std::string& given) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::string name = given.substr(0, given.find('='));
  const std::string text = pulsecast::helios::suggestion(name, known);
  return text.starts_with("; did") ? text : "";
}

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

/// The folder of this user for scenes that are kept. Source: XDG Base Directory Specification 0.8.
fs::path scene_folder() {
  const auto folder = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value != nullptr && fs::path(value).is_absolute() ? value : "");
  };
  if (const fs::path cache = folder("XDG_CACHE_HOME"); !cache.empty()) return cache / "pulsecast";
  const fs::path home = folder("HOME");
  return home.empty() ? home : home / ".cache" / "pulsecast";
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

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Options> read_command_line(int argc, char** argv, int& status) {
  Options o;
  std::vector<std::string> words(argv + 1, argv + argc);
  for (const char* command : all_commands)
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
      "  pulsecast forecast SURVEY.xml   says what a run takes, and which settings are the cheapest that meet what is asked\n"
      "  pulsecast catalogue             lists the scanners and platforms that surveys may name\n",
      "pulsecast");
  app.get_formatter()->column_width(46);
  app.set_version_flag("--version", std::string("pulsecast ") + PULSECAST_VERSION);
  app.option_defaults()->ignore_case();
  app.add_option("survey", o.survey, "The document")->type_name("SURVEY.xml");
  app.add_option("--assets", o.assets, "Folder of what the document names; may be given again")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("-o,--output", o.output, "Folder for the results")->type_name("DIR")->capture_default_str();
  app.add_option("--format", o.format, "Of the points: las, laz, xyz or xyz.gz; xyz if not given")
      ->type_name("FORMAT")
      ->transform(CLI::IsMember({"las", "laz", "xyz", "xyz.gz"}, CLI::ignore_case));
  std::string seed;
  app.add_option("--seed", seed, "Of all that is random; the survey's own, or another one each time")
      ->type_name("N")
      ->check([](const std::string& text) {
        return text == "AUTO" || number_in<std::uint64_t>(text) ? std::string() : "'" + text + "' is no whole number from 0";
      });
  app.add_option("-j,--threads,--nthreads,--njobs", o.threads, "How many compute; 0 for as many as the machine runs at once")
      ->type_name("N")
      ->check([](const std::string& text) {
        const auto threads = number_in<unsigned>(text);
        return threads && *threads <= pulsecast::max_threads
                   ? std::string()
                   : "'" + text + "' is no whole number from 0 to " + std::to_string(pulsecast::max_threads);
      });
  app.add_option(both("gpsStartTime"), o.gps_start_time, "When the survey begins: UTC, or seconds since 1970")
      ->type_name("'YYYY-MM-DD hh:mm:ss'");
  bool las = false, zip = false, no_platform_noise = false, no_leg_noise = false;
  app.add_flag(both("lasOutput"), las, "Points as LAS 1.4: --format las");
  app.add_flag("--las10", o.las_1_0, "Points as LAS 1.0, for readers of long ago");
  app.add_option(both("lasScale"), o.las_scale, "Step of the coordinates in LAS [m]")->type_name("M")->check([](const std::string& text) {
    const auto step = number_in<double>(text);
    return step && *step >= 1e-9 && *step <= 1e3 ? std::string() : "'" + text + "' is no length from 1e-9 to 1000 m";
  });
  std::string epsg;
  app.add_option("--epsg", epsg, "Reference system of the coordinates in LAS, 0 for none; that of the scene's GeoTIFF if not given")
      ->type_name("CODE")
      ->check([](const std::string& text) {
        const auto code = number_in<std::uint16_t>(text);
        return code && (*code == 0 || (*code >= 1024 && *code <= 32766)) ? std::string()
                                                                         : "'" + text + "' is no code of EPSG from 1024 to 32766, nor 0";
      });
  app.add_flag(both("zipOutput"), zip, "Points compressed: --format xyz.gz; with --lasOutput, --format laz");
  app.add_flag(both("writeWaveform"), o.write_waveform, "Leave waveforms, too");
  app.add_flag(both("writePulse"), o.write_pulse, "Leave a table of all pulses, too");
  app.add_flag(both("calcEchowidth"), o.echo_width, "Measure the width of echoes");
  app.add_flag(both("fullwaveNoise"), o.waveform_noise, "Noise in the receiver");
  app.add_flag(both("fixedIncidenceAngle"), o.fixed_incidence, "Surfaces reflect as if they were met squarely");
  app.add_flag(both("splitByChannel"), o.split_by_channel, "A file of points for each channel");
  app.add_flag(both("disablePlatformNoise"), no_platform_noise, "The platform knows where it is");
  app.add_flag(both("disableLegNoise"), no_leg_noise, "Legs begin where they should");
  app.add_flag("--page", o.page, "Leave a page to look at the points in a browser, too: page.html");
  app.add_flag("--live", o.live, "Show the points in a browser while they come; says where");
  app.add_option(both("pagePoints"), o.page_points, "Most points of a page; more are thinned")
      ->type_name("N")
      ->check(CLI::Range(2, 134'217'728))
      ->capture_default_str();
  bool rebuild_scene = false, no_scene_writing = false;
  app.add_flag(both("rebuildScene"), rebuild_scene, "Build the scene anew, even if it was kept from an earlier run");
  app.add_flag(both("noSceneWriting"), no_scene_writing, "Do not keep the scene for later runs");
  app.add_flag("--resume", o.resume, "Go on with the newest run of this survey that was not finished");
  app.add_flag("--strict", o.strict, "Take notes about the survey and its files as errors");
  app.add_flag("-q,--quiet,--silent", o.quiet, "Say nothing but errors");
  app.add_flag("-v,--verbose", o.verbose, "Say more");

  std::vector<CLI::Option*> of_forecast;
  std::string range_error, intensity_error, time, memory, apply_to;
  const auto demand = [&](const std::string& name, std::string& text, const QuantityKind& kind, const char* help, const char* type) {
    of_forecast.push_back(app.add_option(name, text, help)->type_name(type)->check([&kind](const std::string& given) {
      return quantity(given, kind) ? std::string() : "'" + given + "': expected " + kind.expected;
    }));
  };
  demand("--range-error", range_error, a_length, "forecast: largest error of ranges, as in 5mm", "LENGTH");
  demand("--intensity-error", intensity_error, a_share, "forecast: largest error of intensities, as in 2%", "SHARE");
  demand("--time", time, a_duration, "forecast: longest run, as in 10min", "DURATION");
  demand("--memory", memory, a_size, "forecast: most memory, as in 4GB", "SIZE");
  of_forecast.push_back(
      app.add_option("--apply", apply_to, "forecast: changes the survey, or writes it to FILE")->type_name("[FILE]")->expected(0, 1));

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

  app.allow_extras();  // which are told of below
  const auto refuse = [&](const std::string& problem) {
    std::cerr << "error: " << problem << "\nTry --help.\n";
    status = 2;
    return std::nullopt;
  };
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(error.what());
    status = app.exit(error);
    return std::nullopt;
  }
  const std::vector<std::string> extras = app.remaining();
  for (const std::string& extra : extras)
    if (extra.starts_with('-')) return refuse("there is no option " + extra + nearest_option(app, extra));
  const std::vector<std::string> commands(std::begin(all_commands), std::end(all_commands));
  if (!extras.empty() && o.survey.extension() != ".xml")
    return refuse("there is no command '" + o.survey.string() + "'" + pulsecast::helios::suggestion(o.survey.string(), commands));
  if (o.command == "catalogue" && !o.survey.empty()) return refuse("'" + o.survey.string() + "' is too much: catalogue takes no document");
  if (!extras.empty()) return refuse("'" + extras.front() + "' is too much: one document at a time");
  if (o.command != "catalogue" && o.survey.empty()) return refuse("no document is given: expected SURVEY.xml");
  for (const CLI::Option* option : of_forecast)
    if (option->count() > 0 && o.command != "forecast") return refuse(option->get_name() + " is for forecast only");
  if (o.command == "forecast") {
    o.forecast = {quantity(range_error, a_length), quantity(intensity_error, a_share), quantity(time, a_duration),
                  quantity(memory, a_size),        of_forecast.back()->count() > 0,    apply_to};
    if (o.forecast.apply && !o.forecast.asks())
      return refuse("--apply must know what for: expected --range-error, --intensity-error, --time or --memory");
  }
  for (std::size_t i = 0; i < std::size(none); ++i)
    if (given[i]->count() > 0) o.notes.push_back(std::string("--") + none[i].name + " has no effect: " + none[i].why);
  const bool is_las = las || o.las_1_0;
  const std::string asked_by_flags = is_las ? (zip && !o.las_1_0 ? "laz" : "las") : zip ? "xyz.gz" : "xyz";
  if (o.format.empty())
    o.format = asked_by_flags;
  else if ((las || zip) && o.format != asked_by_flags)
    o.notes.push_back("--format " + o.format + " counts, not " + (las ? "--lasOutput" : "--zipOutput"));
  if (o.las_1_0 && o.format == "laz") return refuse("--las10 and --format laz: only LAS 1.4 is compressed");
  if (o.las_1_0 && zip && o.format == "las") o.notes.push_back("--zipOutput has no effect on LAS 1.0: it is not compressed");
  if (!epsg.empty()) o.epsg = number_in<std::uint16_t>(epsg);
  if (!seed.empty() && seed != "AUTO") o.seed = number_in<std::uint64_t>(seed);
  o.platform_noise = !no_platform_noise, o.leg_noise = !no_leg_noise;
  o.store = {scene_folder(), !rebuild_scene, !no_scene_writing};
  std::error_code error;
  o.assets.push_back(fs::current_path(error));
  for (fs::path& folder : own_assets()) o.assets.push_back(std::move(folder));
  return o;
}
