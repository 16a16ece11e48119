// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/output_file.hpp>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/allocations.hpp"
#include "support/generators.hpp"
#include "support/sanitized.hpp"
#include "support/size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace {

int flock_error = 0;                    // that flock gives instead of a lock; 0: it locks
std::function<int(int)> at_fsync = {};  // sees each file that is synced, and gives an error or 0

}  // namespace

// In place of those of the system, so that a file system may be one without locks, or a disk one that fails.
extern "C" int flock(int file, int operation) noexcept {
  errno = flock_error;
  return flock_error != 0 ? -1 : static_cast<int>(syscall(SYS_flock, file, operation));
}
extern "C" int fsync(int file) {
  errno = at_fsync ? at_fsync(file) : 0;
  return errno != 0 ? -1 : 0;
}

namespace pulsecast::io {
namespace {

using support::content;
using support::SizeLimit;
using support::TemporaryFolder;
namespace fs = std::filesystem;

/// What an action's `FileError` says; fails the test if there is none.
template <class Action>
std::string problem_of(const fs::path& path, Action action) {
  try {
    action();
  } catch (const FileError& error) {
    CHECK(error.path() == path.string());
    return error.what();
  }
  FAIL_CHECK("no FileError");
  return {};
}

bool says(const std::string& message, const std::string& part) { return message.find(part) != std::string::npos; }

TEST_CASE("a file stands under its final name once it is committed, and not before") {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("one ");
  file.write("two");
  CHECK(file.position() == 7);
  CHECK_FALSE(fs::exists(folder / "a.txt"));
  file.commit();
  CHECK(content(folder / "a.txt") == "one two");
  CHECK_FALSE(fs::exists(folder / "a.txt.part"));
}

TEST_CASE("a file that is not committed leaves nothing, and keeps what stood there before") {
  const TemporaryFolder folder;
  { OutputFile(folder / "a.txt").write("lost"); }
  CHECK(folder.empty());
  std::ofstream(folder / "a.txt") << "before";
  { OutputFile(folder / "a.txt").write("lost"); }
  CHECK(content(folder / "a.txt") == "before");
  CHECK_FALSE(fs::exists(folder / "a.txt.part"));
}

TEST_CASE("a committed file replaces what stood there before") {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt") << "before, and longer";
  std::ofstream(folder / "a.txt.part") << "left by a run that was killed";
  OutputFile file(folder / "a.txt");
  file.write("after");
  file.commit();
  CHECK(content(folder / "a.txt") == "after");
}

TEST_CASE("writes and overwrites of any size come out as they would in memory") {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const TemporaryFolder folder;
    OutputFile file(folder / "a.bin");
    std::string expected;
    for (int i = 0; i < 60; ++i) {
      const std::string bytes(static_cast<std::size_t>(random.log_uniform(1, 3e6)),
                              static_cast<char>('a' + random.whole(26)));
      if (random.uniform() < 0.2 && expected.size() >= bytes.size()) {
        const std::size_t position = random.whole(expected.size() - bytes.size() + 1);
        file.overwrite(position, std::as_bytes(std::span(bytes)));
        expected.replace(position, bytes.size(), bytes);
      } else {
        file.write(bytes);
        expected += bytes;
      }
      REQUIRE(file.position() == expected.size());
    }
    file.commit();
    CHECK((content(folder / "a.bin") == expected));
  }
}

TEST_CASE("what was written reads back, and writing goes on at the end") {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  std::string bytes(3, ' ');
  const auto read = [&](std::uint64_t position) {
    file.read(position, std::as_writable_bytes(std::span(bytes)));
    return bytes;
  };
  file.write("0123456789");
  CHECK(read(0) == "012");
  file.overwrite(2, std::as_bytes(std::span("AB", 2)));
  CHECK(read(1) == "1AB");
  file.write(std::string(2'000'000, 'x'));
  CHECK(read(7) == "789");
  file.write("end");
  CHECK(read(2'000'010) == "end");
  CHECK(read(1'999'999) == "xxx");  // across what is passed on and what is held
  CHECK(file.position() == 2'000'013);
  file.discard();
  CHECK_THROWS_AS(read(0), FileError);
  CHECK(folder.empty());
}

TEST_CASE("a file without a name reads back, whatever takes its name, and leaves nothing") {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "a.txt");
    file.write("0123456789");
    file.forget_name();
    CHECK(folder.empty());
    std::ofstream(OutputFile::temporary_name(folder / "a.txt")) << "not yours";
    std::string bytes(4, ' ');
    file.read(3, std::as_writable_bytes(std::span(bytes)));
    CHECK(bytes == "3456");
    CHECK_THROWS_AS(file.commit(), FileError);
  }
  CHECK(content(OutputFile::temporary_name(folder / "a.txt")) == "not yours");
}

