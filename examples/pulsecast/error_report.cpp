// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "error_report.hpp"

#include <array>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <utility>

#include <pulsecast/base/error.hpp>
#include <pulsecast/io/misses.hpp>
#include <pulsecast/page/detail/json.hpp>
#include <pulsecast/version.hpp>

#include "estimate_text.hpp"
#include "survey_inputs.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using page::detail::JsonWriter;

namespace {

void add(JsonWriter& json, const EchoErrors& errors) {
  json.begin_object();
  for (std::size_t f = 0; f < error_figure_count; ++f) {
    const Estimate& e = errors.figures[f];
    json.key(error_figure_names[f]).begin_object();
    json.member("value", e.value).member("low", e.low).member("high", e.high);
    json.member("unit", error_figure_units[f]).end_object();
  }
  json.member("pairs", errors.pairs).member("lost_echoes", errors.lost).member("invented_echoes", errors.invented);
  json.end_object();
}

std::string report_of(const RunErrors& errors, const RunOrigin& origin, const RunSummary& run) {
  JsonWriter json;
  json.begin_object().member("program", "pulsecast").member("version", PULSECAST_VERSION);
  json.member("seed", origin.seed).member("repetition", origin.repetition);
  json.member("options", origin.options).member("settings", origin.settings);
  if (!origin.chosen.empty()) json.member("chosen_settings", origin.chosen);
  json.key("inputs").begin_object();
  for (const auto& [path, digest] : origin.inputs)
    if (digest != hex(io::Fingerprint{})) json.member(path, digest);  // those that are there
  json.end_object().key("totals").begin_object();
  json.member("slots", run.slots).member("pulses", run.pulses()).member("echoes", run.echoes);
  json.member("rays", run.rays).member("seconds", run.seconds);
  for (std::size_t f = 0; f < fate_count; ++f) json.member(io::name_of(static_cast<Fate>(f)), run.fates[f]);
  json.end_object().key("sample").begin_object();
  json.member("slots", errors.slots).member("clusters", errors.clusters).member("share", errors.sampled_share);
  json.member("subrays", errors.subrays);
  json.end_object().key("errors").begin_object();
  for (const ErrorsByClass& part : errors.parts) {
    json.key(part.name).begin_object().key("all");
    add(json, part.all);
    json.key("classes").begin_object();
    for (const auto& [classification, some] : part.classes) add(json.key(std::to_string(classification)), some);
    json.end_object().end_object();
  }
  json.end_object().end_object();
  return json.text() + '\n';
}

}  // namespace

const char* label_of(ErrorFigure figure) {
  static constexpr std::array<const char*, error_figure_count> labels{
      "range, 68.3 %",     "range, 95 %",     "position, 68.3 %", "position, 95 %",
      "intensity, 68.3 %", "intensity, 95 %", "lost echoes",      "invented echoes"};
  return labels[static_cast<std::size_t>(figure)];
}

std::string text_of(const EchoErrors& errors, ErrorFigure figure) {
  const Estimate& e = errors[figure];
  const bool is_length = !error_figure_units[static_cast<std::size_t>(figure)].empty();
  return text_of(e, is_length ? length_unit(e.value) : percent, 3);
}

void print(const RunErrors& errors, bool by_class) {
  const auto row = [](const std::string& label, const auto& parts, const auto& text) {
    std::cout << "  " << std::left << std::setw(18) << label;
    for (const auto& part : parts) std::cout << std::setw(30) << text(part);
    std::cout << std::right << '\n';
  };
  const auto rows = [&](const auto& parts, const auto& of) {
    for (std::size_t f = 0; f < error_figure_count; ++f) {
      const auto figure = static_cast<ErrorFigure>(f);
      row(label_of(figure), parts, [&](const auto& part) { return text_of(of(part), figure); });
    }
  };
  std::cout << "\nerrors by a sample of " << errors.slots << " pulse slots, against " << errors.subrays
            << " subrays:\n";
  row("", errors.parts, [](const ErrorsByClass& part) { return part.name; });
  rows(errors.parts, [](const ErrorsByClass& part) -> const EchoErrors& { return part.all; });
  if (!by_class) return;
  for (const auto& [classification, together] : errors.parts.back().classes) {
    std::cout << "class " << classification << ", together:\n";
    rows(std::array{&together}, [](const EchoErrors* some) -> const EchoErrors& { return *some; });
  }
}

ErrorReport::ErrorReport(const helios::Simulation& simulation, const Options& options, std::uint64_t seed)
    : options_(options), errors_(std::async(std::launch::async, [&simulation, &options, seed] {
        return simulation.errors({.seed = seed, .threads = options.threads});
      })) {}

void ErrorReport::finish(const fs::path& folder, RunOrigin origin, const RunSummary& run) {
  const RunErrors errors = errors_.get();
  origin.inputs.emplace(options_.survey.string(), hex(io::content_fingerprint(options_.survey)));
  const fs::path path = folder / name;
  std::ofstream out(path);
  out << report_of(errors, origin, run) << std::flush;
  if (!out) throw FileError(path.string(), "", "cannot be written");
  if (!options_.quiet) print(errors, options_.verbose);
}
