// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/output.hpp>

#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/mpi_group.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_group;

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

}  // namespace
}  // namespace pulsecast::mpi
