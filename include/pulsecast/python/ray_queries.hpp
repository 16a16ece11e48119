// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_RAY_QUERIES_HPP
#define PULSECAST_PYTHON_RAY_QUERIES_HPP

#include <pulsecast/python/bind.hpp>
#include <pulsecast/python/detail/ray_arguments.hpp>

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

namespace detail {

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

/// Calls `work(check)` without the GIL. Ctrl-C ends the work on many rays: `check()` then throws `Stopped`.
void with_checks(std::size_t rays, const auto& work) {
  constexpr std::size_t few = 1 << 18;  // some tenths of a second
  if (rays > few)
    return interruptible([&](const std::stop_token& stop) {
      work([&stop] {
        if (stop.stop_requested()) throw Stopped{};
      });
    });
  const pybind11::gil_scoped_release free;
  work([] {});
}

/// Calls `task(block, first, end)` for blocks of rays on several threads, as `with_checks`.
template <class Task>
void for_each_block(std::size_t rays, unsigned threads, const Task& task) {
  constexpr std::size_t block = 4096;
  with_checks(rays, [&](const auto& check) {
    for_each_index((rays + block - 1) / block, threads, [&](std::size_t b) {
      check();
      task(b, b * block, std::min(rays, (b + 1) * block));
    });
  });
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

/// Ranges of equal sensors at many poses, as of `pulsecast::run_batch`, at pose p in `scene_at(p)`.
template <class World>
[[nodiscard]] pybind11::array_t<float> run_batch(const auto& scene_at, const NumberArray& poses, const RayTable& rays,
                                                 unsigned threads, const pybind11::object& out) {
  const auto at = sensor_poses(poses);
  std::vector<Ray> beams(rays.size());
  for (std::size_t i = 0; i < beams.size(); ++i) beams[i] = rays[i];
  auto ranges = ranges_in(out, poses.shape(0), static_cast<pybind11::ssize_t>(beams.size()));
  const std::span<float> to(ranges.mutable_data(), static_cast<std::size_t>(ranges.size()));
  with_checks(to.size(), [&](const auto& check) {
    const auto checked_scene_at = [&](std::size_t pose) -> decltype(auto) {
      check();
      return scene_at(pose);
    };
    pulsecast::detail::run_batch<World>(checked_scene_at, at, beams, to, threads);
  });
  return ranges;
}

/// As above, at pose p in `scenes[scene_of[p]]`.
template <class World>
[[nodiscard]] pybind11::array_t<float> run_batch_in(const pybind11::sequence& scenes, const pybind11::object& scene_of,
                                                    const NumberArray& poses, const RayTable& rays, unsigned threads,
                                                    const pybind11::object& out) {
  const pybind11::tuple kept(scenes);  // another thread may change a list
  std::vector<const World*> worlds;
  for (const pybind11::handle scene : kept) worlds.push_back(&scene.cast<const World&>());
  const auto of = whole_numbers(scene_of, "run_batch_in scene_of");
  require_within("run_batch_in scene_of (number)", of.size(), poses.shape(0), poses.shape(0), "");
  std::vector<const World*> at;
  for (pybind11::ssize_t p = 0; p < of.size(); ++p) {
    const std::int64_t index = of.data()[p];
    require_within("run_batch_in scene_of (of pose " + std::to_string(p) + ')', index, 0,
                   static_cast<double>(worlds.size()) - 1, "");
    at.push_back(worlds[static_cast<std::size_t>(index)]);
  }
  const auto scene_at = [&](std::size_t p) noexcept -> const World& { return *at[p]; };
  return run_batch<World>(scene_at, poses, rays, threads, out);
}

/// Attributes of objects: an array a name, of the shape of `objects`, NaN where an object has none.
/// @throws SettingError as `ObjectAttributes` @throws TypeError for numbers that are not whole
template <class World>
[[nodiscard]] pybind11::dict attributes_of(const World& scene, const pybind11::object& given) {
  const auto objects = whole_numbers(given, "attributes_of objects");
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

/// Adds the methods `closest_hits`, `all_hits`, `occluded`, `run_batch`, `run_batch_in` and
/// `attributes_of` to a class of scenes, as `Scene` and `MovingScene`.
template <class Class>
Class& bind_ray_queries(Class&& bound) {
  namespace py = pybind11;
  using World = typename std::remove_reference_t<Class>::type;
  if (!py::detail::get_numpy_internals().get_type_info<detail::HitRow>(false))
    PYBIND11_NUMPY_DTYPE(detail::HitRow, range, normal, weights, texture, velocity, ray, primitive, part, object,
                         classification, front);
  const auto add = [&](const char* name, auto query, const std::string& doc) {
    const auto ask = [query](const World& scene, NumberArray rays, std::optional<NumberArray> directions, double near,
                             double far, NumberArray time, Whole<"seed"> seed, Whole<"threads", unsigned> threads) {
      return query(scene, {std::move(rays), std::move(directions), std::move(time), near, far, seed}, threads);
    };
    detail::ray_arguments([&](const auto&... more) { bound.def(name, ask, more..., doc.c_str()); })();
  };
  const std::string row =
      "range [m], normal (3, towards the ray's origin), weights (3, of a triangle's corners), texture (2), velocity "
      "(3) [m/s], ray, primitive, part, object, classification, front.";
  const std::string asked =
      " rays: shape (n, 6), origin [m] and direction of any length; or origins, shape (n, 3), with directions, shape "
      "(n, 3). near, far: ranges that count [m]. time: of all rays or of each, for parts that move [s]. seed: with "
      "the number of the ray, the key of leaves met at random. threads: 0 for all. Rays of NaN or without direction "
      "miss.";
  add("closest_hits", &detail::closest_hits<World>,
      "Structured array, one row per ray: " + row + " A miss has an infinite range, and -1 as part and primitive." +
          asked);
  add("all_hits", &detail::all_hits<World>, "Structured array of all hits, by ray and then by range: " + row + asked);
  add("occluded", &detail::occluded<World>, "Boolean array: True for each ray with a hit." + asked);
  const auto run = [](const World& scene, const NumberArray& poses, NumberArray rays,
                      std::optional<NumberArray> directions, double near, double far, NumberArray time,
                      Whole<"seed"> seed, Whole<"threads", unsigned> threads, const py::object& out) {
    const auto scene_at = [&](std::size_t) noexcept -> const World& { return scene; };
    return detail::run_batch<World>(
        scene_at, poses, {std::move(rays), std::move(directions), std::move(time), near, far, seed}, threads, out);
  };
  const auto run_in = [](const py::sequence& scenes, const py::object& scene_of, const NumberArray& poses,
                         NumberArray rays, std::optional<NumberArray> directions, double near, double far,
                         NumberArray time, Whole<"seed"> seed, Whole<"threads", unsigned> threads,
                         const py::object& out) {
    return detail::run_batch_in<World>(scenes, scene_of, poses,
                                       {std::move(rays), std::move(directions), std::move(time), near, far, seed},
                                       threads, out);
  };
  const std::string batch =
      "Array of float32, shape (n, m): range of each of m rays of a sensor at each of n poses [m]; infinite without a "
      "hit. poses: shape (n, 4, 4), homogeneous transforms from the sensor's frame to the world; rays, directions: in "
      "the sensor's frame; else as `closest_hits`. seed: with the index in the array, the key of leaves met at "
      "random. out: array of the result, writeable and C-contiguous, which is filled and returned.";
  detail::ray_arguments([&](const auto&... more) { bound.def("run_batch", run, more..., batch.c_str()); },
                        py::arg("poses"))(py::arg("out") = py::none());
  const std::string in = batch + " scenes: sequence of scenes; scene_of: index into it of each pose.";
  detail::ray_arguments([&](const auto&... more) { bound.def_static("run_batch_in", run_in, more..., in.c_str()); },
                        py::arg("scenes"), py::arg("scene_of"), py::arg("poses"))(py::arg("out") = py::none());
  bound.def("attributes_of", &detail::attributes_of<World>, py::arg("objects"),
            "Dict of arrays of the shape of objects, a name each: attributes of these objects, NaN where one has none. "
            "objects: whole numbers, as the column `object` of hits.");
  return bound;
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
