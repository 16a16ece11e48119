// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/mcap.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::TemporaryFolder;

/// Reads numbers and texts one after another, by the serialization rules of the format.
class Cursor {
 public:
  explicit Cursor(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() { return take(number<std::uint32_t>()); }
  std::string take(std::uint64_t length) {
    if (length > bytes_.size() - at_) throw std::runtime_error("a record ends too early");
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }
  [[nodiscard]] std::string rest() { return take(bytes_.size() - at_); }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::uint64_t position() const { return at_; }

 private:
  std::string bytes_;
  std::uint64_t at_ = 0;
};

struct Record {
  int opcode = 0;
  std::uint64_t start = 0, length = 0;  // with its head
  std::string content;
};

/// Records one after another; `from` is where they begin in the file.
std::vector<Record> records_of(const std::string& bytes, std::uint64_t from) {
  std::vector<Record> records;
  for (Cursor cursor(bytes); !cursor.at_end();) {
    Record record{.start = from + cursor.position(), .content = {}};
    record.opcode = cursor.number<std::uint8_t>();
    record.content = cursor.take(cursor.number<std::uint64_t>());
    record.length = 9 + record.content.size();
    records.push_back(record);
  }
  return records;
}

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
  std::string data;
  friend bool operator==(const Message&, const Message&) = default;
};

Message message_of(const Record& record) {
  REQUIRE(record.opcode == 5);
  Cursor at(record.content);
  Message m;
  m.channel = at.number<std::uint16_t>();
  m.sequence = at.number<std::uint32_t>();
  m.log_time = at.number<std::uint64_t>();
  m.publish_time = at.number<std::uint64_t>();
  m.data = at.rest();
  return m;
}

using Times = std::pair<std::uint64_t, std::uint64_t>;

/// Chunk as the records around it tell it.
struct Chunk {
  Times times{};
  std::uint64_t start = 0, length = 0, size = 0;
  std::map<std::uint16_t, std::uint64_t> indexes;  // position of each channel's message index
  std::uint64_t indexes_length = 0;
  friend bool operator==(const Chunk&, const Chunk&) = default;
};

/// Contents of a file, found by a walk over all its records, which requires that all positions and counts in it are
/// right.
struct Walk {
  std::string header, file;
  std::map<std::uint16_t, std::string> schemas, channels;  // contents of the records, by number
  std::vector<Message> messages;
  std::vector<Chunk> chunks;
  std::vector<Record> metadata;

  explicit Walk(const std::filesystem::path& path) : file(content(path)) {
    const std::string magic("\x89MCAP0\r\n", 8);
    REQUIRE((file.size() > 16 && file.starts_with(magic) && file.ends_with(magic)));
    const std::vector<Record> records = records_of(file.substr(8, file.size() - 16), 8);
    REQUIRE((records.front().opcode == 1 && records.back().opcode == 2));
    header = records.front().content;
    std::size_t i = 1;
    while (records.at(i).opcode != 15) i = read_data(records, i);
    CHECK(records[i].content == std::string(4, '\0'));
    read_summary(records, i + 1);
  }

  void add_definition(const Record& record) {
    const auto id = Cursor(record.content).number<std::uint16_t>();
    auto& table = record.opcode == 3 ? schemas : channels;
    REQUIRE(table.emplace(id, record.content).second);
    if (record.opcode == 3) CHECK(id > 0);
    if (record.opcode == 4) {
      Cursor at(record.content);
      at.take(2);
      const auto schema = at.number<std::uint16_t>();
      CHECK((schema == 0 || schemas.contains(schema)));
    }
  }

