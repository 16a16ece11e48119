// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/misses.hpp>
#include <pulsecast/python/bind.hpp>

#include "../pulsecast/clock.hpp"
#include "../pulsecast/loading.hpp"
#include "../pulsecast/notes.hpp"
#include "../pulsecast/outputs.hpp"
#include "../pulsecast/pages.hpp"
#include "../pulsecast/point_formats.hpp"
#include "../pulsecast/reference_systems.hpp"

namespace fs = std::filesystem;
namespace py = pybind11;
using namespace pulsecast;
using namespace py::literals;
using helios::Simulation;
using python::RunRequest;
using CompiledLeg = helios::CompiledSurvey::Leg;

namespace {

/// Option of the survey program as a keyword: `las_scale` for lasScale and las-scale.
std::string keyword_of(std::string_view name) {
  std::string all;
  for (const char c : name) {
    if (text::lower(c) != c) all += '_';
    all += c == '-' ? '_' : text::lower(c);
  }
  return all;
}

/// Message of the survey program with its options as keywords.
std::string in_keywords(std::string_view message) {
  const auto in_name = [](char c) {
    return c == '-' || (c >= '0' && c <= '9') || (text::lower(c) >= 'a' && text::lower(c) <= 'z');
  };
  std::string all;
  for (std::size_t at = 0; (at = message.find("--")) != std::string_view::npos;) {
    all += message.substr(0, at);
    message.remove_prefix(at + 2);
    const std::string_view name(message.begin(), std::ranges::find_if_not(message, in_name));
    all += keyword_of(name);
    message.remove_prefix(name.size());
  }
  return all.append(message);
}

/// Arguments of `run` and `write` about files.
struct FileRequest {
  std::vector<fs::path> paths{};
  std::vector<std::string> words{};  ///< options, as of a command line
  std::string format{};              ///< of names with no ending of a format
  unsigned threads = 0;
  PulseIndex first = 0, end = ~PulseIndex{0};  ///< slots
};

/// Appends an option with its value, a sequence item by item.
void add_words(const std::string& keyword, py::handle value, std::vector<std::string>& words) {
  std::string name = "--" + keyword;
  std::ranges::replace(name, '_', '-');
  if (value.is_none() || value.ptr() == Py_False) return;
  if (value.ptr() == Py_True) return words.push_back(name);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    for (const py::handle item : value) words.push_back(name + '=' + std::string(py::str(item)));
    return;
  }
  words.push_back(name + '=' + std::string(py::str(value)));
}

FileRequest request_of(const py::object& output, const std::vector<std::string>& columns, bool colours,
                       const py::kwargs& options) {
  FileRequest request;
  const auto path_of = [](py::handle name) {
    try {
      return name.cast<fs::path>();
    } catch (const py::cast_error&) {
      throw py::type_error("output: expected the name of a file, or a list of names, not " +
                           std::string(py::repr(name)));
    }
  };
  if (py::isinstance<py::list>(output) || py::isinstance<py::tuple>(output))
    for (const py::handle name : output) request.paths.push_back(path_of(name));
  else
    request.paths.push_back(path_of(output));
  for (const auto& [name, value] : options) {
    const auto keyword = name.cast<std::string>();
    if (const std::string right = keyword_of(keyword); right != keyword)
      throw py::value_error(keyword + " is no option of files; did you mean '" + right + "'?");
    if (keyword == "format" && !value.is_none())
      request.format = text::lower(std::string(py::str(value)));
    else
      add_words(keyword, value, request.words);
  }
  for (const std::string& column : columns) request.words.push_back("--columns=" + column);
  if (colours) request.words.emplace_back("--colours");
  return request;
}

constexpr std::array<std::string_view, 3> further_formats{"html", "geojson", "png"};  // of files without all points

bool is_point_format(std::string_view name) {
  return std::ranges::find(point_formats, name, &PointFormat::name) != point_formats.end();
}

