// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

/// Common parts of the benchmarks: clocks, alternating rounds, and a report with the machine, the compiler and its
/// flags.
namespace bench {

namespace detail {
[[nodiscard]] inline double seconds_of(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
}  // namespace detail

/// Clocks [s]: the processor's time of this thread or of this program, which others on the machine do not add to, and
/// the time on the wall.
[[nodiscard]] inline double thread_seconds() noexcept { return detail::seconds_of(CLOCK_THREAD_CPUTIME_ID); }
[[nodiscard]] inline double process_seconds() noexcept { return detail::seconds_of(CLOCK_PROCESS_CPUTIME_ID); }
[[nodiscard]] inline double wall_seconds() noexcept { return detail::seconds_of(CLOCK_MONOTONIC); }

/// Has the compiler believe that a value is needed.
template <class T>
inline void keep(const T& value) noexcept {
  asm volatile("" : : "g"(&value) : "memory");
}

[[nodiscard]] inline double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Durations of a piece of work, round by round [s].
using Times = std::vector<double>;

/// Speed of a work relative to another: the median of the rounds, in each of which both ran on the machine in the same
/// state.
[[nodiscard]] inline double speed_ratio(const Times& of, const Times& other) {
  Times ratios;
  for (std::size_t i = 0; i < of.size() && i < other.size(); ++i) ratios.push_back(other[i] / of[i]);
  return median(std::move(ratios));
}

/// Figures of one thing that was measured: what they are, with their unit, and how much.
using Figures = std::vector<std::pair<std::string, double>>;

/// The command line, what is to be measured, and what was.
/// Options: `--only PATTERN` (of the shell's kind, over the names of the rows; may be given again), `--rounds N`,
/// `--seconds S`,
/// `--markdown`.
class Report {
 public:
  Report(std::string program, int count, char** words) : program_(std::move(program)) {
    const auto value = [&](int& i) -> std::string {
      if (i + 1 < count) return words[++i];
      std::fprintf(stderr, "%s: %s wants a value\n", program_.c_str(), words[i]);
      std::exit(2);
    };
    for (int i = 1; i < count; ++i) {
      const std::string_view word = words[i];
      if (word == "--markdown") {
        markdown_ = true;
      } else if (word == "--only") {
        only_.push_back(value(i));
      } else if (word == "--rounds") {
        rounds_ = std::max(1, std::atoi(value(i).c_str()));
      } else if (word == "--seconds") {
        seconds_ = std::atof(value(i).c_str());
      } else if (word.starts_with("-")) {
        std::fprintf(stderr, "usage: %s [--only PATTERN]... [--rounds N] [--seconds S] [--markdown] [FILE]...\n",
                     program_.c_str());
        std::exit(word == "--help" ? 0 : 2);
      } else {
        files_.emplace_back(word);
      }
    }
    const char* line = markdown_ ? "`%s`: %s; %s, `%s`; %d rounds of %g s\n"
                                 : "%s\nmachine:  %s\ncompiler: %s\nflags:    %s\nrounds:   %d of %g s\n";
    std::printf(line, program_.c_str(), machine().c_str(), compiler().c_str(), flags().c_str(), rounds_, seconds_);
  }

  [[nodiscard]] const std::vector<std::string>& files() const noexcept { return files_; }
  [[nodiscard]] int rounds() const noexcept { return rounds_; }

  [[nodiscard]] bool wanted(const std::string& name) const {
    const auto matches = [&](const std::string& pattern) { return fnmatch(pattern.c_str(), name.c_str(), 0) == 0; };
    return only_.empty() || std::any_of(only_.begin(), only_.end(), matches);
  }

  /// Times alternating pieces of work: in a round, each is repeated until its seconds have passed by the clock. What
  /// slows the machine down for a while slows them all. Gives the seconds that each took for one go, round by round.
  [[nodiscard]] std::vector<Times> by_turns(const std::vector<std::function<void()>>& works,
                                            double (*clock)() = thread_seconds) const {
    std::vector<Times> times(works.size());
    for (const auto& work : works) work();  // memory is touched, branches are learnt
    for (int round = 0; round < rounds_; ++round)
      for (std::size_t i = 0; i < works.size(); ++i) {
        const double start = clock();
        double passed = 0;
        int done = 0;
        do {
          works[i]();
          ++done;
          passed = clock() - start;
        } while (passed < seconds_);
        times[i].push_back(passed / done);
      }
    return times;
  }

  /// A line above rows that belong together.
  void heading(const std::string& text) {
    std::printf(markdown_ ? "\n%s:\n\n" : "\n%s\n", text.c_str());
    std::fflush(stdout);
    columns_.clear();
  }

  /// A line below a heading.
  void note(const std::string& text) const {
    std::printf(markdown_ ? "%s\n\n" : "  %s\n", text.c_str());
    std::fflush(stdout);
  }

  void row(const std::string& name, const Figures& figures) {
    if (markdown_) {
      std::string columns = "| |", rule = "|---|";
      for (const auto& [what, figure] : figures) {
        columns += " " + what + " |";
        rule += "---|";
      }
      if (columns != columns_) std::printf("%s%s\n%s\n", columns_.empty() ? "" : "\n", columns.c_str(), rule.c_str());
      columns_ = columns;
    }
    std::printf(markdown_ ? "| `%s` |" : "  %-44s", name.c_str());
    for (const auto& [what, figure] : figures)
      markdown_ ? std::printf(" %s |", rounded(figure).c_str()) : std::printf(" %10.4g %s", figure, what.c_str());
    std::printf("\n");
    std::fflush(stdout);
  }

  [[nodiscard]] static std::string machine() {
    std::string name = "unknown processor", model, line;
    std::ifstream in("/proc/cpuinfo");
    const auto take = [&](std::string_view key, std::string& to) {
      if (const std::size_t colon = line.find(": "); line.starts_with(key) && colon != line.npos)
        to = line.substr(colon + 2);
    };
    while (std::getline(in, line) && !line.empty()) {
      take("model name", name);
      take("model\t", model);
    }
    if (!model.empty()) name += ", model " + model;
    return name + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
  }

  [[nodiscard]] static std::string compiler() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "gcc " __VERSION__;
#endif
  }

  [[nodiscard]] static std::string flags() {
    std::string all;
#ifdef PULSECAST_BENCH_FLAGS
    all = PULSECAST_BENCH_FLAGS;
#endif
#if defined(__AVX512F__)
    return all + " (AVX-512)";
#elif defined(__AVX2__)
    return all + " (AVX2)";
#elif defined(__AVX__)
    return all + " (AVX)";
#else
    return all + " (baseline)";
#endif
  }

 private:
  /// To three digits, without an exponent.
  static std::string rounded(double figure) {
    char text[64];
    const double size = std::fabs(figure);
    const int decimals = size >= 100 || size == 0 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
    std::snprintf(text, sizeof text, "%.*f", decimals, figure);
    return text;
  }

  std::string program_;
  std::vector<std::string> only_, files_;
  int rounds_ = 7;
  double seconds_ = 0.15;
  bool markdown_ = false;
  std::string columns_;  ///< of the table that is being printed
};

}  // namespace bench
