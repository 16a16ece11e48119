// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MTL_HPP
#define PULSECAST_IO_MTL_HPP

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/normalized_phong.hpp>
#include <pulsecast/material/phong.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Content of MTL files.
struct MaterialLibrary {
  std::map<std::string, Material, std::less<>> materials;           ///< materials by name
  std::map<std::string, MaterialPictures, std::less<>> pictures{};  ///< for `add_pictures`
  std::vector<std::string> warnings;                                ///< oddities that could still be read
};

/// Reads an MTL file. Colours select the law: `Ks` Phong's, with `Ns`, `Kd` alone Lambert's. Reflectance is
/// `helios_reflectance`, a fraction, or the spectrum named by `helios_spectra`. Others in use are `helios_isGround`,
/// `helios_classification`, `illum`, `Ni`, `Tf`, `Pm` and those of this library, see docs/surveys.md; pictures are
/// `map_Kd` (colour of points), `map_d` (outline) and `pulsecast_reflectanceMap`, without options. Of equal names, the
/// first counts; keys before any are of "default". Throws a `FileError` with path and line at the first error.
[[nodiscard]] MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra = {});

/// Surface without a description: it scatters equally in all directions, as in HELIOS++.
[[nodiscard]] inline Material undescribed(std::string name) {
  return {.name = std::move(name), .law = DirectionIndependent{}};
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_MTL)
#include <algorithm>
#include <array>
#include <cmath>

#include <pulsecast/io/detail/obj/mtl_light.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

class MtlReader : private Statements {
 public:
  MtlReader(InputFile file, const SpectralLibrary& spectra)
      : Statements(file.path(), file.take_rest(), 0), spectra_(spectra) {}

  [[nodiscard]] MaterialLibrary read() {
    while (next_statement()) take();
    MaterialLibrary library{.materials = {}, .pictures = std::move(pictures_), .warnings = std::move(warnings_)};
    for (const MtlMaterial& one : found_) library.materials.emplace(one.name, material(one, library.warnings));
    return library;
  }

 private:
  void take() {
    const std::string key(keyword());
    if (key == "newmtl") {
      require(!rest().empty(), "the name of a material");
      repeated_ = std::ranges::find(found_, rest(), &MtlMaterial::name) != found_.end();
      found_.push_back({.name = std::string(rest())});
      return;
    }
    if (found_.empty()) found_.emplace_back();  // "default"
    take_picture();
    const std::vector<std::string_view>& given = words();
    if (const char* const expected = expected_words(key, given)) require(false, expected);
    MtlMaterial::Statement& statement = found_.back().statements.try_emplace(key, line()).first->second;
    const bool is_standard = key == "Kd" || key == "Ks" || key == "Ns";
    const bool is_light = key == "illum" || key == "Ni" || key == "Tf" || key == "Pm";
    if (is_standard)
      take_numbers(given, key == "Ns" ? 1 : 3, statement.text);
    else if (!is_light || (!given.empty() && text::finite_number_in(given[0])))
      statement.text = rest();
  }

