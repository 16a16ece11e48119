// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/scene_cache.hpp>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::support;

namespace {

/// A geometry that says nothing of what it holds.
struct Secretive {
  const Box& bounds() const noexcept { return box; }
  std::size_t memory() const noexcept { return 0; }
  std::size_t material_count() const noexcept { return 1; }
  void closest(const RayBundle&, ClosestHits&) const noexcept {}
  SurfaceInteraction surface(PrimitiveIndex, const RayBundle&, std::size_t) const noexcept { return {}; }
  Box box;
};

static_assert(Archived<TriangleMesh<>> && Archived<TriangleMesh<KdTree<>>> && Archived<TriangleMesh<Linear<double>>>);
static_assert(Geometry<Secretive> && !Archived<Secretive>);
static_assert(CacheableScene<Scene<TriangleMesh<>, TriangleMesh<Linear<>>>>);
static_assert(!CacheableScene<Scene<TriangleMesh<>, Secretive>>);
static_assert(CacheableScene<MovingScene<TriangleMesh<>>>);

using Mixed = Scene<TriangleMesh<>, TriangleMesh<KdTree<>>, TriangleMesh<Linear<>>, TriangleMesh<KdTree<double>>>;
using Small = Scene<TriangleMesh<KdTree<>>, TriangleMesh<Linear<>>>;

const TemporaryFolder folder;
const std::filesystem::path path = folder / "scene.cache";
constexpr Fingerprint key{1, 2};

MeshData some_mesh(std::uint64_t seed, std::size_t triangles = 40) {
  Generator random(seed);
  MeshData mesh = soup(random, triangles, 10);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.materials.push_back(static_cast<std::uint32_t>(i % 3));
  return mesh;
}

MaterialTable some_materials() {
  const auto spectrum =
      std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.5e-6, 0.1}, {1e-6, 0.4}, {2e-6, 0.2}});
  return material_table({{.name = "bark", .spectrum = spectrum},
                         {.name = "leaf", .reflectance = 0.7, .law = Phong{0.2, 10}, .classification = 5},
                         {.name = "moss", .ground = true, .spectrum = spectrum}});
}

template <class Shape>
std::shared_ptr<const Shape> shared(const MeshData& mesh) {
  return std::make_shared<const Shape>(mesh);
}

/// Parts that share shapes and materials, and one that does not.
template <class S, class First, class Second>
S some_scene() {
  Generator random(5);
  const auto first = shared<First>(some_mesh(1));
  const auto second = shared<Second>(some_mesh(2));
  const MaterialTable materials = some_materials(), others = some_materials();
  std::vector<typename S::Part> parts;
  for (ObjectId i = 0; i < 6; ++i) {
    const Placement placement{
        .rotation = random.rotation(), .scale = random.log_uniform(0.5, 2), .translation = random.point(20)};
    typename S::Part part{.geometry = first,
                          .materials = materials,
                          .placement = placement,
                          .object = 100 + i,
                          .name = "part " + std::to_string(i)};
    if (i % 2 == 1) part.geometry = second;
    if (i == 5) {
      part.materials = others;
      part.placement = {};
      part.name.clear();
    }
    parts.push_back(part);
  }
  return S(std::move(parts));
}

Small small_scene() { return some_scene<Small, TriangleMesh<KdTree<>>, TriangleMesh<Linear<>>>(); }

/// A file of a few hundred bytes.
std::vector<Small::Part> smallest_parts() {
  const MeshData mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}, {{0, 1, 2}, {1, 2, 3}}, {}};
  return {{.geometry = shared<TriangleMesh<KdTree<>>>(mesh), .name = "triangle"}};
}
Small smallest_scene() { return Small(smallest_parts()); }

/// How many of all that rays in all directions meet differs, in any bit.
template <class S>
std::size_t differences(const S& a, const S& b, std::size_t& met) {
  Generator random(9);
  std::size_t different = 0;
  for (int i = 0; i < 2000; ++i) {
    RayBundle rays = random.cone(random.point(30), random.unit(), 0.3, 19);
    rays.wavelength = random.uniform(0.4e-6, 2.2e-6);
    std::array<Hit, 19> of_a, of_b;
    a.closest(rays, of_a);
    b.closest(rays, of_b);
    for (std::size_t j = 0; j < rays.size; ++j) {
      met += of_a[j].met() ? 1 : 0;
      const bool same = of_a[j].range == of_b[j].range && of_a[j].cos_incidence == of_b[j].cos_incidence &&
                        of_a[j].backscatter == of_b[j].backscatter && of_a[j].object == of_b[j].object &&
                        of_a[j].classification == of_b[j].classification;
      different += same ? 0 : 1;
    }
  }
  return different;
}

