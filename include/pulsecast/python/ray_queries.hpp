// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_RAY_QUERIES_HPP
#define PULSECAST_PYTHON_RAY_QUERIES_HPP

#include <pybind11/numpy.h>

#include <pulsecast/python/detail/exceptions.hpp>
#include <pulsecast/python/detail/rows.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/run_batch.hpp>

/// Ray queries of scenes for Python: arrays of rays in, arrays of hits out.
///
///     pulsecast::python::bind_ray_queries(pybind11::class_<OwnScene>(m, "OwnScene").def(...));
///
/// A call releases the GIL and uses several threads. Its results do not depend on their number.
namespace PULSECAST_NAMESPACE::python::detail {

/// Hit of a ray as a row of a NumPy array. Of a miss, range is infinite, part and primitive are -1.
struct HitRow {
  double range = std::numeric_limits<double>::infinity();  ///< as in `RayHit` [m]
  double normal[3] = {};                                   ///< as in `SurfaceInteraction`; zero for a miss
  double weights[3] = {nan, nan, nan};                     ///< as in `SurfaceInteraction`; NaN without
  double texture[2] = {nan, nan};                          ///< as in `SurfaceInteraction`; NaN without
  double velocity[3] = {};                                 ///< as in `SurfaceInteraction` [m/s]
  std::int64_t ray = 0;                                    ///< number of the ray, from 0
  std::int64_t primitive = -1;                             ///< as in `RayHit`
  std::int32_t part = -1;                                  ///< as in `RayHit`
  std::uint32_t object = 0;                                ///< as in `SurfaceInteraction`
  std::uint16_t classification = 0;                        ///< as in `SurfaceInteraction`
  std::uint8_t front = 0;                                  ///< 1 if the shape's own normal faces the origin
  std::uint8_t spare[5] = {};                              ///< zeros outside the array

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace PULSECAST_NAMESPACE::python::detail

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Array of numbers in rows, as Python passes it.
using NumberArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

namespace detail {

template <class Argument>
using Numbers = NumberArray;  // of each argument

/// Rays of one call: shape (n, 6), origins and directions of any length, or both of shape (n, 3).
class RayTable {
 public:
  /// @throws SettingError for arrays of other shapes, or values out of range
  RayTable(NumberArray rays, std::optional<NumberArray> directions, NumberArray time, double near, double far,
           std::uint64_t seed)
      : rays_(std::move(rays)),
        directions_(directions ? std::move(*directions) : rays_),
        time_(std::move(time)),
        near_(near),
        far_(far),
        seed_(seed) {
    stride_ = directions ? 3 : 6;
    require_shape(rays_, "rays");
    require_shape(directions_, "directions");
    if (directions_.shape(0) != rays_.shape(0))
      throw SettingError("rays directions (rows)", static_cast<double>(directions_.shape(0)), "",
                         "as many as origins, " + std::to_string(size()));
    if (time_.size() != 1 && (time_.ndim() != 1 || time_.shape(0) != rays_.shape(0)))
      throw SettingError("rays time (number)", static_cast<double>(time_.size()), "",
                         "1, or as many as rays, " + std::to_string(size()));
    for (pybind11::ssize_t i = 0; i < time_.size(); ++i) require_within("rays time", time_.data()[i], -1e15, 1e15, "s");
    require_not_negative("rays near", near, "m");
    if (!(far >= 0)) throw SettingError("rays far", far, "m", "at least 0");
  }

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(rays_.shape(0)); }

  /// Ray i; of NaN if it has no direction. Leaves are drawn by the seed and the number of the ray.
  [[nodiscard]] Ray operator[](std::size_t i) const {
    const double* const o = rays_.data() + i * stride_;
    const double* const d = directions_.data() + i * stride_ + (stride_ - 3);
    const Vec3 direction(d[0], d[1], d[2]);
    return {.origin = {o[0], o[1], o[2]},
            .direction = direction / length(direction),
            .near = near_,
            .far = far_,
            .tick = Tick::of_seconds(time_.data()[time_.size() == 1 ? 0 : i]),
            .seed = seed_,
            .pulse = i};
  }

 private:
  void require_shape(const NumberArray& array, const std::string& name) const {
    const pybind11::ssize_t columns = array.ndim() == 2 ? array.shape(1) : 0;
    if (columns != static_cast<pybind11::ssize_t>(stride_))
      throw SettingError("rays " + name + " (columns)", static_cast<double>(columns), "",
                         std::to_string(stride_) + ": shape (n, " + std::to_string(stride_) + ")");
  }

