// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/material/phong.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

/// Two streets that cross in a small town: houses with windows, parked cars, lamp posts, trees; about 50,000 triangles.
/// One street runs from south to north, the other from west to east; they cross at the origin.
namespace street {

using pulsecast::Material;
using pulsecast::MeshData;
using pulsecast::pi;
using pulsecast::Vec2;
using pulsecast::Vec3;

inline constexpr double roadway = 6;      ///< from the middle of a street to its kerbs [m]
inline constexpr double front = 9.5;      ///< from the middle of a street to the fronts of its houses [m]
inline constexpr double kerb = 0.12;      ///< height of the pavement above the roadway [m]
inline constexpr Vec2 half_size{62, 92};  ///< from the crossing to the edges of what there is [m]

/// Numbers of the materials in `materials()`.
enum MaterialIndex : std::uint32_t {
  asphalt,
  paving,
  plaster,
  brick,
  tiles,
  glass,
  frame,
  door,
  paint,
  rubber,
  metal,
  bark,
  leaf
};

/// Reflectances at 905 nm, chosen to stand apart; glass shines only when met head-on. Classes: ASPRS LAS 1.4 R15, table
/// 17; from 64 on they are its users' own, here for cars and for posts.
[[nodiscard]] inline std::vector<Material> materials() {
  std::vector<Material> all(13);
  all[asphalt] = {.name = "asphalt", .reflectance = 0.17, .classification = 11, .ground = true};
  all[paving] = {.name = "paving", .reflectance = 0.35, .classification = 2, .ground = true};
  all[plaster] = {.name = "plaster", .reflectance = 0.65, .classification = 6};
  all[brick] = {.name = "brick", .reflectance = 0.4, .classification = 6};
  all[tiles] = {.name = "tiles", .reflectance = 0.3, .classification = 6};
  all[glass] = {.name = "glass", .reflectance = 0.2, .law = pulsecast::Phong{0.9, 60}, .classification = 6};
  all[frame] = {.name = "frame", .reflectance = 0.75, .classification = 6};
  all[door] = {.name = "door", .reflectance = 0.25, .classification = 6};
  all[paint] = {.name = "paint", .reflectance = 0.5, .law = pulsecast::Phong{0.3, 20}, .classification = 64};
  all[rubber] = {.name = "rubber", .reflectance = 0.06, .classification = 64};
  all[metal] = {.name = "metal", .reflectance = 0.45, .classification = 65};
  all[bark] = {.name = "bark", .reflectance = 0.35, .classification = 5};
  all[leaf] = {.name = "leaf", .reflectance = 0.45, .classification = 5};
  return all;
}

/// The height of the ground: the roadway, which is smooth, or the pavement beyond its kerbs [m].
[[nodiscard]] inline double height(const Vec2& at) noexcept {
  const double lie = 0.012 * at.y + 0.45 * std::sin(at.y / 31) + 0.25 * std::sin(at.x / 27);
  const double beyond = std::min(std::fabs(at.x), std::fabs(at.y)) - roadway;  // the nearer street's kerb
  return lie + kerb * std::clamp(beyond / 0.02, 0.0, 1.0);
}
[[nodiscard]] inline Vec3 on(const Vec2& at) noexcept { return {at.x, at.y, height(at)}; }

/// A row of random numbers; each seed and stream give a row of their own.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint32_t stream) noexcept : seed_(seed), stream_(stream) {}

  double between(double low, double high) noexcept {
    return low + (high - low) * pulsecast::uniform({seed_, count_++, stream_, pulsecast::Purpose::scene});
  }

 private:
  std::uint64_t seed_, count_ = 0;
  std::uint32_t stream_;
};

/// A flat shape with these corners in turn.
inline void add_face(MeshData& mesh, std::initializer_list<Vec3> corners, MaterialIndex material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners);
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) {
    mesh.triangles.push_back({first, first + k, first + k + 1});
    mesh.materials.push_back(material);
  }
}

