// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MTL_HPP
#define PULSECAST_IO_MTL_HPP

#include <functional>
#include <map>

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

#include <pulsecast/base/units.hpp>
#include <pulsecast/io/detail/obj/statements.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/water_types.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Statements of a material of an MTL file.
struct MtlMaterial {
  struct Statement {
    std::size_t line = 0;  ///< of the first with its key
    std::string text{};    ///< after the key, of the last
  };
  std::string name = "default";
  std::map<std::string, Statement, std::less<>> statements{};  ///< by key

  [[nodiscard]] std::string_view text(std::string_view key) const {
    const auto found = statements.find(key);
    return found == statements.end() ? "" : std::string_view(found->second.text);
  }
  [[nodiscard]] std::vector<std::string_view> words(std::string_view key) const { return words_of(text(key)); }
  /// Number of a statement, from 0; another one without it.
  [[nodiscard]] double number(std::string_view key, std::size_t i = 0, double otherwise = 0) const {
    const std::vector<std::string_view> all = words(key);
    return i < all.size() ? text::finite_number_in(all[i]).value_or(otherwise) : otherwise;
  }
  [[nodiscard]] double sum(std::string_view key) const { return number(key, 0) + number(key, 1) + number(key, 2); }
};

/// Expected words of an extra key, for a message; null if they are right, or the key is another.
[[nodiscard]] inline const char* expected_words(std::string_view key, const std::vector<std::string_view>& words) {
  const std::size_t count = words.size();
  const auto is = [&](std::string_view word) { return count > 0 && words[0] == word; };
  const auto are = [&](std::size_t first, std::size_t end, double low, double high) {  // numbers in a range
    for (std::size_t i = first; i < std::min(end, count); ++i) {
      const std::optional<double> number = text::finite_number_in(words[i]);
      if (!number || *number < low || *number > high) return false;
    }
    return true;
  };
  const auto need = [](bool right, const char* expected) { return right ? nullptr : expected; };
  if (key == "helios_reflectance")
    return need(count == 1 && are(0, 1, 0, 100), "a fraction from 0 to 1, or up to 100 percent");
  if (key == "helios_classification")
    return need(count == 1 && text::number_in<std::uint16_t>(words[0]), "a whole number from 0 to 65535");
  if (key == "pulsecast_normalizedPhong") return need(count == 1 && (is("true") || is("false")), "true or false");
  if (key == "pulsecast_interface")
    return need((is("mirror") && count == 2 && are(1, 2, 0, 1)) || (is("pane") && count == 2 && are(1, 2, 0, 10)) ||
                    ((is("glass") || is("water") || is("none")) && count == 1),
                "mirror and its reflectance from 0 to 1, pane and its thickness from 0 to 10 m, glass, water or none");
  if (key == "pulsecast_medium")
    return need(count >= 1 && count <= 5 && are(0, 2, 1, 4) && are(2, 5, 0, 1e6),
                "an index from 1 to 4, and then, as far as given, a group index from 1 to 4, absorption, scattering "
                "and backscatter from 0");
  if (key == "pulsecast_water")
    return need((count == 1 && jerlov_type(words[0])) || (is("secchi") && count == 2 && are(1, 2, 0.1, 80)),
                "a type of Jerlov's, I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C, or secchi and a depth from 0.1 to 80 m");
  if (key == "pulsecast_roughness")
    return need(count == 1 && are(0, 1, 1e-3, 2), "a root mean square slope from 0.001 to 2");
  if (key == "pulsecast_retroreflection")
    return need(count >= 1 && count <= 2 && are(0, 1, 0, 1e6) && are(1, 2, 1, 85),
                "a coefficient from 0 to 1e6 cd/(lx m^2), and the angle of half of it from 1 to 85 degrees");
  if (key == "pulsecast_retroreflector")
    return need(((is("beads") || is("cubeCorner")) && count <= 2 && are(1, 2, 0, 0.1)) ||
                    (is("prisms") && count >= 2 && count <= 3 && are(1, 2, 1, 4) && are(2, 3, 0, 0.1)),
                "beads, cubeCorner, or prisms and their index from 1 to 4, and then, if given, the half width of "
                "the light from 0 to 0.1 rad");
  return nullptr;
}