  NumberArray rays_, directions_, time_;
  std::size_t stride_ = 6;
  double near_, far_;
  std::uint64_t seed_;
};

/// Row of a hit, with its surface.
template <class World>
[[nodiscard]] HitRow hit_row(const World& scene, const RayHit& hit, const Ray& ray) {
  const SurfaceInteraction at = scene.surface(hit, ray);
  HitRow row;
  row.range = hit.range;
  for (int k = 0; k < 3; ++k) {
    row.normal[k] = at.normal[k];
    row.velocity[k] = at.velocity[k];
    if (at.weights) row.weights[k] = (*at.weights)[k];
  }
  for (int k = 0; k < 2 && at.texture; ++k) row.texture[k] = (*at.texture)[k];
  row.ray = static_cast<std::int64_t>(ray.pulse);
  row.primitive = hit.primitive;
  row.part = static_cast<std::int32_t>(hit.part);
  row.object = at.object;
  row.classification = at.classification;
  row.front = at.front ? 1 : 0;
  return row;
}

/// Calls `task(block, first, end)` for blocks of rays on several threads, without the GIL.
template <class Task>
void for_each_block(std::size_t rays, unsigned threads, const Task& task) {
  constexpr std::size_t block = 4096;
  const pybind11::gil_scoped_release free;
  const std::size_t blocks = (rays + block - 1) / block;
  for_each_index(blocks, threads, [&](std::size_t b) { task(b, b * block, std::min(rays, (b + 1) * block)); });
}

/// Closest hit of each ray, a row a ray.
template <class World>
[[nodiscard]] pybind11::array_t<HitRow> closest_hits(const World& scene, const RayTable& rays, unsigned threads) {
  pybind11::array_t<HitRow> rows(static_cast<pybind11::ssize_t>(rays.size()));
  HitRow* const out = rows.mutable_data();
  for_each_block(rays.size(), threads, [&](std::size_t, std::size_t first, std::size_t end) {
    std::vector<Ray> some;
    for (std::size_t i = first; i < end; ++i) some.push_back(rays[i]);
    std::vector<ClosestHitOf<World>> hits(some.size());
    pulsecast::closest_hits<World>(scene, some, hits);
    for (std::size_t i = first; i < end; ++i) {
      const auto& hit = hits[i - first];
      out[i] = hit ? hit_row(scene, *hit, some[i - first]) : HitRow{};
      out[i].ray = static_cast<std::int64_t>(i);
    }
  });
  return rows;
}

/// All hits of each ray, by ray and then by range.
template <class World>
[[nodiscard]] pybind11::array_t<HitRow> all_hits(const World& scene, const RayTable& rays, unsigned threads) {
  std::vector<std::vector<HitRow>> found(rays.size() / 4096 + 1);
  for_each_block(rays.size(), threads, [&](std::size_t block, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const Ray ray = rays[i];
      scene.all_hits(ray, [&](const RayHit& hit) { found[block].push_back(hit_row(scene, hit, ray)); });
    }
  });
  Rows<HitRow> rows;
  for (const auto& some : found)
    for (const HitRow& row : some) rows.push_back(row);
  return rows.take();
}

/// True for each ray with a hit.
template <class World>
[[nodiscard]] pybind11::array_t<bool> occluded(const World& scene, const RayTable& rays, unsigned threads) {
  pybind11::array_t<bool> all(static_cast<pybind11::ssize_t>(rays.size()));
  bool* const out = all.mutable_data();
  for_each_block(rays.size(), threads, [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) out[i] = scene.occluded(rays[i]);
  });
  return all;
}

/// Poses of a sensor in the world: shape (n, 4, 4), homogeneous transforms from the sensor's frame.
/// @throws SettingError for another shape, or a pose that is no rotation and translation
[[nodiscard]] inline auto sensor_poses(const NumberArray& array) {
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4)
    throw SettingError("poses (dimensions)", static_cast<double>(array.ndim()), "", "shape (n, 4, 4)");
  std::vector<Pose<frame::Instrument, frame::World>> poses;
  poses.reserve(static_cast<std::size_t>(array.shape(0)));
  for (pybind11::ssize_t p = 0; p < array.shape(0); ++p) {
    const double* const m = array.data(p);  // row by row
    Matrix3 turn(0);                        // its columns are the sensor's axes
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) turn[column][row] = m[4 * row + column];
    double error = std::fabs(m[12]) + std::fabs(m[13]) + std::fabs(m[14]) + std::fabs(m[15] - 1);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) error += std::fabs(dot(turn[a], turn[b]) - (a == b ? 1 : 0));
    error += length(cross(turn[0], turn[1]) - turn[2]);  // 2 for a mirror image
    if (!(error <= 1e-5))
      throw SettingError("poses: pose " + std::to_string(p) + " (error)", error, "", "a rotation and a translation");
    poses.push_back({unit(rotation_of(turn)), {m[3], m[7], m[11]}});
  }
  return poses;
}

/// Ranges of equal sensors at many poses: shape (poses, rays), as of `pulsecast::run_batch`.
template <class World>
[[nodiscard]] pybind11::array_t<float> run_batch(const World& scene, const NumberArray& poses, const RayTable& rays,
                                                 unsigned threads) {
  const auto at = sensor_poses(poses);
  std::vector<Ray> beams(rays.size());
  for (std::size_t i = 0; i < beams.size(); ++i) beams[i] = rays[i];
  pybind11::array_t<float> ranges({poses.shape(0), static_cast<pybind11::ssize_t>(beams.size())});
  const std::span<float> out(ranges.mutable_data(), static_cast<std::size_t>(ranges.size()));
  const pybind11::gil_scoped_release free;
  pulsecast::run_batch(scene, at, beams, out, threads);
  return ranges;
}