/// Format of a file by the ending of its name, or as given.
std::string format_of(const fs::path& path, const std::string& given) {
  const std::string name =
      text::lower(path.filename().empty() ? path.parent_path().filename().string() : path.filename().string());
  std::string found;
  const auto try_ending = [&](std::string_view ending) {
    if (name.ends_with('.' + std::string(ending)) && ending.size() > found.size()) found = ending;
  };
  for (const std::string_view ending : further_formats) try_ending(ending);
  if (!found.empty()) return found;
  if (is_point_format(given)) return given;
  if (!given.empty())
    throw std::invalid_argument("format '" + given + "': expected " +
                                names_of_formats([](const PointFormat&) { return true; }));
  for (const PointFormat& format : point_formats) try_ending(format.name);
  if (!found.empty()) return found;
  std::string known;
  for (const PointFormat& format : point_formats) known += '.' + std::string(format.name) + ", ";
  throw std::invalid_argument("output '" + path.string() + "': expected a name that ends in " + known +
                              ".html, .geojson or .png, or format=");
}

/// Files that a run fills: of points, page, map and picture.
class RunFiles {
 public:
  /// Opens them. Throws std::invalid_argument, SettingError and FileError.
  RunFiles(const Simulation& simulation, const FileRequest& request) {
    std::vector<std::string> formats;
    for (const fs::path& path : request.paths) formats.push_back(format_of(path, request.format));
    const auto points = std::ranges::find_if(formats, is_point_format);
    const std::string others_as = points == formats.end() ? "ply" : *points;  // page, map and picture have all options
    for (std::size_t k = 0; k < formats.size(); ++k) {
      try {
        add(simulation, request, request.paths[k], formats[k], is_point_format(formats[k]) ? formats[k] : others_as);
      } catch (const SettingError&) {
        throw;
      } catch (const std::invalid_argument& problem) {
        throw std::invalid_argument("output '" + request.paths[k].string() + "': " + in_keywords(problem.what()));
      }
    }
  }

  void operator()(const EchoBatch& batch) {
    for (File& file : files_) (*file.file)(file.misses ? (*file.misses)(batch) : batch);
  }
  [[nodiscard]] bool reads_empty_shots() const noexcept { return reads_empty_shots_; }  ///< see ChoosesShots
  /// Completes the files.
  void close() {
    LeftOut left_out;
    for (File& file : files_) {
      file.file->close();
      file.file->count(left_out);
    }
    notes_.note(left_out.notes(las_1_0_));
  }
  /// Warns of what was noted. Requires the GIL.
  void warn_of_notes() const {
    std::vector<std::string> notes = kept_notes_;
    std::ranges::transform(notes, notes.begin(), in_keywords);
    warn(notes);
  }

 private:
  struct File {
    std::unique_ptr<PointFile> file;
    std::optional<io::MissPoints> misses{};
  };

  void add(const Simulation& simulation, const FileRequest& request, const fs::path& path, const std::string& format,
           const std::string& options_as) {
    const helios::SurveySettings& survey = simulation.document();
    std::vector<std::string> words = request.words;
    words.push_back("--format=" + options_as);
    Options o = options_of_files(words);
    o.threads = request.threads;
    o.geojson = format == "geojson";
    o.light_paths = simulation.settings().light_paths || survey.scene.follows_light();
    if (o.states_uncertainty() && !simulation.settings().uncertainty)
      throw std::invalid_argument("columns of the uncertainty: expected Simulation(..., uncertainty=True)");
    if (is_point_format(format) || o.geojson) o.reference = reference_system_of(o, survey.scene, notes_);
    const helios::CompiledSurvey& compiled = simulation.compiled();
    const double start = compiled.clock_start ? *compiled.clock_start : start_of(o);
    if (is_point_format(format))
      settle_clock(o, simulation, start, start + compiled.source.duration().seconds(), notes_);
    take_columns(o, survey, simulation);
    const PointFormat* const points = is_point_format(format) ? &point_format(format) : nullptr;
    if (points && (points->in_scans || format == "ptx") && !o.sensors.contains(whole_run))
      throw std::invalid_argument("the survey has no active leg, and format " + format + " is in the scanner's frame");
    std::erase_if(o.ptx_scans[whole_run],
                  [&](const io::PtxScan& scan) { return scan.end <= request.first || scan.first >= request.end; });
    las_1_0_ = las_1_0_ || o.las_1_0;
    File file;
    if (format == "html")
      file.file = page_file(path, survey, compiled, o);
    else if (format == "geojson")
      file.file = map_file(path, o);
    else if (format == "png")
      file.file = picture_file(path, survey);
    else
      file.file = point_file(path, whole_run, o, start);
    if (points && o.misses_at) file.misses.emplace(io::MissSettings{.range = *o.misses_at});
    reads_empty_shots_ = reads_empty_shots_ || o.geojson || file.misses || (points && points->in_scans);
    files_.push_back(std::move(file));
  }

