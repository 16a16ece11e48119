// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKETS_CALIBRATION_FILE_HPP
#define PULSECAST_IO_DETAIL_PACKETS_CALIBRATION_FILE_HPP

#include <yaml-cpp/yaml.h>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Calibration of a sensor as a tree of YAML, of which JSON is a part. Its errors name the line.
class CalibrationFile {
 public:
  /// @throws FileError for a file that is no map of YAML
  CalibrationFile(const std::filesystem::path& path, std::string_view expected) : path_(path.string()) {
    InputFile file(path, expected);
    if (file.size() > InputFile::block_size) file.fail(text::joined({"is longer than 1 MiB: expected ", expected}));
    const std::string text = file.take_rest();
    try {
      root_ = YAML::Load(text);  // the first document: LoadAll does not return from some damaged files
    } catch (const YAML::Exception& error) {
      fail(error.mark, "is no YAML or JSON: " + error.msg);
    }
    if (!root_.IsMap()) file.fail(text::joined({"is no map: expected ", expected}));
  }

  [[nodiscard]] const YAML::Node& root() const noexcept { return root_; }

  /// Value of a key; empty if there is none. @throws FileError if the parent is no map
  [[nodiscard]] std::optional<YAML::Node> find(const YAML::Node& parent, const std::string& key) const {
    if (!parent.IsMap()) fail(parent, "is no map: expected one with " + key);
    const YAML::Node node = parent[key];
    return node.IsDefined() ? std::optional(node) : std::nullopt;
  }

  /// Value of a key. @throws FileError if there is none
  [[nodiscard]] YAML::Node at(const YAML::Node& parent, const std::string& key) const {
    if (std::optional<YAML::Node> node = find(parent, key)) return *node;
    fail(parent, "has no " + key);
  }

  /// Value of a key of the root, or else of a section, a map in it; empty if there is none.
  [[nodiscard]] std::optional<YAML::Node> find(const std::string& key) const {
    std::optional<YAML::Node> found = find(root_, key);
    for (const auto& section : root_)
      if (!found && section.second.IsMap()) found = find(section.second, key);
    return found;
  }
  [[nodiscard]] YAML::Node at(const std::string& key) const {
    if (std::optional<YAML::Node> node = find(key)) return *node;
    fail(root_, "has no " + key);
  }

  /// Text of a scalar, which is called `name` in messages. @throws FileError for anything else
  [[nodiscard]] std::string word(const YAML::Node& node, const std::string& name) const {
    if (!node.IsScalar()) fail(node, name + " is a list or map: expected one value");
    return node.Scalar();
  }

  /// Number from `low` to `high`. @throws FileError for anything else
  double number(const YAML::Node& node, const std::string& name, double low, double high) const {
    const std::string scalar = word(node, name);
    const std::optional<double> value = text::finite_number_in(scalar);
    if (!value || *value < low || *value > high) {
      const std::string from = low < high ? "a number from " + text::to_text(low) + " to " : "";
      fail(node, text::joined({name, " is ", text::quoted(scalar), ": expected ", from, text::to_text(high)}));
    }
    return *value;
  }

  /// As many numbers from `low` to `high`. @throws FileError for anything else
  [[nodiscard]] std::vector<double> numbers(const YAML::Node& node, const std::string& name, std::size_t count,
                                            double low, double high) const {
    if (!node.IsSequence() || node.size() != count)
      fail(node, text::joined({name, " is no list of ", std::to_string(count)}));
    std::vector<double> values;
    for (const YAML::Node& value : node) values.push_back(number(value, name, low, high));
    return values;
  }

  /// Keeps to the rule for a key that is refused but for one number or list, within 1e-6. @throws FileError
  void require(const YAML::Node& node, const std::string& name, const std::vector<double>& needed,
               const FormatRule& rule) const {
    constexpr double any = 1e12;
    const std::vector<double> given =
        node.IsSequence() ? numbers(node, name, needed.size(), -any, any) : std::vector{number(node, name, -any, any)};
    const auto is_near = [](double a, double b) { return std::abs(a - b) <= 1e-6; };
    if (!std::ranges::equal(given, needed, is_near))
      fail(node, name, " is ", text::quoted(node.IsScalar() ? node.Scalar() : "a list"), ": expected ", rule.meaning);
  }

  /// @throws FileError about a node
  [[noreturn]] void fail(const YAML::Node& node, const auto&... problem) const { fail(node.Mark(), problem...); }

 private:
  [[noreturn]] void fail(const YAML::Mark& mark, const auto&... problem) const {
    throw FileError(path_, mark.is_null() ? "" : text::message("line ", mark.line + 1), text::message(problem...));
  }

  std::string path_;
  YAML::Node root_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
