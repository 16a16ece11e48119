// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKETS_PACKET_STREAM_HPP
#define PULSECAST_IO_DETAIL_PACKETS_PACKET_STREAM_HPP

#include <pulsecast/io/detail/packets/packet.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Returns of a pulse that a sensor reports.
enum class PacketReturns : std::uint8_t {
  strongest,  ///< that of the maximum amplitude
  last,       ///< the farthest
  dual        ///< two, of which one is the strongest
};

/// Settings of the packets of a sensor.
struct PacketSettings {
  PacketReturns returns = PacketReturns::strongest;  ///< returns of a pulse
  double start_time = 0;                             ///< clock time at tick 0, as since 1970, to 4e9 [s]

  void validate() const { require_within("PacketSettings::start_time", start_time, 0, 4e9, "s"); }
};

namespace detail {

/// Sensor whose packets are written, and their settings.
struct PacketSource {
  SpinningSensor sensor;
  PacketSettings settings;

  [[nodiscard]] bool is_dual() const noexcept { return settings.returns == PacketReturns::dual; }
  /// Clock time at the begin of a firing sequence.
  [[nodiscard]] Tick clock(PulseIndex sequence) const noexcept {
    return Tick::of_seconds(settings.start_time) + sensor.sequence_start(sequence);
  }
};

using Echoes = std::span<const Echo>;

/// Strongest echo but one; null if there is no other.
[[nodiscard]] inline const Echo* strongest_but(const Echo* one, Echoes echoes) noexcept {
  const Echo* strongest = nullptr;
  for (const Echo& echo : echoes)
    if (&echo != one && (!strongest || echo.amplitude > strongest->amplitude)) strongest = &echo;
  return strongest;
}

/// The return of a pulse with echoes, of single returns.
[[nodiscard]] inline const Echo& single_return(Echoes echoes, PacketReturns returns) noexcept {
  return returns == PacketReturns::last ? echoes.back() : *strongest_but(nullptr, echoes);
}

/// Layout of packets, each of the same number of firing sequences. `begin` writes what is known
/// before any echo to a payload of zeros, and `write` the returns of one laser in one sequence.
template <class Format>
concept PacketFormat = requires(const PacketSource& source, std::span<std::byte> payload, std::size_t number,
                                PulseIndex first, Echoes echoes) {
  { Format::port } -> std::convertible_to<std::uint16_t>;
  { Format::validate(source.sensor) } -> std::same_as<void>;
  { Format::size(source) } -> std::same_as<std::size_t>;
  { Format::sequences(source) } -> std::same_as<std::size_t>;
  { Format::begin(source, first, payload) } -> std::same_as<void>;
  { Format::write(source, payload, number, number, echoes) } -> std::same_as<void>;
};

/// Sink that writes the echoes of a sensor as its packets. Packet n holds the same firing sequences
/// in any run. From the first echo on, all are passed on, in order, also those without echoes.
template <PacketFormat Format>
class PacketStream {
 public:
  /// @throws SettingError for settings out of range, or a sensor that has no such packets
  PacketStream(const SpinningSensor& sensor, const PacketSettings& settings, TakePacket take)
      : source_{validated(sensor), validated(settings)}, take_(std::move(take)) {
    Format::validate(sensor);
    payload_.resize(Format::size(source_));
  }

  /// Writes the echoes of a batch. @throws SettingError for pulses out of order
  void operator()(const EchoBatch& batch) {
    const std::size_t lasers = source_.sensor.lasers.size(), sequences = Format::sequences(source_);
    for (const Shot& shot : batch.shots) {
      if (shot.echoes == 0) continue;
      if (shot.index < next_slot_)
        throw SettingError("Shot::index", static_cast<double>(shot.index), "",
                           "in ascending order until the packets are closed");
      next_slot_ = shot.index + 1;
      const PulseIndex sequence = shot.index / lasers;
      open(sequence / sequences);
      Format::write(source_, payload_, static_cast<std::size_t>(sequence % sequences),
                    static_cast<std::size_t>(shot.index % lasers), batch.echoes_of(shot));
    }
  }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Passes on the last packet, even if incomplete. The next pulse begins a new stream.
  void close() {
    if (is_open_) send();
    is_open_ = false;
    next_slot_ = 0;
  }

 private:
  /// Makes packet `number` the current one, and passes on those before it.
  void open(PulseIndex number) {
    for (; is_open_ && number_ < number; begin(number_ + 1)) send();
    if (!is_open_) begin(number);
    is_open_ = true;
  }

  void begin(PulseIndex number) {
    number_ = number;
    std::fill(payload_.begin(), payload_.end(), std::byte{});
    Format::begin(source_, number_ * Format::sequences(source_), payload_);
  }

  void send() const { take_({source_.clock((number_ + 1) * Format::sequences(source_)), Format::port, payload_}); }

  PacketSource source_;
  TakePacket take_;
  std::vector<std::byte> payload_;
  PulseIndex number_ = 0;     // of the current packet
  PulseIndex next_slot_ = 0;  // first slot that may come
  bool is_open_ = false;      // true from the first echo on
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
