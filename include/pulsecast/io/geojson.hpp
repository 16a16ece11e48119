// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_GEOJSON_HPP
#define PULSECAST_IO_GEOJSON_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a GeoJSON file.
struct GeoJsonSettings {
  int epsg = 0;                    ///< EPSG code of a projected system, up to 32766; 0: none
  double interval = 1;             ///< time between two points of a trajectory [s]
  double footprint_interval = 10;  ///< time that one polygon of a footprint covers [s]
  double unit = 1;                 ///< unit of x and y in the file [m]
  double vertical_unit = 1;        ///< unit of z in the file [m]

  void validate() const {
    require_within("GeoJsonSettings::epsg", epsg, 0, 32766, "");  // source: OGC GeoTIFF 1.1
    require_positive("GeoJsonSettings::interval", interval, "s");
    require_positive("GeoJsonSettings::footprint_interval", footprint_interval, "s");
    for (const double one : {unit, vertical_unit}) require_within("GeoJsonSettings::unit", one, 1e-9, 1e6, "m");
  }
};

namespace detail {

/// Convex hull, anticlockwise from the lowest x, without points on its edges. Exact if the products
/// of differences are. Source: Andrew 1979, Another efficient algorithm for convex hulls.
[[nodiscard]] inline std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x, p.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  const auto add = [&hull](const Vec2& p, std::size_t fewest) {
    const auto turns_left = [&] {
      const Vec2 &a = hull[hull.size() - 2], &b = hull.back();
      return (b.x - a.x) * (p.y - a.y) > (b.y - a.y) * (p.x - a.x);
    };
    while (hull.size() > fewest && !turns_left()) hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();  // the first point again
  return hull;
}

/// Convex hull of a stream of points. Keeps some thousands, or twice the corners if these are more.
class HullOfStream {
 public:
  void add(const Vec2& point) {
    if (points_.size() >= limit_) {
      points_ = convex_hull(std::move(points_));
      limit_ = std::max(least, 2 * points_.size());
    }
    points_.push_back(point);
  }

  /// Corners of all points since the last call.
  [[nodiscard]] std::vector<Vec2> take() { return convex_hull(std::exchange(points_, {})); }

 private:
  static constexpr std::size_t least = 4096;
  std::vector<Vec2> points_;
  std::size_t limit_ = least;
};

}  // namespace detail

