// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ply.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <doctest/doctest.h>
#include <assimp/Importer.hpp>

#include "support/random_pulses.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

TEST_CASE("Assimp reads the points of a PLY file, in double and in single precision") {
  const support::RandomPulses pulses(2000, 5);
  for (const PointLayout& layout : {layouts::map(), layouts::velodyne().with(layouts::labels())}) {
    CAPTURE(layout.fields.back().name);
    const support::TemporaryFolder folder;
    PlyWriter writer(folder / "a.ply", {.layout = layout});
    writer(pulses.batch());
    writer.close();
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile((folder / "a.ply").string(), 0);
    REQUIRE(scene != nullptr);
    REQUIRE(scene->mNumMeshes == 1);
    const aiMesh& mesh = *scene->mMeshes[0];
    CHECK(mesh.mPrimitiveTypes == aiPrimitiveType_POINT);
    REQUIRE(mesh.mNumVertices == pulses.echoes.size());
    std::size_t i = 0, wrong = 0;
    for (const Shot& shot : pulses.shots)
      for (const Echo& echo : pulses.batch().echoes_of(shot)) {
        const Vec3 at = point_of(shot, echo);
        const aiVector3D& vertex = mesh.mVertices[i++];
        wrong += vertex.x != static_cast<float>(at.x) || vertex.y != static_cast<float>(at.y) ||
                 vertex.z != static_cast<float>(at.z);
      }
    CHECK(wrong == 0);
  }
}

TEST_CASE("Assimp reads the colours of points, of 8 and of 16 bits") {
  const support::RandomPulses pulses(2000, 5);
  const auto colour = [](const EchoBatch&, const Shot& shot, const Echo& echo) {
    const auto level = [](std::uint64_t n) { return static_cast<std::uint16_t>(257 * (n % 256)); };
    return PointColour{level(shot.index), level(7 * shot.index + echo.number), level(echo.number)};
  };
  std::vector<PointField> deep = layouts::deep_colours();
  deep.pop_back();  // without the near infrared
  for (const std::vector<PointField>& fields : {layouts::colours(), deep}) {
    CAPTURE(size_of(fields[0].type));
    const support::TemporaryFolder folder;
    PlyWriter writer(folder / "a.ply", {.layout = layouts::map().with(fields), .points = {.colours = colour}});
    writer(pulses.batch());
    writer.close();
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile((folder / "a.ply").string(), 0);
    REQUIRE(scene != nullptr);
    const aiMesh& mesh = *scene->mMeshes[0];
    REQUIRE(mesh.HasVertexColors(0));
    std::size_t i = 0, wrong = 0;
    for (const Shot& shot : pulses.shots)
      for (const Echo& echo : pulses.batch().echoes_of(shot)) {
        const PointColour expected = colour(pulses.batch(), shot, echo);
        const aiColor4D& read = mesh.mColors[0][i++];
        const auto is = [](float share, std::uint16_t level) {
          return std::fabs(share - static_cast<float>(level) / 65535) < 1e-6F;
        };
        wrong += !is(read.r, expected.red) || !is(read.g, expected.green) || !is(read.b, expected.blue);
      }
    CHECK(i == pulses.echoes.size());
    CHECK(wrong == 0);
  }
}

}  // namespace
}  // namespace pulsecast::io
