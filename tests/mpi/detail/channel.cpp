// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/channel.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/mpi_group.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_group;

TEST_CASE("messages arrive in the order of sending, from all at all") {
  mpi_group();
  MpiChannel channel(MPI_COMM_WORLD);
  constexpr int each = 100;
  for (int k = 0; k < each; ++k)
    for (int to = 0; to < channel.size(); ++to) {
      MpiMessage message;
      message.add(k).add(std::span<const std::byte>(std::vector<std::byte>(static_cast<std::size_t>(k) * 1000)));
      channel.send(to, 3, std::move(message).take());
    }
  std::vector<int> next(static_cast<std::size_t>(channel.size()));
  int all = 0;
  while (all < each * channel.size())
    channel.poll([&](int from, int kind, MpiChannel::Bytes bytes) {
      MpiMessage message(std::move(bytes));
      const int k = message.next<int>();
      CHECK(k == next[static_cast<std::size_t>(from)]++);
      CHECK(message.rest().size() == static_cast<std::size_t>(k) * 1000);
      CHECK(kind == 3);
      ++all;
    });
  CHECK(!channel.poll([](int, int, const MpiChannel::Bytes&) {}));
  CHECK(channel.traffic().messages ==
        static_cast<std::uint64_t>(each * (channel.size() - 1)));  // what one says to itself is none
}

TEST_CASE("what the first says, all say; what all say, the first hears") {
  mpi_group();
  MpiChannel channel(MPI_COMM_WORLD);
  CHECK(channel.from_first(channel.first() ? std::string("a folder") : std::string("another, which is longer")) ==
        "a folder");
  CHECK(channel.from_first(channel.rank() + 5.5) == 5.5);
  const std::vector<int> ranks = channel.gather(channel.rank());
  CHECK(ranks.size() == (channel.first() ? static_cast<std::size_t>(channel.size()) : 0));
  for (std::size_t i = 0; i < ranks.size(); ++i) CHECK(ranks[i] == static_cast<int>(i));
  int waited = 0;
  channel.barrier([&] { ++waited; });
  CHECK(waited > 0);
}

TEST_CASE("messages give back what was put into them") {
  MpiMessage message;
  const std::vector<double> numbers{1, 2, 3}, none;
  message.add('x').add(std::span(numbers)).add(7L).add(std::span(none));
  MpiMessage same(std::move(message).take());
  std::vector<double> read;
  CHECK(same.next<char>() == 'x');
  same.next(read, 3);
  CHECK(read == numbers);
  CHECK(same.next<long>() == 7);
  same.next(read, 0);
  CHECK(read.empty());
  CHECK(same.rest().empty());
}

TEST_CASE("what was added last to a message can be taken off it") {
  MpiMessage message;
  message.add('x').add(7L).add(std::uint32_t{9});
  CHECK(message.last<std::uint32_t>() == 9);
  CHECK(message.next<char>() == 'x');
  CHECK(message.rest().size() == sizeof(long));
  CHECK(message.last<long>() == 7);
  CHECK(message.rest().empty());
}

}  // namespace
}  // namespace pulsecast::mpi
