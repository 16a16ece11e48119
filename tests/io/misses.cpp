// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/misses.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/las.hpp>
#include <pulsecast/pulsecast.hpp>

#include "support/generators.hpp"
#include "support/las_reader.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using namespace pulsecast::literals;
using support::content;
using support::TemporaryFolder;

/// A bright plate of 4 m by 4 m, 10 m in front of the scanner, a black one 10 m behind it, and a bright one 600 m to
/// its right.
Scene<TriangleMesh<>> plates() {
  const auto plate = [](const Vec3& centre, const Vec3& a, const Vec3& b) {
    const MeshData data{.vertices = {centre - a - b, centre + a - b, centre + a + b, centre - a + b},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
    return std::make_shared<const TriangleMesh<>>(data);
  };
  return Scene<TriangleMesh<>>(
      {{.geometry = plate({0, 10, 0}, {2, 0, 0}, {0, 0, 2}),
        .materials = material_table({{.reflectance = 0.8, .classification = 6}})},
       {.geometry = plate({0, -10, 0}, {2, 0, 0}, {0, 0, 2}), .materials = material_table({{.reflectance = 0}})},
       {.geometry = plate({600, 0, 0}, {0, 90, 0}, {0, 0, 90}), .materials = material_table({{.reflectance = 0.8}})}});
}

/// A scan all around, with pulses of all fates but `below_threshold`.
auto scan(const Scene<TriangleMesh<>>& scene) {
  const PolygonMirror mirror{.line_rate = 97, .angle_min = -0.3, .angle_max = 0.3};
  return Survey{Platform{Tripod{}, Mount{},
                         Deflector{RotatingHead{.angular_rate = 2 * pi},
                                   Deflector{mirror, Scanner{.pulse_rate = 20e3, .pulses = 20'000}}}},
                SingleRay{}, scene, Receiver{.range_max = 500}, FirstHit{}};
}

struct Row {
  PulseIndex pulse = 0;
  double time = 0;
  Vec3 origin{}, direction{};
  std::string fate{};
  int leg = 0, device = 0;
};

std::vector<Row> rows_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<Row> rows;
  for (Row r; in >> r.pulse >> r.time >> r.origin.x >> r.origin.y >> r.origin.z >> r.direction.x >> r.direction.y >>
              r.direction.z >> r.fate >> r.leg >> r.device;)
    rows.push_back(r);
  return rows;
}

}  // namespace

TEST_CASE("each pulse without an echo is a row with its place, direction and fate, and no other pulse is") {
  const TemporaryFolder folder;
  const auto scene = plates();
  const auto survey = scan(scene);
  std::map<PulseIndex, Shot> shots;
  MissTextWriter misses(folder / "misses.txt", {.start_time = 1000});
  const RunSummary summary = run(survey, {.threads = 2}, misses, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) shots[shot.index] = shot;
  });
  misses.close();
  const std::vector<Row> rows = rows_of(content(folder / "misses.txt"));
  std::map<std::string, std::uint64_t> by_fate;
  PulseIndex before = 0;
  for (const Row& row : rows) {
    CHECK((by_fate.empty() || row.pulse > before));
    before = row.pulse;
    ++by_fate[row.fate];
    const Shot& shot = shots.at(row.pulse);
    CHECK(row.fate == name_of(shot.fate));
    CHECK(shot.echoes == 0);
    CHECK(length(row.direction - shot.direction) < 1e-9);
    CHECK(length(row.origin - shot.origin) < 1e-4);
    CHECK(std::fabs(row.time - 1000 - shot.tick.seconds()) < 1e-9);
  }
  CHECK(summary.count(Fate::blocked) > 1000);
  CHECK(rows.size() + summary.count(Fate::returned) == summary.pulses());
  CHECK(shots.size() == summary.pulses());
  CHECK(by_fate.size() == 3);
  for (const Fate fate : {Fate::missed, Fate::out_of_range, Fate::absorbed}) {
    CHECK(by_fate[std::string(name_of(fate))] == summary.count(fate));
    CHECK(summary.count(fate) > 10);
  }
}

TEST_CASE("a sink gets a point for each pulse without an echo, at the set range, with a class of its own") {
  const auto scene = plates();
  const auto survey = scan(scene);
  Cloud plain, all;
  const RunSummary summary = run(survey, {.threads = 1}, plain);
  WithMisses misses(all, MissSettings{.range = 77, .classification = 65, .object = 9});
  std::map<PulseIndex, Vec3> directions, origins;
  (void)run(survey, {.threads = 2}, misses, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      directions[shot.index] = shot.direction;
      origins[shot.index] = shot.origin;
    }
  });
  const Cloud& cloud = misses.sink();
  CHECK(plain.size() == summary.echoes);
  CHECK(cloud.size() == summary.pulses());  // of one echo at most
  std::size_t next = 0, added = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Echo& echo = cloud.echoes[i];
    CHECK(echo.number == 1);
    if (echo.classification != 65) {
      REQUIRE(next < plain.size());
      CHECK(cloud.pulses[i] == plain.pulses[next]);
      CHECK(cloud.points[i] == plain.points[next++]);
      continue;
    }
    ++added;
    CHECK(echo.amplitude == 0);
    CHECK(echo.reflectance == 0);
    CHECK(echo.object == 9);
    CHECK(cloud.points[i] == origins.at(cloud.pulses[i]) + directions.at(cloud.pulses[i]) * 77.0);
  }
  CHECK(next == plain.size());
  CHECK(added + summary.count(Fate::returned) == summary.pulses());
}