/// Sets specular light by the standard keys: `illum` 3, 5 and 8, and `Pm`, are mirrors; 4, 6, 7 and
/// 9 glass of the index `Ni`. False for an index out of range: that of glass is set. Source: MTL
/// specification, Wavefront 1995; `Pm`: the common extension for physically based shading.
[[nodiscard]] inline bool set_standard_light(Material& made, const MtlMaterial& m) {
  const double rest = 1 - std::min(made.reflectance, 1.0), specular = m.sum("Ks") / 3, metallic = m.number("Pm"),
               illum = std::trunc(m.number("illum")), index = m.number("Ni", 0, 1);
  if (metallic > 0)
    made.smooth = SmoothInterface::mirror(std::min(metallic, rest));
  else if (illum == 3 || illum == 5 || illum == 8)
    made.smooth = SmoothInterface::mirror(std::min(specular > 0 ? specular : 1.0, rest));
  else if (illum == 4 || illum == 6 || illum == 7 || illum == 9) {
    made.smooth = SmoothInterface::glass();
    if (index < 1 || index > 4) return false;
    if (index > 1) made.smooth.inside = {.index = index};
  }
  return true;
}

/// Sets specular light by the keys of this library, but for water.
inline void set_own_light(Material& made, const MtlMaterial& m) {
  const auto number = [](std::string_view word) { return *text::number_in<double>(word); };
  if (const auto words = m.words("pulsecast_interface"); !words.empty()) {
    if (words[0] == "mirror") made.smooth = SmoothInterface::mirror(number(words[1]));
    if (words[0] == "pane") made.smooth = SmoothInterface::pane(number(words[1]));
    if (words[0] == "glass") made.smooth = SmoothInterface::glass();
    if (words[0] == "water") made.smooth = SmoothInterface::water();
    if (words[0] == "none") made.smooth = {};
    const double index = m.number("Ni", 0, 1);
    if (index > 1 && index <= 4 && made.smooth.inside.index > 1) made.smooth.inside = {.index = index};
  }
  if (const auto words = m.words("pulsecast_medium"); !words.empty()) {
    Medium& inside = made.smooth.inside = {.index = number(words[0])};
    double* const members[] = {&inside.group_index, &inside.absorption, &inside.scattering, &inside.backscatter};
    for (std::size_t i = 1; i < words.size(); ++i) *members[i - 1] = number(words[i]);
  }
  const double transmission = m.sum("Tf") / 3;
  if (made.smooth.kind == InterfaceKind::pane && made.smooth.thickness > 0 && transmission > 0 && transmission < 1)
    made.smooth.inside.absorption = -std::log(transmission) / made.smooth.thickness;
  if (const auto words = m.words("pulsecast_retroreflection"); !words.empty()) {
    const double coefficient = number(words[0]);
    const auto of = m.words("pulsecast_retroreflector");
    const std::string_view kind = of.empty() ? "beads" : of[0];
    const std::size_t width = kind == "prisms" ? 2 : 1;
    const double half_angle = of.size() > width ? number(of[width]) : 0;
    const Beads beads = words.size() > 1 ? Beads{radians(number(words[1]))} : Beads{};
    if (kind == "beads")
      made.law = Retroreflector<Beads>{coefficient, half_angle, beads};
    else
      made.law = Retroreflector<CubeCorners>{coefficient, half_angle, {kind == "prisms" ? number(of[1]) : 1}};
  }
  if (const auto words = m.words("pulsecast_roughness"); !words.empty()) made.law = Microfacet{number(words[0])};
}

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
    MtlMaterial::Statement& statement =
        found_.back().statements.try_emplace(key, MtlMaterial::Statement{line()}).first->second;
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
