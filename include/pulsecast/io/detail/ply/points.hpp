// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PLY_POINTS_HPP
#define PULSECAST_IO_DETAIL_PLY_POINTS_HPP

#include <pulsecast/io/detail/ply/file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reader of the vertices of a PLY file as points, with normals, colours, classes and objects by the names of their
/// properties. Points without finite coordinates are left out. Throws a `FileError` with path and line or byte.
class PlyPoints {
 public:
  explicit PlyPoints(InputFile file) : file_(std::move(file)) {
    file_.keep_rules(detail::ply_cloud_rules, warnings_);
    while (file_.next_element() && file_.element().name != "vertex") continue;
    if (file_.elements().empty() || file_.element().name != "vertex")
      detail::fail(path(), "has no element vertex: expected the points of a cloud");
    const auto& all = file_.element().properties;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (!all[k].length) names_.add(all[k].name, k);
    if (!names_.vector(0))
      detail::fail(path(), "has vertices without x, y or z: expected ",
                   names_.refused ? names_.refused->meaning : "the points of a cloud");
    constexpr std::array<double, 9> most{0, 127, 255, 32767, 65535, 2147483647.0, 4294967295.0, 1, 1};  // by type
    if (has_colours()) max_colour = most[static_cast<std::size_t>(all[*names_.column[6]].type)];
  }

  /// Advances to the next point; false at the end.
  [[nodiscard]] bool next() {
    while (file_.next()) {
      if (finite(vector(0))) return true;
      ++left_out_;
    }
    return false;
  }

  /// Position of the current point. Throws a `FileError` beyond 1e12.
  [[nodiscard]] Vec3 position() const {
    const Vec3 p = vector(0);
    if (!is_within(p, 1e12)) fail_here("has a point beyond 1e12 m: expected coordinates up to 1e12 m");
    return p;
  }

  [[nodiscard]] bool has_normals() const noexcept { return names_.vector(3).has_value(); }
  [[nodiscard]] Vec3 normal() const noexcept { return is_within(vector(3), 1e12) ? vector(3) : Vec3{}; }
  [[nodiscard]] bool has_colours() const noexcept { return names_.vector(6).has_value(); }
  [[nodiscard]] Vec3 colour() const noexcept { return vector(6); }
  double max_colour = 255;  ///< by the type of the property: the largest whole number, or 1
  [[nodiscard]] bool has_class() const noexcept { return names_.column[9].has_value(); }
  [[nodiscard]] std::uint32_t classification() const { return detail::whole_number(file_.number(*names_.column[9])); }
  [[nodiscard]] bool has_object() const noexcept { return names_.column[10].has_value(); }
  [[nodiscard]] std::uint32_t object() const { return detail::whole_number(file_.number(*names_.column[10])); }

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = warnings_;
    if (left_out_ > 0)
      all.push_back(text::message(path(), ": ", left_out_, " points that are not finite are left out"));
    return all;
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_here(problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  [[nodiscard]] Vec3 vector(std::size_t row) const noexcept {
    const auto [x, y, z] = *names_.vector(row);
    return {file_.number(x), file_.number(y), file_.number(z)};
  }

  detail::PlyFile file_;
  detail::PointNames names_;
  std::vector<std::string> warnings_;
  std::uint64_t left_out_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