TEST_CASE("batches with several echoes, waveforms and subrays keep them") {
  support::Generator random(4);
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  std::vector<SubrayRecord> subrays;
  for (PulseIndex i = 0; i < 200; ++i) {
    const auto count = static_cast<std::uint32_t>(random.whole(4));
    shots.push_back({.index = i,
                     .direction = random.unit(),
                     .fate = count > 0 ? Fate::returned : Fate::below_threshold,
                     .first_echo = static_cast<std::uint32_t>(echoes.size()),
                     .echoes = count,
                     .first_sample = 3 * i,
                     .samples = 3});
    for (std::uint32_t k = 0; k < count; ++k) echoes.push_back({.range = static_cast<double>(10 * i + k)});
    subrays.resize(subrays.size() + 2);
  }
  const std::vector<float> samples(600, 1.F);
  const EchoBatch batch{
      .shots = shots, .echoes = echoes, .samples = samples, .sample_interval = 1e-9, .subrays = subrays};
  MissPoints points({.range = 5});
  for (int time = 0; time < 2; ++time) {
    const EchoBatch all = points(batch);
    REQUIRE(all.shots.size() == 200);
    for (std::size_t i = 0; i < 200; ++i) {
      const auto own = batch.echoes_of(shots[i]), found = all.echoes_of(all.shots[i]);
      CHECK(found.size() == std::max<std::size_t>(1, own.size()));
      for (std::size_t k = 0; k < own.size(); ++k) CHECK(found[k].range == own[k].range);
      if (own.empty()) CHECK(found[0].range == 5);
      CHECK(all.shots[i].fate == shots[i].fate);
      CHECK(all.waveform_of(all.shots[i]).data() == batch.waveform_of(shots[i]).data());
      CHECK(all.subrays_of(i).data() == batch.subrays_of(i).data());
    }
  }
  CHECK(points(EchoBatch{}).shots.empty());
}

TEST_CASE("a sink with misses reads empty shots, whatever the other sink does, and is closed with it") {
  const TemporaryFolder folder;
  const auto scene = plates();
  const auto survey = scan(scene);
  XyzWriter points(folder / "points.xyz");
  WithMisses<XyzWriter&> misses(points, {.range = 100});
  static_assert(ChoosesShots<WithMisses<XyzWriter&>> && ChoosesShots<MissTextWriter>);
  CHECK_FALSE(points.reads_empty_shots());
  CHECK(misses.reads_empty_shots());
  const RunSummary summary = run(survey, {}, misses);
  misses.close();
  const std::string text = content(folder / "points.xyz");
  CHECK(static_cast<PulseIndex>(std::count(text.begin(), text.end(), '\n')) == summary.pulses());
  static_assert(!ClosableSink<WithMisses<Cloud>>);

  // in LAS, too: return 1 of 1
  WithMisses las(LasWriter(folder / "points.las"), MissSettings{.range = 100});
  (void)run(survey, {}, las);
  las.close();
  const support::LasFile file = support::read_las(folder / "points.las");
  CHECK(file.points.size() == summary.pulses());
  std::uint64_t of_misses = 0;
  for (const auto& point : file.points) {
    CHECK(point.return_number == 1);
    CHECK(point.returns == 1);
    of_misses += point.classification == 64;
  }
  CHECK(of_misses + summary.count(Fate::returned) == summary.pulses());
}

TEST_CASE("ranges that cannot be are refused") {
  CHECK_THROWS_WITH_AS(MissPoints({.range = -1}), "MissSettings::range is -1 m, but must be from 0 to 1e+09",
                       SettingError);
  CHECK_THROWS_AS(MissTextWriter("nowhere/misses.txt"), FileError);
}

}  // namespace pulsecast::io
