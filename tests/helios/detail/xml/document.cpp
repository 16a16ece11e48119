// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/document.hpp>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;

namespace {

const support::TemporaryFolder folder;

std::unique_ptr<XmlDocument> document(const std::string& text) {
  std::ofstream(folder / "a.xml", std::ios::binary) << text;
  return std::make_unique<XmlDocument>(folder / "a.xml");
}

/// What is told of a text; empty if it is read.
std::string fault(const std::string& text) {
  try {
    (void)document(text);
  } catch (const XmlFaults& faults) {
    return faults.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string at(const XmlPlace& place) { return std::to_string(place.line) + ":" + std::to_string(place.column); }

}  // namespace

TEST_CASE("every element and attribute has its place") {
  const auto xml = document(
      "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- a=\"1\" -->\r\n<a x='1'\n   y = \"a>b='2'\"\n\tz=\"3\"><b\n/>text<c z=''/></a>\n");
  const pugi::xml_node a = xml->root();
  CHECK(at(xml->place()) == "1:1");
  CHECK(at(xml->place(a)) == "3:2");
  CHECK(at(xml->place(a, "x")) == "3:4");
  CHECK(at(xml->place(a, "y")) == "4:4");
  CHECK(at(xml->place(a, "z")) == "5:2");
  CHECK(at(xml->place(a, "w")) == "3:2");  // is not there
  CHECK(at(xml->place(a.child("b"))) == "5:9");
  CHECK(at(xml->place(a.child("c"), "z")) == "6:10");
  CHECK(xml->place(a).text() == xml->path() + ":3:2");
}

TEST_CASE("what is no XML, or no honest one, is refused with its place") {
  CHECK(contains(fault("<a>\n  <b>\n</a>"), "a.xml:3:"));
  CHECK(contains(fault("<a>\n  <b>\n</a>"), "is not well-formed XML"));
  CHECK(contains(fault("<a x=1/>"), "is not well-formed XML"));
  CHECK(contains(fault("nothing"), "(no element)"));
  CHECK(contains(fault("<a>\n<b x=\"1\" y=\"2\" x=\"3\"/></a>"), "a.xml:2:16: attribute 'x' is given twice"));
  CHECK(contains(fault("<a/>\n<b/>"), "a.xml:2:2: a second root element"));
  CHECK(contains(fault("<!DOCTYPE a [<!ENTITY x \"y\">]><a/>"), "declares entities"));
  CHECK(contains(fault("<a x=\"" + std::string(XmlDocument::max_attribute_size, 'x') + "\"/>"), "is longer than"));
  CHECK(contains(fault(std::string("<a>\0</a>", 8)), "a.xml:1:4: holds binary data"));
  std::string many = "<a";
  for (std::size_t i = 0; i <= XmlDocument::max_attributes; ++i) many += " a" + std::to_string(i) + "=\"\"";
  CHECK(contains(fault(many + "/>"), "exceeds the maximum"));
  CHECK(fault("<!DOCTYPE a SYSTEM \"a.dtd\"><a x=\"&unknown; &lt;\">&amp;</a>").empty());
}

TEST_CASE("letters put in, left out, changed and swapped are counted") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("pulseFreq_Hz", "pulseFreq_hz") == 0);
  CHECK(edit_distance("kitten", "sitting") == 3);  // Levenshtein's textbook pair
  CHECK(edit_distance("abcd", "acbd") == 1);
  CHECK(edit_distance("ca", "abc") == 3);  // of the restricted distance: no part is edited twice
  for (const auto& [a, b] : {std::pair("trajectory_seperator", "trajectory_separator"), std::pair("axis", "aixs")}) {
    CHECK(edit_distance(a, b) == 1);
    CHECK(edit_distance(b, a) == 1);
  }
}

TEST_CASE("the nearest name is suggested, or all if none is near") {
  const std::vector<std::string> known{"scanFreq_hz", "pulseFreq_hz", "scanAngle_deg"};
  CHECK(suggestion("scanFreqHz", known) == "; did you mean 'scanFreq_hz'?");
  CHECK(suggestion("scanAngle", known) == "; did you mean 'scanAngle_deg'?");
  CHECK(suggestion("q", known) == "; known names: scanFreq_hz, pulseFreq_hz, scanAngle_deg");
  CHECK(suggestion("q", {}).empty());
}

TEST_CASE("all faults are told, each once, and no more than can be read") {
  XmlReport report;
  CHECK(report.is_clean());
  CHECK_NOTHROW(report.require_clean());
  report.warn({"a.xml", 1, 2}, "odd");
  report.warn({"a.xml", 1, 2}, "odd");
  CHECK(report.warnings() == std::vector<std::string>{"a.xml:1:2: odd"});
  for (int i = 0; i < 2; ++i) report.fault({"a.xml", 3, 4}, "wrong");
  report.fault({"b.xml"}, "missing");
  try {
    report.require_clean();
    FAIL("is not clean");
  } catch (const FileError& error) {
    CHECK(error.what() == std::string("a.xml:3:4: wrong\nb.xml: missing"));
    CHECK(error.path() == "a.xml");
    CHECK(error.place() == "line 3, column 4");
    CHECK(error.problem() == "wrong");
  }
  for (std::size_t i = 0; i < 2 * XmlReport::max_told; ++i) report.fault({"a.xml", i + 10, 1}, "wrong");
  try {
    report.require_clean();
  } catch (const XmlFaults& faults) {
    CHECK(faults.faults().size() == XmlReport::max_told);
    CHECK(contains(faults.what(), "\nand 900 more"));
  }
}
