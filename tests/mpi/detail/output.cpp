// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/output.hpp>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/mpi_group.hpp"
#include "support/size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::mpi {
namespace {

using support::content;
using support::mpi_group;
using support::TemporaryFolder;

/// Counts what it hears.
struct Listener final : MpiOutput {
  explicit Listener(MpiGroup& group) : MpiOutput(group) {}
  struct Piece final : MpiPiece {
    void clear() override { ++cleared; }
    void operator()(const EchoBatch&) override {}
    [[nodiscard]] MpiExtent extent() override { return {}; }
    [[nodiscard]] std::size_t memory() const noexcept override { return 0; }
    int cleared = 0;
  };
  [[nodiscard]] std::unique_ptr<MpiPiece> piece() override { return std::make_unique<Piece>(); }
  void put(MpiPiece&, const MpiPlace&) override {}
  [[nodiscard]] MpiPlace place(const MpiExtent&, int) override { return {}; }
  void receive(int, MpiMessage message) override { input += message.next<int>(); }
  void close() override {
    work_until([&] { return input == expected; });
  }
  void say(int number) {
    for (int to = 0; to < group().size(); ++to) send(to, std::move(MpiMessage().add(number)));
  }
  int input = 0, expected = 0;
};

TEST_CASE("what an output says is heard by the same output everywhere") {
  Listener one(mpi_group()), other(mpi_group());
  one.expected = 5 * mpi_group().size();
  other.expected = 7 * mpi_group().size();
  other.say(7);
  one.say(5);
  one.close();
  other.close();
  CHECK(one.input == one.expected);
  CHECK(other.input == other.expected);
  mpi_group().channel().barrier([] {});
}

TEST_CASE("pieces are used again") {
  Listener output(mpi_group());
  std::unique_ptr<MpiPiece> piece = output.take_piece();
  const MpiPiece* const same = piece.get();
  output.give_back(std::move(piece));
  piece = output.take_piece();
  CHECK(piece.get() == same);
  CHECK(static_cast<Listener::Piece&>(*piece).cleared == 1);
  CHECK(output.take_piece().get() != same);
}

TEST_CASE("what comes too early is kept for the next run") {
  struct Run {
    std::vector<int> input;
  };
  const auto hear = [](void* run, int, int kind, MpiMessage message) {
    static_cast<Run*>(run)->input.push_back(kind * 100 + message.next<int>());
  };
  Run one, two;
  mpi_group().begin(&one, hear);
  mpi_group().send(0, 2, std::move(MpiMessage().add(mpi_group().rank())));
  mpi_group().channel().barrier([] {});  // not served
  mpi_group().end();
  mpi_group().begin(&two, hear);
  mpi_group().send(0, 3, std::move(MpiMessage().add(mpi_group().rank())));
  const std::size_t expected = mpi_group().first() ? static_cast<std::size_t>(mpi_group().size()) : 0;
  while (two.input.size() < expected) mpi_group().serve();
  mpi_group().end();
  CHECK(one.input.empty());
  for (const int number : two.input) CHECK(number / 100 == 3);
  Run three;  // takes what was for one, as none else of its kind has come
  mpi_group().begin(&three, hear);
  mpi_group().serve();
  CHECK(three.input.size() == expected);
  mpi_group().end();
  mpi_group().channel().barrier([] {});
}

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST_CASE("several write to a file that one has made") {
  const TemporaryFolder folder;
  io::OutputFile whole(folder / "a.txt");
  whole.write(std::string_view("head "));
  {
    MpiFile one(folder / "a.txt"), other(folder / "a.txt");
    other.write(9, bytes("five"));
    one.write(5, bytes("four"));
    one.close();
  }
  whole.continue_at(13);
  CHECK(whole.position() == 13);
  whole.write(std::string_view(" end"));
  whole.overwrite(0, bytes("HEAD"));
  whole.commit();
  CHECK(content(folder / "a.txt") == "HEAD fourfive end");
}

TEST_CASE("a write that stops half-way is an error") {
  const TemporaryFolder folder;
  const io::OutputFile whole(folder / "a.txt");
  MpiFile file(folder / "a.txt");
  const support::SizeLimit limit(1000);
  try {
    file.write(0, bytes(std::string(1500, 'x')));
    FAIL("nothing was thrown");
  } catch (const FileError& error) {
    CHECK(std::string_view(error.what()).find("expected room for 500 more bytes") != std::string_view::npos);
  }
}

TEST_CASE("a file that is not there cannot be written to") {
  const TemporaryFolder folder;
  MpiFile file(folder / "a.txt");
  file.write(0, {});  // nothing to write, nothing wrong
  try {
    file.write(0, bytes("x"));
    FAIL("nothing was thrown");
  } catch (const FileError& error) {
    CHECK(std::string_view(error.what()).find("a.txt") != std::string_view::npos);
    CHECK(std::string_view(error.what()).find("No such file") != std::string_view::npos);
  }
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::mpi
