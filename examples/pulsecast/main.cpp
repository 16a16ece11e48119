// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Simulates the survey of an XML document, as users of HELIOS++ have them.

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <stop_token>

#include <pulsecast/adapters/output_file.hpp>

#include "../summary.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "simulation.hpp"
#include "survey_files.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using adapters::SurveyPlan;
using adapters::SurveySettings;

namespace {

enum ExitStatus { success = 0, bad_input = 1, bad_usage = 2, interrupted = 3 };

std::stop_source stopping;
std::atomic<int> signals = 0;

extern "C" void on_signal(int) {
  if (signals.fetch_add(1) > 0) _exit(interrupted);  // whoever asks twice is in a hurry
}

/// Seconds of the GPS week at a moment of UTC, given as seconds since 1970. Source: IS-GPS-200; leap seconds: IERS Bulletin C.
double gps_week_seconds(std::int64_t unix_time) {
  static constexpr std::int64_t leaps[] = {362793600, 394329600,  425865600,  489024000,  567993600,  631152000,
                                           662688000, 709948800,  741484800,  773020800,  820454400,  867715200,
                                           915148800, 1136073600, 1230768000, 1341100800, 1435708800, 1483228800};
  constexpr std::int64_t epoch = 315964800, week = 604800;
  std::int64_t gps = unix_time - epoch;
  for (const std::int64_t leap : leaps) gps += unix_time >= leap ? 1 : 0;
  return static_cast<double>(((gps % week) + week) % week);
}

/// A moment as users write it.
std::int64_t unix_time_of(const std::string& text) {
  if (text.empty()) return std::time(nullptr);
  std::tm t{};
  std::istringstream in(text);
  if (text.find_first_not_of("0123456789") == std::string::npos && text.size() < 16) return std::stoll(text);
  in >> std::get_time(&t, "%Y-%m-%d %H:%M:%S");
  if (!in || in.peek() != std::istringstream::traits_type::eof())
    throw std::invalid_argument("--gpsStartTime '" + text + "': expected YYYY-MM-DD hh:mm:ss in UTC, or whole seconds since 1970");
  return timegm(&t);
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm t{};
  localtime_r(&now, &t);
  std::ostringstream out;
  out << std::put_time(&t, "%Y-%m-%d_%H-%M-%S");
  return out.str();
}

std::string prefix_of(const SurveyPlan::LegPlan& leg) {
  if (leg.strip) return "strip" + std::string(3 - std::min<std::size_t>(3, leg.strip->size()), '0') + *leg.strip;
  const std::string number = std::to_string(leg.number);
  return "leg" + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
}

/// What a run must know to be gone on with, in a file beside its results until it is complete.
struct Log {
  static constexpr const char* name = "unfinished.txt";
  std::uint64_t seed = 0;
  double start_time = 0;           ///< of the first run [s]
  int run = 0;                     ///< which repetition this is
  std::string how{};               ///< what else decides about the results
  std::vector<std::string> cut{};  ///< prefixes of files that are whole, but end too early

  void write(const fs::path& folder) const {
    adapters::OutputFile file(folder / name);
    std::ostringstream text;
    text << "seed " << seed << "\nstart_time " << std::setprecision(17) << start_time << "\nrun " << run << "\nhow " << how << '\n';
    for (const std::string& prefix : cut) text << "cut " << prefix << '\n';
    file.write(text.str());
    file.commit();
  }

  static std::optional<Log> read(const fs::path& folder) {
    std::ifstream in(folder / name);
    if (!in) return std::nullopt;
    Log log;
    for (std::string line; std::getline(in, line);) {
      const std::size_t blank = line.find(' ');
      const std::string key = line.substr(0, blank), value = blank == std::string::npos ? "" : line.substr(blank + 1);
      if (key == "seed") log.seed = std::stoull(value);
      if (key == "start_time") log.start_time = std::stod(value);
      if (key == "run") log.run = std::stoi(value);
      if (key == "how") log.how = value;
      if (key == "cut") log.cut.push_back(value);
    }
    return log;
  }
};

void sum_up(RunSummary& all, const RunSummary& one) {
  all.slots += one.slots, all.echoes += one.echoes, all.rays += one.rays, all.seconds += one.seconds, all.energy += one.energy;
  for (std::size_t f = 0; f < fate_count; ++f) all.fates[f] += one.fates[f], all.spent[f] += one.spent[f];
  all.complete = all.complete && one.complete;
}

/// The command `run`.
class Session {
 public:
  Session(const Options& options, SurveySettings survey, std::uint64_t seed)
      : options_(options), survey_(std::move(survey)), log_{.seed = seed} {}

