// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/side_files.hpp>

#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

const std::string geographic = R"(GEOGCS["NAD83",DATUM["D",SPHEROID["S",6378137,298]],UNIT["Degree",0.0174532925]])";
const std::string in_feet = "PROJCS[\"ny\"," + geographic + R"(,PROJECTION["L"],UNIT["Foot_US",0.3048006096012192]])";
const std::string up = R"(VERT_CS["z",VERT_DATUM["z",2005],UNIT["metre",1],AXIS["Up",UP]])";

/// What is read of the files beside `a.tif`.
struct Beside {
  SpatialReference reference{};
  std::vector<std::string> warnings{};
};

Beside read(const std::string& prj, const std::string& aux = {}, bool is_silent = true) {
  const support::TemporaryFolder folder;
  if (!prj.empty()) std::ofstream(folder / "a.prj", std::ios::binary) << prj;
  if (!aux.empty()) std::ofstream(folder / "a.tif.aux.xml", std::ios::binary) << aux;
  Beside made;
  made.reference = detail::read_side_files(folder / "a.tif", made.warnings, detail::HeightUnit::metre, is_silent);
  return made;
}

std::string pam(const std::string& element) { return "<PAMDataset>\n  " + element + "\n</PAMDataset>\n"; }

TEST_CASE("GDAL's file tells a system in well-known text, before .prj, if the raster names none") {
  std::string escaped = in_feet;
  for (std::size_t at = 0; (at = escaped.find('"', at)) != std::string::npos; at += 6) escaped.replace(at, 1, "&quot;");
  for (const std::string& aux :
       {pam("<SRS>" + in_feet + "</SRS>"), pam("<SRS dataAxisToSRSAxisMapping=\"1,2\">" + escaped + "</SRS>"),
        pam("<SRS xsi:type='x'><WKT>" + escaped + "</WKT><XOrigin>-1</XOrigin></SRS>")}) {
    CHECK(read("", aux).reference.wkt == in_feet);
    CHECK(read(geographic, aux).reference.unit == 0.3048006096012192);
    CHECK(read(geographic, aux, false).reference == SpatialReference{});
  }
  CHECK(read("", pam("<Metadata><MDI key=\"STATISTICS_MEAN\">1</MDI></Metadata>")).reference == SpatialReference{});
  CHECK(read("", "").reference == SpatialReference{});
}

TEST_CASE("each rule of the files beside a raster has one that is read, noted or refused as it says") {
  const auto element = [](const std::string& text) { return [text] { return read("", pam(text)).warnings; }; };
  test::check_rules(
      detail::side_file_rules,
      std::vector<test::FormatCase>{
          {"reference system",
           [] {
             const Beside found = read("COMPD_CS[\"c\"," + in_feet + "," + up + "]");
             CHECK(found.reference.unit == 0.3048006096012192);
             return found.warnings;
           }},
          {"<GeoTransform>", element("<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>")},
          {"<GCPList", element("<GCPList Projection=\"\"></GCPList>")},
          {"<GeodataXform",
           element("<Metadata domain=\"xml:ESRI\"><GeodataXform xsi:type='typens:PolynomialXform'/></Metadata>")},
          {"<NoDataValue", element("<PAMRasterBand band=\"1\"><NoDataValue>0</NoDataValue></PAMRasterBand>")},
          {"<UnitType>", element("<PAMRasterBand band=\"1\"><UnitType>ft</UnitType></PAMRasterBand>")},
          {"<Offset>", element("<PAMRasterBand band=\"1\"><Offset>5</Offset></PAMRasterBand>")},
          {"<Scale>", element("<PAMRasterBand band=\"1\"><Scale>0.01</Scale></PAMRasterBand>")}});
}

TEST_CASE("spoilt files beside a raster are refused, or give units that a raster takes") {
  support::Generator random(3802);
  int refused = 0, accepted = 0;
  for (int time = 0; time < 400; ++time) {
    const std::string text = support::spoilt("COMPD_CS[\"c\"," + in_feet + "," + up + "]", 1 + random.whole(4),
                                             std::array{"UNIT[", "\"", "<SRS", "nan", "-1", "]", "PROJCS["}, random);
    INFO("seed 3802, ", text);
    try {
      const Beside found = time % 2 == 0 ? read(text) : read("", pam("<SRS>" + text));
      CHECK(found.reference.unit >= 1e-6);
      CHECK(found.reference.vertical_unit <= 1e6);
      ++accepted;
    } catch (const FileError&) {
      ++refused;
    }
  }
  CHECK(accepted > 100);
  CHECK(accepted + refused == 400);
  CHECK(read("", std::string(3000000, '"')).warnings.empty());
  CHECK(read("", "<SRS>" + std::string(9000000, '&')).reference.wkt.empty());
}

}  // namespace
}  // namespace pulsecast::io