/// A rectangle that stands on its lower edge, along x.
inline void add_upright(MeshData& mesh, double left, double right, double y, double low, double high,
                        MaterialIndex material) {
  add_face(mesh, {{left, y, low}, {right, y, low}, {right, y, high}, {left, y, high}}, material);
}

/// A cone or, for equal radii, a tube, closed at its far end.
inline void add_tube(MeshData& mesh, const Vec3& from, const Vec3& to, double radius_from, double radius_to, int sides,
                     MaterialIndex material) {
  const Vec3 along = normalize(to - from);
  const Vec3 across = normalize(cross(along, std::fabs(along.z) < 0.9 ? pulsecast::axis::up : pulsecast::axis::right)),
             other = cross(along, across);
  const auto rim = [&](int k) { return std::cos(2 * pi * k / sides) * across + std::sin(2 * pi * k / sides) * other; };
  for (int k = 0; k < sides; ++k) {
    const Vec3 a = rim(k), b = rim(k + 1);
    add_face(mesh, {from + radius_from * a, from + radius_from * b, to + radius_to * b, to + radius_to * a}, material);
    add_face(mesh, {to + radius_to * a, to + radius_to * b, to}, material);
  }
}

/// The roadway and the pavements: a grid that is finer at the kerbs.
[[nodiscard]] inline MeshData ground() {
  const auto lines = [](double reach) {
    std::vector<double> all{-roadway - 0.02, -roadway, roadway, roadway + 0.02};
    for (double x = -reach; x <= reach; x += 3) all.push_back(x + (std::fabs(std::fabs(x) - roadway) < 0.1 ? 0.5 : 0));
    std::ranges::sort(all);
    return all;
  };
  MeshData mesh;
  const std::vector<double> xs = lines(half_size.x), ys = lines(half_size.y);
  for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
    for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
      const Vec2 middle{(xs[i] + xs[i + 1]) / 2, (ys[j] + ys[j + 1]) / 2};
      const bool road = std::min(std::fabs(middle.x), std::fabs(middle.y)) < roadway;
      add_face(mesh, {on({xs[i], ys[j]}), on({xs[i + 1], ys[j]}), on({xs[i + 1], ys[j + 1]}), on({xs[i], ys[j + 1]})},
               road ? asphalt : paving);
    }
  }
  return mesh;
}

/// Properties in which houses differ.
struct House {
  int bays = 4;  ///< windows in a row
  int storeys = 3;
  MaterialIndex wall = plaster;
  bool shop = false;  ///< a shop on its ground floor, behind one wide window a bay

  [[nodiscard]] double width() const noexcept { return 2.7 * bays; }  ///< [m]
};

/// What a shop of that width sells, in a room behind its windows: vases on a shelf, and taller ones before it.
inline void add_shop(MeshData& mesh, double width, double floor, double ceiling) {
  constexpr double back = 4;
  add_upright(mesh, 0, width, back, floor, ceiling, plaster);
  for (const double z : {floor, ceiling})
    add_face(mesh, {{0, 0.3, z}, {width, 0.3, z}, {width, back, z}, {0, back, z}}, paving);
  for (double x = 0.8; x < width; x += 1.3) {
    add_tube(mesh, {x, 0.8, floor}, {x, 0.8, floor + 1.1}, 0.22, 0.1, 12, door);
    add_tube(mesh, {x + 0.5, 2.4, floor}, {x + 0.5, 2.4, floor + 1.7}, 0.1, 0.3, 12, brick);
  }
  add_face(mesh, {{0, 3.2, 1.6}, {width, 3.2, 1.6}, {width, 3.8, 1.6}, {0, 3.8, 1.6}}, frame);
}

