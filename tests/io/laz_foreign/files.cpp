// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes the same points as LAS and as LAZ, in pairs of files, for other programs to read and compare. Usage: files
// FOLDER. With the environment variable PULSECAST_LAZ_POINTS, only a survey of about so many points.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/laz.hpp>
#include <pulsecast/pulsecast.hpp>

#include "support/generators.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::io;
namespace fs = std::filesystem;

namespace {

/// Which values of a point change, and how: with the chance given, to anything, or to a neighbour.
void change(std::span<std::uint8_t> record, support::Generator& random, double chance, unsigned channels) {
  const auto any = [&](std::size_t from, std::size_t bytes) {
    if (random.uniform() > chance) return;
    if (random.coin()) {
      for (std::size_t i = from; i < from + bytes; ++i) record[i] = static_cast<std::uint8_t>(random.whole(256));
    } else {
      record[from] = static_cast<std::uint8_t>(record[from] + random.whole(7) - 3);
    }
  };
  for (std::size_t at : {0U, 4U, 8U}) any(at, 4);
  any(12, 2);
  any(14, 1);
  any(15, 1);
  any(16, 1);
  any(17, 1);
  any(18, 2);
  any(20, 2);
  const std::uint64_t channel = channels == 1 ? 2 : random.whole(channels);
  record[15] = static_cast<std::uint8_t>((record[15] & ~48U) | channel << 4);
  for (std::size_t i = 30; i < record.size(); ++i) any(i, 1);
}

/// Makes green and blue as red is.
void make_grey(std::span<std::uint8_t> record) {
  for (const std::size_t at : {32U, 34U}) std::memcpy(record.data() + at, record.data() + 30, 2);
}

/// Times that go on in even steps, in steps of all sizes, back, not at all, and in several series at once.
void change_time(std::span<std::uint8_t> record, support::Generator& random, std::vector<std::uint64_t>& series) {
  std::uint64_t& time = series[random.uniform() < 0.9 ? 0 : random.whole(series.size())];
  const double kind = random.uniform();
  if (kind < 0.3)
    time += 1000;
  else if (kind < 0.5)
    time += 1000 * random.whole(1200) - 20'000 + random.whole(3);
  else if (kind < 0.55)
    time +=
        static_cast<std::uint64_t>(static_cast<std::int64_t>(random.log_uniform(1, 1e18) * (random.coin() ? 1 : -1)));
  else if (kind < 0.56)
    time = random.whole(std::uint64_t{1} << 52) << 12;
  std::memcpy(record.data() + 22, &time, sizeof time);
}

/// Colours without meaning: what they are is not asked where records are made here.
const PointColours any_colour = [](const EchoBatch&, const Shot&, const Echo&) { return PointColour{}; };

/// The files of no point are made by the writers; records of any bytes then follow, which no echo would give.
void write_random(const fs::path& folder, const std::string& name, std::size_t points, double chance, unsigned channels,
                  const LasSettings& settings = {}) {
  const fs::path las = folder / (name + ".las"), laz = folder / (name + ".laz");
  LasWriter(las, settings).close();
  LazWriter(laz, settings).close();
  const auto count_points = [&](std::string file) {
    const std::uint64_t count = points;
    std::memcpy(file.data() + 247, &count, sizeof count);
    return file;
  };
  const std::string las_head = count_points(support::content(las)), laz_head = count_points(support::content(laz));
  OutputFile las_file(las), laz_file(laz);
  las_file.write(las_head);
  laz_file.write(std::string_view(laz_head).substr(0, laz_head.size() - 16));  // table, and its place
  io::detail::LazRecords records(2);
  records.begin(laz_file, io::detail::LasLayout(settings), false);
  support::Generator random(points + channels);
  std::vector<std::uint8_t> record(LasEncoder::record_size(settings));
  std::vector<std::uint64_t> series(6);
  for (std::size_t i = 0; i < points; ++i) {
    change(record, random, i == 0 ? 1 : chance, channels);
    if (settings.colours && random.coin()) make_grey(record);
    change_time(record, random, series);
    const auto bytes = std::as_bytes(std::span(record));
    las_file.write(bytes);
    records.write(laz_file, bytes);
  }
  records.finish(laz_file);
  las_file.commit();
  laz_file.commit();
}

/// Hills with leaves above, from an airplane.
void write_survey(const fs::path& folder, const std::string& name, PulseIndex pulses, const LasSettings& settings) {
  support::Generator random(1);
  MeshData mesh = support::net(100, [](double x, double y) { return 8 * std::sin(x / 9) * std::cos(y / 7); });
  for (std::size_t i = 0; i < 30'000; ++i) {
    const Vec3 at{random.uniform(0, 100), random.uniform(0, 100), random.uniform(5, 25)};
    support::add_triangle(mesh, {at, at + random.point(0.5), at + random.point(0.5)});
  }
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh))}});
  const Laser laser{.wavelength = 1550_nm, .peak_power = 5000_W, .pulse_length = 3_ns, .divergence = 1_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = pulses, .laser = laser};
  const Platform airplane{
      StraightLine{.from = {50, 10, 300}, .to = {50, 90, 300}, .speed = 80 / scanner.duration().seconds()},
      Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
      Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 9_deg}, scanner}};
  LasWriter las(folder / (name + ".las"), settings);
  LazWriter laz(folder / (name + ".laz"), settings);
  run(Survey{airplane, SunflowerFootprint{7}, scene, Receiver{}, FullWaveform{{.record_length = 20_ns}}}, {}, las, laz);
  las.close();
  laz.close();
}

