// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Makes pages for check.mjs. Usage: `pages FOLDER` leaves page.html and points.json, which has what should be read from
// the page; with a number of shots behind it, only the page, of all their echoes, 5 for 4 shots; `pages live SHOTS`
// serves a page of so many shots, says where, and says at the end whether it was stopped.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <pulsecast/page/page.hpp>
#include <pulsecast/page/server.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>

using namespace pulsecast;

namespace {

const std::string evil = "</script><img src=x onerror=\"window.hurt=1\">";

page::PageSurvey survey() {
  page::PageSurvey out{.name = evil + "survey", .scanner = evil + "scanner", .platform = "Tripod & car"};
  out.legs.push_back(page::page_leg(evil + "leg", Tripod{.position = {0, 0, 15}}, {}, Tick{1, 0}));
  out.legs.push_back(page::page_leg("drive", StraightLine{.from = {-20, -10, 2}, .to = {20, -10, 2}, .speed = 40},
                                    Tick{1, 0}, Tick{1, 0}));
  out.objects[2] = evil + "object";
  return out;
}

/// Shots of one or two echoes each, on a hill of 40 m by 40 m, half of them by each leg.
struct Shots {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;

  Shots(PulseIndex first, PulseIndex end, PulseIndex all) {
    for (PulseIndex i = first; i < end; ++i) {
      const double u = std::fmod(static_cast<double>(i) * 0.618033988749895, 1.0),
                   v = static_cast<double>(i) / static_cast<double>(all);
      const Vec3 at{40 * u - 20, 40 * v - 20, 4 * std::sin(6 * u) * std::cos(5 * v)};
      const auto leg = static_cast<std::uint16_t>(i * 2 >= all ? 1 : 0);
      const Vec3 from = leg == 0 ? Vec3{0, 0, 15} : Vec3{40 * (2 * v - 1) - 20, -10, 15};
      const std::uint32_t number = i % 4 == 0 ? 2 : 1;
      shots.push_back({.index = 3 * i,
                       .tick = Tick::of(2 * i, static_cast<double>(all)),
                       .origin = from,
                       .direction = normalize(at - from),
                       .scan_angle = u - 0.5,
                       .leg = leg,
                       .channel = static_cast<std::uint8_t>(i % 2),
                       .first_echo = static_cast<std::uint32_t>(echoes.size()),
                       .echoes = number});
      for (std::uint32_t k = 1; k <= number; ++k)
        echoes.push_back({.range = length(at - from) - 2.0 * (number - k),
                          .amplitude = 1e-6 * (1 + v) / k,
                          .reflectance = 0.2 + 0.5 * u,
                          .width = 1e-9 + 1e-9 * v,
                          .cos_incidence = 0.5 + 0.4 * u,
                          .object = static_cast<ObjectId>(i % 3),
                          .classification = static_cast<std::uint16_t>(2 + i % 5),
                          .number = static_cast<std::uint8_t>(k),
                          .kind = static_cast<ReflectionKind>(i % reflection_kind_count)});
    }
  }
  [[nodiscard]] EchoBatch batch() const { return {shots, echoes, {}, 0}; }
};

/// Red and green by the place in a batch of all shots; unknown of every 50th shot.
std::optional<PointColour> colour_of_shot(const EchoBatch&, const Shot& shot, const Echo& echo) {
  if (shot.index % 50 == 0) return std::nullopt;
  return PointColour{.red = static_cast<std::uint16_t>(shot.leg == 0 ? 65535 : 0),
                     .green = static_cast<std::uint16_t>(shot.leg == 0 ? 0 : 257 * (shot.index % 200)),
                     .blue = static_cast<std::uint16_t>(257 * echo.number)};
}

void write_truth(const std::string& path, const page::PagePoints& all) {
  std::ofstream out(path);
  out.precision(17);
  out << '[';
  const auto write = [&](double value) { std::isnan(value) ? out << "null" : out << value; };
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const page::PagePoint& p = all.points[i];
    out << (i == 0 ? "" : ",\n") << "{\"x\":" << p.position.x << ",\"y\":" << p.position.y << ",\"z\":" << p.position.z
        << ",\"time\":" << p.time << ",\"pulse\":" << p.pulse
        << ",\"range\":" << std::hypot(p.to_instrument[0], p.to_instrument[1], p.to_instrument[2]);
    for (std::size_t k = 0; k < all.columns.size(); ++k) {
      out << ",\"" << all.columns[k].field.name << "\":";
      write(all.value(i, k));
    }
    out << '}';
  }
  out << "]\n";
}

int live(PulseIndex all) {
  page::PageServer server;
  server.begin(survey());
  std::cout << server.address() << std::endl;
  PulseIndex done = 0;
  for (constexpr PulseIndex a_batch = 500; done < all && !server.stop_requested(); done += a_batch) {
    server(Shots(done, std::min(all, done + a_batch), all).batch());
    server.show(
        {.done = done + a_batch, .total = all, .echoes = done, .seconds = 0.05 * static_cast<double>(done) / a_batch});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  server.finish(done >= all);
  std::cout << (server.stop_requested() ? "stopped" : "complete") << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "live") return live(std::strtoull(argv[2], nullptr, 10));
  if (argc != 2 && argc != 3) return 2;
  const std::string folder = argv[1];
  if (argc == 3) {
    const PulseIndex all = std::strtoull(argv[2], nullptr, 10);
    page::PageWriter writer(folder + "/page.html", survey(), {.points_max = 2 * all + 2});
    for (PulseIndex i = 0; i < all; i += 10'000) writer(Shots(i, std::min(all, i + 10'000), all).batch());
    writer.close();
    return 0;
  }
  const Shots shots(0, 60'000, 60'000);
  page::PageWriter writer(folder + "/page.html", survey(),
                          {.points_max = 70'000, .points = {.colours = colour_of_shot}});
  page::PageSample sample(70'000, {.colours = colour_of_shot});
  writer(shots.batch());
  sample(shots.batch());
  writer.close();
  write_truth(folder + "/points.json", sample.points());
}
