// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/mesh_data.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

MeshData square() {
  MeshData data{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}, {3, 1}};
  data.texture = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  return data;
}

/// What the refusal of data after a change says; empty if it is accepted.
template <class Change>
std::string refusal(const Change& change) {
  MeshData data = square();
  change(data);
  try {
    data.validate();
    return {};
  } catch (const SettingError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("data of a mesh that cannot be are refused, and the refusal says what is wrong") {
  CHECK(refusal([](MeshData&) {}) == "");
  CHECK(refusal([](MeshData& m) { m = {}; }) == "MeshData::triangles is 0, but must be at least one in number");
  CHECK(refusal([](MeshData& m) { m.triangles[1][2] = 4; }) ==
        "MeshData::triangles is 4, but must be less than the number of vertices, 4; see triangle 1");
  CHECK(refusal([](MeshData& m) { m.vertices[2].y = std::numeric_limits<double>::infinity(); }) ==
        "MeshData::vertices is inf m, but must be finite; see vertex 2");
  CHECK(refusal([](MeshData& m) { m.vertices[3].z = std::numeric_limits<double>::quiet_NaN(); }) ==
        "MeshData::vertices is nan m, but must be finite; see vertex 3");
  CHECK(refusal([](MeshData& m) { m.materials.pop_back(); }) ==
        "MeshData::materials is 1, but must be as many as triangles, 2, or none");
  CHECK(refusal([](MeshData& m) { m.texture.pop_back(); }) ==
        "MeshData::texture is 1, but must be as many as triangles, 2, or none");
  CHECK(refusal([](MeshData& m) { m.texture[1][0].y = 1e31; }) ==
        "MeshData::texture is 1e+31, but must be from -1e+30 to 1e+30; see triangle 1");
}

TEST_CASE("masks need texture coordinates, and as many bits as pixels") {
  CHECK(refusal([](MeshData& m) { m.masks = {{}, {2, 1, {1}}}; }) == "");
  CHECK(refusal([](MeshData& m) {
          m.masks = {{2, 100, {1}}};
        }) == "Mask::bits (number of words) is 1, but must be from 4 to 4");
  CHECK(refusal([](MeshData& m) {
          m.masks = {{2, 1, {1}}};
          m.texture.clear();
        }) == "MeshData::texture (number) is 0, but must be one a triangle, for masks");
}

TEST_CASE("a triangle has the corners of its vertices") { CHECK(square().triangle(1).b == Vec3{2, 2, 0}); }
