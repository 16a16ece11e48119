// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Instrument that misreports: a scanner with ten misalignments scans boards around it in two faces. Prints the error of
// each face, their difference, which shows without known places, and the deviation that the scanner states.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/uncertainty.hpp>

#include "misaligned_scanner.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Square board of half a metre, turned towards the scanner.
MeshData board_at(const Vec3& place) {
  const Vec3 across = 0.25 * normalize(cross(place, axis::up)), up = 0.25 * normalize(cross(across, place));
  return {.vertices = {place - across - up, place + across - up, place + across + up, place - across + up},
          .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

/// Points of a board in one face.
struct Face {
  Vec3 error{};       ///< sum of reported less true points [m]
  double points = 0;  ///< their number
  [[nodiscard]] Vec3 mean() const { return error / points; }
};

/// Components along the range, to the left and upwards [mm].
std::string in_mm(const Vec3& error, const Vec3& place) {
  const Vec3 range = normalize(place), left = normalize(cross(axis::up, range)), above = cross(range, left);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%8.2f%7.2f%7.2f", 1e3 * dot(error, range), 1e3 * dot(error, left),
                1e3 * dot(error, above));
  return text.data();
}

int main() {
  const double offset = 0.2_mm, tilt = 0.05_mrad;  // standard deviations
  const misaligned::Parameters deviations{offset, offset, offset, offset, tilt, tilt, tilt, tilt, tilt, offset};
  const misaligned::MirrorUnit unit{.scanner = {.pulse_rate = 100_kHz, .pulses = 720 * 720},
                                    .rotation_rate = 100_kHz / 720,
                                    .misalignments = misaligned::drawn(deviations, 1),
                                    .deviations = deviations};
  std::puts("misalignments [mm, mrad]");
  for (std::size_t k = 0; k < misaligned::names.size(); ++k)
    std::printf("%5s%8.3f\n", misaligned::names[k], 1e3 * unit.misalignments[k]);

  const std::vector<Vec3> places{{0, 3, 0}, {6, 0, 2}, {0, -8, 6}, {-4, 0, -3}, {5, 5, 9}, {10, -10, 0}};
  std::vector<Part<TriangleMesh<>>> parts;
  for (const Vec3& place : places)
    parts.push_back({.geometry = std::make_shared<const TriangleMesh<>>(board_at(place)),
                     .object = static_cast<ObjectId>(parts.size())});
  const Scene<TriangleMesh<>> boards(std::move(parts));

  // mirror and head turn once around, so that every place is seen in both faces
  const Deflector scanner{RotatingHead{.angular_rate = 360_deg / unit.duration().seconds()}, unit};
  const Survey survey{Platform{Tripod{}, Mount{}, scanner}, SingleRay{}, boards, Receiver{}, FirstHit{}};
  const UncertaintyQuery uncertainty = uncertainty_of(survey);
  std::vector<std::array<Face, 2>> faces(places.size());
  std::vector<Covariance> stated(places.size());  // of the last point
  run(survey, {}, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const Pulse<frame::World> truth = *survey.source().pulse(shot.index);
        Face& face = faces[echo.object][unit.zenith(shot.tick) < pi ? 0 : 1];
        face.error += point_of(shot, echo) - truth.pose.point({0, echo.range, 0});
        ++face.points;
        stated[echo.object] = uncertainty(shot, echo).systematic;
      }
  });

  std::puts("\nreported less true place [mm]: along the range, to the left, upwards; stated: deviation in space");
  std::puts("board  range    face 1                 face 2                 difference             stated");
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Vec3 first = faces[k][0].mean(), second = faces[k][1].mean();
    const double deviation = std::sqrt(stated[k].xx + stated[k].yy + stated[k].zz);
    std::printf("%5zu%6.1fm %s %s %s %7.2f\n", k + 1, length(places[k]), in_mm(first, places[k]).c_str(),
                in_mm(second, places[k]).c_str(), in_mm(second - first, places[k]).c_str(), 1e3 * deviation);
  }
}
