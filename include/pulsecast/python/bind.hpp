// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_BIND_HPP
#define PULSECAST_PYTHON_BIND_HPP

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <chrono>
#include <future>
#include <iterator>

#include <pulsecast/python/detail/batch.hpp>
#include <pulsecast/python/detail/exceptions.hpp>
#include <pulsecast/python/detail/whole.hpp>

/// Python bindings of surveys: any compile-time pipeline becomes a class with runs to NumPy arrays.
///
///     PYBIND11_MODULE(own_scanner, m) {
///       pulsecast::python::bind_survey<OwnSurvey>(m, "OwnSurvey").def(pybind11::init(&make_own_survey));
///     }
///
/// A run releases the GIL; Ctrl-C ends it, and results up to then are complete.
namespace PULSECAST_NAMESPACE::python {}

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Lets Python handle its signals during work without the GIL, on the main thread alone. A handler
/// that raises, as that of Ctrl-C, stops the work; another is called meanwhile.
class InterruptWatch {
 public:
  /// Will ask `stopping` for the end of the work.
  explicit InterruptWatch(std::stop_source stopping) : stopping_(std::move(stopping)) {
    const pybind11::module_ threading = pybind11::module_::import("threading");
    on_main_ = threading.attr("current_thread")().is(threading.attr("main_thread")());
  }

  /// Calls `work()`; on the main thread, on another one, and handles signals. Needs the GIL.
  template <class Work>
  void during(const Work& work) {
    const pybind11::gil_scoped_release free;
    if (!on_main_) return work();
    std::future<void> done = std::async(std::launch::async, work);
    const auto handle = [this] {
      const pybind11::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() == 0) return;
      raised_.emplace();
      stopping_.request_stop();
    };
    while (done.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) handle();
    handle();  // an interrupt too late to stop the work is still reported
    done.get();
  }

  /// True after Ctrl-C. Throws what another handler raised.
  [[nodiscard]] bool interrupted() const {
    if (raised_ && !raised_->matches(PyExc_KeyboardInterrupt)) throw pybind11::error_already_set(*raised_);
    return raised_.has_value();
  }

 private:
  std::stop_source stopping_;
  std::optional<pybind11::error_already_set> raised_{};  // by a handler
  bool on_main_ = false;
};

/// Thrown in work that Ctrl-C ends, in place of its results.
struct Stopped {};

/// Executor of work that Ctrl-C ends: `for_each` throws `Stopped` when it is asked to.
class InterruptibleThreads {
 public:
  /// `count` threads, as in `thread_count`, until `stop` is requested.
  InterruptibleThreads(unsigned count, std::stop_token stop) : threads_(thread_count(count)), stop_(std::move(stop)) {}
  [[nodiscard]] unsigned threads() const noexcept { return threads_; }
  void for_each(std::size_t count, const IndexTask& task) const {
    if (!stop_.stop_requested()) for_each_index(count, threads_, task);
    if (stop_.stop_requested()) throw Stopped{};
  }

 private:
  unsigned threads_;
  std::stop_token stop_;
};

/// Calls `work(stop)` without the GIL, which may throw `Stopped` once a stop is requested by Ctrl-C; that is raised.
template <class Work>
void interruptible(const Work& work) {
  std::stop_source stopping;
  InterruptWatch watch(stopping);
  watch.during([&] {
    try {
      work(stopping.get_token());
    } catch (const Stopped&) {  // what the handler of a signal raised is thrown below
    }
  });
  if (!watch.interrupted()) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw pybind11::error_already_set();
}

/// Arguments of a survey's `run`, as in Python.
struct RunRequest {
  unsigned threads = 0;                          ///< as in `RunOptions`
  PulseIndex first = 0;                          ///< first slot
  std::optional<PulseIndex> end{};               ///< one past the last slot; all if empty
  PulseIndex stride = 1;                         ///< step between slots
  pybind11::object callback = pybind11::none();  ///< called with each batch; None to return one
  pybind11::object progress = pybind11::none();  ///< called with done, total, echoes, seconds
  PulseIndex every_pulses = 0;                   ///< pulses per batch of the callback; 0: no limit
  double every_seconds = 0;                      ///< time per batch; 0: no limit [s]
  bool pulses = true;                            ///< true to keep pulses and waveforms
  /// True to keep points by column, or the names of the columns that are kept
  std::variant<bool, std::vector<std::string>> columns = false;
  bool colours = false;                        ///< true to keep colours of points
  pybind11::object survey = pybind11::none();  ///< what batches are of

