// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/voxel_data.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace pulsecast;

namespace {

VoxelData two_cells() {
  VoxelData data;
  data.corner = {500000, 5400000, 100};
  data.edge = 0.5;
  data.cells = {{0, 0, 0}, {7, 2, 4294967295}};
  data.normals = {{0, 0, 1}, {0, 0, 0}};
  data.densities = {0, 3.5F};
  data.scales = {1, 0.5F};
  data.shifts = {{0, 0, 0}, {0.25F, -0.25F, 0}};
  data.materials = {0, 65535};
  return data;
}

template <class Change>
std::string refusal(Change change) {
  VoxelData data = two_cells();
  change(data);
  try {
    data.validate();
    return {};
  } catch (const SettingError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("voxels that can be are accepted, with all columns or with none") {
  CHECK(refusal([](VoxelData&) {}) == "");
  CHECK(refusal([](VoxelData& d) { d = VoxelData{.cells = {{1, 2, 3}}}; }) == "");
}

TEST_CASE("voxels that cannot be are refused, and the refusal says what is wrong") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  CHECK(refusal([&](VoxelData& d) { d.corner.y = nan; }).find("VoxelData::corner is") == 0);
  CHECK(refusal([&](VoxelData& d) { d.corner.z = -infinity; }) ==
        "VoxelData::corner is -inf m, but must be within 1e18 m of the origin");
  for (const double edge : {0.0, -1.0, nan, infinity})
    CHECK(refusal([&](VoxelData& d) { d.edge = edge; }).find("VoxelData::edge is ") == 0);
  CHECK(refusal([](VoxelData& d) { d.edge = 1e12; }) ==
        "VoxelData::cells is 4294967295, but must be a cell within 1e18 m of the origin; see entry 1");
  CHECK(refusal([](VoxelData& d) { d.cells.clear(); }) == "VoxelData::cells is 0, but must be at least one in number");
  CHECK(refusal([](VoxelData& d) { d.normals[1][2] = 0.5F; }).find("VoxelData::normals (length) is 0.5") == 0);
  CHECK(refusal([](VoxelData& d) { d.normals[0][0] = std::nanf(""); }).find("VoxelData::normals (length) is nan") == 0);
  CHECK(refusal([](VoxelData& d) { d.densities[1] = -1; }) ==
        "VoxelData::densities is -1, but must be finite and at least 0; see entry 1");
  CHECK(refusal([](VoxelData& d) {
          d.densities[1] = std::numeric_limits<float>::infinity();
        }).find("VoxelData::densities is inf") == 0);
  for (const float scale : {0.0F, -0.5F, 1.01F, std::nanf("")})
    CHECK(refusal([&](VoxelData& d) { d.scales[0] = scale; }).find("VoxelData::scales is ") == 0);
  CHECK(refusal([](VoxelData& d) {
          d.shifts[1][1] = 0.26F;
        }).find("small enough that the cube is inside its cell; see entry 1") != std::string::npos);
  CHECK(refusal([](VoxelData& d) { d.scales.clear(); }).find("VoxelData::shifts is 0.25, but") == 0);
  CHECK(refusal([](VoxelData& d) { d.shifts[0][0] = std::nanf(""); }).find("VoxelData::shifts is nan") == 0);
}

TEST_CASE("a column that is too short or too long is refused") {
  const std::string allowed = ", but must be as many as cells, 2, or none";
  CHECK(refusal([](VoxelData& d) { d.normals.pop_back(); }) == "VoxelData::normals is 1" + allowed);
  CHECK(refusal([](VoxelData& d) { d.densities.push_back(1); }) == "VoxelData::densities is 3" + allowed);
  CHECK(refusal([](VoxelData& d) { d.scales.pop_back(); }) == "VoxelData::scales is 1" + allowed);
  CHECK(refusal([](VoxelData& d) { d.shifts.push_back({}); }) == "VoxelData::shifts is 3" + allowed);
  CHECK(refusal([](VoxelData& d) { d.materials.pop_back(); }) == "VoxelData::materials is 1" + allowed);
}
