// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_PAGE_HPP
#define PULSECAST_PAGE_PAGE_HPP

#include <pulsecast/io/colour.hpp>
#include <pulsecast/page/detail/columns.hpp>
#include <pulsecast/version.hpp>

#if !__has_include(<pulsecast/page/detail/assets.hpp>)
#error \
    "pulsecast/page/detail/assets.hpp is generated: install pulsecast with CMake, or run `cmake -P include/pulsecast/page/assets.cmake`"
#endif
#include <pulsecast/page/detail/assets.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Path of the instrument in a leg. A path of one place is a set-up.
struct PageLeg {
  std::string name{};           ///< name shown for the leg
  std::vector<double> times{};  ///< ascending, since the survey's start [s]
  std::vector<Vec3> places{};   ///< one for each time, in the world [m]
};

/// Samples a trajectory from `start` to `start + duration` in the survey's time: evenly spaced, or
/// once if it does not move. The trajectory's own time begins at 0.
[[nodiscard]] PageLeg page_leg(std::string name, const Trajectory auto& trajectory, Tick start, Tick duration,
                               int moments = 200) {
  PageLeg leg{std::move(name), {}, {}};
  for (int k = 0; k < moments; ++k) {
    const double time = duration.seconds() * k / std::max(moments - 1, 1);
    leg.times.push_back(start.seconds() + time);
    leg.places.push_back(trajectory.at(Tick::of_seconds(time)).position);
  }
  const auto stays = [&](const Vec3& p) { return !(length(p - leg.places.front()) > 1e-4); };
  if (std::ranges::all_of(leg.places, stays)) {
    leg.times.resize(1);
    leg.places.resize(1);
  }
  return leg;
}

/// Description of a survey on a page. Texts may contain any characters.
struct PageSurvey {
  std::string name{}, scanner{}, platform{};  ///< names shown for survey, scanner and platform
  std::vector<PageLeg> legs{};                ///< legs by number
  std::map<ObjectId, std::string> objects{};  ///< names of objects, if any
};

/// Settings of a page.
struct PageSettings {
  std::size_t points_max = 1'000'000;     ///< from 2 to 2^27; larger clouds are thinned
  double position_step = 0;               ///< step of coordinates; 0: by `page_step` [m]
  int effort = 6;                         ///< compression level, 1 to 9
  std::vector<io::PointField> columns{};  ///< further columns, see `io::layouts::columns`
  io::PointSettings points{};             ///< values of columns; colours if these have any

  void validate() const {
    require_within("PageSettings::points_max", points_max, 2, 134'217'728, "");
    encoding().validate();
  }
  /// Settings of the encoding of points.
  [[nodiscard]] PageColumnSettings encoding() const { return {.position_step = position_step, .effort = effort}; }
};

namespace detail {

/// Writes the colour scales of pictures, for the page.
inline void write_colours(detail::JsonWriter& json) {
  const auto scale = [](std::span<const io::Srgb> colours) {
    return [colours](auto i) { return io::to_srgb(io::along(colours, static_cast<double>(i) / 255)); };
  };
  json.begin_object();
  json.key("viridis").array(256, scale(io::viridis));
  json.key("greys").array(256, scale(io::greys));
  json.key("hues").array(256, [](auto i) { return io::to_srgb(io::of_hue(static_cast<double>(i) / 256)); });
  json.key("classes").array(70, [](std::size_t i) { return io::of_class(static_cast<std::uint16_t>(i)); });
  json.member("kinds", io::okabe_ito);
  json.member("light", io::kind_colours);
  json.end_object();
}

inline void write_legs(detail::JsonWriter& json, std::span<const PageLeg> legs) {
  const auto rounded = [](double value, double steps) { return std::round(value * steps) / steps; };
  json.begin_array();
  for (const PageLeg& leg : legs) {
    json.begin_object().member("name", leg.name);
    json.key("times").array(leg.times.size(), [&](std::size_t i) { return rounded(leg.times[i], 1e7); });
    json.key("places").array(leg.places.size(), [&](std::size_t i) {
      const Vec3& p = leg.places[i];
      return std::array{rounded(p.x, 1e4), rounded(p.y, 1e4), rounded(p.z, 1e4)};
    });
    json.end_object();
  }
  json.end_array();
}

inline std::string json_of(const PageSurvey& survey, std::uint64_t echoes, bool live) {
  detail::JsonWriter json;
  json.begin_object().member("name", survey.name).member("scanner", survey.scanner).member("platform", survey.platform);
  json.member("version", PULSECAST_VERSION).member("echoes", echoes).member("live", live);
  json.key("objects").begin_object();
  for (const auto& [id, name] : survey.objects) json.member(std::to_string(id), name);
  json.end_object();
  json.key("legs");
  write_legs(json, survey.legs);
  json.key("colours");
  write_colours(json);
  json.end_object();
  return json.text();
}

}  // namespace detail

/// Whole page as HTML. With `live`, it has no points and loads them from its own server.
[[nodiscard]] inline std::string page_html(const PageSurvey& survey, std::uint64_t echoes, std::string_view columns,
                                           bool live = false) {
  std::string out;
  for (const std::string_view piece : detail::html_before_survey) out += piece;
  out += detail::json_of(survey, echoes, live);
  for (const std::string_view piece : detail::html_before_points) out += piece;
  out += base64(columns);
  for (const std::string_view piece : detail::html_after_points) out += piece;
  return out;
}

/// Sink that writes the cloud as one HTML file: an interactive 3D view with colours, playback and point attributes.
/// Works in any browser since 2023, without a network. The file depends on echoes and settings alone. `PageSample`
/// thins larger clouds; `page_columns` states the accuracy. Only `close()` makes the file: see `OutputFile`.
class PageWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit PageWriter(std::filesystem::path path, PageSurvey survey = {}, const PageSettings& settings = {})
      : settings_(validated(settings)),
        survey_(std::move(survey)),
        file_(std::move(path)),
        sample_(settings.points_max, settings.points, settings.columns) {}

  void operator()(const EchoBatch& batch) { sample_(batch); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Description of the survey; may be changed until the file is closed.
  [[nodiscard]] PageSurvey& survey() noexcept { return survey_; }

  void close() {
    file_.write(page_html(survey_, sample_.seen(), page_columns(sample_.points(), settings_.encoding())));
    file_.commit();
  }

 private:
  PageSettings settings_;
  PageSurvey survey_;
  io::OutputFile file_;
  PageSample sample_;
};
static_assert(EchoSink<PageWriter>);

}  // namespace PULSECAST_NAMESPACE::page

#endif
