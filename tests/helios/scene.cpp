// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <tiffio.h>

#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/scene/object_attributes.hpp>

#include "support/gltf.hpp"
#include "support/las_builder.hpp"
#include "support/png_builder.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::helios {
namespace {

using support::grey_png;
using support::relative;
using support::TemporaryFolder;

/// A square of ground about the origin, and a cube of edge 2 whose bottom is at height 0.
struct Files {
  TemporaryFolder folder;
  Files() {
    std::ofstream(folder / "m.mtl")
        << "newmtl ground\nKd 1 1 1\nhelios_reflectance 0.4\nhelios_isGround true\nhelios_classification 2\n"
           "newmtl wall\nKd 1 1 1\nhelios_reflectance 0.8\nhelios_classification 6\n";
    std::ofstream(folder / "plane.obj")
        << "mtllib m.mtl\nusemtl ground\nv -50 -50 0\nv 50 -50 0\nv 50 50 0\nv -50 50 0\nf 1 2 3 4\n";
    std::ofstream(folder / "cube.obj")
        << "mtllib m.mtl\nusemtl wall\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 2\nv 1 -1 2\nv 1 1 2\n"
           "v -1 1 2\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  }
  [[nodiscard]] PartSettings part(const char* file, std::string id = {}) const {
    return {std::move(id), ObjSource{{folder / file}}, {}, 1, {}, {}, {}, {}};
  }
};

SceneSettings scene_of(std::vector<PartSettings> parts) {
  SceneSettings s;
  s.parts = std::move(parts);
  return s;
}

/// What a ray straight down from a height of 100 m meets.
Hit below(const SurveyScene& scene, double x, double y, double time = 0) {
  RayBundle rays = bundle_of({.origin = {x, y, 100}, .direction = -axis::up});
  rays.tick = Tick::of_seconds(time);
  std::vector<Hit> hits(RayBundle::capacity);
  scene.closest(rays, hits);
  return hits[0];
}

SurveyScene built(SceneSettings settings, SceneBuildOptions options = {}, int run = 0) {
  return SurveyScene(SceneBuilder(std::move(settings), std::move(options)).parts(run), {.to = 10});
}

TEST_CASE("parts are turned, scaled and moved, and keep their ids and materials") {
  const Files files;
  PartSettings cube = files.part("cube.obj", "17");
  cube.transform.scale = 2;
  cube.transform.translation = {10, 5, 0};
  cube.transform.rotations = {{.turns = {{Axis::z, pi / 4}}}};
  const SurveyScene scene = built(scene_of({files.part("plane.obj", "0"), cube}));
  const Hit top = below(scene, 10, 5), ground = below(scene, 0, 0), corner = below(scene, 10 + 2.7, 5),
            beside = below(scene, 10 + 1.9, 5 + 1.9);
  CHECK(top.range == relative(96, 1e-12));
  CHECK(top.object == 17);
  CHECK(top.classification == 6);
  CHECK(top.backscatter == relative(0.8, 1e-12));
  CHECK(corner.object == 17);
  CHECK(beside.object == 0);
  CHECK(ground.range == relative(100, 1e-12));
  CHECK(ground.classification == 2);
  CHECK(scene.ground_height({10, 5}) == 0);
  cube.transform.rotations = {{.turns = {{Axis::x, pi / 2}}},
                              {.turns = {{Axis::z, pi / 2}}}};  // up lies down, and then aside
  const Placement twice = SceneBuilder(scene_of({cube}), {}).parts()[0].placement;
  CHECK(std::fabs((twice.rotation * axis::up).x) == relative(1, 1e-12));
}

TEST_CASE("an id that is no number gives way to the part's place, with a note") {
  const Files files;
  SceneBuilder builder(scene_of({files.part("plane.obj", "floor"), files.part("cube.obj", "house")}), {});
  CHECK(builder.parts()[1].object == 1);
  REQUIRE(builder.warnings().size() == 2);
  CHECK(builder.warnings()[1].find("'house'") != std::string::npos);
}

TEST_CASE("parts that points do not tell apart are told of") {
  const Files files;
  SceneBuilder alike(scene_of({files.part("plane.obj", "3"), files.part("cube.obj", "3")}), {});
  CHECK(alike.parts().size() == 2);
  REQUIRE(alike.warnings().size() == 1);
  CHECK(alike.warnings()[0].find("'3' and '3' have the same object id, 3") != std::string::npos);
  SceneBuilder unlike(scene_of({files.part("plane.obj", "3"), files.part("cube.obj", "4")}), {});
  CHECK(unlike.parts().size() == 2);
  CHECK(unlike.warnings().empty());
}

TEST_CASE("named numbers of a part go to its points by their object") {
  const Files files;
  PartSettings cube = files.part("cube.obj", "17");
  cube.attributes = {{"age", 80}, {"species", 3}};
  const auto simulation = [&](std::vector<PartSettings> parts) {
    return SceneBuilder(scene_of(std::move(parts)), {}).parts();
  };
  const std::vector<SurveyPart> parts = simulation({files.part("plane.obj", "0"), cube});
  const ObjectAttributes all{std::span<const SurveyPart>(parts)};
  CHECK(all.names() == std::vector<std::string>{"age", "species"});
  CHECK(all.of(17)[0] == 80);
  CHECK(all.of(17)[1] == 3);
  CHECK(std::isnan(all.of(0)[0]));
  cube.attributes.push_back({"age", 81});
  CHECK_THROWS_AS(static_cast<void>(simulation({cube})), SettingError);
}

TEST_CASE("leaves of an OBJ file are where their pictures are solid") {
  const Files files;
  std::ofstream(files.folder / "leaf.mtl") << "newmtl leaf\nmap_d leaf.pgm\n";
  std::ofstream(files.folder / "leaf.pgm", std::ios::binary) << "P5 2 1 255\n" << '\xFF' << '\0';
  std::ofstream(files.folder / "leaf.obj") << "mtllib leaf.mtl\nusemtl leaf\nv -1 -1 5\nv 1 -1 5\nv 1 1 5\nv -1 1 5\n"
                                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
  const SurveyScene scene = built(scene_of({files.part("leaf.obj", "1"), files.part("plane.obj", "0")}));
  CHECK(below(scene, -0.5, 0.2).object == 1);
  CHECK(below(scene, 0.5, 0.2).object == 0);
}

TEST_CASE("a part is let down onto the ground") {
  const Files files;
  PartSettings cube = files.part("cube.obj", "1");
  cube.transform.translation = {3, 3, 8};
  cube.transform.on_ground = 1;
  CHECK(below(built(scene_of({cube, files.part("plane.obj", "0")})), 3, 3).range == relative(98, 1e-9));
  std::ofstream(files.folder / "plane.obj")
      << "mtllib m.mtl\nusemtl ground\nv -50 -50 -5\nv 50 -50 5\nv 50 50 5\nv -50 50 -5\nf 1 2 3 4\n";
  cube.transform.translation = {0, 3, 8};
  CHECK(below(built(scene_of({cube, files.part("plane.obj", "0")})), 0, 3).range == relative(98, 1e-9));
  cube.transform.on_ground = -1;  // no part of it below the slope
  CHECK(below(built(scene_of({cube, files.part("plane.obj", "0")})), 0, 3).range == relative(97.9, 1e-9));
  cube.transform.translation = {300, 3, 8};
  SceneBuilder nowhere(scene_of({cube, files.part("plane.obj", "0")}), {});
  CHECK(nowhere.parts()[0].placement.translation.z == 8);
  CHECK(nowhere.warnings().size() == 1);
}

TEST_CASE("without incidence, surfaces send back the same from everywhere") {
  const Files files;
  const SurveyScene scene = built(scene_of({files.part("plane.obj", "0")}), {.fixed_incidence = true});
  RayBundle slanting = bundle_of({.origin = {0, 0, 1}, .direction = normalize(Vec3{5, 0, -1})});
  std::vector<Hit> hits(RayBundle::capacity);
  scene.closest(slanting, hits);
  CHECK(hits[0].backscatter == relative(0.4, 1e-12));
}

MotionSequenceSettings sequence(std::string id, int loop, MotionSettings motion) {
  return {std::move(id), loop, {}, {motion}};
}

TEST_CASE("motions go on from step to step, at the pulse rate") {
  const Files files;
  PartSettings cube = files.part("cube.obj", "1");
  SceneBuildOptions options;
  options.pulse_rate = 1000;
  SUBCASE("a translation, for ever") {
    cube.motions = {sequence("go", 0, {TranslationMotion{{0.01, 0, 0}}})};
    const SurveyScene scene = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(scene, 0, 0, 0).object == 1);
    CHECK(below(scene, 0, 0, 1).object == 0);
    CHECK(below(scene, 20.9, 0, 2).object == 1);
    CHECK(below(scene, 21.1, 0, 2).object == 0);
  }
  SUBCASE("every other step only, for a second, and then back for ever") {
    cube.dynamic_step = 2;
    cube.motions = {sequence("go", 500, {TranslationMotion{{0.01, 0, 0}}}),
                    sequence("back", 0, {TranslationMotion{{0, 0.01, 0}}})};
    cube.motions[0].next = "back";
    const SurveyScene scene = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(scene, 5.995, 0, 1).object == 1);
    CHECK(below(scene, 5.9, 4.5, 2).object == 1);
    CHECK(below(scene, 6.1, 4.5, 2).object == 0);
  }
  SUBCASE("there once, and then up and down for ever") {
    cube.motions = {sequence("go", 100, {TranslationMotion{{0.01, 0, 0}}}),
                    sequence("up", 100, {TranslationMotion{{0, 0.01, 0}}}),
                    sequence("down", 100, {TranslationMotion{{0, -0.01, 0}}})};
    cube.motions[0].next = cube.motions[2].next = "up";
    cube.motions[1].next = "down";
    const SurveyScene scene = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(scene, 1.9, 1.9, 9.8 + 0.2).object == 1);
    CHECK(below(scene, 1.9, -0.1, 9.8 + 0.2).object == 0);
  }
  SUBCASE("in whole intervals of the scene") {
    cube.dynamic_interval = 0.0025;
    cube.motions = {sequence("go", 0, {TranslationMotion{{0.01, 0, 0}}})};
    SceneSettings settings = scene_of({files.part("plane.obj", "0"), cube});
    settings.dynamic_interval = 0.001;
    const SurveyScene scene = built(settings, options);
    CHECK(below(scene, 10.9, 0, 2).object == 1);
    CHECK(below(scene, 11.1, 0, 2).object == 0);
  }
  SUBCASE("a turn about itself stays where it is; one about a place does not") {
    cube.transform.translation = {10, 0, 0};
    const double angle = pi / 4 / 1000;
    cube.motions = {sequence("turn", 0, {RotationMotion{.axis = axis::up, .angle = angle}, true})};
    const SurveyScene own = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(own, 11.3, 0, 1).object == 1);
    CHECK(below(own, 11.3, 0, 0).object == 0);
    cube.motions[0].motions.push_back({TranslationMotion{{0.01, 0, 0}}});
    const SurveyScene rolls = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(rolls, 21.3, 0, 1).object == 1);
    cube.motions = {sequence("turn", 0, {RotationMotion{.axis = axis::up, .angle = 2 * angle}, false, 0})};
    const SurveyScene orbit = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(orbit, 0, 10, 1).object == 1);
    CHECK(below(orbit, 10, 0, 1).object == 0);
  }
  SUBCASE("one mirror is refused; two parallel ones are a way, two that meet are a turn") {
    cube.motions = {sequence("mirror", 0, {ReflectionMotion{}})};
    CHECK_THROWS_AS((void)built(scene_of({cube}), options), SettingError);
    cube.motions = {sequence("mirror", 0, {RotoreflectionMotion{.axis = axis::up, .angle = 0.1}})};
    CHECK_THROWS_AS((void)built(scene_of({cube}), options), SettingError);

    cube.motions = {sequence("glide", 0, {ReflectionMotion{.normal = {3, 4, 0}, .shift = Vec3{0, 0, -0.0005}}})};
    cube.motions[0].motions.push_back(cube.motions[0].motions[0]);
    const SurveyScene sinks = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(sinks, 0, 0, 0).range == relative(98, 1e-12));
    CHECK(below(sinks, 0.9, -0.9, 1.5).range == relative(99.5, 1e-9));

    cube.transform.translation = {10, 0, 0};
    const double half = pi / 4 / 1000;  // twice the angle between the mirrors is that of the turn
    cube.motions = {sequence("turn", 0, {ReflectionMotion{.normal = axis::right}})};
    cube.motions[0].motions.push_back({ReflectionMotion{.normal = {std::cos(half), std::sin(half), 0}}});
    const SurveyScene orbit = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(orbit, 0, 10, 1).object == 1);
    CHECK(below(orbit, 10, 0, 1).object == 0);
    cube.motions = {
        sequence("turn", 0, {RotoreflectionMotion{.axis = axis::up, .angle = half, .center = Vec3{0, 0, 1}}})};
    cube.motions[0].motions.push_back(cube.motions[0].motions[0]);
    const SurveyScene same = built(scene_of({files.part("plane.obj", "0"), cube}), options);
    CHECK(below(same, 0, 10, 1).object == 1);
    CHECK(below(same, 0, 10, 1).range == relative(98, 1e-9));
  }
}