#ifndef PULSECAST_TEST_SANITIZED
TEST_CASE("a file for which there is no memory leaves nothing, whichever allocation fails") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a name that is too long for a short string.txt";
  bool is_made = false;
  for (std::size_t n = 1; !is_made && n < 100; ++n) {
    CAPTURE(n);
    try {
      support::allocations_left = n;
      OutputFile file(path);
      is_made = true;
    } catch (const std::bad_alloc&) {
    }
    support::allocations_left = 0;
    CHECK(folder.empty());
  }
  CHECK(is_made);
}
#endif

TEST_CASE("an encoder gets every byte once and in order, is told the end, and what it makes is the file") {
  struct Doubler final : OutputEncoder {
    void encode(std::span<const std::byte> bytes, bool last, std::vector<std::byte>& out) override {
      for (const std::byte b : bytes) {
        out.push_back(b);
        out.push_back(b);
      }
      if (last) out.push_back(std::byte{'.'});
    }
  };
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt", std::make_unique<Doubler>());
  file.write("ab");
  file.write(std::string(3'000'000, 'x'));
  file.write("c");
  CHECK(file.position() == 3'000'003);
  file.commit();
  CHECK((content(folder / "a.txt") == "aabb" + std::string(6'000'000, 'x') + "cc."));
  OutputFile(folder / "empty", std::make_unique<Doubler>()).commit();
  CHECK(content(folder / "empty") == ".");
}

TEST_CASE("a file goes on where others have written to") {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("head ");
  file.continue_at(5);
  std::ofstream(OutputFile::temporary_name(folder / "a.txt"), std::ios::app) << "others ";
  file.continue_at(12);
  CHECK(file.position() == 12);
  file.write("tail");
  CHECK(file.position() == 16);
  file.overwrite(0, std::as_bytes(std::span("HEAD", 4)));
  file.commit();
  CHECK(content(folder / "a.txt") == "HEAD others tail");
}

TEST_CASE("a file that is moved goes on where it was, and one that is moved over is given up") {
  const TemporaryFolder folder;
  OutputFile first(folder / "first");
  first.write("1");
  OutputFile second(folder / "second");
  second.write("2");
  OutputFile moved(std::move(first));
  moved.write("1");
  second = std::move(moved);
  CHECK_FALSE(fs::exists(folder / "second.part"));
  second.write("1");
  second.commit();
  CHECK(content(folder / "first") == "111");
  CHECK_FALSE(fs::exists(folder / "second"));
}

TEST_CASE("a file that cannot be made is an error that names it and says what was expected") {
  const TemporaryFolder folder;
  fs::path path = folder / "missing" / "a.las";
  std::string problem = problem_of(path, [&] { OutputFile{path}; });
  CHECK(says(problem, "No such file or directory"));
  CHECK(says(problem, "expected an existing, writable folder"));

  std::ofstream(folder / "plain") << "no folder";
  path = folder / "plain" / "a.las";
  CHECK(says(problem_of(path, [&] { OutputFile{path}; }), "Not a directory"));

  path = folder.path();
  CHECK(says(problem_of(path, [&] { OutputFile{path}; }), "is a folder"));
  CHECK_FALSE(fs::exists(folder.path().string() + ".part"));

  path = "/proc/a.las";  // a folder that nobody may write to, not even root
  problem_of(path, [&] { OutputFile{path}; });

  fs::create_directory(folder / "closed");
  fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  path = folder / "closed" / "a.las";
  if (geteuid() != 0) CHECK(says(problem_of(path, [&] { OutputFile{path}; }), "Permission denied"));
}

TEST_CASE("a full disk is an error, when little is written at the end and when much is written at once") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  for (const std::size_t size : {std::size_t{5}, std::size_t{3'000'000}}) {
    CAPTURE(size);
    fs::create_symlink("/dev/full", folder / "a.las.part");
    OutputFile file(path);
    const std::string problem = problem_of(path, [&] {
      file.write(std::string(size, 'x'));
      CHECK(size == 5);
      file.commit();
    });
    CHECK(says(problem, "No space left on device"));
    CHECK(says(problem, "expected room for " + std::to_string(size) + " more bytes"));
    CHECK(folder.empty());
    CHECK(says(problem_of(path, [&] { file.write("x"); }), "cannot be written: it is already"));
    CHECK(says(problem_of(path, [&] { file.commit(); }), "cannot be written: it is already"));
    CHECK(folder.empty());
  }
}

