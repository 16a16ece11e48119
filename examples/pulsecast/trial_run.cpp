// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "trial_run.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <stop_token>
#include <string>
#include <system_error>
#include <utility>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>

#include "outputs.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using helios::CompiledSurvey;
using helios::Simulation;

namespace {

constexpr double start_time = 302'400;  // half a GPS week, whose seconds have as many digits as most

/// Temporary folder; the destructor removes it.
struct TemporaryFolder {
  fs::path path =
      parent() / ("pulsecast_forecast_" + std::to_string(getpid()) + '_' + std::to_string(std::random_device{}()));
  TemporaryFolder() { fs::create_directories(path); }
  /// Folder of TMPDIR. Throws a `FileError` with its path if it is none.
  static fs::path parent() {
    std::error_code problem;
    fs::path folder = fs::temp_directory_path(problem);
    const char* const given = std::getenv("TMPDIR");
    if (problem)
      throw FileError(given ? given : "/tmp", "", "is no folder: expected one for temporary files, by TMPDIR");
    return folder;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

/// Size of all files in a folder [byte].
double size_of(const fs::path& folder) {
  double sum = 0;
  for (const auto& file : fs::recursive_directory_iterator(folder))
    if (file.is_regular_file()) sum += static_cast<double>(file.file_size());
  return sum;
}

/// Legs that share files, by the prefix of their names.
std::map<std::string, std::vector<std::size_t>> legs_by_files(const CompiledSurvey& compiled) {
  std::map<std::string, std::vector<std::size_t>> all;
  for (std::size_t k = 0; k < compiled.legs.size(); ++k)
    if (compiled.legs[k].active) all[prefix_of(compiled.legs[k])].push_back(k);
  return all;
}

/// Number of pulses that count.
double lines(const RunSummary& run, PulseLines counted) {
  if (counted == PulseLines::none) return 0;
  return static_cast<double>(run.pulses() - (counted == PulseLines::all ? 0 : run.count(Fate::returned)));
}

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Part of a survey that was written.
struct Written {
  double points = 0, lines = 0;   ///< number of points, and of pulses as `pulse_lines` counts them
  double bytes = 0, seconds = 0;  ///< cost
  [[nodiscard]] double results() const { return points + lines; }
};

/// Writes parts of a survey, each to files of its own.
class TrialWriter {
 public:
  TrialWriter(const Simulation& simulation, const Options& options, const std::vector<std::string>& channels,
              PulseLines counted)
      : simulation_(simulation), options_(options), channels_(channels), counted_(counted) {}

  /// Writes what `add` adds.
  template <class Add>
  [[nodiscard]] Written write(const Add& add) const {
    const TemporaryFolder folder;
    Written all;
    const double before = processor_time();
    LegFiles files(folder.path, whole_run, options_, start_time, channels_);
    all.seconds = processor_time() - before;
    add(files, all);
    const double then = processor_time();
    files.close();
    all.seconds += processor_time() - then;
    all.bytes = size_of(folder.path);
    return all;
  }

  /// Adds slots to files, until there are enough results.
  void add(LegFiles& files, Written& all, PulseIndex from, PulseIndex end, double enough) const {
    constexpr PulseIndex length = 1024, at_once = 32;
    while (from < end && all.results() < enough) {
      std::vector<SampleBlock> blocks;
      for (; from < end && blocks.size() < at_once; from = blocks.back().end)
        blocks.push_back({from, from, std::min(end, from + length), counted_ != PulseLines::none});
      for (const Sample& sample : sample(simulation_.survey(), blocks, options_.threads)) {
        const double before = processor_time();
        files(sample.batch());
        all.seconds += processor_time() - before;
        all.points += static_cast<double>(sample.echoes.size());
        all.lines += lines(sample.counts, counted_);
      }
    }
  }

 private:
  const Simulation& simulation_;
  const Options& options_;
  const std::vector<std::string>& channels_;
  PulseLines counted_;
};

/// Regression of costs on the numbers of points and of pulses that count: weighted least squares, which reproduces the
/// sum of the costs. Source: Sarndal, Swensson & Wretman 1992, Model Assisted Survey Sampling, chapter 6, the
/// regression estimator.
WritingCost regression(std::span<const Written> all, double Written::*cost, double fixed) {
  double pp = 0, pl = 0, ll = 0, pc = 0, lc = 0;
  for (const Written& w : all) {
    if (w.results() == 0) continue;
    const double own = (w.*cost) - fixed, weight = 1 / w.results();
    pp += weight * w.points * w.points;
    pl += weight * w.points * w.lines;
    ll += weight * w.lines * w.lines;
    pc += weight * w.points * own;
    lc += weight * w.lines * own;
  }
  const double ridge = 1e-9 * (pp + ll);
  if (!(ridge > 0)) return {};
  pp += ridge;
  ll += ridge;
  const double determinant = pp * ll - pl * pl;
  WritingCost found{.point = (pc * ll - lc * pl) / determinant, .line = (lc * pp - pc * pl) / determinant};
  double squares = 0, sum = 0;
  for (const Written& w : all) {
    squares += std::pow((w.*cost) - fixed - found.growing(w.points, w.lines), 2);
    sum += (w.*cost) - fixed;
  }
  const double n = static_cast<double>(all.size());
  found.unsure = n < 3 || !(sum > 0) ? 0 : pulsecast::detail::student_t(n - 2) * std::sqrt(squares * n / (n - 2)) / sum;
  return found;
}

// ------------------------------------------------------------------------------------------ memory

/// Resident memory of this process. Source: proc(5), /proc/PID/status.
Resident resident_now() {
  std::ifstream in("/proc/self/status");
  Resident r;
  for (std::string word; in >> word;)
    for (const auto& [name, value] : {std::pair{"RssAnon:", &r.own}, {"RssFile:", &r.file}, {"VmHWM:", &r.peak}})
      if (word == name && in >> *value) *value *= 1024;
  return r;
}

/// Points that fill the buffers of the writers: see `LazRecords` and `CopcTree`. 0: none that matter.
std::uint64_t filling_points(const Options& options) {
  const std::uint64_t threads = thread_count(options.threads);
  if (options.format == "laz") return 50'000 * std::min<std::uint64_t>(threads, 16);
  if (options.format == "npz") return std::uint64_t{1} << 62;  // columns grow with the file
  return options.format == "copc.laz" ? (std::uint64_t{1} << 19) * (std::min<std::uint64_t>(threads, 12) + 3) : 0;
}

/// Files of a leg or strip, and sink that writes them as a run does. It stops when more results would take no more
/// memory.
struct TrialFiles {
  LegFiles files;
  const ProcessorBudget& allowance;
  std::uint64_t enough;  ///< points
  std::stop_source stop{};
  std::uint64_t points = 0;
  std::size_t bytes = 0, waveforms = 0;

  void operator()(const EchoBatch& batch) {
    files(batch);
    points += batch.echoes.size();
    waveforms += batch.samples.size_bytes();
    bytes += batch.shots.size_bytes() + batch.echoes.size_bytes() + batch.samples.size_bytes();
    constexpr std::size_t ahead = std::size_t{24} << 20;  // four times what `ReorderBuffer` holds
    constexpr std::size_t long_text = 100'000'000;
    if ((points >= enough && bytes >= ahead) || waveforms >= long_text || !allowance.left()) stop.request_stop();
  }
  [[nodiscard]] bool reads_empty_shots() const noexcept {
    return files.reads_empty_shots();
  }  ///< as the concept ChoosesShots describes
};

/// Simulates and writes as much of each leg as matters.
void play(const Simulation& simulation, const Options& options, const std::vector<std::string>& channels,
          PulseLines counted, const fs::path& folder, TrialRun& trial) {
  const CompiledSurvey& compiled = simulation.compiled();
  const ProcessorBudget allowance(3, std::min(thread_count(options.threads), thread_count(0)));
  // Compressors take more memory when they fill their buffers again, by what the heap leaves between.
  const std::uint64_t enough = options.format == "laz" ? 3 * trial.filling : trial.filling;
  const auto legs_of = legs_by_files(compiled);
  std::map<std::string, std::unique_ptr<TrialFiles>> open;
  trial.complete = true;
  for (std::size_t k = 0; k < compiled.legs.size() && allowance.left(); ++k) {
    const CompiledSurvey::Leg& leg = compiled.legs[k];
    if (!leg.active) continue;
    const std::string prefix = prefix_of(leg);
    auto& files = open[prefix];
    if (!files) files.reset(new TrialFiles{LegFiles(folder, prefix, options, start_time, channels), allowance, enough});
    files->files.add_trajectory(compiled.source.legs()[k], leg.start, leg.trajectory_interval);
    const RunSummary summary = pulsecast::run(
        simulation.survey(),
        {.threads = options.threads, .first = leg.first, .end = leg.end, .stop = files->stop.get_token()}, *files);
    trial.points += static_cast<double>(summary.echoes);
    trial.lines += lines(summary, counted);
    trial.complete = trial.complete && summary.complete;
    trial.most_points = std::max(trial.most_points, static_cast<double>(files->points));
    if (legs_of.at(prefix).back() != k) continue;
    files->files.close();
    open.erase(prefix);
  }
  for (auto& [prefix, files] : open) files->files.close();
  trial.complete = trial.complete && allowance.left();
  trial.bytes = size_of(folder);
  trial.after = resident_now();
}

}  // namespace

void WritingCost::scale_to(double all, double points, double lines) {
  const double now = growing(points, lines);
  if (!(now > 0)) fixed = all;
  const double factor = now > 0 ? (all - fixed) / now : 1;
  point *= factor;
  line *= factor;
  unsure = 0.005;  // digits of times in text
}

PulseLines pulse_lines(const Options& options, const std::vector<std::string>& channels) {
  const TemporaryFolder folder;
  if (!LegFiles(folder.path, whole_run, options, start_time, channels).reads_empty_shots()) return PulseLines::none;
  return options.write_pulse ? PulseLines::all : PulseLines::empty;
}

WritingCosts writing_costs(const Simulation& simulation, const Options& options,
                           const std::vector<std::string>& channels, PulseLines counted,
                           std::span<const PulseIndex> starts) {
  const CompiledSurvey& compiled = simulation.compiled();
  const TrialWriter writer(simulation, options, channels, counted);
  const auto nothing = [](LegFiles&, Written&) {};
  (void)writer.write(nothing);  // one-time costs
  const Written without = writer.write(nothing);

  std::vector<Written> all;
  const auto legs_of = legs_by_files(compiled);
  constexpr double stretch = 25'000;  // results: enough for a compressor to adapt
  constexpr std::size_t min_stretches = 8;
  constexpr PulseIndex longest = 1 << 18;
  const ProcessorBudget allowance(1, std::min(thread_count(options.threads), thread_count(0)));
  for (const PulseIndex from : starts) {
    if (all.size() >= min_stretches && !allowance.left()) break;
    const auto leg = std::find_if(compiled.legs.begin(), compiled.legs.end(),
                                  [&](const auto& l) { return l.active && from < l.end; });
    all.push_back(writer.write([&](LegFiles& files, Written& subset) {
      writer.add(files, subset, from, std::min(leg->end, from + longest), stretch);
    }));
  }
  WritingCosts costs{regression(all, &Written::bytes, without.bytes),
                     regression(all, &Written::seconds, without.seconds)};
  // Stretches differ from the whole by the state of their compressors, and by their octree. Source: 37 surveys,
  // bench/forecast.sh.
  const double model = !options.format.ends_with("laz") ? 0.005 : options.format == "laz" ? 0.015 : 0.08;
  costs.bytes.unsure = std::hypot(costs.bytes.unsure, model);

  double records = 0;
  for (const auto& leg : compiled.legs)
    if (leg.active && leg.trajectory_interval > 0)
      records += std::ceil(leg.duration.seconds() / leg.trajectory_interval) + 1;
  const double step = std::max(1.0, records / 20'000);
  const Written paths = writer.write([&](LegFiles& files, Written& subset) {
    const double before = processor_time();
    for (const auto& [prefix, legs] : legs_of)
      for (const std::size_t k : legs)
        files.add_trajectory(compiled.source.legs()[k], compiled.legs[k].start,
                             step * compiled.legs[k].trajectory_interval);
    subset.seconds += processor_time() - before;
  });
  const double sets = static_cast<double>(legs_of.size());
  costs.bytes.fixed = sets * without.bytes + step * (paths.bytes - without.bytes);
  costs.seconds.fixed = sets * without.seconds + step * std::max(0.0, paths.seconds - without.seconds);
  return costs;
}

TrialRun trial_run(const Simulation& simulation, const Options& options, const std::vector<std::string>& channels,
                   PulseLines counted) {
  const TemporaryFolder folder;
  std::array<int, 2> pipe_ends{};
  TrialRun trial{.filling = filling_points(options), .before = resident_now()};
  if (pipe(pipe_ends.data()) != 0) return trial;
  const pid_t child = fork();
  if (child == 0) {
    try {
      play(simulation, options, channels, counted, folder.path, trial);
      if (write(pipe_ends[1], &trial, sizeof trial) == sizeof trial) _exit(0);
    } catch (const std::exception&) {  // a fault of the survey or the disk: the process that waits will find it
    }
    _exit(1);
  }
  close(pipe_ends[1]);
  TrialRun done;
  if (child > 0 && read(pipe_ends[0], &done, sizeof done) == sizeof done) trial = done;
  close(pipe_ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  return trial;
}

Estimate TrialRun::memory(double of_run, const Options& options) const {
  if (!(after.peak > 0)) return {before.peak, before.peak, std::numeric_limits<double>::infinity()};
  const double growth = after.peak - after.file - before.own, base = before.own + before.file;
  // With buffers that are not full yet, memory grows at most as the points do.
  const double more =
      !complete && most_points > 0 ? std::max(1.0, std::min(of_run, static_cast<double>(filling)) / most_points) : 1;
  // Runs differ in the pages of libraries in use, the order of work of their threads and what the heap of each thread
  // keeps, which grows with longer runs. Source of the figures: 37 surveys of 200 to 6 million points by
  // bench/forecast.sh, in LAS, LAZ, COPC and text, on 1 to 8 threads.
  const bool alone = thread_count(options.threads) == 1;
  const double later = alone || options.format == "copc.laz" ? 1 : complete ? 1.05 : 1.2;
  const auto memory = [&](double all, double grown, double pages) {
    return std::max(all * before.peak, all * base + grown * later * growth + pages * after.file);
  };
  const double middle = std::sqrt(more);
  return {memory(1, middle, 0.1), memory(0.98, alone ? 0.93 : 0.65 * std::min(middle, 1.4), 0),
          memory(1.03, std::max(alone ? 1.1 : 1.35, 1.1 * more), 0.25)};
}
