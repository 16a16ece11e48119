// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_REFERENCE_READER_HPP
#define PULSECAST_IO_DETAIL_REFERENCE_READER_HPP

#include <cctype>

#include <pulsecast/io/format_rules.hpp>
#include <pulsecast/io/spatial_reference.hpp>

/// Reference systems in rasters, in files beside them, and in LAS files.
namespace PULSECAST_NAMESPACE::io::detail {

/// Items of reference systems. Source: OGC GeoTIFF 1.1, annex B; OGC 01-009 and 18-010 (WKT).
inline constexpr FormatRule reference_rules[]{
    {"WKT PROJ*", FormatUse::read, "projected: its unit is that of x and y"},
    {"WKT LOCAL_CS, WKT ENG*", FormatUse::read, "its unit is that of x and y"},
    {"WKT VERT*", FormatUse::read, "its unit is that of heights"},
    {"WKT GEO*, GeoKey 1024 = 2, GeoKey 1024 = 3", FormatUse::refused,
     "projected coordinates, not degrees or geocentric ones: gdalwarp -t_srs EPSG:CODE, or pdal translate with "
     "filters.reprojection"},
    {"GeoKey 1024 = 1", FormatUse::read, "GTModelType: projected coordinates"},
    {"GeoKey 1024 = *", FormatUse::noted, "a projected system is assumed"},
    {"GeoKey 1025", FormatUse::read, "GTRasterType: pixels are areas or points"},
    {"GeoKey 1026, GeoKey 4097", FormatUse::read, "citations: units, as `(ftUS)`, or well-known text of Esri"},
    {"GeoKey 3072, GeoKey 4096", FormatUse::read, "EPSG codes"},
    {"GeoKey 3076, GeoKey 3077, GeoKey 4099", FormatUse::read, "units: coordinates and heights become metres"},
    {"GeoKey 20*, GeoKey 30*, GeoKey 4098", FormatUse::read, "datum and projection; coordinates stay in them"},
    {"GeoKey 5120", FormatUse::noted, "CoordinateEpoch: coordinates stay in it"},
    {"unit of *", FormatUse::refused, "a known unit: gdal_edit.py -a_srs EPSG:CODE, or pdal's --a_srs, names one"},
    {"depths", FormatUse::refused, "heights, not depths; with a vertical scale as a setting its numbers are heights"},
    {"axis to the west", FormatUse::noted, "x is taken as east, and y as north"},
    {"coordinates without a unit, no well-known text", FormatUse::noted, "metres are assumed"},
    {"heights without a unit", FormatUse::noted, "those of rasters are taken as metres, z of points in the unit of x"},
    {"text that is cut off", FormatUse::refused, "a complete well-known text"},
};

/// Unit by EPSG code, and names between bars. Source: EPSG 10.076; GDALRasterBand::GetUnitType.
struct LengthUnit {
  std::uint16_t code = 9001;
  double metres = 1;
  std::string_view names = "|m|metre|metres|meter|meters|";
};
inline constexpr double foot = 0.3048, us_foot = 1200.0 / 3937.0;
inline constexpr std::array<LengthUnit, 8> length_units{{
    {},
    {1025, 0.001, "|mm|millimetre|"},
    {1033, 0.01, "|cm|centimetre|"},
    {9036, 1000, "|km|kilometre|"},
    {9096, 0.9144, "|yd|yard|"},
    {9002, foot, "|ft|foot|feet|international foot|"},
    {9003, us_foot, "|us survey foot|us_survey_foot|foot_us|us-ft|ftus|sft|sfoot|"},
    {9095, 0.3048007491, "|british foot (1936)|"},
}};

/// Systems in metres, horizontal, vertical or compound, from one code to another: a part of all, which spares a note.
/// Source: EPSG registry 10.076; GeoTIFF 1.0, 6.3.4, whose vertical codes from 5001 on tell no unit.
inline constexpr std::array<std::uint16_t, 60> systems_in_metres{
    2000, 2065,  2067,  2135,  2137,  2154,  2161,  2193,  2315,  2866,  2931,  2963,  2995,  3079,  3103,
    3138, 3168,  3358,  3761,  3989,  4458,  4999,  5107,  5331,  5337,  5469,  5479,  5583,  5659,  5701,
    5703, 5705,  5707,  5714,  5716,  5733,  5755,  5788,  5874,  6125,  7374,  7405,  7408,  7586,  7651,
    7968, 20135, 22293, 24600, 26722, 26891, 27260, 27391, 29333, 30339, 32000, 32180, 32663, 32700, 32760};

[[nodiscard]] constexpr bool is_between(const auto& ranges, std::uint16_t code) noexcept {
  const auto end = std::ranges::upper_bound(ranges, code);
  return (end - ranges.begin()) % 2 == 1 || (end != ranges.begin() && *std::prev(end) == code);
}

/// Vertical systems of depths. Source: EPSG registry 10.076.
inline constexpr std::array<std::uint16_t, 29> systems_of_depths{
    5336, 5612, 5614, 5706, 5715, 5734, 5739, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866,
    5867, 5873, 6357, 6358, 6359, 7976, 8051, 8053, 8358, 8378, 8897, 9287, 9288, 9672};

/// Systems with an axis to the west, and mostly one to the south, from one code to another. Source: EPSG
/// registry 10.076.
inline constexpr std::array<std::uint16_t, 34> systems_to_the_west{
    2046, 2055, 2065, 2065, 2218, 2218, 2221, 2221, 2296, 2307, 2963, 2963, 3052, 3053,  3144,  3145,  3173,
    3173, 5017, 5017, 5224, 5224, 5513, 5513, 5515, 5515, 8044, 8045, 8352, 8352, 22275, 22293, 29371, 29385};

/// GeoTIFF keys, with the records or tags that they refer to. Source: OGC GeoTIFF 1.1, 7.1.2.
struct GeoKeys {
  static constexpr std::uint16_t in_numbers = 34736, in_texts = 34737, user_defined = 32767;
  std::span<const std::uint16_t> directory;  ///< 34735
  std::span<const double> numbers;           ///< 34736
  std::string_view texts;                    ///< 34737

