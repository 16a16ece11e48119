// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/chunk.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laz_reader.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;
using support::LazReadChunk;
using support::read_laz_chunk;

std::string compressed(const std::string& records, std::size_t record, std::size_t colour = 0) {
  const std::vector<std::byte> bytes = LazChunk(std::as_bytes(std::span(records)), record, colour).compressed();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Compresses, reads again, and checks that nothing else came back, and that nothing stands behind it.
LazReadChunk through(const std::string& records, std::size_t record, std::size_t colour = 0) {
  const std::string bytes = compressed(records, record, colour);
  LazReadChunk chunk = read_laz_chunk(bytes, 0, record, colour);
  CHECK(chunk.points == records.size() / record);
  CHECK(chunk.size == bytes.size());
  std::size_t same = 0;
  while (same < records.size() && same < chunk.records.size() && records[same] == chunk.records[same]) ++same;
  CAPTURE(same / record);  // the first point that is not as it was, and which of its bytes
  CAPTURE(same % record);
  CHECK(chunk.records == records);
  // The models, and so the bits, are the format's: nobody can do with fewer, and these are no more than are needed to
  // end a layer.
  for (std::size_t i = 0; i < chunk.layers.size(); ++i)
    if (chunk.layers[i] > 0) CHECK(8 * static_cast<double>(chunk.layers[i]) <= chunk.information[i] + 8 + 32);
  return chunk;
}

/// Points that are all alike but for what `change(record, i)` does to each.
std::string points(std::size_t count, std::size_t record,
                   const std::function<void(std::string&, std::size_t)>& change) {
  std::string one(record, '\0'), all;
  one[14] = 0x11;
  for (std::size_t i = 0; i < count; ++i) {
    change(one, i);
    all += one;
  }
  return all;
}

template <class Number>
void put(std::string& record, std::size_t at, Number number) {
  std::memcpy(record.data() + at, &number, sizeof number);
}

TEST_CASE("one point stands as it is, with the layers of positions and heights alone") {
  const std::string point = points(1, 34, [](std::string& p, std::size_t) { put(p, 30, 0x01020304U); });
  const std::string bytes = compressed(point, 34);
  CHECK(bytes.substr(0, 34) == point);
  CHECK(bytes.size() == 34 + 4 + 4 * 13 + 4 + 4);
  const LazReadChunk chunk = through(point, 34);
  CHECK(chunk.layers == std::vector<std::size_t>{4, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("a layer is there if its attribute changes, and only then") {
  const auto layers = [](std::size_t at) {
    const auto chunk = through(
        points(1000, 32, [at](std::string& p, std::size_t i) { p[at] = static_cast<char>(i == 500 ? 3 : p[at]); }), 32);
    std::vector<std::size_t> there;
    for (std::size_t i = 2; i < chunk.layers.size(); ++i)
      if (chunk.layers[i] > 0) there.push_back(i);
    return there;
  };
  using Layers = std::vector<std::size_t>;
  for (const std::size_t at : {0U, 4U, 8U, 14U}) CHECK(layers(at) == Layers{});
  CHECK(layers(16) == Layers{2});
  CHECK(layers(15) == Layers{3});
  CHECK(layers(12) == Layers{4});
  CHECK(layers(18) == Layers{5});
  CHECK(layers(17) == Layers{6});
  CHECK(layers(20) == Layers{7});
  CHECK(layers(22) == Layers{8});
  CHECK(layers(30) == Layers{9});
  CHECK(layers(31) == Layers{10});
}

TEST_CASE("a grey that changes costs no more than red alone, and less than half of a colour that changes") {
  const auto colours = [](const std::function<std::array<std::uint16_t, 3>(std::size_t)>& colour) {
    return through(points(10'000, 36, [&](std::string& p, std::size_t i) { put(p, 30, colour(i)); }), 36, 6)
        .layers.at(9);
  };
  const auto any = [](std::size_t i) { return static_cast<std::uint16_t>(i * i * 40'503 >> 4 & 255); };
  const auto grey = colours([&](std::size_t i) { return std::array{any(i), any(i), any(i)}; });
  const auto red = colours([&](std::size_t i) { return std::array{any(i), std::uint16_t{7}, std::uint16_t{7}}; });
  const auto all = colours([&](std::size_t i) { return std::array{any(i), any(i + 1), any(i + 2)}; });
  CHECK(grey < red + red / 50);
  CHECK(all > 2 * red);
}

TEST_CASE("points in even steps cost less than two bits") {
  const auto chunk = through(points(50'000, 30,
                                    [](std::string& p, std::size_t i) {
                                      put(p, 0, static_cast<std::int32_t>(25 * i));
                                      put(p, 4, static_cast<std::int32_t>(i % 2));
                                      put(p, 8, std::int32_t{100});
                                      put(p, 22, 0x1p20 + static_cast<double>(i) * 0x1p-17);
                                    }),
                             30);
  CHECK(chunk.size < 12'500);
}

/// Which of a point's bytes change, and with what chance; `channels` of the scanner there are.
struct Change {
  double chance;
  std::uint64_t channels;
  std::string operator()(std::size_t count, std::size_t record, std::uint64_t seed) const {
    Generator random(seed);
    return points(count, record, [&](std::string& p, std::size_t i) {
      for (std::size_t at = 0; at < record; ++at)
        if (random.uniform() < chance || i == 0) {
          const std::uint64_t any =
              random.coin() ? random.whole(256) : static_cast<unsigned char>(p[at]) + random.whole(5) - 2;
          p[at] = static_cast<char>(any);
        }
      p[15] = static_cast<char>((p[15] & ~0x30) | static_cast<char>(random.whole(channels) << 4));
    });
  }
};

TEST_CASE("points of any bytes come back, of one scanner channel and of several") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const Change change{random.log_uniform(1e-3, 1), 1 + random.whole(4)};
    const std::size_t record = 38 + random.whole(32), colour = std::array{0U, 6U, 8U}[seed % 3];
    through(change(1 + random.whole(3'000), record, seed), record, colour);
  }
}

TEST_CASE("all numbers of returns come back in all orders") {
  for (const bool same_time : {true, false}) {
    CAPTURE(same_time);
    Generator random(same_time ? 1 : 2);
    through(points(10'000, 30,
                   [&](std::string& p, std::size_t i) {
                     p[14] = static_cast<char>(random.whole(256));
                     put(p, 0, static_cast<std::int32_t>(random.whole(1000)));
                     put(p, 4, static_cast<std::int32_t>(random.whole(1000)));
                     put(p, 8, static_cast<std::int32_t>(random.whole(1000)));
                     if (!same_time) put(p, 22, static_cast<double>(i));
                   }),
            30);
  }
}

/// Of points that differ in their times alone.
LazReadChunk at_times(const std::vector<std::int64_t>& times) {
  return through(points(times.size(), 30, [&](std::string& p, std::size_t i) { put(p, 22, times[i]); }), 30);
}

TEST_CASE("times come back at every multiple of the usual step and beside it, and at the ends of their range") {
  for (const std::int64_t usual : {1, -1, 7, -1000, 3'000'000}) {
    CAPTURE(usual);
    std::vector<std::int64_t> times{12345, 12345 + usual};
    for (std::int64_t multiple = -15; multiple <= 510; ++multiple)
      for (std::int64_t off = -1; off <= 1; ++off) {
        times.push_back(times.back() + multiple * usual + off);
        times.push_back(times.back() + usual);
      }
    at_times(times);
  }
  constexpr std::int64_t step = INT32_MIN;
  at_times(
      {0, INT64_MIN, INT64_MAX, 0, INT64_MAX, INT64_MIN, -1, 1, INT64_MIN + 1, INT64_MAX - 1, INT64_MIN, INT64_MAX});
  at_times({0, step, 2 * step, 0, -step, 0, step, step - 1, 0, -1, step, 0});
}

TEST_CASE("two even series of times that take turns cost less than four bits a turn") {
  std::vector<std::int64_t> times;
  for (std::int64_t i = 0; i < 10'000; ++i) times.push_back((i % 2 == 0 ? 0 : std::int64_t{1} << 50) + 100 * i);
  CHECK(at_times(times).layers[8] * 2 < times.size());
}

TEST_CASE("coordinates at the ends of their range come back") {
  const std::int32_t ends[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX - 1, INT32_MAX};
  Generator random(5);
  through(points(2'000, 30,
                 [&](std::string& p, std::size_t) {
                   for (const std::size_t at : {0U, 4U, 8U}) put(p, at, ends[random.whole(7)]);
                 }),
          30);
}

TEST_CASE("points of one channel that is not the first, and of one that comes late, come back") {
  through(points(3'000, 40,
                 [](std::string& p, std::size_t i) {
                   p[15] = 0x20;
                   p[35] = static_cast<char>(i / 3);
                   p[16] = static_cast<char>(i % 7);
                 }),
          40);
  through(points(3'000, 40,
                 [](std::string& p, std::size_t i) {
                   p[15] = static_cast<char>(i < 2'000 ? 0x10 : i % 5 < 3 ? 0x30 : 0x10);
                   p[35] = static_cast<char>(i / 3);
                   p[16] = static_cast<char>(i % 7);
                   put(p, 8, static_cast<std::int32_t>(i * i));
                 }),
          40);
}

}  // namespace
}  // namespace pulsecast::io::detail