  /// Start of the survey by the clock of a GPS week [s], the same for all files.
  double start_of(const Options& o) {
    if (!start_) start_ = gps_week_seconds(unix_time_of(o.gps_start_time));
    return *start_;
  }

  std::vector<File> files_;
  std::vector<std::string> kept_notes_;
  Notes notes_{kept_notes_};
  std::optional<double> start_;
  bool reads_empty_shots_ = false, las_1_0_ = false;
};

std::unique_ptr<RunFiles> files_of(const Simulation& simulation, const FileRequest& request) {
  const py::gil_scoped_release free;
  return std::make_unique<RunFiles>(simulation, request);
}

/// Points of a batch, as the run gave them.
class Replay {
 public:
  /// Requires the GIL. Throws a ValueError for a batch without what files need.
  explicit Replay(const python::Batch& batch) : pulses_(batch.pulses), count_(python::point_count(batch)) {
    if (pulses_.size() == 0 && (count_ > 0 || batch.summary.pulses() > 0))
      throw py::value_error(
          "write: the batch has no pulses, by which points are written: expected that of run(pulses=True), or "
          "run(output=...)");
    columns_ = python::columns_of(batch);
    std::ranges::transform(names, sources_.begin(), [this](const char* name) { return source(name); });
    std::ranges::transform(axes, places_.begin(), [this](const char* name) { return source(name); });
  }

  /// Gives all pulses to a sink, without the GIL. Returns false if it was stopped.
  template <class Sink>
  [[nodiscard]] bool operator()(const std::stop_token& stop, Sink& sink) const {
    constexpr py::ssize_t some = 4096;
    std::vector<Shot> shots;
    std::vector<Echo> echoes;
    for (py::ssize_t first = 0; first < pulses_.size(); first += some) {
      if (stop.stop_requested()) return false;
      shots.clear();
      echoes.clear();
      for (py::ssize_t i = first; i < std::min(first + some, pulses_.size()); ++i)
        add(pulses_.data()[i], shots, echoes);
      sink(EchoBatch{.shots = shots, .echoes = echoes, .samples = {}});
    }
    return true;
  }

 private:
  struct Source {
    const std::byte* data = nullptr;
    py::ssize_t stride = 0;
    io::PointField field{};

    [[nodiscard]] double operator[](std::size_t point) const noexcept {
      return io::number_in(data + static_cast<py::ssize_t>(point) * stride, field);
    }
  };

  [[nodiscard]] Source source(const char* name) const {
    if (!columns_.contains(name))
      throw py::value_error("write: the batch has no column '" + std::string(name) +
                            "': expected that of run(), or of run(columns=True)");
    const auto array = columns_[name].cast<py::array>();
    const io::PointColumn& column = io::find_column(name);
    return {static_cast<const std::byte*>(array.data()), array.strides(0), {name, column.type, &column}};
  }

