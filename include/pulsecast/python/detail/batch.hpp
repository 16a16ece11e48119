// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_BATCH_HPP
#define PULSECAST_PYTHON_DETAIL_BATCH_HPP

#include <pybind11/numpy.h>

#include <pulsecast/io/misses.hpp>
#include <pulsecast/python/detail/arrow.hpp>
#include <pulsecast/python/detail/point_arrays.hpp>
#include <pulsecast/python/detail/pulse_rows.hpp>
#include <pulsecast/run.hpp>

namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Results of a run, for Python.
struct Batch {
  pybind11::array points;              ///< structured, one row an echo
  pybind11::array_t<PulseRow> pulses;  ///< one row a pulse sent
  pybind11::array_t<float> waveforms;  ///< samples of all pulses, concatenated [W]
  double sample_interval = 0;          ///< between samples [s]
  pybind11::dict columns{};            ///< arrays by name; those of rows only if `by_column`
  bool by_column = false;              ///< true if points are kept by column, and not as rows
  RunSummary summary{};                ///< of the whole run; empty in a batch for a callback
  pybind11::object survey{};           ///< survey of the run; none in a copy
};

/// Kinds of data that a `RowSink` keeps.
struct KeptData {
  bool pulses = true;          ///< true for pulses and waveforms
  io::PointLayout rows{};      ///< layout of the rows of points; without fields: none
  io::PointLayout columns{};   ///< columns of points; without fields: none
  io::PointSettings points{};  ///< values of rows and columns

  /// @throws SettingError for two columns of a name
  void validate() const {
    std::vector<io::PointField> all = rows.fields;
    all.insert(all.end(), columns.fields.begin(), columns.fields.end());
    for (const io::PointField& field : all) {
      if (std::ranges::count(all, field.name, &io::PointField::name) > 1)
        throw SettingError("columns: '" + field.name + "'",
                           " is there twice: expected each once, and attributes without the name of a column");
    }
  }
};

/// Sink that keeps echoes, as rows or by column, and pulses.
class RowSink {
 public:
  /// @throws SettingError for two columns of a name, or a column of an attribute that no object has
  explicit RowSink(KeptData kept) : keeps_pulses_(validated(kept).pulses) {
    auto& [pulses, rows, columns, points] = kept;
    if (!rows.fields.empty()) points_.emplace(io::PointEncoder(std::move(rows), points));
    if (!columns.fields.empty()) columns_.emplace(io::PointEncoder(std::move(columns), std::move(points)));
  }

  void operator()(const EchoBatch& batch) {
    sample_interval_ = batch.sample_interval;
    pulse_count_ += batch.shots.size();
    if (points_) (*points_)(batch);
    if (columns_) (*columns_)(batch);
    for (const Shot& s : batch.shots) {
      if (keeps_pulses_) {
        pulses_.push_back({static_cast<std::int64_t>(s.index), s.tick.seconds(), s.origin.x, s.origin.y, s.origin.z,
                           s.direction.x, s.direction.y, s.direction.z, s.scan_angle, s.waveform_start,
                           static_cast<std::int64_t>(samples_.size()), static_cast<std::int64_t>(point_count_),
                           s.samples, s.echoes, s.leg, s.channel, static_cast<std::uint8_t>(s.fate)});
        for (const float sample : batch.waveform_of(s)) samples_.push_back(sample);
      }
      point_count_ += s.echoes;
    }
  }

  [[nodiscard]] std::size_t pulses() const noexcept { return pulse_count_; }  ///< since `take`
  /// Data so far, as NumPy arrays; leaves this empty. Requires the GIL.
  [[nodiscard]] Batch take() {
    pulse_count_ = point_count_ = 0;
    Batch batch{points_ ? points_->take() : pybind11::array(), pulses_.take(), samples_.take(), sample_interval_};
    if (columns_) batch.columns = columns_->take();
    batch.by_column = !points_;
    return batch;
  }

