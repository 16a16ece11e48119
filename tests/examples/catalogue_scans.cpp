// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Lets every scanner of the catalogue scan a plane.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/survey.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::helios;

namespace {

const std::filesystem::path catalogue = std::filesystem::absolute(__FILE__).parent_path() / "../../examples/catalogue";

/// The plane z = 0, half of white.
struct Floor {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range < ray.far)) return std::nullopt;
    const double cosine = std::fabs(ray.direction.z);
    return Hit{.range = range, .cos_incidence = cosine, .backscatter = 0.5 * cosine, .object = 1};
  }
};

AssetDocument read(const std::string& name) {
  return read_assets(catalogue / "data" / (name + ".xml"), {.assets = {catalogue}});
}

/// How high above ground it works, and how fast it is carried.
struct Place {
  std::string platform;
  double height = 0, speed = 0;  ///< [m], [m/s]
};

Place place_of(const std::string& document, const ScannerSettings& scanner) {
  const ChannelSettings& channel = scanner.channels.front();
  if (document == "scanners_space") return {"satellite", 415e3, 7200};
  if (document == "scanners_mls") return {"vehicle_linearpath", 0, 10};
  if (scanner.id == "tractorscanner") return {"vehicle_linearpath", 0, 2};
  for (const char* maker : {"dji", "livox", "riegl_vux", "riegl_minivux"})
    if (document == "scanners_als" && scanner.id.starts_with(maker)) return {"copter_linearpath", 40, 5};
  if (document == "scanners_als")
    return {"sr22", std::clamp(0.3 * channel.range_max, 2 * channel.range_min, 1000.0), 20};
  return {"tripod", 0, 0};
}

double scan_rate_of(const ScannerSettings& scanner) {
  const ChannelSettings& channel = scanner.channels.front();
  if (channel.scan_rate_max > 0) return 0.5 * (channel.scan_rate_min + channel.scan_rate_max);
  const bool head_scans =
      channel.scan_angle_max >= pi && (scanner.channels.size() > 1 || channel.head_rate_max > radians(3600));
  return std::holds_alternative<RotatingOptic>(channel.optic) && head_scans ? 0 : std::max(20.0, channel.scan_rate_min);
}

SurveySettings survey_of(const std::string& document, const ScannerSettings& scanner,
                         const std::vector<PlatformSettings>& platforms) {
  SurveySettings survey{.name = scanner.id, .scanner = scanner};
  const Place place = place_of(document, scanner);
  const auto platform =
      std::find_if(platforms.begin(), platforms.end(), [&](const auto& p) { return p.id == place.platform; });
  REQUIRE(platform != platforms.end());
  survey.platform = *platform;
  const double head_rate = std::min(scanner.channels.front().head_rate_max, radians(3600));
  LegSettings leg;
  leg.duration_max = 2;
  leg.platform.position = {0, 0, place.height};
  leg.platform.speed = place.speed;
  leg.scanner.pulse_rate = scanner.pulse_rates.front();
  leg.scanner.scan_rate = scan_rate_of(scanner);
  leg.scanner.head_rate = head_rate;
  if (place.speed == 0 && head_rate > 0) leg.scanner.head_stop = 2 * head_rate;  // for as long
  survey.legs.push_back(leg);
  if (place.speed > 0) {
    leg.platform.position.y += 2 * place.speed;
    survey.legs.push_back(leg);
  }
  return survey;
}

/// What a scan of some hundred pulses came to.
struct Scan {
  int pulses = 0, echoes = 0;
};

