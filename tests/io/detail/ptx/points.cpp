// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/ptx/points.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/point_cloud.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;

struct Read {
  std::vector<Vec3> positions, colours;
  std::vector<std::string> warnings;
};

Read read(const std::string& text) {
  const support::TemporaryFolder folder;
  InputFile file(folder.write("a.ptx", text), "a point cloud");
  CHECK(PtxPoints::is_ptx(file));
  PtxPoints points(std::move(file));
  Read result;
  while (points.next()) {
    result.positions.push_back(points.position());
    if (points.has_colours()) result.colours.push_back(points.colour());
  }
  result.warnings = points.warnings();
  return result;
}

std::string numbers(const Vec3& v) { return text::message(v.x, ' ', v.y, ' ', v.z); }

/// Header of a scan whose axes are the columns of a matrix.
std::string header(int columns, int rows, const Matrix3& axes, const Vec3& shift) {
  std::string text = text::message(columns, '\n', rows, '\n', numbers(shift), '\n');
  for (int k = 0; k < 3; ++k) text += numbers(axes[k]) + '\n';
  for (int k = 0; k < 3; ++k) text += numbers(axes[k]) + " 0\n";
  return text + numbers(shift) + " 1\n";
}

const Matrix3 quarter{Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)};  // x to y
const std::string sound = header(2, 2, quarter, {500'000, 5'400'000, 100}) +
                          "1 0 0 0.5 255 0 51\n0 0 0 0.5 0 0 0\n0 2 0 0.25 1 2 3\n0 0 3.125 1 4 5 6\n";

TEST_CASE("points of a scan are placed by its transform, and misses are left out") {
  const Read all = read(sound);
  CHECK(all.positions ==
        std::vector<Vec3>{{500'000, 5'400'001, 100}, {499'998, 5'400'000, 100}, {500'000, 5'400'000, 103.125}});
  CHECK(all.colours == std::vector<Vec3>{{255, 0, 51}, {1, 2, 3}, {4, 5, 6}});
  CHECK(all.warnings.empty());
}

TEST_CASE("several scans follow each other, with transforms of their own") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    std::string text;
    std::vector<Vec3> expected;
    for (int scan = 0; scan < 3; ++scan) {
      const Matrix3 axes = matrix_of(random.rotation());
      const Vec3 shift = random.point(1000);
      text += header(3, 2, axes, shift);
      for (int k = 0; k < 6; ++k) {
        const Vec3 p = random.coin() ? Vec3{} : random.point(50);
        text += numbers(p) + " 0.5\r\n";
        if (p != Vec3{}) expected.push_back(axes * p + shift);
      }
    }
    const Read all = read(text);
    REQUIRE(all.positions.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) CHECK(max_norm(all.positions[k] - expected[k]) < 1e-10);
    CHECK(all.colours.empty());
  }
}

TEST_CASE("a byte order mark is skipped, and lines that end in CR alone are told") {
  CHECK(read("\xEF\xBB\xBF" + sound).positions == read(sound).positions);
  const support::TemporaryFolder folder;
  std::string text = sound;
  for (char& c : text) c = c == '\n' ? '\r' : c;
  const auto path = folder.write("a.ptx", text);
  CHECK(contains(support::file_error([&] { (void)read_point_cloud(path); }).problem(), "lines that end in CR alone"));
}

TEST_CASE("each row of the rules of PTX files is kept") {
  const auto colours = [] {
    CHECK(read(sound).colours[0] == Vec3(255, 0, 51));
    return read(sound).warnings;
  };
  const auto count = [](const std::string& text, std::size_t points) {
    return [=] {
      CHECK(read(text).positions.size() == points);
      return read(text).warnings;
    };
  };
  std::string elsewhere = sound;
  elsewhere.replace(elsewhere.find(" 100\n"), 5, " 101\n");
  const std::vector<test::FormatCase> cases{{"scan", count(sound + sound, 6)},
                                            {"transform",
                                             [] {
                                               CHECK(read(sound).positions[0] == Vec3(500'000, 5'400'001, 100));
                                               return read(sound).warnings;
                                             }},
                                            {"scanner pose", count(elsewhere, 3)},
                                            {"miss", count(sound, 3)},
                                            {"colour", colours}};
  test::check_rules(detail::ptx_rules, cases);
}

TEST_CASE("axes of the scanner that the transform does not have are noted, as of one that is zero or scales") {
  for (const Matrix3& axes : {Matrix3{1} * 0.0, Matrix3{1} * 1000.0}) {
    std::string text = header(1, 1, Matrix3{1}, {}) + "1 2 3 0.5\n";
    const std::string other = header(1, 1, axes, {});
    const auto end_of_axes = [](const std::string& of) {
      std::size_t at = 0;
      for (int line = 0; line < 6; ++line) at = of.find('\n', at) + 1;
      return at;
    };
    text = text.substr(0, end_of_axes(text)) + other.substr(end_of_axes(other)) + "1 2 3 0.5\n";
    REQUIRE(read(text).warnings.size() == 1);
    CHECK(read(text).warnings[0].find("'scanner pose': differs from the transform") != std::string::npos);
  }
}

TEST_CASE("texts of points are no PTX files") {
  const support::TemporaryFolder folder;
  for (const char* text : {"1 2 3\n4 5 6\n7 8 9\n", "2\n1 2 3\n4 5 6\n", "a\nb\n1 2 3\n", "2\n"}) {
    CAPTURE(text);
    InputFile file(folder.write("a.txt", text), "a point cloud");
    CHECK_FALSE(PtxPoints::is_ptx(file));
    CHECK(file.position() == 0);
  }
  CHECK(read(header(0, 5, quarter, {}) + sound).positions.size() == 3);
  CHECK(read_point_cloud(folder.write("a.ptx", sound), {.voxel_size = 0.5}).points == 3);
}

TEST_CASE("damaged PTX files are read or explained") {
  int explained = 0, total = 0;
  std::string problems;
  const support::TemporaryFolder folder;
  const auto attempt = [&](const std::string& text) {
    CAPTURE(text);
    const auto path = folder.write("a.ptx", text);
    ++total;
    try {
      read_point_cloud(path, {.colours = true}).voxels.validate();
    } catch (const FileError& error) {
      CHECK(error.path() == path.string());
      ++explained;
      problems += error.problem() + '\n';
    }
  };
  const std::vector<std::pair<std::string, std::string>> lies{{"2\n2\n", "2\n3\n"},
                                                              {"2\n2\n", "2\n1\n"},
                                                              {"2\n2\n", "0\n2\n"},
                                                              {"2\n2\n", "2\n2\n\n"},
                                                              {"2\n2\n", "-2\n-2\n"},
                                                              {"2\n2\n", "2\n-2\n"},
                                                              {"2\n2\n", "4000000000\n4000000000\n"},
                                                              {"2\n2\n", "1e12\n1e12\n"},
                                                              {"2\n2\n", "1.5\n2\n"},
                                                              {"2\n2\n", "nan\n2\n"},
                                                              {"2\n2\n", "0.25\n8\n"},
                                                              {" 0\n", " 1\n"},
                                                              {" 0\n", " nan\n"},
                                                              {" 0\n", "\n"},
                                                              {"100 1\n", "100 0\n"},
                                                              {"100 1\n", "100 x\n"},
                                                              {"100 1\n", "1e300 1\n"},
                                                              {"100 1\n", "\n"},
                                                              {"1 0 0 0.5 255", "nan 0 0 0.5 255"},
                                                              {"1 0 0 0.5 255", "1 0 0.5 255"},
                                                              {"1 0 0 0.5 255", "1 0 0 0.5 256"},
                                                              {"1 0 0 0.5 255", "1 0 0 0.5 -1"},
                                                              {"1 0 0 0.5 255", "1e13 0 0 0.5 255"},
                                                              {"1 0 0 0.5 255 0 51", "1 0 0 0.5"},
                                                              {"0 2 0 0.25 1 2 3", "0 2 0 0.25"},
                                                              {"0 2 0 0.25 1 2 3", "0 2"},
                                                              {"0 2 0 0.25 1 2 3", "x y z 0 0 0 0"},
                                                              {"0 2 0 0.25 1 2 3\n", ""},
                                                              {"0 0 3.125 1 4 5 6\n", "0 0 3 1 4 5 6\n5\n"},
                                                              {"0 0 3.125 1 4 5 6\n", "0 0 3 1 4 5 6\n5\n5\n"},
                                                              {"0 0 3.125 1 4 5 6\n", "0 0 3 1 4 5 6\n1 2 3 4\n"}};
  for (const auto& [from, to] : lies) {
    std::string text = sound;
    REQUIRE(text.find(from) != std::string::npos);
    attempt(text.replace(text.find(from), from.size(), to));
  }
  for (std::size_t part = 1; part < 24; ++part) attempt(sound.substr(0, sound.size() * part / 24));
  attempt("2\n2\n0 0 0\n" + std::string(3'000'000, '1'));
  CHECK(total >= 54);
  CHECK(explained >= 40);
  for (const char* problem : {"the file ends: expected", "expected columns and rows that fit into the file",
                              "is no row of an affine transform", "has too few numbers: expected 7",
                              "expected a number within 1e12", "has the colour 256"})
    CHECK_MESSAGE(contains(problems, problem), problem);
  const std::array<const char*, 8> words{"4294967295", "-1", "nan", "\xFF\xFF", "0", "\n", "1e999", " "};
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    attempt(support::spoilt(sound, 1 + seed / 25, words, random));
  }
}

}  // namespace
}  // namespace pulsecast::io