TEST_CASE("swaps take a part's place in later runs") {
  const Files files;
  PartSettings cube = files.part("cube.obj", "1");
  SwapSettings larger, gone;
  larger.step = 2;
  larger.transform.scale = 3;
  gone.removes = true;
  cube.swaps = {larger, gone};
  SceneBuilder builder(scene_of({files.part("plane.obj", "0"), cube}), {});
  CHECK(builder.runs() == 4);
  const std::vector<double> tops{98, 94, 94, 100};
  for (int run = 0; run < 4; ++run) {
    CAPTURE(run);
    CHECK(below(SurveyScene(builder.parts(run), {.to = 1}), 0, 0).range ==
          relative(tops[static_cast<std::size_t>(run)], 1e-12));
  }
}

TEST_CASE("a cloud becomes voxels; those in which no plane fits are left out if normals are to be estimated") {
  const Files files;
  std::ofstream out(files.folder / "cloud.xyz");
  for (int i = 0; i < 100; ++i) out << 0.1 * (i % 10) + 0.05 << ' ' << 0.1 * (i / 10) + 0.05 << " 0.5\n";
  out << "5.5 0.5 0.5\n";
  out.close();
  PartSettings cloud{
      "3",
      XyzSource{
          .files = {files.folder / "cloud.xyz"}, .material = {files.folder / "m.mtl", "wall"}, .estimate_normals = 1},
      {},
      1,
      {},
      {},
      {}};
  const SurveyScene scene = built(scene_of({cloud}));
  CHECK(below(scene, 0.5, 0.5).object == 3);
  CHECK(below(scene, 0.5, 0.5).classification == 6);
  CHECK_FALSE(below(scene, 5.5, 0.5).met());
  std::get<XyzSource>(cloud.source).estimate_normals = 0;
  CHECK(below(built(scene_of({cloud})), 5.5, 0.5).met());
  std::ofstream(files.folder / "few.xyz") << "0 0 0\n5 0 0\n";
  PartSettings few = cloud;
  few.source = XyzSource{.files = {files.folder / "few.xyz"}, .estimate_normals = 1};
  SceneBuilder bare(scene_of({few, cloud}), {});
  CHECK(bare.parts().size() == 1);
  const std::vector<std::string>& told = bare.warnings();
  CHECK(std::any_of(told.begin(), told.end(), [](const std::string& text) {
    return text.find(
               "few.xyz: has no voxel of three points or more, as required by estimateNormals, and is left out") !=
           std::string::npos;
  }));
  std::ofstream(files.folder / "none.mtl") << "# nothing\n";
  PartSettings plain = cloud;
  std::get<XyzSource>(plain.source).material = {files.folder / "none.mtl"};
  SceneBuilder undescribed(scene_of({plain}), {.spectra = {.warnings = {"spectra/a.txt, line 3: odd"}}});
  CHECK(undescribed.parts().at(0).materials->at(0).reflectance == 0.5);
  CHECK(std::any_of(undescribed.warnings().begin(), undescribed.warnings().end(), [](const std::string& text) {
    return text.find("none.mtl: holds no material: a reflectance of 0.5 is assumed") != std::string::npos;
  }));
  CHECK(undescribed.warnings().back() == "spectra/a.txt, line 3: odd");
  std::get<XyzSource>(cloud.source).material.name = "brick";
  CHECK_THROWS_WITH_AS((void)built(scene_of({cloud})),
                       doctest::Contains("holds no material 'brick'; it has ground, wall"), FileError);
}

