// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ply.hpp>

#include <cstddef>
#include <string>

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
        wrong += vertex.x != static_cast<float>(at.x) || vertex.y != static_cast<float>(at.y) || vertex.z != static_cast<float>(at.z);
      }
    CHECK(wrong == 0);
  }
}

}  // namespace
}  // namespace pulsecast::io
