// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "clock.hpp"

#include <chrono>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/survey.hpp>

#include "point_formats.hpp"

using namespace pulsecast;

// Sources: IS-GPS-200; leap seconds: IERS Bulletin C.
double gps_week_seconds(std::int64_t unix_time) {
  static constexpr std::int64_t leaps[] = {362793600, 394329600,  425865600,  489024000,  567993600,  631152000,
                                           662688000, 709948800,  741484800,  773020800,  820454400,  867715200,
                                           915148800, 1136073600, 1230768000, 1341100800, 1435708800, 1483228800};
  constexpr std::int64_t epoch = 315964800, week = 604800;
  std::int64_t gps = unix_time - epoch;
  for (const std::int64_t leap : leaps) gps += unix_time >= leap ? 1 : 0;
  return static_cast<double>(((gps % week) + week) % week);
}

std::int64_t unix_time_of(const std::string& text) {
  if (text.empty()) return std::time(nullptr);
  std::tm t{};
  std::istringstream in(text);
  if (text.find_first_not_of("0123456789") == std::string::npos && text.size() < 16)
    return *pulsecast::text::number_in<std::int64_t>(text);
  in >> std::get_time(&t, "%Y-%m-%d %H:%M:%S");
  const std::tm given = t;
  const std::int64_t moment = timegm(&t);  // it turns the 30th of February into the 2nd of March
  const bool is_date =
      t.tm_mday == given.tm_mday && t.tm_hour == given.tm_hour && t.tm_sec == given.tm_sec && moment >= 0;
  if (!in || in.peek() != std::istringstream::traits_type::eof() || !is_date)
    throw std::invalid_argument("--gpsStartTime '" + text +
                                "': expected YYYY-MM-DD hh:mm:ss in UTC, or whole seconds since 1970");
  return moment;
}

void settle_clock(Options& o, const helios::Simulation& simulation, double begin, double end, Notes& notes) {
  constexpr double week = 604'800;
  o.adjusted_time = simulation.compiled().clock_start && !(begin >= 0 && begin <= week);
  if (o.format == "mcap" && !(begin >= 0 && end <= 2'147'483'647))
    throw std::invalid_argument("--format mcap: times from " + text::to_text(begin) + " to " + text::to_text(end) +
                                " s: expected seconds from 0 to 2^31 - 1, as ROS has; other formats have any");
  if (point_format(o.format).kind != PointKind::las) return;
  std::ostringstream text;
  text << std::fixed << "times from " << begin << " to " << end << " s ";
  if (o.adjusted_time && std::fabs(begin) <= 1e9) {  // up to 2043
    using namespace std::chrono;
    const year_month_day day = floor<days>(sys_days{January / 6 / 1980} + seconds(std::llround(1e9 + begin)));
    text << "are no seconds of a GPS week: LAS says that they are adjusted standard GPS time, which begins here at "
         << int{day.year()} << '-' << std::setfill('0') << std::setw(2) << unsigned{day.month()} << '-' << std::setw(2)
         << unsigned{day.day()};
    notes.note(text.str());
  } else if (o.adjusted_time) {
    text << "are neither seconds of a GPS week nor adjusted standard GPS time, of which LAS says that they are: "
            "expected one of these clocks";
    notes.warn(text.str());
  } else if (end > week) {
    text << "continue beyond the end of the GPS week, 604800 s";
    notes.note(text.str());
  }
}
