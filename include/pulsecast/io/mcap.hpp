// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MCAP_HPP
#define PULSECAST_IO_MCAP_HPP

#include <bit>
#include <map>

#include <pulsecast/io/output_file.hpp>
#include <pulsecast/version.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of an MCAP file.
struct McapSettings {
  std::string profile = "ros2";  ///< "ros2": all channels are of ROS 2; empty: any
  /// Length of a chunk, from 1 to 2^30; a longer message is alone in its chunk [byte]
  std::size_t chunk_size = std::size_t{1} << 20;

  /// @throws SettingError for settings out of range
  void validate() const { require_within("McapSettings::chunk_size", chunk_size, 1, 1 << 30, "byte"); }
};

/// Channel of an MCAP file: messages of one type on one topic. By default those of ROS 2.
struct McapChannel {
  std::string topic{};                      ///< topic
  std::string schema_name{};                ///< as "sensor_msgs/msg/PointCloud2"; empty: none
  std::string schema_encoding = "ros2msg";  ///< language of the schema
  std::string schema{};                     ///< definition of the type
  std::string message_encoding = "cdr";     ///< encoding of the messages
  /// Further texts by keys. The profile "ros2" requires the quality of service, in YAML, or empty
  std::map<std::string, std::string> metadata{{"offered_qos_profiles", ""}};
};

namespace detail {

static_assert(std::endian::native == std::endian::little,
              "MCAP files are little-endian, and are written as the numbers lie in memory");

/// Kind of a record. Source: mcap.dev/spec, Records.
enum class McapOpcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F
};

inline constexpr std::size_t mcap_record_head = 1 + 8;                                    ///< opcode, length [byte]
inline constexpr std::size_t mcap_chunk_head = mcap_record_head + 8 + 8 + 8 + 4 + 4 + 8;  ///< of a chunk [byte]
inline constexpr std::uint32_t mcap_no_crc = 0;  ///< absent checksum. Source: mcap.dev/spec

/// Record under construction: opcode, length of content, content. Source: mcap.dev/spec, Records.
class McapRecord {
 public:
  McapRecord& begin(McapOpcode opcode) {
    bytes_.clear();
    return add(static_cast<std::uint8_t>(opcode)).add(std::uint64_t{0});
  }

  McapRecord& add(std::unsigned_integral auto number) {
    const auto* const from = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), from, from + sizeof number);
    return *this;
  }

  McapRecord& add(std::string_view text) {
    return add_list([&] {
      const auto from = std::as_bytes(std::span(text));
      bytes_.insert(bytes_.end(), from.begin(), from.end());
    });
  }

  McapRecord& add(const std::map<std::string, std::string>& texts) {
    return add_list([&] {
      for (const auto& [key, text] : texts) add(key).add(text);
    });
  }

  /// Array or map: its length in bytes, and what `add_elements` adds.
  template <class AddElements>
  McapRecord& add_list(const AddElements& add_elements) {
    const std::size_t at = bytes_.size();
    add(std::uint32_t{0});
    add_elements();
    const auto length = static_cast<std::uint32_t>(bytes_.size() - at - sizeof(std::uint32_t));
    std::memcpy(bytes_.data() + at, &length, sizeof length);
    return *this;
  }

  /// The record, whose content ends with `further` bytes that follow it [byte].
  [[nodiscard]] std::span<const std::byte> bytes(std::uint64_t further = 0) {
    const std::uint64_t length = bytes_.size() - mcap_record_head + further;
    std::memcpy(bytes_.data() + 1, &length, sizeof length);
    return bytes_;
  }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace detail

