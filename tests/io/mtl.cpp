// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/mtl.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/water_types.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;

namespace {

const support::TemporaryFolder folder;
const std::filesystem::path path = folder.path() / "file";

/// Reads a file with this text.
MaterialLibrary mtl(const std::string& text, const std::vector<double>& wavelengths = {}) {
  std::ofstream(path, std::ios::binary) << text;
  return read_mtl(path, {.wavelengths = wavelengths});
}

}  // namespace

TEST_CASE("every key of an MTL file that counts is read") {
  const MaterialLibrary library =
      mtl("# comment\r\nnewmtl wall\r\n\tKd 0.7 0.7 0.7\r\n  Ks 0.1 0.1 0.1\r\nNs 20\r\nKa 1 1 1\r\nillum 2\r\n"
          "helios_reflectance 0.3\r\nhelios_isGround TRUE\r\nhelios_classification 6\r\nhelios_useVertexColors 1\r\n");
  REQUIRE(library.materials.size() == 1);
  CHECK(library.warnings.empty());
  const Material& wall = library.materials.at("wall");
  CHECK(wall.name == "wall");
  CHECK(wall.reflectance == 0.3);
  CHECK(wall.law.get<Phong>());
  CHECK(wall.law.get<Phong>()->share == doctest::Approx(0.125));
  CHECK(wall.law.get<Phong>()->exponent == 20);
  CHECK(wall.classification == 6);
  CHECK(wall.ground);
}

TEST_CASE("what is neither true nor false is no ground, with a warning") {
  const MaterialLibrary library =
      mtl("newmtl a\nhelios_isGround yes\nnewmtl b\nhelios_isGround 0\nnewmtl c\nhelios_isGround False\n");
  for (const char* name : {"a", "b", "c"}) CHECK_FALSE(library.materials.at(name).ground);
  REQUIRE(library.warnings.size() == 1);
  CHECK(contains(library.warnings[0], ", line 2: material 'a' has helios_isGround 'yes', expected true or false"));
}

TEST_CASE("the colours decide the angular law, material by material") {
  const MaterialLibrary library =
      mtl("newmtl both\nKd 0.3 0.3 0.3\nKs 0.1 0.1 0.1\n"
          "newmtl diffuse\nKd 0.2\n"
          "newmtl neither\nhelios_reflectance 0.1\n"
          "newmtl specular\nKs 0 0 0.5\n"
          "newmtl black with blanks\nKd 0 0 0\nKs 0 0 0\nKa 1 1 1\nmap_Kd x.png\n");
  const auto& m = library.materials;
  CHECK(m.at("both").law.get<Phong>());
  CHECK(m.at("both").law.get<Phong>()->share == doctest::Approx(0.25));
  CHECK(m.at("diffuse").law.get<Lambert>());
  CHECK(m.at("neither").law.get<DirectionIndependent>());
  CHECK(m.at("specular").law.get<Phong>());
  CHECK(m.at("specular").law.get<Phong>()->share == 1);
  CHECK(m.at("black with blanks").law.get<DirectionIndependent>());
  CHECK(m.at("diffuse").reflectance == 0.5);
  CHECK(m.at("specular").law.get<Phong>()->exponent == 10);
  CHECK_FALSE(m.at("diffuse").ground);
  for (const auto& [name, material] : m) CHECK_NOTHROW(material.validate());
}

TEST_CASE("laws of the library's own have keys of its own") {
  const MaterialLibrary library =
      mtl("newmtl gloss\nKd 0.3\nKs 0.1\nNs 20\npulsecast_normalizedPhong true\n"
          "newmtl plain\nKd 0.3\nKs 0.1\npulsecast_normalizedPhong false\n"
          "newmtl sign\nKd 0.3\npulsecast_retroreflection 70\nnewmtl mark\npulsecast_retroreflection 300.5 45\n");
  CHECK(library.materials.at("gloss").law.get<NormalizedPhong>());
  CHECK(library.materials.at("plain").law.get<Phong>());
  CHECK(library.materials.at("sign").law.get<Retroreflector<>>());
  CHECK(library.materials.at("sign").law.get<Retroreflector<>>()->coefficient == 70);
  CHECK(library.materials.at("sign").law.get<Retroreflector<>>()->optics.half_angle ==
        support::relative(pi / 6, 1e-12));
  CHECK(library.materials.at("mark").law.get<Retroreflector<>>()->coefficient == 300.5);
  CHECK(library.materials.at("mark").law.get<Retroreflector<>>()->optics.half_angle ==
        support::relative(pi / 4, 1e-12));
  for (const char* wrong :
       {"pulsecast_retroreflection -1", "pulsecast_retroreflection 70 0", "pulsecast_retroreflection 70 30 5",
        "pulsecast_retroreflection", "pulsecast_normalizedPhong maybe"})
    CHECK_THROWS_AS((void)mtl(std::string("newmtl a\n") + wrong + "\n"), FileError);
}