  void validate() const {
    require_not_negative("run every_seconds", every_seconds, "s");
    for (const auto& [name, function] : {std::pair{"callback", callback}, std::pair{"progress", progress}})
      if (!function.is_none() && PyCallable_Check(function.ptr()) == 0)
        throw pybind11::type_error(std::string(name) + ": expected a function, not " +
                                   std::string(pybind11::repr(function)));
  }
};

namespace detail {

/// Data that a run keeps. @throws SettingError for an unknown column @throws ValueError for columns
/// that need colours or surfaces of a survey without any
[[nodiscard]] inline KeptData kept_by(const RunRequest& request, io::PointSettings points) {
  const std::vector<std::string>& attributes = points.attributes.names();
  const auto* const names = std::get_if<std::vector<std::string>>(&request.columns);
  std::vector<io::PointField> usual = names ? io::layouts::columns(*names, attributes)
                                            : io::layouts::columns(io::usual_point_columns),
                              more;
  if (request.colours) more = io::layouts::deep_colours();
  if (!names) std::ranges::copy(io::layouts::attributes(attributes), std::back_inserter(more));
  const bool rows = !names && !std::get<bool>(request.columns);
  KeptData kept{.pulses = request.pulses, .points = std::move(points)};
  if (rows) kept.rows = row_layout();
  kept.columns = rows ? io::PointLayout::packed(more) : io::PointLayout::packed(usual).with(more);
  if (kept.columns.needs(io::PointNeed::colour) && !kept.points.colours)
    throw pybind11::value_error("run colours: the points of this survey have none");
  if (kept.columns.needs(io::PointNeed::surface) && !kept.points.surfaces)
    throw pybind11::value_error("run columns: the points of this survey have no surfaces");
  return kept;
}

/// Run with an end of its own, unless a callback fails: after the last batch `close()`, without the GIL, then `after`,
/// with it.
template <class Run>
concept HasEnd = requires(const Run& run, const RunRequest& request, const RunSummary& summary) {
  { run.close() } -> std::same_as<void>;
  { run.after(request, summary) } -> std::same_as<void>;
};

}  // namespace detail

/// Calls `run(options, sink)` without the GIL until done or interrupted, and keeps its points.
/// Rethrows Python exceptions of callbacks and signal handlers; that of Ctrl-C as `Interrupted`,
/// with the result. Throws a `TypeError` for a callback that is not callable, and as `kept_by`. See `HasEnd`.
template <class Run>
[[nodiscard]] Batch run(const RunRequest& request, io::PointSettings points, const Run& run) {
  request.validate();
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  const bool has_callback = !request.callback.is_none(), reports = !request.progress.is_none();
  std::stop_source stopping;
  RowSink rows(detail::kept_by(request, std::move(points)));
  auto delivered = Clock::now(), reported = delivered;

  InterruptWatch watch(stopping);
  RunOptions options{
      .threads = request.threads, .first = request.first, .stride = request.stride, .stop = stopping.get_token()};
  if (request.end) options.end = *request.end;
  options.progress = [&](const Progress& p) {
    if (!reports || (p.done < p.total && seconds_since(reported) < 0.1)) return;
    reported = Clock::now();
    const pybind11::gil_scoped_acquire gil;
    request.progress(p.done, p.total, p.echoes, p.seconds);
  };
  const auto taken = [&] {
    Batch batch = rows.take();
    batch.survey = request.survey;
    return batch;
  };
  const auto deliver = [&] {
    const pybind11::gil_scoped_acquire gil;
    request.callback(taken());
    delivered = Clock::now();
  };
  const auto sink = [&](const EchoBatch& batch) {
    rows(batch);
    const auto [pulses, seconds] = std::pair(request.every_pulses, request.every_seconds);
    const bool is_due = (pulses > 0 && rows.pulses() >= pulses) || (seconds > 0 && seconds_since(delivered) >= seconds);
    if (has_callback && is_due) deliver();
  };
  RunSummary summary;
  watch.during([&] {
    summary = run(options, sink);
    if (has_callback && rows.pulses() > 0) deliver();
    if constexpr (detail::HasEnd<Run>) run.close();
  });
  const bool interrupted = watch.interrupted();
  if constexpr (detail::HasEnd<Run>) run.after(request, summary);
  Batch result = taken();
  result.summary = summary;
  if (!interrupted) return result;
  raise(Exceptions{}.interrupted, "the survey was stopped", std::pair{"result", pybind11::cast(std::move(result))});
  throw pybind11::error_already_set();
}

