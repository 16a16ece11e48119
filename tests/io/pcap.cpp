// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/pcap.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

const std::vector<std::byte> payload{std::byte{0xAB}, std::byte{0xCD}, std::byte{0xEF}};

std::string written(const PcapSettings& settings, const std::vector<SensorPacket>& packets) {
  const support::TemporaryFolder folder;
  PcapWriter writer(folder / "lidar.pcap", settings);
  for (const SensorPacket& packet : packets) writer(packet);
  writer.close();
  return support::content(folder / "lidar.pcap");
}

std::string bytes(const std::vector<unsigned>& values) {
  std::string text;
  for (const unsigned value : values) text += static_cast<char>(value);
  return text;
}

TEST_CASE("a capture file has the bytes of its specifications") {
  const std::string expected = bytes({
      0xD4, 0xC3, 0xB2, 0xA1, 2,    0,    4,    0,    0,    0,    0,    0,    0,    0,    0, 0,
      0x0E, 0x00, 0x01, 0x00, 1,    0,    0,    0,                                               // file, Ethernet
      0x02, 0x01, 0x00, 0x00, 0x40, 0xE2, 0x01, 0x00, 45,   0,    0,    0,    45,   0,    0, 0,  // record, 258.123456 s
      0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 2,    0,    0,    0,    0,    1,    0x08, 0x00,        // Ethernet
      0x45, 0x00, 0x00, 31,   0x00, 0x00, 0x40, 0x00, 64,   17,   0x78, 0x5D,                    // IPv4
      192,  168,  1,    201,  255,  255,  255,  255,                                             // addresses
      0x09, 0x40, 0x09, 0x40, 0x00, 11,   0x00, 0x00, 0xAB, 0xCD, 0xEF,                          // UDP, port 2368
  });
  CHECK(written({}, {{{258, 0.123456}, 2368, payload}}) == expected);
}

TEST_CASE("times are rounded to the file's unit, with a carry") {
  const auto time = [&](bool nanoseconds, Tick tick) {
    const std::string file = written({.nanoseconds = nanoseconds}, {{tick, 7502, payload}});
    CHECK(file.substr(0, 4) == (nanoseconds ? bytes({0x4D, 0x3C, 0xB2, 0xA1}) : bytes({0xD4, 0xC3, 0xB2, 0xA1})));
    return file.substr(24, 8);
  };
  CHECK(time(false, {1, 0.9999999}) == bytes({2, 0, 0, 0, 0, 0, 0, 0}));
  CHECK(time(true, {1, 0.9999999}) == bytes({1, 0, 0, 0, 0x9C, 0xC9, 0x9A, 0x3B}));
  CHECK(time(false, {4'000'000'000, 0}) == bytes({0x00, 0x28, 0x6B, 0xEE, 0, 0, 0, 0}));
}

TEST_CASE("the checksum of IPv4 holds for any addresses and lengths, and each packet of a file") {
  const std::vector<std::size_t> sizes{0, 1206, 16'640, 65'507, 3};
  std::vector<std::vector<std::byte>> payloads;
  for (const std::size_t size : sizes) payloads.emplace_back(size);
  std::vector<SensorPacket> packets;
  for (const auto& each : payloads) packets.push_back({{}, 1, each});
  const std::string file = written({.source = {10, 255, 254, 253}, .destination = {127, 0, 0, 1}}, packets);
  std::size_t at = 24;
  for (const std::size_t size : sizes) {
    REQUIRE(file.size() >= at + 16 + 42 + size);
    unsigned sum = 0;  // the sum of all words, the checksum included, is all ones. Source: RFC 1071
    for (std::size_t k = at + 30; k < at + 50; k += 2)
      sum += static_cast<unsigned>(std::uint8_t(file[k])) << 8 | std::uint8_t(file[k + 1]);
    CHECK((sum & 0xFFFF) + (sum >> 16) == 0xFFFF);
    at += 16 + 42 + size;
  }
  CHECK(file.size() == at);
}

TEST_CASE("a packet longer than UDP allows, and a folder that is none, are refused") {
  const support::TemporaryFolder folder;
  PcapWriter writer(folder / "lidar.pcap");
  const std::vector<std::byte> too_long(65'508);
  CHECK_THROWS_WITH_AS(writer({{}, 1, too_long}), doctest::Contains("SensorPacket::payload"), SettingError);
  CHECK(support::file_error([&] { PcapWriter(folder / "none/lidar.pcap"); }).path() ==
        (folder / "none/lidar.pcap").string());
}

}  // namespace
}  // namespace pulsecast::io
