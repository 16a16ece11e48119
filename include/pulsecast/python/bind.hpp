// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_BIND_HPP
#define PULSECAST_PYTHON_BIND_HPP

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include <pulsecast/python/detail/exceptions.hpp>
#include <pulsecast/python/detail/interrupt_watch.hpp>
#include <pulsecast/python/detail/rows.hpp>
#include <pulsecast/run.hpp>

/// Python bindings of surveys: any compile-time pipeline, with user-defined optics too, becomes a class whose runs return NumPy arrays.
///
///     PYBIND11_MODULE(own_scanner, m) {
///       pulsecast::python::bind_survey<OwnSurvey>(m, "OwnSurvey").def(pybind11::init(&make_own_survey));
///     }
///
/// A run releases the GIL; Ctrl-C ends it, and results up to then are complete.
namespace PULSECAST_NAMESPACE::python {

/// Echo as a row of a NumPy array, named as in point clouds. Numbers for calculation are signed, as NumPy makes fractions of unsigned ones.
struct PointRow {
  double x, y, z;                  ///< position in the world [m]
  double time;                     ///< departure of its pulse, since the survey's start [s]
  double range;                    ///< range along the pulse's axis [m]
  float intensity;                 ///< received power at the echo's peak [W]
  float reflectance;               ///< as in `Echo`
  float echo_width;                ///< standard deviation in time; 0 if not asked for, NaN if none was found [s]
  float cos_incidence;             ///< of the strongest contributor
  std::int64_t pulse;              ///< number of the pulse slot
  std::uint32_t object;            ///< of the strongest contributor
  std::uint16_t classification;    ///< of the strongest contributor
  std::uint16_t leg;               ///< number of the leg, from 0
  std::uint8_t return_number;      ///< return number, from 1 in order of range
  std::uint8_t number_of_returns;  ///< returns of its pulse, 255 if more
  std::uint16_t channel;           ///< number of the emitter, from 0
  std::uint8_t kind;               ///< way of its light, by number: `ReflectionKind`
  std::uint8_t spare[3]{};         ///< zeros outside the array, so that equal rows have equal bytes
};

/// Pulse sent, as a row of a NumPy array.
struct PulseRow {
  std::int64_t pulse;                            ///< number of the slot
  double time;                                   ///< departure, since the survey's start [s]
  double x, y, z;                                ///< origin in the world [m]
  double direction_x, direction_y, direction_z;  ///< unit direction in the world
  double scan_angle;                             ///< as in `Pulse` [rad]
  double waveform_start;                         ///< two-way travel time of the first sample [s]
  std::int64_t first_sample, first_point;        ///< indices into the other arrays
  std::uint32_t samples, points;                 ///< numbers of samples and points
  std::uint16_t leg;                             ///< number of the leg, from 0
  std::uint16_t channel;                         ///< number of the emitter, from 0
  std::uint8_t fate;                             ///< as in `Fate`
  std::uint8_t spare[3]{};                       ///< zeros outside the array
};

}  // namespace PULSECAST_NAMESPACE::python

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Names of the values of `Fate`, in order.
inline constexpr std::array<const char*, fate_count> fate_names{"returned",     "blocked",         "missed",
                                                                "out_of_range", "below_threshold", "absorbed"};

/// Results of a run, for Python.
struct Batch {
  pybind11::array_t<PointRow> points;  ///< one row an echo
  pybind11::array_t<PulseRow> pulses;  ///< one row a pulse sent
  pybind11::array_t<float> waveforms;  ///< samples of all pulses, concatenated [W]
  double sample_interval = 0;          ///< between samples [s]
  RunSummary summary{};                ///< of the whole run; empty in a batch for a callback
};

/// Sink that keeps echoes and pulses as rows, or echoes alone.
class RowSink {
 public:
  /// `keeps_pulses`: true to keep pulses and waveforms.
  explicit RowSink(bool keeps_pulses) : keeps_pulses_(keeps_pulses) {}