TEST_CASE("voxels of a LAS file have the classes of its points, if their material has none") {
  const Files files;
  support::LasBuilder las{.minor = 4, .format = 6, .scale = {1, 1, 1}};
  las.points = {{.stored = {0, 0, 0}, .kind = 2}, {.stored = {5, 0, 0}, .kind = 5}, {.stored = {9, 0, 0}}};
  std::ofstream(files.folder / "a.las", std::ios::binary) << las.bytes();
  XyzSource source{.files = {files.folder / "a.las"}, .voxel_size = 1};
  const auto classes = [&](const XyzSource& from) {
    const SurveyScene scene = built(scene_of({PartSettings{"3", from, {}, 1, {}, {}, {}}}));
    const auto at = [&](double x) { return static_cast<int>(below(scene, x, 0).classification); };
    return std::vector<int>{at(0.5), at(5.5), at(8.5)};
  };
  CHECK(classes(source) == std::vector<int>{2, 5, 0});
  source.material.random = 3;
  CHECK(classes(source) == std::vector<int>{0, 0, 0});
  source.material = {files.folder / "m.mtl", "wall"};
  CHECK(classes(source) == std::vector<int>{6, 6, 6});
}

/// Writes a GeoTIFF of 8 bits with a colour table, whose entry n is (n, 255 - n, 255), in pixels of 1 m from (0, rows -
/// 1) on.
void write_palette(const std::filesystem::path& path, std::uint32_t columns, std::uint32_t rows,
                   std::vector<std::uint8_t> codes) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  REQUIRE(tiff != nullptr);
  static const std::vector<TIFFFieldInfo> fields{
      {33550, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("scale")},
      {33922, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("ties")},
      {34735, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, const_cast<char*>("keys")}};
  TIFFMergeFieldInfo(tiff, fields.data(), static_cast<std::uint32_t>(fields.size()));
  std::vector<std::uint16_t> red(256), green(256), blue(256, 65535);
  for (std::size_t i = 0; i < 256; ++i) {
    red[i] = static_cast<std::uint16_t>(257 * i);
    green[i] = static_cast<std::uint16_t>(257 * (255 - i));
  }
  const std::array<double, 3> scale{1, 1, 0};
  const std::array<double, 6> ties{0, 0, 0, -0.5, rows - 0.5, 0};
  const std::array<std::uint16_t, 8> keys{1, 1, 0, 1, 1024, 0, 1, 1};
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, rows);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_PALETTE);
  TIFFSetField(tiff, TIFFTAG_COLORMAP, red.data(), green.data(), blue.data());
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows);
  TIFFSetField(tiff, 33550, 3, scale.data());
  TIFFSetField(tiff, 33922, 6, ties.data());
  TIFFSetField(tiff, 34735, 8, keys.data());
  const auto size = static_cast<tmsize_t>(codes.size());
  REQUIRE(TIFFWriteEncodedStrip(tiff, 0, codes.data(), size) == size);
  TIFFClose(tiff);
}

