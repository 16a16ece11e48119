// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/output.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

namespace {

const support::TemporaryFolder folder;

std::filesystem::path written(const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

/// The root element of a text, to be read, and what is reported of it.
struct Reading {
  explicit Reading(const std::string& text, bool params = false)
      : document(written("a.xml", text)), io(document, document.root(), report, search, params) {}

  /// What is wrong after all was asked for; empty if nothing is.
  std::string faults() {
    io.finish();
    try {
      report.require_clean();
    } catch (const XmlFaults& faults) {
      return faults.what();
    }
    return "";
  }

  /// What is odd after all was asked for, a line each.
  std::string warnings() {
    CHECK(faults().empty());
    std::string all;
    for (const std::string& warning : report.warnings()) all += warning + '\n';
    return all;
  }

  XmlDocument document;
  XmlReport report{};
  AssetSearch search{{folder.path()}};
  XmlInput io;
};

enum class Colour { red, green };

/// Settings with a field of every kind.
struct Everything {
  double length = 1;
  std::optional<double> angle{};
  int count = 2;
  bool is_on = false;
  std::string name = "n";
  std::optional<std::string> nick{};
  Colour colour = Colour::red;
  Vec3 place{};
  std::optional<Vec3> normal{};
  std::filesystem::path file{};

  void fields(FieldIo& io) {
    io.number("length_ns", length, units::nanosecond, 0, 1e12);
    io.number("angle_deg", angle, units::degree, -360, 360);
    io.whole("count", count, -5, 5);
    io.flag("on", is_on);
    io.text("name", name);
    io.text("nick", nick);
    io.choice("colour", colour, {{"red", Colour::red}, {"green", Colour::green}});
    io.vector("place", place, 1e9);
    io.vector("normal", normal, 1);
    io.file("file", file);
  }
  bool operator==(const Everything&) const = default;
};

constexpr const char* whole_text =
    R"(length_ns="4" angle_deg="30" count="-3" on="1" name="" nick="k" colour="GREEN" place="1;-2;3.5" normal="0;0;1" file="a.xml")";

}  // namespace

TEST_CASE("a number has as few digits as it needs, and reads back the same") {
  CHECK(xml_number(0) == "0");
  CHECK(xml_number(-0.0) == "0");
  CHECK(xml_number(476000) == "476000");
  CHECK(xml_number(1e6) == "1000000");
  CHECK(xml_number(0.0003) == "0.0003");
  CHECK(xml_number(1e300) == "1e+300");
  CHECK(number_of("1e5") == 1e5);
  CHECK(number_of(" +2.5\t") == 2.5);
  for (const char* text : {"", " ", "x", "1x", "1,5", "nan", "--1", "+-1", "0x10", "1e999", "1 2"})
    CHECK_FALSE(number_of(text));
}

TEST_CASE("what was read in a unit is written as it was read, and what was not, to the last digit but one") {
  CHECK(units::degree.number(radians(20)) == 20);
  CHECK(units::nanosecond.number(0.25e-9) == 0.25);
  CHECK(units::nanosecond.si(0.25) == 0.25e-9);
  CHECK(units::nanometre.si(1064) == 1064e-9);
  support::Generator random(20);
  for (int i = 0; i < 20000; ++i) {
    const double number = random.log_uniform(1e-12, 1e12);
    for (const XmlUnit& unit :
         {units::degree, units::nanosecond, units::kilometre, units::nanometre, units::nanowatt, units::metre}) {
      const double value = unit.si(number);
      CAPTURE(number);
      CAPTURE(unit.symbol);
      REQUIRE(unit.si(unit.number(value)) == value);
      REQUIRE(std::abs(unit.si(unit.number(number)) / number - 1) < 1e-15);
    }
  }
}

TEST_CASE("every kind of field is read, as attribute and as param, and what is not given stays") {
  for (const bool params : {false, true}) {
    std::string text = "<a " + std::string(whole_text) + "/>";
    if (params) {
      text = "<filter type=\"x\">";
      const XmlDocument attributes(written("b.xml", "<a " + std::string(whole_text) + "/>"));
      for (const pugi::xml_attribute a : attributes.root().attributes())
        text += "<param key=\"" + std::string(a.name()) + "\" value=\"" + a.value() + "\"/>";
      text += "</filter>";
    }
    Reading reading(text, params);
    Everything s;
    s.fields(reading.io);
    CHECK(reading.faults().empty());
    CHECK(s == Everything{4e-9, radians(30), -3, true, "", "k", Colour::green, Vec3(1, -2, 3.5), Vec3(0, 0, 1),
                          folder / "a.xml"});
  }
  Reading nothing("<a/>");
  Everything s;
  s.fields(nothing.io);
  CHECK(nothing.faults().empty());
  CHECK(s == Everything{});
}

TEST_CASE("what was written is read the same, as attribute and as param") {
  const Everything full{
      0.1, 0.2, 5, true, "<&>\"'\n", "", Colour::green, Vec3(1e-9, -2e8, 3), Vec3(0, 1, 0), folder / "a.xml"};
  for (Everything s : {full, Everything{}})
    for (const bool params : {false, true}) {
      pugi::xml_document document;
      pugi::xml_node node = document.append_child(params ? "filter" : "a");
      if (params) node.append_attribute("type").set_value("x");
      XmlOutput out(node, params);
      s.fields(out);
      document.save_file((folder / "c.xml").c_str());
      Reading reading(support::content(folder / "c.xml"), params);
      Everything again{.length = 7, .name = "other"};
      again.fields(reading.io);
      CHECK(reading.faults().empty());
      CHECK(again.angle.has_value() == s.angle.has_value());
      again.angle = s.angle;
      again.length = s.length;
      CHECK(again == s);
    }
}

TEST_CASE("what is wrong with a field is told, and the field stays") {
  const auto refuses = [](const std::string& attribute, const std::string& part) {
    Reading reading("<a\n " + attribute + "/>");
    Everything s;
    s.fields(reading.io);
    CAPTURE(attribute);
    const std::string faults = reading.faults();
    INFO(faults);
    CHECK(contains(faults, "a.xml:2:2: "));
    CHECK(contains(faults, part));
    CHECK(s == Everything{});
  };
  refuses("length_ns=\"-1\"", "length_ns=\"-1\": expected a number from 0 to 1000000000000 ns");
  refuses("length_ns=\"inf\"", "expected a number");
  refuses("angle_deg=\"1e9\"", "expected a number from -360 to 360 deg");
  refuses("count=\"1.5\"", "expected a whole number from -5 to 5");
  refuses("count=\"6\"", "expected a whole number from -5 to 5");
  refuses("on=\"yse\"", "on=\"yse\" is not known; known names: true, false, 1, 0");
  refuses("colour=\"gren\"", "did you mean 'green'?");
  refuses("place=\"1;2\"", "expected three numbers 'x;y;z'");
  refuses("place=\"1;2;3;4\"", "expected three numbers 'x;y;z'");
  refuses("normal=\"0;0;2\"", "of at most 1");
  refuses("file=\"none\"", "does not exist");
  refuses("count=\"" + std::string(1000, '9') + "\"", "999...\": expected a whole number");
}

TEST_CASE("what is odd about a field, but leaves no doubt, is told and read") {
  const auto takes = [](const std::string& attribute, const std::string& part, const Everything& expected) {
    for (const bool params : {false, true}) {
      const std::size_t equals = attribute.find('=');
      const std::string param =
          "<filter type=\"x\">\n <param key=\"" + attribute.substr(0, equals) + "\" value" + attribute.substr(equals);
      Reading reading(params ? param + "/></filter>" : "<a\n " + attribute + "/>", params);
      Everything s;
      s.fields(reading.io);
      CAPTURE(attribute);
      const std::string warnings = reading.warnings();
      INFO(warnings);
      CHECK(contains(warnings, "a.xml:2:"));
      CHECK(contains(warnings, part));
      CHECK(s == expected);
    }
  };
  takes("on=\"Yes\"", "on=\"Yes\" is taken as true: expected true or false", {.is_on = true});
  takes("on=\"off\"", "is taken as false", {});
  for (const char* name : {"length_ns", "angle_deg", "count", "colour", "place", "normal", "file"})
    takes(name + std::string("=\" \""), "=\" \" is empty: it is ignored", {});
  takes("place=\"1,-2, 3\"", "expected semicolons between the numbers", {.place = Vec3(1, -2, 3)});
  takes("place=\"1  -2 3\"", "expected semicolons between the numbers", {.place = Vec3(1, -2, 3)});
  takes("cuont=\"1\"", "'cuont' of", {});
  takes("cuont=\"1\"", "is not known; did you mean 'count'?", {});
  Reading needed("<a b=\"\"/>");
  int n = 0;
  needed.io.require({"b"});
  needed.io.whole("b", n, 0, 9);
  CHECK(contains(needed.faults(), "b=\"\" is empty: expected a value"));
}

TEST_CASE("children are read in order, once where there may be one, and unknown ones are told") {
  Reading reading("<a><b n=\"1\"/><b n=\"2\"/><c/><c/><d/></a>");
  std::vector<int> numbers;
  reading.io.children("b", numbers, [](FieldIo& io, int& n) { io.whole("n", n, 0, 9); });
  CHECK(numbers == std::vector<int>{1, 2});
  CHECK(reading.io.child("c", [](XmlInput&) {}));
  CHECK_FALSE(reading.io.child("e", [](XmlInput&) { FAIL("does not exist"); }));
  const std::string warnings = reading.warnings();
  CHECK(contains(warnings, "a second <c> in <a>: the first one is used"));
  CHECK(contains(warnings, "element <d> in <a> is not known"));
  for (const char* text : {"text", "<![CDATA[text]]>", "<!-- note -->text", "<?php?>text"})
    CHECK(contains(Reading("<a>" + std::string(text) + "</a>").warnings(), "<a> holds the text 'text': it has no"));
  Reading number("<a>1<!-- note -->2<![CDATA[3]]></a>");
  CHECK(number.io.content() == "1");
  CHECK(contains(number.warnings(), "holds the text '2'"));
  CHECK(contains(number.warnings(), "holds the text '3'"));
  Reading lacks("<a b=\"\"/>");
  lacks.io.require({"b", "c"});
  lacks.io.know({"b"});
  CHECK(contains(lacks.faults(), "<a> has no attribute 'c'"));
  Reading idle("<a b=\"1\" xmlns:xsi=\"u\" xsi:schema=\"v\"/>");
  idle.io.without_effect({"b"});
  CHECK(idle.faults().empty());
  CHECK(idle.report.warnings().size() == 1);
}

TEST_CASE("params are checked as attributes are") {
  const auto read = [](Reading& reading) {
    int n = 0;
    reading.io.whole("count", n, 0, 9);
    return n;
  };
  const auto fault = [&](const std::string& inside) {
    Reading reading("<filter type=\"x\">" + inside + "</filter>", true);
    (void)read(reading);
    return reading.faults();
  };
  const auto warning = [&](const std::string& inside, int expected) {
    Reading reading("<filter type=\"x\">" + inside + "</filter>", true);
    CHECK(read(reading) == expected);
    return reading.warnings();
  };
  CHECK(warning(R"(<param type="int" key="count" value="3"/>)", 3).empty());
  CHECK(contains(warning(R"(<param type="int" key="cuont" value="3"/>)", 0),
                 "param 'cuont' of filter 'x' is not known; did you mean 'count'?"));
  CHECK(contains(warning(R"(<param type="itn" key="count" value="3"/>)", 3),
                 "type=\"itn\" is not known; did you mean 'int'?"));
  CHECK(contains(fault(R"(<param type="int" key="count" value="x"/>)"), "count=\"x\": expected a whole number"));
  CHECK(contains(warning(R"(<param type="int" key="count" vlaue="3"/>)", 0),
                 "attribute 'vlaue' of <param> is not known"));
  CHECK(contains(fault(R"(<param key="count" value="3"/><param key="count" value="4"/>)"),
                 "is given twice, with another value"));
  CHECK(contains(warning(R"(<param key="count" value="3"/><param key="count" value="3"/>)", 3), "is given twice"));
  CHECK(contains(warning(R"(<parm key="count" value="3"/>)", 0), "did you mean 'param'?"));
  CHECK(contains(warning(R"(<param key="count" value="3"><rot/></param>)", 3), "element <rot> in <param>"));
  CHECK(contains(warning(R"(<param key="count" value="3"><![CDATA[4]]></param>)", 3), "<param> holds the text '4'"));
  CHECK(contains(warning(R"(<param key="count" value="3"/>4)", 3), "<filter> holds the text '4'"));
}
