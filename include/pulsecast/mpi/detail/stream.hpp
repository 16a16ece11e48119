// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_DETAIL_STREAM_HPP
#define PULSECAST_MPI_DETAIL_STREAM_HPP

#include <pulsecast/mpi/detail/output.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// Writes batches in their memory layout, for `for_each_batch` in another process.
class MpiBatchWriter {
 public:
  /// `empty_shots`: as `reads_empty_shots()` of the sink.
  explicit MpiBatchWriter(io::OutputFile file, bool empty_shots = true)
      : file_(std::move(file)), empty_shots_(empty_shots) {}

  [[nodiscard]] bool reads_empty_shots() const noexcept { return empty_shots_; }

  void operator()(const EchoBatch& batch) {
    const Head head{batch.shots.size(), batch.echoes.size(), batch.samples.size(), batch.subrays.size(),
                    batch.sample_interval};
    file_.write(std::as_bytes(std::span(&head, 1)));
    file_.write(std::as_bytes(batch.shots));
    file_.write(std::as_bytes(batch.echoes));
    file_.write(std::as_bytes(batch.samples));
    file_.write(std::as_bytes(batch.subrays));
  }
  void close() { file_.commit(); }

  struct Head {
    std::uint64_t shots, echoes, samples, subrays;
    double sample_interval;
  };

 private:
  io::OutputFile file_;
  bool empty_shots_;
};

/// Calls a sink with each batch of a message from `MpiBatchWriter`.
template <class Sink>
void for_each_batch(MpiMessage bytes, Sink&& sink) {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  std::vector<float> samples;
  std::vector<SubrayRecord> subrays;
  while (!bytes.rest().empty()) {
    const auto head = bytes.next<MpiBatchWriter::Head>();
    bytes.next(shots, head.shots);
    bytes.next(echoes, head.echoes);
    bytes.next(samples, head.samples);
    bytes.next(subrays, head.subrays);
    sink(EchoBatch{shots, echoes, samples, head.sample_interval, subrays});
  }
}

/// Output whose pieces, made by `Writer`, go to the first process in order, a bounded number at a
/// time. For a compressed stream: one process must make it, while all simulate and format text.
template <class Writer>
class MpiStream final : public MpiOutput {
 public:
  using Make = typename MpiWrittenPiece<Writer>::Make;
  using Take = std::function<void(MpiMessage bytes)>;

  MpiStream(MpiGroup& group, Make make, Take take, std::function<void()> close)
      : MpiOutput(group), make_(std::move(make)), take_(std::move(take)), close_(std::move(close)) {}

  [[nodiscard]] std::unique_ptr<MpiPiece> piece() override { return std::make_unique<Piece>(path_, make_); }

  void put(MpiPiece& piece, const MpiPlace& place) override {
    MpiMessage message(std::move(static_cast<Piece&>(piece).bytes));
    send(0, std::move(message.add(place.starts[0])));
  }

  [[nodiscard]] MpiPlace place(const MpiExtent& /*extent*/, int /*owner*/) override {
    MpiPlace place;
    place.starts[0] = placed_++;
    return place;
  }
  [[nodiscard]] bool may_place() const noexcept override {
    return placed_ - taken_ < std::min(16U, 2U * static_cast<unsigned>(group().size()) + 2);
  }

  void receive(int /*from*/, MpiMessage message) override {
    const auto number = message.last<std::uint64_t>();
    waiting_.emplace(number, std::move(message));
  }

  bool work() override {
    auto next = waiting_.extract(taken_);
    if (next.empty()) return false;
    take_(std::move(next.mapped()));
    ++taken_;
    return true;
  }

  void close() override {
    if (!group().first()) return;
    work_until([&] { return taken_ == placed_; });
    close_();
  }

 private:
  using Piece = MpiWrittenPiece<Writer>;

  std::filesystem::path path_ = "piece";
  Make make_;
  Take take_;
  std::function<void()> close_;
  std::uint64_t placed_ = 0, taken_ = 0;  // pieces, on the first process
  std::map<std::uint64_t, MpiMessage> waiting_;
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
