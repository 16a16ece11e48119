// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/base/vector.hpp>

namespace CLI {
class App;
}

/// Command line that all examples share. An example adds its own options, then runs inside `run`. Each option keeps its
/// variable's value as the default. `type` is the unit or the kind of a value, as the help shows it.
class CommandLine {
 public:
  std::filesystem::path output = "pulsecast-output";  ///< folder of the results
  unsigned threads;                                   ///< number of threads, by default those of the machine
  std::uint64_t seed = 1;                             ///< of all random numbers

  explicit CommandLine(const std::string& purpose);
  ~CommandLine();

  /// Number from an interval, ends included.
  void add_number(const std::string& name, double& value, double least, double most, const std::string& type,
                  const std::string& meaning);
  void add_number(const std::string& name, std::size_t& value, int least, int most, const std::string& meaning);

  void add_flag(const std::string& name, bool& value, const std::string& meaning);

  /// Position, as in `--position 1.5,-2,0`; repeatable.
  void add_positions(const std::string& name, std::vector<pulsecast::Vec3>& positions, const std::string& meaning);

  /// File or files without a name of an option.
  void add_file(const std::string& name, std::filesystem::path& file, const std::string& type,
                const std::string& meaning);
  void add_files(const std::string& name, std::vector<std::string>& files, const std::string& type,
                 const std::string& meaning);

  /// Search folder; repeatable.
  void add_folders(const std::string& name, std::vector<std::filesystem::path>& folders, const std::string& meaning);

  /// Reads the command line, makes the output folder and does the work. Returns the exit status: 0 for success, 1 for
  /// an error of a setting or a file, 2 for one of the command line.
  int run(int argc, char** argv, const std::function<void()>& work);

 private:
  std::unique_ptr<CLI::App> app_;
};
