// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "accuracy.hpp"

#include <array>
#include <iostream>
#include <stdexcept>

#include <pulsecast/scanner/footprint.hpp>

#include "error_report.hpp"
#include "estimate_text.hpp"
#include "quantity.hpp"

using namespace pulsecast;
using helios::ReceiverOverrides;

namespace {

struct Limit {
  const char* name;
  double Accuracy::*value;
  const QuantityKind& kind;
};
constexpr std::array limits{
    Limit{"range", &Accuracy::range, a_length}, Limit{"position", &Accuracy::position, a_length},
    Limit{"intensity", &Accuracy::intensity, a_share}, Limit{"echoes", &Accuracy::echoes, a_share}};

/// Errors that have a limit, with their intervals.
std::string limited(const Accuracy& accuracy, const EchoErrors& errors) {
  std::string all;
  for (std::size_t f = 0; f < error_figure_count; ++f) {
    const auto figure = static_cast<ErrorFigure>(f);
    if (accuracy.limit(figure) == Accuracy::any) continue;
    all += (all.empty() ? "" : "; ") + std::string(label_of(figure)) + ": " + text_of(errors, figure);
  }
  return all;
}

}  // namespace

std::string read_accuracy(const std::string& text, std::optional<Accuracy>& accuracy) {
  accuracy.emplace();
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(item.size() + 1, rest.size()));
    const std::size_t sign = std::min(item.find('='), item.size());
    const auto limit = std::ranges::find_if(
        limits, [&](const Limit& known) { return pulsecast::text::is_same_word(item.substr(0, sign), known.name); });
    if (limit == limits.end())
      return "'" + std::string(item) +
             "': expected range=, position=, intensity= or echoes=, as in range=5mm,echoes=1%";
    const auto value = quantity(std::string(item.substr(std::min(sign + 1, item.size()))), limit->kind);
    if (!value) return "'" + std::string(item) + "': expected " + limit->kind.expected;
    (*accuracy).*limit->value = *value;
  }
  return text.empty() ? "expected limits, as in range=5mm,echoes=1%" : "";
}

std::string text_of(const Accuracy& accuracy) {
  std::string all;
  for (const Limit& limit : limits) {
    const double value = accuracy.*limit.value;
    if (value == Accuracy::any) continue;
    const Unit unit = &limit.kind == &a_length ? length_unit(value) : percent;
    all += (all.empty() ? "" : ",") + std::string(limit.name) + '=' + pulsecast::text::to_text(value / unit.size) +
           unit.name;
  }
  return all;
}

std::string text_of(const ReceiverOverrides& s) {
  const std::size_t subrays = RingFootprint(static_cast<std::size_t>(*s.rings)).size();
  std::string all = "beamSampleQuality " + std::to_string(*s.rings) + " (" + std::to_string(subrays) +
                    (subrays == 1 ? " subray" : " subrays") + "), binSize_ns " + digits(*s.bin_size * 1e9);
  if (s.orders && *s.paths > 1) all += ", orders " + std::to_string(*s.orders) + ", paths " + std::to_string(*s.paths);
  return all;
}

ReceiverOverrides chosen_settings(const helios::Simulation& simulation, const Accuracy& accuracy, std::uint64_t seed,
                                  unsigned threads, bool quiet) {
  const SettingsChoice choice = simulation.choose(accuracy, {.seed = seed, .threads = threads});
  const ReceiverOverrides chosen = ReceiverOverrides::of(choice.values);
  const std::string words = text_of(chosen) + ": " + limited(accuracy, choice.errors);
  if (!choice.reached)
    throw std::invalid_argument("--accuracy " + text_of(accuracy) +
                                ": no settings are known to reach it; nearest are " + words);
  if (!quiet)
    std::cout << "accuracy " << text_of(accuracy) << "\nchosen   " << words << "\n         against " << choice.subrays
              << " subrays, by " << choice.slots << " pulse slots and " << choice.trials.size()
              << " trials; without errors of the instrument\n";
  return chosen;
}
