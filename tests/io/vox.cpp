// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/vox.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::TemporaryFolder;
using Cell = std::array<std::uint32_t, 3>;

VoxelFile read(const std::string& text, const VoxelFileSettings& settings = {}) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.vox", std::ios::binary) << text;
  return read_voxel_file(folder / "a.vox", settings);
}

FileError error(const std::string& text, const VoxelFileSettings& settings = {}) {
  return support::file_error([&] { (void)read(text, settings); });
}

const std::string keys = "VOXEL SPACE\n#min_corner: 1 2 3\n#max_corner: 3 4 5\n#split: 4 4 4\n#res: 0.5 #max_pad: 2\n";
const std::string head = keys + "i j k PadBVTotal transmittance\n";

constexpr VoxelFileSettings opaque{.use = VoxelUse::opaque}, scaled{.use = VoxelUse::scaled};

TEST_CASE("transmissive voxels have the density of their rows") {
  const VoxelFile file = read(head + "0 0 0 0.5 0.25\n3 2 1 1.75 1\n1 1 1 0 1\n");
  CHECK(file.voxels.corner == Vec3{1, 2, 3});
  CHECK(file.voxels.edge == 0.5);
  CHECK(file.voxels.cells == std::vector<Cell>{{0, 0, 0}, {3, 2, 1}});  // without density, it is not there
  CHECK(file.voxels.densities == std::vector<float>{0.5f, 1.75f});
  CHECK(file.transmittances == std::vector<float>{0.25f, 1});
  CHECK(file.density_max == 2);
  CHECK(file.voxels.scales.empty());
  CHECK(file.voxels.shifts.empty());
  CHECK(file.warnings.empty());
}

TEST_CASE("voxels of unknown density are left out, with a warning") {
  for (const VoxelUse use : {VoxelUse::transmissive, VoxelUse::scaled}) {
    const VoxelFile file = read(head + "0 0 0 0.5 0\n3 2 1 NaN 0\n1 1 1 nan 0\n", {.use = use});
    CHECK(file.voxels.cells == std::vector<Cell>{{0, 0, 0}});
    REQUIRE(file.warnings.size() == 1);
    CHECK(file.warnings[0].ends_with("a.vox, line 8: a voxel has no density (NaN), one of 2: they are left out"));
  }
}

TEST_CASE("opaque voxels are those that let some light, but not all of it, pass") {
  const VoxelFile file = read(head + "0 0 0 0 0\n0 0 1 NaN 0.5\n0 0 2 1 1\n0 0 3 1 NaN\n0 1 0 9 0.999\n", opaque);
  CHECK(file.voxels.cells == std::vector<Cell>{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}});
  CHECK(file.voxels.densities.empty());
  CHECK(file.voxels.scales.empty());
  CHECK(file.transmittances == std::vector<float>{0, 0.5f, 0.999f});
  CHECK(file.warnings.empty());
}

TEST_CASE("scaled cubes are a power of their density large") {
  const std::string text = head + "0 0 0 2 0\n0 0 1 0.5 0\n0 0 2 0 0\n0 0 3 1 1\n0 1 0 3 0.5\n";
  const VoxelFile file = read(text, scaled);
  CHECK(file.voxels.cells == std::vector<Cell>{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}});
  CHECK(file.voxels.scales == std::vector<float>{1, 0.5f, 1});  // the last is denser than the maximum
  CHECK(file.transmittances == std::vector<float>{0, 0, 0.5f});
  CHECK(file.voxels.shifts.empty());
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0].ends_with(
      "a.vox: a voxel is denser than the maximum, 2 m^2/m^3, one of 1: they fill their cells"));
  CHECK(read(text, {.use = VoxelUse::scaled, .exponent = 1}).voxels.scales == std::vector<float>{1, 0.25f, 1});
  CHECK(read(text, {.use = VoxelUse::scaled, .exponent = 0}).voxels.scales == std::vector<float>{1, 1, 1, 1});
  CHECK(read(text, {.use = VoxelUse::scaled, .exponent = 1, .density_max = 4}).voxels.scales ==
        std::vector<float>{0.5f, 0.125f, 0.75f});
}

