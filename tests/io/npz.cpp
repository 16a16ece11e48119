// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/npz.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/scan_splitter.hpp>

#include "support/every_column.hpp"
#include "support/random_pulses.hpp"
#include "support/refused_field.hpp"
#include "support/size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::RandomPulses;
using support::refused_field;
using support::TemporaryFolder;

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  REQUIRE(at + sizeof(Number) <= bytes.size());
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// Members of a zip file without compression, by its table. Source: PKWARE, APPNOTE 6.3: 4.3.7, 4.3.12 and 4.3.16.
std::map<std::string, std::string> members(const std::string& zip) {
  std::map<std::string, std::string> all;
  REQUIRE(zip.size() >= 22);
  const std::size_t end = zip.size() - 22;  // of a file without comment
  CHECK(number_at<std::uint32_t>(zip, end) == 0x06054b50);
  std::size_t at = number_at<std::uint32_t>(zip, end + 16);
  for (int count = number_at<std::uint16_t>(zip, end + 10); count > 0; --count) {
    CHECK(number_at<std::uint32_t>(zip, at) == 0x02014b50);
    CHECK(number_at<std::uint16_t>(zip, at + 10) == 0);             // stored
    CHECK(number_at<std::uint32_t>(zip, at + 12) == 0x0021'0000U);  // 1980-01-01, the earliest
    const std::size_t size = number_at<std::uint32_t>(zip, at + 20), name = number_at<std::uint16_t>(zip, at + 28);
    CHECK(number_at<std::uint32_t>(zip, at + 24) == size);
    const std::size_t local = number_at<std::uint32_t>(zip, at + 42);
    CHECK(number_at<std::uint32_t>(zip, local) == 0x04034b50);
    const std::size_t begin =
        local + 30 + number_at<std::uint16_t>(zip, local + 26) + number_at<std::uint16_t>(zip, local + 28);
    all[zip.substr(at + 46, name)] = zip.substr(begin, size);
    at += 46 + name + number_at<std::uint16_t>(zip, at + 30) + number_at<std::uint16_t>(zip, at + 32);
  }
  CHECK(at == end);
  return all;
}

/// Numbers of an array, behind its header, which must be this one.
std::string array_content(const std::string& npy, const std::string& type, std::size_t count) {
  CHECK(npy.substr(0, 8) == std::string("\x93NUMPY\x01\0", 8));
  const std::size_t length = number_at<std::uint16_t>(npy, 8);
  CHECK((10 + length) % 64 == 0);
  const std::string text =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(count) + ",), }";
  CHECK(npy.substr(10, length) == text + std::string(length - text.size() - 1, ' ') + "\n");
  return npy.substr(10 + length);
}

std::string npz(const EchoBatch& batch, const NpzSettings& settings = {}) {
  const TemporaryFolder folder;
  NpzWriter writer(folder / "a.npz", settings);
  writer(batch);
  writer.close();
  return content(folder / "a.npz");
}

/// Layout of one quantity in all number types.
PointLayout every_type() {
  std::vector<PointField> fields;
  for (const char* const name : {"i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8"})
    fields.push_back({name, static_cast<NumberType>(fields.size() + 1), column("range")});
  return PointLayout::packed(fields);
}

TEST_CASE("waveforms are arrays of all samples, and of the place of those of each pulse") {
  std::vector<Shot> shots(3);
  shots[0] = {.index = 4, .tick = {2, 0.5}, .origin = {1, 2, 3}, .direction = {0, 0, -1}};
  shots[1] = shots[0];
  shots[0].samples = 2;
  shots[0].waveform_start = 1e-9;
  shots[1].samples = 0;
  shots[2] = shots[1];
  shots[2].index = 9;
  shots[2].first_sample = 2;
  shots[2].samples = 3;
  const std::vector<float> samples{1, 2, 3, 4, 5};
  const TemporaryFolder folder;
  WaveformNpzWriter writer(folder / "a.npz", 1000);
  writer(EchoBatch{shots, {}, samples, 2e-9});
  writer.close();
  const std::map<std::string, std::string> all = members(content(folder / "a.npz"));
  CHECK(all.size() == 13);
  const auto numbers = [&]<class Number>(const char* name, const char* type, const std::vector<Number>& expected) {
    CAPTURE(name);
    const std::string data = array_content(all.at(std::string(name) + ".npy"), type, expected.size());
    REQUIRE(data.size() == expected.size() * sizeof(Number));
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(number_at<Number>(data, i * sizeof(Number)) == expected[i]);
  };
  numbers("samples", "<f4", samples);
  numbers("first", "<i8", std::vector<std::int64_t>{0, 2});
  numbers("count", "<i8", std::vector<std::int64_t>{2, 3});
  numbers("pulse", "<i8", std::vector<std::int64_t>{4, 9});
  numbers("time", "<f8", std::vector<double>{1002.5, 1002.5});
  numbers("start", "<f8", std::vector<double>{1e-9, 0});
  numbers("interval", "<f8", std::vector<double>{2e-9, 2e-9});
  numbers("origin_y", "<f8", std::vector<double>{2, 2});
  numbers("direction_z", "<f8", std::vector<double>{-1, -1});
  CHECK_THROWS_AS(WaveformNpzWriter(folder / "b.npz", std::numeric_limits<double>::infinity()), SettingError);
  CHECK_FALSE(std::filesystem::exists(folder / "a.npz.samples.part"));
}

TEST_CASE("each field is an array of its name and type, with the numbers of all points") {
  const std::array<Shot, 1> shots{{{.direction = axis::right, .echoes = 2}}};
  const std::array<Echo, 2> echoes{{{.range = 3}, {.range = 70'000.25}}};
  const std::map<std::string, std::string> all =
      members(npz({.shots = shots, .echoes = echoes, .samples = {}}, {.layout = every_type()}));
  CHECK(all.size() == 8);
  const auto numbers = [&](const std::string& name, const std::string& order, auto first, auto second) {
    const std::string data = array_content(all.at(name + ".npy"), order + name, 2);
    REQUIRE(data.size() == 2 * sizeof first);
    return number_at<decltype(first)>(data, 0) == first && number_at<decltype(second)>(data, sizeof first) == second;
  };
  CHECK(numbers("i1", "|", std::int8_t{3}, std::int8_t{127}));
  CHECK(numbers("u1", "|", std::uint8_t{3}, std::uint8_t{255}));
  CHECK(numbers("i2", "<", std::int16_t{3}, std::int16_t{32767}));
  CHECK(numbers("u2", "<", std::uint16_t{3}, std::uint16_t{65535}));
  CHECK(numbers("i4", "<", std::int32_t{3}, std::int32_t{70'000}));
  CHECK(numbers("u4", "<", std::uint32_t{3}, std::uint32_t{70'000}));
  CHECK(numbers("f4", "<", 3.0F, 70'000.25F));
  CHECK(numbers("f8", "<", 3.0, 70'000.25));
}

TEST_CASE("every column of the table is an array of its type") {
  const support::EveryColumn all;
  const std::map<std::string, std::string> found =
      members(npz(all.batch(), {.layout = PointLayout::packed(all.fields), .points = all.settings}));
  CHECK(found.size() == point_columns.size());
  constexpr std::array types{"", "|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<f4", "<f8", "<i8", "<u8"};
  const PointBuffer expected = all.records();
  for (const PointField& field : expected.layout().fields) {
    CAPTURE(field.name);
    const std::size_t size = size_of(field.type);
    std::string numbers;
    for (std::size_t i = 0; i < 2; ++i)
      numbers += all.bytes(expected).substr(i * expected.layout().size + field.offset, size);
    CHECK(array_content(found.at(field.name + ".npy"), types[static_cast<std::size_t>(field.type)], 2) == numbers);
  }
}

TEST_CASE("random points of scans are the columns of a buffer, padded or not") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    const RandomPulses pulses(1 + 300 * seed, seed);
    const TemporaryFolder folder;
    NpzWriter writer(folder / "a.npz", {.layout = layouts::ouster()});
    std::map<std::string, std::string> expected;
    std::size_t count = 0;
    ScanSplitter splitter(PointBuffer(layouts::ouster()), 10, [&](const PointBuffer& scan) {
      writer.add(scan);
      for (const PointField& field : scan.layout().fields)
        for (std::size_t i = 0; i < scan.size(); ++i)
          expected[field.name].append(
              reinterpret_cast<const char*>(scan.records().data()) + i * scan.layout().size + field.offset,
              size_of(field.type));
      count += scan.size();
    });
    splitter(pulses.batch());
    splitter.close();
    writer.close();
    const std::map<std::string, std::string> all = members(content(folder / "a.npz"));
    REQUIRE(all.size() == layouts::ouster().fields.size());
    CHECK(count == pulses.echoes.size());
    constexpr std::array<const char*, 9> types{"", "|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<f4", "<f8"};
    for (const PointField& field : layouts::ouster().fields)
      CHECK(array_content(all.at(field.name + ".npy"), types[static_cast<std::size_t>(field.type)], count) ==
            expected[field.name]);
  }
}

TEST_CASE("equal points give equal bytes, in any time zone") {
  const RandomPulses pulses(100, 1);
  const std::string bytes = npz(pulses.batch());
  const char* const zone = std::getenv("TZ");
  const std::string former = zone == nullptr ? "" : zone;
  for (const char* const other : {"Pacific/Kiritimati", "Pacific/Pago_Pago"}) {
    setenv("TZ", other, 1);
    tzset();
    CHECK(npz(pulses.batch()) == bytes);
  }
  zone == nullptr ? unsetenv("TZ") : setenv("TZ", former.c_str(), 1);
  tzset();
}

TEST_CASE("headers of arrays end at a multiple of 64 bytes for any count") {
  for (std::uint64_t count = 1; count < std::uint64_t{1} << 60; count *= 10) {
    CAPTURE(count);
    CHECK(array_content(detail::npy_header(NumberType::float64, count), "<f8", count).empty());
  }
}

TEST_CASE("a file without points has arrays without numbers") {
  const std::map<std::string, std::string> all = members(npz({}, {.layout = every_type()}));
  CHECK(all.size() == 8);
  CHECK(array_content(all.at("f8.npy"), "<f8", 0).empty());
}

TEST_CASE("without close there is no file, and a full disk is an error that leaves none") {
  const TemporaryFolder folder;
  {
    NpzWriter writer(folder / "a.npz");
    writer(RandomPulses(100, 1).batch());
  }
  CHECK(folder.empty());
  {
    const support::SizeLimit limit(10'000);
    NpzWriter small(folder / "a.npz"), large(folder / "b.npz");
    small(RandomPulses(1000, 1).batch());
    CHECK_THROWS_AS(small.close(), FileError);
    large(
        RandomPulses(300'000, 1).batch());  // whose arrays do not fit into the buffer of the file: the library is told
    CHECK_THROWS_WITH_AS(large.close(), doctest::Contains("room for"), FileError);
  }
  CHECK(folder.empty());
}

TEST_CASE("settings and buffers that do not fit are refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const NpzSettings& settings) {
    return refused_field([&] { NpzWriter(folder / "a.npz", settings); });
  };
  CHECK(refused({.layout = {}}) == "PointLayout::size");
  CHECK(refused({.layout = PointLayout::packed({{"a/b", NumberType::float32}})}) ==
        "PointField::name (character code)");
  CHECK(refused({.points = {.start_time = std::numeric_limits<double>::infinity()}}) == "PointSettings::start_time");
  NpzWriter writer(folder / "a.npz");
  CHECK(refused_field([&] { writer.add(PointBuffer(layouts::xyzi())); }) == "PointBuffer::layout (index of a field)");
}

}  // namespace
}  // namespace pulsecast::io