/// Colours by height, none of every third pulse, and attributes of the one object.
LasSettings of_heights() {
  Part<TriangleMesh<>> part;
  part.attributes = attributes({{"height of the trunk", 17.5}, {"age", 80}});
  return {.colours = [](const EchoBatch&, const Shot& shot, const Echo& echo) -> std::optional<PointColour> {
            if (shot.index % 3 == 0) return std::nullopt;
            const auto high = static_cast<std::uint16_t>(200 * point_of(shot, echo).z + 2000);
            return PointColour{high, static_cast<std::uint16_t>(2 * high), 300, static_cast<std::uint16_t>(shot.index)};
          },
          .near_infrared = true,
          .attributes = std::make_shared<const ObjectAttributes>(std::span<const Part<TriangleMesh<>>>(&part, 1))};
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const fs::path folder = words[1];
  fs::create_directories(folder);
  if (const char* const points = std::getenv("PULSECAST_LAZ_POINTS")) {
    write_survey(folder, "large", std::strtoull(points, nullptr, 10) * 7 / 10, {});
    return 0;
  }
  for (const std::size_t points : {0u, 1u, 2u, 49'999u, 50'000u, 50'001u})
    write_random(folder, "any_" + std::to_string(points), points, 1, 4);
  write_random(folder, "calm", 60'000, 0.1, 1);
  write_random(folder, "calm_channels", 60'000, 0.1, 4);
  write_random(folder, "still", 60'000, 0.001, 2);
  const LasSettings colours{.colours = any_colour}, near_infrared{.colours = any_colour, .near_infrared = true};
  for (const unsigned channels : {1U, 4U}) {
    const std::string by = std::to_string(channels);
    for (const double chance : {1.0, 0.1, 0.001}) {
      write_random(folder, "colours_" + by + '_' + std::to_string(chance), 20'000, chance, channels, colours);
      write_random(folder, "near_infrared_" + by + '_' + std::to_string(chance), 20'000, chance, channels,
                   near_infrared);
    }
  }
  write_survey(folder, "survey_colours", 20'000, of_heights());
  write_survey(folder, "survey", 100'000, {.epsg = 25832, .start_time = 3e8});
  write_survey(folder, "survey_amplitude", 10'000, {.intensity = LasIntensity::amplitude});
}