void write(const std::filesystem::path& to, const std::string& bytes) { std::ofstream(to, std::ios::binary) << bytes; }

/// What is said of a cache that holds these bytes; empty if it is taken.
template <class S = Small>
std::string refusal(const std::string& bytes, const Fingerprint& of = key) {
  const std::filesystem::path other = folder / "other.cache";
  write(other, bytes);
  const OpenedScene<S> opened = open_scene<S>(other, of);
  REQUIRE(opened.scene.has_value() == opened.reason.empty());
  return opened.reason;
}

/// Gives a file that was tampered with the checksum that it should have.
void seal(std::string& bytes) {
  io::detail::CacheHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  Digest rest;
  rest.add(std::as_bytes(std::span(bytes)).subspan(sizeof header));
  header.checksum = io::detail::checksum_of(header, rest);
  std::memcpy(bytes.data(), &header, sizeof header);
}

}  // namespace

TEST_CASE_TEMPLATE("a scene from its cache is met in every bit as the one that was saved", Shape, TriangleMesh<>,
                   TriangleMesh<Bvh<double>>, TriangleMesh<KdTree<>>, TriangleMesh<KdTree<double>>,
                   TriangleMesh<Linear<>>) {
  using S = Scene<Shape>;
  const S scene = some_scene<S, Shape, Shape>();
  save_scene(path, scene, key);
  const OpenedScene<S> opened = open_scene<S>(path, key);
  CHECK(opened.reason == "");
  REQUIRE(opened.scene);
  std::size_t met = 0;
  CHECK(differences(scene, *opened.scene, met) == 0);
  CHECK(met > 1000);
  CHECK(opened.scene->bounds() == scene.bounds());
  const auto memory = [](const S& s) {
    return visit_shape([](const auto& shape) { return shape->memory(); }, s.parts()[0].geometry);
  };
  CHECK(memory(*opened.scene) == memory(scene));
}

TEST_CASE("every word about a part comes back, for several shapes in one scene") {
  const Mixed scene = some_scene<Mixed, TriangleMesh<>, TriangleMesh<KdTree<double>>>();
  save_scene(path, scene, key);
  const OpenedScene<Mixed> opened = open_scene<Mixed>(path, key);
  REQUIRE(opened.scene);
  std::size_t met = 0;
  CHECK(differences(scene, *opened.scene, met) == 0);
  CHECK(met > 1000);
  REQUIRE(opened.scene->parts().size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto &was = scene.parts()[i], &is = opened.scene->parts()[i];
    CHECK(is.geometry.index() == was.geometry.index());
    CHECK(is.placement.rotation == was.placement.rotation);
    CHECK(is.placement.scale == was.placement.scale);
    CHECK(is.placement.translation == was.placement.translation);
    CHECK(is.object == was.object);
    CHECK(is.name == was.name);
    REQUIRE(is.materials->size() == 3);
    for (std::size_t m = 0; m < 3; ++m) {
      const Material &a = (*was.materials)[m], &b = (*is.materials)[m];
      CHECK(b.name == a.name);
      CHECK(b.reflectance == a.reflectance);
      REQUIRE((b.law.get<Phong>() == nullptr) == (a.law.get<Phong>() == nullptr));
      if (a.law.get<Phong>()) CHECK(b.law.get<Phong>()->share == a.law.get<Phong>()->share);
      CHECK(b.classification == a.classification);
      CHECK(b.ground == a.ground);
      REQUIRE((b.spectrum == nullptr) == (a.spectrum == nullptr));
      if (a.spectrum) CHECK(b.spectrum->reflectance(0.7e-6) == a.spectrum->reflectance(0.7e-6));
    }
  }
}

