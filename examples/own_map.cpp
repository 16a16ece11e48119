// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Robot that scans a user-defined map: a struct that answers ray queries, without mesh or scene. Here it is a signed
// distance function of an underground cistern with columns and vaults; an occupancy grid works as well. Writes
// own_map.png.

#include <array>
#include <cmath>
#include <optional>

#include <pulsecast/io/png.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "summary.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Columns four metres apart under groin vaults, within four walls.
struct Cistern {
  enum Class : std::uint16_t { water = 9, column = 64, vault = 65 };

  static constexpr double spacing = 4, springing = 3;  // of the columns, and the springing height of the vaults [m]

  /// Offset from the nearest axis of columns, in [-spacing/2, spacing/2].
  static double cell(double x) noexcept { return x - spacing * std::round(x / spacing); }

  /// Distances to the water, columns and vaults [m]. A groin vault encloses the union of two crossing barrels.
  static std::array<double, 3> distances(const Vec3& p) noexcept {
    const double x = cell(p.x), y = cell(p.y), across = std::hypot(x, y);
    const double base = std::fmax(std::fmax(std::fabs(x), std::fabs(y)) - 0.45, std::fmax(std::fabs(p.z) - 0.35, -p.z));
    const double shaft = across - 0.3;
    const double capital = std::fmax(std::fmax(std::fabs(x), std::fabs(y)) - 0.30 - 0.5 * std::fabs(p.z - 2.55),
                                     std::fabs(p.z - 2.8) - 0.25);
    const double above = std::fmax(p.z - springing, 0.0), radius = spacing / 2 - 0.25;
    const double along_x = radius - std::hypot(spacing / 2 - std::fabs(y), above),
                 along_y = radius - std::hypot(spacing / 2 - std::fabs(x), above);
    const double vaults =
        p.z > springing ? std::fmax(along_x, along_y)
                        : springing + 0.05 - p.z;  // below the springing: lower bound of the distance to the vaults
    const double walls = std::fmin(10 - std::fabs(p.x - 2), 18 - std::fabs(p.y - 14));
    return {p.z, std::fmin(base, std::fmin(shaft, 0.8 * capital)), std::fmin(walls, vaults)};
  }

  static double distance(const Vec3& p) noexcept {
    const auto [to_water, to_column, to_vault] = distances(p);
    return std::fmin(to_water, std::fmin(to_column, to_vault));
  }

  /// The only function that the `Target` concept requires. Source: Hart 1996, sphere tracing.
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    double range = ray.near;
    for (int step = 0; step < 400 && range < ray.far && range < 60; ++step) {
      const Vec3 p = ray.origin + range * ray.direction;
      const double free = distance(p);
      if (free < 1e-4) return describe(p, ray, range);
      range += 0.9 * free;
    }
    return std::nullopt;
  }

  static Hit describe(const Vec3& p, const Ray& ray, double range) noexcept {
    constexpr double h = 1e-4;
    const Vec3 slope{distance(p + h * axis::right) - distance(p - h * axis::right),
                     distance(p + h * axis::forward) - distance(p - h * axis::forward),
                     distance(p + h * axis::up) - distance(p - h * axis::up)};
    const double cosine = std::fabs(dot(normalize(slope), ray.direction));
    const auto [to_water, to_column, to_vault] = distances(p);
    const Class what = to_water < 1e-3 ? water : to_column < 1e-3 ? column : vault;
    return {.range = range, .cos_incidence = cosine, .backscatter = 0.5 * cosine, .classification = what};
  }
};
static_assert(Target<Cistern>);

int main(int argc, char** argv) {
  CommandLine line("A robot scans the map of a cistern, a signed distance function.");
  return line.run(argc, argv, [&] {
    const Cistern map;
    const Scanner scanner{.pulse_rate = 300_kHz, .pulses = 600'000};
    const auto stop_at = [&](double y) {
      const Deflector sweeping{PolygonMirror{.line_rate = 500_Hz, .sweep = 90_deg}, scanner};
      return Platform{Tripod{.position = {2, y, 0.4}}, Mount{},
                      Deflector{RotatingHead{.angular_rate = 180_deg}, sweeping}};
    };
    const Legs stops(std::vector{stop_at(2), stop_at(10), stop_at(18), stop_at(26)});  // set-ups along an aisle
    const Survey survey{stops, SingleRay{}, map, Receiver{}, FirstHit{}};
    io::ImageWriter image(line.output / "own_map.png", {.azimuth = 0,
                                                        .elevation = 2_deg,
                                                        .field_of_view = 80_deg,
                                                        .eye = Vec3(2, -3, 1.5),
                                                        .colour_by = io::ColourBy::classification});
    print(run(survey, {.threads = line.threads, .progress = ProgressLine{}}, image));
    image.close();
  });
}
