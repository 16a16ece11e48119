// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/source.hpp>

#include <string>

#include <doctest/doctest.h>

#include "helios/xml_reading.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

/// What is told of a filter.
template <class Source>
std::string filter_told(const std::string& params, Source& source) {
  return support::xml_told("<f><filter type=\"x\">" + params + "</filter></f>", [&](XmlInput& outer) {
    outer.know({}, {"filter"});
    XmlInput io(outer.document(), outer.node().child("filter"), outer.report(), outer.search(), true);
    xml::fields(io, source);
    io.finish();
  });
}

}  // namespace

TEST_CASE("a cloud that says little has the defaults of the format") {
  XyzSource cloud;
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="separator" value=""/><param key="voxelSize" value="1"/>)", cloud)
            .empty());
  CHECK(cloud.files.at(0).filename() == "mesh.obj");
  CHECK(cloud.voxel_size == 1);
  CHECK(cloud.separator.empty());
  CHECK(cloud.normal_columns[2] == 5);
  XyzSource other;
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/>)", other), "has no param 'voxelSize'"));
  const std::string odd =
      R"(<param key="filepath" value="mesh.obj"/><param key="voxelSize" value="0"/><param key="defaultNormal" value="0;0;0"/>)";
  CHECK(filter_told(odd, other).starts_with("\nwarning "));
  CHECK(contains(filter_told(odd, other), "a.xml:1:84: voxelSize of 0 means 1 m"));
  CHECK(contains(filter_told(odd, other), "defaultNormal is zero: it has no direction, and no effect"));
  CHECK(other.voxel_size == 1);
  CHECK_FALSE(other.default_normal);
  CHECK(contains(filter_told(R"(<param key="normalXIndex" value="1000"/>)", other), "from 0 to 999"));
  CHECK(contains(filter_told(R"(<param key="colour" value="1"/>)", other), "rgbRIndex, rgbGIndex"));  // each once
  for (const char* name : {"rgbRIndex", "rgbGIndex", "rgbBIndex", "maxColorValue", "sparse"}) {
    const std::string told = filter_told("<param key=\"filepath\" value=\"mesh.obj\"/><param key=\"voxelSize\" value=\"1\"/><param key=\"" +
                                             std::string(name) + "\" value=\"1\"/>",
                                         other);
    CHECK(contains(told, "warning"));
    CHECK(contains(told, "param '" + std::string(name) + "' has no effect"));
  }
}

TEST_CASE("files may be one, those of a pattern, or a list") {
  ObjSource one, pattern, list, none;
  CHECK(filter_told(R"(<param key="filepath" value="mesh.obj"/>)", one).empty());
  CHECK(filter_told(R"(<param key="filepath" value="nothing"/><param key="efilepath" value="m.*"/>)", pattern).empty());
  CHECK(filter_told(R"(<param key="filepaths" value="mesh.obj|a.xml"/>)", list).empty());
  CHECK(one == pattern);
  CHECK(list.files.size() == 2);
  CHECK(contains(filter_told(R"(<param key="filepaths" value="mesh.obj|b.xml"/>)", none), "filepaths=\"b.xml\" does not exist"));
  CHECK(contains(filter_told("", none), "has no param 'filepath'"));
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="up" value="x"/>)", none), "up=\"x\" is not known"));
}

TEST_CASE("voxels have a mode, a table and a material") {
  VoxelSource voxels;
  CHECK(filter_told(
            R"(<param key="filepath" value="mesh.obj"/><param key="intersectionMode" value="Fixed"/><param key="ladlut" value="mesh.obj"/>
      <param key="matfile" value="mesh.obj"/><param key="matname" value="leaf"/><param key="randomMaterials" value="3"/>)",
            voxels)
            .empty());
  CHECK(voxels.mode == VoxelMode::fixed);
  CHECK(voxels.leaf_angles.filename() == "mesh.obj");
  CHECK(voxels.material.name == "leaf");
  CHECK(voxels.material.random == 3);
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="ladlut" value="no.txt"/>)", voxels), "does not exist"));
  CHECK(contains(filter_told(R"(<param key="filepath" value="mesh.obj"/><param key="intersectionArgument" value="-1"/>)", voxels),
                 "from 0 to 100"));
}
