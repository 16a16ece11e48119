// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/height_field.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pulsecast/accel/linear.hpp>

#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;

static_assert(Geometry<HeightField>);
using namespace pulsecast::support;

static_assert(std::copyable<HeightField>);

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// A raster of heights by column and row.
template <class Height>
Raster raster_of(std::uint32_t columns, std::uint32_t rows, Height height, Vec2 first = {}, Vec2 pixel = {1, 1}) {
  Raster raster{.columns = columns, .rows = rows, .first = first, .pixel = pixel};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) raster.heights.push_back(static_cast<float>(height(c, r)));
  return raster;
}

/// z = 10 + x/2 - y/4 at the pixels, from (100, 200) on towards the south-east.
Raster slope() {
  return raster_of(21, 11,
                   [](std::uint32_t c, std::uint32_t r) { return 10 + (100 + 2.0 * c) / 2 - (200 - 4.0 * r) / 4; },
                   {100, 200}, {2, 4});
}

/// The raster's mesh, with its triangles numbered as the height field's are.
template <class Index>
class RasterMesh {
 public:
  explicit RasterMesh(const Raster& raster) : data_(raster.mesh()), mesh_(data_) {
    for (std::uint32_t r = 0; r + 1 < raster.rows; ++r)
      for (std::uint32_t c = 0; c + 1 < raster.columns; ++c)
        for (const int k : {0, 1})
          if (pulsecast::detail::RasterCell(raster.grid(), raster.heights.data(), c, r).has(k))
            numbers_.push_back(2 * (r * (raster.columns - 1) + c) + static_cast<PrimitiveIndex>(k));
    CHECK(numbers_.size() == mesh_.size());
  }

  [[nodiscard]] const MeshData& data() const noexcept { return data_; }
  [[nodiscard]] const std::vector<PrimitiveIndex>& numbers() const noexcept { return numbers_; }
  [[nodiscard]] const Box& bounds() const noexcept { return mesh_.bounds(); }
  [[nodiscard]] std::size_t memory() const noexcept { return mesh_.memory(); }
  [[nodiscard]] std::size_t material_count() const noexcept { return 1; }
  void closest(const RayBundle& rays, ClosestHits& nearest) const noexcept {
    mesh_.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j)
      if (nearest.met(j)) nearest.id[j] = numbers_[nearest.primitive_of(j)];
  }
  [[nodiscard]] SurfaceInteraction surface(PrimitiveIndex i, const RayBundle& rays, std::size_t j) const noexcept {
    return mesh_.surface(i, rays, j);
  }

 private:
  MeshData data_;
  TriangleMesh<Index> mesh_;
  std::vector<PrimitiveIndex> numbers_;
};

/// An archive that looks where the first array is that is not empty.
template <class Number>
struct Look {
  const Number* found = nullptr;
  template <class... Members>
  void operator()(Members&... members) {
    (see(members), ...);
  }
  void see(SharedArray<Number>& array) { found = found == nullptr ? array.data() : found; }
  void see(pulsecast::detail::PixelHeights& heights) { heights.archive(*this); }
  void see(auto&) {}
};

double range_of(const HeightField& field, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  ClosestHits nearest(rays);
  field.closest(rays, nearest);
  return nearest.met(0) ? nearest.range[0] : -1;
}

/// The height of the ground under a place; -1 if there is none.
double height_at(const HeightField& field, double x, double y) {
  const double range = range_of(field, {{x, y, 1000}, -axis::up});
  return range < 0 ? -1 : 1000 - range;
}

template <class Index>
Comparison compared(const Raster& raster, std::uint64_t seed, std::size_t times) {
  const RasterMesh<Index> mesh(raster);
  const HeightField field(raster);
  CHECK(field.bounds() == mesh.bounds());
  Generator random(seed);
  Comparison result;
  for (std::size_t time = 0; time < times; ++time)
    for (const std::size_t size : {std::size_t{1}, std::size_t{1}, std::size_t{1}, std::size_t{19}, std::size_t{64},
                                   std::size_t{random.whole(64) + 1}})
      compare(mesh, field, "HeightField", bundle(random, mesh.data(), mesh.bounds(), size), result);
  return result;
}

}  // namespace