/// Writes the trajectory and the footprint of each leg as GeoJSON, one feature a line, as for QGIS:
/// - trajectory: LineString of origins of pulses, the first and the last among them; a Point for a
///   leg that does not move. Properties: kind, leg, pulses, points (all echoes), start, end [s];
/// - footprint: Polygon of the convex hull, seen from above, of the echoes' points of one
///   `footprint_interval`, counted from the start of the leg. Properties: kind, leg, start and end
///   (first and last pulse with a point) [s], points, area [m^2]. Points on a line have none.
///
/// Sources: RFC 7946, 3.1 and 3.3; for the member "crs", which names `epsg`: GeoJSON 2008, 3. QGIS
/// and GDAL read it; RFC 7946 allows WGS 84 only, so strict readers misplace coordinates in metres.
/// Coordinates have 3 decimals. Points that are not finite are left out. A leg ends when another
/// begins; one that comes back has new features. Memory grows with the points of one leg's
/// trajectory, and the corners of one footprint. `close()` completes the file: see `OutputFile`.
class GeoJsonWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit GeoJsonWriter(std::filesystem::path path, const GeoJsonSettings& settings = {})
      : settings_(validated(settings)), file_(std::move(path)) {
    file_.write(std::string_view("{\"type\":\"FeatureCollection\","));
    if (settings_.epsg != 0)
      file_.write(text::joined({R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::)",
                                std::to_string(settings_.epsg), "\"}},"}));
    file_.write(std::string_view("\"features\":["));
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      const double time = shot.tick.seconds();
      if (!leg_ || leg_->number != shot.leg) {
        end_leg();
        leg_ = Leg{.number = shot.leg, .time = {time, time}};
      }
      follow(shot, time);
      for (const Echo& echo : batch.echoes_of(shot)) cover(point_of(shot, echo), time);
    }
  }

  /// Writes the last leg, and gives the file its name. Throws a `FileError`.
  void close() {
    end_leg();
    file_.write(std::string_view("\n]}\n"));
    file_.commit();
  }

 private:
  static constexpr double per_unit = 1000;  // steps of the coordinates as written

  struct Times {
    double start = 0, end = 0;
  };

  struct Leg {
    std::uint16_t number = 0;
    Times time{};
    std::uint64_t pulses = 0, points = 0;
    double slot = -1;            // number of the interval of the last point
    std::optional<Vec3> last{};  // origin of the last pulse [steps]
    std::string line{}, end{};   // points so far, and the last of them
    std::size_t line_points = 0;

    void add(const Vec3& point) {
      std::string text = position({point.x, point.y, point.z});
      if (text == end) return;
      line += (line_points == 0 ? "" : ",") + text;
      end = std::move(text);
      ++line_points;
    }
  };

  struct Footprint {
    double slot = 0;
    Times time{};
    std::uint64_t points = 0;
  };

  /// Point in whole steps: hulls up to some 90 million of them are exact. Empty if not finite.
  [[nodiscard]] std::optional<Vec3> rounded(const Vec3& point) const {
    const Vec3 scaled = point * per_unit / Vec3{settings_.unit, settings_.unit, settings_.vertical_unit};
    if (!finite(scaled)) return std::nullopt;
    return Vec3{std::nearbyint(scaled.x), std::nearbyint(scaled.y), std::nearbyint(scaled.z)};
  }

  template <std::size_t N>
  [[nodiscard]] static std::string position(const double (&steps)[N]) {
    TextRow row(',');
    for (const double value : steps) row.add(value / per_unit, 3);
    std::string_view text = row.end();
    text.remove_suffix(1);  // the line end
    return text::joined({"[", text, "]"});
  }

  void follow(const Shot& shot, double time) {
    ++leg_->pulses;
    leg_->points += shot.echoes;
    leg_->time.end = time;
    const std::optional<Vec3> origin = rounded(shot.origin);
    if (!origin) return;
    leg_->last = origin;
    const double slot = std::floor((time - leg_->time.start) / settings_.interval);
    if (slot <= leg_->slot) return;
    leg_->slot = slot;
    leg_->add(*origin);
  }

  void cover(const Vec3& echo, double time) {
    const std::optional<Vec3> point = rounded(echo);
    if (!point) return;
    const double slot = std::floor((time - leg_->time.start) / settings_.footprint_interval);
    if (footprint_ && footprint_->slot != slot) end_footprint();
    if (!footprint_) footprint_ = Footprint{.slot = slot, .time = {time, time}};
    footprint_->time.end = time;
    ++footprint_->points;
    hull_.add({point->x, point->y});
  }

  void end_footprint() {
    if (!footprint_) return;
    const Footprint done = *std::exchange(footprint_, std::nullopt);
    const std::vector<Vec2> corners = hull_.take();
    if (corners.size() < 3) return;
    double twice = 0;  // area [steps^2]
    std::string ring;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
      twice += a.x * b.y - a.y * b.x;
      ring += position({corners[i].x, corners[i].y}) + ",";
    }
    if (!std::isfinite(twice)) return;
    const std::string area = text::to_text(twice / (2 * per_unit * per_unit) * settings_.unit * settings_.unit);
    const std::string end = position({corners[0].x, corners[0].y});
    feature("footprint", done.time, text::joined({R"("points":)", std::to_string(done.points), R"(,"area":)", area}),
            text::joined({R"({"type":"Polygon","coordinates":[[)", ring, end, "]]}"}));
  }

  void end_leg() {
    if (!leg_) return;
    end_footprint();
    if (leg_->last) leg_->add(*leg_->last);
    const std::string pulses = std::to_string(leg_->pulses), points = std::to_string(leg_->points);
    const auto [begin, end] = leg_->line_points > 1 ? std::pair(R"({"type":"LineString","coordinates":[)", "]}")
                                                    : std::pair(R"({"type":"Point","coordinates":)", "}");
    if (leg_->last)
      feature("trajectory", leg_->time, text::joined({R"("pulses":)", pulses, R"(,"points":)", points}),
              text::joined({begin, leg_->line, end}));
    leg_.reset();
  }

  void feature(std::string_view kind, const Times& time, std::string_view counts, std::string_view geometry) {
    const std::string leg = std::to_string(leg_->number);
    const std::string start = text::to_text(time.start), end = text::to_text(time.end);
    file_.write(text::joined({std::exchange(separator_, ",\n"), R"({"type":"Feature","properties":{"kind":")", kind,
                              R"(","leg":)", leg, R"(,"start":)", start, R"(,"end":)", end, ",", counts,
                              R"(},"geometry":)", geometry, "}"}));
  }

  GeoJsonSettings settings_;
  OutputFile file_;
  std::string_view separator_ = "\n";
  std::optional<Leg> leg_;
  std::optional<Footprint> footprint_;
  detail::HullOfStream hull_;
};
static_assert(EchoSink<GeoJsonWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
