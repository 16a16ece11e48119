// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_LAZ_HPP
#define PULSECAST_MPI_LAZ_HPP

#include <pulsecast/io/laz.hpp>
#include <pulsecast/mpi/las.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// LAZ file written by all processes, with the bytes of `LazWriter`. The process with the first
/// point of a chunk compresses it; others send their parts. The first sums up the sizes.
class MpiLaz final : public detail::MpiLasOutput<io::LazWriter> {
 public:
  /// `threads` per process, 0 as in `thread_count`. Throws a `SettingError` or `FileError`.
  MpiLaz(MpiGroup& group, const std::filesystem::path& path, io::LasSettings settings, unsigned threads = 0)
      : MpiLasOutput(group, path, io::LazWriter::compressible(detail::mpi_las_settings(std::move(settings)))),
        threads_(thread_count(threads)) {
    if (group.first()) {
      whole_.emplace(path, settings_, threads);
      end_ = whole_->records_at();
    }
  }

  /// Keeps chunks that begin in the piece; sends the points before to the owner of their chunk.
  void put(MpiPiece& piece, const MpiPlace& place) override {
    std::uint64_t at = place.starts[0];
    std::span<const std::byte> records = take(static_cast<detail::MpiLasPiece&>(piece), place);
    while (!records.empty()) {
      const std::uint64_t before = at % chunk_points;
      const auto some = records.first(std::min(records.size(), (chunk_points - before) * record_));
      if (before == 0 || place.chunk_owner == group().rank())
        add(at, some);
      else
        send(place.chunk_owner, std::move(MpiMessage().add(MessageKind::part).add(at).add(some)));
      records = records.subspan(some.size());
      at += some.size() / record_;
    }
  }

  [[nodiscard]] MpiPlace place(const MpiExtent& extent, int owner) override {
    MpiPlace place = next_points(extent);
    place.chunk_owner = chunk_owner_;
    if (chunks_of(points_) > chunks_of(place.starts[0])) chunk_owner_ = owner;
    return place;
  }

  void receive(int from, MpiMessage message) override {
    switch (message.next<MessageKind>()) {
      case MessageKind::part: {
        const auto at = message.next<std::uint64_t>();
        return add(at, message.rest());
      }
      case MessageKind::sizes:
        while (!message.rest().empty()) {
          const auto [number, size] = message.next<Size>();
          sizes_.emplace(number, std::pair(size, from));
        }
        return place_chunks();
      case MessageKind::position: {
        const auto [number, position] = message.next<Size>();
        return points_file_.write(position, compressed_.extract(number).mapped());
      }
      case MessageKind::all_points:
        all_points_ = message.next<std::uint64_t>();
        if (const auto last = gathered_.find(*all_points_ / chunk_points); last != gathered_.end()) finish(last);
        return;
      case MessageKind::all_placed:
        all_placed_ = true;
        return;
    }
  }

  /// Compresses up to one chunk per thread.
  bool work() override {
    std::vector<Chunk> some;
    for (; !ready_.empty() && some.size() < threads_; ready_.pop_front()) some.push_back(std::move(ready_.front()));
    if (some.empty()) return false;
    for_each_index(some.size(), threads_,
                   [&](std::size_t i) { some[i].bytes = io::LazWriter::compressed_chunk(some[i].bytes, settings_); });
    MpiMessage sizes;
    sizes.add(MessageKind::sizes);
    for (Chunk& chunk : some) {
      sizes.add(Size{chunk.number, chunk.bytes.size()});
      compressed_.emplace(chunk.number, std::move(chunk.bytes));
    }
    send(0, std::move(sizes));
    return true;
  }

  [[nodiscard]] bool full() const noexcept override { return compressed_.size() + ready_.size() > max_waiting; }

  void close() override {
    if (group().first())
      for (int rank = 0; rank < group().size(); ++rank)
        send(rank, std::move(MpiMessage().add(MessageKind::all_points).add(points_)));
    work_until([&] {
      if (group().first() && !all_told_ && sizes_of_placed_.size() == chunks_of(points_)) {
        all_told_ = true;
        for (int rank = 0; rank < group().size(); ++rank)
          send(rank, std::move(MpiMessage().add(MessageKind::all_placed)));
      }
      return all_placed_ && compressed_.empty();
    });
    points_file_.close();
    const detail::MpiLasShare all = sum_of_shares();
    if (!whole_) return;
    whole_->adopt(all.tally, first_, end_);
    whole_->records().adopt(std::move(sizes_of_placed_));
    whole_->close();
  }

 private:
  enum class MessageKind : std::uint8_t { part, sizes, position, all_points, all_placed };
  struct Size {
    std::uint64_t number, bytes;
  };
  struct Chunk {
    std::uint64_t number = 0;
    std::vector<std::byte> bytes;
    std::uint64_t points = 0;  // number of its points received so far
  };
  using Chunks = std::map<std::uint64_t, Chunk>;
  static constexpr std::uint64_t chunk_points = io::LazWriter::chunk_points;
  static constexpr std::size_t max_waiting = 64;  // in chunks

  [[nodiscard]] static std::uint64_t chunks_of(std::uint64_t points) noexcept {
    return (points + chunk_points - 1) / chunk_points;
  }

  /// Adds records of one chunk at their position in it, in any order.
  void add(std::uint64_t at, std::span<const std::byte> records) {
    const std::uint64_t number = at / chunk_points;
    const auto chunk = gathered_.try_emplace(number, Chunk{number, {}, 0}).first;
    auto& [its_number, bytes, points] = chunk->second;
    const std::size_t begin = (at % chunk_points) * record_;
    bytes.resize(std::max(bytes.size(), begin + records.size()));
    std::copy(records.begin(), records.end(), bytes.data() + begin);
    points += records.size() / record_;
    finish(chunk);
  }

  /// Queues a complete chunk for compression.
  void finish(Chunks::iterator chunk) {
    const std::uint64_t points = chunk->second.points;
    if (points < chunk_points && chunk->first * chunk_points + points != all_points_) return;
    ready_.push_back(std::move(chunk->second));
    gathered_.erase(chunk);
  }

  /// First process: sends the positions of chunks before which no size is missing.
  void place_chunks() {
    while (const auto next = sizes_.extract(sizes_of_placed_.size())) {
      const auto [size, owner] = next.mapped();
      send(owner, std::move(MpiMessage().add(MessageKind::position).add(Size{next.key(), end_})));
      end_ += size;
      sizes_of_placed_.push_back(size);
    }
  }

  unsigned threads_;
  Chunks gathered_;                                             // by number, from several processes
  std::deque<Chunk> ready_;                                     // to be compressed
  std::map<std::uint64_t, std::vector<std::byte>> compressed_;  // by number, without positions
  std::optional<std::uint64_t> all_points_;                     // of the file, known at the end
  bool all_placed_ = false;

  // on the first process
  std::uint64_t end_ = 0;                                       // end of the chunks placed [byte]
  int chunk_owner_ = 0;                                         // owner of the chunk begun last
  std::map<std::uint64_t, std::pair<std::size_t, int>> sizes_;  // size, owner; without a position
  std::vector<std::size_t> sizes_of_placed_;                    // [byte]
  bool all_told_ = false;
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
