// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/server.hpp>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include "support/local_client.hpp"

using namespace pulsecast;
using namespace pulsecast::page;

namespace {

struct Address {
  std::string host, path;
  int port = 0;

  explicit Address(const std::string& all) {
    const auto begin = std::string("http://").size(), slash = all.find('/', begin);
    host = all.substr(begin, slash - begin);
    path = all.substr(slash);
    port = std::atoi(host.substr(host.find(':') + 1).c_str());
  }
};

/// All that a server answers to a request, word by word.
std::string answer(int port, const std::string& request) {
  const support::Client client(port);
  REQUIRE(client.send(request));
  return client.rest();
}

std::string ask(const Address& a, const std::string& method, const std::string& path, const std::string& more = "",
                const std::string& host = "") {
  return answer(a.port, method + ' ' + path + " HTTP/1.1\r\nHost: " + (host.empty() ? a.host : host) +
                            "\r\nConnection: close\r\nContent-Length: 0\r\n" + more + "\r\n");
}

int status(const std::string& answer) { return std::atoi(answer.substr(9, 3).c_str()); }

std::string body(const std::string& answer) { return answer.substr(answer.find("\r\n\r\n") + 4); }

/// The JSON text that news begin with.
std::string news(const Address& a, const std::string& query) {
  const std::string all = body(ask(a, "GET", a.path + "points?" + query));
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(all[i])}; };
  return all.substr(4, byte(0) | byte(1) << 8 | byte(2) << 16);
}

bool has(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

void give(PageServer& server, PulseIndex first, PulseIndex end) {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  for (PulseIndex i = first; i < end; ++i) {
    shots.push_back(
        {.index = i, .direction = axis::forward, .first_echo = static_cast<std::uint32_t>(echoes.size()), .echoes = 1});
    echoes.push_back({.range = 5});
  }
  EchoBatch batch;
  batch.shots = shots;
  batch.echoes = echoes;
  server(batch);
}

}  // namespace

TEST_CASE("the page is served to its address, and to nothing else") {
  PageServer server({.name = "</script>"});
  const Address a(server.address());
  CHECK(a.path.size() == 34);
  const std::string page = ask(a, "GET", a.path);
  CHECK(status(page) == 200);
  CHECK(body(page).starts_with("<!DOCTYPE html>"));
  CHECK(has(page, "\"live\":true"));
  CHECK_FALSE(has(page, "name\":\"<"));
  CHECK_FALSE(has(page, "Access-Control"));
  CHECK(has(page, "X-Frame-Options: DENY"));
  CHECK(status(ask(a, "GET", a.path, "", "localhost:" + std::to_string(a.port))) == 200);

  CHECK(status(ask(a, "GET", "/")) == 403);
  CHECK(status(ask(a, "GET", "/00000000000000000000000000000000/")) == 403);
  CHECK(status(ask(a, "GET", a.path + "../")) == 404);
  CHECK(status(ask(a, "GET", a.path + "etc/passwd")) == 404);
  CHECK(status(ask(a, "GET", a.path, "", "evil.example:" + std::to_string(a.port))) == 403);
  CHECK(status(ask(a, "GET", a.path, "", "127.0.0.1")) == 403);
  CHECK(status(ask(a, "POST", a.path + "stop", "Origin: http://evil.example\r\n")) == 403);
  CHECK(status(ask(a, "POST", a.path + "stop", "Origin: null\r\n")) == 403);
  CHECK(status(ask(a, "GET", a.path + "stop")) == 404);
  CHECK_FALSE(server.stop_requested());
  CHECK(status(ask(a, "POST", a.path + "stop", "Origin: http://" + a.host + "\r\n")) == 204);
  CHECK(server.stop_requested());
}

TEST_CASE("addresses differ from server to server") {
  CHECK(Address(PageServer().address()).path != Address(PageServer().address()).path);
}

TEST_CASE("only this machine is listened to") {
  PageServer server;
  const Address a(server.address());
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in all{};  // were every address taken, none could be bound; were another one, it would be refused here
  all.sin_family = AF_INET;
  all.sin_port = htons(static_cast<std::uint16_t>(a.port));
  all.sin_addr.s_addr = htonl(0x7f000002);
  CHECK(bind(s, reinterpret_cast<const sockaddr*>(&all), sizeof all) == 0);
  close(s);
}

TEST_CASE("news are what came since, and how far the run is") {
  PageServer server;
  server.begin({.legs = {{"A", {0}, {{1, 2, 3}}}}});
  const Address a(server.address());
  std::string text = news(a, "run=&after=");
  CHECK(has(text, "\"run\":2,\"state\":\"running\""));
  CHECK(has(text, "\"last\":\"\""));
  CHECK(has(text, "\"name\":\"A\""));
  give(server, 0, 1000);
  server.show({.done = 1000, .total = 5000, .echoes = 1000, .seconds = 2});
  text = news(a, "run=2&after=");
  CHECK(has(text, "\"done\":1000,\"total\":5000,\"echoes\":1000,\"seconds\":2,"));
  CHECK(has(text, "\"more\":false,\"last\":\"999\"}"));
  give(server, 1000, 1010);
  CHECK(has(body(ask(a, "GET", a.path + "points?run=2&after=999")), "{\"count\":10,"));
  CHECK(has(body(ask(a, "GET", a.path + "points?run=2&after=1009")), "{\"count\":0,"));
  CHECK(has(news(a, "run=2&after=1009"), "\"last\":\"1009\""));
  CHECK(has(body(ask(a, "GET", a.path + "points?run=1&after=1009")), "{\"count\":1010,"));
  CHECK(has(body(ask(a, "GET", a.path + "points?run=x%00&after=-1")), "{\"count\":1010,"));
  give(server, 1010, 200'000);
  CHECK(has(body(ask(a, "GET", a.path + "points?run=2&after=1009")), "{\"count\":65536,"));
  CHECK(has(news(a, "run=2&after=1009"), "\"more\":true"));
}

TEST_CASE("points have colours in every run of a server that has them") {
  const auto red = [](const EchoBatch&, const Shot&, const Echo&) { return PointColour{.red = 65535}; };
  PageServer server({}, {.points = {.colours = red}}), plain;
  for (int run = 0; run < 2; ++run) {
    server.begin({});
    give(server, 0, 10);
    const Address a(server.address());
    CHECK(has(body(ask(a, "GET", a.path + "points?run=&after=")), "\"name\":\"colour\""));
  }
  const Address a(plain.address());
  plain.begin({}, {.points = {.colours = red}});
  give(plain, 0, 10);
  CHECK(has(body(ask(a, "GET", a.path + "points?run=&after=")), "\"name\":\"colour\""));
  plain.begin({}, {});
  give(plain, 0, 10);
  CHECK_FALSE(has(body(ask(a, "GET", a.path + "points?run=&after=")), "\"name\":\"colour\""));
}

TEST_CASE("whoever watches gets the end, and nobody is waited for who does not") {
  PageServer server;
  const auto began = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::steady_clock::now() - began; };
  server.finish(true);
  CHECK(passed() < std::chrono::seconds(1));
  const Address a(server.address());
  CHECK(has(news(a, "run=1&after="), "\"state\":\"complete\""));
  std::string last;
  std::thread watcher([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    last = news(a, "run=1&after=");
  });
  server.finish(false);
  watcher.join();
  CHECK(has(last, "\"state\":\"stopped\""));
  CHECK(passed() < std::chrono::seconds(15));
}
