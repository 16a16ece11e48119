// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <pulsecast/base/error.hpp>
#include <pulsecast/base/vector.hpp>

/// What every example takes on its command line. An example adds its own options to `app`, then runs inside `run`.
struct CommandLine {
  CLI::App app;
  std::filesystem::path output = "pulsecast-output";                     ///< folder of the files that are left
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());  ///< how many
  std::uint64_t seed = 1;                                                ///< of all that is random

  explicit CommandLine(const std::string& what) : app(what) {
    app.get_formatter()->column_width(34);
    app.option_defaults()->always_capture_default();
    app.add_option("-o,--output", output, "Folder for the results, created if missing")->type_name("DIR");
    app.add_option("-t,--threads", threads, "Number of threads")->type_name("N")->check(CLI::Range(1U, 1024U));
    app.add_option("-s,--seed", seed, "Seed of all random numbers; the same seed gives the same files")
        ->type_name("N")
        ->check(CLI::NonNegativeNumber);
  }

  /// An option that takes a place, as in `--position 1.5,-2,0`, and may be given again for further ones.
  void add_places(const std::string& name, std::vector<pulsecast::Vec3>& places, const std::string& what) {
    const auto add = [&places](const std::string& text) {
      std::istringstream in(text);
      pulsecast::Vec3 place{};
      char first = 0, second = 0;
      in >> place.x >> first >> place.y >> second >> place.z;
      if (!in || first != ',' || second != ',' || !(in >> std::ws).eof()) return false;
      places.push_back(place);
      return true;
    };
    const auto add_all = [add](const CLI::results_t& texts) { return std::ranges::all_of(texts, add); };
    app.add_option(name, add_all, what)->type_name("X,Y,Z")->expected(1, -1)->allow_extra_args(false);
  }

  /// Reads the command line, makes the output folder, and does the work. Returns what `main` should: 0 if all went well, 1 if a setting
  /// or a file was at fault, 2 if the command line was.
  int run(int argc, char** argv, auto&& work) {
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0) return app.exit(error);  // --help
      std::cerr << "error: " << error.what() << "\nTry --help.\n";
      return 2;
    }
    try {
      std::error_code problem;
      std::filesystem::create_directories(output, problem);
      if (problem) throw pulsecast::FileError(output.string(), "", "the output folder cannot be created (" + problem.message() + ")");
      work();
    } catch (const std::exception& error) {
      std::cerr << "\nerror: " << error.what() << '\n';
      return 1;
    }
    return 0;
  }
};
