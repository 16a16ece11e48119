// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/spectral_library.hpp>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::support;

namespace {

const TemporaryFolder folder;
const std::filesystem::path path = folder / "oak.txt";

/// Reads a file with this text.
SpectrumFile spectrum(const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return read_spectrum(path);
}

/// Whether a file spans these wavelengths [m], and has this reflectance at 1 micrometre.
void check(const SpectrumFile& file, double shortest, double longest, double reflectance) {
  CHECK(file.spectrum->shortest() == relative(shortest, 1e-12));
  CHECK(file.spectrum->longest() == relative(longest, 1e-12));
  CHECK(file.spectrum->reflectance(1e-6) == relative(reflectance, 1e-12));
}

}  // namespace

TEST_CASE("a file with the header of the ECOSTRESS and ASTER libraries is read in the units that it names") {
  const std::string header =
      "Name: Oak leaf\nType: vegetation\nParticle Size: 75-250 um\nSample No.: 26\nWavelength Range: All\n"
      "Description: A leaf, 5 % wet, of 2 by 3 nm.\nMeasurement: Directional (10 Degree) Hemispherical Reflectance\n"
      "First Column: X\nSecond Column: Y\n";
  const std::string end =
      "First X Value: 1.5\nLast X Value: 0.5\nNumber of X Values: 2\nAdditional Information: none\n\n";
  const SpectrumFile percent = spectrum(header + "X Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n" +
                                        end + "1.5\t60\r\n0.5\t20\r\n");
  check(percent, 0.5e-6, 1.5e-6, 0.4);
  CHECK(percent.scale == ReflectanceScale::percent);
  CHECK(percent.report ==
        path.string() + ": wavelengths in micrometres, by the header; reflectance in percent, by the header");
  CHECK(percent.warnings.empty());

  const SpectrumFile fraction = spectrum(
      header + "X Units: Wavelength (nanometers)\nY Units: Reflectance (fraction)\n" + end + "1500 0.6\n500 0.2\n");
  check(fraction, 0.5e-6, 1.5e-6, 0.4);
  CHECK(fraction.scale == ReflectanceScale::fraction);
  CHECK(contains(fraction.report, "nanometres, by the header; reflectance in fractions, by the header"));

  const SpectrumFile waves =
      spectrum("X Units: Wavenumber (cm-1)\nY Units: Reflectance (percentage)\n5000 10\n10000 40\n");
  check(waves, 1e-6, 2e-6, 0.4);
}

TEST_CASE("without a header the values tell the units, and both are always reported") {
  const SpectrumFile percent = spectrum("500 20\n1500 60\n");
  check(percent, 0.5e-6, 1.5e-6, 0.4);
  CHECK(percent.scale == ReflectanceScale::percent);
  CHECK(contains(percent.report,
                 "nanometres, by the values 500 to 1500; reflectance in percent, as its values reach 60"));

  const SpectrumFile fraction = spectrum("0.5,0.2\n1.5,0.6");
  check(fraction, 0.5e-6, 1.5e-6, 0.4);
  CHECK(fraction.scale == ReflectanceScale::fraction);
  CHECK(contains(fraction.report,
                 "micrometres, by the values 0.5 to 1.5; reflectance in fractions, as its values reach 0.6"));

  check(spectrum("5e-7;0.2;9\n1.5e-6;0.6;9\n"), 0.5e-6, 1.5e-6, 0.4);
}

TEST_CASE("the titles of the columns tell the units") {
  const SpectrumFile names =
      spectrum("# from the garden, 2 nm steps\nwavelength_nm,reflectance_percent\n500,0.2\n1500,0.6\n");
  check(names, 0.5e-6, 1.5e-6, 0.004);
  CHECK(names.scale == ReflectanceScale::percent);
  REQUIRE(names.warnings.size() == 1);
  CHECK(contains(names.warnings[0], ", line 2: its header says percent, but its values reach 0.6 only"));
  check(spectrum("Wavelength(\xC2\xB5m)\tReflectance(%)\n0.5\t20\n1.5\t60\n"), 0.5e-6, 1.5e-6, 0.4);
  check(spectrum("wavelength [um] reflectance [%]\n0.5 20\n1.5 60\n"), 0.5e-6, 1.5e-6, 0.4);
}

