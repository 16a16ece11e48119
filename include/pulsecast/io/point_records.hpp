// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_RECORDS_HPP
#define PULSECAST_IO_POINT_RECORDS_HPP

#include <pulsecast/io/detail/stored_numbers.hpp>

/// Records of points in a layout, which point files and messages consist of.
namespace PULSECAST_NAMESPACE::io {

/// Number in a field of a record, as it is stored.
[[nodiscard]] inline double number_in(const std::byte* record, const PointField& field) noexcept {
  return detail::visit_number_type(field.type, [from = record + field.offset]<class Number>() {
    Number number;
    std::memcpy(&number, from, sizeof number);
    return static_cast<double>(number);
  });
}

/// Number of echoes of the shots of a batch.
[[nodiscard]] inline std::size_t count_echoes(const EchoBatch& batch) noexcept {
  std::size_t count = 0;
  for (const Shot& shot : batch.shots) count += shot.echoes;
  return count;
}

/// Encoder of echoes as point records, in pulse order. Allocates nothing but their vector.
class PointEncoder {
 public:
  /// @throws SettingError for a layout or settings out of range, or an attribute that no object has
  explicit PointEncoder(PointLayout layout, PointSettings settings = {})
      : layout_(validated(std::move(layout))), settings_(validated(std::move(settings))) {
    places_ = layout_.needs(PointNeed::position);
    surfaces_ = layout_.needs(PointNeed::surface) && settings_.surfaces;
    colours_ = layout_.needs(PointNeed::colour) && settings_.colours;
    attributes_ = layout_.needs(PointNeed::attribute);
    uncertain_ = layout_.needs(PointNeed::uncertainty) && settings_.uncertainty;
    for (const PointField& field : layout_.fields) numbers_.push_back(number_of(field));
    begin_scan({});
  }

  [[nodiscard]] const PointLayout& layout() const noexcept { return layout_; }  ///< of the records
  [[nodiscard]] const PointSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] Tick scan_start() const noexcept { return start_; }  ///< start of the scan

  /// Sets the start of the scan, from which its times count, and the sensor's pose then.
  void begin_scan(Tick start) {
    start_ = start;
    if (settings_.sensor && removed()) frame_ = settings_.sensor(start).inverse();
  }

  /// Calls `use(view)` with the `PointView` of an echo of a batch, which has what the layout needs.
  template <class Use>
  void see(const EchoBatch& batch, const Shot& shot, const Echo& echo, const Use& use) const {
    std::optional<Frame> own;
    see(batch, shot, echo, frame_of(shot, own), use);
  }

  /// Writes the record of a point to `layout().size` bytes, but for those between fields.
  void store(const PointView& view, std::byte* record) const noexcept { store(std::span(&view, 1), record); }
  /// Writes the record of an echo of a batch, as above.
  void store(const EchoBatch& batch, const Shot& shot, const Echo& echo, std::byte* record) const {
    see(batch, shot, echo, [&](const PointView& view) { store(view, record); });
  }

  /// Value of the field of this index, times its scale; NaN if unknown.
  [[nodiscard]] double value(std::size_t field, const PointView& view) const noexcept {
    return numbers_[field].unscaled(view) * numbers_[field].scale;
  }

  /// Appends a record for each echo of the shots of a batch.
  void encode(const EchoBatch& batch, std::vector<std::byte>& records) const {
    const std::size_t at = records.size();
    records.resize(at + count_echoes(batch) * layout_.size);
    encode(batch, records.data() + at);
  }

  /// Writes them to `count_echoes(batch)` times `layout().size` bytes.
  void encode(const EchoBatch& batch, std::byte* records) const {
    Points points;
    std::size_t count = 0;
    const auto store_all = [&] {
      store({points.views.data(), count}, records);
      records += std::exchange(count, 0) * layout_.size;
    };
    for (const Shot& shot : batch.shots) {
      if (shot.echoes == 0) continue;
      std::optional<Frame> own;
      const Frame* const frame = frame_of(shot, own);
      for (const Echo& echo : batch.echoes_of(shot)) {
        if (surfaces_ || colours_) {  // which live during the call
          see(batch, shot, echo, frame, [&](const PointView& view) { store(view, records); });
          records += layout_.size;
          continue;
        }
        PointView& view = *std::construct_at(&points.views[count], PointView{shot, echo, settings_, start_});
        set(view, frame);
        if (uncertain_) view.uncertainty = std::construct_at(&points.uncertainties[count], uncertainty(view, frame));
        if (++count == points.views.size()) store_all();
      }
    }
    store_all();
  }

 private:
  using Frame = Pose<frame::World, frame::Instrument>;

  /// Points that are stored together, field by field.
  struct Points {
    union {
      std::array<PointView, 32> views;
    };
    union {
      std::array<PointUncertainty, 32> uncertainties;
    };
    Points() noexcept {}  // leaves them unset
  };

