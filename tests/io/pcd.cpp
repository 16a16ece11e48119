// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/pcd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/scan_splitter.hpp>

#include "support/every_column.hpp"
#include "support/random_pulses.hpp"
#include "support/refused_field.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::RandomPulses;
using support::refused_field;
using support::TemporaryFolder;

constexpr std::array encodings{PcdEncoding::ascii, PcdEncoding::binary, PcdEncoding::binary_compressed};

/// Header of a PCD file by the first word of its lines, without comments; and the bytes after it.
struct PcdFile {
  std::map<std::string, std::vector<std::string>> header;
  std::string data;

  explicit PcdFile(const std::string& bytes) {
    std::size_t at = 0;
    while (header.count("DATA") == 0) {
      const std::size_t end = bytes.find('\n', at);
      REQUIRE(end != std::string::npos);
      std::istringstream line(bytes.substr(at, end - at));
      at = end + 1;
      std::string key, word;
      line >> key;
      if (key == "#") continue;
      while (line >> word) header[key].push_back(word);
    }
    data = bytes.substr(at);
  }

  [[nodiscard]] std::size_t points() const { return std::stoull(header.at("POINTS").at(0)); }

  /// Numbers of the points, by the header alone: one row a field.
  [[nodiscard]] std::vector<std::vector<double>> columns() const {
    const std::string encoding = header.at("DATA").at(0);
    if (encoding == "ascii") return text_columns();
    std::vector<std::vector<double>> all(header.at("FIELDS").size());
    const bool compressed = encoding == "binary_compressed";
    const std::string bytes = compressed ? decompressed() : data;
    std::size_t record = 0, begin = 0;
    for (const std::string& size : header.at("SIZE")) record += std::stoull(size);
    CHECK(bytes.size() == record * points());
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t size = std::stoull(header.at("SIZE")[k]), step = compressed ? size : record;
      for (std::size_t i = 0; i < points(); ++i)
        all[k].push_back(number(header.at("TYPE")[k] + header.at("SIZE")[k], bytes.data() + begin + i * step));
      begin += compressed ? size * points() : size;
    }
    return all;
  }

 private:
  template <class Number>
  static double as(const char* from) {
    Number value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
  }

  static double number(const std::string& type, const char* from) {
    static const std::map<std::string, double (*)(const char*)> readers{
        {"I1", as<std::int8_t>},  {"U1", as<std::uint8_t>},  {"I2", as<std::int16_t>}, {"U2", as<std::uint16_t>},
        {"I4", as<std::int32_t>}, {"U4", as<std::uint32_t>}, {"F4", as<float>},        {"F8", as<double>}};
    return readers.at(type)(from);
  }

  [[nodiscard]] std::vector<std::vector<double>> text_columns() const {
    std::vector<std::vector<double>> all(header.at("FIELDS").size());
    std::istringstream lines(data);
    std::string line, word;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      for (std::size_t k = 0; k < all.size(); ++k) {
        REQUIRE(static_cast<bool>(words >> word));
        all[k].push_back(header.at("TYPE")[k] + header.at("SIZE")[k] == "F4" ? std::stof(word) : std::stod(word));
      }
      CHECK_FALSE(static_cast<bool>(words >> word));
    }
    return all;
  }

  [[nodiscard]] std::string decompressed() const {
    std::array<std::uint32_t, 2> sizes;
    REQUIRE(data.size() >= sizeof sizes);
    std::memcpy(sizes.data(), data.data(), sizeof sizes);
    CHECK(data.size() == sizeof sizes + sizes[0]);
    std::string bytes(sizes[1], '\0');
    if (sizes[1] > 0) CHECK(lzf_decompress(data.data() + sizeof sizes, sizes[0], bytes.data(), sizes[1]) == sizes[1]);
    return bytes;
  }
};