TEST_CASE("headers of spectra are read and refused by the rules") {
  std::vector<test::FormatCase> cases;
  const auto add = [&](const char* row, const char* head) {
    cases.push_back({row, [head] {
                       const SpectrumFile file = spectrum(std::string(head) + "\n500 0.2\n1500 0.6\n");
                       check(file, 0.5e-6, 1.5e-6, 0.4);
                       return file.warnings;
                     }});
  };
  add("x units:", "X Units: Wavelength (nanometers)");
  add("y units:", "Y Units: Reflectance (fraction)");
  add("titles", "wavelength (nm) reflectance transmittance");
  add("units", "units: nm");
  add("*", "Description: broadband emission of a lamp at 10000 Angstrom\nof oak");
  add("first column: y", "First Column: Y\nSecond Column: X");
  add("angstrom", "X Units: Wavelength (Angstrom)\nY Units: Reflectance (fraction)\n");
  add("frequency", "frequency reflectance");
  add("thz", "f [THz] reflectance");
  add("energy", "photon energy (eV), reflectance");
  add("band", "Band, Wavelength, Reflectance");
  add("channel", "channel;wavelength;reflectance");
  add("index", "index wavelength reflectance");
  add("transmi", "wavelength, transmission, reflectance");
  add("absor", "Y Units: Absorbance");
  add("emiss", "wavelength emissivity");
  add("radian", "units= Radiance, Radiance\ndata=");
  add("refractive", "wavelength, refractive n");
  add("10000", "wavelength (nm), reflectance * 10000");
  add("log(", "Wavelength nm, log(1/R)");
  add("mille", "nm, reflectance (per mille)");
  add("scatter", "Y Units: Backscatter");
  test::check_rules(io::detail::spectrum_rules, cases);
  for (const char* head : {"Reflectance, Wavelength", "wavelength irradiance", "Y Units: Gloss"})
    CHECK_THROWS_AS(spectrum(std::string(head) + "\n500 0.2\n"), FileError);
}

TEST_CASE("a file of 26 header lines of any words, as HELIOS++ takes them, is read") {
  std::string text;
  for (int line = 1; line <= 26; ++line) text += "header line " + std::to_string(line) + "\n";
  check(spectrum(text + "0.500\t20.0\n1.500\t60.0\n"), 0.5e-6, 1.5e-6, 0.4);
}

TEST_CASE("what is missing is left out, what is beyond is clipped, and what comes twice is united") {
  const SpectrumFile gaps = spectrum("0.3 -1.23e+34\n0.5 0.2\n1.0 nan\n1.5 0.6\n2.0 NA\n");
  check(gaps, 0.5e-6, 1.5e-6, 0.4);
  const SpectrumFile beyond = spectrum("500 -2\n1000 40\n1500 101\n");
  CHECK(beyond.spectrum->reflectance(0.5e-6) == 0);
  CHECK(beyond.spectrum->reflectance(1.5e-6) == 1);
  REQUIRE(beyond.warnings.size() == 1);
  CHECK(contains(beyond.warnings[0], ", line 1: a reflectance below 0 or above 1 is clipped, the first of 2"));
  const SpectrumFile twice = spectrum("0.5 0.2\n1.0 0.3\n1.0 0.5\n1.5 0.6\n1.5 0.8\n");
  check(twice, 0.5e-6, 1.5e-6, 0.4);
  CHECK(twice.spectrum->reflectance(1.5e-6) == relative(0.7, 1e-12));
  REQUIRE(twice.warnings.size() == 1);
  CHECK(contains(twice.warnings[0], ", line 3: a wavelength is repeated, the first of 2: the mean is used"));
  const SpectrumFile denied = spectrum("Y Units: Reflectance (fraction)\n500 20\n1500 60\n");
  check(denied, 0.5e-6, 1.5e-6, 0.4);
  REQUIRE(denied.warnings.size() == 1);
  CHECK(contains(denied.warnings[0], ", line 1: its header says fraction, but its values reach 60"));
  CHECK(contains(spectrum("X Units: Wavelength (micrometers)\n500 0.2\n1500 0.6\n").warnings.at(0),
                 ", line 3: its wavelengths, 500 to 1500 micrometres, are not all between 100 nm and 1 mm"));
  CHECK(spectrum("0.5 0.2\n# end of the visible\n1.5 0.6\n").spectrum->samples().size() == 2);
}

