// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>
#include <sys/types.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "report.hpp"
#include "scenes.hpp"

/// Embree 3 on the benchmarks' meshes and rays, for comparison. Source: Wald, Woop, Benthin, Johnson & Ernst 2014.
namespace bench {

/// Name and version of the library that is in use, such as "Embree 3.13.5".
[[nodiscard]] inline std::string embree_name() {
  const RTCDevice device = rtcNewDevice("threads=1");
  std::string name = "Embree";
  for (const RTCDeviceProperty part :
       {RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_DEVICE_PROPERTY_VERSION_MINOR, RTC_DEVICE_PROPERTY_VERSION_PATCH})
    name += (name == "Embree" ? " " : ".") + std::to_string(rtcGetDeviceProperty(device, part));
  rtcReleaseDevice(device);
  return name;
}

/// A mesh built by Embree, on `threads` threads.
class EmbreeMesh {
 public:
  EmbreeMesh(const MeshData& mesh, RTCBuildQuality quality, bool robust, unsigned threads = 1)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())), scene_(rtcNewScene(device_)) {
    rtcSetDeviceMemoryMonitorFunction(device_, monitor, this);
    rtcSetSceneBuildQuality(scene_, quality);
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    for (const Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) corners = std::copy(triangle.begin(), triangle.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    const double start = process_seconds(), start_wall = wall_seconds();
    rtcCommitScene(scene_);
    build_seconds_ = process_seconds() - start;
    build_wall_seconds_ = wall_seconds() - start_wall;
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE) {
      std::fprintf(stderr, "Embree fails with error %d\n", static_cast<int>(error));
      std::exit(1);
    }
  }
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;
  ~EmbreeMesh() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] RTCScene scene() const noexcept { return scene_; }
  [[nodiscard]] double build_seconds() const noexcept { return build_seconds_; }  ///< of the processor, all threads [s]
  [[nodiscard]] double build_wall_seconds() const noexcept { return build_wall_seconds_; }  ///< [s]
  [[nodiscard]] double bytes() const noexcept { return static_cast<double>(bytes_); }  ///< with vertices and corners
  [[nodiscard]] double max_bytes() const noexcept { return static_cast<double>(max_bytes_); }

 private:
  static bool monitor(void* self, ssize_t more, bool) {
    auto& mesh = *static_cast<EmbreeMesh*>(self);
    const std::int64_t now = mesh.bytes_ += more;
    std::int64_t most = mesh.max_bytes_;
    while (now > most && !mesh.max_bytes_.compare_exchange_weak(most, now)) {
    }
    return true;
  }

  std::atomic<std::int64_t> bytes_ = 0, max_bytes_ = 0;
  RTCDevice device_;
  RTCScene scene_;
  double build_seconds_ = 0, build_wall_seconds_ = 0;
};

namespace detail {
template <class Number>
[[nodiscard]] Number& lane(Number& only, std::size_t) noexcept {
  return only;
}
template <class Number, std::size_t Width>
[[nodiscard]] Number& lane(Number (&all)[Width], std::size_t k) noexcept {
  return all[k];
}
}  // namespace detail

/// The rays of bundles in Embree's own layout, for `rtcIntersect1`, `8` or `16`: a bundle in as many packets as it
/// takes. A packet is copied to where it is traced, as a bundle of ours is: tracing writes on it.
template <std::size_t Width>
class EmbreeRays {
 public:
  EmbreeRays(const Bundles& bundles, bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    for (std::size_t i = 0; i < bundles.size(); ++i) {
      const RayBundle rays = bundles[i];
      for (std::size_t first = 0; first < rays.size; first += Width) add(rays, first);
    }
  }

  /// Traces them all, as `sum_of_ranges` of ours does.
  double sum_of_ranges(const EmbreeMesh& mesh) noexcept {
    double sum = 0;
    trace(mesh, [&](float range, bool met) noexcept { sum += met ? double{range} : 0; });
    return sum;
  }

  /// Number of rays that meet anything.
  double occluded(const EmbreeMesh& mesh) noexcept requires(Width == 1) {
    double sum = 0;
    for (const RTCRay& packet : packets_) {
      RTCRay ray = packet;
      rtcOccluded1(mesh.scene(), &context_, &ray);
      sum += ray.tfar < 0 ? 1 : 0;
    }
    return sum;
  }

  /// The range of every ray, infinite where nothing is met.
  [[nodiscard]] std::vector<double> ranges(const EmbreeMesh& mesh) {
    std::vector<double> all;
    trace(mesh,
          [&](float range, bool met) { all.push_back(met ? double{range} : std::numeric_limits<double>::infinity()); });
    return all;
  }

 private:
  using Packet = std::conditional_t<Width == 1, RTCRay, std::conditional_t<Width == 8, RTCRay8, RTCRay16>>;
  using RayHit = std::conditional_t<Width == 1, RTCRayHit, std::conditional_t<Width == 8, RTCRayHit8, RTCRayHit16>>;

  void add(const RayBundle& rays, std::size_t first) {
    using detail::lane;
    Packet& packet = packets_.emplace_back();
    sizes_.push_back(std::min(Width, rays.size - first));
    for (std::size_t k = 0; k < Width; ++k) {
      const std::size_t j = std::min(first + k, rays.size - 1);
      lane(packet.org_x, k) = static_cast<float>(rays.origin.x);
      lane(packet.dir_x, k) = static_cast<float>(rays.x[j]);
      lane(packet.org_y, k) = static_cast<float>(rays.origin.y);
      lane(packet.dir_y, k) = static_cast<float>(rays.y[j]);
      lane(packet.org_z, k) = static_cast<float>(rays.origin.z);
      lane(packet.dir_z, k) = static_cast<float>(rays.z[j]);
      lane(packet.tnear, k) = static_cast<float>(rays.near);
      lane(packet.tfar, k) = static_cast<float>(rays.far);
      lane(packet.time, k) = 0;
      lane(packet.mask, k) = ~0U;
      lane(packet.id, k) = 0;
      lane(packet.flags, k) = 0;
    }
  }

  template <class Take>
  void trace(const EmbreeMesh& mesh, const Take& take) {
    alignas(64) std::array<std::array<int, Width>, Width + 1> valid{};  // by how many rays are in a packet
    for (std::size_t size = 0; size <= Width; ++size) std::fill_n(valid[size].begin(), size, -1);
    RayHit rays;
    for (std::size_t i = 0; i < packets_.size(); ++i) {
      rays.ray = packets_[i];
      for (std::size_t k = 0; k < Width; ++k) detail::lane(rays.hit.geomID, k) = RTC_INVALID_GEOMETRY_ID;
      if constexpr (Width == 1) {
        rays.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(mesh.scene(), &context_, &rays);
      } else {
        std::fill_n(rays.hit.instID[0], Width, RTC_INVALID_GEOMETRY_ID);
        if constexpr (Width == 8)
          rtcIntersect8(valid[sizes_[i]].data(), mesh.scene(), &context_, &rays);
        else
          rtcIntersect16(valid[sizes_[i]].data(), mesh.scene(), &context_, &rays);
      }
      for (std::size_t k = 0; k < sizes_[i]; ++k)
        take(detail::lane(rays.ray.tfar, k), detail::lane(rays.hit.geomID, k) != RTC_INVALID_GEOMETRY_ID);
    }
  }

  RTCIntersectContext context_;
  std::vector<Packet> packets_;
  std::vector<std::size_t> sizes_;  ///< rays in each
};

}  // namespace bench
