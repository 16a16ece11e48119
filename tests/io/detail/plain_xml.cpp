// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/plain_xml.hpp>

#include <string>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io::detail;
using support::contains;

TEST_CASE("XML files that could hide a document type from a search of bytes are refused") {
  const support::TemporaryFolder folder;
  const auto problem = [&](const std::string& text) {
    return support::file_error([&] { require_plain_xml(folder.write("a.xml", text)); }).problem();
  };
  const std::string root = "<a/>";
  for (const std::string encoding :
       {"UTF-7", "utf-7", "UTF-16", "UTF-32", "IBM1140", "EBCDIC-CP-DE", "windows-1252", "UTF-8 ", ""}) {
    CAPTURE(encoding);
    for (const std::string& declaration : {"<?xml version=\"1.0\" encoding=\"" + encoding + "\"?>",
                                           "\xEF\xBB\xBF<?xml\tversion='1.0'\n encoding = '" + encoding + "' ?>",
                                           "<?xml encoding='UTF-8' encoding='" + encoding + "'?>",
                                           "<?xml x=' encoding=\"UTF-8\"' encoding='" + encoding + "'?>"})
      CHECK(contains(problem(declaration + root),
                     "has the encoding '" + encoding + "': expected UTF-8, US-ASCII or ISO-8859-1"));
  }
  for (const std::string declaration :
       {"<?xml version=\"1.0\" encoding?>", "<?xml encoding=\"UTF-8?>", "<?xml encoding=UTF-7?>",
        "<?xml version=\"?>\" encoding=\"UTF-7\"?>", "<?xml encoding UTF-7"})
    CHECK(contains(problem(declaration + root), "malformed XML declaration"));
  CHECK(contains(problem(std::string("<\0?\0x\0m\0l\0", 10)), "does not begin as XML in UTF-8"));
  CHECK(contains(problem("\xFF\xFE<\0"), "does not begin as XML in UTF-8"));
  CHECK(contains(problem("\x4C\x6F\xA7\x94\x93"), "does not begin as XML in UTF-8"));  // EBCDIC
  CHECK(
      contains(problem("<?xml version='1.0'?>" + std::string(2'000'000, ' ') + "<!DOCTYPE a>"), "has a document type"));
  for (const std::string declaration :
       {"", "<?xml version='1.0'?>", "<?xml version=\"1.0\" encoding=\"utf-8\" standalone='yes'?>",
        "<?xml version='1.0' encoding='US-ASCII'?>", "<?xml version='1.0' encoding='ISO-8859-1'?>",
        "<?xml-stylesheet href='a'?>"})
    CHECK_NOTHROW(require_plain_xml(folder.write("a.xml", declaration + root)));
}
