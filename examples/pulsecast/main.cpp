// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Simulates the survey of an XML document in the format of HELIOS++.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <random>
#include <set>
#include <sstream>
#include <stop_token>
#include <utility>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/scene_cache.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/version.hpp>

#include "../summary.hpp"
#include "accuracy.hpp"
#include "clock.hpp"
#include "doctor.hpp"
#include "entry.hpp"
#include "error_report.hpp"
#include "forecast_report.hpp"
#include "loading.hpp"
#include "notes.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "pages.hpp"
#include "point_formats.hpp"
#include "ranks.hpp"
#include "reference_systems.hpp"
#include "run_folder.hpp"
#include "survey_files.hpp"
#include "survey_inputs.hpp"
#include "written_name.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using helios::CompiledSurvey;
using helios::Simulation;
using helios::SurveySettings;

namespace {

enum ExitStatus { success = 0, bad_input = 1, bad_usage = 2, interrupted = 3 };

std::stop_source stopping;
std::atomic<int> signals = 0;
std::atomic<bool> simulating = false;
std::atomic<bool> follows = false;  // another process decides when to stop

/// Completes results before the end; exits at once if there are none, or at the second signal.
extern "C" void on_signal(int) {
  if (!follows && (signals.fetch_add(1) > 0 || !simulating)) _exit(interrupted);
}

Loading loading_of(const Options& o, const SurveyFile& file, std::uint64_t seed) {
  return {.settings = {.seed = seed,
                       .echo_width = o.echo_width,
                       .waveforms = o.write_waveform,
                       .las_waveforms = o.format == "las" && o.write_waveform && !o.las_1_0,
                       .waveform_noise = o.waveform_noise,
                       .fixed_incidence = o.fixed_incidence,
                       .uncertainty = o.states_uncertainty(),
                       .library_physics = o.library_physics,
                       .light_paths = o.light_paths,
                       .platform_noise = o.platform_noise,
                       .leg_noise = o.leg_noise,
                       .assets = o.assets,
                       .leg_places = file.leg_places,
                       .place = file.place,
                       .threads = o.threads,
                       .projector = projector_of(o)},
          .scene_text = file.scene_text,
          .store = o.store};
}

/// Command `run`.
class Session {
 public:
  Session(const Options& options, const SurveyFile& file, std::uint64_t seed, Ranks& ranks, Notes& notes)
      : options_(options),
        file_(file),
        survey_(file.survey),
        ranks_(ranks),
        pages_(options, file.survey),
        log_{.seed = seed},
        notes_(notes) {
    if (options_.page && options_.resume)
      notes_.note("--page shows only the legs simulated now, not those of the earlier run");
  }

  int run() {
    const fs::path parent = options_.output / survey_.name;
    const auto [again, is_complete] = options_.resume ? run_to_resume(parent) : RunToResume{};
    if (is_complete) return success;
    const double start_time =
        gps_week_seconds(std::stoll(ranks_.from_first(std::to_string(unix_time_of(options_.gps_start_time)))));
    const auto inputs = std::make_shared<SurveyInputs>(survey_, options_.assets);
    log_.how = run_inputs();
    if (again)
      resume_from(*again, *inputs);
    else
      log_.start_time = start_time;
    note_inputs(*inputs);
    std::unique_ptr<Simulation> simulation = loaded(inputs);
    note_inputs(*inputs);
    if (options_.accuracy) {
      chosen_ = chosen_settings(*simulation, *options_.accuracy, log_.seed, options_.threads,
                                options_.quiet || !ranks_.first());
      simulation = simulation->with_receivers(*chosen_);
    }
    if (again) require_run(*again, simulation->repetitions());
    settle_start_time(*simulation, again, start_time);
    if (again) forget_run_before(parent);
    print_notes(*simulation);
    take_columns(options_, survey_, *simulation);  // may refuse the format, before there is a folder
    if (!pages_.address().empty()) std::cout << "watch this run at " << pages_.address() << std::endl;
    const RunSummary all = play_all(simulation, *inputs, parent, again);
    pages_.finish(all.complete);
    if (!all.complete)
      notes_.note("stopped: files are complete up to there; the same command with --resume continues the run");
    if (const std::string why = why_no_points(*simulation, all, 0); !why.empty()) notes_.warn(why);
    notes_.note(left_out_.notes(options_.las_1_0));
    if (all.complete && all.echoes > 0 && !empty_legs_.empty())
      notes_.warn("no points from leg " + empty_legs_ +
                  ": a leg without pulses, as the last of a platform that moves, may be inactive");
    if (all.count(Fate::blocked) > all.slots / 20 * 19)
      notes_.note("more than 95 % of the slots are outside the field of view: are its angles in degrees?");
    const std::string traffic = ranks_.traffic();
    if (!options_.quiet) print_summary(all, traffic);
    notes_.require_none();
    return all.complete ? success : interrupted;
  }

