// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/citygml.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

/// Leaks of the XML parser of libcitygml at damaged files, for the address sanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libxerces-c\n"; }

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;

namespace {

using Folder = support::TemporaryFolder;

std::string ring(const std::string& positions) {
  return "<gml:LinearRing><gml:posList srsDimension=\"3\">" + positions + "</gml:posList></gml:LinearRing>";
}
std::string polygon(const std::string& id, const std::string& outer, const std::string& inner = "") {
  return "<gml:surfaceMember><gml:Polygon gml:id=\"" + id + "\"><gml:exterior>" + ring(outer) + "</gml:exterior>" +
         (inner.empty() ? "" : "<gml:interior>" + ring(inner) + "</gml:interior>") +
         "</gml:Polygon></gml:surfaceMember>";
}
/// Surfaces of a level of detail of a room of CityGML.
std::string surfaces(const std::string& room, int lod, const std::string& polygons) {
  const std::string name = room + ":lod" + std::to_string(lod) + "MultiSurface";
  return "<" + name + "><gml:MultiSurface>" + polygons + "</gml:MultiSurface></" + name + ">";
}
std::string replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}
std::string element(const std::string& name, const std::string& id, const std::string& inner) {
  return "<" + name + " gml:id=\"" + id + "\">" + inner + "</" + name + ">";
}
std::string bounded(const std::string& name, const std::string& id, const std::string& polygons, int lod = 2) {
  return "<bldg:boundedBy>" + element("bldg:" + name, id, surfaces("bldg", lod, polygons)) + "</bldg:boundedBy>";
}
std::string city(const std::vector<std::string>& members,
                 const std::string& system = "urn:ogc:def:crs,crs:EPSG:6.12:25832,crs:EPSG::5783",
                 const std::string& prolog = "") {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + prolog +
                     "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" "
                     "xmlns:gml=\"http://www.opengis.net/gml\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"";
  for (const auto& [prefix, room] : std::vector<std::pair<std::string, std::string>>{{"bldg", "building"},
                                                                                     {"veg", "vegetation"},
                                                                                     {"dem", "relief"},
                                                                                     {"tran", "transportation"},
                                                                                     {"wtr", "waterbody"},
                                                                                     {"brid", "bridge"},
                                                                                     {"luse", "landuse"},
                                                                                     {"app", "appearance"}})
    text += " xmlns:" + prefix + "=\"http://www.opengis.net/citygml/" + room + "/2.0\"";
  text += ">\n<gml:boundedBy><gml:Envelope srsName=\"" + system +
          "\" srsDimension=\"3\"><gml:lowerCorner>0 0 0</gml:lowerCorner><gml:upperCorner>1 1 "
          "1</gml:upperCorner></gml:Envelope></gml:boundedBy>\n";
  for (const std::string& member : members) text += "<cityObjectMember>" + member + "</cityObjectMember>\n";
  return text + "</CityModel>\n";
}

const std::string small = "500020 5400000 99 500021 5400000 99 500020 5400001 99 500020 5400000 99";

/// A house of 10 m x 8 m with a court of 2 m x 2 m in its roof, in UTM, and another shape of it of less detail.
std::string house() {
  return element("bldg:Building", "house",
                 surfaces("bldg", 1, polygon("p0", small)) +
                     bounded("RoofSurface", "roof",
                             polygon("p1",
                                     "500000.125 5400000.5 110 500010.125 5400000.5 110 500010.125 5400008.5 110 "
                                     "500000.125 5400008.5 110 500000.125 "
                                     "5400000.5 110",
                                     "500002.125 5400002.5 110 500002.125 5400004.5 110 500004.125 5400004.5 110 "
                                     "500004.125 5400002.5 110 500002.125 "
                                     "5400002.5 110")) +
                     bounded("WallSurface", "wall",
                             polygon("p2",
                                     "500000.125 5400000.5 100 500010.125 5400000.5 100 500010.125 5400000.5 110 "
                                     "500000.125 5400000.5 110 500000.125 "
                                     "5400000.5 100")) +
                     bounded("ClosureSurface", "gate", polygon("p3", small)) + "<bldg:interiorRoom>" +
                     element("bldg:Room", "room", bounded("CeilingSurface", "ceiling", polygon("p4", small))) +
                     "</bldg:interiorRoom>");
}