  void add(const python::PulseRow& p, std::vector<Shot>& shots, std::vector<Echo>& echoes) const {
    const auto first = static_cast<std::size_t>(p.first_point);
    if (first + p.points > count_)
      throw std::invalid_argument("write: the rows of pulses name points that are not there");
    const Shot shot{.index = static_cast<PulseIndex>(p.pulse),
                    .tick = Tick::of_seconds(p.time),
                    .origin = {p.x, p.y, p.z},
                    .direction = {p.direction_x, p.direction_y, p.direction_z},
                    .scan_angle = p.scan_angle,
                    .leg = p.leg,
                    .channel = p.channel,
                    .fate = static_cast<Fate>(p.fate),
                    .first_echo = static_cast<std::uint32_t>(echoes.size()),
                    .echoes = p.points};
    for (std::size_t k = first; k < first + p.points; ++k) {
      const auto& [range, amplitude, reflectance, width, cosine, object, classification, number, kind] = sources_;
      echoes.push_back({.range = range[k],
                        .amplitude = amplitude[k],
                        .reflectance = reflectance[k],
                        .width = width[k],
                        .cos_incidence = cosine[k],
                        .object = static_cast<ObjectId>(object[k]),
                        .classification = static_cast<std::uint16_t>(classification[k]),
                        .number = static_cast<std::uint8_t>(number[k]),
                        .kind = static_cast<ReflectionKind>(kind[k])});
      const Vec3 point = point_of(shot, echoes.back());
      for (std::size_t axis = 0; axis < places_.size(); ++axis)
        if (!(std::fabs(places_[axis][k] - point[static_cast<int>(axis)]) <= 1e-6))  // other machines round otherwise
          throw std::invalid_argument("write: point " + std::to_string(k) +
                                      " has been moved: expected x, y and z as the run gave them");
    }
    shots.push_back(shot);
  }

  static constexpr std::array axes{"x", "y", "z"};
  static constexpr std::array names{"range",  "intensity",      "reflectance",   "echo_width", "cos_incidence",
                                    "object", "classification", "return_number", "kind"};
  py::array_t<python::PulseRow> pulses_;
  std::size_t count_;
  py::dict columns_;
  std::array<Source, names.size()> sources_;
  std::array<Source, axes.size()> places_;
};

/// Throws a ValueError for columns that a batch does not hold.
void require_held(const FileRequest& request) {
  for (const std::string& word : request.words) {
    const std::string name = word.substr(std::min(word.find('=') + 1, word.size()));
    const bool is_column = word.starts_with("--columns=");
    const io::PointColumn* const column = is_column ? io::detail::column_or_null(name) : nullptr;
    if (word == "--uncertainty" ||
        (column && (column->needs == io::PointNeed::uncertainty || column == io::column("radial_velocity"))))
      throw py::value_error("write: a batch does not hold " + (is_column ? "the column " + name : "the uncertainty") +
                            ": expected run(output=...)");
  }
}

void write_batch(const python::Batch& batch, const py::object& output, const std::vector<std::string>& columns,
                 bool colours, python::Whole<"write threads", unsigned> threads, const py::kwargs& options) {
  FileRequest request = request_of(output, columns, colours, options);
  request.threads = threads;
  if (!batch.survey || batch.survey.is_none())
    throw py::value_error("write: a Batch that was copied or sent has no survey: expected that of run()");
  require_held(request);
  const Replay replay(batch);
  const std::unique_ptr<RunFiles> files = files_of(batch.survey.cast<const Simulation&>(), request);
  python::interruptible([&](const std::stop_token& stop) {
    if (replay(stop, *files)) files->close();
  });
  files->warn_of_notes();
}

/// Run of a simulation, to files too if there are any.
class FileRun {
 public:
  FileRun(const Simulation& simulation, const RunRequest& request, const py::object& output, const py::kwargs& options)
      : simulation_(simulation), to_sink_(output.is_none() || !request.callback.is_none()) {
    if (output.is_none()) {
      if (options.size() > 0)
        throw py::type_error("run: " + std::string(py::str(options.begin()->first)) +
                             " is an option of files: expected output=, or a known argument");
      return;
    }
    request.validate();
    const auto* const columns = std::get_if<std::vector<std::string>>(&request.columns);
    FileRequest of_files =
        request_of(output, columns ? *columns : std::vector<std::string>{}, request.colours, options);
    of_files.threads = request.threads;
    of_files.first = request.first;
    if (request.end) of_files.end = *request.end;
    files_ = files_of(simulation, of_files);
  }