Scan scan(const SurveySettings& survey) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  const CompiledSurvey compiled = compile_survey(survey, ground);
  const Floor floor;
  const auto receiver = [](const ChannelSettings& channel) -> ReceiverUnit<RingFootprint, FullWaveform<>> {
    return {RingFootprint(2), survey_receiver(channel), FullWaveform(survey_waveform(channel))};
  };
  const Survey run(compiled.source, ReceiverGroups(survey.scanner).units(survey.scanner, receiver), floor, 7);
  auto workspace = run.workspace();
  Scan out;
  const PulseIndex slots = run.size(), step = std::max<PulseIndex>(1, slots / 1200) | 1;
  CHECK(compiled.legs.front().pulse_rate == survey.scanner.pulse_rates.front());
  CHECK(slots >= survey.scanner.channels.size());
  for (PulseIndex i = 0; i < slots && out.pulses < 600; i += step) {
    const Outcome o = run(i, workspace);
    if (o.shot.fate == Fate::blocked) continue;
    ++out.pulses;
    CAPTURE(i);
    REQUIRE(o.shot.channel < survey.scanner.channels.size());
    const ChannelSettings& channel = survey.scanner.channels[o.shot.channel];
    for (const Echo& echo : o.echoes) {
      ++out.echoes;
      const double noise = 6 * channel.accuracy, down = -o.shot.direction.z;
      REQUIRE(echo.range >= channel.range_min - noise);
      REQUIRE(echo.range <= channel.range_max + noise);
      if (down < 0.1) continue;  // the footprint is drawn out
      const double range = o.shot.origin.z / down,
                   along = range * channel.divergence * std::sqrt(std::fmax(0.0, 1 - down * down)) / down;
      REQUIRE(std::fabs(echo.range - range) <= noise + along + 1e-3 * channel.pulse_length * 1e9 + 1e-3);
    }
  }
  return out;
}

TEST_CASE("every scanner of the catalogue scans a plane, at the rates that it is made for") {
  const std::vector<PlatformSettings> platforms = read("platforms").platforms;
  std::size_t scanners = 0;
  for (const std::string document : {"scanners_als", "scanners_mls", "scanners_space", "scanners_tls"}) {
    const AssetDocument assets = read(document);
    CHECK(assets.warnings.empty());
    for (const ScannerSettings& scanner : assets.scanners) {
      CAPTURE(document);
      CAPTURE(scanner.id);
      ++scanners;
      SurveySettings survey = survey_of(document, scanner, platforms);
      Scan found;
      REQUIRE_NOTHROW(found = scan(survey));
      CAPTURE(found.pulses);
      CHECK(found.pulses >= 100);
      CHECK(found.echoes >= 20);
      for (const ChannelSettings& channel : scanner.channels) {
        CHECK(channel.scan_rate_min <= survey.legs.front().scanner.scan_rate);
        CHECK((channel.scan_rate_max == 0 || survey.legs.front().scanner.scan_rate <= channel.scan_rate_max));
      }
      if (scanner.channels.front().scan_rate_max == 0) continue;
      survey.legs.front().scanner.scan_rate = 1.01 * scanner.channels.front().scan_rate_max;
      CHECK_THROWS_AS((void)compile_survey(survey, [](const Vec2&) -> std::optional<double> { return 0; }),
                      SettingError);
    }
  }
  CHECK(scanners >= 59);
}

TEST_CASE("every platform of the catalogue goes where it is sent") {
  const ScannerSettings scanner = read("scanners_tls").scanners.front();
  for (const PlatformSettings& platform : read("platforms").platforms) {
    CAPTURE(platform.id);
    SurveySettings survey{.scanner = scanner, .platform = platform};
    for (const double y : {0.0, 40.0}) {
      LegSettings leg{.duration_max = 60};
      leg.platform.position = {5, y, 10};
      leg.platform.speed = 4;
      leg.scanner.scan_rate = scan_rate_of(scanner);
      survey.legs.push_back(leg);
    }
    const CompiledSurvey compiled = compile_survey(survey, [](const Vec2&) -> std::optional<double> { return 10; });
    const SurveyLeg& leg = compiled.source.legs().front();
    const Vec3 from = leg.path().at({}).position, to = leg.path().at(leg.duration()).position;
    CHECK(length(from - Vec3{5, 0, 10}) < 0.5);
    if (platform.kind != PlatformKind::stationary) CHECK(length(to - Vec3{5, 40, 10}) < 0.5);
  }
}

}  // namespace
