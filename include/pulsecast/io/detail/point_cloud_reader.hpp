// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_POINT_CLOUD_READER_HPP
#define PULSECAST_IO_DETAIL_POINT_CLOUD_READER_HPP

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <pulsecast/io/detail/cell_numbers.hpp>
#include <pulsecast/io/detail/las/points.hpp>
#include <pulsecast/io/detail/ply/points.hpp>
#include <pulsecast/io/detail/ptx/points.hpp>
#include <pulsecast/io/detail/text/points.hpp>
#include <pulsecast/io/point_cloud.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Refuses a file of another kind by its first bytes.
inline void refuse_other_kinds(InputFile& file) {
  struct Kind {
    std::string_view begin, name;
  };
  static constexpr std::array<Kind, 5> kinds{{{"# .PCD", "a PCD file"},
                                              {"ASTM-E57", "an E57 file"},
                                              {"PK\x03\x04", "a ZIP file"},
                                              {"\x1F\x8B", "compressed by gzip"},
                                              {"\x89HDF", "an HDF file"}}};
  const std::string_view head = file.take(16);
  for (const Kind& kind : kinds)
    if (head.starts_with(kind.begin))
      file.fail(
          "is ", kind.name,
          ": expected a point cloud as text, PTX, PLY, LAS or LAZ; CloudCompare and pdal translate convert to LAS");
  file.seek(0);
}

/// Calls a function with the reader for the format of a file.
void with_points(const std::filesystem::path& path, const PointCloudSettings& settings, const auto& function) {
  InputFile file(path, "a point cloud");
  if (LasPoints::is_las(file)) {
    LasPoints points(std::move(file), {.colours = settings.colours, .objects = settings.objects});
    function(points);
  } else if (detail::PlyFile::is_ply(file)) {
    PlyPoints points(std::move(file));
    function(points);
  } else if (PtxPoints::is_ptx(file)) {
    PtxPoints points(std::move(file));
    function(points);
  } else {
    refuse_other_kinds(file);
    TextPointColumns columns = settings.columns;
    if (settings.normals != VoxelNormals::mean && settings.normals != VoxelNormals::nearest) columns.normal.reset();
    if (!settings.colours) columns.colour.reset();
    TextPoints points(std::move(file), std::move(columns));
    function(points);
  }
}

/// Normal, pointing up, of the least-squares plane through points; empty for fewer than three, or
/// on one line. Given are their number, and sums of their offsets from a nearby origin and of the
/// products xx, xy, xz, yy, yz, zz. Source: Pearson 1901: least eigenvector of the covariance.
[[nodiscard]] inline std::optional<Vec3> plane_normal(double count, const Vec3& sum,
                                                      const std::array<double, 6>& products) {
  if (count < 3) return std::nullopt;
  const Eigen::Vector3d offset(sum.x, sum.y, sum.z);
  Eigen::Matrix3d about{{products[0], products[1], products[2]},
                        {products[1], products[3], products[4]},
                        {products[2], products[4], products[5]}};
  const double size = about.trace();
  if (!(size > 0)) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver((about - offset * offset.transpose() / count) / size);
  constexpr double rounding = 1e-13;  // smaller eigenvalues are noise of doubles
  if (solver.info() != Eigen::Success || !(solver.eigenvalues()[1] > rounding)) return std::nullopt;
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  const Vec3 normal = normalize(Vec3{least.x(), least.y(), least.z()});
  const double side = normal.z != 0 ? normal.z : normal.y != 0 ? normal.y : normal.x;
  return side < 0 ? -normal : normal;
}

/// Counts of labels, such as classes, by voxel.
class VoxelLabels {
 public:
  void add(std::size_t voxel, std::uint32_t label) {
    const std::size_t pair = pairs_.number({static_cast<std::uint32_t>(voxel), label, 0});
    if (pair == counts_.size()) counts_.push_back(0);
    ++counts_[pair];
  }

  /// Most frequent label of each voxel, or the lowest of these.
  [[nodiscard]] std::vector<std::uint32_t> most_frequent(std::size_t voxels) && {
    std::vector<std::uint32_t> labels(voxels);
    std::vector<std::uint64_t> most(voxels);
    const auto pairs = std::move(pairs_).release();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [voxel, label, none] = pairs[i];
      if (counts_[i] < most[voxel] || (counts_[i] == most[voxel] && label > labels[voxel])) continue;
      most[voxel] = counts_[i];
      labels[voxel] = label;
    }
    return labels;
  }

 private:
  CellNumbers pairs_;
  std::vector<std::uint64_t> counts_;
};

class PointCloudReader {
 public:
  PointCloudReader(const std::vector<std::filesystem::path>& paths, const PointCloudSettings& settings)
      : settings_(validated(settings)) {
    measure(paths);
    for (int axis = 0; axis < 3; ++axis) lay(axis, paths.front());
    require_room(paths.front());
    for (const std::filesystem::path& path : paths)
      with_points(path, settings_, [this](auto& points) {
        while (points.next()) add(points);
      });
  }

