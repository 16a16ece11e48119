// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/version.hpp>

#include "accuracy.hpp"
#include "point_formats.hpp"
#include "quantity.hpp"

namespace {

#define QUOTED_WORD(word) #word
#define QUOTED(macro) QUOTED_WORD(macro)

namespace fs = std::filesystem;
namespace text = pulsecast::text;

constexpr const char* all_commands[] = {"run", "check", "info", "preview", "forecast", "catalogue", "doctor"};

/// "; did you mean '--format'?"
std::string nearest_option(const CLI::App& app, const std::string& given) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::string name = given.substr(0, given.find('='));
  const std::string text = text::suggestion(name, known);
  return text.starts_with("; did") ? text : "";
}

/// Asset folders of the program: next to it in a build, below its prefix in an installation.
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

/// Folder of this user for stored scenes. Source: XDG Base Directory Specification 0.8.
fs::path scene_folder() {
  const auto folder = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value != nullptr && fs::path(value).is_absolute() ? value : "");
  };
  if (const fs::path cache = folder("XDG_CACHE_HOME"); !cache.empty()) return cache / "pulsecast";
  const fs::path home = folder("HOME");
  return home.empty() ? home : home / ".cache" / "pulsecast";
}

/// Both spellings, `fullwaveNoise` and `fullwave-noise`, in the notation of CLI11.
std::string both(const std::string& name) {
  std::string kebab;
  for (const char c : name) {
    if (text::lower(c) != c) kebab += '-';
    kebab += text::lower(c);
  }
  return kebab == name ? "--" + name : "--" + name + ",--" + kebab;
}

/// Number in a text, or a problem for CLI11; `holds(number)` is the condition.
template <class Number, class Holds>
auto number_check(const Holds& holds, const std::string& problem) {
  return [holds, problem](const std::string& text) {
    const std::optional<Number> number = text::number_in<Number>(text);
    return number && holds(*number) ? std::string() : "'" + text + "': expected a " + problem;
  };
}

/// Codes of a horizontal and a vertical reference system, as in 25832+7837; empty if the text is none.
std::optional<pulsecast::io::SpatialReference> codes_in(const std::string& text) {
  const std::size_t plus = text.find('+');
  const auto code = [](const std::string& word) {
    const auto number = text::number_in<std::uint16_t>(word);
    return number && *number >= 1024 && *number <= 32766 ? number : std::nullopt;  // source: OGC GeoTIFF 1.1
  };
  if (text == "0") return pulsecast::io::SpatialReference{};
  const auto horizontal = code(text.substr(0, plus)),
             vertical = plus == std::string::npos ? std::uint16_t{0} : code(text.substr(plus + 1));
  if (!horizontal || !vertical) return std::nullopt;
  return pulsecast::io::SpatialReference{.epsg = *horizontal, .vertical_epsg = *vertical};
}

/// Option of HELIOS++ without a meaning here.
struct Unused {
  const char* name;
  bool value;
  const char* why;
};
constexpr Unused unused_options[] = {{"parallelization", true, "work is always shared out evenly"},
                                     {"chunkSize", true, "work is always shared out evenly"},
                                     {"warehouseFactor", true, "work is always shared out evenly"},
                                     {"kdt", true, "there is one search structure"},
                                     {"kdtJobs", true, "there is one search structure"},
                                     {"kdtGeomJobs", true, "there is one search structure"},
                                     {"sahNodes", true, "there is one search structure"},
                                     {"legacyEnergyModel", false, "there is one link budget"},
                                     {"logFile", false, "the log goes to standard error"},
                                     {"logFileOnly", false, "the log goes to standard error"}};

/// Options that say what is in files, which the Python module takes, too.
constexpr const char* names_of_file_options[] = {"format",       "scanRate", "kittiClasses", "gpsStartTime", "lasScale",
                                                 "las10",        "epsg",     "wkt",          "missesAt",     "colours",
                                                 "nearInfrared", "columns",  "uncertainty",  "pagePoints"};

/// Names of the columns that points can have, in order.
std::string names_of_columns() {
  std::string all;
  for (const pulsecast::io::PointColumn& column : pulsecast::io::point_columns)
    all.append(all.empty() ? "" : ", ").append(column.name);
  return all;
}