  void operator()(const EchoBatch& batch) {
    sample_interval_ = batch.sample_interval;
    pulse_count_ += batch.shots.size();
    for (const Shot& s : batch.shots) {
      const double time = s.tick.seconds();
      if (keeps_pulses_) {
        pulses_.push_back({static_cast<std::int64_t>(s.index), time, s.origin.x, s.origin.y, s.origin.z, s.direction.x, s.direction.y,
                           s.direction.z, s.scan_angle, s.waveform_start, static_cast<std::int64_t>(samples_.size()),
                           static_cast<std::int64_t>(points_.size()), s.samples, s.echoes, s.leg, s.channel,
                           static_cast<std::uint8_t>(s.fate)});
        for (const float sample : batch.waveform_of(s)) samples_.push_back(sample);
      }
      for (const Echo& e : batch.echoes_of(s)) {
        const Vec3 p = point_of(s, e);
        points_.push_back({p.x, p.y, p.z, time, e.range, static_cast<float>(e.amplitude), static_cast<float>(e.reflectance),
                           static_cast<float>(e.width), static_cast<float>(e.cos_incidence), static_cast<std::int64_t>(s.index), e.object,
                           e.classification, s.leg, e.number, static_cast<std::uint8_t>(std::min<std::uint32_t>(255, s.echoes)), s.channel,
                           static_cast<std::uint8_t>(e.kind)});
      }
    }
  }

  [[nodiscard]] std::size_t pulses() const noexcept { return pulse_count_; }  ///< pulses sent since the last `take`
  /// Rows so far, as NumPy arrays; leaves this empty. Requires the GIL.
  [[nodiscard]] Batch take() {
    pulse_count_ = 0;
    return {points_.take(), pulses_.take(), samples_.take(), sample_interval_};
  }

 private:
  bool keeps_pulses_;
  std::size_t pulse_count_ = 0;
  Rows<PointRow> points_;
  Rows<PulseRow> pulses_;
  Rows<float> samples_;
  double sample_interval_ = 0;
};

/// Arguments of a survey's `run`, as in Python.
struct RunRequest {
  unsigned threads = 0;                          ///< as in `RunOptions`
  PulseIndex first = 0;                          ///< first slot
  std::optional<PulseIndex> end{};               ///< one past the last slot; all if empty
  PulseIndex stride = 1;                         ///< step between slots
  pybind11::object callback = pybind11::none();  ///< called with each batch; None to return one
  pybind11::object progress = pybind11::none();  ///< called with done, total, echoes and seconds; may be None
  PulseIndex every_pulses = 0;                   ///< pulses per batch of the callback; 0: no limit
  double every_seconds = 0;                      ///< time per batch of the callback; 0: no limit [s]
  bool pulses = true;                            ///< true to keep pulses and waveforms

  void validate() const {
    require_not_negative("run every_seconds", every_seconds, "s");
    for (const auto& [name, function] : {std::pair{"callback", callback}, std::pair{"progress", progress}})
      if (!function.is_none() && PyCallable_Check(function.ptr()) == 0)
        throw pybind11::type_error(std::string(name) + ": expected a function, not " + std::string(pybind11::repr(function)));
  }
};

/// Calls `run(options, sink)` without the GIL until done or interrupted. Rethrows Python exceptions of callbacks. Throws a `SettingError`,
/// or a `TypeError` for a callback that is not callable.
template <class Run>
[[nodiscard]] Batch run(const RunRequest& asked, const InterruptWatch& watch, const Run& run) {
  asked.validate();
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); };
  const bool hands_over = !asked.callback.is_none(), tells = !asked.progress.is_none();
  std::stop_source stopping;
  RowSink rows(asked.pulses);
  Batch result;
  auto handed_over = Clock::now(), told = handed_over;

  RunOptions options{.threads = asked.threads, .first = asked.first, .stride = asked.stride, .stop = stopping.get_token()};
  if (asked.end) options.end = *asked.end;
  options.progress = [&](const Progress& p) {
    if (watch.interrupted()) stopping.request_stop();
    if (!tells || (p.done < p.total && seconds_since(told) < 0.1)) return;
    told = Clock::now();
    const pybind11::gil_scoped_acquire gil;
    asked.progress(p.done, p.total, p.echoes, p.seconds);
  };
  const auto hand_over = [&] {
    const pybind11::gil_scoped_acquire gil;
    asked.callback(rows.take());
    handed_over = Clock::now();
  };
  const auto sink = [&](const EchoBatch& batch) {
    rows(batch);
    const bool is_due = (asked.every_pulses > 0 && rows.pulses() >= asked.every_pulses) ||
                        (asked.every_seconds > 0 && seconds_since(handed_over) >= asked.every_seconds);
    if (hands_over && is_due) hand_over();
  };
  {
    const pybind11::gil_scoped_release free;
    result.summary = run(options, sink);
  }
  if (hands_over && rows.pulses() > 0) hand_over();
  const RunSummary summary = result.summary;
  result = rows.take();
  result.summary = summary;
  return result;
}

