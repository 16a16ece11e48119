// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MTL_HPP
#define PULSECAST_IO_MTL_HPP

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <map>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tiny_obj_loader.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/spectral_library.hpp>
#include <pulsecast/scene/material.hpp>

namespace pulsecast::io {

/// Content of MTL files.
struct MaterialLibrary {
  std::map<std::string, Material, std::less<>> materials;  ///< materials by name
  std::vector<std::string> warnings;                       ///< oddities that could still be read
};

/// Reads an MTL file. Colours select the scattering model: `Ks` Phong's, `Kd` alone Lambert's. The reflectance is `helios_reflectance`, a
/// fraction, or else the spectrum named by `helios_spectra`. `Ns`, `helios_isGround` and `helios_classification` count, too; other keys are
/// ignored. The first of equal names counts. Keys before the first name describe the material "default". Throws a `FileError` with path and
/// line at the first error.
[[nodiscard]] MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra = {});

/// Surface without a description. It scatters alike in all directions, as in HELIOS++, which defined the extra keys.
[[nodiscard]] inline Material undescribed(std::string name) {
  return {.name = std::move(name), .scattering = Scattering::direction_independent};
}

namespace detail {

static_assert(std::same_as<tinyobj::real_t, double>, "define TINYOBJLOADER_USE_DOUBLE and link libtinyobjloader_double");

inline constexpr double max_number = 1e12;  ///< upper limit in a file, so that products of a few numbers cannot overflow

/// Number in a word, if tinyobjloader would read the same. It takes other words for zero or the number that they begin with, and
/// fails at very long ones.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view word) {
  const std::optional<Number> value = word.size() <= 100 ? text::number_in<Number>(word) : std::nullopt;
  return value && std::isfinite(static_cast<double>(*value)) ? value : std::nullopt;
}

/// Text of an OBJ or MTL file, read in pieces.
class StatementFile {
 public:
  explicit StatementFile(const std::filesystem::path& path) : file_(path, "an OBJ or MTL file") {}

  /// Next whole statements, about `bytes` long; empty at the end of the file.
  [[nodiscard]] std::string next(std::size_t bytes) {
    std::string text = std::exchange(rest_, {});
    std::size_t end = 0;
    while (end == 0) {
      const std::string_view more = file_.take(bytes);
      if (more.empty()) break;
      text += more;
      end = end_of_statements(text);
    }
    if (end > 0) {
      rest_.assign(text, end);
      text.resize(end);
    }
    if (!std::exchange(begun_, true)) text.erase(0, text.size() - text::without_byte_order_mark(text).size());
    return text;
  }

  [[nodiscard]] std::string all() { return file_.take_rest(); }

  static constexpr std::size_t piece_bytes = std::size_t{1} << 18;  ///< default size of a piece [byte]

  [[nodiscard]] const std::string& path() const { return file_.path(); }
  [[noreturn]] void fail(const std::string& problem) const { file_.fail(problem); }

 private:
  /// End of the last line that is not continued in the next; 0 if there is none.
  static std::size_t end_of_statements(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.rfind('\n') + 1;
      text = text.substr(0, end == 0 ? 0 : end - 1);
      const std::size_t last = text.find_last_not_of(" \t\v\f\r");
      if (end > 0 && (last == text.npos || text[last] != '\\')) return end;
    }
    return 0;
  }

  InputFile file_;
  std::string rest_;
  bool begun_ = false;
};

/// Stream buffer that feeds tinyobjloader statement by statement, so that every check and error knows its line.
class StatementBuffer : public std::streambuf {
 public:
  /// `text` of whole statements of a file, behind `lines_before` lines.
  StatementBuffer(std::string path, std::string text, std::size_t lines_before)
      : path_(std::move(path)), text_(std::move(text)), lines_before_(lines_before), lines_(lines_before) {}

 protected:
  /// Sets `ready`, empty at first, to the text for tinyobjloader for the current statement. Throws a `FileError` if it is invalid.
  virtual void check(std::string& ready) = 0;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t line() const { return line_; }                   ///< first line of the current statement, from 1
  [[nodiscard]] bool line_is_open() const { return open_; }                  ///< true for a last line without end
  [[nodiscard]] const std::string& statement() const { return statement_; }  ///< current statement, with one blank after the keyword
  [[nodiscard]] std::string_view keyword() const { return std::string_view(statement_).substr(0, statement_.find(' ')); }
  [[nodiscard]] std::string_view rest() const { return text::trimmed(std::string_view(statement_).substr(keyword().size())); }

