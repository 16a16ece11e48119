// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MTL_HPP
#define PULSECAST_IO_MTL_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/normalized_phong.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Content of MTL files.
struct MaterialLibrary {
  std::map<std::string, Material, std::less<>> materials;           ///< materials by name
  std::map<std::string, MaterialPictures, std::less<>> pictures{};  ///< for `add_pictures`
  std::vector<std::string> warnings;                                ///< oddities that could still be read
};

/// Reads an MTL file. Colours select the law: `Ks` Phong's, with `Ns`, `Kd` alone Lambert's. Reflectance is
/// `helios_reflectance`, a fraction, or the spectrum named by `helios_spectra`. Others in use are `helios_isGround`,
/// `helios_classification`, `illum`, `Ni`, `Tf`, `Pm` and those of this library, see docs/survey-scenes.md; pictures are
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
#include <deque>
#include <istream>

#include <tiny_obj_loader.h>

#include <pulsecast/io/detail/obj/mtl_light.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

class MtlReader : private StatementBuffer {
 public:
  MtlReader(InputFile file, const SpectralLibrary& spectra)
      : StatementBuffer(file.path(), file.take_rest(), 0), spectra_(spectra) {}

  [[nodiscard]] MaterialLibrary read() {
    std::istream stream(this);
    stream.exceptions(std::ios::badbit);  // passes on exceptions thrown while reading
    std::map<std::string, int> ignored_numbers;
    std::vector<tinyobj::material_t> found;
    tinyobj::LoadMtl(&ignored_numbers, &found, &stream, nullptr, nullptr);
    MaterialLibrary library;
    library.warnings = std::move(warnings_);
    notes_.tell(path(), library.warnings);
    for (const tinyobj::material_t& m : found)
      if (!m.name.empty()) library.materials.emplace(m.name, material(m, library.warnings));
    library.pictures = std::move(pictures_);
    return library;
  }

 private:
  void check(std::string& ready) override {
    // tinyobjloader drops keys before the first name, and its default exponent is 1
    static const std::string exponent = "\nNs " + text::to_text(Phong{}.exponent) + "\n";
    const bool is_first = !std::exchange(begun_, true);
    const bool is_name = keyword() == "newmtl";
    if (is_name) current_ = rest();
    if (is_name) repeated_ = lines_.contains({current_, "newmtl"});
    note_picture();
    lines_.try_emplace({current_, std::string(keyword())}, line());
    if (is_name) {
      require(!rest().empty(), "the name of a material");
      ready = statement() + exponent;
      return;
    }
    const std::vector<std::string_view>& given = words();
    if (const char* const expected = expected_words(keyword(), given)) require(false, expected);
    if (is_first) ready = "newmtl default" + exponent;
    const double share =
        number_in<double>(given.empty() ? "" : given[0]).value_or(std::numeric_limits<double>::quiet_NaN());
    const bool is_clear = (keyword() == "d" && share != 1.0) || (keyword() == "Tr" && share != 0.0);
    notes_.keep(!is_clear ? keyword() : keyword() == "d" ? "d below 1" : "Tr above 0", path(), line(), statement());
    const bool is_light = rule_of(mtl_rules, keyword()) == rule_of(mtl_rules, "illum");
    const bool is_colour = keyword() == "Kd" || keyword() == "Ks";
    const auto is_beyond = [&](std::string_view word) {
      return number_in<double>(word).value_or(0) > 1 || (!is_colour && word.starts_with('-'));
    };
    if ((is_colour || keyword() == "Tf" || keyword() == "Pm") && std::ranges::any_of(given, is_beyond))
      note("has a number beyond 0 to 1: as a colour or a share of light, the nearest of these is taken");
    if (is_colour)
      ready += standard_numbers(given, 3);
    else if (keyword() == "Ns")
      ready += standard_numbers(given, 1);
    // with textures, tinyobjloader would change the colour, depending on the order
    else if (is_light && !(share <= (keyword() == "illum" ? 10 : std::numeric_limits<double>::infinity())))
      note("is ignored: expected numbers, of illum from 0 to 10");
    else if (is_light || keyword().starts_with("helios_") || keyword().starts_with("pulsecast_"))
      ready += statement();
  }