  /// Calls `take(key, place, value)` for each key; place 0 is that of the key itself.
  void each(const auto& take) const {
    for (std::size_t i = 4; i + 4 <= directory.size() && i / 4 <= directory[3]; i += 4)
      take(directory[i], directory[i + 1], directory[i + 3]);
  }

  /// Value of a key, or its index into another record.
  [[nodiscard]] std::optional<std::uint16_t> value(std::uint16_t wanted, std::uint16_t at = 0) const {
    std::optional<std::uint16_t> found;
    each([&](std::uint16_t key, std::uint16_t place, std::uint16_t value) {
      if (key == wanted && place == at && !found) found = value;
    });
    return found;
  }
  [[nodiscard]] std::uint16_t code(std::uint16_t key) const { return value(key).value_or(0); }
  [[nodiscard]] double number(std::uint16_t key) const {
    const auto at = value(key, in_numbers);
    return at && *at < numbers.size() ? numbers[*at] : 0;
  }
  [[nodiscard]] std::string_view text(std::uint16_t key) const {
    const std::string_view from =
        texts.substr(std::min<std::size_t>(value(key, in_texts).value_or(65535), texts.size()));
    return from.substr(0, from.find('|'));
  }
};

/// Text without blanks and line ends around it.
[[nodiscard]] constexpr std::string_view without_margins(std::string_view text) noexcept {
  constexpr std::string_view margin = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(margin), text.size()));
  return text.substr(0, text.find_last_not_of(margin) + 1);
}

/// Node of well-known text: `KEYWORD["name",values and nodes]`. Source: OGC 01-009, 7; OGC 18-010.
struct WktNode {
  std::string keyword;       ///< in capitals
  std::string_view content;  ///< between the brackets

  [[nodiscard]] std::string_view after_name() const {
    const std::size_t comma = content.find(',', content.find('"', content.find('"') + 1));
    return comma == content.npos ? "" : without_margins(content.substr(comma + 1));
  }
};

/// Takes the next complete node from a text; nothing at its end.
[[nodiscard]] inline std::optional<WktNode> take_node(std::string_view& text) {
  std::size_t begin = 0, open = 0, depth = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (c == ',' && depth == 0) begin = i + 1;
    if (c == '[' && depth++ == 0) open = i;
    if (c != ']' || depth == 0 || --depth > 0) continue;
    WktNode node{std::string(without_margins(text.substr(begin, open - begin))), text.substr(open + 1, i - open - 1)};
    for (char& letter : node.keyword) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    text.remove_prefix(i + 1);
    return node;
  }
  return std::nullopt;
}

