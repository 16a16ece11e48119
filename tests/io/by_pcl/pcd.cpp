// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <pulsecast/io/pcd.hpp>
#include <pulsecast/io/scan_splitter.hpp>

#include "io/by_pcl/wrong_points.hpp"
#include "support/random_pulses.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::RandomPulses;
using support::TemporaryFolder;

constexpr std::array encodings{PcdEncoding::ascii, PcdEncoding::binary, PcdEncoding::binary_compressed};

/// Number of fields and numbers of a cloud that are not those of the points.
std::size_t differences(const pcl::PCLPointCloud2& cloud, const PointBuffer& points) {
  const std::vector<PointField>& fields = points.layout().fields;
  REQUIRE(cloud.fields.size() == fields.size());
  REQUIRE(std::size_t{cloud.width} * cloud.height == points.size());
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    wrong +=
        cloud.fields[k].name != fields[k].name || cloud.fields[k].datatype != static_cast<std::uint8_t>(fields[k].type);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto* const at =
          reinterpret_cast<const std::byte*>(cloud.data.data() + i * cloud.point_step + cloud.fields[k].offset);
      const double number = number_in(at, {.type = fields[k].type});
      const double expected = points.number(i, fields[k]);
      wrong += !(number == expected || (std::isnan(number) && std::isnan(expected)));
    }
  }
  return wrong;
}

/// Labels without part and material, which are infinite as long as surfaces are unknown, and NaN for the velocity of
/// most.
PointLayout labelled() {
  return layouts::velodyne().with(layouts::labels()).with({{"radial", NumberType::float32, column("radial_velocity")}});
}

TEST_CASE("PCL reads the same numbers from all encodings, with labels and NaN") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    for (const PcdEncoding encoding : encodings) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(encoding));
      const RandomPulses pulses(1 + 300 * seed, seed);
      PointBuffer points(labelled());
      points(pulses.batch());
      const TemporaryFolder folder;
      PcdWriter writer(folder / "a.pcd", {.encoding = encoding, .layout = labelled()});
      writer(pulses.batch());
      writer.close();
      pcl::PCLPointCloud2 cloud;
      REQUIRE(pcl::PCDReader().read((folder / "a.pcd").string(), cloud) == 0);
      CHECK(differences(cloud, points) == 0);
      if (points.size() > 0) {
        cloud.data[cloud.data.size() / 2] ^= 1;
        CHECK(differences(cloud, points) > 0);
      }
    }
  }
}

TEST_CASE("PCL reads points of its own type, from scans written one by one") {
  const RandomPulses pulses(2000, 7);
  for (const PcdEncoding encoding : encodings) {
    CAPTURE(static_cast<int>(encoding));
    const TemporaryFolder folder;
    PcdWriter writer(folder / "a.pcd", {.encoding = encoding});
    ScanSplitter splitter(PointBuffer(layouts::xyzi()), 10, [&](const PointBuffer& scan) { writer.add(scan); });
    splitter(pulses.batch());
    splitter.close();
    writer.close();
    pcl::PointCloud<pcl::PointXYZI> cloud;
    REQUIRE(pcl::io::loadPCDFile<pcl::PointXYZI>((folder / "a.pcd").string(), cloud) == 0);
    CHECK(wrong_points(cloud, pulses) == 0);
  }
}

TEST_CASE("PCL reads a cloud without points") {
  for (const PcdEncoding encoding : encodings) {
    CAPTURE(static_cast<int>(encoding));
    const TemporaryFolder folder;
    PcdWriter(folder / "a.pcd", {.encoding = encoding}).close();
    pcl::PCLPointCloud2 cloud;
    CHECK(pcl::PCDReader().read((folder / "a.pcd").string(), cloud) == 0);
    CHECK(cloud.width * cloud.height == 0);
    CHECK(cloud.data.empty());
  }
}

}  // namespace
}  // namespace pulsecast::io
