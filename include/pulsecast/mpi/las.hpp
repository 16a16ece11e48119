// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_LAS_HPP
#define PULSECAST_MPI_LAS_HPP

#include <pulsecast/io/las.hpp>
#include <pulsecast/mpi/detail/output.hpp>

namespace PULSECAST_NAMESPACE::mpi {

namespace detail {

/// Points of a block: records, whose coordinates wait for the offset of the file, and waveforms.
class MpiLasPiece final : public MpiPiece {
 public:
  MpiLasPiece(const std::filesystem::path& path, const io::LasSettings& settings) : path_(path), encoder_(settings) {
    if (settings.waveforms) packets_.emplace(io::OutputFile(path_, packet_bytes_));
  }

  void clear() override {
    records_.clear();
    points_.clear();
    packet_bytes_.clear();
    encoder_.tally() = {};
    if (packets_) packets_.emplace(io::OutputFile(path_, packet_bytes_));
  }

  [[nodiscard]] bool reads_empty_shots() const noexcept override { return false; }

  void operator()(const EchoBatch& batch) override {
    const std::size_t size = encoder_.layout().record();
    for (const Shot& shot : batch.shots) {
      if (shot.echoes == 0) continue;
      std::optional<io::LasPacket> packet;
      if (packets_ && shot.samples != 0) packet = packets_->add(batch.waveform_of(shot), batch.sample_interval);
      encoder_.encode(shot, batch, packet ? &*packet : nullptr, [&](const auto& record, const Vec3& point) {
        records_.insert(records_.end(), record.data(), record.data() + size);
        points_.push_back(point);
      });
    }
  }

  [[nodiscard]] MpiExtent extent() override {
    if (packets_) packets_->end_piece();
    return {{points_.size(), packet_bytes_.size()}, points_.empty() ? Vec3{} : points_.front()};
  }
  [[nodiscard]] std::size_t memory() const noexcept override {
    return records_.size() + std::span(points_).size_bytes() + packet_bytes_.size();
  }

  /// Finished records, after `number` others. Throws a `FileError` if coordinates do not fit.
  [[nodiscard]] std::span<const std::byte> located(const Vec3& first, std::uint64_t number, std::uint64_t packets_at) {
    const std::size_t size = encoder_.layout().record();
    encoder_.choose_offset(first);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (!encoder_.locate(records_.data() + i * size, points_[i]))
        throw FileError(path_.string(), "point " + std::to_string(number + i + 1), encoder_.misfit(points_[i]));
    if (packets_) encoder_.move_packets(records_, packets_at);
    return records_;
  }

  [[nodiscard]] std::span<const std::byte> packet_bytes() const noexcept { return packet_bytes_; }
  [[nodiscard]] std::uint32_t spacing() const noexcept { return packets_ ? packets_->spacing() : 0; }
  [[nodiscard]] const io::LasEncoder& encoder() const noexcept { return encoder_; }

 private:
  std::filesystem::path path_;
  io::LasEncoder encoder_;
  std::vector<std::byte> records_, packet_bytes_;
  std::vector<Vec3> points_;
  std::optional<io::LasPackets> packets_;
};

/// Settings that processes can share. @throws SettingError for intensities scaled to the maximum
[[nodiscard]] inline io::LasSettings mpi_las_settings(io::LasSettings settings) {
  if (settings.intensity == io::LasIntensity::amplitude && !settings.intensity_full_scale)
    throw SettingError("LasSettings::intensity_full_scale", 0, "W", "given, with amplitudes and many processes");
  return validated(std::move(settings));
}

/// Contribution of one process to the header.
struct MpiLasShare {
  io::LasTally tally{};
  std::uint32_t spacing = 0;  ///< interval of samples [ps]

  void add(const MpiLasShare& other) noexcept {
    tally.add(other.tally);
    spacing = std::max(spacing, other.spacing);
  }
};

/// Part that LAS and LAZ files of all processes share. `Whole` is the writer of the first process.
template <class Whole>
class MpiLasOutput : public MpiOutput {
 public:
  [[nodiscard]] std::unique_ptr<MpiPiece> piece() final {
    return std::make_unique<MpiLasPiece>(points_file_.path(), settings_);
  }
  [[nodiscard]] std::uint64_t pulses_cut() const noexcept final { return whole_ ? whole_->pulses_cut() : 0; }
  [[nodiscard]] std::uint64_t classes_cut() const noexcept final { return whole_ ? whole_->classes_cut() : 0; }

 protected:
  MpiLasOutput(MpiGroup& group, const std::filesystem::path& path, io::LasSettings settings)
      : MpiOutput(group), settings_(std::move(settings)), points_file_(path) {}

  /// Records of a piece at its place, whose counts are added to the share of this process.
  [[nodiscard]] std::span<const std::byte> take(MpiLasPiece& piece, const MpiPlace& place) {
    const auto records = piece.located(place.first, place.starts[0], place.starts[1]);
    share_.add({piece.encoder().tally(), piece.spacing()});
    return records;
  }

  /// Counts points. Returns the place of the first of them.
  [[nodiscard]] MpiPlace next_points(const MpiExtent& extent) {
    if (points_ == 0) first_ = extent.first;
    return {{std::exchange(points_, points_ + extent.amounts[0])}, first_};
  }

  /// Sum of the shares of all processes; valid on the first.
  [[nodiscard]] MpiLasShare sum_of_shares() {
    MpiLasShare sum;
    for (const MpiLasShare& one : group().channel().gather(share_)) sum.add(one);
    return sum;
  }

  io::LasSettings settings_;
  std::size_t record_ = io::LasEncoder::record_size(settings_);  // [byte]
  MpiFile points_file_;
  std::optional<Whole> whole_;  // on the first process, as are the following
  std::uint64_t points_ = 0;    // points placed
  Vec3 first_{};

 private:
  MpiLasShare share_;
};

}  // namespace detail

/// LAS file written by all processes, waveforms included; its bytes equal those of `LasWriter`.
/// Throws a `SettingError` for intensities scaled to the maximum amplitude.
class MpiLas final : public detail::MpiLasOutput<io::LasWriter> {
 public:
  /// Collective. @throws SettingError for such intensities @throws FileError
  MpiLas(MpiGroup& group, const std::filesystem::path& path, io::LasSettings settings)
      : MpiLasOutput(group, path, detail::mpi_las_settings(std::move(settings))),
        packets_file_(std::filesystem::path(path).replace_extension(".wdp")) {
    if (group.first()) {
      whole_.emplace(path, settings_);
      packets_end_ = whole_->packets_at();
    }
    begin_ = group.channel().from_first(whole_ ? whole_->records_at() : 0);
  }

  void put(MpiPiece& piece, const MpiPlace& place) override {
    auto& own = static_cast<detail::MpiLasPiece&>(piece);
    points_file_.write(begin_ + place.starts[0] * record_, take(own, place));
    packets_file_.write(place.starts[1], own.packet_bytes());
  }

  [[nodiscard]] MpiPlace place(const MpiExtent& extent, int /*owner*/) override {
    MpiPlace place = next_points(extent);
    place.starts[1] = std::exchange(packets_end_, packets_end_ + extent.amounts[1]);
    return place;
  }

  void close() override {
    points_file_.close();
    packets_file_.close();
    const detail::MpiLasShare all = sum_of_shares();
    if (!whole_) return;
    whole_->adopt(all.tally, first_, begin_ + points_ * record_, packets_end_, all.spacing);
    whole_->close();
  }

 private:
  MpiFile packets_file_;
  std::uint64_t begin_ = 0, packets_end_ = 0;  // begin of the points; end of the packets placed [byte]
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
