// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_DETAIL_LOCAL_SERVER_HPP
#define PULSECAST_PAGE_DETAIL_LOCAL_SERVER_HPP

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <httplib.h>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Limits of a `LocalServer` that protect the program's memory, descriptors and time from clients.
struct LocalServerLimits {
  std::size_t connections = 32;                     ///< at once, in half of the descriptors; one more closes the oldest
  std::size_t request_bytes = 65'536;               ///< request line and headers
  std::chrono::milliseconds request_time{2'000};    ///< to the end of the headers
  std::chrono::milliseconds response_time{10'000};  ///< from there to the last byte sent
};

namespace detail {

/// In-memory stream of one request and its response, for httplib.
class BufferedExchange final : public httplib::Stream {
 public:
  explicit BufferedExchange(std::string request) : request_(std::move(request)) {}

  [[nodiscard]] bool is_readable() const override { return read_ < request_.size(); }
  [[nodiscard]] bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = request_.copy(to, size, read_);
    read_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    response.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override { get_local_ip_and_port(ip, port); }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    ip = "127.0.0.1";
    port = 0;
  }
  [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }

  std::string response{};

 private:
  std::string request_;
  std::size_t read_ = 0;
};

}  // namespace detail

/// HTTP server at 127.0.0.1 that holds slow, many or large clients to `LocalServerLimits`, by the routes and parser of
/// `httplib::Server`. One thread polls all connections: idle ones cost nothing. Each is one request without a body.
class LocalServer final : public httplib::Server {
 public:
  explicit LocalServer(const LocalServerLimits& limits = {}) : limits_(limits) {
    set_payload_max_length(0);
    set_socket_options([](socket_t socket) {  // httplib's let two servers share a port
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      fcntl(socket, F_SETFL, O_NONBLOCK);
      fcntl(socket, F_SETFD, FD_CLOEXEC);
    });
  }
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;
  ~LocalServer() override { end(); }

  /// Binds to a port, 0 for any free one, and returns it. @throws std::runtime_error if it is taken
  int bind(int port) {
    const int bound = port > 0 ? (bind_to_port("127.0.0.1", port) ? port : -1) : bind_to_any_port("127.0.0.1");
    if (bound <= 0)
      throw std::runtime_error(
          (port > 0 ? "port " + std::to_string(port) + " is not free" : std::string("no port is free")) +
          " at 127.0.0.1");
    ::listen(svr_sock_, SOMAXCONN);
    return bound;
  }

  /// Starts to answer; no route may be added afterwards.
  void start() {
    thread_ = std::thread([this] { serve(); });
  }

  /// Closes all connections at once, in any state.
  void end() {
    ending_ = true;
    if (svr_sock_ != INVALID_SOCKET) shutdown(svr_sock_, SHUT_RDWR);  // wakes poll()
    if (thread_.joinable()) thread_.join();
    if (const socket_t socket = svr_sock_.exchange(INVALID_SOCKET); socket != INVALID_SOCKET) close(socket);
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Connection {
    socket_t socket;
    Clock::time_point deadline;
    std::string bytes{};    // request received so far, then the response
    std::size_t sent = 0;   // bytes sent of the response
    bool answered = false;  // `bytes` is the response
    bool over = false;
  };

  void serve() {
    constexpr int tick = 100;  // interval of deadline checks [ms]
    bool may_accept = true;    // false for a tick after descriptors ran out
    std::vector<pollfd> ready;
    while (!ending_) {
      ready.assign(1, {may_accept ? svr_sock_.load() : -1, POLLIN, 0});
      for (const Connection& c : open_)
        ready.push_back({c.socket, static_cast<short>(c.answered ? POLLOUT : POLLIN), 0});
      poll(ready.data(), ready.size(), may_accept && open_.empty() ? -1 : tick);
      const auto now = Clock::now();  // once a round: no client pays for another's response
      for (std::size_t k = 0; k < open_.size(); ++k) {
        if (ready[k + 1].revents != 0) proceed(open_[k]);
        if (now > open_[k].deadline) open_[k].over = true;
      }
      close_if([](const Connection& c) { return c.over; });
      may_accept = ready[0].revents == 0 || accept_one();
    }
    close_if([](const Connection&) { return true; });
  }

  /// Accepts one connection, so that others are served before the next; false without a descriptor.
  bool accept_one() {
    socket_t socket = accept4(svr_sock_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket == INVALID_SOCKET) return errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM;
    // descriptors are assigned in order: this number counts those in use, by the program as well
    const bool takes_share = static_cast<rlim_t>(socket) >= share_ && !open_.empty();
    if (open_.size() >= limits_.connections || takes_share) {
      const auto waiting = std::ranges::find(open_, false, &Connection::answered);
      const auto oldest = waiting != open_.end() ? waiting : open_.begin();
      // the new one takes the number of the oldest, so that numbers stay low
      close(dup3(socket, oldest->socket, O_CLOEXEC) >= 0 ? std::exchange(socket, oldest->socket) : oldest->socket);
      open_.erase(oldest);
    }
    open_.push_back({socket, Clock::now() + limits_.request_time});
    return true;
  }

  void proceed(Connection& c) {
    if (!c.answered && !receive(c)) return;
    const ssize_t sent = send(c.socket, c.bytes.data() + c.sent, c.bytes.size() - c.sent, MSG_NOSIGNAL);
    if (sent > 0)
      c.sent += static_cast<std::size_t>(sent);
    else if (errno != EAGAIN && errno != EINTR)
      c.over = true;
    if (c.sent == c.bytes.size()) c.over = true;
  }

  /// Returns true once `bytes` is a response.
  bool receive(Connection& c) {
    char room[4096];
    const std::size_t most = std::min(sizeof room, limits_.request_bytes - c.bytes.size());
    const ssize_t count = recv(c.socket, room, most, 0);
    if (count <= 0) {
      c.over = count == 0 || (errno != EAGAIN && errno != EINTR);
      return false;
    }
    const std::size_t from = c.bytes.size() < 3 ? 0 : c.bytes.size() - 3;
    c.bytes.append(room, static_cast<std::size_t>(count));
    const bool whole = c.bytes.find("\r\n\r\n", from) != std::string::npos;
    if (!whole && c.bytes.size() < limits_.request_bytes) return false;
    detail::BufferedExchange exchange(std::move(c.bytes));
    bool closed = true;
    try {
      process_request(exchange, true, closed, nullptr);
    } catch (...) {  // out of memory for this client; the next may succeed
      exchange.response.clear();
    }
    c.bytes = std::move(exchange.response);
    c.answered = true;
    c.deadline = Clock::now() + limits_.response_time;
    return true;
  }

  template <class Condition>
  void close_if(const Condition& condition) {
    for (const Connection& c : open_)
      if (condition(c)) close(c.socket);
    std::erase_if(open_, condition);
  }

  /// Half of the descriptors that this process may have.
  [[nodiscard]] static rlim_t half_of_descriptors() {
    rlimit limit{};
    return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur / 2 : 0;
  }

  LocalServerLimits limits_;
  rlim_t share_ = half_of_descriptors();
  std::vector<Connection> open_{};  // oldest first
  std::atomic<bool> ending_ = false;
  std::thread thread_{};
};

}  // namespace PULSECAST_NAMESPACE::page

#endif