/// Attributes of objects: an array a name, of the shape of `objects`, NaN where an object has none.
/// @throws SettingError as `ObjectAttributes` @throws TypeError for numbers that are not whole
template <class World>
[[nodiscard]] pybind11::dict attributes_of(const World& scene, const pybind11::object& given) {
  const auto numbers = pybind11::array::ensure(given);
  const char kind = !numbers ? ' ' : numbers.size() == 0 ? 'i' : numbers.dtype().kind();
  if (kind != 'i' && kind != 'u')
    throw pybind11::type_error("attributes_of objects: expected whole numbers, not " +
                               std::string(pybind11::repr(given)));
  using pybind11::array;
  const pybind11::array_t<std::int64_t, array::c_style | array::forcecast> objects(numbers);
  const ObjectAttributes all(scene.parts());
  const std::vector<pybind11::ssize_t> shape(objects.shape(), objects.shape() + objects.ndim());
  std::vector<pybind11::array_t<double>> columns;
  for (std::size_t k = 0; k < all.names().size(); ++k) columns.emplace_back(shape);
  for (pybind11::ssize_t i = 0; i < objects.size(); ++i) {
    const std::int64_t object = objects.data()[i];
    const bool is_object = object >= 0 && object <= std::numeric_limits<ObjectId>::max();
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns[k].mutable_data()[i] = is_object ? all.of(static_cast<ObjectId>(object))[k] : none;
  }
  pybind11::dict named;
  for (std::size_t k = 0; k < columns.size(); ++k) named[all.names()[k].c_str()] = columns[k];
  return named;
}

}  // namespace detail

/// Adds the methods `closest_hits`, `all_hits`, `occluded`, `run_batch` and `attributes_of` to a
/// class of scenes, as `Scene` and `MovingScene`.
template <class Class>
Class& bind_ray_queries(Class&& bound) {
  namespace py = pybind11;
  using World = typename std::remove_reference_t<Class>::type;
  if (!py::detail::get_numpy_internals().get_type_info<detail::HitRow>(false))
    PYBIND11_NUMPY_DTYPE(detail::HitRow, range, normal, weights, texture, velocity, ray, primitive, part, object,
                         classification, front);
  const auto add = [&bound]<class... First>(const char* name, auto query, const std::string& doc, First... first) {
    bound.def(
        name,
        [query](const World& scene, const detail::Numbers<First>&... more, NumberArray rays,
                std::optional<NumberArray> directions, double near, double far, NumberArray time, std::uint64_t seed,
                unsigned threads) {
          const detail::RayTable table(std::move(rays), std::move(directions), std::move(time), near, far, seed);
          return query(scene, more..., table, threads);
        },
        first..., py::arg("rays"), py::arg("directions") = py::none(), py::kw_only(), py::arg("near") = 0.0,
        py::arg("far") = std::numeric_limits<double>::infinity(), py::arg("time") = 0.0, py::arg("seed") = 0,
        py::arg("threads") = 0, doc.c_str());
  };
  const std::string row =
      "range [m], normal (3, towards the ray's origin), weights (3, of a triangle's corners), texture (2), velocity "
      "(3) [m/s], ray, primitive, part, object, classification, front.";
  const std::string rays =
      " rays: shape (n, 6), origin [m] and direction of any length; or origins, shape (n, 3), with directions, shape "
      "(n, 3). near, far: ranges that count [m]. time: of all rays or of each, for parts that move [s]. seed: with "
      "the number of the ray, the key of leaves met at random. threads: 0 for all. Rays of NaN or without direction "
      "miss.";
  add("closest_hits", &detail::closest_hits<World>,
      "Structured array, one row per ray: " + row + " A miss has an infinite range, and -1 as part and primitive." +
          rays);
  add("all_hits", &detail::all_hits<World>, "Structured array of all hits, by ray and then by range: " + row + rays);
  add("occluded", &detail::occluded<World>, "Boolean array: True for each ray with a hit." + rays);
  add("run_batch", &detail::run_batch<World>,
      "Array of float32, shape (n, m): range of each of m rays of a sensor at each of n poses [m]; infinite without a "
      "hit. poses: shape (n, 4, 4), homogeneous transforms from the sensor's frame to the world; rays, directions: in "
      "the sensor's frame; else as `closest_hits`. seed: with the index in the array, the key of leaves met at "
      "random.",
      py::arg("poses"));
  bound.def("attributes_of", &detail::attributes_of<World>, py::arg("objects"),
            "Dict of arrays of the shape of objects, a name each: attributes of these objects, NaN where one has none. "
            "objects: whole numbers, as the column `object` of hits.");
  return bound;
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