 private:
  struct RunToResume {
    std::optional<fs::path> folder{};
    bool is_complete = false;  ///< nothing to resume, as the newest run is complete
  };

  /// Finds the run to resume, if there is one. Otherwise adds a note.
  [[nodiscard]] RunToResume run_to_resume(const fs::path& parent) {
    const RunFolders found = ranks_.first() ? lock_unfinished(parent, lock_) : RunFolders{};
    const fs::path unfinished = ranks_.from_first(found.unfinished.value_or(fs::path()).string());
    if (!unfinished.empty()) return {.folder = unfinished};
    const fs::path newest = ranks_.from_first(found.newest.value_or(fs::path()).string());
    if (newest.empty())
      notes_.note("no run to resume in " + parent.string() + ": a new run is started");
    else
      notes_.note("no run to resume: the newest one, " + newest.string() + ", is complete");
    return {.is_complete = !newest.empty()};
  }

  [[nodiscard]] std::unique_ptr<Simulation> loaded(const std::shared_ptr<SurveyInputs>& inputs) {
    Loading loading = loading_of(options_, file_, log_.seed);
    loading.inputs = inputs;
    loading.sharing = &ranks_;
    loading.store.write = loading.store.write && ranks_.first();
    return load(survey_, loading, scene_notes_);
  }

  /// Throws unless the resumed run is one of the survey's repetitions.
  void require_run(const fs::path& folder, int runs) const {
    if (log_.run >= runs)
      throw FileError((folder / RunLog::name).string(), "line 3",
                      "'run " + std::to_string(log_.run) + "': expected less than the number of repetitions, " +
                          std::to_string(runs));
  }

  /// Start time: that of a trajectory takes precedence over the option; a resumed run keeps its own.
  void settle_start_time(const Simulation& simulation, const std::optional<fs::path>& again, double asked) {
    const std::optional<double> clock = simulation.compiled().clock_start;
    if (again && !clock && !options_.gps_start_time.empty())
      require_same(*again, second_of_week(log_.start_time), second_of_week(asked));
    if (!again && clock) log_.start_time = *clock;
    settle_clock(options_, simulation, log_.start_time,
                 log_.start_time + simulation.repetitions() * simulation.compiled().source.duration().seconds(),
                 notes_);
  }

  /// Removes the log of the previous repetition, a possible remnant of an interrupted run.
  void forget_run_before(const fs::path& parent) const {
    if (!ranks_.first() || log_.before.empty() || !fs::exists(parent / log_.before)) return;
    const RunLock lock(parent / log_.before);
    RunLog::remove(parent / log_.before);
  }

  /// Simulates all remaining repetitions, each into its own folder. `simulation` is then the last one.
  RunSummary play_all(std::unique_ptr<Simulation>& simulation, SurveyInputs& inputs, const fs::path& parent,
                      std::optional<fs::path> again) {
    const int repetitions = simulation->repetitions();
    RunSummary all;
    fs::path folder = again ? *again : new_folder(parent);
    for (int r = log_.run; r < repetitions && all.complete; ++r) {
      log_.run = r;
      if (r > 0) {
        simulation = simulation->repetition(r);
        if (chosen_) simulation = simulation->with_receivers(*chosen_);
        if (note_inputs(inputs)) log_.write(folder);
        print_notes(*simulation);
        take_columns(options_, survey_, *simulation);
      }
      std::optional<ErrorReport> errors;
      if ((options_.errors || chosen_) && ranks_.first()) errors.emplace(*simulation, options_, log_.seed);
      const RunSummary played = play(*simulation, folder, std::exchange(again, std::nullopt).has_value());
      if (errors && played.complete)
        errors->finish(folder, {file_.text, log_.how, log_.inputs, log_.seed, r, chosen_ ? text_of(*chosen_) : ""},
                       played);
      all.add(played);
      const fs::path done = folder;
      if (!all.complete) break;
      const std::optional<RunLock> lock_of_done = std::exchange(lock_, std::nullopt);  // held until its log is removed
      log_.run = r + 1;
      log_.files.clear();
      log_.before = done.filename().string();
      if (r + 1 < repetitions) folder = new_folder(parent);  // at all times one folder is unfinished
      if (ranks_.first()) RunLog::remove(done);
    }
    return all;
  }

