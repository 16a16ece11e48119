// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/output.hpp>

#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/mpi_team.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_team;

/// Counts what it hears.
struct Listener final : MpiOutput {
  explicit Listener(MpiTeam& team) : MpiOutput(team) {}
  struct Piece final : MpiPiece {
    void clear() override { ++cleared; }
    void operator()(const EchoBatch&) override {}
    [[nodiscard]] MpiClaim claim() override { return {}; }
    [[nodiscard]] std::size_t memory() const noexcept override { return 0; }
    int cleared = 0;
  };
  [[nodiscard]] std::unique_ptr<MpiPiece> piece() override { return std::make_unique<Piece>(); }
  void put(MpiPiece&, const MpiPlace&) override {}
  [[nodiscard]] MpiPlace place(const MpiClaim&, int) override { return {}; }
  void receive(int, MpiParcel parcel) override { heard += parcel.next<int>(); }
  void close() override {
    work_until([&] { return heard == expected; });
  }
  void say(int number) {
    for (int to = 0; to < team().size(); ++to) send(to, std::move(MpiParcel().add(number)));
  }
  int heard = 0, expected = 0;
};

TEST_CASE("what an output says is heard by the same output everywhere") {
  Listener one(mpi_team()), other(mpi_team());
  one.expected = 5 * mpi_team().size(), other.expected = 7 * mpi_team().size();
  other.say(7), one.say(5);
  one.close(), other.close();
  CHECK(one.heard == one.expected);
  CHECK(other.heard == other.expected);
  mpi_team().channel().meet([] {});
}

TEST_CASE("pieces are used again") {
  Listener output(mpi_team());
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
    std::vector<int> heard;
  };
  const auto hear = [](void* run, int, int kind, MpiParcel parcel) {
    static_cast<Run*>(run)->heard.push_back(kind * 100 + parcel.next<int>());
  };
  Run one, two;
  mpi_team().begin(&one, hear);
  mpi_team().send(0, 2, std::move(MpiParcel().add(mpi_team().rank())));
  mpi_team().channel().meet([] {});  // not served
  mpi_team().end();
  mpi_team().begin(&two, hear);
  mpi_team().send(0, 3, std::move(MpiParcel().add(mpi_team().rank())));
  const std::size_t expected = mpi_team().first() ? static_cast<std::size_t>(mpi_team().size()) : 0;
  while (two.heard.size() < expected) mpi_team().serve();
  mpi_team().end();
  CHECK(one.heard.empty());
  for (const int number : two.heard) CHECK(number / 100 == 3);
  Run three;  // takes what was for one, as none else of its kind has come
  mpi_team().begin(&three, hear);
  mpi_team().serve();
  CHECK(three.heard.size() == expected);
  mpi_team().end();
  mpi_team().channel().meet([] {});
}

}  // namespace
}  // namespace pulsecast::mpi
