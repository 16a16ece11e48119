// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/helios/detail/xml/element.hpp>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

/// Short texts of elements, read beside a file `mesh.obj`.
namespace pulsecast::support {

/// Lets `fields(XmlInput&)` read an element; what is reported, faults first.
template <class Fields>
std::string xml_told(const std::string& text, Fields fields) {
  static const TemporaryFolder folder;
  std::ofstream(folder / "a.xml", std::ios::binary) << text;
  std::ofstream(folder / "mesh.obj") << "v 0 0 0\n";
  const helios::XmlDocument document(folder / "a.xml");
  const helios::AssetSearch search({folder.path()});
  helios::XmlReport report;
  helios::XmlInput io(document, document.root(), report, search);
  fields(io);
  io.finish();
  std::string told;
  try {
    report.require_clean();
  } catch (const helios::XmlFaults& faults) {
    told = faults.what();
  }
  for (const std::string& warning : report.warnings()) told += "\nwarning " + warning;
  return told;
}

}  // namespace pulsecast::support
