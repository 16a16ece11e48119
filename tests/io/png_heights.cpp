// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/png_heights.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <pulsecast/io/detail/raster_rules.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/png_builder.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;
using support::grey_png;

namespace {

struct Folder {
  support::TemporaryFolder folder;
  std::filesystem::path path = folder / "dem.png";

  void put(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
  void put_world(const std::string& text) const { std::ofstream(folder / "dem.pgw", std::ios::binary) << text; }
  [[nodiscard]] std::string refusal(const PngHeightSettings& settings = {.pixel = Vec2{1, 1}}) const {
    return support::file_error([&] { (void)read_png_heights(path, settings); }).what();
  }
};

}  // namespace

TEST_CASE("grey of 16 and of 8 bits is read as it was written, and takes two bytes a pixel") {
  const Folder files;
  support::Generator random(3);
  for (const unsigned bits : {8U, 16U}) {
    std::vector<std::uint16_t> grey(300 * 200);
    for (std::uint16_t& one : grey) one = static_cast<std::uint16_t>(random.whole(std::uint64_t{1} << bits));
    files.put(grey_png(300, 200, bits, grey));
    const Raster raster = read_png_heights(files.path, {.pixel = Vec2{2, 3}});
    CHECK(raster.columns == 300);
    CHECK(raster.rows == 200);
    CHECK(raster.pixel == Vec2{2, 3});
    CHECK(raster.first == Vec2{});
    CHECK(raster.packed.numbers == grey);
    CHECK(raster.heights.empty());
    const HeightField field(raster);
    const auto [least, greatest] = std::minmax_element(grey.begin(), grey.end());
    CHECK(field.bounds().min.z == *least);
    CHECK(field.bounds().max.z == *greatest);
  }
  // compressed and filtered, by another writer
  std::vector<std::uint8_t> grey(64 * 48);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(i % 64 + i / 64);
  REQUIRE(stbi_write_png(files.path.c_str(), 64, 48, 1, grey.data(), 64) != 0);
  CHECK(read_png_heights(files.path, {.pixel = Vec2{1, 1}}).packed.numbers ==
        std::vector<std::uint16_t>(grey.begin(), grey.end()));
}

TEST_CASE("scale, offset and the grey of missing heights give heights in metres") {
  const Folder files;
  files.put(grey_png(3, 2, 16, {0, 1, 65535, 300, 1000, 300}));
  const Raster raster = read_png_heights(
      files.path,
      {.vertical_scale = 0.25, .vertical_offset = -100, .missing = 300, .pixel = Vec2{1, 1}, .first = Vec2{7, 9}});
  CHECK(raster.first == Vec2{7, 9});
  const std::vector<float> heights = raster.unpacked().heights;
  CHECK(heights[0] == -100);
  CHECK(heights[1] == -99.75F);
  CHECK(heights[2] == -100 + 65535 * 0.25F);
  CHECK(std::isnan(heights[3]));
  CHECK(heights[4] == 150);
  CHECK(std::isnan(heights[5]));
}

TEST_CASE("a world file beside the picture places its pixels, with rows to the south or to the north") {
  const Folder files;
  files.put(grey_png(3, 2, 8, {1, 2, 3, 4, 5, 6}));
  CHECK(contains(files.refusal({}), "has no place: expected a world file beside it"));
  files.put_world("0.5\n0\n0\n-2\n1000.25\n2000\n");
  Raster raster = read_png_heights(files.path);
  CHECK(raster.first == Vec2{1000.25, 2000});
  CHECK(raster.pixel == Vec2{0.5, 2});
  CHECK(raster.packed.numbers == std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6});
  files.put_world("0.5\n0\n0\n2\n1000.25\n2000\n");
  raster = read_png_heights(files.path);
  CHECK(raster.first == Vec2{1000.25, 2002});
  CHECK(raster.pixel == Vec2{0.5, 2});
  CHECK(raster.packed.numbers == std::vector<std::uint16_t>{4, 5, 6, 1, 2, 3});
  CHECK(read_png_heights(files.path, {.first = Vec2{5, 6}}).first == Vec2{5, 6});
  CHECK(read_png_heights(files.path, {.pixel = Vec2{7, 8}}).first == Vec2{});
  files.put_world("0.5\n0\n0\n-2\n");
  CHECK(contains(files.refusal({}), "dem.pgw: ends after 4 numbers"));
  files.put_world("0.000278\n0\n0\n-0.000278\n8.5\n49.5\n");
  CHECK(contains(files.refusal({}), "is it in degrees?"));
  CHECK(read_png_heights(files.path, {.pixel = Vec2{30, 30}}).pixel == Vec2{30, 30});
  files.put_world("1e-9\n0\n0\n-1\n1e15\n0\n");
  CHECK(contains(files.refusal({}), "dem.png: Raster::pixel.x is 1e-09 m"));
}