TEST_CASE("the greatest density is the file's own where nobody names one") {
  const std::string plain = "VOXEL SPACE\n#min_corner: 0 0 0\n#res: 1\ni j k PadBVTotal transmittance\n";
  const VoxelFile file = read(plain + "0 0 0 1 0\n0 0 1 4 1\n0 0 2 NaN 0\n", scaled);  // 4, though it is not opaque
  CHECK(file.density_max == 4);
  CHECK(file.voxels.scales == std::vector<float>{0.5f});
  REQUIRE(file.warnings.size() == 2);  // beside that about NaN
  CHECK(file.warnings[0].ends_with(
      "has no key 'max_pad': the largest density of its rows, 4 m^2/m^3, is that of whole cubes"));
  CHECK(error(plain + "0 0 0 0 0\n", scaled).problem() == "has no occupied voxel: expected at least one");
}

TEST_CASE("shifted cubes stay inside their cells, evenly, and depend on the seed and their cell alone") {
  std::vector<std::string> rows;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k)
        rows.push_back(std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) + " 0.25 0.5\n");
  const auto text = [&] {
    std::string all = "VOXEL SPACE\n#min_corner: 0 0 0\n#res: 1 #max_pad: 1\ni j k PadBVTotal transmittance\n";
    for (const std::string& row : rows) all += row;
    return all;
  };
  const VoxelFileSettings settings{.use = VoxelUse::scaled, .shift = 7};
  const VoxelFile file = read(text(), settings);
  REQUIRE(file.voxels.shifts.size() == 8000);
  REQUIRE(file.voxels.scales == std::vector<float>(8000, 0.5f));
  std::map<Cell, std::array<float, 3>> shifts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0, squares = 0, most = 0;
    for (std::size_t n = 0; n < 8000; ++n) {
      const double s = file.voxels.shifts[n][axis];
      sum += s;
      squares += s * s;
      most = std::max(most, std::fabs(s));
      shifts[file.voxels.cells[n]] = file.voxels.shifts[n];
    }
    CHECK(most <= 0.25);
    CHECK(most > 0.249);
    CHECK(std::fabs(sum / 8000) < 4 * 0.25 / std::sqrt(3.0 * 8000));                   // four standard errors
    CHECK(squares / 8000 == doctest::Approx(0.25 * 0.25 / 3).epsilon(0.05).scale(0));  // of an even distribution
  }
  std::reverse(rows.begin(), rows.end());
  const VoxelFile reversed = read(text(), settings);
  std::size_t different = 0;
  for (std::size_t n = 0; n < 8000; ++n) different += shifts.at(reversed.voxels.cells[n]) != reversed.voxels.shifts[n];
  CHECK(different == 0);
  const VoxelFile other = read(text(), {.use = VoxelUse::scaled, .shift = 8});
  for (std::size_t n = 0; n < 8000; ++n) different += other.voxels.shifts[n] != reversed.voxels.shifts[n];
  CHECK(different == 8000);
}

TEST_CASE("keys come in any order and spelling, with brackets or without, one or several a line") {
  for (const char* given : {"#min_corner: 1 2 3\n#res: 0.5\n", "#RES:0.5 #nsubvoxel:8 #MIN_CORNER:1 2 3\n",
                            "#res=0.5 0.5 0.5\n#min_corner: (1, 2, 3)\n",
                            "#type: TLS\n#res:\t0.5\n# a remark\n\n#min_corner: [1.0 2.0 3.0]\n"}) {
    CAPTURE(given);
    const VoxelFile file = read(std::string("VOXEL SPACE\r\n") + given + "i j k PadBVTotal\n0 1 2 3\n");
    CHECK(file.voxels.corner == Vec3{1, 2, 3});
    CHECK(file.voxels.edge == 0.5);
    CHECK(file.density_max == 3);
    CHECK(file.transmittances.empty());
  }
  CHECK(read(head + "0 0 0 1 0\n").warnings.empty());
  const VoxelFile odd = read(
      "VOXEL SPACE\n#min_corner: 1 2 3\n#max_corner: 3 4 9\n#split: 4 4 4\n#res: 0.5\ni j k PadBVTotal\n0 1 2 3\n");
  REQUIRE(odd.warnings.size() == 1);
  CHECK(odd.warnings[0].ends_with("a.vox: 'max_corner' contradicts 'min_corner', 'split' and 'res': it is ignored"));
}

TEST_CASE("columns are found by their names, and rows may have more than there are names") {
  const VoxelFile file = read(keys + "ground k transmittance i PadBVTotal j\nx 3 0.5 1 1.5 2\ny 0 1 0 0.5 1 7 8\n");
  CHECK(file.voxels.cells == std::vector<Cell>{{1, 2, 3}, {0, 1, 0}});
  CHECK(file.voxels.densities == std::vector<float>{1.5f, 0.5f});
  CHECK(file.transmittances == std::vector<float>{0.5f, 1});
}