  template <class Sink>
  RunSummary operator()(const RunOptions& options, const Sink& sink) const {
    if (!files_) return pulsecast::run(simulation_.survey(), options, sink);
    const std::function<void(const EchoBatch&)> to_batches = std::cref(sink);
    return pulsecast::run(simulation_.survey(), options, Both{*files_, to_sink_ ? &to_batches : nullptr});
  }
  /// Completes the files, after an interrupt, too. After an error of a callback it is not called: there is none.
  void close() const {
    if (files_) files_->close();
  }
  /// Warns of what files noted, and of a run of all slots, or of those of whole legs, without points.
  void after(const RunRequest& request, const RunSummary& summary) const {
    if (files_) files_->warn_of_notes();
    if (summary.echoes > 0 || request.stride > 1) return;
    const auto& legs = simulation_.compiled().legs;
    const bool begins = request.first == 0 || std::ranges::count(legs, request.first, &CompiledLeg::first) > 0;
    const bool ends = !request.end || std::ranges::count(legs, *request.end, &CompiledLeg::end) > 0;
    if (!begins || !ends) return;
    if (const std::string why = why_no_points(simulation_, summary, request.first); !why.empty()) warn({why});
  }

 private:
  /// Sink of files, and of batches for a callback.
  struct Both {
    RunFiles& files;
    const std::function<void(const EchoBatch&)>* to_batches;
    void operator()(const EchoBatch& batch) const {
      files(batch);
      if (to_batches) (*to_batches)(batch);
    }
    [[nodiscard]] bool reads_empty_shots() const noexcept { return to_batches || files.reads_empty_shots(); }
  };

  const Simulation& simulation_;
  std::shared_ptr<RunFiles> files_;
  bool to_sink_;
};

/// Documentation of the options, as the survey program describes them.
std::string described_options() {
  std::string all;
  for (const auto& [name, help] : file_options())
    if (name != "columns" && name != "colours")
      all.append(all.empty() ? "" : "\n- ").append(keyword_of(name)).append(": ").append(in_keywords(help));
  return all;
}

}  // namespace

void warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

void bind_run_to_files(py::class_<Simulation>& simulation) {
  const auto runner = [](const Simulation& s, const RunRequest& request, const py::object& output,
                         const py::kwargs& options) { return FileRun(s, request, output, options); };
  python::bind_run<py::object, py::kwargs>(
      simulation, runner, [](const Simulation& s) { return s.points(); },
      " With output, a file or a list of files, points go to these as they come, and are not kept: the Batch has none. "
      "`columns` and `colours` are of the files, too. Names and options are those of Batch.write; Interrupted leaves "
      "files that are complete up to there. Raises ValueError, FileError.",
      "output"_a = py::none());
}

void bind_write(py::module_& m) {
  const py::object batch = m.attr("Batch");
  const std::string doc =
      "Writes the points to a file, or to each of a list of files, as the survey program writes them. The ending says "
      "the format of points; .html is the page, .geojson has trajectories and footprints, .png is a picture; a KITTI "
      "sequence is a folder. columns: further columns of the points, of the survey's. colours: colours of surfaces. "
      "threads: that compress; 0: all. Needs the pulses of the run. Intensities have the single precision of the "
      "batch; those of run(output=...) have double. Raises ValueError, SettingError, FileError. Further options, by "
      "keyword:\n- " +
      described_options();
  batch.attr("write") =
      py::cpp_function(&write_batch, py::name("write"), py::is_method(batch), doc.c_str(), "output"_a, py::kw_only(),
                       "columns"_a = std::vector<std::string>{}, "colours"_a = false, "threads"_a = 0);
}
