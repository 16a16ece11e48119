// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "run_folder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <random>
#include <sstream>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/output_file.hpp>

#include "written_name.hpp"

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

constexpr std::string_view stamp_form = "0000-00-00_00-00-00";  // 0 for a digit

/// True if a text is the name of a run folder.
bool is_run_name(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() < stamp_form.size()) return false;
  for (std::size_t i = 0; i < stamp_form.size(); ++i)
    if (stamp_form[i] == '0' ? !is_digit(text[i]) : text[i] != stamp_form[i]) return false;
  text.remove_prefix(stamp_form.size());
  return text.empty() || (text.size() > 1 && text.size() < 5 && text.front() == '_' &&
                          std::all_of(text.begin() + 1, text.end(), is_digit));
}

std::string reason_of(int error) { return std::generic_category().message(error); }

/// Size of a result: of a file, or of all files in a folder [byte].
std::uintmax_t result_size(const fs::path& path) {
  if (!fs::is_directory(path)) return fs::file_size(path);
  std::uintmax_t sum = 0;
  for (const auto& file : fs::recursive_directory_iterator(path))
    if (file.is_regular_file()) sum += file.file_size();
  return sum;
}

/// True if run `a` is later. Runs of the same second are numbered: the longer name is the later.
bool is_later(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& path) {
    const std::string name = path.filename().string();
    return std::tuple(name.substr(0, stamp_form.size()), name.size(), name);
  };
  return key(a) > key(b);
}

}  // namespace

std::string RunLog::text() const {
  std::ostringstream text;
  text << "seed " << seed << "\nstart_time " << std::setprecision(17) << start_time << "\nrun " << run << "\nhow "
       << how << '\n';
  for (const auto& [path, fingerprint] : inputs) text << "input " << fingerprint << ' ' << path << '\n';
  if (!before.empty()) text << "before " << before << '\n';
  text << "end\n";
  for (const auto& [file, size] : files) text << "file " << size << ' ' << file << '\n';
  return text.str();
}

namespace {

/// Line of a log: a key and its value.
class LogLine {
 public:
  LogLine(std::string_view line, std::size_t number, const std::string& path)
      : line_(line), number_(number), path_(path) {
    const std::size_t blank = std::min(line.find(' '), line.size());
    key = line.substr(0, blank);
    value = line.substr(std::min(blank + 1, line.size()));
  }

  void expect(bool holds) const {
    if (holds) return;
    const std::string shown = written_name(std::string(line_.substr(0, 80))) + (line_.size() > 80 ? "..." : "");
    throw FileError(path_, "line " + std::to_string(number_),
                    "'" + shown + "': expected a line of a run's log: the run cannot be resumed");
  }

  [[nodiscard]] bool is_end() const { return line_ == "end"; }

  template <class Number>
  void read(std::string_view digits, Number& to) const {
    const std::optional<Number> number = text::number_in<Number>(digits);
    expect(number.has_value());
    to = *number;
  }

  /// Splits a value into a number or fingerprint, and a name.
  [[nodiscard]] std::pair<std::string_view, std::string> split() const {
    const std::size_t at = std::min(value.find(' '), value.size());
    const std::string_view name = value.substr(std::min(at + 1, value.size()));
    expect(at > 0 && !name.empty() &&
           std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }));
    return {value.substr(0, at), std::string(name)};
  }

  std::string_view key, value;

 private:
  std::string_view line_;
  std::size_t number_;
  const std::string& path_;
};

constexpr std::array<std::string_view, 6> log_keys{"seed", "start_time", "run",
                                                   "how",  "input",      "before"};  // in the order of the file

/// Reads the value of a key by its index.
void read_value(const LogLine& line, std::size_t key, RunLog& log) {
  switch (key) {
    case 0:
      line.read(line.value, log.seed);
      break;
    case 1:
      line.read(line.value, log.start_time);
      line.expect(std::isfinite(log.start_time));
      break;
    case 2:
      line.read(line.value, log.run);
      line.expect(log.run >= 0);
      break;
    case 3:
      log.how = line.value;
      break;
    case 4: {
      const auto [fingerprint, file] = line.split();
      line.expect(fingerprint.size() == 32 && fingerprint.find_first_not_of("0123456789abcdef") == fingerprint.npos);
      line.expect(log.inputs.emplace(file, fingerprint).second);
      break;
    }
    default:
      line.expect(is_run_name(line.value));
      log.before = line.value;
  }
}

}  // namespace

RunLog RunLog::parse(std::string_view text, const std::string& path) {
  RunLog log;
  std::size_t number = 0, next = 0;  // line number; index of the next key allowed
  bool complete = false;
  for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
    const LogLine line(text.substr(0, end), ++number, path);
    text.remove_prefix(end + 1);
    if (complete) {
      const auto [size, file] = line.split();
      line.expect(line.key == "file" && file.find('/') == file.npos);
      line.read(size, log.files[file]);
    } else if (line.is_end()) {
      line.expect(next >= 4);
      complete = true;
    } else {
      const auto key =
          static_cast<std::size_t>(std::find(log_keys.begin(), log_keys.end(), line.key) - log_keys.begin());
      line.expect(key < log_keys.size() && (key == next || (next >= 4 && key >= next)));
      next = key == 4 ? 4 : key + 1;
      read_value(line, key, log);
    }
  }
  if (!complete) throw FileError(path, "", "is truncated: the run cannot be resumed");
  return log;
}

void RunLog::write(const fs::path& folder) const {
  io::OutputFile file(folder / name);
  file.write(text());
  file.commit();
}

std::string RunLog::text_in(const fs::path& folder) {
  constexpr std::uint64_t longest = std::uint64_t{1} << 28;  // a million legs [byte]
  io::InputFile file(folder / name, "the log of a run");
  if (file.size() > longest)
    file.fail("is longer than " + std::to_string(longest) + " bytes: expected the log of a run");
  return file.take_rest();
}