/// Options of the program and their values.
class CommandLine {
 public:
  CommandLine() {
    app_.get_formatter()->column_width(46);
    app_.set_version_flag(
        "--version", std::string("pulsecast ") + PULSECAST_VERSION + ", instructions: " QUOTED(PULSECAST_INSTRUCTIONS));
    add_inputs();
    add_las();
    add_results();
    add_page();
    add_habits();
    add_forecast();
    add_unused();
    app_.allow_extras();  // reported by `problem_of_words`
  }

  /// Reads the words after the name of the program. Empty if nothing remains to be done; then `status` is set.
  [[nodiscard]] std::optional<Options> read(std::vector<std::string> words, int& status) {
    take_command(words);
    fold_case(words);
    std::string problem;
    try {
      app_.parse(std::vector<std::string>(words.rbegin(), words.rend()));
      problem = problem_of_words();
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0) {
        status = app_.exit(error);
        return std::nullopt;
      }
      problem = error.what();
    }
    if (problem.empty()) problem = problem_of_forecast();
    if (problem.empty()) problem = settle();
    if (problem.empty()) return o_;
    std::cerr << "error: " << problem << "\nTry --help.\n";
    status = 2;
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> file_options() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const char* name : names_of_file_options) {
      const CLI::Option& option = *app_.get_option("--" + std::string(name));
      all.emplace_back(option.get_lnames().back(), option.get_description());
    }
    return all;
  }

  /// Reads words that are options of files alone, each with its value. Throws std::invalid_argument.
  [[nodiscard]] Options read_file_options(const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const auto& [name, help] : file_options()) names.push_back("--" + name);
    for (const std::string& word : words)
      if (const std::string name = word.substr(0, word.find('=')); std::ranges::find(names, name) == names.end())
        throw std::invalid_argument(name + " is no option of files" + text::suggestion(name, names));
    std::string problem;
    try {
      app_.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
      problem = error.what();
    }
    if (problem.empty()) problem = settle();
    if (!problem.empty()) throw std::invalid_argument(problem);
    return o_;
  }

 private:
  void add_inputs() {
    app_.add_option("survey", o_.survey, "Survey document")->type_name("SURVEY.xml");
    app_.add_option("--assets", o_.assets, "Search folder for files of the document; repeatable")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app_.add_option("-o,--output", o_.output, "Folder for the results")->type_name("DIR")->capture_default_str();
    const auto any = [](const PointFormat&) { return true; };
    std::vector<std::string> names;
    for (const PointFormat& format : point_formats) names.emplace_back(format.name);
    app_.add_option("--format", o_.format, "Format of the points: " + names_of_formats(any) + "; default: " + names[0])
        ->type_name("FORMAT")
        ->transform(CLI::IsMember(names, CLI::ignore_case));
    app_.add_option(both("scanRate"), scan_rate_, "Scans per second in KITTI and MCAP [Hz]; default: 10")
        ->type_name("HZ")
        ->check(
            number_check<double>([](double rate) { return rate >= 1e-3 && rate <= 1e6; }, "rate from 0.001 to 1e6 Hz"));
    app_.add_option(
            both("kittiClasses"), o_.kitti_classes,
            "Labels in KITTI: a file of rows of class and label, or 'own' for the classes; default: by those of LAS")
        ->type_name("FILE")
        ->check([](const std::string& given) {
          return given == "own" || fs::is_regular_file(given) ? std::string()
                                                              : "'" + given + "': expected a file, or own";
        });
    app_.add_option("--seed", seed_, "Seed of all random numbers; default: the survey's own, or a new one each time")
        ->type_name("N")
        ->check([](const std::string& text) {
          return text == "AUTO" || text::number_in<std::uint64_t>(text)
                     ? std::string()
                     : "'" + text + "': expected a whole number from 0, or AUTO";
        });
    app_.add_option("-j,--threads,--nthreads,--njobs", o_.threads, "Number of threads; 0: all of the machine")
        ->type_name("N")
        ->check(number_check<unsigned>([](unsigned threads) { return threads <= pulsecast::max_threads; },
                                       "whole number from 0 to " + std::to_string(pulsecast::max_threads)));
    app_.add_option(both("gpsStartTime"), o_.gps_start_time, "Start of the survey: UTC, or seconds since 1970")
        ->type_name("'YYYY-MM-DD hh:mm:ss'");
  }

  void add_las() {
    app_.add_flag(both("lasOutput"), las_, "Points as LAS 1.4: --format las");
    app_.add_flag("--las10", o_.las_1_0, "Points as LAS 1.0, for old readers");
    app_.add_option(both("lasScale"), o_.las_scale, "Step of the coordinates in LAS [m, or the unit of --epsg]")
        ->type_name("M")
        ->check(number_check<double>([](double step) { return step >= 1e-9 && step <= 1e3; },
                                     "length from 1e-9 to 1000 m"));
    app_.add_option(
            "--epsg", epsg_,
            "EPSG code of the coordinates in LAS, as in 25832, or with that of the heights, as in 25832+7837; 0 "
            "for none; default: those of the scene's GeoTIFF")
        ->type_name("CODE[+CODE]")
        ->check([](const std::string& text) {
          return codes_in(text) ? std::string()
                                : "'" + text + "': expected a code from 1024 to 32766, two of them as 25832+7837, or 0";
        });
    app_.add_option("--wkt", o_.wkt, "File with the text (WKT) of the reference system, in place of --epsg")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    app_.add_option("--project", project_,
                    "EPSG code of the map of the survey, to which trajectories in degrees are projected; before it, "
                    "that of the degrees, as in 4258:25832")
        ->type_name("[CODE:]CODE");
    app_.add_flag(both("zipOutput"), zip_, "Points compressed: --format xyz.gz; with --lasOutput, --format laz");
  }

  void add_results() {
    app_.add_flag(both("writeWaveform"), o_.write_waveform, "Write waveforms, too");
    app_.add_option(both("waveformBins"), waveform_bins_,
                    "Samples of each waveform in text: zeros follow, later ones are cut")
        ->type_name("N")
        ->check(number_check<std::uint32_t>([](std::uint32_t bins) { return bins > 0 && bins <= 1'000'000; },
                                            "whole number from 1 to 1000000"));
    app_.add_flag(both("writePulse"), o_.write_pulse, "Write a table of all pulses, too");
    app_.add_flag(both("writeMisses"), o_.write_misses, "Write a table of the pulses without echoes, too");
    app_.add_option(both("missesAt"), misses_at_, "Write a point for each pulse without echoes, at this range [m]")
        ->type_name("M")
        ->check(number_check<double>([](double range) { return range >= 0 && range <= 1e9; }, "range from 0 to 1e9 m"));
    app_.add_flag("--geojson", o_.geojson, "Write trajectories and footprints as GeoJSON, too");
    app_.add_option_function<std::string>(
            "--accuracy",
            [this](const std::string& given) {
              if (const std::string problem = read_accuracy(given, o_.accuracy); !problem.empty())
                throw CLI::ValidationError("--accuracy", problem);
            },
            "Choose the cheapest settings that reach an accuracy, as in range=5mm,echoes=1%; also intensity=, "
            "position=")
        ->type_name("LIST");
    app_.add_flag("--errors", o_.errors, "Compute the errors of the run by a sample, and write report.json");
    app_.add_flag(both("calcEchowidth"), o_.echo_width, "Measure the width of echoes");
    app_.add_flag(both("fullwaveNoise"), o_.waveform_noise, "Add receiver noise");
    app_.add_flag(both("fixedIncidenceAngle"), o_.fixed_incidence, "Scatter as at normal incidence");
    app_.add_flag(both("libraryPhysics"), o_.library_physics, "Physics of the library in place of that of HELIOS++");
    app_.add_flag(both("lightPaths"), o_.light_paths, "Follow light from mirrors, glass and water");
    app_.add_flag("--colours", o_.colours, "Points with the colours of their surfaces; not in text, KITTI and PTX");
    app_.add_flag(both("nearInfrared"), o_.near_infrared, "Colours with near infrared, by the spectra of surfaces");
    app_.add_option("--columns", o_.columns,
                    "Further columns of points, in every format and on the page: attributes of objects, or of " +
                        names_of_columns())
        ->type_name("NAME,NAME")
        ->delimiter(',');
    app_.add_flag("--uncertainty", o_.uncertainty,
                  "Columns of the covariance of each point, by the errors that the survey draws");
    app_.add_flag(both("splitByChannel"), o_.split_by_channel, "Write a file of points for each channel");
    app_.add_flag(both("disablePlatformNoise"), no_platform_noise_, "No platform noise");
    app_.add_flag(both("disableLegNoise"), no_leg_noise_, "No random offset of the start of legs");
  }

  void add_page() {
    app_.add_flag("--page", o_.page, "Write page.html, too: the points for a browser");
    app_.add_flag("--live", o_.live, "Show the growing cloud in a browser, at the address printed");
    app_.add_option(both("pagePoints"), o_.page_points, "Maximum number of points of a page; larger clouds are thinned")
        ->type_name("N")
        ->check(CLI::Range(2, 134'217'728))
        ->capture_default_str();
  }

  void add_habits() {
    app_.add_flag(both("rebuildScene"), rebuild_scene_, "Build the scene anew instead of reading it from the cache");
    app_.add_flag(both("noSceneWriting"), no_scene_writing_, "Do not cache the scene for later runs");
    app_.add_flag("--resume", o_.resume, "Resume the newest unfinished run of this survey");
    app_.add_flag("--strict", o_.strict, "Treat notes on the survey and its files as errors");
    app_.add_flag("-q,--quiet,--silent", o_.quiet, "Print errors only");
    app_.add_flag("-v,--verbose", o_.verbose, "Print more");
  }

  void add_forecast() {
    const auto demand = [&](const std::string& name, std::string& text, const QuantityKind& kind, const char* help,
                            const char* type) {
      of_forecast_.push_back(
          app_.add_option(name, text, help)->type_name(type)->check([&kind](const std::string& given) {
            return quantity(given, kind) ? std::string() : "'" + given + "': expected " + kind.expected;
          }));
    };
    demand("--time", time_, a_duration, "forecast: maximum run time, as in 10min", "DURATION");
    demand("--memory", memory_, a_size, "forecast: maximum memory, as in 4GB", "SIZE");
    of_forecast_.push_back(
        app_.add_option("--apply", apply_to_, "forecast: write the best settings to the survey, or a copy to FILE")
            ->type_name("[FILE]")
            ->expected(0, 1));
  }

  void add_unused() {
    const std::string help = "No effect here";
    for (const Unused& unused : unused_options) {
      auto* option =
          unused.value ? app_.add_option(both(unused.name), swallowed_, help) : app_.add_flag(both(unused.name), help);
      unused_.push_back(option->group(""));
    }
  }

  /// Takes the command from the words, also in the notation of HELIOS++.
  void take_command(std::vector<std::string>& words) {
    const auto known = words.empty() ? std::end(all_commands)
                                     : std::find(std::begin(all_commands), std::end(all_commands), words.front());
    if (known != std::end(all_commands)) {
      o_.command = *known;
      words.erase(words.begin());
    }
    std::erase(words, "-vt");
    for (std::string& word : words)
      if (word == "-v2" || word == "-vv") word = "-v";
    // names after the end of options: CLI11 takes that as the end of a list, too, and what follows for options
    for (auto word = std::find(words.begin(), words.end(), "--"); word != words.end(); ++word)
      if (word->starts_with('-') && *word != "--") word->insert(0, "./");
  }

  /// Spells options as they are declared, however their letters are. CLI11 can ignore case, too, but compares each
  /// option with all others for it, which takes as long as all else of a start.
  void fold_case(std::vector<std::string>& words) const {
    for (std::string& word : words) {
      const std::size_t end = std::min(word.find('='), word.size());
      for (const CLI::Option* option : app_.get_options())
        for (const std::string& name : option->get_lnames())
          if (text::is_same_word(word.substr(0, end), "--" + name)) word.replace(0, end, "--" + name);
      if (!word.starts_with('-') || word.starts_with("--")) continue;
      for (char& letter : std::span(word).subspan(1)) {  // as in -qJ2
        const CLI::Option* const option = app_.get_option_no_throw(std::string("-") + text::lower(letter));
        if (option == nullptr) break;
        letter = text::lower(letter);
        if (option->get_items_expected_max() > 0) break;  // its value follows
      }
    }
  }

  /// Problem with words that are not options; empty if there is none.
  [[nodiscard]] std::string problem_of_words() const {
    std::vector<std::string> extras = app_.remaining();
    std::erase(extras, "--");  // which ends the options
    for (const std::string& extra : extras)
      if (extra.starts_with('-')) return "unknown option " + extra + nearest_option(app_, extra);
    const std::vector<std::string> commands(std::begin(all_commands), std::end(all_commands));
    const bool without_document = o_.command == "catalogue" || o_.command == "doctor";
    if (!extras.empty() && o_.survey.extension() != ".xml")
      return "unknown command '" + o_.survey.string() + "'" + text::suggestion(o_.survey.string(), commands);
    if (without_document && !o_.survey.empty())
      return "unexpected argument '" + o_.survey.string() + "': " + o_.command + " takes no document";
    if (!extras.empty()) return "unexpected argument '" + extras.front() + "': expected one document";
    if (!without_document && o_.survey.empty()) return "no document is given: expected SURVEY.xml";
    return "";
  }

  /// Checks and completes the options of `forecast`. Returns a problem; empty if there is none.
  [[nodiscard]] std::string problem_of_forecast() {
    for (const CLI::Option* option : of_forecast_)
      if (option->count() > 0 && o_.command != "forecast") return option->get_name() + " is for forecast only";
    if (o_.accuracy && o_.command != "run" && o_.command != "forecast")
      return "--accuracy is for a run or forecast only";
    if (o_.command != "forecast") return "";
    o_.forecast = {.time = quantity(time_, a_duration),
                   .memory = quantity(memory_, a_size),
                   .apply = of_forecast_.back()->count() > 0,
                   .apply_to = apply_to_};
    const bool knows_why = !o_.forecast.apply || o_.accuracy || o_.forecast.time || o_.forecast.memory;
    return knows_why ? "" : "--apply needs a limit: expected --accuracy, --time or --memory";
  }

  /// Problem of the format with other options; empty if there is none.
  [[nodiscard]] std::string problem_of_format(const PointFormat& format) {
    const std::string name = "--format " + o_.format;
    const auto expected = [](const auto& has) { return ": expected --format " + names_of_formats(has); };
    if (!format.missing.empty()) return name + " is left out of this build, missing: " + std::string(format.missing);
    if (o_.las_1_0 && format.kind != PointKind::las) return "--las10 and " + name + ": expected --format las";
    if (o_.colours && !format.colours)
      return "--colours and " + name + ": it has no colours" + expected([](const auto& f) { return f.colours; });
    if ((!o_.columns.empty() || o_.uncertainty) && format.kind == PointKind::fixed)
      return (o_.uncertainty ? "--uncertainty and " : "--columns and ") + name + ": it has no further columns" +
             expected([](const auto& f) { return f.kind != PointKind::fixed; });
    if (!scan_rate_.empty() && !format.in_scans)
      return "--scanRate and " + name + ": it is not in scans" + expected([](const auto& f) { return f.in_scans; });
    if (!scan_rate_.empty()) o_.scan_rate = *text::number_in<double>(scan_rate_);
    if (!o_.kitti_classes.empty() && o_.format != "kitti") return "--kittiClasses needs --format kitti";
    if (!waveform_bins_.empty() && !o_.write_waveform) return "--waveformBins needs --writeWaveform";
    if (!waveform_bins_.empty() && format.waveform_arrays)
      return "--waveformBins and " + name + ": its waveforms are arrays; another format has text";
    if (!waveform_bins_.empty()) o_.waveform_bins = *text::number_in<std::uint32_t>(waveform_bins_);
    if (o_.command == "forecast" && o_.format == "ptx")
      return "forecast and --format ptx: the file has a line for each pulse, a size that is not forecast: expected "
             "another format";
    return "";
  }

  /// Reads --project, whose map is that of --epsg unless given. Returns a problem; empty if there is none.
  [[nodiscard]] std::string settle_projection() {
    if (project_.empty()) return "";
    const std::size_t colon = project_.find(':');
    const auto from = codes_in(colon == std::string::npos ? "0" : project_.substr(0, colon)),
               to = codes_in(colon == std::string::npos ? project_ : project_.substr(colon + 1));
    if (!from || !to || to->epsg == 0 || from->vertical_epsg != 0)
      return "--project: '" + project_ + "': expected a code from 1024 to 32766, or two of them as 4258:25832";
    if (to->vertical_epsg != 0)
      return "--project: '" + project_ + "': expected no vertical system, as heights are kept: --epsg names it";
    o_.project_from = from->epsg;
    o_.project_to = to->epsg;
    if (!o_.reference && o_.wkt.empty()) o_.reference = to;
    if (o_.reference && o_.wkt.empty() && o_.reference->epsg != to->epsg && o_.reference->epsg != 0)
      return "--project " + project_ + " and --epsg " + epsg_ + ": expected the same map";
    return "";
  }

  /// Checks and completes all other options, with notes on those without effect. Returns a problem; empty if there is
  /// none.
  [[nodiscard]] std::string settle() {
    for (std::size_t i = 0; i < std::size(unused_options); ++i)
      if (unused_[i]->count() > 0)
        o_.notes.push_back(std::string("--") + unused_options[i].name + " has no effect: " + unused_options[i].why);
    const bool is_las = las_ || o_.las_1_0;
    const std::string asked_by_flags = is_las ? (zip_ && !o_.las_1_0 ? "laz" : "las") : zip_ ? "xyz.gz" : "xyz";
    if (o_.format.empty())
      o_.format = asked_by_flags;
    else if ((las_ || zip_) && o_.format != asked_by_flags)
      o_.notes.push_back("--format " + o_.format + " has precedence over " + (las_ ? "--lasOutput" : "--zipOutput"));
    if (o_.las_1_0 && o_.format.ends_with("laz"))
      return "--las10 and --format " + o_.format + ": only LAS 1.4 is compressed";
    if (o_.las_1_0 && zip_ && o_.format == "las")
      o_.notes.push_back("--zipOutput has no effect on LAS 1.0: it is not compressed");
    o_.colours = o_.colours || o_.near_infrared;
    const PointFormat& format = point_format(o_.format);
    const bool is_las_file = format.kind == PointKind::las;
    if (const std::string problem = problem_of_format(format); !problem.empty()) return problem;
    if (o_.colours && o_.las_1_0) return "--colours need LAS 1.4, or another format than LAS";
    if (o_.colours && o_.format == "las" && o_.write_waveform)
      return "--colours and --writeWaveform: LAS has no points of both here";
    if (!epsg_.empty()) o_.reference = codes_in(epsg_);
    if (const std::string problem = settle_projection(); !problem.empty()) return problem;
    if (!epsg_.empty() && !o_.wkt.empty()) return "--epsg and --wkt: expected one of them";
    if (!misses_at_.empty()) o_.misses_at = text::number_in<double>(misses_at_);
    const double farthest =
        o_.las_scale * (1 << 30);  // so that two points on opposite sides fit 32 bits. Source: LAS 1.4 R15, table 7
    if (o_.misses_at.value_or(0) > farthest && is_las_file)
      return "--missesAt: '" + misses_at_ + "': expected at most " + std::to_string(std::llround(farthest)) +
             " m, as LAS has 32 bits for a coordinate; a greater --lasScale reaches farther";
    if (!seed_.empty() && seed_ != "AUTO") o_.seed = text::number_in<std::uint64_t>(seed_);
    o_.platform_noise = !no_platform_noise_;
    o_.leg_noise = !no_leg_noise_;
    o_.store = {scene_folder(), !rebuild_scene_, !no_scene_writing_};
    std::error_code error;
    o_.assets.push_back(fs::current_path(error));
    for (fs::path& folder : own_assets()) o_.assets.push_back(std::move(folder));
    return "";
  }

  CLI::App app_{
      "Simulates the survey of an XML document.\n\n"
      "  pulsecast SURVEY.xml            simulates it\n"
      "  pulsecast check SURVEY.xml      checks it and lists all errors\n"
      "  pulsecast info SURVEY.xml       describes its legs and its scene\n"
      "  pulsecast preview SURVEY.xml    draws a preview of its points\n"
      "  pulsecast forecast SURVEY.xml   predicts time, memory and errors, and finds the cheapest settings within "
      "limits\n"
      "  pulsecast catalogue             lists the scanners and platforms of the catalogue\n"
      "  pulsecast doctor                tells what this installation can do, and what it lacks\n",
      "pulsecast"};
  Options o_;
  std::string seed_, epsg_, project_, misses_at_, scan_rate_, waveform_bins_, time_, memory_, apply_to_, swallowed_;
  bool las_ = false, zip_ = false, no_platform_noise_ = false, no_leg_noise_ = false, rebuild_scene_ = false,
       no_scene_writing_ = false;
  std::vector<CLI::Option*> of_forecast_, unused_;
};

}  // namespace

Options options_of_files(const std::vector<std::string>& words) { return CommandLine().read_file_options(words); }

std::vector<std::pair<std::string, std::string>> file_options() { return CommandLine().file_options(); }

std::optional<Options> read_command_line(int argc, char** argv, int& status) {
  CommandLine line;
  return line.read({argv + 1, argv + argc}, status);
}