/// Its front stands on x, and it reaches to y = 9 m. In front it has windows with frames, and a door; its saddle roof
/// has a chimney. It goes down below the ground, for slopes.
[[nodiscard]] inline MeshData house(const House& kind) {
  constexpr double bay = 2.7, storey = 3.1, depth = 9, plinth = 0.4, reveal = 0.22;
  const double width = kind.width(), eaves = plinth + storey * kind.storeys;
  MeshData mesh;
  add_upright(mesh, 0, width, 0, -1.5, plinth, brick);
  add_upright(mesh, 0, width, depth, -1.5, eaves, kind.wall);
  for (int i = 0; i < kind.storeys; ++i) {
    for (int k = 0; k < kind.bays; ++k) {
      const bool entry = i == 0 && k == 1;
      const bool wide = kind.shop && i == 0 && !entry;
      const double low = plinth + storey * i, high = low + storey, left = bay * k, right = left + bay,
                   margin = wide ? 0.15 : 0.75;
      const double l = left + margin, r = right - margin,
                   sill = low + (entry  ? 0
                                 : wide ? 0.2
                                        : 0.9),
                   lintel = low + 2.5;
      add_upright(mesh, left, l, 0, low, high, kind.wall);
      add_upright(mesh, r, right, 0, low, high, kind.wall);
      add_upright(mesh, l, r, 0, lintel, high, kind.wall);
      if (!entry) add_upright(mesh, l, r, 0, low, sill, kind.wall);
      for (const double z : {sill, lintel})
        add_face(mesh, {{l, 0, z}, {r, 0, z}, {r, reveal, z}, {l, reveal, z}}, kind.wall);
      for (const double x : {l, r})
        add_face(mesh, {{x, 0, sill}, {x, reveal, sill}, {x, reveal, lintel}, {x, 0, lintel}}, kind.wall);
      add_upright(mesh, l, r, reveal, sill, lintel, entry ? door : glass);
      if (entry || wide) continue;
      const double bars = 0.8 * reveal, middle = (l + r) / 2, cross = sill + 1.05;
      add_upright(mesh, middle - 0.04, middle + 0.04, bars, sill, lintel, frame);
      add_upright(mesh, l, r, bars, cross - 0.04, cross + 0.04, frame);
    }
  }
  if (kind.shop) add_shop(mesh, width, plinth, plinth + storey);
  const double ridge = eaves + 3.4, beyond = 0.4, drop = beyond * 3.4 / (depth / 2);
  for (const double x : {0.0, width}) {
    add_face(mesh, {{x, 0, -1.5}, {x, depth, -1.5}, {x, depth, eaves}, {x, 0, eaves}}, kind.wall);
    add_face(mesh, {{x, 0, eaves}, {x, depth, eaves}, {x, depth / 2, ridge}}, kind.wall);
  }
  for (const double eave : {-beyond, depth + beyond})
    add_face(mesh,
             {{0, eave, eaves - drop}, {width, eave, eaves - drop}, {width, depth / 2, ridge}, {0, depth / 2, ridge}},
             tiles);
  for (int k = 0; k < 4; ++k) {  // chimney
    const auto corner = [&](int c) {
      return Vec3{width - 1.4 + (c % 4 == 1 || c % 4 == 2 ? 0.7 : 0), 5 + (c % 4 < 2 ? 0 : 0.7), 0};
    };
    const Vec3 low = eaves * pulsecast::axis::up, high = (ridge + 0.9) * pulsecast::axis::up;
    add_face(mesh, {corner(k) + low, corner(k + 1) + low, corner(k + 1) + high, corner(k) + high}, brick);
  }
  return mesh;
}