  /// Statement of a standard key with `count` numbers, limited to 0 to 1e12, or one for all; empty
  /// for other words. Source: MTL specification, Wavefront 1995.
  [[nodiscard]] std::string standard_numbers(const std::vector<std::string_view>& given, std::size_t count) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < std::min(given.size(), count); ++i) {
      const auto number = number_in<double>(given[i]);
      if (!number) break;
      numbers.push_back(std::clamp(*number, 0.0, max_number));
      if (numbers.back() != *number) note("takes ", numbers.back(), " for ", given[i]);
    }
    const bool is_comment = given.size() > 1 && given[1].starts_with('/');
    if (numbers.size() != count && !(numbers.size() == 1 && (given.size() == 1 || is_comment))) {
      note("is ignored: expected ", count == 1 ? "a number" : "one or three numbers");
      return {};
    }
    if (given.size() > numbers.size()) note("has words after its numbers, which are ignored");
    std::string made(keyword());
    for (std::size_t i = 0; i < count; ++i) made += ' ' + text::to_text(numbers[std::min(i, numbers.size() - 1)]);
    return made;
  }

  void note(const auto&... oddity) {
    warnings_.push_back(warning(path(), line(), "material '", current_, "': ", quoted(), " ", oddity...));
  }

  /// Notes the picture that a statement names, for the first material of a name.
  void note_picture() {
    static constexpr std::array<std::string_view, 3> keys{"map_Kd", "map_d", "pulsecast_reflectanceMap"};
    const auto key = static_cast<std::size_t>(std::find(keys.begin(), keys.end(), keyword()) - keys.begin());
    if (key == keys.size() || repeated_) return;
    const bool reflectance = key == 2;
    std::string_view named = rest();
    const bool is_pattern = reflectance && named.starts_with("pattern ");
    if (is_pattern) named = text::trimmed(named.substr(8));
    if (named.starts_with('-')) note("has options, which have no effect");
    std::string name;
    tinyobj::texture_option_t unused;
    tinyobj::ParseTextureNameAndOption(&name, &unused, std::string(named).c_str());
    if (reflectance) require(!name.empty(), "the name of a picture");
    if (name.empty()) return note("names no picture");
    std::replace(name.begin(), name.end(), '\\', '/');
    MaterialPictures& all = pictures_[current_];
    all.reflectance_pattern |= is_pattern;
    PictureSource* const sources[] = {&all.colour, &all.opacity, &all.reflectance};
    sources[key]->file = std::filesystem::path(path()).parent_path() / name;
  }

  [[nodiscard]] Material material(const tinyobj::material_t& m, std::vector<std::string>& warnings) const {
    const auto warn = [&](const char* key, const auto&... oddity) {
      const auto known = lines_.find({m.name, key});
      const std::size_t place = known == lines_.end() ? 0 : known->second;
      warnings.push_back(warning(path(), place, "material '", m.name, "' ", oddity...));
    };
    const auto extra = [&](const char* key) {
      const auto found = m.unknown_parameter.find(key);
      return found == m.unknown_parameter.end() ? std::string() : found->second;
    };
    Material made = undescribed(m.name);
    const double diffuse = m.diffuse[0] + m.diffuse[1] + m.diffuse[2],
                 specular = m.specular[0] + m.specular[1] + m.specular[2];
    const double share = specular / (diffuse + specular);
    if (specular > 0 && text::trimmed(extra("pulsecast_normalizedPhong")) == "true")
      made.law = NormalizedPhong{share, m.shininess};
    else if (specular > 0)
      made.law = Phong{share, m.shininess};
    else if (diffuse > 0)
      made.law = Lambert{};
    for (int k = 0; diffuse > 0 && k < 3; ++k) made.colour[k] = std::min(m.diffuse[k], 1.0);
    const std::string reflectance = extra("helios_reflectance"), spectrum(text::trimmed(extra("helios_spectra")));
    if (!reflectance.empty()) {
      made.reflectance = *number_in<double>(reflectance);
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
    set_light(made, m, extra, warn);
    made.classification = number_in<std::uint16_t>(extra("helios_classification")).value_or(made.classification);
    const std::string ground = text::lower(extra("helios_isGround"));
    made.ground = ground == "true" || ground == "1";
    if (!made.ground && !ground.empty() && ground != "false" && ground != "0")
      warn("helios_isGround", "has helios_isGround '", ground, "', expected true or false: false is assumed");
    return made;
  }

  void set_light(Material& made, const tinyobj::material_t& m, const auto& extra, const auto& warn) const {
    set_standard_light(made, m);
    std::deque<std::string> texts;
    const auto words_of = [&](const char* key) {
      texts.push_back(extra(key));
      std::vector<std::string_view> words;
      for (std::string_view left = text::trimmed(texts.back()); !left.empty();) words.push_back(text::take_word(left));
      return words;
    };
    if (const auto words = words_of("pulsecast_water"); !words.empty())
      made.smooth = water_for_lasers(m.name, words, warn);
    set_own_light(made, m, words_of);
    const bool has_index = !extra("pulsecast_medium").empty() || !extra("pulsecast_water").empty();
    if (made.smooth.inside.index > 1 && !has_index && (m.ior < 1 || m.ior > 4))
      warn("Ni", "has the index Ni of a clear body out of range: expected from 1 to 4; ", made.smooth.inside.index,
           " is assumed");
  }

  /// Water for the wavelength of all lasers; clear, with a warning, if there is none.
  [[nodiscard]] SmoothInterface water_for_lasers(const std::string& name, const auto& words, const auto& warn) const {
    constexpr const char* key = "pulsecast_water";
    const std::vector<double>& all = spectra_.wavelengths;
    if (all.empty()) {
      warn(key, "has water by a type, and no wavelength of a laser is known: it is taken as clear");
      return SmoothInterface::water();
    }
    if (std::ranges::any_of(all, [&](double wavelength) { return wavelength != all.front(); }))
      fail_at(path(), lines_.at({name, key}),
              "water by a type, for lasers of several wavelengths: expected one; pulsecast_medium has the "
              "coefficients");
    try {
      if (const auto type = jerlov_type(words[0])) return SmoothInterface::water(water(*type, all.front()));
      return SmoothInterface::water(secchi_water(*number_in<double>(words[1]), all.front()));
    } catch (const SettingError& refused) {
      fail_at(path(), lines_.at({name, key}), refused.what());
    }
  }

  [[nodiscard]] static std::string nanometres(double metres) { return text::to_text(std::round(metres * 1e12) / 1e3); }

  const SpectralLibrary& spectra_;
  std::vector<std::string> warnings_;
  StatementNotes notes_{mtl_rules};
  bool begun_ = false, repeated_ = false;                             // after a statement; for a name again
  std::string current_ = "default";                                   // name of the current material
  std::map<std::pair<std::string, std::string>, std::size_t> lines_;  // by material and keyword
  std::map<std::string, MaterialPictures, std::less<>> pictures_;     // by material
};

}  // namespace detail

PULSECAST_INLINE MaterialLibrary read_mtl(const std::filesystem::path& path, const SpectralLibrary& spectra) {
  return reading(path, [&] { return detail::MtlReader({path, "an OBJ or MTL file"}, spectra).read(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
