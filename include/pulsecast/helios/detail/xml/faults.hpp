// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_FAULTS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_FAULTS_HPP

#include <algorithm>
#include <vector>

#include <pulsecast/base/error.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Position in an XML file; line 0 means the whole file.
struct XmlPlace {
  std::string path{};
  std::size_t line = 0, column = 0;  ///< from 1; columns count bytes

  /// `path:line:column`, the notation of editors.
  [[nodiscard]] std::string text() const {
    return line == 0 ? path : path + ":" + std::to_string(line) + ":" + std::to_string(column);
  }

  bool operator==(const XmlPlace&) const = default;
};

/// One error in a document.
struct XmlFault {
  XmlPlace place{};
  std::string problem{};  ///< the fault and the expectation
};

/// All faults of a document and of those that it refers to, as a `FileError` about the first.
/// `what()` has a line for each, `path:line:column: problem`.
class XmlFaults : public FileError {
 public:
  static constexpr std::size_t max_listed = 100;  ///< faults in `what()`

  /// `faults` must not be empty.
  explicit XmlFaults(std::vector<XmlFault> faults, std::vector<std::string> warnings = {})
      : FileError(faults.front().place.path, place_in_words(faults.front().place), faults.front().problem),
        faults_(std::move(faults)),
        warnings_(std::move(warnings)) {
    for (std::size_t i = 0; i < std::min(faults_.size(), max_listed); ++i)
      text_ += (i == 0 ? "" : "\n") + faults_[i].place.text() + ": " + faults_[i].problem;
    if (faults_.size() > max_listed) text_ += "\nand " + std::to_string(faults_.size() - max_listed) + " more";
  }

  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }
  [[nodiscard]] const std::vector<XmlFault>& faults() const noexcept { return faults_; }
  /// Those of the same documents.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  static std::string place_in_words(const XmlPlace& place) {
    return place.line == 0 ? "" : "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
  }

  std::vector<XmlFault> faults_;
  std::vector<std::string> warnings_;
  std::string text_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