  /// Number of a record: a field, as it is stored.
  struct Number {
    void (*store)(const Number&, std::span<const PointView>, std::byte*, std::size_t size) noexcept;
    detail::ColumnLoop loop;                            // null for an attribute, and a column of the user's
    double (*get)(const PointView&) noexcept;           // null for an attribute
    std::uint64_t (*whole)(const PointView&) noexcept;  // null unless it is stored exactly
    std::size_t attribute;                              // index in the attributes
    double scale;
    std::uint32_t offset;

    [[nodiscard]] double unscaled(const PointView& view) const noexcept {
      return get ? get(view) : view.attributes[attribute];
    }
  };

  template <class Stored>
  static void store_values(const Number& number, std::span<const PointView> views, std::byte* record,
                           std::size_t size) noexcept {
    std::array<double, std::tuple_size_v<decltype(Points::views)>> values;
    if (number.loop) {
      number.loop(views, values.data());
    } else {
      for (std::size_t k = 0; k < views.size(); ++k) values[k] = number.unscaled(views[k]);
    }
    record += number.offset;
    for (std::size_t k = 0; k < views.size(); ++k, record += size)
      detail::store_number<Stored>(values[k] * number.scale, record);
  }
  template <class Stored>
  static void store_wholes(const Number& number, std::span<const PointView> views, std::byte* record,
                           std::size_t size) noexcept {
    for (std::size_t k = 0; k < views.size(); ++k)
      detail::store_whole<Stored>(number.whole(views[k]), record + k * size + number.offset);
  }

  /// Writes the records of up to as many points as `Points` holds.
  void store(std::span<const PointView> views, std::byte* records) const noexcept {
    if (views.empty()) return;  // then there may be no records
    for (const Number& number : numbers_) number.store(number, views, records, layout_.size);
  }

  [[nodiscard]] Number number_of(const PointField& field) const {
    const PointColumn& column = *field.column;
    Number number{nullptr, detail::loop_of(column), column.get, column.whole, 0, field.scale, field.offset};
    if (column.needs == PointNeed::attribute) {
      const auto& names = settings_.attributes.names();
      const auto found = std::ranges::find(names, field.name);
      if (found == names.end())
        throw SettingError("PointSettings::attributes (number of names '" + field.name + "')", 0, "",
                           "1: the layout has such a field");
      number.attribute = static_cast<std::size_t>(found - names.begin());
    }
    detail::visit_number_type(field.type, [&]<class Stored>() {
      number.store = &store_values<Stored>;
      if constexpr (std::is_integral_v<Stored>)
        if (number.whole && number.scale == 1) number.store = &store_wholes<Stored>;
    });
    return number;
  }

  /// Frame of the points of a shot, in memory of the caller if it is the shot's own; null for the world.
  [[nodiscard]] const Frame* frame_of(const Shot& shot, std::optional<Frame>& own) const {
    if (!settings_.sensor) return nullptr;
    return removed() ? &frame_ : &own.emplace(settings_.sensor(shot.tick).inverse());
  }

  /// Sets the position and the attributes of a point, if they are needed.
  void set(PointView& view, const Frame* frame) const {
    if (places_) {
      const Vec3 point = point_of(view.shot, view.echo);
      view.position = in_axes(frame ? frame->point(point) : point - settings_.origin);
    }
    if (attributes_) view.attributes = settings_.attributes.of(view.echo.object).data();
  }

  /// Uncertainty of a point, in its axes.
  [[nodiscard]] PointUncertainty uncertainty(const PointView& view, const Frame* frame) const {
    PointUncertainty u = settings_.uncertainty(view.shot, view.echo);
    if (frame || settings_.axes != PointAxes::right_forward_up) turn(u, frame);
    return u;
  }
  [[gnu::noinline]] void turn(PointUncertainty& u, const Frame* frame) const noexcept {
    const auto turned = [&](const Vec3& v) { return in_axes(frame ? frame->direction(v) : v); };
    for (Covariance* part : {&u.random, &u.systematic}) *part = part->in_axes(turned);
  }

  template <class Use>
  void see(const EchoBatch& batch, const Shot& shot, const Echo& echo, const Frame* frame, const Use& use) const {
    PointView view{shot, echo, settings_, start_};
    set(view, frame);
    std::optional<PointUncertainty> stated;
    if (uncertain_) view.uncertainty = &stated.emplace(uncertainty(view, frame));
    std::optional<PointSurface> surface;
    std::optional<PointColour> colour;
    if (surfaces_)
      if (const std::optional<SurfaceInteraction> at = settings_.surfaces(batch, shot, echo)) {
        const auto turned = [&](const Vec3& v) { return in_axes(frame ? frame->direction(v) : v); };
        view.surface = &surface.emplace(PointSurface{*at, turned(at->normal), turned(at->velocity)});
      }
    if (colours_ && (colour = settings_.colours(batch, shot, echo))) view.colour = &*colour;
    use(view);
  }

  [[nodiscard]] bool removed() const noexcept { return settings_.distortion == MotionDistortion::removed; }

