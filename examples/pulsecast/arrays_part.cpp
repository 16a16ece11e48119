// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include <string_view>
#include <utility>

#include <pulsecast/io/npz.hpp>
#include <pulsecast/version.hpp>

#include "parts.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

template <class Writer>
class Arrays final : public PointFile {
 public:
  template <class Settings>
  Arrays(const fs::path& path, Settings&& settings) : writer_(path, std::forward<Settings>(settings)) {}
  void operator()(const EchoBatch& batch) override { writer_(batch); }
  void close() override { writer_.close(); }
  void count(LeftOut& /*sum*/) const override {}

 private:
  Writer writer_;
};

std::unique_ptr<PointFile> point_arrays(const fs::path& path, const io::PointLayout& layout,
                                        const io::PointSettings& points) {
  return std::make_unique<Arrays<io::NpzWriter>>(path, io::NpzSettings{.layout = layout, .points = points});
}

std::unique_ptr<PointFile> waveform_arrays(const fs::path& path, double start_time) {
  return std::make_unique<Arrays<io::WaveformNpzWriter>>(path, start_time);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const void* pulsecast_part(const char* version) {
  static constexpr ArraysPart functions{&point_arrays, &waveform_arrays};
  return std::string_view(version) == PULSECAST_VERSION ? &functions : nullptr;
}