/// Unit of heights without one of their own.
enum class HeightUnit : std::uint8_t { metre, of_coordinates, by_setting };

/// Reader of one reference system.
class ReferenceReader {
 public:
  ReferenceReader(std::filesystem::path path, HeightUnit otherwise, std::vector<std::string>& warnings)
      : path_(std::move(path)), otherwise_(otherwise), warnings_(warnings) {}

  /// Reference system by well-known text. @throws FileError by the rules
  [[nodiscard]] SpatialReference by_text(std::string_view text) && {
    text = without_margins(text::without_byte_order_mark(text));
    if (read(text)) made_.wkt = text;
    return finished();
  }

  /// Reference system by keys. @throws FileError by the rules
  [[nodiscard]] SpatialReference by_keys(const GeoKeys& keys) && {
    keys.each([&](std::uint16_t key, auto...) {
      if (key != 0 && key != 1024 && key <= GeoKeys::user_defined) keep(text::message("GeoKey ", key));
    });
    const std::uint16_t projected = keys.code(3072), vertical = keys.code(4096), model = keys.code(1024);
    const bool is_globe = model == 0 && projected == 0 && keys.code(2048) != 0;
    if (model != 0 || is_globe) keep(text::message("GeoKey 1024 = ", is_globe ? 2 : model));
    const std::string_view esri = "ESRI PE String = ";
    if (const std::size_t at = keys.texts.find(esri); at != keys.texts.npos) {
      const std::string_view text = keys.texts.substr(at + esri.size());
      made_.wkt = text.substr(0, text.find('|'));
      (void)read(made_.wkt);
    }
    made_.epsg = projected == GeoKeys::user_defined ? std::uint16_t{0} : projected;
    made_.vertical_epsg = vertical == GeoKeys::user_defined ? std::uint16_t{0} : vertical;
    has_heights_ = vertical != 0;
    is_west_ |= is_between(systems_to_the_west, projected) || keys.code(3075) == 27;  // South Orientated
    if (const auto told = unit_of(keys, 3076, 3077)) unit_ = told;
    if (const auto told = unit_of(keys, 4099, 0)) height_ = told;
    read_names(keys.text(1026).empty() ? keys.text(3073) : keys.text(1026), keys.text(4097));
    if ((!unit_ && made_.epsg != 0) || (!height_ && made_.vertical_epsg != 0)) ask_database();
    if (!unit_ && projected == 0) unit_ = 1;
    return finished();
  }

 private:
  void keep(std::string_view item) { keep_rule(reference_rules, path_, "reference system", item, warnings_); }

  /// Reads the systems of a text; false if it is none. Of those that stand in others, four deep are read.
  bool read(std::string_view text, int depth = 0) {
    static constexpr std::array<std::string_view, 4> whole{"COMPD_CS", "COMPOUNDCRS", "BOUNDCRS", "SOURCECRS"};
    bool is_any = false;
    while (const std::optional<WktNode> node = take_node(text)) {
      const std::string_view key = node->keyword;
      is_any = true;
      if (depth < 4 && std::ranges::find(whole, key) != whole.end())
        (void)read(node->content, depth + 1);
      else if (depth == 0 || (key != "TARGETCRS" && (key.ends_with("CS") || key.ends_with("CRS"))))
        read_system(*node);
    }
    if (is_any || depth > 0) return is_any;
    const bool is_globe = text::lower(text).find("geographic") != std::string::npos;
    keep(text.find('[') != text.npos ? "text that is cut off" : is_globe ? "WKT GEOGRAPHIC" : "no well-known text");
    unit_ = 1;
    return false;
  }

  void read_system(const WktNode& system) {
    keep("WKT " + system.keyword);
    const bool is_vertical = system.keyword.starts_with("VERT");
    std::optional<double>& unit = is_vertical ? height_ : unit_;
    std::string_view rest = system.content;
    while (const std::optional<WktNode> part = take_node(rest)) {
      if (part->keyword == "AXIS") {
        const std::string way = text::lower(part->after_name());
        if (way.starts_with("down")) keep_heights();
        is_west_ |= way.starts_with("west");
        std::string_view of_axis = part->content;
        while (const std::optional<WktNode> one = take_node(of_axis))
          if (one->keyword.ends_with("UNIT")) unit = unit_of(*one);
      }
      // Esri's texts have no axes: by these words, theirs go there
      is_west_ |= part->content.starts_with("\"Transverse_Mercator_South") ||
                  (part->content.starts_with("\"XY_Plane_Rotation") && part->after_name().starts_with('0'));
      if (part->keyword == "UNIT" || part->keyword == "LENGTHUNIT") unit = unit_of(*part);
      if (part->content.starts_with("\"Direction\"") && part->after_name().starts_with("-1")) keep_heights();
    }
  }

