// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/laz.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/las.hpp>

#include "support/every_column.hpp"
#include "support/generators.hpp"
#include "support/laz_reader.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::LazFile;
using support::read_laz;
using support::TemporaryFolder;

/// Pulses from an airplane over hills, with up to three echoes each.
struct Pulses {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;

  explicit Pulses(std::size_t points, std::uint64_t channels = 1) {
    Generator random(points);
    while (echoes.size() < points) {
      const std::size_t i = shots.size();
      const double angle = 0.3 * std::sin(static_cast<double>(i) * 0.01);
      const auto of_shot = static_cast<std::uint32_t>(std::min(1 + random.whole(3), points - echoes.size()));
      shots.push_back({.index = i,
                       .tick = Tick::of(i, 1e5),
                       .origin = {6e5, 5e6 + 6e-4 * static_cast<double>(i), 1000},
                       .direction = {std::sin(angle), 0, -std::cos(angle)},
                       .scan_angle = angle,
                       .leg = static_cast<std::uint16_t>(i / 40'000),
                       .channel = static_cast<std::uint8_t>(random.whole(channels)),
                       .first_echo = static_cast<std::uint32_t>(echoes.size()),
                       .echoes = of_shot});
      for (std::uint32_t k = 0; k < of_shot; ++k)
        echoes.push_back({.range = 990 / std::cos(angle) + 3 * k + random.uniform(),
                          .amplitude = random.log_uniform(1e-9, 1e-6),
                          .reflectance = random.uniform(),
                          .object = static_cast<ObjectId>(random.whole(100)),
                          .classification = static_cast<std::uint16_t>(random.whole(8)),
                          .number = static_cast<std::uint8_t>(k + 1),
                          .kind = static_cast<ReflectionKind>(random.whole(reflection_kind_count))});
    }
  }

  template <class Writer>
  void write(Writer writer, std::size_t pulses_at_once = 1'000) const {
    for (std::size_t first = 0; first < shots.size(); first += pulses_at_once)
      writer(EchoBatch{std::span(shots).subspan(first, std::min(pulses_at_once, shots.size() - first)), echoes, {}, 0});
    writer.close();
  }

  /// Writes both, and checks that the compressed file holds what the other does, byte for byte.
  LazFile same(const LasSettings& settings = {}) const {
    const TemporaryFolder folder;
    write(LasWriter(folder / "points.las", settings));
    write(LazWriter(folder / "points.laz", settings));
    LazFile laz = read_laz(content(folder / "points.laz"));
    const std::string las = content(folder / "points.las");
    CHECK(laz.las.size() == las.size());
    CHECK(laz.las == las);
    CHECK(std::distance(std::filesystem::directory_iterator(folder / "."), {}) == 2);
    return laz;
  }
};

TEST_CASE("a file without points has no chunk, and all else") { CHECK(Pulses(0).same({.epsg = 25832}).chunks.empty()); }

TEST_CASE("a LAZ file holds what the LAS file does, around the size of a chunk as elsewhere") {
  for (const std::size_t points : {1U, 2U, 49'999U, 50'000U, 50'001U, 110'000U}) {
    CAPTURE(points);
    const LazFile file = Pulses(points).same();
    CHECK(file.chunks.size() == (points + 49'999) / 50'000);
    CHECK(file.chunks.back().points == (points - 1) % 50'000 + 1);
  }
}

TEST_CASE("and with several scanner channels, and with whatever else may be set") {
  Pulses(20'000, 4).same();
  Pulses(3'000).same(
      {.scale = 1e-2, .offset = Vec3{1, 2, 3}, .wkt = "LOCAL_CS[]", .gps_time = GpsTime::week, .start_time = 1e8});
  Pulses(3'000).same({.light_kinds = true});
  Pulses(3'000).same({.epsg = 31467, .intensity = LasIntensity::amplitude, .intensity_full_scale = 1e-7});
}

TEST_CASE("and with every column of the table") {
  const support::EveryColumn all;
  Pulses(3'000).same({.columns = all.fields, .points = all.settings});
}

/// Settings with colours of all kinds: grey, none, in 8 bits, in 16 bits.
LasSettings of_colours(bool near_infrared) {
  return {.colours = [](const EchoBatch&, const Shot& shot, const Echo& echo) -> std::optional<PointColour> {
            const auto a = static_cast<std::uint16_t>(echo.reflectance * 65535),
                       b = static_cast<std::uint16_t>(shot.index * 7);
            switch (shot.index / 500 % 4) {
              case 0:
                return PointColour{a, a, a, b};
              case 1:
                return std::nullopt;
              case 2:
                return PointColour{static_cast<std::uint16_t>(a % 256 * 256), static_cast<std::uint16_t>(b % 256 * 256),
                                   256, 0};
              default:
                return PointColour{a, b, static_cast<std::uint16_t>(a + b), a};
            }
          },
          .near_infrared = near_infrared};
}

TEST_CASE("colours and the near infrared are those of the LAS file, with one scanner channel and with several") {
  for (const bool near_infrared : {false, true})
    for (const unsigned channels : {1U, 4U}) {
      CAPTURE(near_infrared);
      CAPTURE(channels);
      const LazFile file = Pulses(20'000, channels).same(of_colours(near_infrared));
      CHECK(file.las[104] == (near_infrared ? 8 : 7));
      CHECK(file.chunks.at(0).layers.at(9) > 10'000);
      if (near_infrared) CHECK(file.chunks.at(0).layers.at(10) > 5'000);
    }
}

TEST_CASE("a colour that never changes takes no byte, nor does an attribute") {
  LasSettings settings{.colours =
                           [](const EchoBatch&, const Shot&, const Echo&) {
                             return PointColour{1, 2, 3, 4};
                           },
                       .near_infrared = true};
  struct Tree {
    ObjectId object = 1000;  // no echo is of it
    Attributes attributes = pulsecast::attributes({{"age", 80}});
  } tree;
  settings.attributes = std::make_shared<const ObjectAttributes>(std::span<const Tree>(&tree, 1));
  const LazFile file = Pulses(3'000).same(settings);
  const std::vector<std::size_t>& layers = file.chunks.at(0).layers;
  REQUIRE(layers.size() == 9 + 2 + 32 + 8);
  CHECK((layers[9] == 0 && layers[10] == 0));
  CHECK(std::all_of(layers.end() - 8, layers.end(), [](std::size_t size) { return size == 0; }));
}

TEST_CASE("intensities that are scaled to the greatest amplitude are those of the LAS file") {
  Pulses(60'000).same({.intensity = LasIntensity::amplitude});
  Pulses(0).same({.intensity = LasIntensity::amplitude});
}

TEST_CASE("the bytes are the same for any number of threads, and however the points came") {
  const TemporaryFolder folder;
  const Pulses pulses(260'000);
  pulses.write(LazWriter(folder / "1", {}, 1));
  const std::string one = content(folder / "1");
  for (const unsigned threads : {0U, 2U, 3U, 7U}) {
    CAPTURE(threads);
    pulses.write(LazWriter(folder / "n", {}, threads), 1 + 777 * threads);
    CHECK(content(folder / "n") == one);
  }
}

TEST_CASE("formats that are not compressed, and waveforms, are refused before there is a file") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(LazWriter(folder / "a", {.format = LasFormat::las_1_4_legacy}),
                       doctest::Contains("LasSettings::format"), SettingError);
  CHECK_THROWS_WITH_AS(LazWriter(folder / "a", {.format = LasFormat::las_1_0}),
                       doctest::Contains("LasSettings::format"), SettingError);
  CHECK_THROWS_WITH_AS(LazWriter(folder / "a", {.waveforms = true}), doctest::Contains("LasSettings::waveforms"),
                       SettingError);
  CHECK_THROWS_WITH_AS(LazWriter(folder / "a", {.scale = 0}), doctest::Contains("LasSettings::scale"), SettingError);
  CHECK(std::filesystem::is_empty(folder / "."));
}

TEST_CASE("a writer that is not closed, or that failed, leaves nothing behind") {
  const TemporaryFolder folder;
  const Pulses pulses(60'000);
  const EchoBatch batch{pulses.shots, pulses.echoes, {}, 0};
  for (const LasIntensity intensity : {LasIntensity::reflectance, LasIntensity::amplitude}) {
    {
      LazWriter writer(folder / "points.laz", {.intensity = intensity}, 1);
      writer(batch);
      CHECK_FALSE(std::filesystem::exists(folder / "points.laz"));
    }
    CHECK(std::filesystem::is_empty(folder / "."));
    {
      LazWriter writer(folder / "points.laz", {.intensity = intensity}, 1);
      Shot far = pulses.shots[0];
      far.echoes = 1;
      writer(batch);
      far.origin.x = 1e9;
      const std::vector<Shot> one{far};
      CHECK_THROWS_WITH_AS(writer(EchoBatch{one, pulses.echoes, {}, 0}), doctest::Contains("point 60001: x is"),
                           FileError);
      CHECK_THROWS_AS(writer.close(), FileError);
    }
    CHECK(std::filesystem::is_empty(folder / "."));
  }
}

TEST_CASE("a writer may be moved half-way") {
  const TemporaryFolder folder;
  const Pulses pulses(60'000);
  pulses.write(LazWriter(folder / "a"));
  LazWriter first(folder / "b");
  first(EchoBatch{std::span(pulses.shots).first(10'000), pulses.echoes, {}, 0});
  LazWriter second(std::move(first));
  second(EchoBatch{std::span(pulses.shots).subspan(10'000), pulses.echoes, {}, 0});
  second.close();
  CHECK(content(folder / "a") == content(folder / "b"));
}

TEST_CASE("the chunk table tells the sizes of the chunks") {
  for (const std::vector<std::size_t>& sizes :
       std::vector<std::vector<std::size_t>>{{}, {1}, {900'000, 1'000'000, 3}}) {
    const std::vector<std::byte> bytes = detail::laz_chunk_table(sizes);
    const std::string table(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    CHECK(support::detail::laz_whole(table, 0, 4) == 0);
    CHECK(support::detail::laz_whole(table, 4, 4) == sizes.size());
    if (sizes.empty()) continue;
    support::LazDecoder decoder(table.substr(8));
    support::LazNumbers numbers(32);
    std::int64_t last = 0;
    for (const std::size_t size : sizes)
      CHECK((last = numbers.decode(decoder, last, 1)) == static_cast<std::int64_t>(size));
    CHECK(decoder.at_end());
  }
}

}  // namespace
}  // namespace pulsecast::io