TEST_CASE("height fields and grids of voxels come back, too") {
  using S = Scene<HeightField, VoxelGrid<OpaqueVoxels>, VoxelGrid<ScaledVoxels>, VoxelGrid<TransmissiveVoxels>>;
  Generator random(4);
  Raster raster{.columns = 70, .rows = 60, .first = {-35, 30}};
  for (std::uint32_t i = 0; i < raster.columns * raster.rows; ++i)
    raster.heights.push_back(static_cast<float>(random.uniform(-20, -15)));
  Raster packed{.columns = 70, .rows = 60, .first = {-35, 30}, .packed = {.scale = 0.01, .offset = -30, .missing = 0}};
  for (std::size_t i = 0; i < packed.pixels(); ++i)
    packed.packed.numbers.push_back(static_cast<std::uint16_t>(random.whole(200)));
  VoxelData voxels{.corner = {-10, -10, -10}, .edge = 0.5};
  for (std::uint32_t i = 0; i < 40; ++i)
    for (std::uint32_t j = 0; j < 40; ++j) {
      voxels.cells.push_back({i, j, static_cast<std::uint32_t>(random.whole(40))});
      const Vec3 normal = random.unit();
      voxels.normals.push_back(
          {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
      voxels.densities.push_back(static_cast<float>(random.uniform(0.1, 2)));
      voxels.scales.push_back(static_cast<float>(random.uniform(0.1, 1)));
      voxels.materials.push_back(static_cast<std::uint16_t>(random.whole(3)));
    }
  const MaterialTable materials = some_materials();
  const TransmissiveVoxels leaves{.leaf_angles = LeafAngles::planophile()};
  const S scene({{.geometry = std::make_shared<const HeightField>(raster), .materials = materials},
                 {.geometry = std::make_shared<const HeightField>(packed), .materials = materials},
                 {.geometry = std::make_shared<const VoxelGrid<OpaqueVoxels>>(voxels), .materials = materials},
                 {.geometry = std::make_shared<const VoxelGrid<ScaledVoxels>>(voxels),
                  .materials = materials,
                  .placement = {.translation = {15, 0, 0}}},
                 {.geometry = std::make_shared<const VoxelGrid<TransmissiveVoxels>>(voxels, leaves),
                  .materials = materials,
                  .placement = {.translation = {0, 15, 0}},
                  .object = 9}});
  save_scene(path, scene, key);
  const OpenedScene<S> opened = open_scene<S>(path, key);
  CHECK(opened.reason == "");
  REQUIRE(opened.scene);
  std::size_t met = 0;
  CHECK(differences(scene, *opened.scene, met) == 0);
  CHECK(met > 10'000);
  CHECK(opened.scene->bounds() == scene.bounds());
}

TEST_CASE("every law of the library comes back") {
  using S = Scene<TriangleMesh<>>;
  const SurfaceLaw laws[]{Lambert{},
                          DirectionIndependent{},
                          Phong{0.2, 12},
                          NormalizedPhong{0.3, 15},
                          Microfacet{0.4},
                          Retroreflector<Beads>{70, 0.01, {0.4}},
                          Retroreflector<CubeCorners>{300, 0, {1.5}},
                          Tabulated{SharedArray<BackscatterAtIncidence>({{0.0, 3.0}, {0.3, 1.0}, {1.2, 0.5}})}};
  std::vector<Material> materials;
  for (const SurfaceLaw& law : laws) materials.push_back({.reflectance = 0.3, .law = law});
  const S scene({{.geometry = shared<TriangleMesh<>>(some_mesh(1, 10)), .materials = material_table(materials)}});
  save_scene(folder / "laws.cache", scene, {});
  const OpenedScene<S> opened = open_scene<S>(folder / "laws.cache", {});
  REQUIRE(opened.scene);
  const std::vector<Material>& back = *opened.scene->parts()[0].materials;
  REQUIRE(back.size() == std::size(laws));
  for (std::size_t k = 0; k < back.size(); ++k) {
    CAPTURE(k);
    for (const double cosine : {0.0, 0.3, 0.95, 1.0}) {
      CHECK(back[k].backscatter(cosine, 1e-6) == materials[k].backscatter(cosine, 1e-6));
      CHECK(back[k].scattered_share(1e-6, cosine) == materials[k].scattered_share(1e-6, cosine));
    }
  }
}

TEST_CASE("laws and maps of reflectances of one's own are refused by name") {
  struct OwnLaw {
    double backscatter(double cosine, double) const noexcept { return cosine; }
    double scattered_share(double, double) const noexcept { return 1; }
  };
  struct OwnMap final : ReflectanceByTexture {
    void validate() const override {}
    const Image* picture() const noexcept override { return nullptr; }
    double reflectance(double, Vec2 texture, double) const noexcept override { return texture.x; }
  };
  using S = Scene<TriangleMesh<>>;
  for (const Material& own : {Material{.name = "snow", .law = OwnLaw{}},
                              Material{.name = "snow", .reflectance_map = std::make_shared<const OwnMap>()}}) {
    const S scene(
        {{.geometry = shared<TriangleMesh<>>(some_mesh(1, 10)), .materials = material_table({own, {}, {}, {}})}});
    CHECK_THROWS_WITH_AS(save_scene(folder / "own.cache", scene, {}),
                         doctest::Contains("'snow' has a user-defined law of scattering or map of reflectances"),
                         FileError);
  }
}

TEST_CASE("a scene that moves is made from its parts and its time") {
  using S = MovingScene<TriangleMesh<KdTree<>>>;
  const auto parts = [] {
    return std::vector<S::Part>{
        {.geometry = shared<TriangleMesh<KdTree<>>>(some_mesh(1, 10)), .materials = some_materials()}};
  };
  const std::filesystem::path cache = folder / "moving.cache";
  CHECK_FALSE(cached_scene<S>(cache, {}, parts, MovingIndexSettings{.to = 10}).from_cache);
  CHECK(cached_scene<S>(cache, {}, parts, MovingIndexSettings{.to = 10}).from_cache);

  const auto moving = [&] {
    auto some = parts();
    some[0].motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {1, 0, 0}});
    return some;
  };
  const SceneSources other{.settings = "moving"};
  const auto first = cached_scene<S>(cache, other, moving, MovingIndexSettings{.to = 10});
  const auto second = cached_scene<S>(cache, other, moving, MovingIndexSettings{.to = 10});
  if constexpr (io::detail::Restorable<PartMotion>) {
    REQUIRE(second.from_cache);
    const Tick later = Tick::of_seconds(3);
    CHECK(second.scene.placement(0, later).translation == first.scene.placement(0, later).translation);
  } else {
    CHECK(contains(first.warning, "motions of parts are not supported"));
    CHECK_FALSE(second.from_cache);
  }
}

TEST_CASE("what parts share is kept once, and shared again") {
  save_scene(path, small_scene(), key);
  const OpenedScene<Small> opened = open_scene<Small>(path, key);
  REQUIRE(opened.scene);
  const auto parts = opened.scene->parts();
  CHECK(std::get<0>(parts[0].geometry) == std::get<0>(parts[2].geometry));
  CHECK(std::get<1>(parts[1].geometry) == std::get<1>(parts[5].geometry));
  CHECK(parts[0].materials == parts[4].materials);
  CHECK(parts[0].materials != parts[5].materials);
  CHECK((*parts[0].materials)[0].spectrum == (*parts[0].materials)[2].spectrum);
  CHECK((*parts[0].materials)[0].spectrum != (*parts[5].materials)[0].spectrum);

  const auto one = shared<TriangleMesh<Linear<>>>(some_mesh(3, 2000));
  std::vector<Small::Part> copies(100, {.geometry = one, .materials = some_materials()});
  save_scene(folder / "one.cache", Small({copies[0]}), key);
  save_scene(folder / "hundred.cache", Small(copies), key);
  const auto size = [](const char* name) { return std::filesystem::file_size(folder / name); };
  CHECK(size("hundred.cache") - size("one.cache") < 100 * 400);
}

TEST_CASE("a scene outlives its file, and the cache may be replaced under it") {
  const Small scene = small_scene();
  save_scene(path, scene, key);
  const OpenedScene<Small> opened = open_scene<Small>(path, key);
  REQUIRE(opened.scene);
  const Small copy = *opened.scene;
  save_scene(path, smallest_scene(), key);
  std::size_t met = 0;
  CHECK(differences(scene, copy, met) == 0);
  std::filesystem::remove(path);
  CHECK(differences(scene, copy, met) == 0);
}

TEST_CASE("a cache of nothing is one of no parts") {
  save_scene(path, Small({}), key);
  const OpenedScene<Small> opened = open_scene<Small>(path, key);
  REQUIRE(opened.scene);
  CHECK(opened.scene->parts().empty());
}

TEST_CASE("whichever byte of a cache is flipped, it is noticed") {
  save_scene(path, smallest_scene(), key);
  const std::string bytes = content(path);
  REQUIRE(refusal(bytes) == "");
  std::size_t taken = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (i % 2 == 0 ? 1 : 128));
    taken += refusal(damaged).empty() ? 1 : 0;
  }
  CHECK(taken == 0);
}