TEST_CASE("a system beside the picture tells the unit of its place, and of its heights unless these have a scale") {
  const Folder files;
  files.put(grey_png(3, 2, 8, {1, 2, 3, 4, 5, 6}));
  files.put_world("0.5\n0\n0\n-2\n1000\n2000\n");
  const auto put = [&](const std::string& system) { std::ofstream(files.folder / "dem.prj") << system; };
  const std::string feet = R"(PROJCS["x",GEOGCS["y",UNIT["Degree",0.0174]],UNIT["Foot",0.25]])";
  put(feet);
  CHECK(read_png_heights(files.path).pixel == Vec2{0.125, 0.5});
  CHECK(read_png_heights(files.path).first == Vec2{250, 500});
  CHECK(read_png_heights(files.path).packed.scale == 1);
  put(feet + R"(,VERTCS["z",UNIT["Foot",0.5]])");
  CHECK(read_png_heights(files.path).packed.scale == 0.5);
  CHECK(read_png_heights(files.path, {.vertical_scale = 2}).packed.scale == 2);
  put("GEOGCS[]");
  CHECK(contains(files.refusal({}), "projected coordinates, not degrees"));
  put("Projection UTM");
  CHECK(contains(files.refusal({}), "no well-known text"));
  CHECK(read_png_heights(files.path, {.pixel = Vec2{1, 1}}).pixel == Vec2{1, 1});
}

TEST_CASE("each chunk of the rules is refused, others are not") {
  const Folder files;
  const auto with = [&](const std::string& type, std::size_t bytes) {
    std::string png = grey_png(3, 2, 8, {1, 2, 3, 4, 5, 6});
    files.put(png.insert(33, support::png_chunk(type, std::string(bytes, '\1'))));
    (void)read_png_heights(files.path, {.pixel = Vec2{1, 1}});
    return std::vector<std::string>{};
  };
  test::check_rules(io::detail::png_rules, std::vector<test::FormatCase>{{"tRNS", [&] { return with("tRNS", 2); }},
                                                                         {"pCAL", [&] { return with("pCAL", 30); }},
                                                                         {"sCAL", [&] { return with("sCAL", 5); }},
                                                                         {"oFFs", [&] { return with("oFFs", 9); }},
                                                                         {"acTL", [&] { return with("acTL", 8); }}});
  for (const char* type : {"gAMA", "pHYs", "tEXt"}) CHECK(with(type, 9).empty());
}

