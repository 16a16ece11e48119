// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/xml/library.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;

namespace {

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
      return std::filesystem::path(reference.document->document().path()).filename().string() + " " + reference.node.name() + " " +
             reference.node.attribute("id").value();
    try {
      report.require_clean();
    } catch (const XmlFaults& faults) {
      return faults.what();
    }
    return "nothing, and no word of it";
  }

  support::TemporaryFolder root{};
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

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
  CHECK(contains(report.warnings()[0], "odd.xml:1:12: element <scaner> in <document> is not known; did you mean 'scanner'?"));
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
