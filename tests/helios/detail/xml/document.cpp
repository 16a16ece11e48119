// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/document.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/helios/detail/xml/library.hpp>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;
using support::contains;

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

std::string at(const XmlPlace& place) { return std::to_string(place.line) + ":" + std::to_string(place.column); }

/// A text in UTF-16 with a byte order mark.
std::string utf16(std::u16string_view text, bool is_little) {
  std::string bytes = is_little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char16_t unit : text) {
    const char low = static_cast<char>(unit & 0xFF), high = static_cast<char>(unit >> 8);
    bytes += is_little ? std::string{low, high} : std::string{high, low};
  }
  return bytes;
}

/// A survey that refers to documents in a folder of assets.
struct Library {
  Library() {
    std::filesystem::create_directories(root / "assets");
    put("survey.xml", "<document><survey/><scanner id=\"own\"/><scanner id=\"own\"/></document>");
    put("assets/a.xml", "<document><scanner id=\"one\"/><platform id=\"one\"/><scanner id=\"#two\"/></document>");
    put("assets/broken.xml", "<document><scanner></document>");
  }

  void put(const char* name, const std::string& text) const { std::ofstream(root / name) << text; }

  /// Where the reference leads, as `file element id`; or what is reported.
  std::string found(const std::string& text, const char* element = "scanner") {
    XmlReport report;
    XmlLibrary library({root / "assets", root.path()}, report);
    const XmlLibraryDocument& survey = library.read(root / "survey.xml");
    const XmlInput io(survey.document(), survey.document().root().child("survey"), report, survey.search());
    const XmlReference reference = library.find(io, survey, "scanner", text, element);
    if (reference)
      return std::filesystem::path(reference.document->document().path()).filename().string() + " " +
             reference.node.name() + " " + reference.node.attribute("id").value();
    try {
      report.require_clean();
    } catch (const XmlFaults& faults) {
      return faults.what();
    }
    return "nothing, and no word of it";
  }

  support::TemporaryFolder root{};
};

}  // namespace

TEST_CASE("UTF-16 with a byte order mark is read as UTF-8, whatever its characters and its order of bytes") {
  for (const bool is_little : {true, false}) {
    const auto read = document(
        utf16(u"<?xml version=\"1.0\" encoding=\"UTF-16\"?>\r\n<a b=\"M\u00FCnchen \u20AC \U0001F332\"/>", is_little));
    CHECK(read->root().attribute("b").value() == std::string("M\xC3\xBCnchen \xE2\x82\xAC \xF0\x9F\x8C\xB2"));
    CHECK(at(read->place(read->root())) == "2:2");
    CHECK_FALSE(read->oddity());
    std::string halved = utf16(u"<a b=\"\xD83C\"/>", is_little);
    CHECK(document(halved)->root().attribute("b").value() == std::string("\xEF\xBF\xBD"));
    halved = utf16(u"<a b=\"\xDF32\xD83C", is_little);
    CHECK(contains(fault(halved), "not well-formed"));
    CHECK(contains(fault(halved + "x"), "not well-formed"));
    CHECK(contains(fault(halved.substr(2)), "byte order mark"));
  }
  CHECK_FALSE(fault("\xFF\xFE").empty());
  CHECK(contains(fault(std::string("\xFF\xFE\0\0<\0\0\0", 8)), "binary data"));
}

TEST_CASE("every element and attribute has its place") {
  const auto xml = document(
      "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- a=\"1\" -->\r\n<a x='1'\n   y = \"a>b='2'\"\n\tz=\"3\"><b\n/>text<c "
      "z=''/></a>\n");
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
  for (std::size_t i = 0; i < 2 * XmlReport::max_listed; ++i) report.fault({"a.xml", i + 10, 1}, "wrong");
  try {
    report.require_clean();
  } catch (const XmlFaults& faults) {
    CHECK(faults.faults().size() == XmlReport::max_listed);
    CHECK(contains(faults.what(), "\nand 900 more"));
  }
}

TEST_CASE("a reference leads to an element of its name and id, here or in another document") {
  Library library;
  CHECK(library.found("own") == "survey.xml scanner own");
  CHECK(library.found("#own") == "survey.xml scanner own");
  CHECK(library.found("a.xml#one") == "a.xml scanner one");
  CHECK(library.found("a.xml#one", "platform") == "a.xml platform one");
  CHECK(library.found("assets/a.xml#one") == "a.xml scanner one");
  CHECK(library.found((library.root / "assets/a.xml").string() + "##two") == "a.xml scanner #two");
}

TEST_CASE("a reference that leads nowhere is told") {
  Library library;
  CHECK(contains(library.found("a.xml#noe"), "there is no <scanner> with the id 'noe' in "));
  CHECK(contains(library.found("a.xml#noe"), "did you mean 'one'?"));
  CHECK(contains(library.found("a.xml"), "expected file.xml#id"));
  CHECK(contains(library.found("b.xml#one"), "does not exist: looked for"));
  CHECK(contains(library.found("../../a.xml#one"), "does not exist: looked for"));
  CHECK(contains(library.found("broken.xml#one"), "broken.xml:1:"));
  CHECK(contains(library.found("broken.xml#one"), "scanner=\"broken.xml#one\" cannot be read"));
  CHECK(contains(library.found(""), "there is no <scanner> with the id ''"));
  library.put("assets/odd.xml", "<document><scaner/><scanner id=\"x\"/></document>");
  XmlReport report;
  XmlLibrary other({library.root / "assets"}, report);
  (void)other.read(library.root / "assets/odd.xml");
  CHECK(report.is_clean());
  REQUIRE(report.warnings().size() == 1);
  CHECK(contains(report.warnings()[0],
                 "odd.xml:1:12: element <scaner> in <document> is not known; did you mean 'scanner'?"));
}

TEST_CASE("a document outside the folders is read, with a warning") {
  Library library;
  library.put("assets/inner.xml", R"(<document><scanner id="x"/></document>)");
  library.put("outer.xml", R"(<document><scanner id="y"/></document>)");
  XmlReport report;
  XmlLibrary documents({library.root / "assets"}, report);
  const XmlLibraryDocument& inner = documents.read(library.root / "assets/inner.xml");
  XmlInput io(inner.document(), inner.find("scanner", "x"), report, inner.search());
  CHECK(documents.find(io, inner, "scanner", "../outer.xml#y", "scanner"));
  REQUIRE(report.warnings().size() == 1);
  CHECK(contains(report.warnings()[0], "inner.xml:1:12: scanner=\"../outer.xml#y\" is outside the assets folders: "));
}

TEST_CASE("of two elements with an id the first counts, with a warning; a document is read once") {
  Library library;
  XmlReport report;
  XmlLibrary documents({library.root.path()}, report);
  const XmlLibraryDocument& first = documents.read(library.root / "survey.xml");
  CHECK(report.warnings().size() == 1);
  CHECK(first.find("scanner", "own") == first.document().root().child("scanner"));
  CHECK(&documents.read(library.root / "survey.xml") == &first);
  CHECK(first.ids("scanner").size() == 2);
}
