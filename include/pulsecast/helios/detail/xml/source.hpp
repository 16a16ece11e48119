// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SOURCE_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SOURCE_HPP

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <pulsecast/helios/detail/asset_search.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// Filters that load the geometry of a part.
namespace PULSECAST_NAMESPACE::helios::xml {

/// `filepath`, `efilepath`, or, as an extension, `filepaths` with `|` between them.
inline void files(XmlInput& io, std::vector<std::filesystem::path>& paths) {
  const auto take = [&](const char* name, const std::string& text, const AssetMatch& match) {
    io.take(name, text, match);
    paths.insert(paths.end(), match.files.begin(), match.files.end());
  };
  const auto one = io.given("filepath"), by_pattern = io.given("efilepath"), list = io.given("filepaths");
  if (by_pattern) {
    take("efilepath", *by_pattern, io.search().find_all(*by_pattern));
  } else if (list) {
    for (std::string_view rest = *list; paths.size() < 100'000;) {
      const std::size_t end = rest.find('|');
      take("filepaths", std::string(rest.substr(0, end)), io.search().find(std::string(rest.substr(0, end))));
      if (end == std::string_view::npos) break;
      rest.remove_prefix(end + 1);
    }
  } else if (one) {
    take("filepath", *one, io.search().find(*one));
  } else {
    io.require({"filepath"});
  }
}
inline void files(XmlOutput& io, std::vector<std::filesystem::path>& paths) {
  if (paths.size() == 1) return io.file("filepath", paths.front());
  std::string text;
  for (const std::filesystem::path& path : paths)
    text.append(text.empty() ? "" : "|").append(std::filesystem::absolute(path).string());
  io.put("filepaths", text);
}

/// A loading filter.
inline void fields(FieldIo& io, PartSource& source) {
  std::visit(
      [&](auto& of_kind) {
        if (io.reads())
          files(input(io), of_kind.files);
        else
          files(output(io), of_kind.files);
        of_kind.fields(io);
      },
      source);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
