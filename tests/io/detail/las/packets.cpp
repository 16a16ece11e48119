// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/packets.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::TemporaryFolder;

/// A number at some byte, the lowest byte first.
std::uint64_t whole(const std::string& bytes, std::size_t at, std::size_t n) {
  std::uint64_t value = 0;
  for (std::size_t i = n; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

/// What a descriptor says of the packets that have it: its gain is in units of 2^-52 W, its offset in gains.
struct Descriptor {
  std::uint64_t samples, spacing;
  double gain, offset;
};
Descriptor descriptor(const LasPackets& packets, unsigned index) {
  const std::vector<std::byte> all = packets.descriptors(LasPackets::Used().set());
  const std::string bytes(reinterpret_cast<const char*>(all.data()), all.size());
  for (std::size_t at = 0; at < bytes.size(); at += 80) {
    if (whole(bytes, at + 18, 2) != index + 99U) continue;
    CHECK(bytes.substr(at + 2, 10) == std::string("LASF_Spec\0", 10));
    CHECK(whole(bytes, at + 20, 2) == 26);
    CHECK(whole(bytes, at + 54, 2) == 16);  // bits; not compressed
    const double gain = std::bit_cast<double>(whole(bytes, at + 64, 8)),
                 offset = std::bit_cast<double>(whole(bytes, at + 72, 8));
    return {whole(bytes, at + 56, 4), whole(bytes, at + 60, 4), gain * 0x1p52, offset / gain};
  }
  FAIL("no descriptor");
  return {};
}

TEST_CASE("a file of two packets, byte by byte") {
  const TemporaryFolder folder;
  LasPackets packets(folder / "a.wdp");
  const std::vector<float> first{0, 0x1p-52F, -0x1p-51F}, second(17, 0x1p-30F);
  const LasPacket a = packets.add(first, 0.25e-9), b = packets.add(second, 0.25e-9);
  CHECK((a.descriptor == 1 && a.offset == 60 && a.size == 32));
  CHECK((b.offset == 92 && b.size == 48));
  packets.close();
  std::string expected("\0\0LASF_Spec", 11);
  expected.resize(18);
  expected += std::string("\xFF\xFF\x50\0\0\0\0\0\0\0Waveform Data Packets", 31);  // 80 bytes follow
  expected.resize(60);
  expected += std::string("\0\x10\1\x10\xFE\x0F", 6);
  for (int i = 3; i < 16; ++i) expected += std::string("\0\x10", 2);
  for (int i = 0; i < 17; ++i) expected += std::string("\0\x50", 2);  // 2^-30 is 2^14 of 2^-44
  for (int i = 17; i < 24; ++i) expected += std::string("\0\x10", 2);
  CHECK((content(folder / "a.wdp") == expected));
  const Descriptor of_a = descriptor(packets, a.descriptor), of_b = descriptor(packets, b.descriptor);
  CHECK((of_a.samples == 16 && of_a.spacing == 250 && of_a.gain == 1 && of_a.offset == -4096));
  CHECK((of_b.samples == 24 && of_b.spacing == 250 && of_b.gain == 256 && of_b.offset == -4096));
}

TEST_CASE("there are 253 descriptors, of 23 sizes and 11 gains, each of its own") {
  const TemporaryFolder folder;
  const LasPackets packets(folder / "a.wdp");
  CHECK(packets.descriptors(LasPackets::Used().set()).size() == 253 * 80);
  std::uint64_t before = 0;
  for (unsigned size = 0; size < 23; ++size) {
    const Descriptor first = descriptor(packets, 1 + 11 * size);
    CHECK(first.samples > before);
    CHECK((before == 0 || first.samples <= before + before / 2));
    before = first.samples;
    for (unsigned gain = 0; gain < 11; ++gain) {
      const Descriptor d = descriptor(packets, 1 + 11 * size + gain);
      CHECK(d.samples == first.samples);
      CHECK(d.gain == std::pow(16, gain));
      CHECK(d.offset == -4096);
    }
  }
  CHECK(before == 32768);
}

TEST_CASE("a file has the descriptors that are used, and a superseded record in the room of the others") {
  const TemporaryFolder folder;
  const LasPackets packets(folder / "a.wdp");
  for (const std::vector<std::size_t>& used : {std::vector<std::size_t>{}, {7}, {1, 12, 253}}) {
    LasPackets::Used numbers;
    for (const std::size_t number : used) numbers.set(number);
    const std::vector<std::byte> all = packets.descriptors(numbers);
    const std::string bytes(reinterpret_cast<const char*>(all.data()), all.size());
    CHECK(bytes.size() == 253 * 80);
    std::size_t at = 0;
    for (const std::size_t number : used) {
      CHECK((whole(bytes, at + 18, 2) == 99 + number && whole(bytes, at + 20, 2) == 26));
      at += 80;
    }
    CHECK(whole(bytes, at + 18, 2) == 7);
    CHECK(at + 54 + whole(bytes, at + 20, 2) == bytes.size());
    CHECK(bytes.find_first_not_of('\0', at + 54) == bytes.npos);
  }
}

TEST_CASE("samples come back within a 7680th of the peak, whatever the power and the length, and so do negative ones") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const TemporaryFolder folder;
    LasPackets packets(folder / "a.wdp");
    const double peak = random.log_uniform(1e-14, 14);
    std::vector<float> waveform(static_cast<std::size_t>(random.log_uniform(1, 2000)));
    for (float& w : waveform) w = static_cast<float>(random.uniform(-peak / 20, peak));
    waveform[random.whole(waveform.size())] = static_cast<float>(peak);
    const LasPacket packet = packets.add(waveform, 1e-9);
    packets.close();
    const Descriptor d = descriptor(packets, packet.descriptor);
    const std::string bytes = content(folder / "a.wdp");
    CHECK(packet.size == 2 * d.samples);
    CHECK(d.samples >= waveform.size());
    for (std::size_t i = 0; i < d.samples; ++i) {
      const double power = (static_cast<double>(whole(bytes, packet.offset + 2 * i, 2)) + d.offset) * d.gain * 0x1p-52;
      if (i < waveform.size())
        REQUIRE(std::fabs(power - double{waveform[i]}) <= std::max(peak / 7680, 0x1p-53) * (1 + 1e-6));
      else
        REQUIRE(power == 0);
    }
  }
}