  void print_summary(const RunSummary& all, const std::string& traffic) const {
    print(all);
    if (!traffic.empty()) std::cout << "  messages     " << traffic << '\n';
    const auto fate = [&](const char* name, Fate f, const char* unit) {
      if (all.count(f) > 0)
        std::cout << "  " << std::left << std::setw(13) << name << std::right << std::setw(12) << all.count(f) << unit;
    };
    fate("with echoes", Fate::returned, " pulses\n");
    for (const std::string& written : folders_) std::cout << "  " << written << '\n';
  }

  [[nodiscard]] fs::path new_folder(const fs::path& parent) {
    fs::path folder;
    simulating = true;  // from here on, an interruption must leave the folder in order
    if (ranks_.first()) {
      auto made = new_run_folder(parent, log_);
      folder = std::move(made.first);
      lock_.emplace(std::move(made.second));
    }
    return ranks_.from_first(folder.string());
  }

  void print_notes(const Simulation& simulation) {
    notes_.warn(simulation.warnings());
    notes_.note(scene_notes_);
    notes_.require_none();
  }

  /// Line with all inputs of the results except seed and time.
  [[nodiscard]] std::string run_inputs() const {
    io::Digest survey;
    survey.add(std::string_view(file_.text));
    std::ostringstream out;
    out << "pulsecast " << PULSECAST_VERSION << " survey=" << std::hex << survey.value().low << std::dec
        << " format=" << options_.format << " scale=" << text::to_text(options_.las_scale)
        << " las10=" << options_.las_1_0 << " flags=" << options_.write_waveform << options_.write_pulse
        << options_.echo_width << options_.waveform_noise << options_.fixed_incidence << options_.library_physics
        << options_.light_paths << options_.split_by_channel << options_.platform_noise << options_.leg_noise
        << options_.write_misses << options_.geojson;
    if (const io::SpatialReference& in = *options_.reference; in != io::SpatialReference{}) {
      io::Digest wkt;
      wkt.add(std::string_view(in.wkt));
      out << " reference=" << in.epsg << '+' << in.vertical_epsg << ',' << text::to_text(in.unit) << ','
          << text::to_text(in.vertical_unit) << ',' << hex(wkt.value());
    }
    if (options_.project_to != 0) out << " project=" << options_.project_from << ':' << options_.project_to;
    if (options_.uncertainty) out << " uncertainty";
    if (options_.accuracy) out << " accuracy=" << text_of(*options_.accuracy);
    if (options_.colours) out << " colours=" << options_.near_infrared;
    for (const std::string& column : options_.columns) out << " column=" << column;
    if (point_format(options_.format).in_scans) out << " scans=" << text::to_text(options_.scan_rate);
    if (options_.kitti_classes == "own") out << " classes=own";
    if (!options_.kitti_classes.empty() && options_.kitti_classes != "own")
      for (const auto& [of, label] : read_kitti_classes(options_.kitti_classes)) out << " class=" << of << ':' << label;
    if (options_.waveform_bins > 0) out << " bins=" << options_.waveform_bins;
    if (options_.misses_at) out << " misses=" << text::to_text(*options_.misses_at);
    return out.str();
  }

  static void require_same(const fs::path& folder, const std::string& then, const std::string& now) {
    if (then != now)
      throw std::invalid_argument(folder.string() + ": was started with another survey or other options, '" + then +
                                  "'; now they are '" + now + "'");
  }

  static std::string second_of_week(double time) {
    std::ostringstream text;
    text << "--gpsStartTime of second " << std::setprecision(17) << time << " of the GPS week";
    return text.str();
  }

  /// Adds the inputs found so far to the log. Returns true if there are new ones.
  bool note_inputs(SurveyInputs& inputs) {
    const std::size_t before = log_.inputs.size();
    if (ranks_.first())
      for (const auto& [path, fingerprint] : inputs.fingerprints())
        log_.inputs.emplace(written_name(path), fingerprint);
    return log_.inputs.size() > before;
  }

