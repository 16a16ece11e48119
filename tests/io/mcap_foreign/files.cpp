// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes MCAP files, and beside each what others should read in it, a JSON object a line: first the channels, then
// every message in the order of their times, with its bytes in hexadecimal digits, and with the numbers of its points
// if it is a scan. Usage: files FOLDER.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/io/mcap.hpp>
#include <pulsecast/io/point_cloud2.hpp>
#include <pulsecast/io/scan_splitter.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
namespace fs = std::filesystem;

namespace {

/// File, and what it should hold.
class Twin {
 public:
  Twin(const fs::path& path, const McapSettings& settings) : writer_(path, settings), told_(path.string() + "l") {}

  std::uint16_t add_channel(const McapChannel& channel) {
    channels_.push_back(channel);
    sequences_.push_back(0);
    return writer_.add_channel(channel);
  }

  void write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time, std::span<const std::byte> data,
             const std::string& scan = "null") {
    writer_.write(channel, log_time, publish_time, data);
    std::ostringstream line;
    line << R"({"channelId":)" << channel << R"(,"sequence":)" << sequences_[channel]++ << R"(,"logTime":")" << log_time
         << R"(","publishTime":")" << publish_time << R"(","data":")" << hex(data) << R"(","scan":)" << scan << "}\n";
    messages_.emplace_back(log_time, line.str());
  }

  void close() {
    writer_.close();
    told_ << '[';
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const McapChannel& c = channels_[i];
      told_ << (i > 0 ? "," : "") << R"({"topic":")" << c.topic << R"(","schemaName":")" << c.schema_name
            << R"(","schemaEncoding":")" << c.schema_encoding << R"(","schema":")"
            << hex(std::as_bytes(std::span(c.schema))) << R"(","messageEncoding":")" << c.message_encoding
            << R"(","messages":)" << sequences_[i] << R"(,"metadata":{)";
      for (auto pair = c.metadata.begin(); pair != c.metadata.end(); ++pair)
        told_ << (pair != c.metadata.begin() ? "," : "") << '"' << pair->first << R"(":")" << pair->second << '"';
      told_ << "}}";
    }
    told_ << "]\n";
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [time, line] : messages_) told_ << line;
    told_.close();
    if (!told_) throw FileError("the file of what is written", "", "cannot be written");
  }

 private:
  static std::string hex(std::span<const std::byte> bytes) {
    std::string text;
    for (const std::byte b : bytes) {
      text += "0123456789abcdef"[static_cast<std::size_t>(b >> 4)];
      text += "0123456789abcdef"[static_cast<std::size_t>(b & std::byte{15})];
    }
    return text;
  }

  McapWriter writer_;
  std::ofstream told_;
  std::vector<McapChannel> channels_;
  std::vector<std::uint64_t> sequences_;
  std::vector<std::pair<std::uint64_t, std::string>> messages_;
};

void write_random(const fs::path& path, std::uint64_t seed, std::size_t messages, std::size_t chunk_size) {
  support::Generator any(seed);
  Twin twin(path, {.chunk_size = chunk_size});
  std::vector<std::uint16_t> channels;
  for (std::size_t i = 0; i < messages; ++i) {
    if (channels.empty() || any.whole(10) == 0) {
      const std::string number = std::to_string(any.whole(3));
      channels.push_back(twin.add_channel({.topic = "/topic" + std::to_string(channels.size()),
                                           .schema_name = number == "0" ? "" : "types/msg/T" + number,
                                           .schema = "int8 x" + number,
                                           .metadata = {{"first", number}, {"second", ""}}}));
    }
    std::vector<std::byte> data(static_cast<std::size_t>(any.log_uniform(1, 3000)) - 1);
    for (std::byte& b : data) b = static_cast<std::byte>(any.whole(256));
    twin.write(channels[any.whole(channels.size())], 1'700'000'000'000'000'000 + 1000 * i + any.whole(100'000),
               any.whole(1'000'000), data);
  }
  twin.close();
}

/// Scan as an object: fields and numbers of its points as stored.
std::string told(const PointBuffer& scan) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << R"({"stamp":")" << stamp_ns(scan) << R"(","step":)" << scan.layout().size << R"(,"fields":[)";
  for (std::size_t i = 0; i < scan.layout().fields.size(); ++i) {
    const PointField& field = scan.layout().fields[i];
    text << (i > 0 ? "," : "") << R"({"name":")" << field.name << R"(","offset":)" << field.offset << R"(,"datatype":)"
         << static_cast<int>(field.type) << R"(,"count":1})";
  }
  text << R"(],"points":[)";
  for (std::size_t i = 0; i < scan.size(); ++i) {
    text << (i > 0 ? ",[" : "[");
    for (const PointField& field : scan.layout().fields)
      text << (&field != scan.layout().fields.data() ? "," : "") << scan.number(i, field);
    text << ']';
  }
  text << "]}";
  return text.str();
}

/// Scans of a drive, as a program of a user records them, and its log on another topic.
void write_survey(const fs::path& path, const PointLayout& layout) {
  support::Generator random(1);
  MeshData mesh = support::net(20, [](double x, double y) { return std::sin(x / 3) * std::cos(y / 2); });
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh))}});
  SpinningSensor sensor = velodyne_vlp_16();
  sensor.sequence_rate = 900;  // for a short test
  const Platform platform{StraightLine{.from = {10, 5, 2}, .to = {10, 15, 2}, .speed = 20}, Mount{},
                          sensor.source(0.5)};
  const Survey survey{platform, SingleRay{}, scene, sensor.receiver(), FirstHit{}};
  const PointSettings settings{.sensor = [&](Tick t) { return platform.instrument_at(t); },
                               .axes = PointAxes::forward_left_up,
                               .rings = sensor.rings(),
                               .start_time = 1'700'000'000,
                               .surfaces = surfaces_of(scene)};

  Twin bag(path, {});
  const auto points =
      bag.add_channel({.topic = "/points", .schema_name = point_cloud2_type, .schema = point_cloud2_definition});
  const auto log =
      bag.add_channel({.topic = "/log", .schema_encoding = "", .message_encoding = "json", .metadata = {}});
  std::vector<std::byte> message;
  ScanSplitter scans(PointBuffer(layout, settings), 10, [&](const PointBuffer& scan) {
    serialize_point_cloud2(scan, "lidar", message);
    bag.write(points, stamp_ns(scan), stamp_ns(scan), message, told(scan));
    const std::string text = R"({"points":)" + std::to_string(scan.size()) + '}';
    bag.write(log, stamp_ns(scan) + 1, stamp_ns(scan), std::as_bytes(std::span(text)));
  });
  run(survey, {}, scans);
  scans.close();
  bag.close();
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const fs::path folder = words[1];
  fs::create_directories(folder);
  write_random(folder / "empty.mcap", 0, 0, 1000);
  write_random(folder / "one_chunk.mcap", 1, 100, 1'000'000);
  write_random(folder / "a_chunk_a_message.mcap", 2, 50, 1);
  write_random(folder / "overlapping_chunks.mcap", 3, 500, 10'000);
  write_survey(folder / "scans_velodyne.mcap", layouts::velodyne().with(layouts::labels()));
  write_survey(folder / "scans_map.mcap", layouts::map());
  write_survey(folder / "scans_ouster.mcap", layouts::ouster());
}
