// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SPECTRAL_LIBRARY_HPP
#define PULSECAST_IO_SPECTRAL_LIBRARY_HPP

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/spectrum.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Unit of reflectance in a file.
enum class ReflectanceScale : std::uint8_t { fraction, percent };

/// Content of a spectrum file.
struct SpectrumFile {
  std::shared_ptr<const Spectrum> spectrum;             ///< reflectance by wavelength, as fractions
  ReflectanceScale scale = ReflectanceScale::fraction;  ///< unit in the file; the spectrum itself has fractions
  std::string report{};                                 ///< units assumed for the columns, and the reason
  std::vector<std::string> warnings{};                  ///< oddities that could still be read
};

/// Reads a text of two columns, wavelength and reflectance, with any header and further columns; rows in any order.
/// Rows without a value, also -1.23e34 of the USGS, are left out. Units come from the header, as in the ECOSTRESS and
/// ASTER libraries ("X Units:", "Y Units:"), or from column titles in the line above the numbers. Otherwise wavelengths
/// that begin at 100 or more are nanometres, below 0.01 metres, and micrometres between; reflectances above 1.5 are
/// percent. The report states units and reasons. Throws a `FileError` with path and line at the first error.
[[nodiscard]] SpectrumFile read_spectrum(const std::filesystem::path& path);

/// Reads a file, or all files of a folder. A spectrum is named like its file without the extension; files without one
/// are left out with a warning. Throws a `FileError` if there is no spectrum at all.
[[nodiscard]] SpectralLibrary read_spectral_library(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_SPECTRAL_LIBRARY)
#include <algorithm>
#include <array>
#include <system_error>

#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Unit of the first column.
enum class WavelengthUnit : std::uint8_t { metre, micrometre, nanometre, wavenumber };

/// True if a text contains a word that is not part of a longer one.
[[nodiscard]] inline bool has_word(std::string_view text, std::string_view word) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

