// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/page.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::page;

namespace {

const support::TemporaryFolder folder;
const std::filesystem::path path = folder.path() / "page.html";

/// Gives n shots of one echo each to a sink.
void give(auto& writer, std::size_t n, std::size_t a_batch) {
  for (std::size_t begin = 0; begin < n; begin += a_batch) {
    std::vector<Shot> shots;
    std::vector<Echo> echoes;
    for (std::size_t i = begin; i < std::min(n, begin + a_batch); ++i) {
      shots.push_back({.index = i,
                       .tick = Tick::of(i, 1e4),
                       .origin = {static_cast<double>(i % 100), static_cast<double>(i / 100), 50},
                       .direction = -axis::up,
                       .first_echo = static_cast<std::uint32_t>(i - begin),
                       .echoes = 1});
      echoes.push_back(
          {.range = 50 + 0.01 * static_cast<double>(i % 7), .amplitude = 1e-6, .object = static_cast<ObjectId>(i % 5)});
    }
    EchoBatch batch;
    batch.shots = shots;
    batch.echoes = echoes;
    writer(batch);
  }
}

std::string page_of(const PageSurvey& survey, const PageSettings& settings = {}, std::size_t n = 5000,
                    std::size_t a_batch = 1000) {
  PageWriter writer(path, survey, settings);
  give(writer, n, a_batch);
  CHECK_FALSE(std::filesystem::exists(path));
  writer.close();
  std::string html = support::content(path);
  std::filesystem::remove(path);
  return html;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// What stands in the page's script of texts.
std::string survey_of(const std::string& html) {
  const std::string before = "id=\"survey\">";
  const auto at = html.find(before) + before.size();
  return html.substr(at, html.find("</script>", at) - at);
}

}  // namespace

TEST_CASE("a page is one whole file of HTML that asks for no other") {
  const std::string html = page_of({.name = "Hill"});
  CHECK(html.starts_with("<!DOCTYPE html>"));
  CHECK(html.ends_with("</html>\n"));
  CHECK(count(html, "default-src 'none'") == 1);
  CHECK(count(html, "http://") == 0);
  CHECK(count(html, "https://") == 0);
  CHECK(count(html, " src=") == 0);
  CHECK(count(html, "@import") == 0);
  CHECK(count(html, "<link ") == 1);  // which says that there is no icon
  CHECK(count(html, "</script>") == 3);
  CHECK(count(survey_of(html), "\"name\":\"Hill\"") == 1);
  CHECK(count(survey_of(html), "\"echoes\":5000,") == 1);
}

TEST_CASE("no word of a survey is taken for HTML or script") {
  const std::string evil = "</script><img src=x onerror=alert(1)><!--\"'&amp;";
  PageSurvey survey{.name = evil + "name", .scanner = evil + "scanner", .platform = evil + "platform"};
  survey.legs.push_back({evil + "leg", {0}, {{0, 0, 0}}});
  survey.objects[3] = evil + "object";
  const std::string html = page_of(survey);
  CHECK(count(html, "</script>") == 3);
  CHECK(count(html, "onerror=") == 5);
  const std::string texts = survey_of(html);
  CHECK(count(texts, "onerror=") == 5);
  for (const char* c : {"<", ">", "&", "'\"x"}) CHECK(count(texts, c) == 0);
}

TEST_CASE("the same echoes give the same bytes, however they come") {
  const PageSettings settings{.points_max = 1000};
  const std::string html = page_of({}, settings);
  CHECK(page_of({}, settings) == html);
  CHECK(page_of({}, settings, 5000, 17) == html);
  CHECK(page_of({}, settings, 5000, 5000) == html);
  CHECK(page_of({}, {.points_max = 999}) != html);
}

TEST_CASE("a page has the colours of its points, if its settings have them") {
  const PointColours colours = [](const EchoBatch&, const Shot& shot, const Echo&) {
    return PointColour{.red = static_cast<std::uint16_t>(shot.index * 10), .green = 257, .blue = 65535};
  };
  const std::string plain = page_of({}, {.points_max = 1000}),
                    coloured = page_of({}, {.points_max = 1000, .points = {.colours = colours}});
  PageSample sample(1000, {.colours = colours});
  give(sample, 5000, 1000);
  const std::string points = base64(page_columns(sample.points()));
  CHECK(count(coloured, points) == 1);
  CHECK(count(plain, points) == 0);
  CHECK(coloured.size() > plain.size());
}

TEST_CASE("no points give a page as well, and without close there is none") {
  CHECK(count(page_of({}, {}, 0), "</html>") == 1);
  {
    PageWriter writer(path);
    give(writer, 10, 10);
  }
  CHECK(folder.empty());
}

TEST_CASE("a leg that does not move is a set-up") {
  const PageLeg setup = page_leg("A", Tripod{.position = {1, 2, 3}}, Tick{10, 0}, Tick{5, 0});
  CHECK(setup.name == "A");
  REQUIRE(setup.places.size() == 1);
  CHECK(setup.places[0] == Vec3{1, 2, 3});
  CHECK(setup.times == std::vector<double>{10});
  const PageLeg flight =
      page_leg("B", StraightLine{.from = {0, 0, 0}, .to = {100, 0, 0}, .speed = 10}, Tick{20, 0}, Tick{10, 0}, 11);
  REQUIRE(flight.places.size() == 11);
  CHECK(flight.times[3] == doctest::Approx(23));
  CHECK(length(flight.places[3] - Vec3{30, 0, 0}) < 1e-9);
  CHECK(count(page_of({.legs = {setup, flight}}),
              R"({"name":"A","times":[10],"places":[[1,2,3]]},{"name":"B","times":[20,21,)") == 1);
}

TEST_CASE("settings that cannot be are refused") {
  CHECK_THROWS_AS(PageWriter(path, {}, {.points_max = 1}), SettingError);
  CHECK_THROWS_AS(PageWriter(path, {}, {.position_step = -1}), SettingError);
  CHECK_THROWS_AS(PageWriter(path, {}, {.effort = 10}), SettingError);
  CHECK_THROWS_AS(PageWriter(path / "no" / "folder.html"), FileError);
  CHECK(folder.empty());
}
