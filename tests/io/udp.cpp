// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/udp.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/io/ouster_packets.hpp>
#include <pulsecast/io/velodyne_packets.hpp>
#include <pulsecast/sensor/ouster.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/file_errors.hpp"
#include "support/packets.hpp"

namespace pulsecast::io {
namespace {

/// Socket of this host that receives, at a free port.
class Receiver {
 public:
  Receiver() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    REQUIRE(socket_ >= 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const timeval patience{20, 0};
    REQUIRE(::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) == 0);
    REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
    REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
  }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  ~Receiver() { ::close(socket_); }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::vector<std::byte> next() const {
    std::vector<std::byte> payload(65'536);
    const auto size = ::recv(socket_, payload.data(), payload.size(), 0);
    REQUIRE(size >= 0);
    payload.resize(static_cast<std::size_t>(size));
    return payload;
  }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

constexpr Ipv4Address this_host{127, 0, 0, 1};

TEST_CASE("packets that are sent arrive as they are") {
  const Receiver receiver;
  UdpSender sender(this_host, receiver.port());
  support::PacketKeeper kept;
  std::size_t arrived = 0;
  const auto both = [&](const SensorPacket& packet) {
    kept(packet);
    sender(packet);
    CHECK(receiver.next() == kept.packets.back().payload);
    ++arrived;
  };
  VelodynePackets velodyne(velodyne_vlp_16(), {}, both);
  OusterPackets ouster(ouster_os1_64(), {.returns = PacketReturns::dual}, both);
  support::Generator any(3);
  support::SensorEchoes::any(velodyne_vlp_16().source(1), 0, 4000, 2, any).give(velodyne, any);
  support::SensorEchoes::any(ouster_os1_64().source(1), 0, 4000, 2, any).give(ouster, any);
  velodyne.close();
  ouster.close();
  CHECK(arrived > 10);
}

TEST_CASE("a pace delays packets, and loses none") {
  const Receiver receiver;
  UdpSender sender(this_host, receiver.port(), {.pace = 2});
  timespec before{}, after{};
  ::clock_gettime(CLOCK_MONOTONIC, &before);
  for (unsigned k = 0; k < 5; ++k) {
    const std::vector<std::byte> payload(1 + k, static_cast<std::byte>(k));
    sender({{7, 0.99 + 0.004 * k}, 2368, payload});  // the clock's second ends between them
    CHECK(receiver.next() == payload);
  }
  ::clock_gettime(CLOCK_MONOTONIC, &after);
  const double spent =
      static_cast<double>(after.tv_sec - before.tv_sec) + 1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec);
  CHECK(spent >= 0.008);  // never sooner; later depends on the load of the machine
}

TEST_CASE("a packet that cannot be sent, and settings out of range, are refused") {
  UdpSender sender(this_host, 9);
  const std::vector<std::byte> too_long(70'000);
  const FileError error = support::file_error([&] { sender({{}, 9, too_long}); });
  CHECK(error.path() == "127.0.0.1:9");
  CHECK(support::contains(error.problem(), "cannot be sent"));
  CHECK_THROWS_WITH_AS(UdpSender(this_host, 9, {.pace = -1}), doctest::Contains("UdpSettings::pace"), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