TEST_CASE("a slope is met where it is, from above and from below") {
  const HeightField field(slope());
  CHECK(field.columns() == 21);
  CHECK(field.rows() == 11);
  CHECK(field.bounds() == Box{{100, 160, 10}, {140, 200, 40}});
  CHECK(field.material_count() == 1);
  Generator random(1);
  for (int time = 0; time < 1000; ++time) {
    const double x = random.uniform(100, 140), y = random.uniform(160, 200), z = 10 + x / 2 - y / 4;
    CAPTURE(x);
    CAPTURE(y);
    CHECK(height_at(field, x, y) == relative(z, 1e-12));
    CHECK(range_of(field, {{x, y, -50}, axis::up}) == relative(z + 50, 1e-12));
    const Vec3 from{x, y, z}, aim = normalize(random.unit() + Vec3{0, 0, 1.5});
    CHECK(range_of(field, {from + aim * 7.0, -aim}) == relative(7, 1e-11));
  }
  CHECK(height_at(field, 99.9, 180) == -1);
  CHECK(height_at(field, 120, 200.1) == -1);
  const Vec3 normal = normalize(Vec3{-0.5, 0.25, 1});
  for (const PrimitiveIndex i : {0U, 1U, 77U, 399U}) {
    CHECK(length(field.surface(i, bundle_of({}), 0).normal - normal) < 1e-12);
    CHECK(field.surface(i, bundle_of({}), 0).material_index == 0);
  }
}

TEST_CASE("rows go from north to south, and the diagonal of a cell from south-west to north-east") {
  const float heights[4] = {1, 5, 5, 2};  // north-west, north-east, south-west, south-east
  const HeightField field(raster_of(2, 2, [&](std::uint32_t c, std::uint32_t r) { return heights[2 * r + c]; }));
  CHECK(height_at(field, 0, 0) == 1);
  CHECK(height_at(field, 1, 0) == 5);
  CHECK(height_at(field, 0, -1) == 5);
  CHECK(height_at(field, 1, -1) == 2);
  CHECK(height_at(field, 0.5, -0.5) == 5);
  CHECK(height_at(field, 0.25, -0.25) == 3);    // half-way up the north-western triangle
  CHECK(height_at(field, 0.75, -0.75) == 3.5);  // and the south-eastern
  const RayBundle rays = bundle_of({{0.75, -0.75, 9}, -axis::up});
  ClosestHits nearest(rays);
  field.closest(rays, nearest);
  CHECK(nearest.primitive_of(0) == 1);
}

TEST_CASE("a missing pixel makes a hole of the triangles that it is a corner of") {
  Raster raster = raster_of(4, 4, [](std::uint32_t, std::uint32_t) { return 3; });
  raster.heights[5] = missing;  // column 1, row 1
  const HeightField field(raster);
  CHECK(field.bounds() == Box{{0, -3, 3}, {3, 0, 3}});
  CHECK(height_at(field, 0.25, -0.25) == 3);  // of its cell in the north-west the other triangle is left
  CHECK(height_at(field, 0.75, -0.75) == -1);
  CHECK(height_at(field, 1.75, -1.75) == 3);  // and in the south-east
  for (const Vec2 at : {Vec2{1.25, -0.25}, Vec2{1.75, -0.75}, Vec2{0.1, -1.5}, Vec2{0.9, -1.5}, Vec2{1.25, -1.25}})
    CHECK(height_at(field, at.x, at.y) == -1);
  CHECK(height_at(field, 2.25, -0.25) == 3);
  CHECK(height_at(field, 0.25, -2.25) == 3);
  CHECK(raster.mesh().triangles.size() == 18 - 6);
  CHECK(raster.mesh().vertices.size() == 15);
}

