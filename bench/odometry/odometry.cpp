// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Lidar odometry by PCL's generalized ICP, on what unbag.mjs read from a bag: each scan against a map of the last
// three. Prints its drift: distance of its end from the truth's, by the length of the path [%]. Usage: odometry FOLDER
// WAY, where WAY is
//   scanned: points as they are;
//   undone: motion within a scan undone, rotation by the gyroscopes, translation by the odometry's last velocity, to
//   the
//     middle of the scan: to its start, an error of the velocity would come back with the other sign, for ever;
//   undistorted: points as they are, in the frame of the scan's start.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <Eigen/Geometry>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Pose = Eigen::Isometry3d;

constexpr double leaf = 0.5;       ///< of the grids that thin clouds out [m]
constexpr double scan_time = 0.1;  ///< [s]
constexpr std::size_t window = 3;  ///< scans in the map

struct Scan {
  double stamp = 0;                             ///< [s]
  std::vector<std::array<double, 4>> points{};  ///< x, y, z [m], time since the stamp [s]
};

std::vector<Scan> read_scans(const std::string& folder) {
  std::ifstream in(folder + "/scans.bin", std::ios::binary);
  std::vector<Scan> scans;
  for (std::array<double, 2> head{}; in.read(reinterpret_cast<char*>(head.data()), sizeof head);) {
    scans.push_back({head[0], std::vector<std::array<double, 4>>(static_cast<std::size_t>(head[1]))});
    auto& points = scans.back().points;
    in.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(points.size() * sizeof points[0]));
  }
  return scans;
}

/// True poses of the lidar, which the bag has at all starts and middles of scans.
class Truth {
 public:
  explicit Truth(const std::string& folder) {
    std::ifstream in(folder + "/truth.txt");
    double t, x, y, z, qx, qy, qz, qw;
    while (in >> t >> x >> y >> z >> qx >> qy >> qz >> qw) {
      times_.push_back(t);
      poses_.push_back(Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz).normalized());
    }
  }
  [[nodiscard]] std::size_t index(double t) const {
    const auto at = static_cast<std::size_t>(std::lower_bound(times_.begin(), times_.end(), t - 1e-6) - times_.begin());
    if (at == times_.size() || std::fabs(times_[at] - t) > 1e-6) throw std::runtime_error("no truth at this time");
    return at;
  }
  [[nodiscard]] const Pose& at(double t) const { return poses_[index(t)]; }
  [[nodiscard]] double length(double from, double to) const {
    double sum = 0;
    for (std::size_t i = index(from); i < index(to); ++i)
      sum += (poses_[i + 1].translation() - poses_[i].translation()).norm();
    return sum;
  }

 private:
  std::vector<double> times_;
  std::vector<Pose> poses_;
};

/// Attitudes by the gyroscopes.
class Gyroscopes {
 public:
  explicit Gyroscopes(const std::string& folder) {
    std::ifstream in(folder + "/imu.txt");
    Eigen::Vector3d rate, before = Eigen::Vector3d::Zero();
    double last = 0;
    attitudes_.push_back({0, Eigen::Quaterniond::Identity()});
    for (double t = 0; in >> t >> rate.x() >> rate.y() >> rate.z(); last = t, before = rate) {
      const Eigen::Vector3d turned = (t - last) * 0.5 * (before + rate);
      const double angle = turned.norm();
      Eigen::Quaterniond next = attitudes_.back().second;
      if (angle > 0) next = (next * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turned / angle))).normalized();
      attitudes_.push_back({t, next});
    }
  }
  [[nodiscard]] Eigen::Quaterniond at(double t) const {
    const auto later = [](double time, const auto& sample) { return time < sample.first; };
    auto behind = std::upper_bound(attitudes_.begin(), attitudes_.end(), t, later);
    if (behind == attitudes_.end()) --behind;
    const auto before = behind - 1;
    return before->second.slerp((t - before->first) / (behind->first - before->first), behind->second);
  }

 private:
  std::vector<std::pair<double, Eigen::Quaterniond>> attitudes_;
};

Cloud::Ptr thinned(const Cloud::Ptr& cloud) {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setLeafSize(static_cast<float>(leaf), static_cast<float>(leaf), static_cast<float>(leaf));
  grid.setInputCloud(cloud);
  auto out = std::make_shared<Cloud>();
  grid.filter(*out);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string folder = argv[1], way = argv[2];
  const std::vector<Scan> scans = read_scans(folder);
  const Truth truth(folder);
  const Gyroscopes gyroscopes(folder);
  const double reference = way == "undistorted" ? 0 : scan_time / 2;  // in each scan [s]

  const auto cloud_of = [&](const Scan& scan, const Pose& step) {
    auto cloud = std::make_shared<Cloud>();
    const Eigen::Quaterniond back = gyroscopes.at(scan.stamp + reference).conjugate();
    const Eigen::Vector3d velocity = step.linear().transpose() * step.translation() / scan_time;
    for (const auto& [x, y, z, time] : scan.points) {
      Eigen::Vector3d point(x, y, z);
      if (way == "undone") point = back * (gyroscopes.at(scan.stamp + time) * point) + velocity * (time - reference);
      if (point.norm() < 60) cloud->emplace_back(float(point.x()), float(point.y()), float(point.z()));
    }
    return thinned(cloud);
  };

  struct Kept {
    Pose pose;
    Cloud::Ptr cloud;
  };
  std::deque<Kept> map;
  Pose pose = Pose::Identity(), step = Pose::Identity();
  for (const Scan& scan : scans) {
    const Cloud::Ptr cloud = cloud_of(scan, step);
    if (!map.empty()) {
      auto target = std::make_shared<Cloud>();
      for (const Kept& kept : map) {
        Cloud moved;
        pcl::transformPointCloud(*kept.cloud, moved, (pose.inverse() * kept.pose).matrix().cast<float>().eval());
        *target += moved;
      }
      pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> registration;
      registration.setMaxCorrespondenceDistance(1);
      registration.setMaximumIterations(30);
      registration.setTransformationEpsilon(1e-4);
      registration.setRotationEpsilon(1e-4);
      registration.setInputSource(cloud);
      registration.setInputTarget(thinned(target));
      Cloud aligned;
      registration.align(aligned, step.matrix().cast<float>());
      step = Pose(registration.getFinalTransformation().cast<double>());
      pose = pose * step;
    }
    map.push_back({pose, cloud});
    if (map.size() > window) map.pop_front();
  }
  const double first = scans.front().stamp + reference, last = scans.back().stamp + reference;
  const Pose moved = truth.at(first).inverse() * truth.at(last);
  std::cout << 100 * (moved.translation() - pose.translation()).norm() / truth.length(first, last) << '\n';
}