  int run() {
    const fs::path parent = options_.output / survey_.name;
    std::optional<fs::path> again;
    if (options_.resume) {
      const Found found = runs_in(parent);
      again = found.unfinished;
      if (!again && found.newest) {
        note("there is nothing to resume: the newest run, " + found.newest->string() + ", is complete");
        return success;
      }
      if (!again) note("there is nothing to resume in " + parent.string() + ": this is a new run");
    }
    log_.how = how();
    if (again) {
      const Log before = *Log::read(*again);
      if (before.how != log_.how)
        throw std::invalid_argument(again->string() + ": was begun with other options, '" + before.how + "'; now they are '" + log_.how +
                                    "'");
      log_ = before;
    } else {
      log_.start_time = gps_week_seconds(unix_time_of(options_.gps_start_time));
    }
    Simulation simulation(survey_, {.seed = log_.seed,
                                    .echo_width = options_.echo_width,
                                    .waveforms = options_.write_waveform,
                                    .waveform_noise = options_.waveform_noise,
                                    .fixed_incidence = options_.fixed_incidence,
                                    .platform_noise = options_.platform_noise,
                                    .leg_noise = options_.leg_noise,
                                    .assets = options_.assets});
    if (!again && simulation.plan().clock_start) log_.start_time = *simulation.plan().clock_start;
    for (const std::string& warning : simulation.warnings()) note(warning);
    RunSummary all;
    fs::path folder = again ? *again : new_folder(parent, log_);
    for (int r = log_.run; r < simulation.runs() && all.complete; ++r) {
      log_.run = r;
      if (r > 0) simulation.begin(r);
      sum_up(all, play(simulation, folder));
      const fs::path done = folder;
      if (!all.complete) break;
      log_.run = r + 1, log_.cut.clear();
      if (r + 1 < simulation.runs()) folder = new_folder(parent, log_);  // so that there is always one that is not finished
      std::error_code ignored;
      fs::remove(done / Log::name, ignored);
    }
    if (!options_.quiet) {
      print(all);
      const auto fate = [&](const char* name, Fate f) {
        if (all.count(f) > 0)
          std::cout << "  " << std::left << std::setw(13) << name << std::right << std::setw(12) << all.count(f) << " pulses\n";
      };
      fate("with echoes", Fate::returned), fate("absorbed", Fate::absorbed), fate("blocked", Fate::blocked);
      for (const std::string& written : folders_) std::cout << "  " << written << '\n';
    }
    return all.complete ? success : interrupted;
  }

 private:
  void note(const std::string& text) const {
    if (!options_.quiet) std::cerr << "note: " << text << '\n';
  }

  [[nodiscard]] std::string how() const {
    std::ostringstream out;
    out << fs::weakly_canonical(options_.survey).string() << " format=" << options_.format << " scale=" << options_.las_scale
        << " las10=" << options_.las_1_0 << " flags=" << options_.write_waveform << options_.write_pulse << options_.echo_width
        << options_.waveform_noise << options_.fixed_incidence << options_.split_by_channel << options_.platform_noise
        << options_.leg_noise;
    return out.str();
  }

  struct Found {
    std::optional<fs::path> unfinished{}, newest{};
  };

  /// The newest runs of a survey.
  static Found runs_in(const fs::path& parent) {
    Found found;
    std::error_code error;
    for (fs::directory_iterator i(parent, error), end; !error && i != end; i.increment(error)) {
      const std::string name = i->path().filename().string();
      if (name.starts_with('.') || !i->is_directory(error)) continue;
      if (!found.newest || i->path() > *found.newest) found.newest = i->path();
      if (fs::exists(i->path() / Log::name, error) && (!found.unfinished || i->path() > *found.unfinished)) found.unfinished = i->path();
    }
    return found;
  }

