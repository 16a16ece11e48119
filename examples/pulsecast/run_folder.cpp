// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "run_folder.hpp"

#include <unistd.h>

#include <charconv>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>
#include <system_error>
#include <tuple>

#include <pulsecast/adapters/output_file.hpp>
#include <pulsecast/base/error.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm t{};
  localtime_r(&now, &t);
  std::ostringstream out;
  out << std::put_time(&t, "%Y-%m-%d_%H-%M-%S");
  return out.str();
}

/// Runs of one second are numbered, so that the longer name is the later.
bool is_later(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& path) {
    const std::string name = path.filename().string();
    return std::tuple(name.substr(0, std::string_view("2026-01-01_00-00-00").size()), name.size(), name);
  };
  return key(a) > key(b);
}

}  // namespace

void RunLog::write(const fs::path& folder) const {
  adapters::OutputFile file(folder / name);
  std::ostringstream text;
  text << "seed " << seed << "\nstart_time " << std::setprecision(17) << start_time << "\nrun " << run << "\nhow " << how << '\n';
  if (!before.empty()) text << "before " << before << '\n';
  for (const std::string& prefix : cut) text << "cut " << prefix << '\n';
  text << "end\n";
  file.write(text.str());
  file.commit();
}

RunLog RunLog::read(const fs::path& folder) {
  const fs::path path = folder / name;
  std::ifstream in(path, std::ios::binary);
  RunLog log;
  std::size_t number = 0;
  bool complete = false;
  for (std::string line; std::getline(in, line) && !in.eof();) {
    const auto refuse = [&] {
      throw FileError(path.string(), "line " + std::to_string(number),
                      "'" + line + "': it is not what a run left; this one cannot be resumed");
    };
    const auto read = [&](std::string_view text, auto& value) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc{} || end != text.data() + text.size()) refuse();
    };
    ++number;
    const std::size_t blank = line.find(' ');
    const std::string key = line.substr(0, blank), value = blank == std::string::npos ? "" : line.substr(blank + 1);
    if (complete) refuse();
    if (key == "seed" && number == 1) {
      read(value, log.seed);
    } else if (key == "start_time" && number == 2) {
      read(value, log.start_time);
    } else if (key == "run" && number == 3) {
      read(value, log.run);
    } else if (key == "how" && number == 4) {
      log.how = value;
    } else if (key == "before" && number == 5) {
      log.before = value;
    } else if (key == "cut" && number > 4) {
      log.cut.push_back(value);
    } else if (line == "end" && number > 4) {
      complete = true;
    } else {
      refuse();
    }
  }
  if (!complete) throw FileError(path.string(), "", "is cut short: the run cannot be resumed");
  return log;
}

void RunLog::remove(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / name, ignored);
}

RunFolders runs_in(const fs::path& parent) {
  RunFolders found;
  std::error_code error;
  for (fs::directory_iterator i(parent, error), end; !error && i != end; i.increment(error)) {
    const std::string name = i->path().filename().string();
    if (name.starts_with('.') || !i->is_directory(error)) continue;
    if (!found.newest || is_later(i->path(), *found.newest)) found.newest = i->path();
    if (fs::exists(i->path() / RunLog::name, error) && (!found.unfinished || is_later(i->path(), *found.unfinished)))
      found.unfinished = i->path();
  }
  return found;
}

fs::path new_run_folder(const fs::path& parent, const RunLog& log) {
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