TEST_CASE("wherever a cache is cut short, and when it has grown, it is noticed") {
  save_scene(path, smallest_scene(), key);
  const std::string bytes = content(path);
  std::size_t taken = 0;
  for (std::size_t length = 0; length < bytes.size(); length += length < 256 ? 1 : 5)
    taken += refusal(bytes.substr(0, length)).empty() ? 1 : 0;
  CHECK(taken == 0);
  CHECK(contains(refusal(""), "is empty"));
  CHECK(contains(refusal(bytes.substr(0, bytes.size() - 1)), "truncated"));
  CHECK(contains(refusal(bytes + '\0'), "grown"));
  CHECK(contains(refusal(std::string(1000, 'x')), "is not a scene cache"));
}

TEST_CASE("a cache of another version, other shapes or other sources is not taken") {
  save_scene(path, smallest_scene(), key);
  const std::string bytes = content(path);
  const auto with = [&](auto change) {
    std::string changed = bytes;
    io::detail::CacheHeader header;
    std::memcpy(&header, changed.data(), sizeof header);
    change(header);
    std::memcpy(changed.data(), &header, sizeof header);
    seal(changed);
    return refusal(changed);
  };
  CHECK(with([](io::detail::CacheHeader&) {}) == "");
  CHECK(contains(with([](io::detail::CacheHeader& h) { ++h.format; }), "another version"));
  CHECK(contains(with([](io::detail::CacheHeader& h) { h.order = 0x04030201; }), "another version"));
  CHECK(contains(with([](io::detail::CacheHeader& h) { h.program.low ^= 1; }), "another version"));
  CHECK(contains(refusal<Scene<TriangleMesh<KdTree<>>>>(bytes), "other shapes"));
  CHECK(contains(refusal<Scene<TriangleMesh<Linear<>>, TriangleMesh<KdTree<>>>>(bytes), "other shapes"));
  CHECK(contains(refusal(bytes, {1, 3}), "has changed"));
  CHECK(contains(open_scene<Small>(folder / "none", key).reason, "does not exist"));
  CHECK(contains(open_scene<Small>(folder.path(), key).reason, "is a directory"));
}

