// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "pages.hpp"

#include <algorithm>

#include <pulsecast/page/page.hpp>

#include "parts.hpp"

using namespace pulsecast;

namespace {

page::PageSurvey described(const helios::SurveySettings& survey) {
  const auto name = [](const std::string& full, const std::string& id) { return full.empty() ? id : full; };
  return {.name = survey.name,
          .scanner = name(survey.scanner.name, survey.scanner.id),
          .platform = name(survey.platform.name, survey.platform.id)};
}

page::PageSurvey described(const helios::SurveySettings& settings, const helios::CompiledSurvey& compiled) {
  page::PageSurvey survey = described(settings);
  const int moments = std::clamp(static_cast<int>(40'000 / std::max<std::size_t>(compiled.legs.size(), 1)), 2, 1000);
  for (std::size_t k = 0; k < compiled.legs.size(); ++k) {
    const helios::CompiledSurvey::Leg& leg = compiled.legs[k];
    const std::string name =
        leg.strip ? "strip " + *leg.strip + ", leg " + std::to_string(leg.number) : "leg " + std::to_string(leg.number);
    survey.legs.push_back(page::page_leg(name, compiled.source.legs()[k].path(), leg.start, leg.duration, moments));
  }
  return survey;
}

page::PageSettings page_settings(const Options& options) {
  page::PageSettings settings{.points_max = options.page_points, .columns = options.fields, .points = options.points};
  if (!options.colours && !io::PointLayout::packed(options.fields).needs(io::PointNeed::colour))
    settings.points.colours = {};  // a page has colours if these have
  return settings;
}

}  // namespace

std::unique_ptr<PointFile> page_file(const std::filesystem::path& path, const helios::SurveySettings& survey,
                                     const helios::CompiledSurvey& compiled, const Options& options) {
  return std::make_unique<WrittenFile<page::PageWriter>>(path, described(survey, compiled), page_settings(options));
}

struct Pages::Inside {
  bool file = false;
  helios::SurveySettings survey{};
  std::unique_ptr<PointFile> writer{};
  std::unique_ptr<LivePage> server{};
};

Pages::Pages(const Options& options, const helios::SurveySettings& survey)
    : inside_(new Inside{.file = options.page, .survey = survey}) {
  if (options.live) inside_->server = part<LivePart>().page(described(survey), {.points_max = options.page_points});
}
Pages::~Pages() = default;

std::string Pages::address() const { return inside_->server ? inside_->server->address() : ""; }

void Pages::begin(const std::filesystem::path& folder, const helios::CompiledSurvey& compiled, const Options& options) {
  if (inside_->file) inside_->writer = page_file(folder / "page.html", inside_->survey, compiled, options);
  if (inside_->server) inside_->server->begin(described(inside_->survey, compiled), page_settings(options));
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