TEST_CASE("what is stronger than 15 W is cut, and what is not a number is the least") {
  const TemporaryFolder folder;
  LasPackets packets(folder / "a.wdp");
  const LasPacket packet = packets.add(std::vector<float>{1e9F, -1e9F}, 1e-9);
  const LasPacket other = packets.add(std::vector<float>{std::numeric_limits<float>::quiet_NaN()}, 1e-9);
  packets.close();
  const std::string bytes = content(folder / "a.wdp");
  CHECK(whole(bytes, packet.offset, 4) == 65535);
  CHECK(whole(bytes, other.offset, 2) == 0);
  CHECK(descriptor(packets, packet.descriptor).gain == 0x1p40);
}

TEST_CASE("a waveform of 32768 samples can be written, a longer one is an error that leaves no file") {
  const TemporaryFolder folder;
  LasPackets packets(folder / "a.wdp");
  CHECK(packets.add(std::vector<float>(32768), 1e-9).size == 65536);
  CHECK_THROWS_WITH_AS(static_cast<void>(packets.add(std::vector<float>(32769), 1e-9)),
                       doctest::Contains("a waveform has 32769 samples; expected at most 32768"), FileError);
  CHECK_THROWS_AS(packets.close(), FileError);
  CHECK(folder.empty());
}

TEST_CASE("samples are a whole number of picoseconds apart, one and the same in a file") {
  const TemporaryFolder folder;
  const std::vector<float> waveform(3);
  for (const double bad : {0.25e-12, 1.5e-12, 0.0, -1e-9, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CAPTURE(bad);
    LasPackets packets(folder / "a.wdp");
    CHECK_THROWS_WITH_AS(static_cast<void>(packets.add(waveform, bad)),
                         doctest::Contains("expected a whole number from 1 to 2^32 - 1"), FileError);
  }
  LasPackets packets(folder / "a.wdp");
  for (int i = 0; i < 3; ++i) static_cast<void>(packets.add(waveform, 0.1e-9 + 1e-20 * i));
  CHECK(descriptor(packets, 1).spacing == 100);
  CHECK_THROWS_WITH_AS(static_cast<void>(packets.add(waveform, 0.2e-9)),
                       doctest::Contains("samples are 200 ps apart; expected 100 ps, as before"), FileError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