TEST_CASE("a cache that was forged is refused, or can be traced: no number in it leads astray") {
  save_scene(path, smallest_scene(), key);
  const std::string bytes = content(path);
  std::size_t refused = 0;
  const auto probe = [&](std::string forged) {
    seal(forged);
    write(folder / "forged.cache", forged);
    const OpenedScene<Small> opened = open_scene<Small>(folder / "forged.cache", key);
    refused += opened.scene ? 0 : 1;
    if (!opened.scene) return;
    Generator random(1);
    for (int i = 0; i < 20; ++i) {
      std::array<Hit, 5> hits;
      opened.scene->closest(random.cone(random.point(2), random.unit(), 1, 5), hits);
    }
  };
  for (std::size_t at = sizeof(io::detail::CacheHeader); at + 8 <= bytes.size(); at += 4)
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1} << 60, ~std::uint64_t{0}}) {
      CAPTURE(at);
      CAPTURE(value);
      std::string forged = bytes;
      std::memcpy(forged.data() + at, &value, at % 8 == 0 ? 8 : 4);
      probe(forged);
    }
  CHECK(refused > 200);

  std::string other_type = bytes;
  other_type[sizeof(io::detail::CacheHeader)] = static_cast<char>(other_type[sizeof(io::detail::CacheHeader)] + 1);
  seal(other_type);
  CHECK(contains(refusal(other_type), "its members are inconsistent"));
}

TEST_CASE("a material or a mesh that cannot be is refused, whatever the checksum") {
  save_scene(path, small_scene(), key);
  const auto with = [bytes = content(path)](auto was, auto is) {  // in the first place where it stands
    std::string forged = bytes, old(sizeof was, '\0');
    std::memcpy(old.data(), &was, sizeof was);
    const std::size_t at = forged.find(old, sizeof(io::detail::CacheHeader));
    REQUIRE(at != forged.npos);
    std::memcpy(forged.data() + at, &is, sizeof is);
    seal(forged);
    return refusal(forged);
  };
  CHECK(with(0.7, 0.6) == "");
  CHECK(contains(with(0.7, 1.6), "is damaged: Material::reflectance is 1.6"));
  const std::array<std::uint32_t, 3> corners = some_mesh(1).triangles[1];
  CHECK(with(corners, some_mesh(1).triangles[2]) == "");
  CHECK(contains(with(corners, std::array<std::uint32_t, 3>{0, 1, 4000}), "its members are inconsistent"));
}

