// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/writer.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::io::detail {
namespace {

using support::content;
using support::TemporaryFolder;

/// Keeps what it is told.
struct Told {
  std::vector<std::string> calls;
  std::string records;
  std::size_t record = 0;
};

/// Writes no record, but a word for all.
struct RecordsAside {
  static constexpr std::uint8_t format_bits = 64;
  static constexpr std::uint32_t descriptor_count = 1;
  [[nodiscard]] static std::vector<std::byte> descriptors() {
    const auto head = las_vlr_header("aside", 1, 0, "");
    return {head.begin(), head.end()};
  }

  void begin(OutputFile& file, std::size_t record, bool changed) {
    told->calls.push_back(changed ? "begin, changed" : "begin");
    told->record = record;
    file.write(std::string_view("<"));
  }
  void write(OutputFile& /*file*/, std::span<const std::byte> record) {
    told->records.append(reinterpret_cast<const char*>(record.data()), record.size());
  }
  template <class Change>
  void change(OutputFile& /*file*/, const Change& change) {
    told->calls.emplace_back("change");
    change(std::as_writable_bytes(std::span(told->records)));
  }
  void finish(OutputFile& file) {
    told->calls.emplace_back("finish");
    file.write(std::string_view(">"));
  }

  std::shared_ptr<Told> told;
};

template <class Number>
Number number(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A pulse straight down with two echoes, one twice as strong.
Told write(const std::filesystem::path& path, const LasSettings& settings) {
  const std::vector<Shot> shots{{.origin = {5, 6, 7}, .direction = {0, 0, -1}, .echoes = 2}};
  const std::vector<Echo> echoes{{.range = 1, .amplitude = 1e-6, .reflectance = 0.5, .number = 1},
                                 {.range = 2, .amplitude = 5e-7, .reflectance = 0.25, .number = 2}};
  const auto told = std::make_shared<Told>();
  LasFileWriter<RecordsAside> writer(path, settings, RecordsAside{told});
  writer(EchoBatch{shots, echoes, {}, 0});
  writer.close();
  return *told;
}

TEST_CASE("records go where they are taken to, and the file tells how") {
  const TemporaryFolder folder;
  const Told told = write(folder / "a", {});
  CHECK(told.calls == std::vector<std::string>{"begin", "finish"});
  CHECK(told.record == 62);
  CHECK(told.records.size() == 2 * told.record);
  CHECK(number<std::uint16_t>(told.records, 12) == 32768);
  const std::string file = content(folder / "a");
  CHECK(number<std::uint8_t>(file, 104) == 64 + 6);
  CHECK(number<std::uint32_t>(file, 100) == 2);  // extra bytes, and what the records bring
  const std::size_t points_at = number<std::uint32_t>(file, 96);
  CHECK(file.substr(points_at) == "<>");
  CHECK(file.substr(points_at - las_vlr_header_size + 2, 6) == std::string("aside\0", 6));
  CHECK(number<std::uint64_t>(file, 247) == 2);
}

TEST_CASE("intensities that need the greatest amplitude are changed at the end") {
  const TemporaryFolder folder;
  const Told told = write(folder / "a", {.intensity = LasIntensity::amplitude});
  CHECK(told.calls == std::vector<std::string>{"begin, changed", "change", "finish"});
  CHECK(number<std::uint16_t>(told.records, 12) == 65535);
  CHECK(number<std::uint16_t>(told.records, 62 + 12) == 32768);
  CHECK(write(folder / "b", {.intensity = LasIntensity::amplitude, .intensity_full_scale = 1.0}).calls.size() == 2);
}

TEST_CASE("what was written is read again in whole records, all of it, from where it is asked for") {
  const TemporaryFolder folder;
  OutputFile file(folder / "a");
  std::vector<std::byte> bytes(5 + 700'000 * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 3);
  file.write(bytes);
  std::vector<std::byte> again;
  std::size_t calls = 0;
  las_in_blocks(file, 5, 3, [&](std::uint64_t at, std::span<const std::byte> some) {
    CHECK(at == 5 + again.size());
    CHECK(some.size() % 3 == 0);
    again.insert(again.end(), some.begin(), some.end());
    ++calls;
  });
  CHECK(calls == 3);
  CHECK(again == std::vector<std::byte>(bytes.begin() + 5, bytes.end()));
}

}  // namespace
}  // namespace pulsecast::io::detail