/// Adds exceptions and result types to a module; further calls do nothing.
inline void bind_common(pybind11::module_& m) {
  if (pybind11::hasattr(m, "Batch")) return;
  bind_rows();
  bind_exceptions(m);
  pybind11::list fates;
  for (std::size_t f = 0; f < fate_count; ++f) fates.append(fate_name(f));
  m.attr("FATES") = pybind11::tuple(fates);
  bind_batch(m);
}

/// Adds the method `run` to a class; `runner(self, request, further...)` returns a callable of options and sink,
/// `extras(self)` the `io::PointSettings` of its points. Further arguments of `run` are of types `Further`: `arguments`
/// describe them, and `doc`.
template <class... Further, class Class, class Runner, class Extras, class... Arguments>
void bind_run(Class& bound, const Runner& runner, const Extras& extras, const std::string& doc = "",
              const Arguments&... arguments) {
  namespace py = pybind11;
  using Self = typename Class::type;
  bound.def(
      "run",
      [runner, extras](const py::object& survey, Whole<"run threads", unsigned> threads, Whole<"run first"> first,
                       std::optional<Whole<"run end">> end, Whole<"run stride"> stride, py::object callback,
                       Whole<"run every_pulses"> every_pulses, double every_seconds, py::object progress, bool pulses,
                       std::variant<bool, std::vector<std::string>> columns, bool colours, const Further&... further) {
        const auto& self = survey.cast<const Self&>();
        const RunRequest request{threads,
                                 first,
                                 end,
                                 stride,
                                 std::move(callback),
                                 std::move(progress),
                                 every_pulses,
                                 every_seconds,
                                 pulses,
                                 std::move(columns),
                                 colours,
                                 survey};
        return python::run(request, extras(self), runner(self, request, further...));
      },
      py::arg("threads") = 0, py::arg("first") = 0, py::arg("end") = py::none(), py::arg("stride") = 1,
      py::arg("callback") = py::none(), py::arg("every_pulses") = 0, py::arg("every_seconds") = 0.0,
      py::arg("progress") = py::none(), py::arg("pulses") = true, py::arg("columns") = false,
      py::arg("colours") = false, arguments...,
      ("Simulates the pulse slots first, first + stride, ... before end, on `threads` threads (0: all, at most 1024), "
       "and returns a Batch. With a callback, batches go to callback(batch) every `every_pulses` pulses or "
       "`every_seconds` seconds, and at the end, and are not kept. progress(done, total, echoes, seconds) is called "
       "some ten times a second. pulses=False keeps points only, without rows of pulses and waveforms. columns=True "
       "keeps points by column, as Arrow takes them, in place of rows; a list of names keeps these alone: of "
       "attributes, "
       "or of " +
       described(io::point_columns) +
       ". colours=True keeps their colours, by one more ray each. Raises Interrupted on Ctrl-C; its `result` is "
       "complete up to there." +
       doc)
          .c_str());
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

namespace PULSECAST_NAMESPACE::python {

/// Adds a class of surveys to a module. Constructors are up to the caller, by
/// `.def(pybind11::init(...))`; a survey that refers to a scene held by Python needs
/// `pybind11::keep_alive`. `extras(survey)` gives the `io::PointSettings` of its points, such as
/// `io::points_of(scene)`.
template <PulseSurvey Survey, class Extras>
auto bind_survey(pybind11::module_& m, const char* name, const Extras& extras) {
  python::bind_common(m);
  pybind11::class_<Survey, std::shared_ptr<Survey>> bound(
      m, name, "A survey: a pure function from the number of a pulse to its echoes.");
  bound.def("__len__", &Survey::size, "Number of pulse slots.");
  bound.def_property_readonly("subrays", &Survey::subrays, "Number of subrays of a pulse.");
  const auto runner = [](const Survey& survey, const RunRequest& /*request*/) {
    return [&survey](const RunOptions& how, const auto& sink) { return pulsecast::run(survey, how, sink); };
  };
  python::bind_run(bound, runner, extras);
  return bound;
}
/// As above, of points without colours and attributes.
template <PulseSurvey Survey>
auto bind_survey(pybind11::module_& m, const char* name) {
  return bind_survey<Survey>(m, name, [](const Survey&) { return io::PointSettings{}; });
}

}  // namespace PULSECAST_NAMESPACE::python

#endif
