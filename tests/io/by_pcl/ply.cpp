// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <pulsecast/io/ply.hpp>
#include <pulsecast/io/scan_splitter.hpp>

#include "io/by_pcl/wrong_points.hpp"
#include "support/random_pulses.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::RandomPulses;
using support::TemporaryFolder;

TEST_CASE("PCL reads the same numbers from PLY, of all types") {
  const std::vector<PointLayout> all{layouts::map(), layouts::livox(), layouts::velodyne().with(layouts::labels()),
                                     PointLayout::packed(layouts::xyz_float())
                                         .with({{"a", NumberType::int8, column("ring"), -1},
                                                {"b", NumberType::int16, column("x"), 7},
                                                {"c", NumberType::int32, column("y"), 1e3},
                                                {"d", NumberType::float32, column("radial_velocity")}})};
  for (const PointLayout& layout : all)
    for (std::uint64_t seed = 1; seed < 5; ++seed) {
      CAPTURE(layout.fields.back().name);
      CAPTURE(seed);
      const RandomPulses pulses(100 * seed, seed);
      PointBuffer points(layout);
      points(pulses.batch());
      const TemporaryFolder folder;
      PlyWriter writer(folder / "a.ply", {.layout = layout});
      writer(pulses.batch());
      writer.close();
      pcl::PCLPointCloud2 cloud;
      REQUIRE(pcl::PLYReader().read((folder / "a.ply").string(), cloud) == 0);
      REQUIRE(cloud.fields.size() == layout.fields.size());
      REQUIRE(std::size_t{cloud.width} * cloud.height == points.size());
      std::size_t wrong = 0;
      for (std::size_t k = 0; k < layout.fields.size(); ++k) {
        CHECK(cloud.fields[k].name == layout.fields[k].name);
        CHECK(cloud.fields[k].datatype == static_cast<std::uint8_t>(layout.fields[k].type));
        for (std::size_t i = 0; i < points.size(); ++i) {
          const auto* const at =
              reinterpret_cast<const std::byte*>(cloud.data.data() + i * cloud.point_step + cloud.fields[k].offset);
          const double expected = points.number(i, layout.fields[k]);
          const double number = number_in(at, {.type = layout.fields[k].type});
          wrong += !(number == expected || (std::isnan(number) && std::isnan(expected)));
        }
      }
      CHECK(wrong == 0);
    }
}

TEST_CASE("PCL reads points of its own type from PLY, from scans written one by one") {
  const RandomPulses pulses(2000, 7);
  const TemporaryFolder folder;
  PlyWriter writer(folder / "a.ply", {.layout = layouts::xyzi()});
  ScanSplitter splitter(PointBuffer(layouts::xyzi()), 10, [&](const PointBuffer& scan) { writer.add(scan); });
  splitter(pulses.batch());
  splitter.close();
  writer.close();
  pcl::PointCloud<pcl::PointXYZI> cloud;
  REQUIRE(pcl::io::loadPLYFile<pcl::PointXYZI>((folder / "a.ply").string(), cloud) == 0);
  CHECK(wrong_points(cloud, pulses) == 0);
}

TEST_CASE("PCL reads a PLY without points") {
  const TemporaryFolder folder;
  PlyWriter(folder / "a.ply").close();
  pcl::PCLPointCloud2 cloud;
  CHECK(pcl::PLYReader().read((folder / "a.ply").string(), cloud) == 0);
  CHECK(cloud.data.empty());
}

}  // namespace
}  // namespace pulsecast::io