[[nodiscard]] inline std::optional<WavelengthUnit> wavelength_unit_in(std::string_view text) {
  if (text.find("wavenumber") != text.npos || text.find("cm-1") != text.npos) return WavelengthUnit::wavenumber;
  for (const std::string_view word : {"micromet", "micron"})
    if (text.find(word) != text.npos) return WavelengthUnit::micrometre;
  if (text.find("nanomet") != text.npos || has_word(text, "nm")) return WavelengthUnit::nanometre;
  for (const std::string_view word : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m"})  // two micro signs, and that of Latin-1
    if (has_word(text, word)) return WavelengthUnit::micrometre;
  return std::nullopt;
}

[[nodiscard]] inline std::optional<ReflectanceScale> reflectance_scale_in(std::string_view text) {
  if (text.find("percent") != text.npos || text.find('%') != text.npos) return ReflectanceScale::percent;
  if (text.find("fraction") != text.npos || text.find("0-1") != text.npos) return ReflectanceScale::fraction;
  return std::nullopt;
}

class SpectrumReader {
 public:
  explicit SpectrumReader(const std::filesystem::path& path) : table_(path, "a spectrum") {}

  [[nodiscard]] SpectrumFile read() {
    while (table_.next()) row();
    if (samples_.empty()) table_.fail("holds no row of two numbers: expected wavelength and reflectance, side by side");
    if (!unit_ || !scale_) titles();
    SpectrumFile file;
    file.report = table_.path() + ": " + take_wavelengths() + "; " + take_reflectances(file.scale);
    std::ranges::stable_sort(samples_, {}, &Row::wavelength);
    file.spectrum = std::make_shared<const Spectrum>(united());
    file.warnings = std::move(warnings_);
    return file;
  }

 private:
  /// Row of the file.
  struct Row : SpectralSample {
    std::size_t line = 0;
  };

  /// Number, or empty where marked as missing; `is_cell` is false for anything else.
  struct Cell {
    std::optional<double> number;
    bool is_cell;
  };

  static Cell cell(std::string_view word) {
    const std::optional<double> number = text::finite_number_in(word);
    if (number && *number > -1e30) return {number, true};
    return {std::nullopt, number || text::is_same_word(word, "nan") || text::is_same_word(word, "na")};
  }

  void row() {
    static constexpr std::string_view separators = " \t,;";
    const std::string_view text = table_.text();
    std::string_view rest = text;
    const std::optional<double> wavelength = text::finite_number_in(text::take_word(rest, separators));
    const Cell reflectance = cell(text::take_word(rest, separators));
    if (!wavelength || !reflectance.is_cell) {
      if (begun_ && !text.starts_with('#') && !text.starts_with("//"))
        table_.fail_here(text::quoted(text) + ": expected wavelength and reflectance, two numbers");
      if (!begun_) header(text);
      return;
    }
    begun_ = true;
    if (!(*wavelength >= 1e-12 && *wavelength <= 1e12))
      table_.fail_here(text::quoted(text) + ": expected a wavelength greater than 0");
    if (reflectance.number) samples_.push_back({{*wavelength, *reflectance.number}, table_.line()});
  }

  void header(std::string_view text) {
    const std::string line = text::lower(text);
    titles_ = line;
    titles_line_ = table_.line();
    const auto is_key = [&](std::string_view key) { return line.starts_with(key); };
    if (is_key("x units:")) unit_ = wavelength_unit_in(line);
    if (!is_key("y units:")) return;
    scale_ = reflectance_scale_in(line);
    scale_line_ = table_.line();
    if (line.find("reflect") == line.npos)
      table_.fail_here(text::quoted(text) + ": expected a spectrum of reflectance");
  }

  /// Takes units from the line above the numbers if no key named them.
  void titles() {
    if (!unit_) unit_ = wavelength_unit_in(titles_);
    if (scale_ || titles_.find("reflect") == titles_.npos) return;
    scale_ = reflectance_scale_in(titles_);
    scale_line_ = titles_line_;
  }

  std::string take_wavelengths() {
    static constexpr std::array<const char*, 4> names{"metres", "micrometres", "nanometres", "waves per centimetre"};
    const auto [low, high] = std::ranges::minmax_element(samples_, {}, &Row::wavelength);
    const double shortest = low->wavelength;
    const bool given = unit_.has_value();
    if (!given)
      unit_ = shortest >= 100   ? WavelengthUnit::nanometre
              : shortest < 0.01 ? WavelengthUnit::metre
                                : WavelengthUnit::micrometre;
    const std::string range = text::to_text(shortest) + " to " + text::to_text(high->wavelength);
    for (Row& sample : samples_) {
      double& w = sample.wavelength;
      w = *unit_ == WavelengthUnit::metre        ? w
          : *unit_ == WavelengthUnit::micrometre ? w * 1e-6
          : *unit_ == WavelengthUnit::nanometre  ? w * 1e-9
                                                 : 0.01 / w;
      if (odd_ == 0 && (w < 1e-7 || w > 1e-3)) odd_ = sample.line;
    }
    const std::string name = names[static_cast<std::size_t>(*unit_)];
    if (odd_ > 0) warn(odd_, "its wavelengths, " + range + " " + name + ", are not all between 100 nm and 1 mm");
    return "wavelengths in " + name + (given ? ", by the header" : ", by the values " + range);
  }

  std::string take_reflectances(ReflectanceScale& scale) {
    const double largest = std::ranges::max_element(samples_, {}, &Row::reflectance)->reflectance;
    const std::string reach = "its values reach " + text::to_text(largest);
    const bool many = largest > 1.5;
    const bool given = scale_.has_value() && !(*scale_ == ReflectanceScale::fraction && many);
    scale = given ? *scale_ : many ? ReflectanceScale::percent : ReflectanceScale::fraction;
    const bool percent = scale == ReflectanceScale::percent;
    if (scale_ && !given) warn(scale_line_, "its header says fraction, but " + reach + ": they are taken as percent");
    if (percent && largest <= 1) warn(scale_line_, "its header says percent, but " + reach + " only");
    Oddity clipped;
    for (Row& sample : samples_) {
      const double fraction = percent ? sample.reflectance / 100 : sample.reflectance;
      sample.reflectance = std::clamp(fraction, 0.0, 1.0);
      if (sample.reflectance != fraction) clipped.at(sample.line);
    }
    if (clipped.count > 0)
      warn(clipped.first, "a reflectance below 0 or above 1 is clipped, the first of " + std::to_string(clipped.count));
    return std::string("reflectance in ") + (percent ? "percent" : "fractions") +
           (given ? ", by the header" : ", as " + reach);
  }

  /// Samples with those of equal wavelength averaged.
  [[nodiscard]] std::vector<SpectralSample> united() {
    std::vector<SpectralSample> all;
    Oddity repeated;
    for (std::size_t i = 0; i < samples_.size();) {
      std::size_t end = i;
      double sum = 0;
      for (; end < samples_.size() && samples_[end].wavelength == samples_[i].wavelength; ++end)
        sum += samples_[end].reflectance;
      all.push_back({samples_[i].wavelength, std::min(sum / static_cast<double>(end - i), 1.0)});
      if (end - i > 1) repeated.at(samples_[i + 1].line);
      i = end;
    }
    if (repeated.count > 0)
      warn(repeated.first,
           "a wavelength is repeated, the first of " + std::to_string(repeated.count) + ": the mean is used");
    return all;
  }

  void warn(std::size_t line, const std::string& text) {
    warnings_.push_back(table_.path() + ", line " + std::to_string(line) + ": " + text);
  }

  TextTable table_;
  std::vector<Row> samples_;
  std::optional<WavelengthUnit> unit_;
  std::optional<ReflectanceScale> scale_;
  std::string titles_;  // last line of the header, in small letters
  std::size_t titles_line_ = 0;
  std::vector<std::string> warnings_;
  std::size_t scale_line_ = 0, odd_ = 0;  // lines of the header's scale, and of the first odd wavelength
  bool begun_ = false;
};

}  // namespace detail

PULSECAST_INLINE SpectrumFile read_spectrum(const std::filesystem::path& path) {
  return reading(path, [&] { return detail::SpectrumReader(path).read(); });
}

PULSECAST_INLINE SpectralLibrary read_spectral_library(const std::filesystem::path& path) {
  std::error_code ignored;
  std::vector<std::filesystem::path> files{path};
  if (std::filesystem::is_directory(path, ignored)) {
    files = detail::files_in(path);
    std::erase_if(files, [](const auto& file) { return file.filename().string().starts_with('.'); });
  }
  SpectralLibrary library;
  for (const std::filesystem::path& file : files) {
    try {
      SpectrumFile read = read_spectrum(file);
      if (!library.spectra.try_emplace(file.stem().string(), read.spectrum).second) {
        library.warnings.push_back(file.string() + ": is left out; another file has a spectrum of this name");
        continue;
      }
      library.reports.push_back(std::move(read.report));
      library.warnings.insert(library.warnings.end(), read.warnings.begin(), read.warnings.end());
    } catch (const FileError& unreadable) {
      if (files.size() == 1) throw;
      library.warnings.push_back(std::string(unreadable.what()) + "; it is left out");
    }
  }
  if (library.spectra.empty())
    throw FileError(path.string(), "", "holds no spectrum: expected files of wavelength and reflectance");
  return library;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