/// A hatchback that looks along y: rings of corners from bumper to bumper, and four wheels.
[[nodiscard]] inline MeshData car() {
  struct Ring {
    double y, sill, belt, roof;  ///< [m]
  };
  constexpr std::array<Ring, 12> rings{{{-2.05, 0.45, 0.6, 0.65},
                                        {-2.0, 0.3, 0.85, 0.95},
                                        {-1.85, 0.25, 0.92, 1.05},
                                        {-1.6, 0.22, 0.94, 1.38},
                                        {-1.2, 0.2, 0.93, 1.46},
                                        {-0.3, 0.2, 0.91, 1.48},
                                        {0.2, 0.2, 0.9, 1.42},
                                        {0.85, 0.2, 0.88, 1.0},
                                        {1.1, 0.2, 0.86, 0.93},
                                        {1.7, 0.22, 0.76, 0.84},
                                        {2.0, 0.28, 0.62, 0.68},
                                        {2.08, 0.4, 0.5, 0.55}}};
  const auto corners = [](const Ring& r) {
    const double roof = 0.85 - 0.45 * (r.roof - r.belt), end = std::fabs(r.y) > 1.9 ? 0.9 : 1.0;
    std::array<Vec3, 8> all{
        {{0.78, 0, r.sill}, {0.86, 0, 0.6 * r.sill + 0.4 * r.belt}, {0.86, 0, r.belt}, {roof, 0, r.roof - 0.04}}};
    for (std::size_t k = 0; k < 4; ++k) all[7 - k] = Vec3{-1, 1, 1} * all[k];
    for (Vec3& c : all) c = {end * c.x, r.y, c.z};
    return all;
  };
  MeshData mesh;
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    const auto a = corners(rings[i]), b = corners(rings[i + 1]);
    const bool cabin = rings[i].roof - rings[i].belt > 0.3 && rings[i + 1].roof - rings[i + 1].belt > 0.3;
    const bool screen = !cabin && std::fabs(rings[i + 1].roof - rings[i].roof) > 0.3;
    for (std::size_t k = 0; k < 8; ++k) {
      const bool window = (cabin && (k == 2 || k == 4)) || (screen && k >= 2 && k <= 4);
      add_face(mesh, {a[k], a[(k + 1) % 8], b[(k + 1) % 8], b[k]}, window ? glass : paint);
    }
  }
  for (const auto& end : {corners(rings.front()), corners(rings.back())})
    for (std::size_t k = 0; k < 3; ++k) add_face(mesh, {end[k], end[k + 1], end[6 - k], end[7 - k]}, paint);
  for (const double x : {-0.68, 0.68})
    for (const double y : {-1.3, 1.35}) add_tube(mesh, {x, y, 0.31}, {x * 1.27, y, 0.31}, 0.31, 0.31, 14, rubber);
  return mesh;
}

/// A post of 6 m with its lamp over the street, along y.
[[nodiscard]] inline MeshData lamp_post() {
  MeshData mesh;
  add_tube(mesh, {0, 0, -0.2}, {0, 0, 1.1}, 0.09, 0.09, 10, metal);
  add_tube(mesh, {0, 0, 1.1}, {0, 0, 6}, 0.06, 0.045, 8, metal);
  add_tube(mesh, {0, 0, 5.95}, {0, 1.3, 6.25}, 0.035, 0.03, 6, metal);
  add_tube(mesh, {0, 1.2, 6.27}, {0, 1.85, 6.27}, 0.12, 0.09, 8, metal);
  return mesh;
}

/// A stem, limbs, and a crown of leaves that are as large as small twigs.
[[nodiscard]] inline MeshData tree(Dice dice) {
  MeshData mesh;
  add_tube(mesh, {0, 0, -0.3}, {0, 0, 2.6}, 0.16, 0.12, 8, bark);
  for (int k = 0; k < 9; ++k) {
    const double turn = 2.4 * k,
                 reach = dice.between(1, 1.9);  // the golden angle, as in many plants. Source: Vogel 1979
    const Vec3 foot{0, 0, 2.2 + 0.05 * k};
    add_tube(mesh, foot, foot + Vec3{reach * std::cos(turn), reach * std::sin(turn), dice.between(1.2, 3.2)}, 0.06,
             0.015, 4, bark);
  }
  for (int k = 0; k < 420; ++k) {
    const double turn = 2.4 * k, z = dice.between(-1, 1), out = std::cbrt(dice.between(0.25, 1)),
                 r = std::sqrt(1 - z * z);
    const Vec3 at = Vec3{0, 0, 4.6} + out * Vec3{2.1, 2.1, 2.5} * Vec3{r * std::cos(turn), r * std::sin(turn), z};
    const double size = dice.between(0.12, 0.24);
    const Vec3 along{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 0.2)};
    const Vec3 aside{dice.between(-1, 1), dice.between(-1, 1), 1};
    const Vec3 a = size * normalize(along), b = 0.6 * cross(a, normalize(aside));
    add_face(mesh, {at - a, at + b, at + a, at - b}, leaf);
  }
  return mesh;
}