TEST_CASE("a file of AMAPVox is read as it stands") {
  const std::filesystem::path path = support::data_folder / "crown.vox";
  const VoxelFile file = read_voxel_file(path);
  CHECK(file.voxels.corner == Vec3{-2, -2, 2});
  CHECK(file.voxels.edge == 0.25);
  CHECK(file.density_max == 2.5);
  REQUIRE(file.voxels.cells.size() == 54);
  CHECK(file.voxels.cells.front() == Cell{0, 5, 8});
  CHECK(file.voxels.densities.front() == 0.3065f);
  CHECK(file.transmittances == std::vector<float>(54, 0.5f));
  CHECK(file.warnings.empty());
  const VoxelFile cubes = read_voxel_file(path, scaled);
  CHECK(cubes.voxels.scales.front() == doctest::Approx(std::sqrt(0.3065 / 2.5)).epsilon(1e-6).scale(0));
  CHECK(read_voxel_file(path, opaque).voxels.cells == file.voxels.cells);
}

TEST_CASE("each key and column of a voxel file is read or noted by its rule") {
  const auto with = [](const std::string& key) {
    return [=] {
      return read("VOXEL SPACE\n#min_corner: 1 2 3 #res: 2 " + key + "\ni j k PadBVTotal\n0 0 1 2\n").warnings;
    };
  };
  const auto checks = [](const auto& use) {
    return [=] {
      use();
      return std::vector<std::string>{};
    };
  };
  const std::vector<test::FormatCase> cases{
      {"min_corner", checks([] {
         CHECK(read(head + "0 0 0 1 0\n").voxels.corner == Vec3{1, 2, 3});
       })},
      {"max_corner", with("#max_corner: 5 6 9 #split: 2 2 3")},
      {"split", checks([] { CHECK(error(head + "0 0 4 1 0\n").place() == "line 7, column 3"); })},
      {"res", checks([] { CHECK(read(head + "0 0 0 1 0\n").voxels.edge == 0.5); })},
      {"max_pad", checks([] { CHECK(read(head + "0 0 0 1 0\n").density_max == 2); })},
      {"lad_type = spherical", with("#lad_type: Spherical")},
      {"lad_type = *", with("#lad_type: Planophile")},
      {"columns i, j, k, PadBVTotal", checks([] {
         CHECK(read(head + "1 2 3 1 0\n").voxels.cells[0] == Cell{1, 2, 3});
       })},
      {"column transmittance", checks([] { CHECK(read(head + "0 0 0 1 0\n").transmittances[0] == 0); })},
      {"*", with("#type: TLS")}};
  test::check_rules(detail::vox_rules, cases);
  CHECK(read(keys + "#lad_type: Planophile\ni j k PadBVTotal transmittance\n0 0 0 1 0\n", opaque).warnings.empty());
}

TEST_CASE("a last row without an end is read, with a warning") {
  const VoxelFile file = read(head + "0 0 0 0.5 0\n0 0 1 0.5 0");
  CHECK(file.voxels.cells.size() == 2);
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0].ends_with("the last line has no line end: the file may be truncated"));
}

