// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/echo.hpp>
#include <pulsecast/io/detail/packets/packet_stream.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>

#include "support/generators.hpp"

/// Packets of sensors, and echoes to make them of.
namespace pulsecast::support {

/// Packet that outlives its sender.
struct KeptPacket {
  Tick time;
  std::uint16_t port;
  std::vector<std::byte> payload;

  /// Number at a position.
  template <class Number>
  [[nodiscard]] Number at(std::size_t position) const {
    Number value;
    std::memcpy(&value, payload.data() + position, sizeof value);
    return value;
  }
};

/// Consumer that keeps all packets, and counts the places of their payloads.
struct PacketKeeper {
  std::vector<KeptPacket> packets{};
  std::vector<const std::byte*> places{};

  void operator()(const io::SensorPacket& packet) {
    packets.push_back({packet.time, packet.port, {packet.payload.begin(), packet.payload.end()}});
    if (std::find(places.begin(), places.end(), packet.payload.data()) == places.end())
      places.push_back(packet.payload.data());
  }
};

/// Shots of a sensor with any echoes.
struct SensorEchoes {
  std::vector<Shot> shots{};
  std::vector<Echo> echoes{};

  [[nodiscard]] std::span<const Echo> of(const Shot& shot) const {
    return {echoes.data() + shot.first_echo, shot.echoes};
  }

  /// Appends the shot of a slot, whose echoes have these ranges, each weaker than the one before.
  void add(const SpinningSource& source, PulseIndex slot, const std::vector<double>& ranges) {
    const auto pulse = source.pulse(slot);
    shots.push_back({.index = slot,
                     .tick = pulse->tick,
                     .origin = pulse->origin(),
                     .direction = pulse->direction(),
                     .first_echo = static_cast<std::uint32_t>(echoes.size()),
                     .echoes = static_cast<std::uint32_t>(ranges.size())});
    double amplitude = 1e-6;
    for (const double range : ranges)
      echoes.push_back({.range = range, .amplitude = amplitude *= 0.5, .reflectance = 0.5});
  }

  /// Slots of a source with up to so many echoes each. Some slots are empty, and some are left out, also many in a row.
  [[nodiscard]] static SensorEchoes any(const SpinningSource& source, PulseIndex first, PulseIndex end,
                                        std::size_t most, Generator& any) {
    SensorEchoes all;
    for (PulseIndex slot = first; slot < end; ++slot) {
      if (any.whole(2000) == 0) slot += any.whole(2000);
      if (any.whole(10) == 0 || slot >= end) continue;
      std::vector<double> ranges(any.whole(most + 1));
      for (double& range : ranges) range = any.log_uniform(0.5, 120);
      std::sort(ranges.begin(), ranges.end());
      all.add(source, slot, ranges);
      for (std::size_t k = all.echoes.size() - ranges.size(); k < all.echoes.size(); ++k) {
        all.echoes[k].amplitude = any.log_uniform(1e-9, 1e-5);
        all.echoes[k].reflectance = any.uniform();
      }
    }
    return all;
  }

  /// Gives all shots to a sink, in batches of any size.
  template <class Sink>
  void give(Sink& sink, Generator& any) const {
    for (std::size_t first = 0; first < shots.size();) {
      const std::size_t count = std::min<std::size_t>(1 + any.whole(1000), shots.size() - first);
      sink(EchoBatch{.shots = std::span(shots).subspan(first, count), .echoes = echoes, .samples = {}});
      first += count;
    }
  }
};

/// Packets of echoes, by a sink of this type.
template <class Packets>
[[nodiscard]] std::vector<KeptPacket> packets_of(const SensorEchoes& all, const SpinningSensor& sensor,
                                                 const io::PacketSettings& settings) {
  PacketKeeper kept;
  Packets packets(sensor, settings, std::ref(kept));
  Generator any(1);
  all.give(packets, any);
  packets.close();
  CHECK(kept.places.size() <= 1);  // no payload is allocated anew
  return kept.packets;
}

/// Strongest of the echoes of a pulse, and the strongest of the others, if there are others.
[[nodiscard]] inline std::vector<Echo> by_strength(std::span<const Echo> echoes) {
  std::vector<Echo> sorted(echoes.begin(), echoes.end());
  std::sort(sorted.begin(), sorted.end(), [](const Echo& a, const Echo& b) { return a.amplitude > b.amplitude; });
  return sorted;
}

}  // namespace pulsecast::support
