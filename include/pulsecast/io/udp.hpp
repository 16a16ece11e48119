// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_UDP_HPP
#define PULSECAST_IO_UDP_HPP

#include <cerrno>
#include <optional>
#include <system_error>

#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/packets/packet.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a sender.
struct UdpSettings {
  double pace = 0;  ///< clock seconds in a second: 1 for real time; 0 without waiting

  void validate() const { require_within("UdpSettings::pace", pace, 0, 1e6, ""); }
};

/// Sends packets by UDP to a host, or all of a network. Errors: a `FileError` that names it.
class UdpSender {
 public:
  /// @throws SettingError for settings out of range @throws FileError without a socket
  UdpSender(const Ipv4Address& address, std::uint16_t port, const UdpSettings& settings = {})
      : settings_(validated(settings)) {
    for (const std::uint8_t part : address) name_ += (name_.empty() ? "" : ".") + std::to_string(part);
    name_ += ":" + std::to_string(port);
    receiver_.sin_family = AF_INET;
    receiver_.sin_port = htons(port);
    std::memcpy(&receiver_.sin_addr, address.data(), sizeof address);
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0) fail("has no socket");
    const int yes = 1;
    if (::setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes) != 0) {
      const int error = std::exchange(errno, 0);
      ::close(socket_);
      errno = error;
      fail("cannot be sent to");
    }
  }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;
  ~UdpSender() { ::close(socket_); }

  /// Sends a packet, at its time after the first if there is a pace. @throws FileError
  void operator()(const SensorPacket& packet) {
    if (settings_.pace > 0) wait_for(packet.time);
    while (::sendto(socket_, packet.payload.data(), packet.payload.size(), 0,
                    reinterpret_cast<const sockaddr*>(&receiver_), sizeof receiver_) < 0)
      if (errno != EINTR) fail("cannot be sent to");
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(name_, "", problem + ": " + std::error_code(errno, std::generic_category()).message());
  }

  /// Waits until a time of the packets' clock. The first call sets what the clock shows now.
  void wait_for(Tick time) {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    if (!first_) {
      first_ = time;
      begin_ = {now.tv_sec, 1e-9 * static_cast<double>(now.tv_nsec)};
    }
    const double since = static_cast<double>(time.second - first_->second) + (time.fraction - first_->fraction);
    const Tick until = begin_ + Tick::of_seconds(since / settings_.pace);
    const timespec end{static_cast<time_t>(until.second), static_cast<long>(1e9 * until.fraction)};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr) == EINTR) continue;
  }

  UdpSettings settings_;
  std::string name_;
  sockaddr_in receiver_{};
  int socket_ = -1;
  std::optional<Tick> first_;  // time of the first packet
  Tick begin_{};               // time at which it was sent
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