TEST_CASE("headers that cannot be right are refused, with the line") {
  const std::string names = "i j k PadBVTotal transmittance\n", row = "0 0 0 1 0.5\n";
  struct Case {
    std::string text;
    const char *place, *problem;
  };
  const std::string begin = "VOXEL SPACE\n#min_corner: 0 0 0\n";
  for (const Case& c :
       {Case{"", "", "is empty: expected a voxel file, which begins with 'VOXEL SPACE'"},
        {"ply\n", "line 1", "'ply': expected a voxel file, which begins with 'VOXEL SPACE'"},
        {"VOXEL SPACE\n", "", "has no row of column names: expected 'i j k PadBVTotal ...'"},
        {keys, "", "has no row of column names: expected 'i j k PadBVTotal ...'"},
        {head, "", "has no rows: expected at least one voxel"},
        {begin + "#res: 1\n" + row, "line 4",
         "no column is named 'i': expected a row of names, as 'i j k PadBVTotal ...'"},
        {begin + "#res: 1\ni j k PAD\n", "line 4", "no column is named 'PadBVTotal'"},
        {"VOXEL SPACE\n#res: 1\n" + names + row, "",
         "has no key 'min_corner': expected '#min_corner: x y z' above the rows"},
        {begin + names + row, "", "has no key 'res': expected '#res: edge' above the rows"},
        {begin + "#res: 0\n", "line 3", "'res' is ' 0': expected the edge of a voxel [m], above 0"},
        {begin + "#res: nan\n", "line 3", "'res' is ' nan': expected the edge"},
        {begin + "#res: 1 2\n", "line 3", "'res' is ' 1 2': expected the edge"},
        {begin + "#res: 1e13\n", "line 3", "'res' is ' 1e13': expected the edge"},
        {begin + "#res: 1 1 0.5\n", "line 3", "'res' is ' 1 1 0.5': expected voxels that are cubes"},
        {begin + "#split: 1 1\n", "line 3", "'split' is ' 1 1': expected three numbers within 1e12"},
        {begin + "#split: 1 1 0\n", "line 3", "'split' is ' 1 1 0': expected three whole numbers from 1 to 2^32"},
        {begin + "#split: 1 1 1.5\n", "line 3", "'split' is ' 1 1 1.5': expected three whole numbers"},
        {begin + "#res: 1 #Min_Corner: 1 1 1\n", "line 3", "'min_corner' stands a second time: expected each key once"},
        {begin + "#max_pad: -1\n", "line 3", "'max_pad' is ' -1': expected a number above 0"},
        {begin + "#max_corner: a b c\n", "line 3", "'max_corner' is ' a b c': expected three numbers within 1e12"}}) {
    CAPTURE(c.text);
    const FileError e = error(c.text);
    CHECK(e.place() == c.place);
    CHECK_MESSAGE(e.problem().starts_with(c.problem), e.problem());
    CHECK((c.text.empty() || e.path().ends_with("a.vox")));
  }
  CHECK(
      error(keys + "i j k PadBVTotal\n0 0 0 1\n", opaque).problem().starts_with("no column is named 'transmittance'"));
}

TEST_CASE("rows that cannot be right are refused, with line and column") {
  struct Case {
    const char *row, *place, *problem;
  };
  for (const Case& c :
       {Case{"0 0 0 1\n", "line 10", "has 4 columns: expected 5"},
        {"-1 0 0 1 0\n", "line 10, column 1", "'-1': expected a whole number from 0 to 2^32 - 1"},
        {"0 1.5 0 1 0\n", "line 10, column 2", "'1.5': expected a whole number"},
        {"0 0 4294967296 1 0\n", "line 10, column 3", "'4294967296': expected a whole number"},
        {"0 0 4 1 0\n", "line 10, column 3", "'4': expected less than the 4 voxels that 'split' gives"},
        {"0 0 1 -0.5 0\n", "line 10, column 4", "'-0.5': expected a density from 0 to 1e12"},
        {"0 0 1 inf 0\n", "line 10, column 4", "'inf': expected a number, with a decimal point, or NaN"},
        {"0 0 1 2e12 0\n", "line 10, column 4", "'2e12': expected a density from 0 to 1e12"},
        {"0 0 1 1 x\n", "line 10, column 5", "'x': expected a number, with a decimal point, or NaN"},
        {"0 0 0 1 0\n", "line 10", "the voxel 0 0 0 is repeated: expected each voxel once"}}) {
    CAPTURE(c.row);
    const FileError e = error(head + "# a remark\n0 0 0 1 0\n\n" + c.row);
    CHECK(e.place() == c.place);
    CHECK_MESSAGE(e.problem().starts_with(c.problem), e.problem());
  }
  const FileError far =
      error("VOXEL SPACE\n#min_corner: 0 0 0\n#res: 1e6\ni j k PadBVTotal\n0 1000000 0 1\n0 1000001 0 1\n");
  CHECK(far.place() == "line 6");
  CHECK(far.problem() == "the voxel 0 1000001 0 is beyond 1e12 m: expected coordinates up to 1e12 m");
  const FileError fine = error("VOXEL SPACE\n#res: 1e-9\n#min_corner: 0 0 -1e12\ni j k PadBVTotal\n0 0 0 1\n");
  CHECK(fine.place() == "line 2");
  CHECK_MESSAGE(fine.problem().starts_with("'res' is 1e-09: expected at least 0.00088"), fine.problem());
  CHECK(error(head + "0 0 0 0 1\n").problem() == "has no occupied voxel: expected at least one");
  CHECK(error(head + "0 0 0 1 1\n", opaque).problem() == "has no occupied voxel: expected at least one");
}

TEST_CASE("settings that cannot be are refused") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const VoxelFileSettings& settings :
       {VoxelFileSettings{.exponent = -1}, {.exponent = nan}, {.density_max = 0}, {.density_max = nan}})
    CHECK_THROWS_AS((void)read(head + "0 0 0 1 0\n", settings), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