using Mesh = pulsecast::TriangleMesh<>;
using Scene = pulsecast::Scene<Mesh>;

/// Houses of six kinds.
using Houses = std::array<House, 6>;
inline constexpr Houses dwellings{House{3, 2, plaster}, House{4, 3, plaster}, House{3, 3, brick},
                                  House{5, 3, plaster}, House{4, 2, brick},   House{3, 4, plaster}};

/// The streets of a seed. The ground is object 0.
[[nodiscard]] inline std::vector<Scene::Part> parts(std::uint64_t seed, const Houses& kinds,
                                                    const pulsecast::MaterialTable& table) {
  const auto model = [](const MeshData& mesh) { return std::make_shared<const Mesh>(mesh); };
  std::vector<Scene::Part> parts;
  const auto place = [&](const std::shared_ptr<const Mesh>& shape, const Vec3& at, double turn) {
    parts.push_back({shape,
                     table,
                     {pulsecast::rotation_about(pulsecast::axis::up, turn), 1, at},
                     static_cast<pulsecast::ObjectId>(parts.size())});
  };
  place(model(ground()), {}, 0);

  Dice dice(seed, 1);
  std::vector<std::shared_ptr<const Mesh>> houses;
  for (const House& kind : kinds) houses.push_back(model(house(kind)));
  const auto post = model(lamp_post()), hatchback = model(car());
  const std::array trees{model(tree(Dice(seed, 2))), model(tree(Dice(seed, 3)))};

  // Builds one side of a street, with the houses to the left of the way from one end to the other.
  const auto build_row = [&](const Vec2& from, const Vec2& to) {
    const Vec2 along = normalize(to - from), left{-along.y, along.x};
    const double end = length(to - from), turn = std::atan2(along.y, along.x);
    for (double done = 0;;) {
      const auto k = static_cast<std::size_t>(dice.between(0, 5.999));
      const double width = kinds[k].width();
      if (done + width > end) break;
      const Vec2 middle = from + (done + width / 2) * along;
      place(houses[k], Vec3{from.x + done * along.x, from.y + done * along.y, height(middle)}, turn);
      done += width;
    }
    for (double done = 5; done < end - 2; done += 21) {
      place(post, on(from + done * along - 2.8 * left), turn + pi);
      const double kind = dice.between(0, 1), twist = dice.between(0, 6);
      if (done + 10 < end) place(trees[kind < 0.5 ? 0 : 1], on(from + (done + 10.5) * along - 2.3 * left), twist);
    }
    for (double done = 2; done < end - 4; done += dice.between(5.3, 15)) {
      const Vec2 spot = from + done * along - (front - roadway + 1.1) * left;
      const double way = dice.between(0, 1) < 0.8 ? turn + pi / 2 : turn - pi / 2, askew = dice.between(-0.03, 0.03);
      if (spot.x > 2 * front) continue;  // the arm to the east is kept clear: there cars turn
      place(hatchback, on(spot), way + askew);
    }
  };
  const double x = front, y = front, far = half_size.y - 4, near = 2 * front;
  build_row({x, far}, {x, y});
  build_row({x, -y}, {x, -far});
  build_row({-x, -far}, {-x, -y});
  build_row({-x, y}, {-x, far});
  const double side = half_size.x - 4;
  build_row({near, y}, {side, y});
  build_row({-side, y}, {-near, y});
  build_row({side, -y}, {near, -y});
  build_row({-near, -y}, {-side, -y});
  return parts;
}

[[nodiscard]] inline Scene scene(std::uint64_t seed) {
  return Scene(parts(seed, dwellings, pulsecast::material_table(materials())));
}

}  // namespace street
