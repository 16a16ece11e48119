// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "command_line.hpp"

#include <algorithm>
#include <exception>
#include <iostream>
#include <sstream>
#include <system_error>
#include <thread>

#include <CLI/CLI.hpp>
#include <pulsecast/base/error.hpp>

CommandLine::CommandLine(const std::string& purpose)
    : threads(std::max(1U, std::thread::hardware_concurrency())), app_(std::make_unique<CLI::App>(purpose)) {
  app_->get_formatter()->column_width(34);
  app_->option_defaults()->always_capture_default();
  app_->add_option("-o,--output", output, "Folder for the results, created if missing")->type_name("DIR");
  app_->add_option("-t,--threads", threads, "Number of threads")->type_name("N")->check(CLI::Range(1U, 1024U));
  app_->add_option("-s,--seed", seed, "Seed of all random numbers; the same seed gives the same files")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
}

CommandLine::~CommandLine() = default;

void CommandLine::add_number(const std::string& name, double& value, double least, double most, const std::string& type,
                             const std::string& meaning) {
  app_->add_option(name, value, meaning)->type_name(type)->check(CLI::Range(least, most));
}

void CommandLine::add_number(const std::string& name, std::size_t& value, int least, int most,
                             const std::string& meaning) {
  app_->add_option(name, value, meaning)->type_name("N")->check(CLI::Range(least, most));
}

void CommandLine::add_flag(const std::string& name, bool& value, const std::string& meaning) {
  app_->add_flag(name, value, meaning);
}

void CommandLine::add_positions(const std::string& name, std::vector<pulsecast::Vec3>& positions,
                                const std::string& meaning) {
  const auto add = [&positions](const std::string& text) {
    std::istringstream in(text);
    pulsecast::Vec3 position{};
    char first = 0, second = 0;
    in >> position.x >> first >> position.y >> second >> position.z;
    if (!in || first != ',' || second != ',' || !(in >> std::ws).eof()) return false;
    positions.push_back(position);
    return true;
  };
  const auto add_all = [add](const CLI::results_t& texts) { return std::ranges::all_of(texts, add); };
  app_->add_option(name, add_all, meaning)->type_name("X,Y,Z")->expected(1, -1)->allow_extra_args(false);
}

void CommandLine::add_file(const std::string& name, std::filesystem::path& file, const std::string& type,
                           const std::string& meaning) {
  app_->add_option(name, file, meaning)->type_name(type);
}

void CommandLine::add_files(const std::string& name, std::vector<std::string>& files, const std::string& type,
                            const std::string& meaning) {
  app_->add_option(name, files, meaning)->type_name(type);
}

void CommandLine::add_folders(const std::string& name, std::vector<std::filesystem::path>& folders,
                              const std::string& meaning) {
  app_->add_option(name, folders, meaning)
      ->type_name("DIR")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

int CommandLine::run(int argc, char** argv, const std::function<void()>& work) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error);  // --help
    std::cerr << "error: " << error.what() << "\nTry --help.\n";
    return 2;
  }
  try {
    std::error_code problem;
    std::filesystem::create_directories(output, problem);
    if (problem)
      throw pulsecast::FileError(output.string(), "",
                                 "the output folder cannot be created (" + problem.message() + ")");
    work();
  } catch (const std::exception& error) {
    std::cerr << "\nerror: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