  /// A folder of its own for each run, by the time of its start; it has its log from the beginning.
  static fs::path new_folder(const fs::path& parent, const Log& log) {
    const std::string stamp = local_time();
    std::error_code error;
    fs::create_directories(parent, error);
    if (error) throw FileError(parent.string(), "", "the output folder cannot be made (" + error.message() + ")");
    const fs::path making = parent / ('.' + stamp + '_' + std::to_string(getpid()));
    fs::create_directory(making, error);
    if (error) throw FileError(making.string(), "", "the output folder cannot be made (" + error.message() + ")");
    log.write(making);
    for (int n = 1; n < 1000; ++n) {
      const fs::path folder = parent / (n == 1 ? stamp : stamp + '_' + std::to_string(n));
      if (fs::exists(folder, error)) continue;
      fs::rename(making, folder, error);
      if (!error) return folder;
    }
    throw FileError((parent / stamp).string(), "", "the output folder cannot be made");
  }

  RunSummary play(const Simulation& simulation, const fs::path& folder) {
    folders_.push_back(folder.string());
    const std::vector<std::string> cut = std::exchange(log_.cut, {});
    const double start_time = log_.start_time + log_.run * simulation.plan().source.duration().seconds();
    const SurveyPlan& plan = simulation.plan();
    std::vector<std::string> channels;
    if (options_.split_by_channel && survey_.scanner.channels.size() > 1)
      for (const auto& c : survey_.scanner.channels) channels.push_back(c.id.empty() ? std::to_string(channels.size()) : c.id);

    std::map<std::string, std::size_t> last;  // leg of each prefix
    std::map<std::string, bool> skipped;
    for (std::size_t k = 0; k < plan.legs.size(); ++k) {
      if (!plan.legs[k].active) continue;
      const std::string prefix = prefix_of(plan.legs[k]);
      last[prefix] = k;
      if (!skipped.contains(prefix))
        skipped[prefix] = options_.resume && std::find(cut.begin(), cut.end(), prefix) == cut.end() &&
                          LegFiles::complete(folder, prefix, options_, channels);
    }
    PulseIndex total = 0, before = 0;
    for (const auto& leg : plan.legs)
      if (leg.active && !skipped[prefix_of(leg)]) total += leg.end - leg.first;

    std::map<std::string, LegFiles> open;
    std::set<std::string> done;
    RunSummary all;
    ProgressLine line;
    for (std::size_t k = 0; k < plan.legs.size() && all.complete; ++k) {
      const SurveyPlan::LegPlan& leg = plan.legs[k];
      const std::string prefix = prefix_of(leg);
      if (!leg.active || skipped[prefix]) continue;
      const auto at = open.try_emplace(prefix, folder, prefix, options_, start_time, channels).first;
      LegFiles& files = at->second;
      files.add_trajectory(plan.source.legs()[k], leg.start, leg.trajectory_interval);
      RunOptions run{.threads = options_.threads, .first = leg.first, .end = leg.end, .stop = stopping.get_token()};
      run.progress = [&](const Progress& p) {
        if (signals > 0) stopping.request_stop();
        if (!options_.quiet) line({before + p.done, total, all.echoes + p.echoes, all.seconds + p.seconds});
      };
      if (signals > 0) stopping.request_stop();
      sum_up(all, simulation.run(run, [&](const EchoBatch& batch) { files(batch); }));
      before += leg.end - leg.first;
      if (!all.complete) break;
      if (last[prefix] == k) files.close(), open.erase(at), done.insert(prefix);
    }
    if (!all.complete) {
      for (const auto& [prefix, files] : open) log_.cut.push_back(prefix);
      for (const std::string& prefix : cut)  // that were not come to again
        if (!open.contains(prefix) && !done.contains(prefix)) log_.cut.push_back(prefix);
      log_.write(folder);
      for (auto& [prefix, files] : open) files.close();
    }
    return all;
  }