/// A tree of one triangle, in a frame of its own, turned by 90 degrees about z and of twice the size; or one that shows
/// the same.
std::string tree(const std::string& id, const std::string& geometry, const std::string& matrix, const std::string& at) {
  return element("veg:SolitaryVegetationObject", id,
                 "<veg:lod2ImplicitRepresentation><ImplicitGeometry><transformationMatrix>" + matrix +
                     "</transformationMatrix>" + geometry + "<referencePoint><gml:Point><gml:pos srsDimension=\"3\">" +
                     at +
                     "</gml:pos></gml:Point></referencePoint></ImplicitGeometry></veg:lod2ImplicitRepresentation>");
}

/// Area of the surfaces of a material of a mesh [m^2].
double area(const MeshFile& file, std::size_t mesh, const std::string& name) {
  double sum = 0;
  const FileMesh& one = file.meshes.at(mesh);
  for (std::size_t i = 0; i < one.mesh.triangles.size(); ++i) {
    const std::uint32_t material = one.mesh.materials.empty() ? 0 : one.mesh.materials[i];
    const Triangle t = one.mesh.triangle(i);
    if (file.materials[one.materials[material]].name == name) sum += length(cross(t.b - t.a, t.c - t.a)) / 2;
  }
  return sum;
}

const Material& material(const MeshFile& file, const std::string& name) {
  const auto found =
      std::find_if(file.materials.begin(), file.materials.end(), [&](const Material& m) { return m.name == name; });
  REQUIRE(found != file.materials.end());
  return *found;
}

}  // namespace

TEST_CASE("a house has its surfaces of the highest level of detail, by class, in double precision") {
  const Folder folder;
  const auto path = folder.write("a.gml", city({house()}));
  for (const bool isolated : {false, true}) {
    const CityGml read = read_citygml(path, {.isolated = isolated});
    CHECK(read.epsg == 25832);
    const MeshFile& file = read.file;
    REQUIRE(file.placements.size() == 1);
    CHECK(file.placements[0].name == "house");
    CHECK(area(file, 0, "RoofSurface") == doctest::Approx(10 * 8 - 2 * 2).epsilon(1e-9));
    CHECK(area(file, 0, "WallSurface") == doctest::Approx(100).epsilon(1e-9));
    CHECK(file.materials.size() == 2);
    CHECK(material(file, "RoofSurface").classification == 6);
    Box box;
    for (const Vec3& vertex : file.meshes[0].mesh.vertices) {
      box.extend(file.placements[0].placement.point(vertex));
      CHECK(max_norm(vertex) < 20);  // near its origin
    }
    CHECK(box.min == Vec3(500000.125, 5400000.5, 100));
    CHECK(box.max == Vec3(500010.125, 5400008.5, 110));
  }
  const MeshFile coarse = read_citygml(path, {.max_lod = 1}).file;
  REQUIRE(coarse.meshes.size() == 1);
  CHECK(area(coarse, 0, "Building") == doctest::Approx(0.5));
  CHECK(area(read_citygml(path, {.interior = true}).file, 0, "CeilingSurface") == doctest::Approx(0.5));
}

TEST_CASE("classes of CityGML have classes of ASPRS") {
  const auto only = [](const std::string& member) {
    const Folder folder;
    const MeshFile file = read_citygml(folder.write("a.gml", city({member}))).file;
    REQUIRE(file.materials.size() == 1);
    REQUIRE(file.placements.size() == 1);
    CHECK(file.placements[0].name == "x");
    CHECK(file.materials[0].reflectance == 0.5);
    return file.materials[0];
  };
  const auto of = [&](const std::string& room, const std::string& name) {
    return only(element(room + ":" + name, "x", surfaces(room, 2, polygon("p", small))));
  };
  CHECK(of("bldg", "Building").classification == 6);
  CHECK(of("veg", "PlantCover").classification == 5);
  CHECK(of("luse", "LandUse").classification == 2);
  CHECK(of("tran", "Road").classification == 11);
  CHECK(of("tran", "Railway").classification == 10);
  CHECK(of("wtr", "WaterBody").classification == 9);
  CHECK(of("brid", "Bridge").classification == 17);
  CHECK(of("tran", "Road").ground);
  CHECK_FALSE(of("veg", "PlantCover").ground);
  CHECK(only(element("bldg:Building", "x", bounded("GroundSurface", "g", polygon("p", small)))).classification == 2);
  const Material relief = only(element(
      "dem:ReliefFeature", "x",
      "<dem:lod>2</dem:lod><dem:reliefComponent>" +
          element("dem:TINRelief", "tin",
                  "<dem:lod>2</"
                  "dem:lod><dem:tin><gml:TriangulatedSurface><gml:trianglePatches><gml:Triangle><gml:exterior>" +
                      ring(small) +
                      "</gml:exterior></gml:Triangle></gml:trianglePatches></gml:TriangulatedSurface></dem:tin>") +
          "</dem:reliefComponent>"));
  CHECK(relief.name == "TINRelief");
  CHECK(relief.classification == 2);
  CHECK(relief.ground);
}