TEST_CASE("a pixel has the material of its two triangles, as in the mesh, in as few bits as it needs") {
  Generator random(11);
  for (const std::uint32_t materials : {2U, 3U, 16U, 17U, 256U}) {
    CAPTURE(materials);
    Raster raster = raster_of(23, 14, [&](std::uint32_t, std::uint32_t) { return random.uniform(0, 3); });
    raster.heights[40] = missing;
    for (std::size_t i = 0; i < raster.heights.size(); ++i)
      raster.materials.push_back(static_cast<std::uint8_t>(random.whole(materials)));
    raster.materials[100] = static_cast<std::uint8_t>(materials - 1);
    const HeightField field(raster);
    const RasterMesh<Bvh<float>> mesh(raster);
    CHECK(field.material_count() == materials);
    CHECK(field.is_consistent());
    for (std::size_t i = 0; i < mesh.numbers().size(); ++i)
      CHECK(field.surface(mesh.numbers()[i], bundle_of({}), 0).material_index == mesh.data().materials[i]);
    // the pixel of column 5 and row 4 has a triangle to its south-east and one to its north-west
    const std::uint32_t own = raster.materials[4 * 23 + 5];
    CHECK(field.surface(2 * (4 * 22 + 5), bundle_of({}), 0).material_index == own);
    CHECK(field.surface(2 * (3 * 22 + 4) + 1, bundle_of({}), 0).material_index == own);
  }
  Raster alike = slope();
  alike.materials.assign(alike.heights.size(), 0);
  CHECK(HeightField(alike).memory() == HeightField(slope()).memory());
}