/// Declares the rows to NumPy, in one registry for all modules.
inline void bind_rows() {
  if (pybind11::detail::get_numpy_internals().get_type_info<PointRow>(false)) return;
  PYBIND11_NUMPY_DTYPE(PointRow, x, y, z, time, range, intensity, reflectance, echo_width, cos_incidence, pulse, object, classification,
                       leg, return_number, number_of_returns, channel, kind);
  PYBIND11_NUMPY_DTYPE(PulseRow, pulse, time, x, y, z, direction_x, direction_y, direction_z, scan_angle, waveform_start, first_sample,
                       first_point, samples, points, leg, channel, fate);
}

/// Samples of the pulse in a row of a `Batch`, as its method `waveform_of`.
[[nodiscard]] inline pybind11::array_t<float> waveform_of(const pybind11::object& self, pybind11::ssize_t row) {
  namespace py = pybind11;
  const auto& pulses = self.cast<const Batch&>().pulses;
  if (row < 0 || row >= pulses.size())
    throw py::index_error("row " + std::to_string(row) + " of " + std::to_string(pulses.size()) + " pulses");
  const PulseRow& p = pulses.data()[row];
  return self.attr("waveforms")[py::slice(p.first_sample, p.first_sample + p.samples, 1)].cast<py::array_t<float>>();
}

/// State of a `Batch` for `pickle`.
[[nodiscard]] inline pybind11::tuple state_of(const Batch& b) {
  return pybind11::make_tuple(b.points, b.pulses, b.waveforms, b.sample_interval,
                              pybind11::bytes(reinterpret_cast<const char*>(&b.summary), sizeof b.summary));
}

/// Inverse of `state_of`. Throws a `ValueError` for the state of another version.
[[nodiscard]] inline Batch batch_of(const pybind11::tuple& state) {
  namespace py = pybind11;
  const auto summary = state[4].cast<std::string>();
  Batch b{state[0].cast<py::array_t<PointRow>>(), state[1].cast<py::array_t<PulseRow>>(), state[2].cast<py::array_t<float>>(),
          state[3].cast<double>()};
  if (summary.size() != sizeof b.summary) throw py::value_error("a Batch of another version of pulsecast");
  std::memcpy(&b.summary, summary.data(), sizeof b.summary);
  return b;
}

/// Terms of a ledger by name [J].
[[nodiscard]] inline pybind11::dict dict_of(const EnergyLedger& energy) {
  using namespace pybind11::literals;
  return pybind11::dict("sent"_a = energy.sent, "missed"_a = energy.missed, "out_of_range"_a = energy.out_of_range,
                        "absorbed"_a = energy.absorbed, "scattered"_a = energy.scattered, "cut"_a = energy.cut,
                        "received"_a = energy.received);
}

/// Adds the class `Batch` to a module.
inline void bind_batch(pybind11::module_& m) {
  namespace py = pybind11;
  const auto fates = [](const Batch& b) {
    py::dict all;
    for (std::size_t f = 0; f < fate_count; ++f) all[fate_names[f]] = b.summary.fates[f];
    return all;
  };
  py::class_<Batch>(m, "Batch", py::module_local(), "Results of a run, or, in a callback, those since the last call.")
      .def_readonly(
          "points", &Batch::points,
          "Structured array, one row per echo: x, y, z [m, world]; time [s]; range [m]; intensity [W]; reflectance; echo_width [s]; "
          "cos_incidence; pulse; object; classification; leg; return_number; number_of_returns; channel; kind of light: "
          "0 direct, 1 through glass, 2 from water, 3 by a mirror, 4 from the air, 5 scattered more than once.")
      .def_readonly("pulses", &Batch::pulses,
                    "Structured array, one row per pulse sent: pulse; time [s]; x, y, z [m, world]; direction_x, direction_y, "
                    "direction_z; scan_angle [rad]; waveform_start [s]; first_sample, samples; first_point, points; leg; channel; fate, "
                    "an index into FATES.")
      .def_readonly("waveforms", &Batch::waveforms, "Samples of all pulses, concatenated, shape (n,) [W].")
      .def_readonly("sample_interval", &Batch::sample_interval, "Sample spacing of the waveforms [s]; 0 without waveforms.")
      .def_property_readonly(
          "slots", [](const Batch& b) { return b.summary.slots; }, "Pulse slots done.")
      .def_property_readonly(
          "rays", [](const Batch& b) { return b.summary.rays; }, "Subrays traced.")
      .def_property_readonly(
          "seconds", [](const Batch& b) { return b.summary.seconds; }, "Elapsed time of the run [s].")
      .def_property_readonly(
          "complete", [](const Batch& b) { return b.summary.complete; }, "False if the run was stopped.")
      .def_property_readonly("fates", fates, "Pulse slots by fate.")
      .def_property_readonly(
          "energy", [](const Batch& b) { return dict_of(b.summary.energy); },
          "Energy sent, and its parts by the end of their paths [J]: missed, out_of_range, absorbed, scattered, cut. received: energy at "
          "the "
          "receiver, of that scattered.")
      .def("waveform_of", &waveform_of, py::arg("row"), "Samples of the pulse in a row of `pulses`, shape (n,) [W].")
      .def("__repr__",
           [](const Batch& b) {
             return "<Batch of " + std::to_string(b.points.size()) + " points, " + std::to_string(b.pulses.size()) + " pulses, " +
                    std::to_string(b.waveforms.size()) + " samples>";
           })
      .def(py::pickle(&state_of, &batch_of));
}

