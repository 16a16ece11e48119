// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SPECTRAL_LIBRARY_HPP
#define PULSECAST_IO_SPECTRAL_LIBRARY_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Unit of reflectance in a file.
enum class ReflectanceScale : std::uint8_t { fraction, percent };

/// Content of a spectrum file.
struct SpectrumFile {
  std::shared_ptr<const Spectrum> spectrum;             ///< reflectance by wavelength, as fractions
  ReflectanceScale scale = ReflectanceScale::fraction;  ///< unit in the file
  std::string report{};                                 ///< units assumed, and reasons
  std::vector<std::string> warnings{};                  ///< oddities that could still be read
};

/// Reads a text of wavelength and reflectance, with any header and further columns, in rows of any
/// order. Those without a value, also -1.23e34 of the USGS, are left out. Units are those of the
/// header, as of ECOSTRESS and ASTER ("X Units:", "Y Units:"), or of titles above the numbers. Else
/// wavelengths from 100 on are nanometres, below 0.01 metres, and micrometres between; reflectances
/// above 1.5 are percent. Throws a `FileError` with path and line at the first error.
[[nodiscard]] SpectrumFile read_spectrum(const std::filesystem::path& path);

/// Reads a file, or all files of a folder; those without a spectrum are left out with a warning. A
/// spectrum is named as its file without the extension. @throws FileError without any spectrum
[[nodiscard]] SpectralLibrary read_spectral_library(const std::filesystem::path& path);

namespace detail {

/// Keys of a header, and words that stand before `reflect` in units or titles, in small letters. Source: ECOSTRESS
/// spectral library.
inline constexpr auto spectrum_rules = std::to_array<FormatRule>({
    {"x units:, y units:, units, titles", FormatUse::read, "units; titles are the last line above the numbers"},
    {"angstrom, frequency, thz, energy, band, channel, index, first column: y", FormatUse::refused,
     "wavelengths in nm, um or m, or wavenumbers in cm-1, in the first column"},
    {"transmi, absor, emiss, radian, refractive, scatter, log(", FormatUse::refused,
     "reflectance after the wavelength"},
    {"10000, mille", FormatUse::refused, "reflectance in fractions or percent"},
    {"*", FormatUse::read, "nothing: other lines of a header"},
});

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_SPECTRAL_LIBRARY)
#include <cmath>
#include <limits>

#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Unit of the first column.
enum class WavelengthUnit : std::uint8_t { metre, micrometre, nanometre, wavenumber };

/// True if a text contains a word that is not part of a longer one.
[[nodiscard]] inline bool has_word(std::string_view text, std::string_view word) {
  const auto is_letter = [&](std::size_t i) { return i < text.size() && text[i] >= 'a' && text[i] <= 'z'; };
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
    if (!is_letter(at - 1) && !is_letter(at + word.size())) return true;
  return false;
}

