// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_ERROR_HPP
#define PULSECAST_BASE_ERROR_HPP

#include <array>
#include <charconv>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

namespace text {
/// Shortest decimal text of a number that reads back the same.
inline std::string to_text(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

/// Concatenated texts, such as a message. Compiled once, but each `+` of texts where it stands.
[[gnu::noinline]] inline std::string joined(std::initializer_list<std::string_view> texts) {
  std::string all;
  for (const std::string_view text : texts) all.append(text);
  return all;
}
}  // namespace text

/// Setting outside its allowed range. Thrown when the stage that holds it is made, never later.
class SettingError : public std::invalid_argument {
 public:
  /// `field` as in `Scanner::pulse_rate`; `value` in `unit`, an SI symbol; `allowed` in words.
  SettingError(std::string field, double value, std::string unit, std::string allowed)
      : std::invalid_argument(message(field, value, unit, allowed)),
        field_(std::move(field)),
        unit_(std::move(unit)),
        allowed_(std::move(allowed)),
        value_(value) {}

  /// `problem` follows `field` in the message: `tEnd` and ` is not after tStart`, without a number.
  SettingError(std::string field, std::string problem)
      : std::invalid_argument(text::joined({field, problem})), field_(std::move(field)), problem_(std::move(problem)) {}

  /// Copy of this error whose field is prefixed by a name, as in `leg 3: Scanner::pulse_rate`.
  [[nodiscard]] SettingError of(const std::string& name) const {
    std::string field = text::joined({name, ": ", field_});
    return problem_.empty() ? SettingError(std::move(field), value_, unit_, allowed_)
                            : SettingError(std::move(field), problem_);
  }

  /// Name, as in `Scanner::pulse_rate`.
  [[nodiscard]] const std::string& field() const noexcept { return field_; }
  [[nodiscard]] double value() const noexcept { return value_; }            ///< refused, in `unit()`; NaN if none
  [[nodiscard]] const std::string& unit() const noexcept { return unit_; }  ///< SI symbol; empty for a pure number
  [[nodiscard]] const std::string& allowed() const noexcept { return allowed_; }  ///< allowed range, in words

 private:
  static std::string message(const std::string& field, double value, const std::string& unit,
                             const std::string& allowed) {
    const std::string_view blank = unit.empty() ? "" : " ";
    return text::joined({field, " is ", text::to_text(value), blank, unit, ", but must be ", allowed});
  }

  std::string field_, unit_, allowed_, problem_;
  double value_ = std::numeric_limits<double>::quiet_NaN();
};

/// Calls a function. Prefixes `name` to the field of its `SettingError`, unless it is there.
decltype(auto) naming(const std::string& name, const auto& function) {
  try {
    return function();
  } catch (const SettingError& error) {
    if (error.field().starts_with(name)) throw;
    throw error.of(name);
  }
}

/// Missing, malformed, truncated or unwritable file. Thrown by the rooms beside the core only.
class FileError : public std::runtime_error {
 public:
  /// `place`, as in "line 12" or "byte 375", is empty if the error concerns the whole file.
  FileError(std::string path, std::string place, std::string problem)
      : std::runtime_error(text::joined({path, place.empty() ? "" : ", ", place, ": ", problem})),
        path_(std::move(path)),
        place_(std::move(place)),
        problem_(std::move(problem)) {}

  [[nodiscard]] const std::string& path() const noexcept { return path_; }  ///< name of the file
  /// As in "line 12"; empty for the whole file.
  [[nodiscard]] const std::string& place() const noexcept { return place_; }
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }  ///< defect and expectation

 private:
  std::string path_, place_, problem_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