  void keep_heights() {
    if (otherwise_ != HeightUnit::by_setting) keep("depths");
  }

  [[nodiscard]] double unit_of(const WktNode& node) {
    std::string_view rest = node.after_name();
    const double metres = text::take_number<double>(rest).value_or(0);
    if (!is_unit(metres)) keep(text::message("unit of ", metres, " m"));
    return metres;
  }

  [[nodiscard]] static bool is_unit(double metres) noexcept { return metres >= 1e-6 && metres <= 1e6; }

  /// Unit by a key for its code, or one for its size; empty without one.
  [[nodiscard]] std::optional<double> unit_of(const GeoKeys& keys, std::uint16_t key, std::uint16_t size) {
    const std::uint16_t code = keys.code(key);
    const auto known = std::ranges::find(length_units, code, &LengthUnit::code);
    if (known != length_units.end()) return known->metres;
    if (const double metres = keys.number(size); is_unit(metres)) return metres;
    const bool is_told = size != 0 || (code != GeoKeys::user_defined && otherwise_ != HeightUnit::by_setting);
    if (code != 0 && is_told) keep(text::message("unit of EPSG:", code));
    return std::nullopt;
  }

  /// Finds units by codes and names: GDAL writes no key for those of compound systems, as in `x (ftUS) + y height
  /// (ft)`. EPSG tells the feet of all vertical systems in their names, and of most others but those in `wrong`.
  void read_names(std::string_view name, std::string_view vertical_name) {
    constexpr std::array<std::uint16_t, 4> wrong{3359, 3359, 26814, 26846};
    const auto in_name = [](std::string_view in) -> std::optional<double> {
      if (in.find("(ftUS)") != in.npos) return us_foot;
      return in.find("(ft)") != in.npos ? std::optional(foot) : std::nullopt;
    };
    const std::size_t plus = name.find(" + ");
    if (vertical_name.empty() && plus != name.npos) vertical_name = name.substr(plus);
    if (std::ranges::find(systems_of_depths, made_.vertical_epsg) != systems_of_depths.end() ||
        vertical_name.find("depth") != vertical_name.npos)
      keep_heights();
    if (!unit_ && is_between(systems_in_metres, made_.epsg)) unit_ = 1;
    if (!unit_ && !is_between(wrong, made_.epsg)) unit_ = in_name(name.substr(0, plus));
    if (!height_) height_ = in_name(vertical_name);
    const bool is_named = !vertical_name.empty() && vertical_name.find("(ft") == vertical_name.npos;
    if (!height_ && has_heights_ && (is_named || is_between(systems_in_metres, made_.vertical_epsg))) height_ = 1;
  }

  void ask_database() {
    if (reference_database == nullptr) return;
    constexpr std::uint16_t any = 32631;  // for heights alone
    try {
      const SpatialReference found =
          reference_database({.epsg = made_.epsg == 0 ? any : made_.epsg, .vertical_epsg = made_.vertical_epsg}, {});
      if (!unit_ && made_.epsg != 0) unit_ = found.unit;
      if (!height_ && found.vertical_epsg != 0) height_ = found.vertical_unit;
    } catch (const FileError&) {  // of a system that is unknown there, too
    }
  }

  [[nodiscard]] SpatialReference finished() {
    if (is_west_) keep("axis to the west");
    if (!unit_) keep("coordinates without a unit");
    made_.unit = unit_.value_or(1);
    if (!height_ && (made_.unit != 1 || has_heights_) && otherwise_ != HeightUnit::by_setting)
      keep("heights without a unit");
    made_.vertical_unit = height_.value_or(otherwise_ == HeightUnit::of_coordinates ? made_.unit : 1);
    return std::move(made_);
  }

  std::filesystem::path path_;
  HeightUnit otherwise_;
  std::vector<std::string>& warnings_;
  SpatialReference made_;
  std::optional<double> unit_, height_;  ///< of coordinates and of heights [m]
  bool has_heights_ = false;             ///< the keys name a vertical system
  bool is_west_ = false;                 ///< an axis goes to the west
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