  static void require_same_inputs(const fs::path& folder, const RunLog& then, SurveyInputs& inputs) {
    static const std::string missing = hex(io::Fingerprint{});
    std::string changed;
    for (const auto& [path, before] : then.inputs) {
      const std::string now = hex(inputs.fingerprint(name_written(path)));
      if (now != before)
        changed += (changed.empty() ? "" : ", ") + path +
                   (before == missing ? " is new"
                    : now == missing  ? " is gone"
                                      : " has changed");
    }
    if (!changed.empty()) throw FileError(folder.string(), "", "cannot be resumed: since its start, " + changed);
  }

  void resume_from(const fs::path& folder, SurveyInputs& inputs) {
    const std::string text = ranks_.from_first(ranks_.first() ? RunLog::text_in(folder) : std::string());
    RunLog log = RunLog::parse(text, (folder / RunLog::name).string());
    require_same(folder, log.how, log_.how);
    if (ranks_.first()) require_same_inputs(folder, log, inputs);
    if (options_.seed)
      require_same(folder, "--seed " + std::to_string(log.seed), "--seed " + std::to_string(*options_.seed));
    log_ = std::move(log);
  }

  /// True if results are complete; otherwise they are removed from the log.
  bool are_whole(const std::vector<fs::path>& results) {
    const std::vector<fs::path> damaged = log_.damaged(results);
    for (const fs::path& path : damaged)
      notes_.note(path.string() + " is not as long as when it was completed: its legs are simulated again");
    if (damaged.empty() && log_.names(results)) return true;
    for (const fs::path& path : results) log_.files.erase(path.filename().string());
    return false;
  }

  void close(LegRun& files) {
    files.close();
    left_out_.add(files.left_out());
  }

  RunSummary play(const Simulation& simulation, const fs::path& folder, bool again) {
    folders_.push_back(folder.string());
    const double start_time = log_.start_time + log_.run * simulation.compiled().source.duration().seconds();
    const CompiledSurvey& compiled = simulation.compiled();
    const std::vector<std::string> channels = file_channels(options_, survey_);

    simulating = true;
    std::map<std::string, std::size_t> last;  // last leg of each prefix
    std::map<std::string, bool> skipped;
    const auto files_of = [&](const std::string& prefix) { return leg_files(folder, prefix, options_, channels); };
    for (std::size_t k = 0; k < compiled.legs.size(); ++k) {
      if (!compiled.legs[k].active) continue;
      const std::string prefix = prefix_of(compiled.legs[k]);
      last[prefix] = k;
      if (again && !skipped.contains(prefix))
        skipped[prefix] = ranks_.from_first(ranks_.first() && are_whole(files_of(prefix)) ? "whole" : "") == "whole";
    }
    if (again && ranks_.first()) log_.write(folder);  // without the results to be repeated
    PulseIndex total = 0, before = 0;
    for (const auto& leg : compiled.legs)
      if (leg.active && !skipped[prefix_of(leg)]) total += leg.end - leg.first;

    if (total > 0) pages_.begin(folder, compiled, options_);
    std::map<std::string, std::unique_ptr<LegRun>> open;
    RunSummary all;
    ProgressLine line;
    for (std::size_t k = 0; k < compiled.legs.size() && all.complete; ++k) {
      const CompiledSurvey::Leg& leg = compiled.legs[k];
      const std::string prefix = prefix_of(leg);
      if (!leg.active || skipped[prefix]) continue;
      const auto at = open.try_emplace(prefix).first;
      if (!at->second) at->second = ranks_.leg_run(folder, prefix, options_, start_time, channels);
      LegRun& files = *at->second;
      files.add_trajectory(compiled.source.legs()[k], leg.start, leg.trajectory_interval);
      if (options_.page || options_.live) files.watch = [this](const EchoBatch& batch) { pages_(batch); };
      RunOptions run{.threads = options_.threads, .first = leg.first, .end = leg.end, .stop = stopping.get_token()};
      run.progress = [&](const Progress& p) {
        if (signals > 0 || pages_.stop_requested()) stopping.request_stop();
        const Progress so_far{before + p.done, total, all.echoes + p.echoes, all.seconds + p.seconds};
        if (!options_.quiet) line(so_far);
        pages_.show(so_far);
      };
      if (signals > 0) stopping.request_stop();
      const RunSummary part = files.run(simulation.survey(), run);
      if (part.complete && part.echoes == 0)
        empty_legs_ += (empty_legs_.empty() ? "" : ", ") + std::to_string(leg.number);
      all.add(part);
      before += leg.end - leg.first;
      if (!all.complete) break;
      if (last[prefix] != k) continue;
      close(files);
      open.erase(at);
      if (ranks_.first()) log_.add_files(folder, files_of(prefix));
    }
    for (auto& [prefix, files] : open) close(*files);  // of an interrupted run
    pages_.end();
    return all;
  }