TEST_CASE("light that goes on has the keys of the format, and keys of the library") {
  const MaterialLibrary library =
      mtl("newmtl chrome\nhelios_reflectance 0.1\nKs 0.8\nillum 3\n"
          "newmtl metal\nhelios_reflectance 0\nPm 0.7\n"
          "newmtl body\nhelios_reflectance 0\nillum 7\nNi 1.6\n"
          "newmtl plain\nillum 2\nNi 1.45\n"
          "newmtl window\nhelios_reflectance 0\nTf 0.8 0.8 0.8\npulsecast_interface pane 0.004\n"
          "newmtl thick\nillum 2\nNi 1.45\npulsecast_interface pane 0.01\n"
          "newmtl lake\nhelios_reflectance 0\npulsecast_interface water\npulsecast_medium 1.33 1.36 0.1 0.2 0.01\n"
          "newmtl wet\nhelios_reflectance 0.2\npulsecast_roughness 0.25\n"
          "newmtl sign\npulsecast_retroreflection 400\npulsecast_retroreflector prisms 1.58 0.02\n"
          "newmtl corner\npulsecast_retroreflection 400\npulsecast_retroreflector cubeCorner\n"
          "newmtl mirror\nhelios_reflectance 0.05\npulsecast_interface mirror 0.9\n");
  const auto& m = library.materials;
  for (const auto& [name, material] : m) CHECK_NOTHROW(material.validate());
  CHECK(m.at("chrome").smooth.kind == InterfaceKind::mirror);
  CHECK(m.at("chrome").smooth.reflectance == doctest::Approx(0.8));
  CHECK(m.at("metal").smooth.reflectance == doctest::Approx(0.7));
  CHECK(m.at("body").smooth.kind == InterfaceKind::dielectric);
  CHECK(m.at("body").smooth.inside.index == doctest::Approx(1.6));
  CHECK(m.at("plain").smooth.kind == InterfaceKind::none);
  CHECK(m.at("window").smooth.kind == InterfaceKind::pane);
  CHECK(m.at("window").smooth.inside.absorption == doctest::Approx(-std::log(0.8) / 0.004));
  CHECK(m.at("thick").smooth.inside.index == doctest::Approx(1.45));
  CHECK(m.at("lake").smooth.kind == InterfaceKind::water);
  CHECK(m.at("lake").smooth.inside.scattering == 0.2);
  CHECK(m.at("lake").smooth.inside.backscatter == 0.01);
  CHECK(m.at("wet").law.get<Microfacet>());
  CHECK(m.at("wet").law.get<Microfacet>()->slope == 0.25);
  const auto* sign = m.at("sign").law.get<Retroreflector<CubeCorners>>();
  REQUIRE(sign);
  CHECK(sign->optics.index == 1.58);
  CHECK(sign->half_angle == 0.02);
  REQUIRE(m.at("corner").law.get<Retroreflector<CubeCorners>>());
  CHECK(m.at("corner").law.get<Retroreflector<CubeCorners>>()->optics.index == 1);
  CHECK(m.at("mirror").smooth.reflectance == 0.9);
  for (const char* wrong :
       {"pulsecast_interface", "pulsecast_interface mirror", "pulsecast_interface mirror 1.1",
        "pulsecast_interface pane -1", "pulsecast_interface door", "pulsecast_interface glass 2",
        "pulsecast_medium 0.9", "pulsecast_medium", "pulsecast_medium 1.3 0.5", "pulsecast_medium 1.3 1.4 -1",
        "pulsecast_medium 1.3 1.4 1 1 1 1", "pulsecast_roughness 0", "pulsecast_retroreflector cat",
        "pulsecast_retroreflector prisms", "pulsecast_retroreflector prisms 0.5", "pulsecast_retroreflector beads 1"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS((void)mtl(std::string("newmtl a\n") + wrong + "\n"), FileError);
  }
}

TEST_CASE("water by a type is that of the laser's wavelength") {
  const std::string lake = "newmtl lake\nhelios_reflectance 0\npulsecast_water ";
  const char* const names[]{"I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C"};
  for (int k = 0; k < 10; ++k) {
    const SmoothInterface smooth = mtl(lake + names[k], {532e-9, 532e-9}).materials.at("lake").smooth;
    const Medium expected = water(static_cast<JerlovType>(k), 532e-9);
    CHECK(smooth.kind == InterfaceKind::water);
    CHECK(smooth.inside.group_index == expected.group_index);
    CHECK(smooth.inside.extinction() == expected.extinction());
    CHECK(smooth.inside.backscatter == expected.backscatter);
  }
  CHECK(mtl(lake + "secchi 4", {532e-9}).materials.at("lake").smooth.inside.extinction() == doctest::Approx(1.7 / 4));
  const MaterialLibrary dark = mtl(lake + "1C");
  CHECK(dark.materials.at("lake").smooth.inside.extinction() == 0);
  REQUIRE(dark.warnings.size() == 1);
  CHECK(contains(dark.warnings[0], "line 3"));
  CHECK(contains(dark.warnings[0], "taken as clear"));
  for (const char* wrong : {"", "2C", "I II", "secchi", "secchi 100", "secchi 4 5"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS((void)mtl(lake + wrong, {532e-9}), FileError);
  }
  CHECK_THROWS_AS((void)mtl(lake + "1C", {532e-9, 1064e-9}), FileError);
  CHECK_THROWS_AS((void)mtl(lake + "1C", {1550e-9}), FileError);
  CHECK_THROWS_AS((void)mtl(lake + "secchi 4", {1064e-9}), FileError);
}

TEST_CASE("a reflectance above 1 is percent, with a warning; the limits are themselves allowed") {
  const MaterialLibrary library =
      mtl("newmtl a\nhelios_reflectance 35 # percent\nnewmtl b\nhelios_reflectance 1\nnewmtl c\nhelios_reflectance "
          "100\nnewmtl "
          "d\nhelios_reflectance 0\n");
  CHECK(library.materials.at("a").reflectance == doctest::Approx(0.35));
  CHECK(library.materials.at("b").reflectance == 1);
  CHECK(library.materials.at("c").reflectance == 1);
  CHECK(library.materials.at("d").reflectance == 0);
  REQUIRE(library.warnings.size() == 2);
  CHECK(contains(library.warnings[0], "'a'"));
  CHECK(contains(library.warnings[0], "percent"));
  CHECK(contains(library.warnings[1], ", line 6: material 'c'"));
}

TEST_CASE("a spectrum comes from the library, unless a reflectance is given; one that is not there is warned of") {
  const auto birch = std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.4e-6, 0.1}, {1.5e-6, 0.6}});
  SpectralLibrary spectra{.spectra = {{"birch", birch}, {"oak", birch}}};
  const std::string text =
      "newmtl a\nKd 1 1 1\nhelios_spectra birch\nnewmtl b\nhelios_spectra oak\nhelios_reflectance 0.2\nnewmtl "
      "c\nhelios_spectra elm\n";
  std::ofstream(path, std::ios::binary) << text;
  const MaterialLibrary library = read_mtl(path, spectra);
  CHECK(library.materials.at("a").spectrum == birch);
  CHECK(library.materials.at("a").law.get<Lambert>());
  CHECK(library.materials.at("a").reflectance_at(1.5e-6) == 0.6);
  CHECK(library.materials.at("b").spectrum == nullptr);
  CHECK(library.materials.at("b").reflectance_at(1.5e-6) == 0.2);
  CHECK(library.materials.at("c").spectrum == nullptr);
  CHECK(library.materials.at("c").reflectance == 0.5);
  REQUIRE(library.warnings.size() == 1);
  CHECK(contains(library.warnings[0], ", line 8: material 'c' refers to the spectrum 'elm', which is in no library"));
  CHECK(mtl(text).warnings.size() == 2);

  spectra.wavelengths = {0.532e-6, 1.55e-6, 0.4e-6};
  const MaterialLibrary warned = read_mtl(path, spectra);
  REQUIRE(warned.warnings.size() == 2);
  CHECK(contains(warned.warnings[0], "spans 400 to 1500 nm: for the laser of 1550 nm"));
}