void RunLog::add_files(const fs::path& folder, const std::vector<fs::path>& whole) {
  std::string lines;
  for (const fs::path& path : whole) {
    const std::string file = path.filename().string();
    files[file] = result_size(path);
    lines += "file " + std::to_string(files[file]) + ' ' + file + '\n';
  }
  const fs::path path = folder / name;
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK);
  const bool is_written = file >= 0 && ::write(file, lines.data(), lines.size()) == static_cast<ssize_t>(lines.size());
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!is_written) throw FileError(path.string(), "", "cannot be extended: " + reason_of(error));
}

std::vector<fs::path> RunLog::damaged(const std::vector<fs::path>& results) const {
  std::vector<fs::path> all;
  for (const fs::path& path : results) {
    const auto noted = files.find(path.filename().string());
    if (noted == files.end()) continue;
    std::error_code error;
    const bool is_whole =
        (fs::is_regular_file(path, error) || fs::is_directory(path, error)) && result_size(path) == noted->second;
    if (!is_whole || error) all.push_back(path);
  }
  return all;
}

bool RunLog::names(const std::vector<fs::path>& results) const {
  return std::all_of(results.begin(), results.end(),
                     [&](const fs::path& path) { return files.contains(path.filename().string()); });
}

void RunLog::remove(const fs::path& folder) {
  if (const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); directory >= 0) {
    ::fsync(directory);
    ::close(directory);
  }
  std::error_code ignored;
  fs::remove(folder / name, ignored);
}

namespace {

/// Process in a lock file.
struct Holder {
  pid_t process = 0;
  std::string machine{};

  static Holder self() {
    std::array<char, 256> machine{};
    if (::gethostname(machine.data(), machine.size() - 1) != 0) machine.front() = 0;
    return {::getpid(), machine.data()};
  }

  [[nodiscard]] std::string text() const { return std::to_string(process) + ' ' + machine + '\n'; }

  /// Reads the holder; none if the file is empty or its process has ended.
  static std::optional<Holder> read(int file) {
    std::array<char, 300> bytes{};
    const ssize_t count = ::pread(file, bytes.data(), bytes.size() - 1, 0);
    std::istringstream in(std::string(bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0));
    Holder found;
    if (!(in >> found.process >> found.machine) || found.process <= 0) return std::nullopt;
    const bool is_gone = found.machine == self().machine && ::kill(found.process, 0) != 0 && errno == ESRCH;
    return is_gone ? std::nullopt : std::optional(found);
  }
};

[[noreturn]] void refuse(const fs::path& folder, int file) {
  std::optional<Holder> holder = Holder::read(file);
  for (int tries = 0; !holder && tries < 50; ++tries) {  // the new holder is about to write its name
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    holder = Holder::read(file);
  }
  ::close(file);
  std::string by = "another process";
  if (holder) by = "process " + std::to_string(holder->process) + " of " + written_name(holder->machine);
  throw FileError(folder.string(), "", "is being written by " + by);
}

}  // namespace

RunLock::RunLock(const fs::path& folder) : path_(folder / name) {
  const auto fail = [&](int error) {
    if (file_ >= 0) ::close(file_);
    throw FileError(folder.string(), "", "cannot be locked: " + reason_of(error) + "; expected a writable folder");
  };
  for (;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    struct stat status {};
    if (file_ < 0 || ::fstat(file_, &status) != 0) fail(errno);
    if (!S_ISREG(status.st_mode)) fail(EEXIST);
    if (!io::lock_alone(file_)) refuse(folder, file_);
    if (io::stands_at(file_, path_)) break;
    ::close(file_);  // the previous holder removed it meanwhile
  }
  const std::string text = Holder::self().text();
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    const int error = errno;
    ::unlink(path_.c_str());
    fail(error);
  }
}

RunLock::~RunLock() {
  if (file_ < 0) return;
  if (io::stands_at(file_, path_) && ::unlink(path_.c_str()) != 0)
    std::cerr << "note: " << path_.string() << " cannot be removed: " << reason_of(errno) << "; it does no harm\n";
  ::close(file_);
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

RunFolders lock_unfinished(const fs::path& parent, std::optional<RunLock>& lock) {
  for (;;) {
    RunFolders found = runs_in(parent);
    if (!found.unfinished) return found;
    lock.emplace(*found.unfinished);
    const RunFolders now = runs_in(parent);
    if (now.unfinished == found.unfinished) return now;
    lock.reset();  // completed or succeeded meanwhile
  }
}

std::pair<fs::path, RunLock> new_run_folder(const fs::path& parent, const RunLog& log) {
  const std::string stamp = local_time();
  std::error_code error;
  fs::create_directories(parent, error);
  if (error) throw FileError(parent.string(), "", "the output folder cannot be created (" + error.message() + ")");
  fs::path making;
  do making = parent / ('.' + stamp + '_' + std::to_string(std::random_device{}()));
  while (!fs::create_directory(making, error) && !error);
  if (error) throw FileError(making.string(), "", "the output folder cannot be created (" + error.message() + ")");
  try {
    RunLock lock(making);
    log.write(making);
    for (int n = 1; n < 1000; ++n) {
      fs::path folder = parent / (n == 1 ? stamp : stamp + '_' + std::to_string(n));
      if (fs::exists(folder, error)) continue;
      fs::rename(making, folder, error);
      if (error) continue;  // another run took the name
      lock.renamed(folder);
      return {std::move(folder), std::move(lock)};
    }
    throw FileError((parent / stamp).string(), "", "the output folder cannot be created");
  } catch (...) {
    fs::remove_all(making, error);
    throw;
  }
}
