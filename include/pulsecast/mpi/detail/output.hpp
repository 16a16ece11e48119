// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_DETAIL_OUTPUT_HPP
#define PULSECAST_MPI_DETAIL_OUTPUT_HPP

#include <fcntl.h>
#include <unistd.h>

#include <pulsecast/io/output_file.hpp>
#include <pulsecast/mpi/detail/blocks.hpp>
#include <pulsecast/mpi/detail/channel.hpp>
#include <pulsecast/run.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// Temporary file of an `OutputFile` of the first process, which others write in disjoint ranges.
/// Opened at the first write. Throws a `FileError` that names the final path.
class MpiFile {
 public:
  explicit MpiFile(std::filesystem::path path) : path_(std::move(path)) {}
  MpiFile(const MpiFile&) = delete;
  MpiFile& operator=(const MpiFile&) = delete;
  ~MpiFile() {
    if (file_ >= 0) ::close(file_);
  }

  void write(std::uint64_t position, std::span<const std::byte> bytes) {
    if (file_ < 0 && !bytes.empty())
      file_ = ::open(io::OutputFile::temporary_name(path_).c_str(), O_WRONLY | O_CLOEXEC);
    while (!bytes.empty()) {
      const ssize_t written =
          file_ < 0 ? -1 : ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(position));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(bytes.size());
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      position += static_cast<std::uint64_t>(written);
    }
  }

  /// Flushes to the disk and closes; the system may report write errors only now.
  void close() {
    if (file_ < 0) return;
    if (!io::sync_to_disk(file_)) fail(0);
    if (::close(std::exchange(file_, -1)) != 0) fail(0);
  }

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  [[noreturn]] void fail(std::size_t bytes) const {
    throw FileError(path_.string(), "",
                    text::joined({"cannot be written by all processes: ", std::generic_category().message(errno),
                                  "; expected room for ", std::to_string(bytes),
                                  " more bytes in a folder that all machines share"}));
  }

  std::filesystem::path path_;
  int file_ = -1;
};

class MpiOutput;

/// Processes of a communicator, and their shared outputs. Construction and destruction are
/// collective.
class MpiGroup {
 public:
  explicit MpiGroup(MPI_Comm communicator = MPI_COMM_WORLD) : channel_(communicator) {}

  [[nodiscard]] MpiChannel& channel() noexcept { return channel_; }
  [[nodiscard]] int rank() const noexcept { return channel_.rank(); }
  [[nodiscard]] int size() const noexcept { return channel_.size(); }
  [[nodiscard]] bool first() const noexcept { return channel_.first(); }

  /// Begins a run, whose messages go to `handler`. Those of a later run are kept for it.
  using Handler = void (*)(void* run, int from, int kind, MpiMessage message);
  void begin(void* run, Handler handler) {
    run_ = run;
    handler_ = handler;
    parity_ = 1 - parity_;
    for (auto& message : std::exchange(early_, {})) hand_over(message.from, message.kind, std::move(message.bytes));
  }
  void end() noexcept { handler_ = nullptr; }
  /// Sends a message to the same run on another process; `kind` is from 0 to 7.
  void send(int to, int kind, MpiMessage message) {
    channel_.send(to, 2 + 8 * parity_ + kind, std::move(message).take());
  }

  /// Handles all messages that have arrived; true if there was any.
  bool serve();

  static void pause() noexcept { ::usleep(50); }

  /// Sends a message to the same output on any process.
  void send_to_output(int to, std::uint32_t output, MpiMessage message) {
    channel_.send(to, to_output, std::move(message.add(output)).take());
  }

  [[nodiscard]] std::uint32_t enter(MpiOutput& output) {
    outputs_.emplace(next_, &output);
    return next_++;
  }
  void leave(std::uint32_t output) noexcept { outputs_.erase(output); }

 private:
  static constexpr int to_output = 1;  // tag of messages to outputs; runs have those from 2 on

  void hand_over(int from, int kind, MpiChannel::Bytes bytes) {
    handler_(run_, from, (kind - 2) % 8, MpiMessage(std::move(bytes)));
  }

  MpiChannel channel_;
  std::map<std::uint32_t, MpiOutput*> outputs_;
  std::uint32_t next_ = 0;
  void* run_ = nullptr;
  Handler handler_ = nullptr;
  int parity_ = 0;                          // of the number of runs so far
  std::vector<MpiChannel::Arrived> early_;  // of the next run
};

/// Results of one block for one output, under construction.
class MpiPiece {
 public:
  virtual ~MpiPiece() = default;
  /// Resets the piece, keeping its memory.
  virtual void clear() = 0;
  virtual void operator()(const EchoBatch& batch) = 0;  ///< adds a batch, in pulse order
  [[nodiscard]] virtual bool reads_empty_shots() const noexcept { return true; }
  /// Size of the piece, after the last batch.
  [[nodiscard]] virtual MpiExtent extent() = 0;
  [[nodiscard]] virtual std::size_t memory() const noexcept = 0;  ///< [byte]
};