  /// Reads a schema or channel, or a chunk with its indexes; returns the place of the next record.
  std::size_t read_data(const std::vector<Record>& records, std::size_t i) {
    if (records[i].opcode == 12) {
      metadata.push_back(records[i]);
      return i + 1;
    }
    if (records[i].opcode != 6) {
      REQUIRE((records[i].opcode == 3 || records[i].opcode == 4));
      add_definition(records[i]);
      return i + 1;
    }
    Cursor at(records[i].content);
    Chunk chunk{.start = records[i].start, .length = records[i].length, .indexes = {}};
    chunk.times.first = at.number<std::uint64_t>();
    chunk.times.second = at.number<std::uint64_t>();
    chunk.size = at.number<std::uint64_t>();
    CHECK((at.number<std::uint32_t>() == 0 && at.text().empty() && at.number<std::uint64_t>() == chunk.size));
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>>
        found;  // time and place of each message
    Times times{~std::uint64_t{0}, 0};
    for (const Record& record : records_of(at.rest(), 0)) {
      if (record.opcode != 5) {
        add_definition(record);
        continue;
      }
      messages.push_back(message_of(record));
      const Message& m = messages.back();
      CHECK(channels.contains(m.channel));
      found[m.channel].emplace_back(m.log_time, record.start);
      times = {std::min(times.first, m.log_time), std::max(times.second, m.log_time)};
    }
    CHECK(chunk.times == times);
    for (++i; records.at(i).opcode == 7; ++i) {
      Cursor index(records[i].content);
      const auto channel = index.number<std::uint16_t>();
      Cursor entries(index.text());
      CHECK(index.at_end());
      for (const auto& [time, place] : found.at(channel))
        CHECK((entries.number<std::uint64_t>() == time && entries.number<std::uint64_t>() == place));
      CHECK(entries.at_end());
      REQUIRE(chunk.indexes.emplace(channel, records[i].start).second);
      chunk.indexes_length += records[i].length;
    }
    CHECK(chunk.indexes.size() == found.size());
    chunks.push_back(chunk);
    return i;
  }

  void read_summary(const std::vector<Record>& records, std::size_t i) {
    std::map<std::uint16_t, std::string> schema_copies, channel_copies;
    std::vector<Chunk> chunk_copies;
    std::map<int, Times> groups;  // by opcode: start and length
    const std::uint64_t summary = records.at(i).start;
    std::size_t indexed = 0;  // of the metadata
    for (; records.at(i).opcode != 14; ++i) {
      const Record& record = records[i];
      if (groups.contains(record.opcode)) {
        Times& group = groups[record.opcode];
        CHECK(group.first + group.second == record.start);  // records of a kind are together
        group.second += record.length;
      } else {
        groups[record.opcode] = {record.start, record.length};
      }
      if (record.opcode == 3 || record.opcode == 4)
        (record.opcode == 3 ? schema_copies : channel_copies)[Cursor(record.content).number<std::uint16_t>()] =
            record.content;
      if (record.opcode == 8) chunk_copies.push_back(chunk_index(record));
      if (record.opcode == 11) check_statistics(record);
      if (record.opcode == 13) {
        const Record& of = metadata.at(indexed++);
        Cursor at(record.content);
        CHECK((at.number<std::uint64_t>() == of.start && at.number<std::uint64_t>() == of.length));
        CHECK((at.text() == Cursor(of.content).text() && at.at_end()));
      }
    }
    CHECK(indexed == metadata.size());
    CHECK((schema_copies == schemas && channel_copies == channels && chunk_copies == chunks && groups.contains(11)));
    const std::uint64_t offsets = records[i].start;
    for (; records.at(i).opcode == 14; ++i) {
      Cursor at(records[i].content);
      const Times group = groups.at(at.number<std::uint8_t>());
      CHECK((at.number<std::uint64_t>() == group.first && at.number<std::uint64_t>() == group.second && at.at_end()));
      groups.erase(records[i].content[0]);
    }
    CHECK((groups.empty() && i + 1 == records.size()));
    Cursor footer(records[i].content);
    CHECK((footer.number<std::uint64_t>() == summary && footer.number<std::uint64_t>() == offsets));
    CHECK((footer.number<std::uint32_t>() == 0 && footer.at_end()));
  }

  static Chunk chunk_index(const Record& record) {
    Cursor at(record.content);
    Chunk chunk;
    chunk.times.first = at.number<std::uint64_t>();
    chunk.times.second = at.number<std::uint64_t>();
    chunk.start = at.number<std::uint64_t>();
    chunk.length = at.number<std::uint64_t>();
    for (Cursor map(at.text()); !map.at_end();) {
      const auto channel = map.number<std::uint16_t>();
      chunk.indexes[channel] = map.number<std::uint64_t>();
    }
    chunk.indexes_length = at.number<std::uint64_t>();
    CHECK(at.text().empty());
    chunk.size = at.number<std::uint64_t>();
    CHECK((at.number<std::uint64_t>() == chunk.size && at.at_end()));
    return chunk;
  }