  const Options& options_;
  SurveySettings survey_;
  Log log_;
  std::vector<std::string> folders_;
};

Simulation::Settings settings_of(const Options& o, std::uint64_t seed) {
  return {
      .seed = seed, .fixed_incidence = o.fixed_incidence, .platform_noise = o.platform_noise, .leg_noise = o.leg_noise, .assets = o.assets};
}

void tell(const Options& options, const SurveySettings& survey, std::uint64_t seed) {
  const Simulation simulation(survey, settings_of(options, seed));
  for (const std::string& warning : simulation.warnings()) std::cerr << "note: " << warning << '\n';
  const SurveyPlan& plan = simulation.plan();
  const Simulation::Scene scene = simulation.scene();
  std::cout << std::fixed << std::setprecision(3) << "survey   " << survey.name << "\nscanner  " << survey.scanner.id << ", "
            << survey.scanner.channels.size() << (survey.scanner.channels.size() == 1 ? " channel" : " channels") << "\nplatform "
            << survey.platform.id << "\nscene    " << scene.parts << " parts, " << scene.moving << " of them move; " << scene.triangles
            << " triangles; " << static_cast<double>(scene.memory) / (1 << 20) << " MiB\n";
  if (!scene.empty) {
    const Vec3 a = scene.least, b = scene.most;
    std::cout << "extent   x " << a.x << " to " << b.x << " m, y " << a.y << " to " << b.y << " m, z " << a.z << " to " << b.z << " m\n";
  }
  if (simulation.runs() > 1) std::cout << "runs     " << simulation.runs() << '\n';
  std::cout << "\n  files       starts [s]   lasts [s]   rate [kHz]        pulses\n";
  for (const auto& leg : plan.legs) {
    const std::string name = leg.active ? prefix_of(leg) : "(inactive)";
    std::cout << "  " << std::left << std::setw(10) << name << std::right << std::setw(12) << leg.start.seconds() << std::setw(12)
              << leg.duration.seconds() << std::setw(13) << leg.pulse_rate / 1e3 << std::setw(14) << leg.end - leg.first << '\n';
  }
  std::cout << "  in all    " << std::setw(12) << "" << std::setw(12) << plan.source.duration().seconds() << std::setw(13) << ""
            << std::setw(14) << plan.source.size() << '\n';
}

void preview(const Options& options, const SurveySettings& survey, std::uint64_t seed) {
  const Simulation simulation(survey, settings_of(options, seed));
  std::error_code error;
  fs::create_directories(options.output, error);
  if (error) throw FileError(options.output.string(), "", "the output folder cannot be made (" + error.message() + ")");
  const fs::path path = options.output / (survey.name + "_preview.png");
  constexpr PulseIndex enough = 400'000;
  const PulseIndex slots = simulation.plan().source.size();
  PulseIndex stride = std::max<PulseIndex>(1, slots / enough);
  if (stride > 1) stride |= 1;  // so that it is not in step with the channels
  Picture picture(path);
  const RunSummary summary =
      simulation.run({.threads = options.threads, .stride = stride}, [&](const EchoBatch& batch) { picture(batch); });
  picture.close();
  if (!options.quiet)
    std::cout << "1 pulse in " << stride << " of " << slots << ", " << summary.echoes << " points: " << path.string() << '\n';
}

int work(const Options& options) {
  for (const std::string& text : options.notes)
    if (!options.quiet) std::cerr << "note: " << text << '\n';
  if (options.command == "catalogue") return print_catalogue(options), success;
  SurveyFile file = read_survey_file(options);
  for (const std::string& warning : file.warnings)
    if (!options.quiet) std::cerr << "note: " << warning << '\n';
  std::optional<std::uint64_t> seed = options.seed ? options.seed : file.survey.seed;
  if (!seed) seed = std::random_device{}();
  if (options.command == "check") {
    check_without_scene(file.survey);
    if (!options.quiet) std::cout << options.survey.string() << ": nothing is wrong\n";
  } else if (options.command == "info") {
    tell(options, file.survey, *seed);
  } else if (options.command == "preview") {
    preview(options, file.survey, *seed);
  } else {
    check_without_scene(file.survey);  // before anything expensive
    return Session(options, std::move(file.survey), *seed).run();
  }
  return success;
}

}  // namespace

int main(int argc, char** argv) {
  int status = success;
  const std::optional<Options> options = read_command_line(argc, argv, status);
  if (!options) return status;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  try {
    return work(*options);
  } catch (const std::exception& error) {
    std::cerr << (options->quiet ? "" : "\n") << "error: " << error.what() << '\n';
    return bad_input;
  }
}
