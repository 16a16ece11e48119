// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/ply/file.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/io/point_cloud.hpp>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/ply_builder.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::ply_triangle;
using support::PlyBuilder;
using Numbers = std::vector<double>;

/// What a mesh reader and a reader of points say to a file: nothing, or their problems.
struct Tally {
  int read = 0, explained = 0;
  std::string problems{};

  void operator()(const std::string& bytes) {
    const support::TemporaryFolder folder;
    const auto path = folder.write("a.ply", bytes);
    const auto attempt = [&](const auto& reading) {
      try {
        reading();
        ++read;
      } catch (const FileError& error) {
        CHECK(error.path() == path.string());
        ++explained;
        problems += error.problem() + '\n';
      }
    };
    attempt([&] {
      for (const FileMesh& one : read_mesh_file(path, {.texture = true}).meshes) one.mesh.validate();
    });
    attempt([&] { read_point_cloud(path, {.normals = VoxelNormals::mean, .colours = true}).voxels.validate(); });
  }
};

TEST_CASE("a byte order mark is skipped, and header lines that end in CR alone are told") {
  const support::TemporaryFolder folder;
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    CAPTURE(format);
    std::string bytes = ply_triangle().bytes(format);
    CHECK(read_mesh_file(folder.write("a.ply", "\xEF\xBB\xBF" + bytes)).meshes.at(0).mesh.triangles.size() == 1);
    for (std::size_t k = bytes.find("end_header") + 10; k < bytes.size(); --k)
      if (bytes[k] == '\n') bytes[k] = '\r';
    const auto path = folder.write("a.ply", bytes);
    CHECK(contains(support::file_error([&] { (void)read_mesh_file(path); }).problem(), "lines that end in CR alone"));
  }
}

TEST_CASE("rows are read one after the other, those of other elements are passed over") {
  PlyBuilder ply = ply_triangle();
  ply.elements.insert(ply.elements.begin(),
                      {"a", {"list uchar short many", "double one"}, {{2, -5, 6, 0.5}, {0, 1.5}}});
  const support::TemporaryFolder folder;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    CAPTURE(format);
    detail::PlyFile file(InputFile(folder.write("a.ply", ply.bytes(format)), "a mesh"));
    REQUIRE(file.elements().size() == 3);
    REQUIRE(file.next_element());
    REQUIRE(file.next());
    CHECK(file.list(0) == Numbers{-5, 6});
    CHECK(file.number(1) == 0.5);
    REQUIRE(file.next_element());
    CHECK(file.element().name == "vertex");
    REQUIRE(file.next());
    CHECK(file.number(2) == 5);
    REQUIRE(file.next_element());
    REQUIRE(file.next());
    CHECK(file.list(0) == Numbers{0, 1, 2});
    CHECK_FALSE(file.next());
    CHECK_FALSE(file.next_element());
    CHECK_FALSE(file.next());
  }
}

TEST_CASE("lines of a header may end as on any system, and have blanks") {
  std::string text = ply_triangle().bytes();
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string(" \r\n") : std::string(1, c);
  const support::TemporaryFolder folder;
  CHECK(read_mesh_file(folder.write("a.ply", windows)).triangle_count() == 1);
  CHECK(read_mesh_file(folder.write("a.ply", text + "\n\n")).triangle_count() == 1);
}