/// Adds exceptions and result types to a module; further calls do nothing.
inline void bind_common(pybind11::module_& m) {
  if (pybind11::hasattr(m, "Batch")) return;
  bind_rows();
  bind_exceptions(m);
  m.attr("FATES") = pybind11::tuple(pybind11::cast(fate_names));
  bind_batch(m);
}

/// Adds the method `run` to a class; `runner(self)` returns a callable of options and sink.
template <class Class, class Runner>
void bind_run(Class& bound, const Runner& runner) {
  namespace py = pybind11;
  using Self = typename Class::type;
  bound.def(
      "run",
      [runner](const Self& self, unsigned threads, PulseIndex first, std::optional<PulseIndex> end, PulseIndex stride, py::object callback,
               PulseIndex every_pulses, double every_seconds, py::object progress, bool pulses) {
        const InterruptWatch watch;
        Batch result =
            python::run({threads, first, end, stride, std::move(callback), std::move(progress), every_pulses, every_seconds, pulses}, watch,
                        runner(self));
        if (result.summary.complete && !watch.interrupted()) return result;  // an interrupt too late to stop the run is still reported
        raise(Exceptions{}.interrupted, "the survey was stopped", std::pair{"result", py::cast(std::move(result))});
        throw py::error_already_set();
      },
      py::arg("threads") = 0, py::arg("first") = 0, py::arg("end") = py::none(), py::arg("stride") = 1, py::arg("callback") = py::none(),
      py::arg("every_pulses") = 0, py::arg("every_seconds") = 0.0, py::arg("progress") = py::none(), py::arg("pulses") = true,
      "Simulates the pulse slots first, first + stride, ... before end, on `threads` threads (0: all, at most 1024), and returns a Batch. "
      "With a callback, "
      "batches go to callback(batch) every `every_pulses` pulses or `every_seconds` seconds, and at the end, and are not kept. "
      "progress(done, total, echoes, "
      "seconds) is called some ten times a second. pulses=False keeps points only, without rows of pulses and waveforms. Raises "
      "Interrupted on Ctrl-C; its `result` is complete up to there.");
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

namespace PULSECAST_NAMESPACE::python {

/// Adds a class of surveys, with all it needs, to a module. Constructors are up to the caller, by `.def(pybind11::init(...))`; a survey
/// that refers to a scene held by Python needs `pybind11::keep_alive`.
template <PulseSurvey Survey>
pybind11::class_<Survey, std::shared_ptr<Survey>> bind_survey(pybind11::module_& m, const char* name) {
  python::bind_common(m);
  pybind11::class_<Survey, std::shared_ptr<Survey>> bound(m, name, "A survey: a pure function from the number of a pulse to its echoes.");
  bound.def("__len__", &Survey::size, "Number of pulse slots.");
  bound.def_property_readonly("subrays", &Survey::subrays, "Number of subrays of a pulse.");
  python::bind_run(bound, [](const Survey& survey) {
    return [&survey](const RunOptions& options, const auto& sink) { return pulsecast::run(survey, options, sink); };
  });
  return bound;
}

}  // namespace PULSECAST_NAMESPACE::python

#endif