  [[nodiscard]] PointCloud result() && {
    cloud_.voxels.edge = settings_.voxel_size;
    cloud_.voxels.corner = corner();
    finish_normals();
    finish_colours();
    if (classes_) cloud_.classes = std::move(class_counts_).most_frequent(counts_.size());
    if (objects_) cloud_.objects = std::move(object_counts_).most_frequent(counts_.size());
    cloud_.voxels.cells = std::move(cells_).release();
    return std::move(cloud_);
  }

 private:
  using Cell = CellNumbers::Cell;

  /// First pass: finds the extent, and the normals and colours available.
  void measure(const std::vector<std::filesystem::path>& paths) {
    const VoxelNormals source = settings_.normals;
    const bool from_file = source == VoxelNormals::mean || source == VoxelNormals::nearest;
    normals_ = source != VoxelNormals::none;
    colours_ = settings_.colours;
    classes_ = settings_.classes;
    objects_ = settings_.objects;
    for (const std::filesystem::path& path : paths)
      with_points(path, settings_, [&](auto& points) {
        const std::uint64_t before = cloud_.points;
        for (; points.next(); ++cloud_.points) bounds_.extend(points.position());
        if (cloud_.points == before) detail::fail(points.path(), "holds no point: expected at least one");
        const auto lack = [&](bool& gathered, const char* what) {
          gathered = false;
          cloud_.warnings.push_back(warning(points.path(), 0, what));
        };
        if (from_file && !points.has_normals()) lack(normals_, "has no normals: no voxel gets one from a file");
        if (settings_.colours && !points.has_colours()) lack(colours_, "has no colours: no voxel gets one");
        classes_ = classes_ && points.has_class();
        objects_ = objects_ && points.has_object();
        for (std::string& warning : points.warnings()) cloud_.warnings.push_back(std::move(warning));
      });
  }

  /// Sets up the lattice along an axis.
  void lay(int axis, const std::filesystem::path& path) {
    const double edge = settings_.voxel_size, low = bounds_.min[axis], extent = bounds_.max[axis] - low;
    double cells = std::max(std::ceil(extent / edge), 1.0);
    if (settings_.lattice == VoxelLattice::at_multiples) {
      origin_[axis] = 0;
      first_[axis] = std::floor(low / edge);
      cells = std::floor(bounds_.max[axis] / edge) - first_[axis] + 1;
    } else {
      origin_[axis] = extent > 0 ? low : low - edge / 2;
      first_[axis] = 0;
    }
    if (!(cells <= 0x1p32))
      detail::fail(path, "the cloud extends over ", extent, " m along ", "xyz"[axis], ", which is ", cells,
                   " voxels: expected no more than 2^32; voxels are ", edge, " m large");
    last_[axis] = cells - 1;
  }

  [[nodiscard]] Vec3 corner() const noexcept { return origin_ + first_ * settings_.voxel_size; }

  /// @throws FileError for voxels that are small against the rounding of coordinates
  void require_room(const std::filesystem::path& path) const {
    const double edge = settings_.voxel_size, least = VoxelData::min_edge(corner());
    if (edge >= least) return;
    detail::fail(path, "the cloud begins ", max_norm(corner()), " m from the origin, where voxels of ", edge,
                 " m are below the resolution of coordinates: expected at least ", least, " m");
  }

  /// Second pass: adds a point to its voxel.
  template <class Points>
  void add(const Points& points) {
    const Vec3 p = points.position();
    Cell cell{};
    Vec3 centre{};
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = std::floor((p[axis] - origin_[axis]) / settings_.voxel_size);
      const double place = std::min(offset - first_[axis], last_[axis]);
      if (!(p[axis] >= bounds_.min[axis] && p[axis] <= bounds_.max[axis]))
        points.fail_here("the file has changed while it was read");
      cell[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(place);
      centre[axis] = origin_[axis] + (first_[axis] + place + 0.5) * settings_.voxel_size;
    }
    if (cells_.size() == CellNumbers::max_size) points.fail_here("exceeds the maximum of 2^32 - 2 voxels");
    const std::size_t voxel = cells_.number(cell);
    if (voxel == counts_.size()) append();
    ++counts_[voxel];
    if (normals_) add_normal(points, voxel, p - centre);
    if (colours_) add_colour(points, voxel);
    if (classes_) class_counts_.add(voxel, points.classification());
    if (objects_) object_counts_.add(voxel, points.object());
  }

  void append() {
    counts_.push_back(0);
    if (normals_) sums_.emplace_back(0, 0, 0);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (normals_ && settings_.normals == VoxelNormals::nearest) nearest_.push_back(infinity);
    if (normals_ && settings_.normals == VoxelNormals::fitted) products_.push_back({});
    if (colours_) squares_.emplace_back(0, 0, 0);
  }