  void check_statistics(const Record& record) const {
    std::map<std::uint16_t, std::uint64_t> counts;
    for (const auto& [id, any] : channels) counts[id] = 0;
    Times times = messages.empty() ? Times{0, 0} : Times{~std::uint64_t{0}, 0};
    for (const Message& m : messages) {
      ++counts[m.channel];
      times = {std::min(times.first, m.log_time), std::max(times.second, m.log_time)};
    }
    Cursor at(record.content);
    CHECK((at.number<std::uint64_t>() == messages.size() && at.number<std::uint16_t>() == schemas.size()));
    CHECK((at.number<std::uint32_t>() == channels.size() && at.number<std::uint32_t>() == 0 &&
           at.number<std::uint32_t>() == metadata.size()));  // 0: attachments
    CHECK(at.number<std::uint32_t>() == chunks.size());
    CHECK((at.number<std::uint64_t>() == times.first && at.number<std::uint64_t>() == times.second));
    for (Cursor map(at.text()); !map.at_end();) {
      const auto channel = map.number<std::uint16_t>();
      CHECK(map.number<std::uint64_t>() == counts.at(channel));
      counts.erase(channel);
    }
    CHECK((counts.empty() && at.at_end()));
  }
};

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string string_of(const std::string& text) {
  const auto length = static_cast<std::uint32_t>(text.size());
  return std::string(reinterpret_cast<const char*>(&length), sizeof length) + text;
}

TEST_CASE("files of any channels and messages hold them in order, and every position and count in them is right") {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const auto chunk_size = static_cast<std::size_t>(any.log_uniform(1, 1e5));
    McapWriter writer(folder / "any.mcap", {.chunk_size = chunk_size});
    std::vector<Message> written;
    std::vector<std::uint32_t> sequences;
    for (std::uint64_t left = any.whole(200); left > 0; --left) {
      if (sequences.empty() || any.whole(20) == 0) {
        const std::string type = "types/msg/T" + std::to_string(any.whole(3));
        CHECK(writer.add_channel(
                  {.topic = "/t" + std::to_string(sequences.size()), .schema_name = type, .schema = "int8 x"}) ==
              sequences.size());
        sequences.push_back(0);
      }
      Message m;
      m.channel = static_cast<std::uint16_t>(any.whole(sequences.size()));
      m.sequence = sequences[m.channel]++;
      m.log_time = any.whole(1'000'000);
      m.publish_time = any.whole(1'000'000);
      m.data.resize(any.whole(3) == 0 ? 0 : static_cast<std::size_t>(any.log_uniform(1, 1e4)),
                    static_cast<char>(any.whole(256)));
      writer.write(m.channel, m.log_time, m.publish_time, bytes_of(m.data));
      written.push_back(m);
    }
    writer.close();
    const Walk walk(folder / "any.mcap");
    CHECK(walk.messages == written);
    CHECK(walk.channels.size() == sequences.size());
  }
}

TEST_CASE("a header names the profile and the library, and channels of one schema share it") {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap", {.profile = "x"});
  const McapChannel points{.topic = "/a", .schema_name = "p/msg/P", .schema = "int8 p"};
  CHECK(writer.add_channel(points) == 0);
  CHECK(writer.add_channel({.topic = "/b", .schema_name = "p/msg/Q", .schema = "int8 p"}) == 1);
  CHECK(writer.add_channel(
            {.topic = "/c", .schema_name = "p/msg/P", .schema = "int8 p", .metadata = {{"k", "v"}, {"l", ""}}}) == 2);
  CHECK(writer.add_channel({.topic = "/d", .schema_encoding = "", .message_encoding = "json", .metadata = {}}) == 3);
  writer.close();
  const Walk walk(folder / "a.mcap");
  CHECK(walk.header == string_of("x") + string_of("pulsecast " PULSECAST_VERSION));
  const auto id = [](char number) { return std::string{number, '\0'}; };
  const std::string rest = string_of("ros2msg") + string_of("int8 p"),
                    qos = string_of("offered_qos_profiles") + string_of("");
  CHECK(walk.schemas == std::map<std::uint16_t, std::string>{{std::uint16_t{1}, id(1) + string_of("p/msg/P") + rest},
                                                             {std::uint16_t{2}, id(2) + string_of("p/msg/Q") + rest}});
  CHECK(walk.channels.at(0) == id(0) + id(1) + string_of("/a") + string_of("cdr") + string_of(qos));
  CHECK(walk.channels.at(1) == id(1) + id(2) + string_of("/b") + string_of("cdr") + string_of(qos));
  CHECK(walk.channels.at(2) == id(2) + id(1) + string_of("/c") + string_of("cdr") +
                                   string_of(string_of("k") + string_of("v") + string_of("l") + string_of("")));
  CHECK(walk.channels.at(3) == id(3) + id(0) + string_of("/d") + string_of("json") + string_of(""));
  CHECK((walk.messages.empty() && walk.chunks.empty()));
}