TEST_CASE("a write that stops half-way is an error and leaves nothing") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  const SizeLimit limit(1'500'000);
  OutputFile file(path);
  const std::string problem = problem_of(path, [&] {
    for (int i = 0; i < 40; ++i) file.write(std::string(100'000, 'x'));
  });
  CHECK(says(problem, "File too large"));
  CHECK(folder.empty());

  OutputFile small(path);  // fits
  small.write(std::string(1'000'000, 'x'));
  small.commit();
  CHECK(fs::file_size(path) == 1'000'000);
}

TEST_CASE("a name that cannot be taken in the end is an error and leaves nothing") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  OutputFile file(path);
  file.write("x");
  fs::create_directories(path / "inside");
  CHECK(says(problem_of(path, [&] { file.commit(); }), "a replaceable name"));
  CHECK_FALSE(fs::exists(folder / "a.las.part"));
}

TEST_CASE("a program that is killed leaves no file under the final name") {
  const TemporaryFolder folder;
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    OutputFile file(folder / "a.las");
    file.write(std::string(5'000'000, 'x'));
    file.write("and some that is not handed over yet");
    std::raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK_FALSE(fs::exists(folder / "a.las"));
  CHECK(fs::file_size(folder / "a.las.part") == 5'000'000);
  OutputFile(folder / "a.las").commit();  // at once: its lock has ended with it
}

TEST_CASE("a second writer of a file is refused, in this program and in another, and the first is unharmed") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  OutputFile first(path);
  first.write(std::string(3'000'000, 'x'));
  const auto is_refused = [&] { return says(problem_of(path, [&] { OutputFile{path}; }), "is already being written"); };
  CHECK(is_refused());
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) _exit(is_refused() ? 0 : 1);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  first.write("y");
  first.commit();
  CHECK((content(path) == std::string(3'000'000, 'x') + "y"));
  OutputFile(path).commit();
  CHECK(content(path).empty());
}

TEST_CASE("a program that is started meanwhile does not inherit the lock") {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.las");
  int found = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    if (fs::read_symlink(entry.path(), gone) != folder / "a.las.part") continue;
    ++found;
    CHECK((fcntl(std::stoi(entry.path().filename()), F_GETFD) & FD_CLOEXEC) != 0);
  }
  CHECK(found == 1);
}

TEST_CASE("what processes of a killed program still write does not come into the file that replaces theirs") {
  const TemporaryFolder folder;
  std::ofstream late(folder / "a.las.part");
  late << "first" << std::flush;
  OutputFile file(folder / "a.las");
  file.write("second");
  late << " and last" << std::flush;
  file.commit();
  CHECK(content(folder / "a.las") == "second");
}

TEST_CASE(
    "on a file system without locks a file is written all the same, and who loses its name to another learns of it") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  for (const int error : {ENOLCK, EOPNOTSUPP, ENOSYS}) {
    flock_error = error;
    CAPTURE(error);
    OutputFile first(path);
    first.write("first");
    OutputFile second(path);
    second.write("second");
    CHECK(says(problem_of(path, [&] { first.commit(); }), "another program has replaced"));
    CHECK_FALSE(fs::exists(path));
    second.commit();
    CHECK(content(path) == "second");
    fs::remove(path);
    CHECK(folder.empty());
  }
  flock_error = 0;
}

TEST_CASE("what a file holds is on the disk before it has its name") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  std::vector<std::uintmax_t> sizes;
  at_fsync = [&](int) {
    CHECK_FALSE(fs::exists(path));
    sizes.push_back(fs::file_size(folder / "a.las.part"));
    return 0;
  };
  OutputFile file(path);
  file.write(std::string(3'000'000, 'x'));
  CHECK(sizes.empty());
  file.write("y");
  file.commit();
  CHECK(sizes == std::vector<std::uintmax_t>{3'000'001});
  fs::remove(path);

  at_fsync = [](int) { return EIO; };
  OutputFile lost(path);
  lost.write("x");
  CHECK(says(problem_of(path, [&] { lost.commit(); }), "Input/output error"));
  CHECK(folder.empty());

  at_fsync = [](int) { return EINVAL; };  // what cannot be synced need not be
  OutputFile special(path);
  special.write("x");
  special.commit();
  CHECK(content(path) == "x");
  at_fsync = {};
}

TEST_CASE("a pipe in place of the temporary file is an error and not waited for") {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.las";
  REQUIRE(mkfifo((folder / "a.las.part").c_str(), 0600) == 0);
  CHECK(says(problem_of(path, [&] { OutputFile{path}; }), "cannot be created"));
}

TEST_CASE("a piece of a file goes where its owner wants it, and touches no disk") {
  const TemporaryFolder folder;
  std::vector<std::byte> piece{std::byte{'>'}};
  OutputFile file(folder / "a.txt", piece);
  file.write(std::string_view("some"));
  OutputFile moved = std::move(file);
  moved.write(std::string_view(" text"));
  CHECK(moved.position() == 9);
  moved.commit();
  CHECK(std::string(reinterpret_cast<const char*>(piece.data()), piece.size()) == ">some text");
  CHECK_THROWS_AS(moved.write(std::string_view("more")), FileError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
