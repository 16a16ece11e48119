// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_RAY_ARGUMENTS_HPP
#define PULSECAST_PYTHON_DETAIL_RAY_ARGUMENTS_HPP

#include <pybind11/numpy.h>

#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/scene/run_batch.hpp>

/// Arguments of ray queries, as Python passes them.
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Array of numbers in rows, as Python passes it.
using NumberArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

namespace detail {

/// Whole numbers of an array or sequence. @throws TypeError for others
[[nodiscard]] inline auto whole_numbers(const pybind11::object& given, const std::string& name) {
  using pybind11::array;
  const auto numbers = array::ensure(given);
  const char kind = !numbers ? ' ' : numbers.size() == 0 ? 'i' : numbers.dtype().kind();
  if (kind != 'i' && kind != 'u')
    throw pybind11::type_error(name + ": expected whole numbers, not " + std::string(pybind11::repr(given)));
  return pybind11::array_t<std::int64_t, array::c_style | array::forcecast>(numbers);
}

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

/// `out` itself, or a new array if it is None: float32, shape (poses, rays).
/// @throws TypeError for no array @throws ValueError for one that a batch cannot write to
[[nodiscard]] inline pybind11::array_t<float> ranges_in(const pybind11::object& out, pybind11::ssize_t poses,
                                                        pybind11::ssize_t rays) {
  using Ranges = pybind11::array_t<float, pybind11::array::c_style>;
  if (out.is_none()) return Ranges({poses, rays});
  const std::string expected = "run_batch out: expected a writeable C-contiguous array of float32 of shape (" +
                               std::to_string(poses) + ", " + std::to_string(rays) + "), not ";
  if (!pybind11::isinstance<pybind11::array>(out))
    throw pybind11::type_error(expected + std::string(pybind11::repr(pybind11::type::of(out))));
  const auto given = pybind11::reinterpret_borrow<pybind11::array>(out);
  const bool contiguous = (given.flags() & pybind11::array::c_style) != 0, writeable = given.writeable();
  if (!pybind11::isinstance<Ranges>(out) || given.ndim() != 2 || given.shape(0) != poses || given.shape(1) != rays ||
      !writeable)
    throw pybind11::value_error(expected + (writeable ? "a " : "a read-only ") + (contiguous ? "" : "strided ") +
                                std::string(pybind11::str(given.dtype())) + " array of shape " +
                                std::string(pybind11::str(out.attr("shape"))));
  return pybind11::reinterpret_borrow<Ranges>(out);
}

/// Gives the arguments of rays to `define(first..., arguments..., last...)`.
[[nodiscard]] auto ray_arguments(const auto& define, const auto&... first) {
  return [=](const auto&... last) {
    using pybind11::arg;
    define(first..., arg("rays"), arg("directions") = pybind11::none(), pybind11::kw_only(), arg("near") = 0.0,
           arg("far") = pulsecast::detail::infinity, arg("time") = 0.0, arg("seed") = 0, arg("threads") = 0, last...);
  };
}

}  // namespace detail
}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
