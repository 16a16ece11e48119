// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "pages.hpp"

#include <algorithm>
#include <optional>

#include <pulsecast/page/page.hpp>

#include "parts.hpp"

using namespace pulsecast;

struct Pages::Inside {
  page::PageSettings settings{};
  bool file = false;
  page::PageSurvey survey{};
  std::optional<page::PageWriter> writer{};
  std::unique_ptr<LivePage> server{};
};

Pages::Pages(const Options& options, const helios::SurveySettings& survey) : inside_(new Inside) {
  const auto name = [](const std::string& full, const std::string& id) { return full.empty() ? id : full; };
  inside_->settings.points_max = options.page_points;
  inside_->file = options.page;
  inside_->survey = {.name = survey.name,
                     .scanner = name(survey.scanner.name, survey.scanner.id),
                     .platform = name(survey.platform.name, survey.platform.id)};
  if (options.live) inside_->server = part<LivePart>().page(inside_->survey, inside_->settings);
}
Pages::~Pages() = default;

std::string Pages::address() const { return inside_->server ? inside_->server->address() : ""; }

void Pages::begin(const std::filesystem::path& folder, const helios::CompiledSurvey& compiled, const Options& options) {
  if (!inside_->file && !inside_->server) return;
  inside_->settings.columns = options.fields;
  inside_->settings.points = options.points;
  if (!options.colours && !io::PointLayout::packed(options.fields).needs(io::PointNeed::colour))
    inside_->settings.points.colours = {};  // a page has colours if these have
  page::PageSurvey survey = inside_->survey;
  const int moments = std::clamp(static_cast<int>(40'000 / std::max<std::size_t>(compiled.legs.size(), 1)), 2, 1000);
  for (std::size_t k = 0; k < compiled.legs.size(); ++k) {
    const helios::CompiledSurvey::Leg& leg = compiled.legs[k];
    const std::string name =
        leg.strip ? "strip " + *leg.strip + ", leg " + std::to_string(leg.number) : "leg " + std::to_string(leg.number);
    survey.legs.push_back(page::page_leg(name, compiled.source.legs()[k].path(), leg.start, leg.duration, moments));
  }
  if (inside_->file) inside_->writer.emplace(folder / "page.html", survey, inside_->settings);
  if (inside_->server) inside_->server->begin(std::move(survey), inside_->settings);
}

void Pages::operator()(const EchoBatch& batch) {
  if (inside_->writer) (*inside_->writer)(batch);
  if (inside_->server) (*inside_->server)(batch);
}

void Pages::show(const Progress& progress) {
  if (inside_->server) inside_->server->show(progress);
}

bool Pages::stop_requested() const { return inside_->server && inside_->server->stop_requested(); }

void Pages::end() {
  if (inside_->writer) inside_->writer->close();
  inside_->writer.reset();
}

void Pages::finish(bool complete) {
  if (inside_->server) inside_->server->finish(complete);
}