TEST_CASE("a file that is no spectrum gives one error, with its line") {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      (void)spectrum(text);
    } catch (const FileError& error) {
      return error.place() + ": " + error.problem();
    }
    return {};
  };
  CHECK(contains(problem(""), "is empty"));
  CHECK(contains(problem("words\nand more\n"), "holds no row of two numbers"));
  CHECK(contains(problem("0.1\n0.2\n"), "holds no row of two numbers"));
  CHECK(contains(problem("0.5 -1.23e34\n"), "holds no row"));
  CHECK(contains(problem("title\n0.5 0.2\n0.6 much\n"), "line 3: '0.6 much': expected wavelength and reflectance"));
  CHECK(contains(problem("0.5 0.2\n0.6\n"), "line 2"));
  CHECK(contains(problem("0.5 0.2\n0 0.3\n"), "line 2: '0 0.3': expected a wavelength greater than 0"));
  CHECK(contains(problem("-0.5 0.2\n"), "line 1"));
  CHECK(contains(problem("1e-320 0.2\n1 0.1\n"), "line 1"));
  CHECK(contains(problem("Y Units: Transmittance (percent)\n0.5 0.2\n"),
                 "line 1: 'Y Units: Transmittance (percent)': expected"));
  CHECK(
      contains(problem("nm;reflectance\n400,5;0,25\n"), "line 2: '400,5;0,25': expected numbers with a decimal point"));
  CHECK(contains(problem("400,5 0,25\n"), "decimal point"));
  CHECK(problem("400, 0.2, 0.1\n").empty());
  CHECK(contains(problem("nm, transmittance, reflectance\n400,0.7,0.2\n"),
                 "line 1: 'nm, transmittance, reflectance': expected reflectance after"));
  CHECK(contains(problem("Wavelength (Angstrom) Reflectance\n4000 0.2\n"), "expected wavelengths in nm"));
  CHECK(contains(problem(std::string("0.5 0.2\n\0\0\n", 11)), "binary"));
  CHECK_THROWS_AS((void)read_spectrum(folder / "none"), FileError);
}

TEST_CASE("a library is all spectra of a folder, by the names of their files") {
  const std::filesystem::path many = folder / "library";
  std::filesystem::create_directory(many);
  const auto write = [&](const char* name, const char* text) { std::ofstream(many / name, std::ios::binary) << text; };
  write("oak.v2.txt", "500 20\n1500 60\n");
  write("grass.txt", "0.5 0.1\n");
  write("grass.csv", "0.5 0.3\n");
  write("readme.md", "words\n");
  write(".hidden", "0.5 0.3\n");
  write("empty", "");
  const SpectralLibrary library = read_spectral_library(many);
  REQUIRE(library.spectra.size() == 2);
  CHECK(library.spectra.at("oak.v2")->reflectance(1e-6) == relative(0.4, 1e-12));
  CHECK(library.spectra.at("grass")->reflectance(1e-6) == 0.3);
  REQUIRE(library.reports.size() == 2);
  CHECK(contains(library.reports[0], "grass.csv"));
  CHECK(contains(library.reports[1], "oak.v2.txt"));
  CHECK(contains(library.reports[1], "percent"));
  REQUIRE(library.warnings.size() == 3);
  CHECK(contains(library.warnings[0], "empty"));
  CHECK(contains(library.warnings[1], "grass.txt"));
  CHECK(contains(library.warnings[2], "readme.md"));

  CHECK(read_spectral_library(many / "grass.txt").spectra.count("grass") == 1);
  CHECK_THROWS_AS((void)read_spectral_library(many / "readme.md"), FileError);
  CHECK_THROWS_AS((void)read_spectral_library(folder / "none"), FileError);
  std::filesystem::create_directory(folder / "nothing");
  CHECK_THROWS_WITH_AS((void)read_spectral_library(folder / "nothing"), doctest::Contains("holds no spectrum"),
                       FileError);
}