[[nodiscard]] inline std::optional<WavelengthUnit> wavelength_unit_in(std::string_view text) {
  const auto has = [&](std::string_view part) { return text.find(part) != text.npos; };
  if (has("wavenumber") || has("cm-1")) return WavelengthUnit::wavenumber;
  if (has("micromet") || has("micron")) return WavelengthUnit::micrometre;
  if (has("nanomet") || has_word(text, "nm")) return WavelengthUnit::nanometre;
  for (const std::string_view word : {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m"})  // micro signs
    if (has_word(text, word)) return WavelengthUnit::micrometre;
  return std::nullopt;
}

[[nodiscard]] inline std::optional<ReflectanceScale> reflectance_scale_in(std::string_view text) {
  const auto has = [&](std::string_view part) { return text.find(part) != text.npos; };
  if (has("percent") || has("%")) return ReflectanceScale::percent;
  return has("fraction") || has("0-1") ? std::optional(ReflectanceScale::fraction) : std::nullopt;
}

class SpectrumReader {
 public:
  explicit SpectrumReader(const std::filesystem::path& path) : table_(path, "a spectrum") {}

  [[nodiscard]] SpectrumFile read() {
    while (table_.next()) row();
    if (samples_.empty()) table_.fail("holds no row of two numbers: expected wavelength and reflectance, side by side");
    if (!unit_ || !scale_) titles();
    SpectrumFile file;
    const std::string wavelengths = take_wavelengths();
    file.report = warning(table_.path(), 0, wavelengths, "; ", take_reflectances(file.scale));
    std::ranges::stable_sort(samples_, {}, &Row::wavelength);
    file.spectrum = std::make_shared<const Spectrum>(united());
    file.warnings = std::move(table_.warnings);
    return file;
  }

 private:
  /// Row of the file.
  struct Row : SpectralSample {
    std::size_t line = 0;
  };

  /// Number, NaN where marked as missing; empty for anything else.
  static std::optional<double> cell(std::string_view word) {
    const std::optional<double> number = text::finite_number_in(word);
    const bool is_missing =
        number ? *number <= -1e30 : text::is_same_word(word, "nan") || text::is_same_word(word, "na");
    return is_missing ? std::numeric_limits<double>::quiet_NaN() : number;
  }

  void row() {
    static constexpr std::string_view separators = " \t,;";
    const std::string_view text = table_.text();
    std::string_view rest = text;
    const auto wavelength = text::finite_number_in(text::take_word(rest, separators));
    const std::optional<double> reflectance = cell(text::take_word(rest, separators));
    if (!wavelength || !reflectance) {
      if (begun_ && !text.starts_with('#') && !text.starts_with("//"))
        table_.refuse(text, "wavelength and reflectance, two numbers");
      if (!begun_) header(text);
      return;
    }
    begun_ = true;
    if (has_decimal_commas(text)) table_.refuse(text, "numbers with a decimal point");
    if (!(*wavelength >= 1e-12 && *wavelength <= 1e12)) table_.refuse(text, "a wavelength greater than 0");
    if (!std::isnan(*reflectance)) samples_.push_back({{*wavelength, *reflectance}, table_.line()});
  }

  /// True for a comma between digits where a semicolon or blanks separate numbers.
  [[nodiscard]] static bool has_decimal_commas(std::string_view text) {
    const auto is_digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
    bool commas = false, others = false;
    for (std::size_t i = 1; i < text.size(); ++i) {
      commas = commas || (text[i] == ',' && is_digit(i - 1) && is_digit(i + 1));
      others = others || text[i] == ';' || (text::is_blank(text[i]) && is_digit(i - 1) && is_digit(i + 1));
    }
    return commas && others;
  }

  void header(std::string_view text) {
    const std::string line = text::lower(text);
    titles_ = line;
    titles_line_ = table_.line();
    const auto is_key = [&](std::string_view key) { return line.starts_with(key); };
    if (is_key("x units:")) unit_ = wavelength_unit_in(line);
    if (is_key("x units:") || is_key("y units:") || is_key("units") || is_key("first column:"))
      require_reflectance(text, table_.line());
    if (!is_key("y units:")) return;
    scale_ = reflectance_scale_in(line);
    scale_line_ = table_.line();
    if (line.find("reflect") == line.npos) table_.refuse(text, "a spectrum of reflectance");
  }

  /// Refuses words of units and titles by the rules.
  void require_reflectance(std::string_view text, std::size_t number) const {
    const std::string line = text::lower(text);
    const std::size_t wanted = line.find("reflect");
    for (const FormatRule& rule : spectrum_rules)
      for (std::string_view names = rule.name; rule.use == FormatUse::refused && !names.empty();) {
        const std::size_t at = line.find(take_name(names));
        if (at < wanted || (rule.name.starts_with("10000") && at != line.npos))
          fail_at(table_.path(), number, text::quoted(text), ": expected ", rule.meaning);
      }
    if (wanted < line.find("wavelength") && line.find("wavelength") != line.npos)
      fail_at(table_.path(), number, text::quoted(text), ": expected ", rule_of(spectrum_rules, "index")->meaning);
  }

  /// Takes units from the line above the numbers if no key named them.
  void titles() {
    if (scale_line_ == 0) require_reflectance(titles_, titles_line_);
    if (!unit_) unit_ = wavelength_unit_in(titles_);
    if (scale_ || titles_.find("reflect") == titles_.npos) return;
    scale_ = reflectance_scale_in(titles_);
    scale_line_ = titles_line_;
  }

  std::string take_wavelengths() {
    const auto [low, high] = std::ranges::minmax_element(samples_, {}, &Row::wavelength);
    const double shortest = low->wavelength;
    const bool given = unit_.has_value();
    if (!given)
      unit_ = shortest >= 100   ? WavelengthUnit::nanometre
              : shortest < 0.01 ? WavelengthUnit::metre
                                : WavelengthUnit::micrometre;
    const std::string range = text::message(shortest, " to ", high->wavelength);
    static constexpr std::array<const char*, 4> names{"metres", "micrometres", "nanometres", "waves per centimetre"};
    static constexpr std::array<double, 4> metres{1, 1e-6, 1e-9, 0.01};
    const auto unit = static_cast<std::size_t>(*unit_);
    std::size_t odd = 0;  // line of the first odd wavelength
    for (Row& sample : samples_) {
      double& w = sample.wavelength;
      w = *unit_ == WavelengthUnit::wavenumber ? metres[unit] / w : w * metres[unit];
      if (odd == 0 && (w < 1e-7 || w > 1e-3)) odd = sample.line;
    }
    const char* const name = names[unit];
    if (odd > 0) table_.warn(odd, "its wavelengths, ", range, " ", name, ", are not all between 100 nm and 1 mm");
    return text::message("wavelengths in ", name, given ? ", by the header" : ", by the values " + range);
  }

  std::string take_reflectances(ReflectanceScale& scale) {
    const double largest = std::ranges::max_element(samples_, {}, &Row::reflectance)->reflectance;
    const std::string reach = text::message("its values reach ", largest);
    const bool many = largest > 1.5;
    const bool given = scale_.has_value() && !(*scale_ == ReflectanceScale::fraction && many);
    scale = given ? *scale_ : many ? ReflectanceScale::percent : ReflectanceScale::fraction;
    const bool percent = scale == ReflectanceScale::percent;
    if (scale_ && !given)
      table_.warn(scale_line_, "its header says fraction, but ", reach, ": they are taken as percent");
    if (percent && largest <= 1) table_.warn(scale_line_, "its header says percent, but ", reach, " only");
    Oddity clipped;
    for (Row& sample : samples_) {
      const double fraction = percent ? sample.reflectance / 100 : sample.reflectance;
      sample.reflectance = std::clamp(fraction, 0.0, 1.0);
      if (sample.reflectance != fraction) clipped.at(sample.line);
    }
    table_.warn(clipped, "a reflectance below 0 or above 1 is clipped");
    return text::message("reflectance in ", percent ? "percent" : "fractions",
                         given ? ", by the header" : ", as " + reach);
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
    table_.warn(repeated, "a wavelength is repeated", ": the mean is used");
    return all;
  }

  TextTable table_;
  std::vector<Row> samples_;
  std::optional<WavelengthUnit> unit_;
  std::optional<ReflectanceScale> scale_;
  std::string titles_;  // last line of the header, in small letters
  std::size_t titles_line_ = 0;
  std::size_t scale_line_ = 0;  // line of the header's scale
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
  if (library.spectra.empty()) detail::fail(path, "holds no spectrum: expected files of wavelength and reflectance");
  return library;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