  /// Words after the keyword.
  [[nodiscard]] const std::vector<std::string_view>& words() {
    words_.clear();
    for (std::string_view left = rest(); !left.empty();) words_.push_back(text::take_word(left));
    return words_;
  }

  [[nodiscard]] std::string quoted() const { return text::quoted(statement_); }
  [[noreturn]] void fail_here(const std::string& problem) const { throw FileError(path_, "line " + std::to_string(line_), problem); }
  void require(bool fulfilled, const char* expected) const {
    if (!fulfilled) fail_here(quoted() + ": expected " + expected);
  }

  /// Returns to the beginning of the text.
  void rewind() noexcept {
    at_ = 0;
    lines_ = lines_before_;
  }

  /// Advances to the next statement that is not empty; false at the end of the text.
  bool next_statement() {
    do {
      if (!take_statement()) return false;
    } while (statement_.empty() || statement_.starts_with('#'));
    if (statement_.find('#') != statement_.npos && !keyword().ends_with("mtl"))  // names may contain it, as in `usemtl Material #25`
      statement_.resize(std::min(statement_.find(" #"), statement_.size()));
    const std::string_view word = keyword(), after = rest();
    if (statement_.size() != word.size() + (after.empty() ? 0 : 1) + after.size())
      statement_ = std::string(word) + (after.empty() ? "" : " ") + std::string(after);
    return true;
  }

 private:
  int_type underflow() final {
    if (!next_statement()) return traits_type::eof();
    ready_.clear();
    check(ready_);
    ready_ += '\n';
    setg(ready_.data(), ready_.data(), ready_.data() + ready_.size());
    return traits_type::to_int_type(ready_.front());
  }

  /// Joins lines continued by a backslash, which tinyobjloader does not know. False at the end of the text.
  bool take_statement() {
    joined_.clear();
    line_ = lines_ + 1;
    for (bool goes_on = true; goes_on;) {
      open_ = at_ == text_.size();
      if (open_) break;
      const std::string_view text = take_line();
      goes_on = text.ends_with('\\') && !(joined_.empty() && text.starts_with('#'));
      if (joined_.empty() && !goes_on) {
        statement_ = text;
        return true;
      }
      joined_.append(text.substr(0, text.size() - (goes_on ? 1 : 0))) += ' ';
    }
    statement_ = text::trimmed(joined_);
    return !joined_.empty();
  }

  std::string_view take_line() {
    const std::size_t begin = at_, end = text_.find('\n', begin);
    open_ = end == text_.npos;
    at_ = open_ ? text_.size() : end + 1;
    const std::size_t after = open_ ? text_.size() : end;
    ++lines_;
    for (std::size_t i = begin; i < after; ++i) {
      char& c = text_[i];
      if (static_cast<unsigned char>(c) >= ' ') continue;
      if (c < '\t' || c > '\r') fail_here("holds binary data: expected the text of an OBJ or MTL file");
      c = ' ';
    }
    return text::trimmed(std::string_view(text_).substr(begin, after - begin));
  }

  std::string path_, text_;
  std::string joined_, statement_, ready_;
  std::vector<std::string_view> words_;
  std::size_t lines_before_, lines_, line_ = 0, at_ = 0;  // `at_`: begin of the next line in the text
  bool open_ = false;
};

class MtlReader : private StatementBuffer {
 public:
  MtlReader(StatementFile file, const SpectralLibrary& spectra) : StatementBuffer(file.path(), file.all(), 0), spectra_(spectra) {}

  [[nodiscard]] MaterialLibrary read() {
    std::istream stream(this);
    stream.exceptions(std::ios::badbit);  // passes on exceptions thrown while reading
    std::map<std::string, int> ignored_numbers;
    std::vector<tinyobj::material_t> found;
    tinyobj::LoadMtl(&ignored_numbers, &found, &stream, nullptr, nullptr);
    MaterialLibrary library;
    for (const tinyobj::material_t& m : found)
      if (!m.name.empty()) library.materials.emplace(m.name, material(m, library.warnings));
    return library;
  }

