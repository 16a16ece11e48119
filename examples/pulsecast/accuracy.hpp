// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <pulsecast/accuracy.hpp>
#include <pulsecast/helios/simulation.hpp>

/// Reads an accuracy, as in `range=5mm,echoes=1%`. Returns a problem; empty if there is none.
std::string read_accuracy(const std::string& text, std::optional<pulsecast::Accuracy>& accuracy);
std::string text_of(const pulsecast::Accuracy& accuracy);

/// Chooses settings that reach an accuracy, and prints them with their errors unless `quiet`.
/// @throws std::invalid_argument if there are none, with the nearest ones
pulsecast::helios::ReceiverOverrides chosen_settings(const pulsecast::helios::Simulation& simulation,
                                                     const pulsecast::Accuracy& accuracy, std::uint64_t seed,
                                                     unsigned threads, bool quiet);

/// Settings in words; `orders` and `paths` only if they count.
std::string text_of(const pulsecast::helios::ReceiverOverrides& settings);