 private:
  bool keeps_pulses_;
  std::size_t pulse_count_ = 0, point_count_ = 0;
  std::optional<PointRows> points_;
  std::optional<PointColumns> columns_;
  Rows<PulseRow> pulses_;
  Rows<float> samples_;
  double sample_interval_ = 0;
};

/// Samples of the pulse in a row of a `Batch`, as its method `waveform_of`.
[[nodiscard]] inline pybind11::array_t<float> waveform_of(const pybind11::object& self, pybind11::ssize_t row) {
  namespace py = pybind11;
  const auto& pulses = self.cast<const Batch&>().pulses;
  if (row < 0 || row >= pulses.size())
    throw py::index_error("row " + std::to_string(row) + " of " + std::to_string(pulses.size()) + " pulses");
  const PulseRow& p = pulses.data()[row];
  const py::slice samples(p.first_sample, p.first_sample + p.samples, 1);
  return self.attr("waveforms")[samples].cast<py::array_t<float>>();
}

[[nodiscard]] inline pybind11::tuple state_of(const Batch& b) {
  const pybind11::bytes summary(reinterpret_cast<const char*>(&b.summary), sizeof b.summary);
  return pybind11::make_tuple(b.points, b.pulses, b.waveforms, b.sample_interval, summary, b.columns, b.by_column);
}

/// Inverse of `state_of`. Throws a `ValueError` for the state of another version.
[[nodiscard]] inline Batch batch_of(const pybind11::tuple& state) {
  namespace py = pybind11;
  if (state.size() != 7) throw py::value_error("a Batch of another version of pulsecast");
  const auto summary = state[4].cast<std::string>();
  Batch b{state[0].cast<py::array>(),          state[1].cast<py::array_t<PulseRow>>(),
          state[2].cast<py::array_t<float>>(), state[3].cast<double>(),
          state[5].cast<py::dict>(),           state[6].cast<bool>()};
  if (summary.size() != sizeof b.summary) throw py::value_error("a Batch of another version of pulsecast");
  std::memcpy(&b.summary, summary.data(), sizeof b.summary);
  return b;
}

/// Rows of the points. Throws an `AttributeError` if they are kept by column.
[[nodiscard]] inline pybind11::array points_of(const Batch& b) {
  if (b.by_column)
    throw pybind11::attribute_error("points are kept by column: take `columns`, or run without columns=True");
  return b.points;
}

/// All columns of the points, as arrays by name: views of the rows, if there are any.
[[nodiscard]] inline pybind11::dict columns_of(const Batch& b) {
  pybind11::dict all;
  if (!b.by_column)
    for (const pybind11::handle name : b.points.dtype().attr("names")) all[name] = b.points[name];
  for (const auto& [name, column] : b.columns) all[name] = column;
  return all;
}

[[nodiscard]] inline std::size_t point_count(const Batch& b) {
  if (!b.by_column) return static_cast<std::size_t>(b.points.size());
  for (const auto& [name, column] : b.columns) return pybind11::len(column);
  return 0;
}

/// Capsule of the columns, as `__arrow_c_stream__` returns it. A requested schema is ignored.
/// Throws a `ValueError` if points are kept as rows, which Arrow cannot share without copies.
[[nodiscard]] inline pybind11::object arrow_stream_of(const Batch& b, const pybind11::object& requested_schema) {
  if (!requested_schema.is_none() && PyCapsule_IsValid(requested_schema.ptr(), "arrow_schema") == 0)
    throw pybind11::type_error("__arrow_c_stream__ requested_schema: expected a capsule 'arrow_schema', not " +
                               std::string(pybind11::repr(requested_schema)));
  if (!b.by_column)
    throw pybind11::value_error(
        "points are kept as rows, which Arrow cannot take without copies: run with columns=True");
  return ArrowStream::capsule(b.columns);
}

/// Terms of a ledger by name [J].
[[nodiscard]] inline pybind11::dict dict_of(const EnergyLedger& energy) {
  using namespace pybind11::literals;
  return pybind11::dict("sent"_a = energy.sent, "missed"_a = energy.missed, "out_of_range"_a = energy.out_of_range,
                        "absorbed"_a = energy.absorbed, "scattered"_a = energy.scattered, "cut"_a = energy.cut,
                        "received"_a = energy.received);
}

