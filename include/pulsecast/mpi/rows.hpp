// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_ROWS_HPP
#define PULSECAST_MPI_ROWS_HPP

#include <pulsecast/mpi/detail/output.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// File of text rows, written by all processes. `Writer` must write the same for batches one by one
/// as for all at once, as do `XyzWriter`, `PulseTextWriter` and `WaveformTextWriter`.
template <class Writer, class... Settings>
class MpiRows final : public MpiOutput {
 public:
  /// Throws a `FileError` if the file cannot be made.
  MpiRows(MpiGroup& group, std::filesystem::path path, Settings... settings)
      : MpiOutput(group),
        make_([=](io::OutputFile rows) { return Writer(std::move(rows), settings...); }),
        file_(std::move(path)) {
    if (group.first()) whole_.emplace(file_.path());
  }

  [[nodiscard]] std::unique_ptr<MpiPiece> piece() override { return std::make_unique<Piece>(file_.path(), make_); }
  void put(MpiPiece& piece, const MpiPlace& place) override {
    file_.write(place.starts[0], static_cast<Piece&>(piece).bytes);
  }

  [[nodiscard]] MpiPlace place(const MpiExtent& extent, int /*owner*/) override {
    MpiPlace place;
    place.starts[0] = std::exchange(size_, size_ + extent.amounts[0]);
    return place;
  }

  void close() override {
    file_.close();
    (void)group().channel().gather(0);  // barrier: all have written
    if (!whole_) return;
    whole_->continue_at(size_);
    whole_->commit();
  }

 private:
  using Piece = MpiWrittenPiece<Writer>;

  typename Piece::Make make_;
  MpiFile file_;
  std::optional<io::OutputFile> whole_;  // on the first process
  std::uint64_t size_ = 0;               // end of the rows placed [byte]
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