TEST_CASE("two materials over a raster take less than a twelfth of the memory that the mesh takes") {
  Raster raster = raster_of(
      600, 600, [](std::uint32_t c, std::uint32_t r) { return 300 + 15 * std::sin(c / 9.0) * std::cos(r / 7.0); });
  for (std::uint32_t i = 0; i < 360'000; ++i) raster.materials.push_back(i / 600 / 50 % 2);
  CHECK(12 * HeightField(raster).memory() <= TriangleMesh<>(raster.mesh()).memory());
}

TEST_CASE("where all is missing nothing is met") {
  const HeightField field(raster_of(30, 20, [](std::uint32_t, std::uint32_t) { return missing; }));
  CHECK(field.bounds().empty());
  CHECK(height_at(field, 3, -3) == -1);
  CHECK(HeightField(DeserializeTag{}).bounds().empty());
}

TEST_CASE("a height field answers as the raster's mesh does, bit for bit, for a million rays") {
  Generator random(7);
  const Vec2 utm{4.7e5, 5.4e6};
  const auto rough = [&](std::uint32_t, std::uint32_t) { return random.uniform(0, 3); };
  const auto hills = [](std::uint32_t c, std::uint32_t r) { return 300 + 15 * std::sin(c / 9.0) * std::cos(r / 7.0); };
  const auto holes = [&](std::uint32_t c, std::uint32_t r) {
    return random.whole(4) == 0 ? static_cast<double>(missing) : hills(c, r);
  };
  const auto pits = [&](std::uint32_t c, std::uint32_t r) {
    return (c / 20 + r / 10) % 2 == 0 ? static_cast<double>(missing) : hills(c, r);
  };
  const auto cliffs = [](std::uint32_t c, std::uint32_t r) { return (c / 3 + r / 5) % 2 == 0 ? 0.0 : 40.0; };
  const auto flat = [](std::uint32_t, std::uint32_t) { return 7.0; };
  struct Case {
    std::string name;
    Raster raster;
  };
  const std::vector<Case> small{
      {"one cell", raster_of(2, 2, rough)},
      {"roughness", raster_of(17, 12, rough)},
      {"roughness far from the origin", raster_of(12, 17, rough, utm)},
      {"a plane", raster_of(15, 9, flat, {-7, 4})},
      {"a plane far from the origin", raster_of(9, 15, flat, utm, {0.25, 0.5})},
      {"holes", raster_of(16, 16, holes)},
      {"one column of cells", raster_of(2, 100, rough, utm)},
      {"one row of cells", raster_of(100, 2, rough)},
      {"pixels of a millimetre", raster_of(13, 13, rough, {}, {1e-3, 2e-3})},
      {"pixels of a thousand kilometres", raster_of(9, 9, rough, {}, {1e6, 1e6})},
  };
  const std::vector<Case> large{
      {"hills", raster_of(150, 200, hills)},
      {"hills far from the origin", raster_of(201, 130, hills, utm, {0.5, 2})},
      {"hills with holes", raster_of(90, 140, holes, utm)},
      {"hills with pits", raster_of(190, 140, pits)},
      {"cliffs", raster_of(97, 81, cliffs, utm)},
      {"a wide plane", raster_of(120, 130, flat)},
      {"a long strip", raster_of(1300, 5, hills, utm)},
  };
  std::uint64_t rays = 0;
  const auto check = [&](const Case& c, const Comparison& result) {
    CAPTURE(c.name);
    INFO(result.first);
    CHECK(result.different == 0);
    CHECK(result.met * 10 > result.rays);
    rays += result.rays;
  };
  for (std::size_t i = 0; i < small.size(); ++i) {
    check(small[i], compared<Linear<>>(small[i].raster, 100 + i, 50));
    check(small[i], compared<Bvh<>>(small[i].raster, 300 + i, 750));
  }
  for (std::size_t i = 0; i < large.size(); ++i) check(large[i], compared<Bvh<>>(large[i].raster, 200 + i, 80));
  CHECK(rays >= 1000000);
}

TEST_CASE("packed heights give the hits of the same heights in floating point, to the last bit") {
  struct Scale {
    double step, offset;
    std::uint16_t zero;
    std::optional<std::uint16_t> missing;
  };
  Generator random(17);
  std::size_t rays = 0, met = 0;
  for (const Scale& scale : {Scale{1, 0, 0, 0},
                             {0.01, 0, 32768, 0},
                             {0.1, -431.7, 0, 65535},
                             {1.0 / 3, 8000.123, 7, {}},
                             {0.3048, 0, 0, 33000}})
    for (const Vec2 first : {Vec2{}, Vec2{4.7e5 + 0.1, 5.4e6 + 0.3}}) {
      CAPTURE(scale.step);
      Raster packed{.columns = 61, .rows = 47, .first = first, .pixel = {9 * scale.step, 7 * scale.step}};
      packed.packed = {.scale = scale.step, .offset = scale.offset, .zero = scale.zero, .missing = scale.missing};
      for (std::size_t i = 0; i < packed.pixels(); ++i) {
        const bool hole = scale.missing && random.whole(9) == 0;
        packed.packed.numbers.push_back(hole ? *scale.missing : static_cast<std::uint16_t>(32990 + random.whole(40)));
        packed.materials.push_back(static_cast<std::uint8_t>(i % 3));
      }
      const Raster wide = packed.unpacked();
      CHECK(wide.heights.size() == packed.pixels());
      const HeightField field(packed), reference(wide);
      CHECK(field.is_consistent());
      CHECK(field.bounds() == reference.bounds());
      for (PrimitiveIndex i = 0; i < 2 * 60 * 46; ++i) {
        const Triangle a = field.triangle(i), b = reference.triangle(i);
        CHECK(std::memcmp(&a, &b, sizeof a) == 0);
        CHECK(field.surface(i, bundle_of({}), 0).material_index ==
              reference.surface(i, bundle_of({}), 0).material_index);
      }
      const MeshData mesh = packed.mesh();
      CHECK(mesh.vertices == wide.mesh().vertices);
      for (int time = 0; time < 4000; ++time) {
        const RayBundle rays_of = bundle(random, mesh, field.bounds(), time % 2 == 0 ? 1 : 19);
        ClosestHits a(rays_of), b(rays_of);
        field.closest(rays_of, a);
        reference.closest(rays_of, b);
        for (std::size_t j = 0; j < rays_of.size; ++j) {
          ++rays;
          met += b.met(j);
          if (a.range[j] != b.range[j] || a.id[j] != b.id[j]) FAIL("ray " << j << " of bundle " << time);
        }
      }
    }
  CHECK(rays > 300'000);
  CHECK(3 * met > rays);
}

TEST_CASE("packed heights take two bytes a pixel") {
  Generator random(3);
  Raster packed{.columns = 600, .rows = 600, .packed = {.scale = 0.01, .missing = 0}};
  for (std::size_t i = 0; i < packed.pixels(); ++i)
    packed.packed.numbers.push_back(static_cast<std::uint16_t>(40'000 + random.whole(300)));
  packed.packed.numbers[77] = 0;
  const HeightField wide(packed.unpacked()), field(std::move(packed));
  CHECK(wide.memory() - field.memory() == 2 * 360'000 - 301 * sizeof(float));  // of 300 heights and a missing one
}

TEST_CASE("where all packed heights are missing nothing is met, and a table that is too short is noticed") {
  const HeightField empty(
      Raster{.columns = 9, .rows = 9, .packed = {.numbers = std::vector<std::uint16_t>(81, 5), .missing = 5}});
  CHECK(empty.bounds().empty());
  CHECK(empty.is_consistent());
  CHECK(height_at(empty, 3, -3) == -1);
  std::vector<std::uint16_t> numbers(4, 0);
  for (const std::uint16_t place : std::vector<std::uint16_t>{1, 2}) {
    numbers[3] = place;
    HeightField field(Raster{.columns = 2, .rows = 2, .packed = {.numbers = {10, 11, 10, 10}}});
    const auto set = [&](auto&... members) {
      const auto change = [&](auto& member) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, pulsecast::detail::PixelHeights>) {
          auto spoil = [&](SharedArray<float>&, SharedArray<std::uint16_t>& places) {
            places = SharedArray<std::uint16_t>(numbers);
          };
          member.archive(spoil);
        }
      };
      (change(members), ...);
    };
    field.archive(set);
    CHECK(field.is_consistent() == (place == 1));
  }
}

TEST_CASE("triangles and normals are those of the mesh, bit for bit") {
  Generator random(5);
  const Raster raster = raster_of(40, 30,
                                  [&](std::uint32_t, std::uint32_t) {
                                    return random.whole(5) == 0 ? static_cast<double>(missing) : random.uniform(0, 9);
                                  },
                                  {4.7e5 + 0.1, 5.4e6 + 0.3}, {0.3, 0.7});
  const RasterMesh<Linear<>> mesh(raster);
  const HeightField field(raster);
  for (std::size_t i = 0; i < mesh.numbers().size(); ++i) {
    const Triangle expected = mesh.data().triangle(i), found = field.triangle(mesh.numbers()[i]);
    CHECK((expected.a == found.a && expected.b == found.b && expected.c == found.c));
    CHECK(mesh.surface(static_cast<PrimitiveIndex>(i), bundle_of({}), 0).normal ==
          field.surface(mesh.numbers()[i], bundle_of({}), 0).normal);
  }
}

TEST_CASE("nothing falls through the ground: not at corners, not along edges, at any slant") {
  Generator random(9);
  for (const Vec2 first : {Vec2{}, Vec2{4.7e5, 5.4e6}}) {
    const HeightField field(raster_of(
        60, 50, [&](std::uint32_t, std::uint32_t) { return random.uniform(0, 2); }, first));
    std::uint64_t escapes = 0;
    for (int time = 0; time < 20000; ++time) {
      // at whole pixels, at halves, and anywhere
      const double step = time % 3 == 0 ? 1 : time % 3 == 1 ? 0.5 : 1e-9;
      const double x = std::round(random.uniform(20, 40) / step) * step,
                   y = std::round(random.uniform(20, 30) / step) * step;
      const Vec3 aim{first.x + x, first.y - y, 1};
      const Vec3 from = aim + (random.coin() ? axis::up * random.uniform(3, 1000)
                                             : Vec3{random.uniform(-9, 9), random.uniform(-9, 9), 3});
      escapes += escaped(field, random.cone(from, normalize(aim - from), 1e-3, 1 + random.whole(8)));
    }
    CHECK(escapes == 0);
  }
}

TEST_CASE("what is left of a raster in the middle of nothing is met, however wide the nothing is") {
  // Walls of the nodes that are looked at first are sums of large numbers in single precision, off by centimetres here:
  // hence their pad.
  Generator random(11);
  for (const bool tall : {false, true})
    for (const std::uint32_t first :
         {393216U, 229376U, 475136U, 344064U, 163840U}) {  // where nodes begin, but not the largest
      CAPTURE(tall);
      CAPTURE(first);
      const std::uint32_t last = first + 4, length = 2 * first + 5;
      const auto rough = [&](std::uint32_t c, std::uint32_t r) {
        const std::uint32_t at = tall ? r : c;
        return at < first || at > last ? static_cast<double>(missing) : random.uniform(0, 3);
      };
      const double pixel = random.uniform(0.5, 1), start = 0.5 * length * pixel;
      const Raster raster = tall ? raster_of(2, length, rough, {0.5, start}, {0.9, pixel})
                                 : raster_of(length, 2, rough, {-start, 0.5}, {pixel, 0.9});
      const pulsecast::detail::RasterGrid grid = raster.grid();
      const std::vector<float> heights = raster.heights;
      const HeightField field(raster);
      std::size_t met = 0, lost = 0;
      for (int time = 0; time < 10000; ++time) {
        // level, so that the whole length is looked at, towards the first end or the last one from within millimetres
        // to centimetres of it
        const bool back = random.coin();
        const auto corner = [&](std::uint32_t on, std::uint32_t aside) {
          const std::uint32_t at = (back ? first : last - 1) + on, column = tall ? aside : at, row = tall ? at : aside;
          return grid.vertex(column, row, heights[grid.index(column, row)]);
        };
        const Vec3 end = corner(back ? 0 : 1, 1), along = corner(back ? 0 : 1, 0) - end;
        const Vec3 inwards = back ? corner(1, 0) - corner(0, 0) : corner(0, 1) - corner(1, 1);
        const Vec3 aim = end + along * random.uniform(0.1, 0.9) + inwards * random.log_uniform(1e-5, 0.05);
        const double aside = random.uniform(-1e-3, 1e-3), rise = random.uniform(-1e-6, 1e-6);
        const Vec3 direction = normalize(tall ? Vec3{aside, back ? 1 : -1, rise} : Vec3{back ? -1 : 1, aside, rise});
        const Ray ray{aim - direction * random.log_uniform(1e-6, 0.01), direction};
        const RayBundle rays = bundle_of(ray);
        ClosestHits nearest(rays);
        for (std::uint32_t c = first; c < last; ++c)
          for (const int which : {0, 1})
            intersect(
                pulsecast::detail::RasterCell(grid, heights.data(), tall ? 0 : c, tall ? c : 0).triangle(grid, which),
                2 * c + static_cast<PrimitiveIndex>(which), rays, nearest);
        if (!nearest.met(0)) continue;
        ++met;
        lost += range_of(field, ray) != nearest.range[0];
      }
      CHECK(met > 7500);
      CHECK(lost == 0);
    }
}

TEST_CASE("rays that are not numbers meet nothing and spoil nothing") {
  const HeightField field(slope());
  RayBundle rays = bundle_of({{120, 180, 100}, -axis::up});
  rays.size = 3;
  const double nothing = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  rays.set_direction(1, {nothing, nothing, nothing});
  rays.set_direction(2, {0, endless, 0});
  rays.pad();
  ClosestHits nearest(rays);
  field.closest(rays, nearest);
  CHECK(nearest.met(0));
  CHECK_FALSE(nearest.met(1));
  for (const double bad : {nothing, endless}) {
    CHECK(range_of(field, {{bad, 180, 100}, -axis::up}) == -1);
    CHECK(range_of(field, {{120, 180, bad}, -axis::up}) == -1);
    CHECK(range_of(field, {{120, 180, 100}, {bad, 0, -1}}) == -1);
    CHECK(range_of(field, {{120, 180, 100}, -axis::up, bad}) == -1);
  }
}

TEST_CASE("a height field holds less than 6 bytes a cell, and less than a tenth of what the mesh holds") {
  struct Size {
    std::uint32_t columns, rows;
  };
  Generator random(11);
  for (const auto& size : {Size{1041, 713}, {65, 65}, {1001, 1003}, {4000, 18}}) {
    const Raster raster =
        raster_of(size.columns, size.rows, [&](std::uint32_t, std::uint32_t) { return random.uniform(); });
    const HeightField field(raster);
    CAPTURE(size.columns);
    CHECK(field.memory() < 6 * std::size_t{size.columns - 1} * (size.rows - 1));
    CHECK(field.memory() > 4 * std::size_t{size.columns} * size.rows);
  }
  const Raster raster = raster_of(210, 150, [&](std::uint32_t, std::uint32_t) { return random.uniform(); });
  CHECK(HeightField(raster).memory() * 10 < TriangleMesh<>(raster.mesh()).memory());
}

TEST_CASE("a height field is the same on however many threads it is built") {
  const auto rough = [](std::uint32_t c, std::uint32_t r) {
    return c % 97 == 5 && r % 89 == 7 ? missing : static_cast<float>((c * 7919U + r * 104729U) % 1009U);
  };
  const Raster raster = raster_of(1100, 1000, rough);
  const HeightField one(raster, 1), three(raster, 3);
  CHECK(one.bounds() == three.bounds());
  Generator random(5);
  for (int time = 0; time < 2000; ++time) {
    const Ray ray{{random.uniform(0, 1100), random.uniform(-1000, 0), 1500}, normalize(random.unit() - 1.2 * axis::up)};
    REQUIRE(range_of(one, ray) == range_of(three, ray));
  }
}

TEST_CASE("a raster is taken over, not copied") {
  Raster raster = slope();
  raster.heights.shrink_to_fit();
  const float* heights = raster.heights.data();
  const HeightField field(std::move(raster));
  Look<float> look;
  HeightField copy = field;
  copy.archive(look);
  CHECK(look.found == heights);

  Raster packed{.columns = 3, .rows = 2, .packed = {.numbers = {1, 2, 3, 4, 5, 6}}};
  const std::uint16_t* numbers = packed.packed.numbers.data();
  HeightField compact(std::move(packed));
  Look<std::uint16_t> other;
  compact.archive(other);
  CHECK(other.found == numbers);
}

TEST_CASE("arrays that are not as long as the grid says are noticed") {
  const HeightField field(slope()), smaller(raster_of(5, 3, [](std::uint32_t, std::uint32_t) { return 1; }));
  CHECK(field.is_consistent());
  CHECK(smaller.is_consistent());
  CHECK_FALSE(HeightField(DeserializeTag{}).is_consistent());
  for (std::size_t from_smaller = 0; from_smaller < 9; ++from_smaller) {  // in the order of `archive`
    HeightField mixed = field, other = smaller;
    std::vector<void*> kept;
    const auto keep = [&](auto&... members) { (kept.push_back(&members), ...); };
    other.archive(keep);
    std::size_t i = 0;
    const auto replace_one = [&]<class Member>(Member& member) {
      if (i == from_smaller) member = *static_cast<Member*>(kept[i]);
      ++i;
    };
    const auto replace = [&](auto&... members) { (replace_one(members), ...); };
    mixed.archive(replace);
    CAPTURE(from_smaller);
    CHECK(mixed.is_consistent() ==
          (from_smaller >= 3 && from_smaller <= 6));  // per_metre, pad, centre and bounds are not followed anywhere
  }
}

TEST_CASE("a height field refuses what a raster's check refuses") {
  Raster raster = slope();
  raster.heights.pop_back();
  CHECK_THROWS_AS(HeightField{raster}, SettingError);
}
