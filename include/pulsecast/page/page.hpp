// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/colour.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/page/detail/columns.hpp>
#include <pulsecast/page/detail/sample.hpp>
#include <pulsecast/page/detail/viewer.hpp>
#include <pulsecast/version.hpp>

namespace pulsecast::page {

/// Where the instrument was during a leg. A way of a single place is a set-up.
struct PageLeg {
  std::string name{};
  std::vector<double> times{};  ///< ascending, since the survey's start [s]
  std::vector<Vec3> places{};   ///< one for each time, in the world [m]
};

/// A trajectory from `start` to `start + duration` in the survey's time, as a page tells it: at so many moments, evenly spaced, or at one
/// if it does not move. The trajectory is asked in its own time, from 0.
[[nodiscard]] PageLeg page_leg(std::string name, const Trajectory auto& trajectory, Tick start, Tick duration, int moments = 200) {
  PageLeg leg{std::move(name), {}, {}};
  bool moves = false;
  for (int k = 0; k < moments; ++k) {
    const double time = duration.seconds() * k / std::max(moments - 1, 1);
    leg.times.push_back(start.seconds() + time);
    leg.places.push_back(trajectory.at(Tick::of_seconds(time)).position);
    moves = moves || length(leg.places.back() - leg.places.front()) > 1e-4;
  }
  if (!moves) leg.times.resize(1), leg.places.resize(1);
  return leg;
}

/// What a page tells beside the points. Texts may be any.
struct PageSurvey {
  std::string name{}, scanner{}, platform{};
  std::vector<PageLeg> legs{};                ///< by number
  std::map<ObjectId, std::string> objects{};  ///< names of objects, if they have any
};

struct PageSettings {
  std::size_t points_max = 1'000'000;  ///< from 2 to 2^27; more are thinned
  double position_step = 0;            ///< of coordinates; 0 for one that suits the extent: see `page_step` [m]
  int effort = 6;                      ///< of compression, from 1 to 9

  void validate() const {
    require_within("PageSettings::points_max", static_cast<double>(points_max), 2, 134'217'728, "");
    columns().validate();
  }
  [[nodiscard]] PageColumnSettings columns() const { return {.position_step = position_step, .effort = effort}; }
};

namespace detail {

inline std::string json_of(const io::Srgb& colour) {
  return '[' + std::to_string(colour[0]) + ',' + std::to_string(colour[1]) + ',' + std::to_string(colour[2]) + ']';
}

template <class Item>
std::string json_list(std::size_t count, const Item& item) {
  std::string out = "[";
  for (std::size_t i = 0; i < count; ++i) out += (i > 0 ? "," : "") + item(i);
  return out + ']';
}

/// The colours of pictures, for the page's own.
inline std::string json_colours() {
  const auto scale = [](std::span<const io::Srgb> colours) {
    return json_list(256, [colours](std::size_t i) { return json_of(io::to_srgb(io::along(colours, static_cast<double>(i) / 255))); });
  };
  return "{\"viridis\":" + scale(io::viridis) + ",\"greys\":" + scale(io::greys) +
         ",\"hues\":" + json_list(256, [](std::size_t i) { return json_of(io::to_srgb(io::of_hue(static_cast<double>(i) / 256))); }) +
         ",\"classes\":" + json_list(70, [](std::size_t i) { return json_of(io::of_class(static_cast<std::uint16_t>(i))); }) +
         ",\"kinds\":" + json_list(io::okabe_ito.size(), [](std::size_t i) { return json_of(io::okabe_ito[i]); }) + '}';
}

inline std::string json_legs(std::span<const PageLeg> legs) {
  const auto place = [](const Vec3& p) {
    return json_list(3, [&p](std::size_t k) { return json_number(std::round(p[static_cast<int>(k)] * 1e4) / 1e4); });
  };
  return json_list(legs.size(), [&](std::size_t i) {
    const PageLeg& leg = legs[i];
    return "{\"name\":" + json_text(leg.name) + ",\"times\":" +
           json_list(leg.times.size(), [&leg](std::size_t k) { return json_number(std::round(leg.times[k] * 1e7) / 1e7); }) +
           ",\"places\":" + json_list(leg.places.size(), [&](std::size_t k) { return place(leg.places[k]); }) + '}';
  });
}

inline std::string json_of(const PageSurvey& survey, std::uint64_t echoes, bool live) {
  std::string objects = "{";
  for (const auto& [id, name] : survey.objects)
    objects += (objects.size() > 1 ? ",\"" : "\"") + std::to_string(id) + "\":" + json_text(name);
  return "{\"name\":" + json_text(survey.name) + ",\"scanner\":" + json_text(survey.scanner) +
         ",\"platform\":" + json_text(survey.platform) + ",\"version\":" + json_text(PULSECAST_VERSION) +
         ",\"echoes\":" + std::to_string(echoes) + ",\"live\":" + (live ? "true" : "false") + ",\"objects\":" + objects +
         "},\"legs\":" + json_legs(survey.legs) + ",\"colours\":" + json_colours() + '}';
}

}  // namespace detail

/// A whole page: HTML that needs no other file and asks nobody for anything. With `live`, it has no points, but asks where it came from.
[[nodiscard]] inline std::string page_html(const PageSurvey& survey, std::uint64_t echoes, std::string_view columns, bool live = false) {
  std::string out(page_head);
  out += detail::json_of(survey, echoes, live);
  out += page_before_points;
  out += base64(columns);
  out += page_before_scripts;
  for (const std::string_view script : page_scripts) out += script;
  return out += page_end;
}

/// A sink that leaves the cloud as one HTML file in which it can be looked at from all sides, coloured, played and asked for the attributes
/// of its points, in any browser since 2023, without a network. What is written depends on echoes and settings alone. Points that are too
/// many are thinned evenly: see `PageSample`; see `page_columns` for how exact the attributes are. Only `close()` makes the file: see
/// `OutputFile`.
class PageWriter {
 public:
  explicit PageWriter(std::filesystem::path path, PageSurvey survey = {}, const PageSettings& settings = {})
      : settings_(validated(settings)), survey_(std::move(survey)), file_(std::move(path)), sample_(settings.points_max) {}

  void operator()(const EchoBatch& batch) { sample_(batch); }

  /// What is told beside the points, which may be changed until the file is closed.
  [[nodiscard]] PageSurvey& survey() noexcept { return survey_; }

  void close() {
    file_.write(page_html(survey_, sample_.seen(), page_columns(sample_.points(), settings_.columns())));
    file_.commit();
  }

 private:
  PageSettings settings_;
  PageSurvey survey_;
  io::OutputFile file_;
  PageSample sample_;
};
static_assert(EchoSink<PageWriter>);

}  // namespace pulsecast::page
