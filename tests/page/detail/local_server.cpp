// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/local_server.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/local_client.hpp"

using namespace pulsecast;
using namespace pulsecast::page;
using support::Client;

namespace {

constexpr const char* request = "GET /greeting HTTP/1.1\r\nHost: a\r\n\r\n";

struct Greeter {
  LocalServer server;
  int port;

  explicit Greeter(const LocalServerLimits& limits = {}) : server(limits) {
    server.Get("/greeting",
               [](const httplib::Request&, httplib::Response& r) { r.set_content("hello", "text/plain"); });
    server.Get("/long", [](const httplib::Request&, httplib::Response& r) {
      r.set_content(std::string(20'000'000, 'a'), "text/plain");
    });
    port = server.bind(0);
    server.start();
  }
  [[nodiscard]] std::string answer(const std::string& text) const {
    const Client client(port);
    client.send(text);
    return client.rest();
  }
};

std::size_t descriptors() {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator()));
}

/// Waits until `number` descriptors are open: the server took or closed a connection, however busy the machine is.
void wait_for_descriptors(std::size_t number) {
  for (int tries = 0; tries < 10'000 && descriptors() != number; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

}  // namespace

TEST_CASE("a request is answered, in one piece or byte by byte, and the connection closed") {
  const Greeter greeter;
  CHECK(greeter.answer(request).starts_with("HTTP/1.1 200"));
  CHECK(greeter.answer(request).ends_with("\r\n\r\nhello"));
  const Client client(greeter.port);
  for (const char* c = request; *c != '\0'; ++c) client.send({c, 1});
  CHECK(client.rest().ends_with("hello"));
}

TEST_CASE("a long response comes whole") {
  CHECK(Greeter().answer("GET /long HTTP/1.1\r\n\r\n").ends_with("\r\n\r\n" + std::string(20'000'000, 'a')));
}

TEST_CASE("what is no request, or has a body, is told so") {
  const Greeter greeter;
  CHECK(greeter.answer("nonsense\r\n\r\n").starts_with("HTTP/1.1 400"));
  CHECK(greeter.answer("POST /greeting HTTP/1.1\r\nContent-Length: 5\r\n\r\nabcde").starts_with("HTTP/1.1 4"));
  CHECK(greeter.answer("POST /greeting HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nabcde\r\n")
            .starts_with("HTTP/1.1 4"));
  std::string ranges = "GET /greeting HTTP/1.1\r\nRange: bytes=0-1";
  for (int k = 0; k < 2000; ++k) ranges += ",0-1";
  CHECK(greeter.answer(ranges + "\r\n\r\n").starts_with("HTTP/1.1 "));
}

TEST_CASE("a client that sends a byte now and then is cut off, and another answered meanwhile") {
  const Greeter greeter({.request_time = std::chrono::milliseconds(300)});
  const Client slow(greeter.port);
  int sent = 0;
  for (; sent < 100 && slow.send("a"); ++sent) {
    if (sent < 2) CHECK(greeter.answer(request).ends_with("hello"));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  CHECK(sent < 100);
}

TEST_CASE("a client that does not take its response is cut off") {
  const Greeter greeter({.response_time = std::chrono::milliseconds(100)});
  const std::size_t before = descriptors();
  const Client idle(greeter.port);
  CHECK(greeter.answer(request).ends_with("hello"));  // the server takes connections in order, so it has that of `idle`
  idle.send("GET /long HTTP/1.1\r\n\r\n");
  wait_for_descriptors(before + 1);
  CHECK(idle.rest().size() < 20'000'000);
}

TEST_CASE("of many clients a few are kept, and the newest is answered") {
  const Greeter greeter({.connections = 8, .request_time = std::chrono::minutes(10)});
  const std::size_t before = descriptors();
  std::vector<Client> clients;
  for (int k = 0; k < 300; ++k) clients.emplace_back(greeter.port).send("GET /");
  CHECK(greeter.answer(request).ends_with("hello"));
  CHECK(descriptors() <= before + clients.size() + 8);
}

TEST_CASE("many clients leave half of the descriptors to the program") {
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
  const std::size_t taken = descriptors(), free = 24;
  rlimit few = before;
  few.rlim_cur = 2 * taken + free;
  REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
  {
    const Greeter greeter({.request_time = std::chrono::minutes(10)});
    const std::size_t with_server = descriptors();
    const pid_t crowd = fork();
    if (crowd == 0) {  // clients in another process, which have descriptors of their own
      setrlimit(RLIMIT_NOFILE, &before);
      std::vector<Client> clients;
      for (int k = 0; k < 300; ++k) clients.emplace_back(greeter.port).send("GET /");
      for (;;) pause();
    }
    for (int tries = 0; tries < 500 && descriptors() == with_server; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::vector<int> files;
    for (std::size_t k = 0; k < free / 2; ++k) files.push_back(open("/dev/null", O_RDONLY | O_CLOEXEC));
    CHECK(std::ranges::none_of(files, [](int file) { return file < 0; }));
    for (const int file : files) close(file);
    CHECK(greeter.answer(request).ends_with("hello"));
    kill(crowd, SIGKILL);
    waitpid(crowd, nullptr, 0);
  }
  setrlimit(RLIMIT_NOFILE, &before);
}

TEST_CASE("headers without an end are refused once they fill their room") {
  const Greeter greeter;
  const Client large(greeter.port);
  large.send("GET / HTTP/1.1\r\n");
  std::string headers;
  while (headers.size() < 1 << 20) headers += "a: b\r\n";
  int sent = 0;
  while (sent < 64 && large.send(headers)) ++sent;
  CHECK(sent < 64);
  std::string just = "GET / HTTP/1.1\r\n";
  just += std::string(65'536 - just.size(), 'a');
  CHECK(greeter.answer(just).starts_with("HTTP/1.1 4"));
}

TEST_CASE("the end waits for no client") {
  std::vector<Client> clients;
  {
    const Greeter greeter({.request_time = std::chrono::minutes(10), .response_time = std::chrono::minutes(10)});
    clients.emplace_back(greeter.port).send("GET /");
    clients.emplace_back(greeter.port).send("GET /long HTTP/1.1\r\n\r\n");
    clients.emplace_back(greeter.port);
    CHECK(greeter.answer(request).ends_with("hello"));
  }
  for (const Client& client : clients) CHECK(client.rest().size() < 20'000'000);
}

TEST_CASE("a port that is taken is told") {
  const Greeter greeter;
  LocalServer other;
  CHECK_THROWS_AS(other.bind(greeter.port), std::runtime_error);
}