  [[nodiscard]] Vec3 in_axes(const Vec3& v) const noexcept {
    return settings_.axes == PointAxes::forward_left_up ? to_forward_left_up(v) : v;
  }

  PointLayout layout_;
  PointSettings settings_;
  std::vector<Number> numbers_;                                                                        // one a field
  bool places_ = false, surfaces_ = false, colours_ = false, attributes_ = false, uncertain_ = false;  // needs
  Tick start_{};
  Frame frame_{};  // of a scan without distortion
};

/// Grid of the points of a scan, one place a pulse, row by row; the first echo of the first pulse takes its place. A
/// point without an echo has NaN in each field of floating point, and 0 in integers.
struct PointGrid {
  std::uint32_t rows = 0;     ///< number of rows, as of rings; 0: no grid
  std::uint32_t columns = 0;  ///< number of columns
  /// Columns a second: the row is the ring, the column counts from the scan's start, so that a column is a firing
  /// sequence if a scan has a whole number of them. 0: pulses fill rows, as of a pixel array, from a slot that is a
  /// multiple of their number [Hz]
  double column_rate = 0;

  void validate() const {
    require_within("PointGrid::rows", rows, 0, 1e6, "");
    require_within("PointGrid::columns", columns, rows > 0 ? 1 : 0, 1e6, "");
    require_within("PointGrid::rows * columns", double{1} * rows * columns, 0, 1e9, "");
    require_within("PointGrid::column_rate", column_rate, 0, 1e9, "Hz");
  }
};

/// Point records in memory: a sink that keeps them, and gives them to the writers of files and
/// messages. Once it has grown to the longest scan, it allocates nothing.
class PointBuffer {
 public:
  /// @throws SettingError for a layout, settings or a grid out of range
  explicit PointBuffer(PointLayout layout, PointSettings settings = {}, PointGrid grid = {})
      : encoder_(std::move(layout), std::move(settings)), grid_(validated(grid)) {
    clear();
  }

  void operator()(const EchoBatch& batch) {
    if (grid_.rows == 0) return encoder_.encode(batch, records_);
    for (const Shot& shot : batch.shots)
      if (shot.echoes > 0) place(batch, shot);
  }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Drops all points, and sets the start of the next scan.
  void begin_scan(Tick start) {
    clear();
    encoder_.begin_scan(start);
  }

  [[nodiscard]] const PointGrid& grid() const noexcept { return grid_; }
  /// Echoes of all scans without a place in the grid, or whose place was taken.
  [[nodiscard]] std::uint64_t echoes_left_out() const noexcept { return left_out_; }
  [[nodiscard]] std::size_t size() const noexcept { return records_.size() / layout().size; }
  /// Records, one after another.
  [[nodiscard]] std::span<const std::byte> records() const noexcept { return records_; }
  [[nodiscard]] const PointLayout& layout() const noexcept { return encoder_.layout(); }
  [[nodiscard]] const PointSettings& settings() const noexcept { return encoder_.settings(); }
  [[nodiscard]] Tick scan_start() const noexcept { return encoder_.scan_start(); }

  /// Number in a field of this layout of a point, as it is stored.
  [[nodiscard]] double number(std::size_t point, const PointField& field) const noexcept {
    return number_in(records_.data() + point * layout().size, field);
  }

 private:
  /// Drops all points; fills a grid with those of misses.
  void clear() {
    records_.clear();
    taken_.assign(std::size_t{grid_.rows} * grid_.columns, 0);
    records_.resize(taken_.size() * layout().size);
    for (const PointField& field : layout().fields)
      for (std::size_t at = field.offset; at < records_.size(); at += layout().size)
        detail::visit_number_type(field.type, [&]<class Number>() {
          detail::store_number<Number>(std::numeric_limits<double>::quiet_NaN(), &records_[at]);
        });
  }

  /// Writes the first echo of a shot to its place in the grid.
  void place(const EchoBatch& batch, const Shot& shot) {
    const Echo& echo = batch.echoes_of(shot).front();
    const Tick start = scan_start();
    const PointView view{shot, echo, settings(), start};
    double row = 0, column = static_cast<double>(shot.index % size());
    if (grid_.column_rate > 0) {
      row = detail::ring_of(view);
      column = std::floor(detail::scan_time(view) * grid_.column_rate + 1e-6);  // rounded times are of their column
    }
    const bool inside = row < grid_.rows && column >= 0 && (column < grid_.columns || grid_.column_rate == 0);
    const std::size_t at = inside ? static_cast<std::size_t>(row * grid_.columns + column) : 0;
    const bool free = inside && std::exchange(taken_[at], char{1}) == 0;
    left_out_ += shot.echoes - (free ? 1 : 0);
    if (free) encoder_.store(batch, shot, echo, records_.data() + at * layout().size);
  }

  PointEncoder encoder_;
  PointGrid grid_;
  std::vector<std::byte> records_;
  std::vector<char> taken_;     // a place of the grid: 0 or 1
  std::uint64_t left_out_ = 0;  // echoes without a place
};
static_assert(EchoSink<PointBuffer>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