TEST_CASE("metadata stand between chunks, with their name and texts, and are indexed") {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  writer.add_metadata("empty", {});
  const std::uint16_t channel = writer.add_channel({.topic = "/a"});
  writer.write(channel, 1, 1, bytes_of("one"));
  writer.add_metadata("two", {{"k", "v"}, {"l", ""}});
  writer.write(channel, 2, 2, bytes_of("two"));
  writer.close();
  const Walk walk(folder / "a.mcap");
  REQUIRE((walk.metadata.size() == 2 && walk.chunks.size() == 2));
  CHECK(walk.metadata[0].content == string_of("empty") + string_of(""));
  CHECK(walk.metadata[1].content ==
        string_of("two") + string_of(string_of("k") + string_of("v") + string_of("l") + string_of("")));
}

TEST_CASE("a file without channels is complete, too") {
  const TemporaryFolder folder;
  McapWriter(folder / "a.mcap").close();
  CHECK(Walk(folder / "a.mcap").channels.empty());
}

TEST_CASE("chunks end before they exceed their size, and a longer message is a chunk by itself") {
  const TemporaryFolder folder;
  const auto sizes = [&](std::size_t chunk_size, const std::vector<std::size_t>& lengths) {
    McapWriter writer(folder / "a.mcap", {.chunk_size = chunk_size});
    const std::uint16_t channel = writer.add_channel({.topic = "/a"});
    for (const std::size_t length : lengths) writer.write(channel, 1, 1, bytes_of(std::string(length, 'x')));
    writer.close();
    std::vector<std::uint64_t> found;
    for (const Chunk& chunk : Walk(folder / "a.mcap").chunks) found.push_back(chunk.size);
    return found;
  };
  const std::size_t head = 9 + 22;  // of a message
  CHECK(sizes(3 * (head + 10), {10, 10, 10, 10}) == std::vector<std::uint64_t>{3 * (head + 10), head + 10});
  CHECK(sizes(3 * (head + 10) - 1, {10, 10, 10, 10}) == std::vector<std::uint64_t>{2 * (head + 10), 2 * (head + 10)});
  CHECK(sizes(1000, {10, 5'000'000, 10}) == std::vector<std::uint64_t>{head + 10, head + 5'000'000, head + 10});
  CHECK(sizes(1, {0, 0}) == std::vector<std::uint64_t>{head, head});
}

TEST_CASE("a channel that does not exist, too many channels, and settings out of range are refused") {
  const TemporaryFolder folder;
  McapWriter writer(folder / "a.mcap");
  CHECK_THROWS_WITH_AS(writer.write(0, 0, 0, {}), doctest::Contains("one that add_channel has returned"), SettingError);
  for (std::uint32_t id = 0; id < 65'535; ++id)
    REQUIRE(writer.add_channel({.topic = "/a", .schema_name = "p/msg/P"}) == id);
  CHECK_THROWS_WITH_AS(static_cast<void>(writer.add_channel({})), doctest::Contains("McapWriter::add_channel"),
                       SettingError);
  writer.write(65'534, 0, 0, {});
  writer.close();
  CHECK(Walk(folder / "a.mcap").channels.size() == 65'535);
  CHECK_THROWS_AS(McapWriter(folder / "b.mcap", {.chunk_size = 0}), SettingError);
  CHECK_THROWS_AS(McapWriter(folder / "b.mcap", {.chunk_size = (std::size_t{1} << 30) + 1}), SettingError);
}

TEST_CASE("nothing is left without close, nothing can be written after it, and a full disk is an error") {
  const TemporaryFolder folder;
  {
    McapWriter writer(folder / "a.mcap");
    writer.write(writer.add_channel({.topic = "/a"}), 0, 0, bytes_of("lost"));
  }
  CHECK(folder.empty());
  std::filesystem::create_symlink("/dev/full", folder / "a.mcap.part");
  McapWriter full(folder / "a.mcap");
  const std::uint16_t channel = full.add_channel({.topic = "/a"});
  full.write(channel, 0, 0, {});
  CHECK_THROWS_AS(full.close(), FileError);
  CHECK(folder.empty());
  McapWriter writer(folder / "a.mcap");
  CHECK(writer.add_channel({.topic = "/a"}) == channel);
  writer.close();
  const std::string before = content(folder / "a.mcap");
  CHECK_THROWS_AS(writer.write(channel, 0, 0, {}), FileError);
  CHECK_THROWS_AS(static_cast<void>(writer.add_channel({.topic = "/b"})), FileError);
  CHECK_THROWS_AS(writer.close(), FileError);
  CHECK(content(folder / "a.mcap") == before);
}

}  // namespace
}  // namespace pulsecast::io