TEST_CASE(
    "the key is that of the contents: it changes with every byte, the order and the settings, but not with the place") {
  write(folder / "a", "one");
  write(folder / "b", "two");
  write(folder / "empty", "");
  const auto of = [](std::vector<std::filesystem::path> files, std::string settings = {}) {
    return scene_key({std::move(files), std::move(settings)});
  };
  const Fingerprint before = of({folder / "a", folder / "b"});
  CHECK(of({folder / "a", folder / "b"}) == before);
  CHECK(of({folder / "b", folder / "a"}) != before);
  CHECK(of({folder / "a"}) != before);
  CHECK(of({folder / "a", folder / "b", folder / "empty"}) != before);
  CHECK(of({folder / "a", folder / "b"}, "up = y") != before);
  std::filesystem::rename(folder / "a", folder / "c");
  CHECK(of({folder / "c", folder / "b"}) == before);
  write(folder / "c", "onf");
  CHECK(of({folder / "c", folder / "b"}) != before);
  write(folder / "c", "onet");
  write(folder / "b", "wo");  // the same bytes in all
  CHECK(of({folder / "c", folder / "b"}) != before);
  CHECK_THROWS_WITH_AS((void)of({folder / "a"}), doctest::Contains("does not exist"), FileError);
  const SceneSources sources{.files = {folder / "a", folder / "c"}};  // of which the caller knows the contents
  CHECK(scene_key(sources, [](const auto&) {
          return Fingerprint{1, 2};
        }) == scene_key(sources, [](const auto&) {
          return Fingerprint{1, 2};
        }));
  CHECK(scene_key(sources, [](const auto&) {
          return Fingerprint{1, 2};
        }) != scene_key(sources, [](const auto&) {
          return Fingerprint{1, 3};
        }));
  CHECK(scene_key({.files = {folder / "b", folder / "c"}}, content_fingerprint) == of({folder / "b", folder / "c"}));
}

TEST_CASE("a scene is built once, and again when a source changes, the cache is damaged or a source is missing") {
  const std::filesystem::path source = folder / "source", cache = folder / "built.cache";
  write(source, "first");
  int builds = 0;
  const auto scene = [&](const std::string& settings = {}) {
    return cached_scene<Small>(cache, {.files = {source}, .settings = settings}, [&] {
      ++builds;
      return smallest_parts();
    });
  };
  const CachedScene<Small> first = scene();
  CHECK_FALSE(first.from_cache);
  CHECK(contains(first.reason, "does not exist"));
  CHECK(first.warning == "");
  const CachedScene<Small> second = scene();
  CHECK(second.from_cache);
  CHECK(second.reason == "");
  CHECK(builds == 1);

  write(source, "First");
  CHECK(contains(scene().reason, "has changed"));
  CHECK(scene().from_cache);
  CHECK(builds == 2);
  CHECK(contains(scene("up = y").reason, "has changed"));
  CHECK(scene("up = y").from_cache);
  CHECK(builds == 3);

  std::string bytes = content(cache);
  bytes[bytes.size() / 2] ^= 1;
  write(cache, bytes);
  CHECK(contains(scene("up = y").reason, "is damaged"));
  CHECK(scene("up = y").from_cache);
  CHECK(builds == 4);

  std::filesystem::remove(source);
  const CachedScene<Small> without = scene("up = y");
  CHECK_FALSE(without.from_cache);
  CHECK(contains(without.reason, "does not exist"));
  CHECK(contains(without.warning, "not saved"));
  CHECK(without.scene.parts().size() == 1);
  CHECK(builds == 5);
}

TEST_CASE("a cache that cannot be written is a warning, and what the build throws passes through") {
  const auto made =
      cached_scene<Small>(folder / "no" / "such" / "folder", {}, [] { return std::vector<Small::Part>{}; });
  CHECK_FALSE(made.from_cache);
  CHECK(contains(made.warning, "cannot be created"));
  const std::filesystem::path never = folder / "never.cache";
  CHECK_THROWS_AS(
      (void)cached_scene<Small>(never, {}, []() -> std::vector<Small::Part> { throw std::runtime_error("no"); }),
      std::runtime_error);
  CHECK_FALSE(std::filesystem::exists(never));
}
