// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_DETAIL_SAMPLE_HPP
#define PULSECAST_PAGE_DETAIL_SAMPLE_HPP

#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Point of a page: what is coded in a way of its own. All else is in a record of its columns.
struct PagePoint {
  Vec3 position{};                       ///< in the world [m]
  double time = 0;                       ///< since the survey's start [s]
  PulseIndex pulse = 0;                  ///< number of the pulse
  std::array<float, 3> to_instrument{};  ///< vector from the point to the origin of its pulse [m]
  std::uint32_t key = 0;                 ///< for thinning: see `page_key`
};

/// Coding of a column on a page.
enum class PageCoding : std::uint8_t {
  steps,        ///< multiples of a step above the least value
  from_zero,    ///< multiples of a step
  similar,      ///< as `steps`, of neighbours that are alike
  logarithmic,  ///< multiples of a step of the logarithm
  listed        ///< index in a list of few values
};

/// Column of a page.
struct PageColumn {
  io::PointField field{};                 ///< name on the page; type in the record
  PageCoding coding = PageCoding::steps;  ///< coding
  double step = 0;                        ///< step of the values on the page; 0: from their extent
  double scale = 1, divisor = 1;          ///< factors of the unit on the page
  std::optional<double> plain{};          ///< the column is left out if all have this value
  bool further = false;                   ///< asked for: name and unit are shown as they are
};

/// Columns of a page besides `PagePoint`: the usual ones, colours if any, and further ones.
[[nodiscard]] inline std::vector<PageColumn> columns_of_page(bool colours, std::span<const io::PointField> further) {
  using enum io::NumberType;
  using enum PageCoding;
  using io::column;
  std::vector<PageColumn> all{{{"return_number", uint8, column("return_number")}, similar, 1},
                              {{"returns", uint8, column("number_of_returns")}, similar, 1},
                              {{"leg", uint16, column("leg")}, similar, 1},
                              {{"channel", uint16, column("channel")}, similar, 1},
                              {{"scan_angle", float32, column("scan_angle")}, similar, 0.05, 180, pi},
                              {{"object", uint32, column("object")}, listed},
                              {{"class", uint16, column("classification")}, listed},
                              {{"reflectance", float32, column("reflectance")}, steps, 0.002},
                              {{"amplitude", float32, column("intensity")}, logarithmic, 0.02},
                              {{"incidence", float32, column("incidence")}, steps, 0.5, 180, pi},
                              {{"kind", uint8, column("kind")}, listed, 0, 1, 1, 0},
                              {{"width", float32, column("echo_width")}, similar, 0.001, 1e9, 1, 0}};
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (colours) all.push_back({{"colour", float32, column("rgb")}, from_zero, 1, 1, 1, unknown});  // below 2^24
  for (const io::PointField& field : further) {
    constexpr std::array known{"x", "y", "z", "time", "pulse", "range"};
    const auto same = [&](const PageColumn& other) { return other.field.name == field.name; };
    if (std::ranges::find(known, field.name) != known.end() || std::ranges::any_of(all, same)) continue;
    const bool whole = field.type != float32 && field.type != float64;
    all.push_back({.field = field, .step = whole ? 1.0 : 0.0, .further = true});
  }
  return all;
}

/// Points of a page in pulse order, with the records of their columns.
struct PagePoints {
  std::vector<PageColumn> columns{};  ///< columns of the records
  io::PointLayout layout{};           ///< layout of the records
  std::vector<PagePoint> points{};    ///< points
  std::vector<std::byte> records{};   ///< a record a point

  explicit PagePoints(std::vector<PageColumn> all = columns_of_page(false, {})) : columns(std::move(all)) {
    for (const PageColumn& each : columns) layout = layout.with({each.field});
  }

  /// Value in a column of a point, in the unit of the page; NaN if unknown.
  [[nodiscard]] double value(std::size_t point, std::size_t column) const noexcept {
    const io::PointField& field = layout.fields[column];
    const double stored = io::number_in(records.data() + point * layout.size, field);
    return stored * columns[column].scale / columns[column].divisor;
  }

