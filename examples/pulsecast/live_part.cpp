// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include <string_view>
#include <utility>

#include <pulsecast/page/server.hpp>
#include <pulsecast/version.hpp>

#include "parts.hpp"

using namespace pulsecast;

namespace {

class ServedPage final : public LivePage {
 public:
  ServedPage(const page::PageSurvey& survey, const page::PageSettings& settings) : server_(survey, settings) {}
  [[nodiscard]] std::string address() const override { return server_.address(); }
  void begin(page::PageSurvey survey, const page::PageSettings& settings) override {
    server_.begin(std::move(survey), settings);
  }
  void operator()(const EchoBatch& batch) override { server_(batch); }
  void show(const Progress& progress) override { server_.show(progress); }
  [[nodiscard]] bool stop_requested() const override { return server_.stop_requested(); }
  void finish(bool complete) override { server_.finish(complete); }

 private:
  page::PageServer server_;
};

std::unique_ptr<LivePage> served_page(const page::PageSurvey& survey, const page::PageSettings& settings) {
  return std::make_unique<ServedPage>(survey, settings);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const void* pulsecast_part(const char* version) {
  static constexpr LivePart functions{&served_page};
  return std::string_view(version) == PULSECAST_VERSION ? &functions : nullptr;
}