TEST_CASE("PLY files that are damaged are read or explained") {
  const std::string sound = ply_triangle().bytes(), little = ply_triangle().bytes("binary_little_endian");
  const std::vector<std::pair<std::string, std::string>> lies{
      {"vertex 3", "vertex 4"},
      {"vertex 3", "vertex 2"},
      {"vertex 3", "vertex 0"},
      {"vertex 3", "vertex -1"},
      {"vertex 3", "vertex 18446744073709551615"},
      {"vertex 3", "vertex 4294967296"},
      {"vertex 3", "vertex 1e9"},
      {"vertex 3", "vertex 99999999999999999999999"},
      {"vertex 3", "vertex"},
      {"vertex 3", "vertex 3\nelement vertex 3"},
      {"face 1", "face 2"},
      {"face 1", "face 4000000000"},
      {"element face 1", "element face 1\nelement bomb 4000000000000000000"},
      {"element face 1", "element bomb 4000000000\nproperty list uchar uchar a\nelement face 1"},
      {"float x", "float y"},
      {"float x", "list uchar float x"},
      {"float x", "quad x"},
      {"float x", "float"},
      {"float x", "list"},
      {"float x", "list uchar"},
      {"uchar int", "float double"},
      {"uchar int", "double char"},
      {"uchar int", "char uchar"},
      {"list uchar int vertex_indices", "int vertex_indices"},
      {"vertex_indices", "vertices"},
      {"end_header", "end_heade"},
      {"end_header\n", ""},
      {"end_header\n", "end_header\r"},
      {"format", "formal"},
      {"ascii", "binary_middle_endian"},
      {"ascii", "binary_big_endian"},
      {"ascii 1.0", ""},
      {"element vertex 3\n", ""},
      {"ply\n", "ply\nproperty float x\n"},
      {"3 0 1 2", "3 0 1"},
      {"3 0 1 2", "3 0 1 2 0"},
      {"3 0 1 2", "4294967295 0 1 2"},
      {"3 0 1 2", "1e300 0 1 2"},
      {"3 0 1 2", "-3 0 1 2"},
      {"3 0 1 2", "nan 0 1 2"},
      {"3 0 1 2", "3 0 1 -1"},
      {"3 0 1 2", "3 0 1 1.5"},
      {"3 0 1 2", "3 0 1 nan"},
      {"3 0 1 2", "3 0 1 1e30"},
      {"3 0 1 2", "x 0 1 2"},
      {"3 0 5", "3 nan 5"},
      {"3 0 5", "3 1e999 5"},
      {"3 0 5", "3 1e300 5"},
      {"3 0 5", "3"},
      {"3 0 5", std::string(3, '\0')}};
  Tally tally;
  tally(sound);
  tally(little);
  CHECK(tally.read == 4);
  for (const auto& lie : lies) {
    CAPTURE(lie.second);
    std::string text = sound;
    REQUIRE(text.find(lie.first) != std::string::npos);
    tally(text.replace(text.find(lie.first), lie.first.size(), lie.second));
    text = little;
    if (text.find(lie.first) != std::string::npos)
      tally(text.replace(text.find(lie.first), lie.first.size(), lie.second));
  }
  CHECK(lies.size() >= 40);
  for (const std::string& whole : {sound, little, ply_triangle("double").bytes("binary_big_endian")})
    for (std::size_t part = 1; part < 24; ++part) tally(whole.substr(0, whole.size() * part / 24));
  tally("ply\n" + std::string(3'000'000, 'x'));
  tally("ply\nformat binary_little_endian 1.0\ncomment" + std::string(3'000'000, '\0'));
  PlyBuilder big = ply_triangle();
  big.elements[1].rows[0] = {5000};
  for (int k = 0; k < 5000; ++k) big.elements[1].rows[0].push_back(k % 3);
  big.elements[1].properties = {"list int int vertex_indices"};
  tally(big.bytes("binary_little_endian"));
  CHECK(tally.explained > 120);
  for (const char* problem :
       {"has the format", "expected no more than fit into the file's", "the file ends", "has more values than",
        "has fewer values than", "has a list of", "expected a type of numbers", "and each element once",
        "expected a line of a PLY header", "no end_header within 64 KiB", "corners, expected at most 4096"})
    CHECK_MESSAGE((contains(tally.problems, problem) || std::string(problem) == "has the format"), problem);
  CHECK(contains(tally.problems, "has the PLY format 'binary_middle_endian': expected ascii"));
  rusage used{};
  REQUIRE(::getrusage(RUSAGE_SELF, &used) == 0);
  CHECK(used.ru_maxrss < 2'000'000);  // [KiB]
}

TEST_CASE("spoilt PLY files are read or explained") {
  const std::array<const char*, 10> words{"4294967295", "-1", "nan",  "\xFF\xFF\xFF\xFF", "0", "\n", "list",
                                          "1e999",      " ",  "uchar"};
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const char* const format = seed % 3 == 0 ? "ascii" : seed % 3 == 1 ? "binary_little_endian" : "binary_big_endian";
    tally(
        support::spoilt(ply_triangle(seed % 2 == 0 ? "float" : "double").bytes(format), 1 + seed / 40, words, random));
  }
  CHECK(tally.read + tally.explained == 300);
}

}  // namespace
}  // namespace pulsecast::io