  /// Points from `first` to before `last`.
  [[nodiscard]] PagePoints part(std::size_t first, std::size_t last) const {
    PagePoints some(columns);
    some.points.assign(points.begin() + static_cast<std::ptrdiff_t>(first),
                       points.begin() + static_cast<std::ptrdiff_t>(last));
    some.records.assign(records.begin() + static_cast<std::ptrdiff_t>(first * layout.size),
                        records.begin() + static_cast<std::ptrdiff_t>(last * layout.size));
    return some;
  }
};

/// Pseudo-random number of an echo alone. Source: Appleby 2011, MurmurHash3, fmix64.
[[nodiscard]] constexpr std::uint32_t page_key(PulseIndex pulse, std::uint8_t number) noexcept {
  std::uint64_t h = pulse * 256 + number;
  h = (h ^ h >> 33) * 0xff51afd7ed558ccd;
  h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53;
  return static_cast<std::uint32_t>((h ^ h >> 33) >> 32);
}

/// Sink that keeps at most `most` points, those with the least keys, in pulse order: a uniform
/// sample that depends on the echoes alone. It skips points that are not finite.
class PageSample {
 public:
  /// `most` is from 2 to 2^27. The points have colours if `points` has; surfaces and colours are
  /// asked for those that are kept for the moment. `further`: columns beyond the usual ones.
  explicit PageSample(std::size_t most, const io::PointSettings& points = {},
                      std::span<const io::PointField> further = {})
      : most_(most),
        kept_(columns_of_page(static_cast<bool>(points.colours), further)),
        encoder_(kept_.layout, points) {
    require_within("PageSample::most", most, 2, 134'217'728, "");
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        ++seen_;
        const std::uint32_t key = page_key(shot.index, echo.number);
        if (thinned_ && key >= largest_key_) continue;
        const Vec3 position = point_of(shot, echo), back = shot.direction * -echo.range;
        if (!finite(position) || !finite(back)) continue;
        kept_.points.push_back(
            {.position = position,
             .time = shot.tick.seconds(),
             .pulse = shot.index,
             .to_instrument = {static_cast<float>(back.x), static_cast<float>(back.y), static_cast<float>(back.z)},
             .key = key});
        kept_.records.resize(kept_.records.size() + kept_.layout.size);
        encoder_.store(batch, shot, echo, kept_.records.data() + kept_.records.size() - kept_.layout.size);
        if (kept_.points.size() >= most_ + most_ / 4 + 1) thin();
      }
  }

  /// Points kept, in pulse order; valid until the next batch.
  [[nodiscard]] const PagePoints& points() {
    if (kept_.points.size() > most_) thin();
    return kept_;
  }

  [[nodiscard]] std::uint64_t seen() const noexcept { return seen_; }  ///< echoes so far
  /// Upper bound of the keys kept.
  [[nodiscard]] std::uint32_t largest_key() const noexcept { return largest_key_; }

 private:
  /// Keeps the points with the least keys; of equal keys, the earliest.
  void thin() {
    keys_.clear();
    for (const PagePoint& point : kept_.points) keys_.push_back(point.key);
    const auto last = keys_.begin() + static_cast<std::ptrdiff_t>(most_ - 1);
    std::nth_element(keys_.begin(), last, keys_.end());
    largest_key_ = *last;
    thinned_ = true;
    auto equal = 1 + std::count(keys_.begin(), last, largest_key_);  // number of them that stay
    std::size_t kept = 0;
    for (std::size_t i = 0; i < kept_.points.size(); ++i) {
      const PagePoint point = kept_.points[i];
      if (point.key > largest_key_ || (point.key == largest_key_ && equal-- <= 0)) continue;
      const std::byte* const record = kept_.records.data() + i * kept_.layout.size;
      std::memmove(kept_.records.data() + kept * kept_.layout.size, record, kept_.layout.size);
      kept_.points[kept++] = point;
    }
    kept_.points.resize(kept);
    kept_.records.resize(kept * kept_.layout.size);
  }

  std::size_t most_;
  PagePoints kept_;
  io::PointEncoder encoder_;
  std::vector<std::uint32_t> keys_;
  std::uint64_t seen_ = 0;
  std::uint32_t largest_key_ = std::numeric_limits<std::uint32_t>::max();
  bool thinned_ = false;
};
static_assert(EchoSink<PageSample>);

}  // namespace PULSECAST_NAMESPACE::page

#endif