TEST_CASE("of a name that comes twice the first counts, and what has no name is the default") {
  const MaterialLibrary library =
      mtl("helios_reflectance 0.1\nnewmtl a\nhelios_reflectance 0.2\nnewmtl a\nhelios_reflectance 0.3\n");
  REQUIRE(library.materials.size() == 2);
  CHECK(library.materials.at("default").reflectance == 0.1);
  CHECK(library.materials.at("a").reflectance == 0.2);
}

TEST_CASE("a colour of one number is grey, and a texture is no colour") {
  const MaterialLibrary library = mtl("newmtl a\nKd 0.3\nKs 0.1 0.1 0.1\nnewmtl b\nmap_Kd x.png\n");
  CHECK(library.materials.at("a").law.get<Phong>()->share == doctest::Approx(0.25));
  CHECK(library.materials.at("b").law.get<DirectionIndependent>());
  CHECK(mtl("newmtl a\nmap_Kd x.png\n").materials.at("a").law.get<DirectionIndependent>());
}

TEST_CASE("names may have blanks and signs of comments") {
  const MaterialLibrary library =
      mtl("newmtl Material #25\nhelios_reflectance 0.1\nnewmtl Material #26\nhelios_isGround 1 # yes\n");
  REQUIRE(library.materials.size() == 2);
  CHECK(library.materials.at("Material #25").reflectance == 0.1);
  CHECK(library.materials.at("Material #26").ground);
}