/// Writes an MCAP file, which the tools of ROS 2 (rosbag2) and others read: chunks without
/// compression and checksums, with an index and statistics. Messages may have any encoding and
/// order. `close()` completes the file: see `OutputFile`. Source: mcap.dev/spec, 0.
class McapWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit McapWriter(std::filesystem::path path, McapSettings settings = {})
      : settings_(validated(std::move(settings))), file_(std::move(path)) {
    file_.write(magic);
    constexpr std::string_view library = "pulsecast " PULSECAST_VERSION;
    put(record_.begin(Opcode::header).add(settings_.profile).add(library));
  }

  /// Adds a channel, and returns its number. @throws SettingError beyond 65,535 @throws FileError
  [[nodiscard]] std::uint16_t add_channel(McapChannel channel) {
    require_within("McapWriter::add_channel (channels so far)", channels_.size(), 0, 65'534, "");
    const auto id = static_cast<std::uint16_t>(channels_.size());
    channels_.push_back({std::move(channel), {}, 0, 0});
    Channel& added = channels_.back();
    if (!added.settings.schema_name.empty()) {
      const auto same = std::ranges::find_if(channels_, [&, &a = added.settings](const Channel& other) {
        const McapChannel& b = other.settings;
        return a.schema_name == b.schema_name && a.schema_encoding == b.schema_encoding && a.schema == b.schema;
      });
      added.schema = static_cast<std::uint16_t>(same - channels_.begin() + 1);  // from 1
      if (brings_schema(id)) put_schema(id);
    }
    put_channel(id);
    return id;
  }

  /// Appends texts by keys, under a name. @throws FileError
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& texts) {
    if (in_chunk_) end_chunk();
    metadata_.push_back({name, file_.position(), 0});
    put(record_.begin(Opcode::metadata).add(name).add(texts));
    metadata_.back().size = file_.position() - metadata_.back().start;
  }

  /// Appends a message to a channel, with the times when it was recorded and published [ns].
  /// @throws SettingError for a channel that does not exist @throws FileError
  void write(std::uint16_t channel, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
             std::span<const std::byte> data) {
    if (channel >= channels_.size())
      throw SettingError("McapWriter::write (channel)", channel, "", "one that add_channel has returned");
    constexpr std::uint64_t message_head = detail::mcap_record_head + 2 + 4 + 8 + 8;
    const std::uint64_t end = file_.position() + message_head + data.size();
    if (in_chunk_ && end - chunks_.back().records() > settings_.chunk_size) end_chunk();
    if (!in_chunk_) begin_chunk();
    Channel& of = channels_[channel];
    Chunk& chunk = chunks_.back();
    of.index.emplace_back(log_time_ns, file_.position() - chunk.records());
    const auto sequence = static_cast<std::uint32_t>(of.messages++);
    record_.begin(Opcode::message).add(channel).add(sequence).add(log_time_ns).add(publish_time_ns);
    file_.write(record_.bytes(data.size()));
    file_.write(data);
    chunk.times.add(log_time_ns, log_time_ns);
  }

  /// Writes the summary, and completes the file. @throws FileError
  void close() {
    if (in_chunk_) end_chunk();
    put(record_.begin(Opcode::data_end).add(detail::mcap_no_crc));
    const std::uint64_t summary = file_.position();
    const std::vector<Group> groups = put_summary();
    const std::uint64_t offsets = file_.position();
    for (const auto& [opcode, start, end] : groups)
      put(record_.begin(Opcode::summary_offset).add(static_cast<std::uint8_t>(opcode)).add(start).add(end - start));
    put(record_.begin(Opcode::footer).add(summary).add(offsets).add(detail::mcap_no_crc));
    file_.write(magic);
    file_.commit();
  }

 private:
  using Opcode = detail::McapOpcode;

  /// First and last of times [ns].
  struct Times {
    std::uint64_t first = std::numeric_limits<std::uint64_t>::max(), last = 0;

    void add(std::uint64_t from, std::uint64_t to) noexcept {
      first = std::min(first, from);
      last = std::max(last, to);
    }
  };

  struct Channel {
    McapChannel settings;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // times, positions in the chunk
    std::uint64_t messages;
    std::uint16_t schema;  // number of the schema; 0: none
  };

  struct Chunk {
    std::uint64_t start = 0, size = 0;  // position in the file; length of its records [byte]
    Times times{};
    std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes{};  // channels, positions [byte]
    std::uint64_t indexes_size = 0;                                  // of these records [byte]

    [[nodiscard]] std::uint64_t records() const noexcept { return start + detail::mcap_chunk_head; }
  };

  struct Metadata {
    std::string name;
    std::uint64_t start, size;  // of its record [byte]
  };

  /// Records of one kind in the summary.
  struct Group {
    Opcode opcode;
    std::uint64_t start, end;  // positions in the file [byte]
  };

  static constexpr std::string_view magic = "\x89MCAP0\r\n";  // Source: mcap.dev/spec, Magic

  void put(detail::McapRecord& record) { file_.write(record.bytes()); }

  /// True if a channel is the first with its schema, which has the number of this channel, from 1.
  bool brings_schema(std::size_t id) const noexcept { return channels_[id].schema == id + 1; }

  void put_schema(std::size_t id) {
    const McapChannel& of = channels_[id].settings;
    record_.begin(Opcode::schema).add(channels_[id].schema);
    put(record_.add(of.schema_name).add(of.schema_encoding).add(of.schema));
  }

  void put_channel(std::size_t id) {
    const McapChannel& of = channels_[id].settings;
    record_.begin(Opcode::channel).add(static_cast<std::uint16_t>(id)).add(channels_[id].schema);
    put(record_.add(of.topic).add(of.message_encoding).add(of.metadata));
  }

  /// Head of a chunk, to be overwritten when its length and times are known.
  [[nodiscard]] std::span<const std::byte> chunk_head(const Chunk& chunk) {
    record_.begin(Opcode::chunk).add(chunk.times.first).add(chunk.times.last).add(chunk.size);
    return record_.add(detail::mcap_no_crc).add(std::string_view()).add(chunk.size).bytes(chunk.size);
  }

  void begin_chunk() {
    const Chunk chunk{.start = file_.position()};
    file_.write(chunk_head(chunk));
    chunks_.push_back(chunk);
    in_chunk_ = true;
  }

  void end_chunk() {
    in_chunk_ = false;
    Chunk& chunk = chunks_.back();
    const std::uint64_t end = file_.position();
    chunk.size = end - chunk.records();
    file_.overwrite(chunk.start, chunk_head(chunk));
    for (std::size_t id = 0; id < channels_.size(); ++id) {
      auto& index = channels_[id].index;
      if (index.empty()) continue;
      const auto number = static_cast<std::uint16_t>(id);
      chunk.indexes.emplace_back(number, file_.position());
      put(record_.begin(Opcode::message_index).add(number).add_list([&] {
        for (const auto& [time, position] : index) record_.add(time).add(position);
      }));
      index.clear();
    }
    chunk.indexes_size = file_.position() - end;
  }

  [[nodiscard]] std::vector<Group> put_summary() {
    std::vector<Group> groups;
    const auto put_group = [&](Opcode opcode, const auto& put_records) {
      const std::uint64_t start = file_.position();
      put_records();
      if (file_.position() > start) groups.push_back({opcode, start, file_.position()});
    };
    put_group(Opcode::schema, [&] {
      for (std::size_t id = 0; id < channels_.size(); ++id)
        if (brings_schema(id)) put_schema(id);
    });
    put_group(Opcode::channel, [&] {
      for (std::size_t id = 0; id < channels_.size(); ++id) put_channel(id);
    });
    put_group(Opcode::statistics, [&] { put_statistics(); });
    put_group(Opcode::chunk_index, [&] {
      for (const Chunk& chunk : chunks_) put_chunk_index(chunk);
    });
    put_group(Opcode::metadata_index, [&] {
      for (const auto& [name, start, size] : metadata_)
        put(record_.begin(Opcode::metadata_index).add(start).add(size).add(name));
    });
    return groups;
  }

  void put_statistics() {
    std::uint64_t messages = 0;
    std::uint16_t schemas = 0;
    for (std::size_t id = 0; id < channels_.size(); ++id) {
      messages += channels_[id].messages;
      if (brings_schema(id)) ++schemas;
    }
    Times times = chunks_.empty() ? Times{0, 0} : Times{};
    for (const Chunk& chunk : chunks_) times.add(chunk.times.first, chunk.times.last);
    const auto channels = static_cast<std::uint32_t>(channels_.size());
    record_.begin(Opcode::statistics).add(messages).add(schemas).add(channels);
    record_.add(std::uint32_t{0}).add(static_cast<std::uint32_t>(metadata_.size()));  // attachments, metadata
    record_.add(static_cast<std::uint32_t>(chunks_.size())).add(times.first).add(times.last);
    put(record_.add_list([&] {
      for (std::size_t id = 0; id < channels_.size(); ++id)
        record_.add(static_cast<std::uint16_t>(id)).add(channels_[id].messages);
    }));
  }

  void put_chunk_index(const Chunk& chunk) {
    record_.begin(Opcode::chunk_index).add(chunk.times.first).add(chunk.times.last);
    record_.add(chunk.start).add(detail::mcap_chunk_head + chunk.size);
    record_.add_list([&] {
      for (const auto& [channel, position] : chunk.indexes) record_.add(channel).add(position);
    });
    put(record_.add(chunk.indexes_size).add(std::string_view()).add(chunk.size).add(chunk.size));
  }

  McapSettings settings_;
  OutputFile file_;
  detail::McapRecord record_;  // the one under construction, kept for its memory
  std::vector<Channel> channels_;
  std::vector<Chunk> chunks_;
  std::vector<Metadata> metadata_;
  bool in_chunk_ = false;  // true if the last chunk is open
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