  Options options_;  // of the command line, and what the survey adds to them
  const SurveyFile& file_;
  const SurveySettings& survey_;
  Ranks& ranks_;
  Pages pages_;
  LeftOut left_out_;  // of all legs
  RunLog log_;
  std::optional<RunLock> lock_;  // of the output folder, on the first process
  std::vector<std::string> folders_, scene_notes_;
  std::string empty_legs_;                           // numbers of active legs without points
  std::optional<helios::ReceiverOverrides> chosen_;  // by --accuracy
  Notes& notes_;
};

void print_info(const Options& options, const SurveyFile& file, std::uint64_t seed, Notes& notes) {
  const SurveySettings& survey = file.survey;
  std::vector<std::string> scene_notes;
  const std::unique_ptr<Simulation> loaded = load(survey, loading_of(options, file, seed), scene_notes);
  const Simulation& simulation = *loaded;
  notes.warn(simulation.warnings());
  notes.note(scene_notes);
  notes.require_none();
  const CompiledSurvey& compiled = simulation.compiled();
  const Simulation::Scene scene = simulation.scene();
  std::cout << std::fixed << std::setprecision(3) << "survey   " << survey.name << "\nscanner  " << survey.scanner.id
            << ", " << survey.scanner.channels.size()
            << (survey.scanner.channels.size() == 1 ? " channel" : " channels") << "\nplatform " << survey.platform.id
            << "\nscene    " << scene.parts << " parts, " << scene.moving << " of them move; " << scene.triangles
            << " triangles; " << static_cast<double>(scene.memory) / (1 << 20) << " MiB\n";
  if (!scene.empty) {
    const Vec3 a = scene.min, b = scene.max;
    std::cout << "extent   x " << a.x << " to " << b.x << " m, y " << a.y << " to " << b.y << " m, z " << a.z << " to "
              << b.z << " m\n";
  }
  if (simulation.repetitions() > 1) std::cout << "runs     " << simulation.repetitions() << '\n';
  std::cout << "\n  files       starts [s]   lasts [s]   rate [kHz]         slots\n";
  for (const auto& leg : compiled.legs) {
    const std::string name = leg.active ? prefix_of(leg) : "(inactive)";
    std::cout << "  " << std::left << std::setw(10) << name << std::right << std::setw(12) << leg.start.seconds()
              << std::setw(12) << leg.duration.seconds() << std::setw(13) << leg.pulse_rate / 1e3 << std::setw(14)
              << leg.end - leg.first << '\n';
  }
  std::cout << "  in all    " << std::setw(12) << "" << std::setw(12) << compiled.source.duration().seconds()
            << std::setw(13) << "" << std::setw(14) << compiled.source.size() << '\n';
}

void preview(const Options& options, const SurveyFile& file, std::uint64_t seed, Notes& notes) {
  std::vector<std::string> scene_notes;
  const std::unique_ptr<Simulation> loaded = load(file.survey, loading_of(options, file, seed), scene_notes);
  const Simulation& simulation = *loaded;
  notes.warn(simulation.warnings());
  notes.require_none();
  std::error_code error;
  fs::create_directories(options.output, error);
  if (error)
    throw FileError(options.output.string(), "", "the output folder cannot be created (" + error.message() + ")");
  const fs::path path = options.output / (file.survey.name + "_preview.png");
  constexpr PulseIndex enough = 400'000;
  const PulseIndex slots = simulation.compiled().source.size();
  PulseIndex stride = std::max<PulseIndex>(1, slots / enough);
  if (stride > 1) stride |= 1;  // odd, to be out of step with the channels
  const std::unique_ptr<PointFile> picture = picture_file(path, file.survey);
  const RunSummary summary = pulsecast::run(simulation.survey(), {.threads = options.threads, .stride = stride},
                                            [&](const EchoBatch& batch) { (*picture)(batch); });
  picture->close();
  if (!options.quiet)
    std::cout << "1 pulse in " << stride << " of " << slots << ", " << summary.echoes << " points: " << path.string()
              << '\n';
}

/// Options of a run, with what the survey adds to them.
Options settled_by(const SurveyFile& file, Options options, Notes& notes) {
  options.reference = reference_system_of(options, file.survey.scene, notes);
  options.light_paths = options.light_paths || file.survey.scene.follows_light();
  return options;
}

int work(const Options& options, Ranks& ranks) {
  if (options.command != "run" && !ranks.first()) return success;  // other commands use one process
  Notes notes(options);
  notes.note(options.notes);
  if (options.command == "catalogue") {
    print_catalogue(options);
    return success;
  }
  if (options.command == "doctor") {
    print_abilities(options);
    return success;
  }
  const SurveyFile file = read_survey_file(options, notes);
  if (options.command != "check") notes.require_none();  // it reports all first
  std::optional<std::uint64_t> seed = options.seed ? options.seed : file.survey.seed;
  if (!seed && options.command == "run")
    seed = std::stoull(ranks.from_first(std::to_string(std::random_device{}())));
  else if (!seed)
    seed = std::random_device{}();
  if (options.command == "check") {
    notes.warn(helios::check_without_scene(file.survey, file.leg_places, projector_of(options)));
    notes.require_none();
    if (!options.quiet) std::cout << options.survey.string() << ": nothing is wrong\n";
  } else if (options.command == "info") {
    print_info(options, file, *seed, notes);
  } else if (options.command == "preview") {
    preview(options, file, *seed, notes);
  } else if (options.command == "forecast") {
    (void)helios::check_without_scene(file.survey, file.leg_places, projector_of(options));
    return forecast(settled_by(file, options, notes), file, loading_of(options, file, *seed), notes) ? success
                                                                                                     : bad_input;
  } else {
    (void)helios::check_without_scene(file.survey, file.leg_places, projector_of(options));  // before expensive work
    Options settled = settled_by(file, options, notes);
    notes.require_none();
    if (ranks.count() > 1 && (options.page || options.live)) {
      settled.page = settled.live = false;
      if (ranks.first())
        notes.note("--page and --live have no effect under mpirun: they need all points in one process");
    }
    const auto shared = [](const PointFormat& format) { return format.shared; };
    if (ranks.count() > 1 && options.format != "copc.laz" && !shared(point_format(options.format)))
      throw std::invalid_argument("--format " + options.format +
                                  " needs all points in one process: expected --format " + names_of_formats(shared) +
                                  " under mpirun, or no mpirun");
    if (ranks.count() > 1 && options.waveform_bins > 0)
      throw std::invalid_argument("--waveformBins needs all waveforms in one process: expected no mpirun");
    if (ranks.count() > 1 && options.format == "copc.laz") {
      settled.format = "laz";
      if (ranks.first()) notes.note("--format copc.laz needs all points in one process: under mpirun, laz is written");
    }
    if (ranks.count() > 1 && options.geojson) {
      settled.geojson = false;
      if (ranks.first()) notes.note("--geojson has no effect under mpirun: it needs all points in one process");
    }
    return Session(settled, file, *seed, ranks, notes).run();
  }
  return success;
}

}  // namespace

int pulsecast_main(int argc, char** argv) {
  std::unique_ptr<Ranks> ranks;
  std::optional<Options> options;
  try {
    ranks = join_ranks(argv);
    int status = success;
    options = read_command_line(argc, argv, status);
    if (!options) return status;
    options->threads = ranks->threads(options->threads);
    follows = !ranks->first();
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGXFSZ, SIG_IGN);  // makes exceeding the file size limit an error with a message
    return naming(options->survey.string(),
                  [&] { return work(*options, *ranks); });  // names the survey in errors of its settings
  } catch (const std::exception& error) {
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    if (ranks) ranks->complain();
    std::cerr << (options && simulating && !options->quiet && isatty(STDERR_FILENO) != 0 ? "\n" : "") << "error: ";
    if (no_memory && options)
      std::cerr
          << options->survey.string()
          << ": takes more memory than there is: expected fewer --threads, a smaller scene, or more free memory\n";
    else
      std::cerr << error.what() << '\n';
    if (ranks) ranks->abort(bad_input);
    return bad_input;
  }
}