/// Echoes at 10 m and 20 m to the east of (1, 2, 3).
struct TwoEchoes {
  std::array<Shot, 1> shots{
      {{.tick = {3, 0.25}, .origin = {1, 2, 3}, .direction = axis::right, .channel = 5, .echoes = 2}}};
  std::array<Echo, 2> echoes{{{.range = 10, .reflectance = 0.5, .object = 70'000, .classification = 6},
                              {.range = 20, .reflectance = 0.015, .number = 2, .velocity = -3.5}}};

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

/// Layout with all number types, signs, and quantities that may be NaN or infinite.
PointLayout every_type() {
  return PointLayout::packed({{"i8", NumberType::int8, column("object"), -1e-8},
                              {"u8", NumberType::uint8, column("reflectivity")},
                              {"i16", NumberType::int16, column("x"), 7},
                              {"u16", NumberType::uint16, column("classification")},
                              {"i32", NumberType::int32, column("y"), 1e3},
                              {"u32", NumberType::uint32, column("object")},
                              {"f32", NumberType::float32, column("z")},
                              {"f64", NumberType::float64, column("x")},
                              {"width", NumberType::float32, column("echo_width")},
                              {"velocity", NumberType::float64, column("radial_velocity")},
                              {"part", NumberType::float32, column("part")},
                              {"ring", NumberType::uint16, column("ring")}});
}

std::string pcd(const EchoBatch& batch, const PcdSettings& settings) {
  const TemporaryFolder folder;
  PcdWriter writer(folder / "a.pcd", settings);
  writer(batch);
  writer.close();
  return content(folder / "a.pcd");
}

TEST_CASE("every column of the table is a field in every encoding, of 64-bit integers as a double") {
  const support::EveryColumn all;
  const PointBuffer expected = all.records(false);
  for (const PcdEncoding encoding : encodings) {
    const PcdFile file(
        pcd(all.batch(), {.encoding = encoding, .layout = PointLayout::packed(all.fields), .points = all.settings}));
    const std::vector<std::vector<double>> columns = file.columns();
    REQUIRE(columns.size() == point_columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      CAPTURE(all.fields[k].name);
      CHECK(file.header.at("FIELDS")[k] == all.fields[k].name);
      for (std::size_t i = 0; i < 2; ++i) {
        const double value = expected.number(i, expected.layout().fields[k]);
        CHECK((columns[k][i] == value || (std::isnan(columns[k][i]) && std::isnan(value))));
      }
    }
  }
}

TEST_CASE("a header names fields, sizes, types and the number of points, and the records follow it") {
  const std::string bytes = pcd(TwoEchoes().batch(), {.layout = layouts::velodyne()});
  const std::string blanks(2 * 19, ' ');
  const std::string header =
      "# .PCD v0.7 - Point Cloud Data file format" + blanks +
      "\nVERSION 0.7\nFIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
  REQUIRE(bytes.size() == header.size() + 2 * 22);
  CHECK(bytes.substr(0, header.size()) == header);
  const std::vector<std::vector<double>> columns = PcdFile(bytes).columns();
  CHECK((columns[0] == std::vector<double>{11, 21}));
  CHECK((columns[2] == std::vector<double>{3, 3}));
  CHECK((columns[3] == std::vector<double>{50, 1.5}));
  CHECK((columns[4] == std::vector<double>{5, 5}));
  CHECK((columns[5] == std::vector<double>{3.25, 3.25}));
}

TEST_CASE("text has a line a point, with the shortest numbers that read back the same") {
  const PointLayout layout = PointLayout::packed({{"x", NumberType::float32, column("x"), 0.1},
                                                  {"x_double", NumberType::float64, column("x"), 0.1},
                                                  {"object", NumberType::uint32, column("object")},
                                                  {"class", NumberType::uint8, column("classification")},
                                                  {"velocity", NumberType::float32, column("radial_velocity")}});
  const std::string bytes = pcd(TwoEchoes().batch(), {.encoding = PcdEncoding::ascii, .layout = layout});
  CHECK(PcdFile(bytes).data == "1.1 1.1 70000 6 nan\n2.1 2.1 0 0 -3.5\n");
}

TEST_CASE("compressed points are columns behind their sizes") {
  const PcdFile file(pcd(TwoEchoes().batch(), {.encoding = PcdEncoding::binary_compressed}));
  CHECK(file.header.at("DATA").at(0) == "binary_compressed");
  std::array<float, 8> numbers;
  const std::array<float, 8> expected{11, 21, 2, 2, 3, 3, 50, 1.5};
  std::array<std::uint32_t, 2> sizes;
  std::memcpy(sizes.data(), file.data.data(), sizeof sizes);
  CHECK(sizes[1] == sizeof numbers);
  CHECK(file.data.size() == 8 + sizes[0]);
  CHECK(lzf_decompress(file.data.data() + 8, sizes[0], numbers.data(), sizeof numbers) == sizeof numbers);
  CHECK(numbers == expected);
}

TEST_CASE("random records decode to the same numbers from all encodings") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomPulses pulses(1 + 40 * seed, seed);
    PointBuffer points(every_type());
    points(pulses.batch());
    for (const PcdEncoding encoding : encodings) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(encoding));
      const PcdFile file(pcd(pulses.batch(), {.encoding = encoding, .layout = every_type()}));
      CHECK(file.points() == points.size());
      const std::vector<std::vector<double>> columns = file.columns();
      std::size_t wrong = 0;
      for (std::size_t k = 0; k < columns.size(); ++k) {
        REQUIRE(columns[k].size() == points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double number = points.number(i, points.layout().fields[k]);
          wrong += !(columns[k][i] == number || (std::isnan(columns[k][i]) && std::isnan(number)));
        }
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("scans that are added one by one are one cloud, and padding is left out") {
  const RandomPulses pulses(3000, 1);
  for (const PcdEncoding encoding : encodings) {
    CAPTURE(static_cast<int>(encoding));
    const TemporaryFolder folder;
    PcdWriter writer(folder / "a.pcd", {.encoding = encoding, .layout = layouts::ouster()});
    std::vector<double> ranges, times;
    ScanSplitter splitter(PointBuffer(layouts::ouster()), 1, [&](const PointBuffer& scan) {
      for (std::size_t i = 0; i < scan.size(); ++i) {
        ranges.push_back(scan.number(i, scan.layout().fields[8]));
        times.push_back(scan.number(i, scan.layout().fields[4]));
      }
      writer.add(scan);
    });
    splitter(pulses.batch());
    splitter.close();
    writer.close();
    const PcdFile file(content(folder / "a.pcd"));
    REQUIRE(file.points() == pulses.echoes.size());
    CHECK(file.columns()[8] == ranges);
    CHECK(file.columns()[4] == times);
    CHECK(*std::max_element(times.begin(), times.end()) < 1e9);
    CHECK((file.header.at("SIZE") == std::vector<std::string>{"4", "4", "4", "4", "4", "2", "2", "2", "4"}));
  }
}

TEST_CASE("a buffer of the same points gives the same bytes as their echoes") {
  const RandomPulses pulses(200, 2);
  for (const PcdEncoding encoding : encodings) {
    const TemporaryFolder folder;
    PointBuffer points(every_type());
    points(pulses.batch());
    PcdWriter writer(folder / "a.pcd", {.encoding = encoding, .layout = every_type()});
    writer.add(points);
    writer.close();
    CHECK(content(folder / "a.pcd") == pcd(pulses.batch(), {.encoding = encoding, .layout = every_type()}));
  }
}

TEST_CASE("a cloud without points has a header that says so") {
  for (const PcdEncoding encoding : encodings) {
    const PcdFile file(pcd({}, {.encoding = encoding}));
    CHECK(file.points() == 0);
    CHECK(file.header.at("WIDTH").at(0) == "0");
    CHECK(file.columns() == std::vector<std::vector<double>>(4));
    CHECK(file.data.size() == (encoding == PcdEncoding::binary_compressed ? 8 : 0));
  }
}

TEST_CASE("coordinates count from the origin of the settings, so that single precision keeps them") {
  TwoEchoes two;
  two.shots[0].origin = {477'000.125, 5'429'000.25, 300};
  const std::string bytes = pcd(two.batch(), {.points = {.origin = {477'000, 5'429'000, 0}}});
  const PcdFile file(bytes);
  CHECK((file.columns()[0] == std::vector<double>{10.125, 20.125}));
  CHECK((file.columns()[1] == std::vector<double>{0.25, 0.25}));
  CHECK(bytes.find("\n# origin of x, y, z [m]: 477000 5429000 0\nVERSION") != bytes.npos);
}

TEST_CASE("without close there is no file, and a former one stays") {
  const TemporaryFolder folder;
  const auto begin = [&] {
    PcdWriter writer(folder / "a.pcd");
    writer(TwoEchoes().batch());
  };
  begin();
  CHECK(folder.empty());
  PcdWriter(folder / "a.pcd").close();
  const std::string former = content(folder / "a.pcd");
  begin();
  CHECK(content(folder / "a.pcd") == former);
  CHECK_THROWS_AS(PcdWriter(folder / "none" / "a.pcd"), FileError);
}

TEST_CASE("settings and buffers that do not fit are refused, and leave no file") {
  const TemporaryFolder folder;
  const auto refused = [&](const PcdSettings& settings) {
    return refused_field([&] { PcdWriter(folder / "a.pcd", settings); });
  };
  const auto named = [](const std::string& name) {
    return PcdSettings{.layout = PointLayout::packed({{"x", NumberType::float32}, {name, NumberType::float32}})};
  };
  CHECK(refused({.encoding = static_cast<PcdEncoding>(3)}) == "PcdSettings::encoding");
  CHECK(refused({.layout = {}}) == "PointLayout::size");
  CHECK(refused({.points = {.start_time = std::numeric_limits<double>::infinity()}}) == "PointSettings::start_time");
  CHECK(refused(named("")) == "PointField::name (length)");
  CHECK(refused(named("a b")) == "PointField::name (character code)");
  CHECK(refused(named("a\n")) == "PointField::name (character code)");
  CHECK(refused(named("\xC3\xA4")) == "PointField::name (character code)");
  CHECK(refused(named("x")) == "PointField::name (number of x)");
  CHECK(refused(named("y")).empty());
  PcdWriter writer(folder / "a.pcd", {.layout = layouts::velodyne()});
  CHECK(refused_field([&] { writer.add(PointBuffer(layouts::xyzi())); }) == "PointBuffer::layout (index of a field)");
  CHECK(refused_field([&] { writer.add(PointBuffer(layouts::hesai())); }) == "PointBuffer::layout (index of a field)");
  CHECK(refused_field([&] { writer.add(PointBuffer(layouts::velodyne())); }).empty());
}

TEST_CASE("what LZF can take has sizes of 32 bits, before and after") {
  CHECK(detail::lzf_room(detail::lzf_size_max) <= std::numeric_limits<std::uint32_t>::max());
  CHECK(detail::lzf_room(detail::lzf_size_max + 1) > std::numeric_limits<std::uint32_t>::max());
  support::Generator random(3);
  for (std::size_t size = 1; size < 5000; size = size * 5 / 4 + 1) {  // bytes that nothing compresses
    CAPTURE(size);
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.whole(256));
    const std::vector<std::byte> compressed = detail::pcd_compressed(bytes);
    std::vector<std::byte> again(size);
    REQUIRE(compressed.size() > 8);
    CHECK(lzf_decompress(compressed.data() + 8, static_cast<unsigned>(compressed.size() - 8), again.data(),
                         static_cast<unsigned>(size)) == size);
    CHECK(again == bytes);
  }
}

}  // namespace
}  // namespace pulsecast::io