TEST_CASE("an MTL file may describe nothing, but not be empty") {
  CHECK(mtl("# Material Count: 0\n").materials.empty());
  CHECK_THROWS_WITH_AS((void)mtl(""), doctest::Contains("is empty"), FileError);
}

TEST_CASE("a damaged MTL file gives one error with its line") {
  for (const char* statement :
       {"helios_reflectance", "helios_reflectance abc", "helios_reflectance nan", "helios_reflectance -0.1",
        "helios_reflectance 100.5", "helios_reflectance 0.5 0.5", "helios_reflectance inf", "helios_classification 2.5",
        "helios_classification -1", "helios_classification 65536", "newmtl", "pulsecast_reflectanceMap"}) {
    CAPTURE(statement);
    const FileError error =
        support::file_error([&] { (void)mtl("newmtl a\n" + std::string(statement) + "\nKd 1 1 1\n"); });
    CAPTURE(error.what());
    CHECK(error.path() == path.string());
    CHECK(error.place() == "line 2");
    CHECK(contains(error.problem(), "expected"));
  }
}

TEST_CASE("standard keys are limited or ignored with a note, and never refuse a file") {
  struct Case {
    std::string statement, note;
    Vec3 colour{1, 1, 1};
    double exponent = 10;
  };
  for (const Case& c : std::vector<Case>{{"Kd 0.8 0.7 0.6 1.0", "has words after its numbers", {0.8, 0.7, 0.6}},
                                         {"Kd 0.8 0.7 0.6 // wood", "has words after its numbers", {0.8, 0.7, 0.6}},
                                         {"Kd 0.8 // wood", "has words after its numbers", {0.8, 0.8, 0.8}},
                                         {"Kd xyz 0.3 0.3 0.3", "is ignored"},
                                         {"Kd spectral wood.rfl", "is ignored"},
                                         {"Kd", "is ignored"},
                                         {"Kd 0.1 0.2", "is ignored"},
                                         {"Kd 0.1 x 0.3", "is ignored"},
                                         {"Kd nan 0 0", "is ignored"},
                                         {"Kd -1 0.5 0.5", "takes 0 for -1", {0, 0.5, 0.5}},
                                         {"Ns -1.96", "takes 0 for -1.96", {1, 1, 1}, 0},
                                         {"Ns 1e13", "takes 1e+12 for 1e13", {1, 1, 1}, 1e12},
                                         {"Ns many", "is ignored"},
                                         {"Ns 20 30", "has words after its numbers", {1, 1, 1}, 20},
                                         {"illum 4\nNi 0", "expected from 1 to 4; 1.5"},
                                         {"pulsecast_interface pane 0.01\nNi 5", "expected from 1 to 4; 1.5"},
                                         {"Kd 0.5 2 0.5", "beyond 0 to 1", {0.5, 1, 0.5}},
                                         {"Ks 2", "beyond 0 to 1"},
                                         {"Pm 1.5", "beyond 0 to 1"},
                                         {"Tf -1", "beyond 0 to 1"},
                                         {"map_Kd", "names no picture"},
                                         {"map_d", "names no picture"}}) {
    CAPTURE(c.statement);
    const MaterialLibrary library = mtl("newmtl a\nKs 1 1 1\n" + c.statement + "\n");
    REQUIRE(library.warnings.size() == 1);
    CHECK(contains(library.warnings[0], c.note));
    CHECK(contains(library.warnings[0], ", line "));
    CHECK(max_norm(library.materials.at("a").colour - c.colour) < 1e-12);
    REQUIRE(library.materials.at("a").law.get<Phong>());
    CHECK(library.materials.at("a").law.get<Phong>()->exponent == c.exponent);
    CHECK(library.pictures.empty());
    CHECK_NOTHROW(library.materials.at("a").validate());
  }
}