/// Piece of bytes that a `Writer` makes from the file it is given.
template <class Writer>
class MpiWrittenPiece final : public MpiPiece {
 public:
  using Make = std::function<Writer(io::OutputFile)>;

  /// `path` is named in errors; it and `make` must outlive the piece.
  MpiWrittenPiece(const std::filesystem::path& path, const Make& make) : path_(path), make_(make) { clear(); }

  void clear() override {
    bytes.clear();
    writer_.emplace(make_(io::OutputFile(path_, bytes)));
  }
  void operator()(const EchoBatch& batch) override { (*writer_)(batch); }
  [[nodiscard]] bool reads_empty_shots() const noexcept override {
    return pulsecast::detail::reads_empty_shots(*writer_);
  }
  [[nodiscard]] MpiExtent extent() override {
    writer_->close();
    MpiExtent extent;
    extent.amounts[0] = bytes.size();
    return extent;
  }
  [[nodiscard]] std::size_t memory() const noexcept override { return bytes.size(); }

  std::vector<std::byte> bytes;

 private:
  const std::filesystem::path& path_;
  const Make& make_;
  std::optional<Writer> writer_;
};

/// Output written by all processes, a file or a stream. Each process makes pieces of its blocks,
/// and writes each at the place that the first process assigns once all sizes before are known.
/// Construction and `close()` are collective, in the same order.
class MpiOutput {
 public:
  explicit MpiOutput(MpiGroup& group) : group_(group), number_(group.enter(*this)) {}
  MpiOutput(const MpiOutput&) = delete;
  MpiOutput& operator=(const MpiOutput&) = delete;
  virtual ~MpiOutput() { group_.leave(number_); }

  /// Piece for the next block, new or recycled.
  [[nodiscard]] std::unique_ptr<MpiPiece> take_piece() {
    if (spare_.empty()) return piece();
    std::unique_ptr<MpiPiece> piece = std::move(spare_.back());
    spare_.pop_back();
    piece->clear();
    return piece;
  }
  void give_back(std::unique_ptr<MpiPiece> piece) { spare_.push_back(std::move(piece)); }

  [[nodiscard]] virtual std::unique_ptr<MpiPiece> piece() = 0;   ///< new, empty piece
  virtual void put(MpiPiece& piece, const MpiPlace& place) = 0;  ///< writes a piece at its place

  /// First process, in the order of blocks: place of a piece, while `may_place()` is true.
  [[nodiscard]] virtual MpiPlace place(const MpiExtent& extent, int owner) = 0;
  [[nodiscard]] virtual bool may_place() const noexcept { return true; }

  /// Handles a message from the same output of another process, quickly.
  virtual void receive(int /*from*/, MpiMessage /*message*/) {}
  /// Does some pending work; false if there is none.
  virtual bool work() { return false; }
  /// True if enough is waiting and no more pieces should be made.
  [[nodiscard]] virtual bool full() const noexcept { return false; }

  /// Writes the rest and gives the file its final name.
  virtual void close() = 0;
  /// As of `LasWriter`, once closed, on the first process; 0 for other files.
  [[nodiscard]] virtual std::uint64_t pulses_cut() const noexcept { return 0; }
  [[nodiscard]] virtual std::uint64_t classes_cut() const noexcept { return 0; }  ///< points, as above

  std::optional<std::uint16_t> channel{};  ///< only emitter whose pulses are wanted; all if empty

 protected:
  [[nodiscard]] MpiGroup& group() const noexcept { return group_; }
  void send(int to, MpiMessage message) { group_.send_to_output(to, number_, std::move(message)); }

  /// Handles messages and works until done() is true.
  template <class Done>
  void work_until(const Done& done) {
    while (!done()) {
      const bool served = group_.serve(), worked = work();
      if (!served && !worked && !done()) MpiGroup::pause();
    }
  }

 private:
  MpiGroup& group_;
  std::uint32_t number_;
  std::vector<std::unique_ptr<MpiPiece>> spare_;
};

inline bool MpiGroup::serve() {
  return channel_.poll([this](int from, int kind, MpiChannel::Bytes bytes) {
    if (kind != to_output) {
      if (handler_ == nullptr || (kind - 2) / 8 != parity_)
        return void(early_.push_back({from, kind, std::move(bytes)}));
      return hand_over(from, kind, std::move(bytes));
    }
    MpiMessage message(std::move(bytes));
    const auto found = outputs_.find(message.last<std::uint32_t>());
    PULSECAST_ASSERT(found != outputs_.end());
    found->second->receive(from, std::move(message));
  });
}

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