  /// Takes `count` numbers of a standard key, limited to 0 to 1e12, or one for all; ignores other words. Source: MTL
  /// specification, Wavefront 1995.
  void take_numbers(const std::vector<std::string_view>& given, std::size_t count, std::string& to) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < std::min(given.size(), count); ++i) {
      const auto number = text::finite_number_in(given[i]);
      if (!number) break;
      numbers.push_back(std::clamp(*number, 0.0, max_number));
      if (numbers.back() != *number) note("takes ", numbers.back(), " for ", given[i]);
    }
    const bool is_comment = given.size() > 1 && given[1].starts_with('/');
    if (numbers.size() != count && !(numbers.size() == 1 && (given.size() == 1 || is_comment)))
      return note("is ignored: expected ", count == 1 ? "a number" : "one or three numbers");
    if (given.size() > numbers.size()) note("has words after its numbers, which are ignored");
    to.clear();
    for (std::size_t i = 0; i < count; ++i) to += text::to_text(numbers[std::min(i, numbers.size() - 1)]) + ' ';
  }

  void note(const auto&... oddity) {
    warnings_.push_back(warning(path(), line(), "material '", found_.back().name, "': ", quoted(), " ", oddity...));
  }

  /// Takes the picture that a statement names, for the first material of a name.
  void take_picture() {
    static constexpr std::array<std::string_view, 3> keys{"map_Kd", "map_d", "pulsecast_reflectanceMap"};
    const auto key = static_cast<std::size_t>(std::ranges::find(keys, keyword()) - keys.begin());
    if (key == keys.size() || repeated_) return;
    const bool reflectance = key == 2;
    std::string_view named = rest();
    const bool is_pattern = reflectance && named.starts_with("pattern ");
    if (is_pattern) (void)text::take_word(named);
    if (named.starts_with('-')) note("has options, which have no effect");
    while (named.starts_with('-')) {
      const std::string_view option = text::take_word(named);
      const bool has_numbers = option == "-o" || option == "-s" || option == "-t" || option == "-mm";
      const auto is_number = [](std::string_view left) { return text::finite_number_in(text::take_word(left)); };
      for (int i = 0; i < (has_numbers ? 3 : 1) && (!has_numbers || is_number(named)); ++i)
        (void)text::take_word(named);
    }
    if (reflectance) require(!named.empty(), "the name of a picture");
    if (named.empty()) return note("names no picture");
    std::string name(named);
    std::ranges::replace(name, '\\', '/');
    MaterialPictures& all = pictures_[found_.back().name];
    all.reflectance_pattern |= is_pattern;
    PictureSource* const sources[] = {&all.colour, &all.opacity, &all.reflectance};
    sources[key]->file = std::filesystem::path(path()).parent_path() / name;
  }

  [[nodiscard]] Material material(const MtlMaterial& m, std::vector<std::string>& warnings) const {
    const auto warn = [&](const char* key, const auto&... oddity) {
      const auto known = m.statements.find(key);
      const std::size_t place = known == m.statements.end() ? 0 : known->second.line;
      warnings.push_back(warning(path(), place, "material '", m.name, "' ", oddity...));
    };
    Material made = undescribed(m.name);
    const double diffuse = m.sum("Kd"), specular = m.sum("Ks"), share = specular / (diffuse + specular);
    const double exponent = m.number("Ns", 0, Phong{}.exponent);
    if (specular > 0 && m.text("pulsecast_normalizedPhong") == "true")
      made.law = NormalizedPhong{share, exponent};
    else if (specular > 0)
      made.law = Phong{share, exponent};
    else if (diffuse > 0)
      made.law = Lambert{};
    for (std::size_t k = 0; diffuse > 0 && k < 3; ++k)
      made.colour[static_cast<int>(k)] = std::min(m.number("Kd", k), 1.0);
    const std::string_view reflectance = m.text("helios_reflectance"), spectrum = m.text("helios_spectra");
    if (!reflectance.empty()) {
      made.reflectance = m.number("helios_reflectance");
      if (made.reflectance > 1) {
        warn("helios_reflectance", "has the reflectance ", reflectance, ", which is taken as percent");
        made.reflectance /= 100;
      }
    } else if (const auto found = spectra_.spectra.find(spectrum); found != spectra_.spectra.end()) {
      made.spectrum = found->second;
      const double shortest = made.spectrum->shortest(), longest = made.spectrum->longest();
      for (const double wavelength : spectra_.wavelengths)
        if (!(wavelength >= shortest && wavelength <= longest))
          warn("helios_spectra", "has the spectrum '", spectrum, "', which spans ", nanometres(shortest), " to ",
               nanometres(longest), " nm: for the laser of ", nanometres(wavelength), " nm the nearest sample is used");
    } else if (!spectrum.empty()) {
      warn("helios_spectra", "refers to the spectrum '", spectrum,
           "', which is in no library: a reflectance of 0.5 is assumed");
    }
    if (!set_standard_light(made, m))
      warn("Ni", "has the index Ni of a clear body out of range: expected from 1 to 4; glass is assumed");
    if (!m.text("pulsecast_water").empty()) made.smooth = water_for_lasers(m, warn);
    set_own_light(made, m);
    made.classification = text::number_in<std::uint16_t>(m.text("helios_classification")).value_or(made.classification);
    const std::string ground = text::lower(m.text("helios_isGround"));
    made.ground = ground == "true" || ground == "1";
    if (!made.ground && !ground.empty() && ground != "false" && ground != "0")
      warn("helios_isGround", "has helios_isGround '", ground, "', expected true or false: false is assumed");
    return made;
  }

  /// Water for the wavelength of all lasers; clear, with a warning, if there is none.
  [[nodiscard]] SmoothInterface water_for_lasers(const MtlMaterial& m, const auto& warn) const {
    constexpr const char* key = "pulsecast_water";
    const std::vector<double>& all = spectra_.wavelengths;
    if (all.empty()) {
      warn(key, "has water by a type, and no wavelength of a laser is known: it is taken as clear");
      return SmoothInterface::water();
    }
    const std::vector<std::string_view> words = m.words(key);
    const std::size_t line = m.statements.at(key).line;
    if (std::ranges::any_of(all, [&](double wavelength) { return wavelength != all.front(); }))
      fail_at(path(), line,
              "water by a type, for lasers of several wavelengths: expected one; pulsecast_medium has the "
              "coefficients");
    try {
      if (const auto type = jerlov_type(words[0])) return SmoothInterface::water(water(*type, all.front()));
      return SmoothInterface::water(secchi_water(m.number(key, 1), all.front()));
    } catch (const SettingError& refused) {
      fail_at(path(), line, refused.what());
    }
  }

  [[nodiscard]] static std::string nanometres(double metres) { return text::to_text(std::round(metres * 1e12) / 1e3); }

  const SpectralLibrary& spectra_;
  std::vector<std::string> warnings_;
  std::vector<MtlMaterial> found_;                                 // materials, the last is the current one
  bool repeated_ = false;                                          // true if that has a name again
  std::map<std::string, MaterialPictures, std::less<>> pictures_;  // by material
};

}  // namespace detail

PULSECAST_INLINE MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra) {
  return reading(path, [&] { return detail::MtlReader({path, "an OBJ or MTL file"}, spectra).read(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