TEST_CASE("a raster of classes chooses the materials of a raster of heights") {
  const Files files;
  const TemporaryFolder& folder = files.folder;
  // pixels at 0, 1, 2 m east and 1, 0 m north; classes in pixels twice as wide
  std::ofstream(folder / "dem.asc") << "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n7 7 7\n7 7 7\n";
  std::ofstream(folder / "land.ASC") << "ncols 2\nnrows 2\nxllcorner -0.5\nyllcorner -2.5\ncellsize 2\n6 2\n6 9\n";
  SceneSettings scene =
      scene_of({{"1",
                 GeoTiffSource{.files = {folder / "dem.asc"}, .material = {folder / "m.mtl", "ground"}},
                 {},
                 1,
                 {},
                 {},
                 {}}});
  const auto class_at = [&](double x, double y) { return below(built(scene), x, y).classification; };
  CHECK(below(built(scene), 0.25, 0.75).range == relative(93, 1e-12));
  CHECK(class_at(0.25, 0.9) == 2);
  std::get<GeoTiffSource>(scene.parts[0].source).classes = folder / "land.ASC";
  CHECK(class_at(0.25, 0.9) == 6);  // pixel at (0, 1)
  CHECK(class_at(1.9, 0.4) == 2);   // pixel at (2, 0)
  CHECK(below(built(scene), 0.25, 0.9).backscatter == relative(0.8, 1e-12));
  SceneBuilder builder(scene, {});
  CHECK(builder.parts().size() == 1);
  CHECK(builder.warnings().empty());
  std::ofstream(folder / "land.ASC") << "ncols 2\nnrows 2\nxllcorner -0.5\nyllcorner -2.5\ncellsize 2\n6 9\n6 9\n";
  // two more columns of heights to the east
  std::ofstream(folder / "east.asc") << "ncols 2\nnrows 2\nxllcenter 3\nyllcenter 0\ncellsize 1\n7 7\n7 7\n";
  SceneSettings tiled = scene;
  GeoTiffSource& tiles = std::get<GeoTiffSource>(tiled.parts[0].source);
  tiles.files.push_back(folder / "east.asc");
  CHECK(SceneBuilder(tiled, {}).parts().size() == 2);
  CHECK_FALSE(below(built(tiled), 2.5, 0.5).met());
  tiles.mosaic = true;
  CHECK(SceneBuilder(tiled, {}).parts().size() == 1);
  CHECK(below(built(tiled), 2.5, 0.5).range == relative(93, 1e-12));
  SceneBuilder told(scene, {});
  CHECK(told.parts().size() == 1);
  REQUIRE(told.warnings().size() == 1);
  CHECK(told.warnings()[0].find("land.ASC: 2 of 6 pixels have no class with a material, and get 'ground'") !=
        std::string::npos);
}