TEST_CASE("trees of one implicit geometry share it, and a name table gives its material") {
  const Folder folder;
  const std::string own = "<relativeGMLGeometry><gml:MultiSurface gml:id=\"shape\">" +
                          polygon("p", "0 0 0 1 0 0 0 0 1 0 0 0") + "</gml:MultiSurface></relativeGMLGeometry>";
  const auto path =
      folder.write("a.gml", city({tree("t1", own, "0 -2 0 1 2 0 0 2 0 0 2 3 0 0 0 1", "500020 5400000 100"),
                                  tree("t2", "<relativeGMLGeometry xlink:href=\"#shape\"/>",
                                       "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "500030 5400000 100")}));
  const auto table = folder.write(
      "a.mtl", "newmtl SolitaryVegetationObject\nKd 1 1 1\nhelios_reflectance 0.4\nhelios_classification 4\n");
  const MeshFile file = read_citygml(path, {.materials = table}).file;
  CHECK(file.meshes.size() == 1);
  REQUIRE(file.placements.size() == 2);
  CHECK(file.placements[0].name == "t1");
  CHECK(length(file.placements[0].placement.point({1, 0, 0}) - Vec3(500021, 5400004, 103)) < 1e-8);
  CHECK(length(file.placements[1].placement.point({1, 0, 0}) - Vec3(500031, 5400000, 100)) < 1e-8);
  CHECK(file.materials[0].classification == 4);
  CHECK(file.materials[0].reflectance == 0.4);
  const auto parts = parts_of(file, 10);
  CHECK(parts[0].geometry == parts[1].geometry);
  CHECK(parts[1].object == 11);
}

TEST_CASE("codes of reference systems are found in their names") {
  CHECK(io::detail::epsg_of("urn:ogc:def:crs,crs:EPSG:6.12:25832,crs:EPSG::5783") == 25832);
  CHECK(io::detail::epsg_of("urn:ogc:def:crs:EPSG::31467") == 31467);
  CHECK(io::detail::epsg_of("http://www.opengis.net/def/crs/EPSG/0/7415") == 7415);
  CHECK(io::detail::epsg_of("EPSG:2056+5728") == 2056);
  CHECK_FALSE(io::detail::epsg_of("urn:adv:crs:DE_DHDN_3GK2*DE_DHN_92_NH"));
}

TEST_CASE("a solid that refers to the surfaces of a building has each once, with the class of the surface") {
  const std::string solid =
      "<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember xlink:href=\"#p1\"/>"
      "</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>";
  const Folder folder;
  for (const bool before : {false, true}) {
    const std::string roof = bounded("RoofSurface", "roof", polygon("p1", small));
    const std::string building = element("bldg:Building", "b", before ? solid + roof : roof + solid);
    const MeshFile file = read_citygml(folder.write("a.gml", city({building}))).file;
    REQUIRE(file.triangle_count() == 1);
    CHECK(file.materials[0].name == "RoofSurface");
  }
}

TEST_CASE("degrees are known by the size of objects, whatever the code of their system, and files of trees are noted") {
  const Folder folder;
  const auto square = [](double x, double y, double size) {
    std::string text;
    for (const auto& [i, k] : std::vector<std::pair<int, int>>{{0, 0}, {1, 0}, {1, 1}, {0, 0}})
      text += text::to_text(x + i * size) + ' ' + text::to_text(y + k * size) + " 3 ";
    text.pop_back();
    return element("bldg:Building", "b", surfaces("bldg", 1, polygon("p", text)));
  };
  const auto read = [&](const std::string& one, const char* code) {
    return read_citygml(folder.write("a.gml", city({one}, code))).file;
  };
  CHECK(contains(support::file_error([&] { (void)read(square(35.6, 139.7, 1e-4), "EPSG:6697"); }).problem(),
                 "in degrees or geocentric, by 'EPSG:6697' or its size"));
  CHECK(read(square(0, 0, 0.1), "EPSG:25832").triangle_count() == 1);
  CHECK(read(square(500000, 5400000, 0.01), "EPSG:25832").triangle_count() == 1);
  const MeshFile none = read(
      tree("t", "<libraryObject>tree.x3d</libraryObject>", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "1 2 3"), "EPSG:25832");
  CHECK(std::ranges::any_of(none.warnings, [](const std::string& one) {
    return contains(one, "implicit geometries that are files of their own are left out");
  }));
}

TEST_CASE("elements and attributes of CityGML are read, noted and refused by the rules") {
  const Folder folder;
  const std::string sound =
      city({house(), tree("t",
                          "<relativeGMLGeometry><gml:MultiSurface>" + polygon("t0", "0 0 0 1 0 0 0 1 0 0 0 0") +
                              "</gml:MultiSurface></relativeGMLGeometry>",
                          "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "0 0 0")});
  const auto warnings = [&](const std::string& text) {
    const MeshFile file = read_citygml(folder.write("a.gml", text)).file;
    CHECK(file.placements.size() == 2);
    return file.warnings;
  };
  CHECK(warnings(sound).empty());  // also without a note for the closing corner of each polygon
  std::vector<test::FormatCase> cases;
  for (const std::string_view row : {"posList", "srsName", "transformationMatrix"})
    cases.push_back({row, [&] { return warnings(sound); }});
  const auto with = [&](std::string_view row, const std::string& from, const std::string& to) {
    cases.push_back({row, [&, from, to] { return warnings(replaced(sound, from, to)); }});
  };
  const std::string in = "<bldg:lod1MultiSurface>", end = "<cityObjectMember>";
  with("another srsName", "<gml:MultiSurface>", "<gml:MultiSurface srsName='EPSG:25833'>");
  with("srsDimension=\"2\"", "posList srsDimension=\"3\"", "posList srsDimension=\"2\"");
  with("uomLabels", "posList srsDimension", "posList uomLabels=\"ft ft ft\" srsDimension");
  with("last row of a transformationMatrix", "0 0 0 1</", "0 0 0 2</");
  with("libraryObject", "<relativeGMLGeometry", "<libraryObject>tree.x3d</libraryObject><relativeGMLGeometry");
  with("citygml/3.0", "citygml/2.0", "citygml/3.0");
  for (const std::string_view name :
       {"coordinates", "outerBoundaryIs", "innerBoundaryIs", "surfaceMembers", "Ring", "Tin"})
    with(name, in, element("gml:" + std::string(name), "x", "") + in);
  with("RasterRelief", end, element("dem:RasterRelief", "x", "") + end);
  with("terminationDate", in, "<terminationDate>2010-01-01</terminationDate>" + in);
  for (const std::string_view name : {"X3DMaterial", "ParameterizedTexture", "GeoreferencedTexture"})
    with(name, end,
         "<app:appearanceMember><app:Appearance><app:surfaceDataMember><app:" + std::string(name) +
             "/></app:surfaceDataMember></app:Appearance></app:appearanceMember>" + end);
  with("measureAttribute", in, "<measureAttribute name=\"h\"><value uom=\"m\">3</value></measureAttribute>" + in);
  with("*", in, "<bldg:lod0FootPrint/>" + in);
  test::check_rules(io::detail::city_rules, cases);
}

TEST_CASE("systems of CityGML that may not be in metres are noted by their code") {
  const Folder folder;
  const auto is_noted = [&](const std::string& system) {
    const auto warnings = read_citygml(folder.write("a.gml", city({house()}, system))).file.warnings;
    return std::ranges::any_of(warnings, [](const std::string& one) { return contains(one, "metres are assumed"); });
  };
  for (const char* in_metres : {"EPSG:25832", "urn:ogc:def:crs:EPSG::28992", "EPSG:7415", "EPSG:5555", "EPSG:32633"})
    CHECK_FALSE_MESSAGE(is_noted(in_metres), in_metres);
  for (const char* in_feet : {"EPSG:2263", "urn:ogc:def:crs:EPSG::2225"}) CHECK_MESSAGE(is_noted(in_feet), in_feet);
  const auto warnings = read_citygml(folder.write("a.gml", city({house()}, "EPSG:2065"))).file.warnings;
  CHECK(std::ranges::any_of(warnings, [](const std::string& one) { return contains(one, "axis to the west"); }));
}

TEST_CASE("CityGML files that are not for us are explained") {
  const Folder folder;
  const auto problem = [&](const std::string& text) {
    return support::file_error([&] { (void)read_citygml(folder.write("a.gml", text)); }).problem();
  };
  CHECK(contains(problem(city({house()}, "urn:ogc:def:crs:EPSG::4326")), "in degrees"));
  CHECK(contains(problem(city({house()}, "EPSG:4978")), "geocentric"));
  CHECK(contains(problem(city({house()}, "EPSG:25832", "<!DOCTYPE a [<!ENTITY b SYSTEM \"file:///etc/passwd\">]>\n")),
                 "document type"));
  CHECK(contains(
      problem(city({house()}, "EPSG:25832", "<!-- " + std::string(std::size_t{1} << 20, ' ') + " -->\n<!DOCTYPE a>\n")),
      "document type"));
  CHECK(contains(problem(std::string("<\0?\0x\0m\0l\0", 10)), "UTF-8"));
  CHECK(contains(problem("no xml"), "does not begin as XML"));
  const std::string hidden =
      "+ADwAIQ-DOCTYPE d SYSTEM +ACI-http://127.0.0.1:1/x.dtd+ACIAPg-";  // a document type in UTF-7
  CHECK(
      contains(problem(replaced(city({house()}, "EPSG:25832", hidden), "UTF-8", "UTF-7")), "has the encoding 'UTF-7'"));
  for (const char* encoding : {"UTF-8", "utf-8", "US-ASCII", "iso-8859-1"})
    CHECK(read_citygml(folder.write("a.gml", replaced(city({house()}), "UTF-8", encoding))).file.placements.size() ==
          1);
  CHECK(contains(problem("<a>"), "no CityGML file that can be read"));
  CHECK(contains(problem(""), "is empty"));
  CHECK_THROWS_AS((void)read_citygml(folder / "a.gml", {.max_lod = 5}), SettingError);
  CHECK(is_citygml("a/b.GML"));
  CHECK_FALSE(is_citygml("b.xml"));
}

TEST_CASE("CityGML files that are cut off or spoilt are read or explained") {
  const Folder folder;
  const std::string sound = city(
      {house(), tree("t", "<relativeGMLGeometry xlink:href=\"#p1\"/>", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "0 0 0")});
  const std::array<const char*, 12> words{
      "nan",  "1e999", "-1",        "99999999999999999999", "<",       "</gml:Polygon>", "&lt;",
      "&#0;", "]]>",   "<![CDATA[", "xlink:href=\"#p1\"",   "\xFF\xFE"};
  int read = 0, explained = 0;
  const auto tally = [&](const std::string& text) {
    const auto path = folder.write("a.gml", text);
    try {
      const CityGml city = read_citygml(path, {.isolated = true, .limits = {.memory = 5e8, .time = 2}});
      for (const FileMesh& one : city.file.meshes) one.mesh.validate();
      ++read;
    } catch (const FileError& error) {
      CHECK(error.path() == path.string());
      ++explained;
    } catch (const SettingError&) {
      ++explained;
    }
  };
  tally(sound);
  CHECK(read == 1);
  for (std::size_t part = 1; part < 16; ++part) tally(sound.substr(0, sound.size() * part / 16));
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    tally(support::spoilt(sound, 1 + seed / 10, words, random));
  }
  CHECK(read + explained == 76);
  CHECK(explained > 20);
  std::string deep;
  for (int i = 0; i < 5000; ++i)
    deep += "<bldg:Building><bldg:consistsOfBuildingPart><bldg:BuildingPart><bldg:consistsOfBuildingPart>";
  tally(city({deep}));
  rusage used{};
  REQUIRE(::getrusage(RUSAGE_CHILDREN, &used) == 0);
  CHECK(used.ru_maxrss < 2'000'000);  // [KiB]
}