  template <class Points>
  void add_normal(const Points& points, std::size_t voxel, const Vec3& d) {
    if (settings_.normals == VoxelNormals::fitted) {
      sums_[voxel] += d;
      auto product = products_[voxel].begin();
      for (int i = 0; i < 3; ++i)
        for (int k = i; k < 3; ++k) *product++ += d[i] * d[k];
      return;
    }
    const Vec3 given = points.normal();
    if (given == Vec3{0, 0, 0}) return;
    const Vec3 normal = normalize(given / max_norm(given));
    if (settings_.normals == VoxelNormals::mean) {
      sums_[voxel] += normal;
    } else if (dot(d, d) < nearest_[voxel]) {
      nearest_[voxel] = dot(d, d);
      sums_[voxel] = normal;
    }
  }

  template <class Points>
  void add_colour(const Points& points, std::size_t voxel) {
    const Vec3 colour = points.colour();
    const double largest = settings_.colour_max.value_or(points.max_colour);
    for (int k = 0; k < 3; ++k)
      if (!(colour[k] >= 0 && colour[k] <= largest))
        points.fail_here(text::message("has the colour ", colour[k], ": expected one from 0 to ", largest));
    const Vec3 share = colour / largest;
    if (!settings_.colour_max) brightest_ = std::max(brightest_, max_norm(colour));
    squares_[voxel] += share * share;
    colour_max_ = std::max(colour_max_, largest);
  }

  [[nodiscard]] std::optional<Vec3> normal_of(std::size_t voxel) const {
    if (!normals_) return std::nullopt;
    if (settings_.normals == VoxelNormals::fitted)
      return plane_normal(static_cast<double>(counts_[voxel]), sums_[voxel], products_[voxel]);
    constexpr double rounding = 1e-12;  // residue where normals of one voxel cancel
    if (!(length(sums_[voxel]) > rounding * static_cast<double>(counts_[voxel]))) return std::nullopt;
    return normalize(sums_[voxel]);
  }

  void finish_normals() {
    if (settings_.normals == VoxelNormals::none || (!normals_ && !settings_.default_normal)) return;
    std::optional<Vec3> otherwise = settings_.default_normal;
    if (otherwise) otherwise = normalize(*otherwise / max_norm(*otherwise));
    std::uint64_t without = 0;
    cloud_.voxels.normals.reserve(counts_.size());
    for (std::size_t voxel = 0; voxel < counts_.size(); ++voxel) {
      std::optional<Vec3> normal = normal_of(voxel);
      if (!normal) normal = otherwise;
      if (!normal) ++without;
      const Vec3 n = normal.value_or(Vec3{});
      cloud_.voxels.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    }
    const char* const reason = settings_.normals == VoxelNormals::fitted
                                   ? "their points are fewer than three, or on one line"
                                   : "the normals of their points are zero, or cancel";
    if (without > 0)
      cloud_.warnings.push_back(text::message(without, " of ", counts_.size(), " voxels have no normal: ", reason));
  }

  void finish_colours() {
    if (!colours_) return;
    for (const double usual : {1, 255})
      if (brightest_ > 0 && brightest_ <= usual && colour_max_ > usual) {
        cloud_.warnings.push_back(text::message("no colour exceeds ", usual, " of ", colour_max_,
                                                ": for colours up to ", usual, ", the maximum should be ", usual));
        break;
      }
    cloud_.colours.reserve(counts_.size());
    for (std::size_t voxel = 0; voxel < counts_.size(); ++voxel) {
      const Vec3 mean = squares_[voxel] / static_cast<double>(counts_[voxel]);
      const auto channel = [&](int k) { return static_cast<float>(std::sqrt(mean[k])); };
      cloud_.colours.push_back({channel(0), channel(1), channel(2)});
    }
  }

  PointCloudSettings settings_;
  PointCloud cloud_;
  bool normals_ = false, colours_ = false, classes_ = false, objects_ = false;  // true if gathered in the second pass
  Box bounds_;                                                                  // extent of the points
  Vec3 origin_{}, first_{}, last_{};       // of the lattice [m]; its first and last cells
  double brightest_ = 0, colour_max_ = 0;  // largest channel, and its limit
  CellNumbers cells_;
  VoxelLabels class_counts_, object_counts_;
  // for each voxel:
  std::vector<std::uint64_t> counts_;            // number of points
  std::vector<Vec3> sums_;                       // sum of normals, or of offsets from the centre
  std::vector<double> nearest_;                  // squared distance of the nearest to the centre
  std::vector<std::array<double, 6>> products_;  // sums of products of the offsets
  std::vector<Vec3> squares_;                    // sums of squared colours
};

}  // namespace detail

PULSECAST_INLINE PointCloud read_point_cloud(const std::vector<std::filesystem::path>& paths,
                                             const PointCloudSettings& settings) {
  if (paths.empty()) throw SettingError("read_point_cloud paths", 0, "", "at least one");
  return reading(paths.front(), [&] { return detail::PointCloudReader(paths, settings).result(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