TEST_CASE("a builder tells each file that it looked for, by whatever name, and those that are missing, too") {
  const Files files;
  const TemporaryFolder& folder = files.folder;
  const auto put = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  using Names = std::set<std::string>;
  const auto told = [&](const PartSource& source) {
    SceneBuilder builder(scene_of({{.id = "1", .source = source}}), {});
    (void)builder.parts();
    Names names;
    for (const std::filesystem::path& path : builder.files())
      names.insert(path.lexically_relative(folder.path()).string());
    return names;
  };
  put("leaf.png", grey_png(1, 1, 8, {0}));
  put("a.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd leaf.png\nmap_d missing.png\n");
  put("tree.obj", "mtllib none.mtl a.mtl\nusemtl wall\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  const Names tree{"tree.obj", "none.mtl a.mtl", "none.mtl", "a.mtl", "leaf.png", "missing.png"};
  CHECK(told(ObjSource{{folder / "tree.obj"}}) == tree);
  CHECK(told(MeshSource{.files = {folder / "tree.obj"}}) == tree);

  support::Gltf gltf;
  gltf.primitive({{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 1, 2}}, R"(,"material":0)", {{0, 0}, {1, 0}, {0, 1}});
  gltf.mesh("lid");
  gltf.material(R"("name":"wall","pbrMetallicRoughness":{"baseColorTexture":{"index":0}})");
  gltf.node(R"("mesh":0)");
  for (const auto& names :
       {std::pair("b.bin", "b.bin"), std::pair("b.dat", "b.dat"), std::pair("b", "b"),
        std::pair("b.buffer", "b.buffer"), std::pair("b'c.bin", "b'c.bin"), std::pair("b\\u00e4.bin", "b\xC3\xA4.bin")})
    for (const std::string picture : {"sky.hdr", "sky.pic", "sky.jfif", "sky"}) {
      const char *const uri = names.first, *const buffer = names.second;
      CAPTURE(uri);
      put(buffer, gltf.buffer());
      gltf.more = R"("images":[{"uri":")" + picture + R"("}],"textures":[{"source":0}],)";
      put("a.gltf", gltf.text(uri));
      CHECK(told(MeshSource{.files = {folder / "a.gltf"}, .materials = folder / "m.mtl"}) ==
            Names{"a.gltf", buffer, picture, "m.mtl"});
    }

  put("dem.png", grey_png(2, 2, 16, {1, 1, 1, 1}));
  put("class.asc", "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n2 2\n2 2\n");
  const Names ground = told(GeoTiffSource{.files = {folder / "dem.png"},
                                          .material = {folder / "m.mtl", "ground"},
                                          .classes = folder / "class.asc",
                                          .pixel_size = 1});
  for (const char* name : {"dem.png", "dem.pgw", "dem.pngw", "dem.wld", "dem.WLD", "m.mtl", "class.asc"})
    CHECK_MESSAGE(ground.contains(name), name);

  put("p.xyz", "0 0 0\n1 1 1\n");
  CHECK(told(XyzSource{.files = {folder / "p.xyz"}, .material = {folder / "m.mtl", "wall"}, .voxel_size = 1}) ==
        Names{"p.xyz", "m.mtl"});
}

TEST_CASE("a raster of heights may be a PNG file, with scale, offset and a number for what is missing") {
  const Files files;
  const TemporaryFolder& folder = files.folder;
  std::ofstream(folder / "dem.png", std::ios::binary) << grey_png(3, 2, 16, {1000, 1000, 1000, 1000, 1000, 0});
  SceneSettings scene =
      scene_of({{"1",
                 GeoTiffSource{.files = {folder / "dem.png"}, .height_scale = 0.01, .height_offset = -3, .missing = 0},
                 {},
                 1,
                 {},
                 {},
                 {}}});
  GeoTiffSource& source = std::get<GeoTiffSource>(scene.parts[0].source);
  CHECK_THROWS_WITH_AS((void)built(scene), doctest::Contains("has no place: expected a world file"), FileError);
  source.pixel_size = 1;
  CHECK(below(built(scene), 0.25, -0.5).range == relative(93, 1e-12));
  CHECK_FALSE(below(built(scene), 1.75, -0.75).met());
  source.pixel_size.reset();
  std::ofstream(folder / "dem.pgw") << "1\n0\n0\n-1\n10\n20\n";
  CHECK(below(built(scene), 10.25, 19.5).range == relative(93, 1e-12));
  scene.parts[0].transform.translation = {0, 0, 5};
  const std::vector<PlacedRaster> rasters = SceneBuilder(scene, {}).rasters();
  REQUIRE(rasters.size() == 1);
  CHECK(rasters[0].raster.unpacked().heights[0] == 7);
  CHECK(rasters[0].placement.translation == Vec3{0, 0, 5});
  scene.parts[0].transform.translation = {};
  // the same keys for a grid of text
  std::ofstream(folder / "dem.asc") << "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n1000 1000\n1000 1000\n";
  source.files = {folder / "dem.asc"};
  CHECK(below(built(scene), 0.25, 0.25).range == relative(93, 1e-12));
}

TEST_CASE("the colour table of a raster of classes colours the ground, if it is asked for") {
  const Files files;
  const TemporaryFolder& folder = files.folder;
  std::ofstream(folder / "dem.asc") << "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n7 7 7\n7 7 7\n";
  write_palette(folder / "land.tif", 3, 2, {6, 6, 200, 6, 6, 200});  // pixels of 1 m, the first at (0, 1)
  SceneSettings scene = scene_of(
      {{"1",
        GeoTiffSource{
            .files = {folder / "dem.asc"}, .material = {folder / "m.mtl", "ground"}, .classes = folder / "land.tif"},
        {},
        1,
        {},
        {},
        {}}});
  const auto materials = [&] {
    SceneBuilder builder(scene, {});
    return *builder.parts().at(0).materials;
  };
  for (const Material& one : materials()) CHECK(one.colour == Vec3{1, 1, 1});
  std::get<GeoTiffSource>(scene.parts[0].source).class_colours = true;
  const std::vector<Material> coloured = materials();
  REQUIRE(coloured.back().name == "ground 200");
  CHECK(coloured.back().colour == Vec3{200 / 255.0, 55 / 255.0, 1});
  const auto wall =
      std::find_if(coloured.begin() + 1, coloured.end(), [](const Material& one) { return one.classification == 6; });
  REQUIRE(wall != coloured.end());
  CHECK(wall->colour == Vec3{6 / 255.0, 249 / 255.0, 1});
  CHECK(coloured.front().colour == Vec3{1, 1, 1});
  std::get<GeoTiffSource>(scene.parts[0].source).classes = folder / "dem.asc";
  SceneBuilder told(scene, {});
  CHECK(told.parts().size() == 1);
  const auto tells = [](const SceneBuilder& builder, const std::string& what) {
    return std::any_of(builder.warnings().begin(), builder.warnings().end(),
                       [&](const std::string& text) { return text.find(what) != text.npos; });
  };
  CHECK(tells(told, "has no colour table: classcolours has no effect"));
  std::get<GeoTiffSource>(scene.parts[0].source).files = {folder / "land.tif"};
  SceneBuilder mistaken(scene, {});
  CHECK(mistaken.parts().size() == 1);
  CHECK(tells(mistaken, "land.tif: has a colour table, as a map of classes; its numbers are taken as heights"));
}

TEST_CASE("what a file comes to, and cannot be, is told with the file; what a part is asked for, with the part") {
  const Files files;
  std::ofstream(files.folder / "wide.vox")
      << "VOXEL SPACE\n#min_corner: 0 0 0\n#res: 1\ni j k PadBVTotal\n0 0 0 1\n3000000 0 0 1\n";
  PartSettings wide = files.part("plane.obj", "wide");
  wide.source = VoxelSource{.files = {files.folder / "wide.vox"}};
  CHECK_THROWS_WITH_AS((void)built(scene_of({wide})),
                       doctest::Contains("wide.vox: VoxelData::cells is 3e+06, but must be within"), FileError);

  PartSettings cube = files.part("cube.obj", "hut");
  cube.transform.scale = 1e-31;
  CHECK_THROWS_WITH_AS((void)built(scene_of({cube})), doctest::Contains("part 'hut': Placement::scale is 1e-31"),
                       SettingError);
  cube.transform.scale = 1e19;
  CHECK_THROWS_WITH_AS((void)built(scene_of({cube})),
                       "part 'hut': place is 2e+19 m, but must be within 1e18 m of the origin", SettingError);
  PartSettings cloud = cube;
  cloud.source = XyzSource{.files = {files.folder / "none.xyz"}, .voxel_size = -1};
  CHECK_THROWS_AS((void)built(scene_of({cloud})), SettingError);
  CHECK_THROWS_WITH_AS((void)built(scene_of({}), {.threads = 1025}),
                       doctest::Contains("SceneBuildOptions::threads is 1025"), SettingError);
}

TEST_CASE("nodes of a mesh file are parts of their own, placed in their part, which share their mesh") {
  const Files files;
  std::ofstream(files.folder / "crates.mtl") << "newmtl red\nKd 1 0 0\nhelios_classification 64\n";
  support::Gltf gltf;  // a horizontal triangle, y up
  gltf.primitive({{0, 1, 0}, {1, 1, 0}, {0, 1, -1}}, {{0, 1, 2}}, R"(,"material":0)");
  gltf.mesh("lid");
  gltf.material(R"("name":"red")");
  gltf.node(R"("mesh":0,"name":"first")");
  gltf.node(R"("mesh":0,"name":"second","translation":[10,0,0],"scale":[3,3,3])");
  gltf.roots = "0,1";
  std::ofstream(files.folder / "crates.gltf") << gltf.text();
  PartSettings crates{
      .id = "7",
      .source = MeshSource{.files = {files.folder / "crates.gltf"}, .materials = files.folder / "crates.mtl"}};
  crates.transform = {.scale = 2, .translation = {100, 0, 0}, .on_ground = 1};
  SceneBuilder builder(scene_of({files.part("plane.obj", "1"), crates}), {});
  const std::vector<SurveyPart> parts = builder.parts();
  REQUIRE(parts.size() == 3);
  CHECK(parts[1].name == "7/first");
  CHECK(parts[2].name == "7/second");
  CHECK(parts[1].object == 7);
  CHECK(parts[2].object == 8);
  CHECK(parts[1].geometry == parts[2].geometry);
  CHECK((*parts[1].materials)[0].classification == 64);
  const auto warned = [&](const std::string& text) {
    return std::any_of(builder.warnings().begin(), builder.warnings().end(),
                       [&](const auto& w) { return w.find(text) != w.npos; });
  };
  CHECK(warned("onGround has no effect on a mesh file of several nodes"));
  const SurveyScene scene(parts, {.to = 1});
  CHECK(below(scene, 100.5, 0.5).range == relative(98, 1e-12));  // 2 m high
  CHECK(below(scene, 120.5, 0.5).range == relative(94, 1e-12));  // 3 times as high
  CHECK(below(scene, 120.5, 0.5).object == 8);

  std::ofstream(files.folder / "bad.glb") << "glTF and no more";
  SceneBuilder bad(scene_of({{.id = "1", .source = MeshSource{.files = {files.folder / "bad.glb"}}}}), {});
  CHECK_THROWS_AS((void)bad.parts(), FileError);
}

TEST_CASE("CityGML files are read by the reader of the program, or refused without one") {
  const Files files;
  std::ofstream(files.folder / "city.GML") << "<CityModel/>";
  const MeshSource source{.files = {files.folder / "city.GML"}, .materials = files.folder / "m.mtl"};
  const SceneSettings settings = scene_of({{.id = "4", .source = source}});
  CHECK_THROWS_AS((void)SceneBuilder(settings, {}).parts(), FileError);
  const auto reader = [&](const std::filesystem::path& path, const io::MeshFileSettings& by, unsigned threads) {
    CHECK(path == source.files[0]);
    CHECK(by.materials == source.materials);
    CHECK(by.isolated);
    CHECK(threads == 3);
    io::MeshFile city;
    city.meshes.push_back({{{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}, {{{0, 1, 2}}}}, {0}});
    city.materials = {{.classification = 6}};
    city.placements = {{0, {}, "house"}};
    return city;
  };
  const std::vector<SurveyPart> parts = SceneBuilder(settings, {.threads = 3, .city_models = reader}).parts();
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].name == "4/house");
  CHECK((*parts[0].materials)[0].classification == 6);
}

}  // namespace
}  // namespace pulsecast::helios