 private:
  void check(std::string& ready) override {
    // tinyobjloader drops keys before the first name, and its default exponent is 1
    static const std::string exponent = "\nNs " + pulsecast::detail::to_text(Material{}.specular_exponent) + "\n";
    const bool is_first = !std::exchange(begun_, true);
    if (keyword() == "newmtl") current_ = rest();
    lines_.try_emplace({current_, std::string(keyword())}, line());
    if (keyword() == "newmtl") {
      require(!rest().empty(), "the name of a material");
      ready = statement() + exponent;
      return;
    }
    const std::vector<std::string_view>& given = words();
    const auto are_within = [&](double high) {
      return std::all_of(given.begin(), given.end(), [high](std::string_view word) {
        const double value = number_in<double>(word).value_or(-1);
        return value >= 0 && value <= high;
      });
    };
    const bool is_one = given.size() == 1, is_colour = keyword() == "Kd" || keyword() == "Ks";
    if (is_colour) require((is_one || given.size() == 3) && are_within(max_number), "one or three numbers that are not negative");
    if (keyword() == "Ns") require(is_one && are_within(max_number), "a number that is not negative");
    if (keyword() == "helios_reflectance") require(is_one && are_within(100), "a fraction from 0 to 1, or up to 100 percent");
    if (keyword() == "helios_classification") require(is_one && number_in<std::uint16_t>(given[0]), "a whole number from 0 to 65535");
    if (is_first) ready = "newmtl default" + exponent;
    // with textures, tinyobjloader would change the colour, depending on the order
    if (is_colour || keyword() == "Ns" || keyword().starts_with("helios_")) ready += statement();
    // a single number is the value of red, green and blue. Source: MTL specification, Wavefront 1995.
    if (is_colour && is_one) ready.append(" ").append(given[0]).append(" ").append(given[0]);
  }

  [[nodiscard]] Material material(const tinyobj::material_t& m, std::vector<std::string>& warnings) const {
    const auto warn = [&](const char* key, const std::string& text) {
      const auto known = lines_.find({m.name, key});
      const std::string place = known == lines_.end() ? "" : ", line " + std::to_string(known->second);
      warnings.push_back(path() + place + ": material '" + m.name + "' " + text);
    };
    const auto extra = [&](const char* key) {
      const auto found = m.unknown_parameter.find(key);
      return found == m.unknown_parameter.end() ? std::string() : found->second;
    };
    Material made = undescribed(m.name);
    const double diffuse = m.diffuse[0] + m.diffuse[1] + m.diffuse[2], specular = m.specular[0] + m.specular[1] + m.specular[2];
    if (specular > 0) {
      made.scattering = Scattering::phong;
      made.specular_share = specular / (diffuse + specular);
    } else if (diffuse > 0) {
      made.scattering = Scattering::lambert;
    }
    made.specular_exponent = m.shininess;
    const std::string reflectance = extra("helios_reflectance"), spectrum(text::trimmed(extra("helios_spectra")));
    if (!reflectance.empty()) {
      made.reflectance = *number_in<double>(reflectance);
      if (made.reflectance > 1) {
        warn("helios_reflectance", "has the reflectance " + reflectance + ", which is taken as percent");
        made.reflectance /= 100;
      }
    } else if (const auto found = spectra_.spectra.find(spectrum); found != spectra_.spectra.end()) {
      made.spectrum = found->second;
      const double shortest = made.spectrum->shortest(), longest = made.spectrum->longest();
      for (const double wavelength : spectra_.wavelengths)
        if (!(wavelength >= shortest && wavelength <= longest))
          warn("helios_spectra", "has the spectrum '" + spectrum + "', which spans " + nanometres(shortest) + " to " + nanometres(longest) +
                                     " nm: for the laser of " + nanometres(wavelength) + " nm the nearest sample is used");
    } else if (!spectrum.empty()) {
      warn("helios_spectra", "refers to the spectrum '" + spectrum + "', which is in no library: a reflectance of 0.5 is assumed");
    }
    made.classification = number_in<std::uint16_t>(extra("helios_classification")).value_or(made.classification);
    const std::string ground = text::lower(extra("helios_isGround"));
    made.ground = ground == "true" || ground == "1";
    if (!made.ground && !ground.empty() && ground != "false" && ground != "0")
      warn("helios_isGround", "has helios_isGround '" + ground + "', expected true or false: false is assumed");
    return made;
  }

  [[nodiscard]] static std::string nanometres(double metres) { return pulsecast::detail::to_text(std::round(metres * 1e12) / 1e3); }

  const SpectralLibrary& spectra_;
  bool begun_ = false;
  std::string current_ = "default";                                   // name of the current material
  std::map<std::pair<std::string, std::string>, std::size_t> lines_;  // of each material and keyword
};

}  // namespace detail

inline MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra) {
  return detail::MtlReader(detail::StatementFile(path), spectra).read();
}

}  // namespace pulsecast::io

#endif
