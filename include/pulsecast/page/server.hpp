// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_SERVER_HPP
#define PULSECAST_PAGE_SERVER_HPP

#include <sys/random.h>

#include <pulsecast/page/detail/local_server.hpp>
#include <pulsecast/page/page.hpp>
#include <pulsecast/run.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Sink that shows the growing cloud at 127.0.0.1: the page of `PageWriter` with a stop button.
///
/// It is a `LocalServer`: no client takes memory, descriptors or time from the run. Every address
/// contains a random secret. Requests must use the name of this machine and come from no other
/// site's page. The functions may be called from any thread.
class PageServer {
 public:
  /// Throws a `std::runtime_error` if nothing can be served. `port` is 0 for any free one.
  explicit PageServer(PageSurvey survey = {}, const PageSettings& settings = {}, int port = 0)
      : settings_(validated(settings)),
        token_(secret()),
        survey_(std::move(survey)),
        sample_(settings.points_max, settings.points, settings.columns) {
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (is_ours(request)) return httplib::Server::HandlerResponse::Unhandled;
      response.status = 403;
      response.set_content("This address is for the page of this machine only.\n", "text/plain");
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"X-Frame-Options", "DENY"}});
    server_.Get('/' + token_ + '/', [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(page(), "text/html; charset=utf-8");
    });
    server_.Get('/' + token_ + "/points", [this](const httplib::Request& request, httplib::Response& response) {
      response.set_content(news(text::number_in<std::uint64_t>(request.get_param_value("run")),
                                text::number_in<std::uint64_t>(request.get_param_value("after"))),
                           "application/octet-stream");
    });
    server_.Post('/' + token_ + "/stop", [this](const httplib::Request&, httplib::Response& response) {
      stop_requested_ = true;
      response.status = 204;
    });
    try {
      host_ = ':' + std::to_string(server_.bind(port));
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(std::string("no page can be served: ") + e.what());
    }
    server_.start();
  }

  /// URL of the page.
  [[nodiscard]] std::string address() const { return "http://127.0.0.1" + host_ + '/' + token_ + '/'; }

  /// Removes all points and starts another run.
  void begin(PageSurvey survey) { begin(std::move(survey), settings_); }
  /// As above, with other settings. @throws SettingError
  void begin(PageSurvey survey, const PageSettings& settings) {
    const std::lock_guard lock(mutex_);
    settings_ = validated(settings);
    survey_ = std::move(survey);
    sample_ = PageSample(settings_.points_max, settings_.points, settings_.columns);
    progress_ = {};
    state_ = "running";
    ++run_;
  }

  void operator()(const EchoBatch& batch) {
    const std::lock_guard lock(mutex_);
    sample_(batch);
  }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Sets the progress shown.
  void show(const Progress& progress) {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
  }

  /// True if the stop button was pressed.
  [[nodiscard]] bool stop_requested() const noexcept { return stop_requested_; }

  /// Ends the run, and waits until open pages have all points, but at most `patience`.
  void finish(bool complete, std::chrono::milliseconds patience = std::chrono::seconds(20)) {
    {
      const std::lock_guard lock(mutex_);
      state_ = complete ? "complete" : "stopped";
    }
    const auto began = Clock::now();
    constexpr auto quiet = std::chrono::milliseconds(1500);  // hidden pages poll each second
    while (Clock::now() - began < patience) {
      {
        const std::lock_guard lock(mutex_);
        if (!asked_ || Clock::now() - *asked_ > quiet) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::ptrdiff_t max_at_once = 65'536;  // points

  /// 128 random bits as text.
  [[nodiscard]] static std::string secret() {
    std::array<unsigned char, 32> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("no page can be served: the system has no random numbers");
    std::string out;
    for (const unsigned char byte : bytes) out += "0123456789abcdef"[byte % 16];
    return out;
  }

  /// True if a request names this host, as others may resolve to it ("DNS rebinding"), and comes from no other page.
  [[nodiscard]] bool is_ours(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (host != "127.0.0.1" + host_ && host != "localhost" + host_) return false;
    if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + host) return false;
    return request.path.starts_with('/' + token_ + '/');
  }

  [[nodiscard]] std::string page() {
    const std::lock_guard lock(mutex_);
    asked_ = Clock::now();
    return page_html(survey_, sample_.seen(), "", true);
  }

  /// Progress, and points of later pulses than `after`: a JSON text with its length, and columns.
  [[nodiscard]] std::string news(std::optional<std::uint64_t> run, std::optional<std::uint64_t> after) {
    detail::JsonWriter json;
    PagePoints fresh;
    {
      const std::lock_guard lock(mutex_);
      asked_ = Clock::now();
      const bool other = run != run_;
      const std::vector<PagePoint>& all = sample_.points().points;
      const auto later = [](std::uint64_t pulse, const PagePoint& p) { return pulse < p.pulse; };
      const auto first = other || !after ? all.begin() : std::upper_bound(all.begin(), all.end(), *after, later);
      auto end = first + std::min(max_at_once, all.end() - first);
      if (end != first) end = std::upper_bound(end, all.end(), std::prev(end)->pulse, later);
      fresh = sample_.points().part(static_cast<std::size_t>(first - all.begin()),
                                    static_cast<std::size_t>(end - all.begin()));
      const std::string last = first != end      ? std::to_string(fresh.points.back().pulse)
                               : other || !after ? ""
                                                 : std::to_string(*after);
      json.begin_object().member("run", run_).member("state", state_);
      json.member("done", progress_.done).member("total", progress_.total).member("echoes", sample_.seen());
      json.member("seconds", progress_.seconds).member("largest_key", sample_.largest_key());
      json.member("more", end != all.end()).member("last", last);
      if (other) {
        json.key("legs");
        detail::write_legs(json, survey_.legs);
      }
      json.end_object();
    }
    constexpr double step = 1e-3;  // suits any extent: nothing is stored [m]
    return detail::with_length(json.text()) +
           page_columns(fresh, {.position_step = settings_.position_step > 0 ? settings_.position_step : step,
                                .keys = true,
                                .effort = 1});
  }

  PageSettings settings_;
  std::string token_, host_;
  std::mutex mutex_;
  PageSurvey survey_;
  PageSample sample_;
  Progress progress_{};
  std::string state_ = "running";
  std::uint64_t run_ = 1;
  std::optional<Clock::time_point> asked_{};  // time of the last request
  std::atomic<bool> stop_requested_ = false;
  LocalServer server_;  // no `Request` is made here: its layout depends on how httplib was compiled
};
static_assert(EchoSink<PageServer>);

}  // namespace PULSECAST_NAMESPACE::page

#endif