TEST_CASE("pictures that are no heights are refused with a reason") {
  const Folder files;
  CHECK(contains(files.refusal(), "does not exist"));
  files.put("no picture, but the text of a letter");
  CHECK(contains(files.refusal(), "is no PNG file"));
  std::vector<std::uint8_t> colour(4 * 4 * 4, 9);
  for (const int channels : {2, 3, 4}) {
    REQUIRE(stbi_write_png(files.path.c_str(), 4, 4, channels, colour.data(), 4 * channels) != 0);
    CHECK(contains(files.refusal(), "channels of 8 bits"));
    CHECK(contains(files.refusal(), "expected grey of 8 or 16 bits"));
  }
  std::string few = grey_png(8, 8, 8, std::vector<std::uint16_t>(64, 1));
  few[24] = 4;
  files.put(few);
  CHECK(contains(files.refusal(), "has 1 channels of 4 bits"));
  files.put(grey_png(1, 9, 16, std::vector<std::uint16_t>(9, 1)));
  CHECK(contains(files.refusal(), "is of 1 x 9 pixels: expected 2 x 2 or more"));
  files.put(grey_png(9, 9, 16, std::vector<std::uint16_t>(81, 1)));
  CHECK(contains(files.refusal({.pixel = Vec2{1, 1}, .max_pixels = 80}),
                 "is of 9 x 9 pixels: expected at most 80 in all"));
  CHECK(contains(files.refusal({.missing = 1, .pixel = Vec2{1, 1}}), "has no height"));
  const auto refused = [&](const PngHeightSettings& settings) {
    try {
      (void)read_png_heights(files.path, settings);
      return std::string();
    } catch (const SettingError& error) {
      return std::string(error.what());
    }
  };
  CHECK(contains(refused({.vertical_scale = 0}), "PngHeightSettings::vertical_scale"));
  CHECK(contains(refused({.vertical_offset = 1e16}), "PngHeightSettings::vertical_offset"));
  CHECK(contains(refused({.pixel = Vec2{1, -1}}), "PngHeightSettings::pixel"));
  CHECK(contains(refused({.pixel = Vec2{1, 1}, .first = Vec2{1e16, 1}}), "PngHeightSettings::first"));
}

TEST_CASE(
    "damaged pictures are explained or read, and sizes that a file cannot hold are refused before they are allocated") {
  const Folder files;
  support::Generator random(8532);
  std::vector<std::uint16_t> grey(40 * 30);
  for (std::uint16_t& one : grey) one = static_cast<std::uint16_t>(random.whole(65536));
  const std::string whole = grey_png(40, 30, 16, grey);
  std::size_t explained = 0, read = 0;
  const auto attempt = [&](const std::string& bytes) {
    files.put(bytes);
    try {
      const Raster raster = read_png_heights(files.path, {.pixel = Vec2{1, 1}});
      raster.validate();
      ++read;
    } catch (const FileError& error) {
      CHECK(error.path() == files.path.string());
      CHECK(error.problem().size() > 10);
      ++explained;
    }
  };
  for (std::size_t end = 1; end < whole.size(); end += 41) attempt(whole.substr(0, end));
  CHECK(explained >= 58);
  CHECK(read == 0);
  // sizes that lie, from twice as many pixels to all that the format allows
  for (const std::size_t at : {std::size_t{16}, std::size_t{20}})
    for (const std::uint32_t size : {0U, 1U, 80U, 4096U, 65536U, 16'000'000U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
      std::string lying = whole;
      lying.replace(at, 4, support::big_endian(size));
      const std::size_t before = explained;
      attempt(lying);
      CHECK(explained == before + 1);
    }
  std::string huge = whole;
  huge.replace(16, 8, support::big_endian(20'000) + support::big_endian(20'000));
  files.put(huge);
  CHECK(contains(files.refusal(), "is of 20000 x 20000 pixels: expected at most 268435456 in all"));
  huge.replace(16, 8, support::big_endian(10'000) + support::big_endian(10'000));
  files.put(huge);
  CHECK(contains(files.refusal(), "claims 10000 x 10000 pixels, more than its"));
  // a wrong checksum of the header, of the pixels, and of their stream
  for (const std::size_t from_end : {std::size_t{13}, std::size_t{17}, whole.size() - 30}) {
    std::string wrong = whole;
    wrong[whole.size() - from_end] = static_cast<char>(wrong[whole.size() - from_end] ^ 1);
    attempt(wrong);
  }
  for (int time = 0; time < 400; ++time) {
    std::string spoilt = whole;
    for (int k = 0; k < 3; ++k) {
      const bool head = random.coin();
      spoilt[static_cast<std::size_t>(random.whole(head ? 60 : spoilt.size()))] = static_cast<char>(random.whole(256));
    }
    attempt(spoilt);
  }
  INFO("seed 8532");
  CHECK(explained > 200);
  CHECK(read > 20);
}