/// Names of columns, with their units.
[[nodiscard]] inline std::string described(std::span<const io::PointColumn> columns) {
  std::string all;
  for (const io::PointColumn& column : columns) {
    all += text::joined({all.empty() ? "" : ", ", column.name});
    if (!column.unit.empty()) all += text::joined({" [", column.unit, "]"});
  }
  return all;
}

[[nodiscard]] inline pybind11::str fate_name(std::size_t fate) {
  return std::string(io::name_of(static_cast<Fate>(fate)));
}

inline void bind_batch(pybind11::module_& m) {
  namespace py = pybind11;
  const auto fates = [](const Batch& b) {
    py::dict all;
    for (std::size_t f = 0; f < fate_count; ++f) all[fate_name(f)] = b.summary.fates[f];
    return all;
  };
  const auto summary = [](auto member) { return [member](const Batch& b) { return b.summary.*member; }; };
  py::class_<Batch>(m, "Batch", py::module_local(), "Results of a run, or, in a callback, those since the last call.")
      .def_property_readonly(
          "points", &points_of,
          ("Structured array, one row per echo, in the world: " + described(io::usual_point_columns) +
           ". Kinds of light: 0 direct, 1 through glass, 2 from water, 3 by a mirror, 4 from the "
           "air, 5 scattered more than once. AttributeError after run(columns=True).")
              .c_str())
      .def_property_readonly(
          "columns", &columns_of,
          "Arrays of a number per echo, by name: those of `points`, then red, green, blue and near_infrared (from 0 to "
          "65535) after run(colours=True), and the attributes of objects, NaN where an object has none. After "
          "run(columns=True) each is contiguous, else those of `points` are views of its rows. After "
          "run(columns=names) "
          "there are those of the names alone.")
      .def("__arrow_c_stream__", &arrow_stream_of, py::arg("requested_schema") = py::none(),
           "Capsule of an Arrow C stream of the columns, which shares their memory, for run(columns=True). Raises "
           "ValueError otherwise.")
      .def_readonly(
          "pulses", &Batch::pulses,
          "Structured array, one row per pulse sent: pulse; time [s]; x, y, z [m, world]; direction_x, direction_y, "
          "direction_z; scan_angle [rad]; waveform_start [s]; first_sample, samples; first_point, points; leg; "
          "channel; fate, an index into FATES.")
      .def_readonly("waveforms", &Batch::waveforms, "Samples of all pulses, concatenated, shape (n,) [W].")
      .def_readonly("sample_interval", &Batch::sample_interval,
                    "Sample spacing of the waveforms [s]; 0 without waveforms.")
      .def_property_readonly("slots", summary(&RunSummary::slots), "Pulse slots done.")
      .def_property_readonly("rays", summary(&RunSummary::rays), "Subrays traced.")
      .def_property_readonly("seconds", summary(&RunSummary::seconds), "Elapsed time of the run [s].")
      .def_property_readonly("complete", summary(&RunSummary::complete), "False if the run was stopped.")
      .def_property_readonly("fates", fates, "Pulse slots by fate.")
      .def_property_readonly(
          "energy", [](const Batch& b) { return dict_of(b.summary.energy); },
          "Energy sent, and its parts by the end of their paths [J]: missed, out_of_range, absorbed, scattered, cut. "
          "received: energy at the receiver, of that scattered.")
      .def("waveform_of", &waveform_of, py::arg("row"), "Samples of the pulse in a row of `pulses`, shape (n,) [W].")
      .def("__repr__",
           [](const Batch& b) {
             return "<Batch of " + std::to_string(point_count(b)) + " points, " + std::to_string(b.pulses.size()) +
                    " pulses, " + std::to_string(b.waveforms.size()) + " samples>";
           })
      .def(py::pickle(&state_of, &batch_of));
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