TEST_CASE("Kd is the colour of points, white without one") {
  const MaterialLibrary library = mtl("newmtl a\nKd 0.5 0.25 3\nnewmtl b\nKs 1 1 1\nnewmtl c\nKd 0.5\n");
  CHECK(library.materials.at("a").colour == Vec3{0.5, 0.25, 1});
  CHECK(library.materials.at("b").colour == Vec3{1, 1, 1});
  CHECK(library.materials.at("c").colour == Vec3{0.5, 0.5, 0.5});
}

TEST_CASE("keys of an MTL file are read, noted and refused by the rules") {
  std::vector<test::FormatCase> cases;
  const auto add = [&](std::string_view row, const std::string& key, std::size_t notes) {
    cases.push_back({row, [=] {
                       const MaterialLibrary library = mtl("newmtl a\n" + key + "\n");
                       CHECK(library.warnings.size() == notes);
                       CHECK(library.materials.contains("a"));
                       return library.warnings;
                     }});
  };
  for (const char* key : {"Kd", "Ks", "Ns", "illum", "Ni", "Tf", "Pm", "d", "Ka", "Ke", "helios_reflectance",
                          "helios_isGround", "helios_classification", "helios_useVertexColors", "pulsecast_medium",
                          "pulsecast_roughness", "pulsecast_retroreflection"})
    add(key, std::string(key) + " 1", 0);
  for (const char* key : {"map_Kd", "map_d", "pulsecast_reflectanceMap", "map_Ka", "map_Ke"})
    add(key, std::string(key) + " a.png", 0);
  for (const char* key : {"bump", "norm", "disp"}) add(key, std::string(key) + " a.png", 1);
  add("newmtl", "newmtl b", 0);
  add("Tr", "Tr 0", 0);
  add("d below 1", "d 0.5", 1);
  add("Tr above 0", "Tr 0.5", 1);
  add("helios_spectra", "helios_spectra oak", 1);  // which no library has
  add("pulsecast_normalizedPhong", "pulsecast_normalizedPhong true", 0);
  add("pulsecast_interface", "pulsecast_interface glass", 0);
  add("pulsecast_water", "pulsecast_water II", 1);  // without a wavelength
  add("pulsecast_retroreflector", "pulsecast_retroreflector beads", 0);
  add("pulsecast_*", "pulsecast_rougness 0.1", 0);
  add("map_*", "map_Bump a.png", 1);
  add("*", "helios_reflectanc 0.1", 1);
  test::check_rules(io::detail::mtl_rules, cases);
  for (const char* key : {"d -halo 0.5", "d 0", "Tf spectral glass.rfl", "Ni xyz", "illum 12", "Pr 0.1"}) {
    CAPTURE(key);
    CHECK(mtl("newmtl a\n" + std::string(key) + "\n").warnings.size() == 1);
  }
  CHECK(mtl("newmtl a\nd 0.5\nnewmtl b\nd 0.4\n").warnings ==
        std::vector<std::string>{path.string() + ", line 2: 'd 0.5': the surface is opaque; map_d cuts holes, "
                                                 "pulsecast_interface makes panes, the first of 2"});
}

TEST_CASE("pictures are named beside the file, without their options, and for the first of equal names") {
  const MaterialLibrary library =
      mtl("newmtl leaf\nmap_Kd -s 2 2 1 pictures\\my leaf.png\nmap_d -clamp on mask.png\npulsecast_reflectanceMap "
          "pattern bark.jpg\n"
          "newmtl bare\nnewmtl leaf\nmap_Kd other.png\n");
  REQUIRE(library.warnings.size() == 2);
  CHECK(contains(library.warnings[0], "line 2: material 'leaf': 'map_Kd -s 2 2 1 pictures\\my leaf.png' has options"));
  REQUIRE(library.pictures.size() == 1);
  const MaterialPictures& leaf = library.pictures.at("leaf");
  CHECK(leaf.colour.file == folder.path() / "pictures/my leaf.png");
  CHECK(leaf.opacity.file == folder.path() / "mask.png");
  CHECK(leaf.reflectance.file == folder.path() / "bark.jpg");
  CHECK(leaf.reflectance_pattern);
}
