// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The Python module `pulsecast`: surveys of documents, run as the survey program runs them. For user-defined pipelines
// there is `bind_survey`; see `own_scanner.cpp`.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl/filesystem.h>

#include <pulsecast/accuracy.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/python/bind.hpp>
#include <pulsecast/version.hpp>

#include "../pulsecast/loading.hpp"
#include "outputs.hpp"
#include "planning.hpp"
#include "scene.hpp"
#include "settings.hpp"

namespace py = pybind11;
using namespace pulsecast;
using namespace py::literals;
using helios::CompiledSurvey;
using helios::Simulation;
using python::Whole;
using Paths = std::vector<std::filesystem::path>;

namespace {

/// Place of a platform, as a row of a NumPy array.
struct PoseRow {
  double time, x, y, z, roll, pitch, yaw;
  std::int32_t leg, spare{};
};

/// A leg, as a row of a NumPy array.
struct LegRow {
  std::int32_t number;
  bool active;
  std::uint8_t spare[3]{};
  double start, duration, pulse_rate;
  std::int64_t first, end;
};

/// Folders in which files are searched: those given, then the catalogue.
Paths with_catalogue(Paths folders) {
  for (std::filesystem::path& folder : py::module_::import("pulsecast").attr("asset_folders")().cast<Paths>())
    folders.push_back(std::move(folder));
  return folders;
}

std::unique_ptr<Simulation> simulation_of(py::handle survey, Paths assets, const py::object& meshes,
                                          const std::map<std::string, py::object>& trajectories,
                                          std::optional<Whole<"Simulation seed">> seed, bool echo_width, bool waveforms,
                                          bool waveform_noise, bool fixed_incidence, bool library_physics,
                                          bool light_paths, bool uncertainty, bool platform_noise, bool leg_noise,
                                          Whole<"Simulation threads", unsigned> threads,
                                          Whole<"Simulation repetition", int> run) {
  const helios::SurveySettings settings = survey_of(survey);
  require_within("Simulation repetition", run, 0, std::numeric_limits<int>::max(), "");
  assets = with_catalogue(std::move(assets));
  std::vector<Simulation::Mesh> more = meshes_of(meshes);
  std::map<std::string, std::vector<TimedPose>> paths;
  for (const auto& [name, poses] : trajectories) paths[name] = trajectory_poses(poses, "trajectories['" + name + "']");
  std::unique_ptr<Simulation> simulation;
  {
    const py::gil_scoped_release free;
    (void)helios::check_without_scene(settings, {}, {}, paths);
    simulation = load(settings, {.seed = seed ? *seed : settings.seed.value_or(0),
                                 .echo_width = echo_width,
                                 .waveforms = waveforms,
                                 .waveform_noise = waveform_noise,
                                 .fixed_incidence = fixed_incidence,
                                 .uncertainty = uncertainty,
                                 .library_physics = library_physics,
                                 .light_paths = light_paths,
                                 .platform_noise = platform_noise,
                                 .leg_noise = leg_noise,
                                 .assets = std::move(assets),
                                 .meshes = std::move(more),
                                 .trajectories = std::move(paths),
                                 .threads = threads});
    if (run > 0) simulation = simulation->repetition(run);
  }
  warn(simulation->warnings());
  return simulation;
}

py::array trajectory_of(const Simulation& simulation, double interval) {
  require_within("Simulation.trajectory interval", interval, 1e-6, 1e9, "s");
  python::Rows<PoseRow> rows;
  const CompiledSurvey& compiled = simulation.compiled();
  for (std::size_t k = 0; k < compiled.legs.size(); ++k) {
    const auto& path = compiled.source.legs()[k].path();
    io::for_each_record(compiled.legs[k].duration, interval, [&](const Tick& tick) {
      const Pose<frame::Body, frame::World> pose = path.at(tick);
      const io::RollPitchYaw angles = io::roll_pitch_yaw(pose.rotation, {});
      const Vec3& p = pose.position;
      rows.push_back({(compiled.legs[k].start + tick).seconds(), p.x, p.y, p.z, angles.roll, angles.pitch, angles.yaw,
                      static_cast<std::int32_t>(compiled.legs[k].number)});
    });
  }
  return rows.take();
}

/// Value, lower and upper limit by the name of a figure.
py::dict dict_of(const EchoErrors& errors) {
  py::dict all;
  for (std::size_t f = 0; f < error_figure_count; ++f)
    all[py::str(std::string(error_figure_names[f]))] =
        py::make_tuple(errors.figures[f].value, errors.figures[f].low, errors.figures[f].high);
  return all;
}

py::dict errors_of(const Simulation& simulation, Whole<"errors clusters"> clusters, Whole<"errors length"> length,
                   Whole<"errors seed"> seed, Whole<"errors threads", unsigned> threads) {
  RunErrors errors;
  python::interruptible([&](const std::stop_token& stop) {
    python::InterruptibleThreads executor(threads, stop);
    errors = simulation.errors({.seed = seed, .clusters = clusters, .length = length, .executor = executor});
  });
  py::dict parts;
  for (const ErrorsByClass& part : errors.parts) {
    py::dict classes;
    for (const auto& [classification, some] : part.classes) classes[py::int_(classification)] = dict_of(some);
    py::dict both;
    both["all"] = dict_of(part.all);
    both["classes"] = classes;
    parts[py::str(part.name)] = both;
  }
  return parts;
}

/// The simulation with settings that reach an accuracy, or come nearest, and what is known of them.
py::tuple chosen(const Simulation& simulation, std::optional<double> range, std::optional<double> position,
                 std::optional<double> intensity, double echoes, Whole<"choose clusters"> clusters,
                 Whole<"choose length"> length, Whole<"choose seed"> seed, Whole<"choose threads", unsigned> threads) {
  const Accuracy accuracy{range.value_or(Accuracy::any), position.value_or(Accuracy::any),
                          intensity.value_or(Accuracy::any), echoes};
  SettingsChoice choice;
  python::interruptible([&](const std::stop_token& stop) {
    python::InterruptibleThreads executor(threads, stop);
    choice = simulation.choose(accuracy, {.seed = seed, .clusters = clusters, .length = length, .executor = executor});
  });
  const auto overrides = helios::ReceiverOverrides::of(choice.values);
  py::dict known;
  known["reached"] = choice.reached;
  known["rings"] = *overrides.rings;
  known["bin_size"] = *overrides.bin_size;
  known["orders"] = *overrides.orders;
  known["paths"] = *overrides.paths;
  known["errors"] = dict_of(choice.errors);
  known["slots"] = choice.slots;
  known["subrays"] = choice.subrays;
  return py::make_tuple(simulation.with_receivers(overrides), known);
}

py::array legs_of(const Simulation& simulation) {
  python::Rows<LegRow> rows;
  for (const CompiledSurvey::Leg& leg : simulation.compiled().legs)
    rows.push_back({static_cast<std::int32_t>(leg.number),
                    leg.active,
                    {},
                    leg.start.seconds(),
                    leg.duration.seconds(),
                    leg.pulse_rate,
                    static_cast<std::int64_t>(leg.first),
                    static_cast<std::int64_t>(leg.end)});
  return rows.take();
}

void bind_documents(py::module_& m) {
  m.def(
      "read_survey",
      [](const std::filesystem::path& path, Paths assets) {
        helios::SurveyDocument document = helios::read_survey(path, {.assets = with_catalogue(std::move(assets))});
        warn(document.warnings);
        return to_python(document.survey);
      },
      "path"_a, "assets"_a = Paths{},
      "Reads the XML document of a survey, with all documents that it refers to, and returns its SurveySettings. "
      "Search folders: `assets`, "
      "the catalogue, then that of the document. Raises FileError with all errors; other defects are warnings.");
  m.def(
      "write_survey",
      [](const std::filesystem::path& path, py::handle survey) { helios::write_survey(path, survey_of(survey)); },
      "path"_a, "survey"_a,
      "Writes SurveySettings as one XML document, which `read_survey` and the survey program read.");
  m.def(
      "xml_text", [](py::handle survey) { return helios::xml_text(survey_of(survey)); }, "survey"_a,
      "Text that `write_survey` writes.");
  m.def(
      "read_assets",
      [](const std::filesystem::path& path, Paths assets) {
        const helios::AssetDocument document = helios::read_assets(path, {.assets = with_catalogue(std::move(assets))});
        warn(document.warnings);
        return to_python(document);
      },
      "path"_a, "assets"_a = Paths{},
      "Reads an XML document of scanners, platforms and scenes: a dict of three lists of settings.");
}

void bind_accuracy(py::class_<Simulation>& simulation) {
  simulation
      .def("errors", &errors_of, py::kw_only(), "clusters"_a = 1024, "length"_a = 4, "seed"_a = 0, "threads"_a = 0,
           "Errors of a run, by a random sample of so many clusters of so many consecutive pulse slots at reference "
           "quality: a dict by cause (sampling, estimator, instrument, together), of dicts `all` and `classes`, of "
           "tuples of value, lower and upper 95 % limit by figure [m, or a share].")
      .def("choose", &chosen, py::kw_only(), "range"_a = py::none(), "position"_a = py::none(),
           "intensity"_a = py::none(), "echoes"_a = 0.01, "clusters"_a = 1024, "length"_a = 4, "seed"_a = 0,
           "threads"_a = 0,
           "The cheapest settings that reach an accuracy, by trial on random samples: the Simulation with them, and a "
           "dict of rings, bin_size [s], orders, paths; reached: False if none are known to, and these come nearest; "
           "errors: their figures as in `errors`, without those of the instrument; slots of the sample, subrays of the "
           "reference. range, position [m], intensity: limits of 95 % of the echoes; echoes: of the shares lost and "
           "invented. Raises SettingError.");
}

void bind_simulation(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(PoseRow, time, x, y, z, roll, pitch, yaw, leg);
  PYBIND11_NUMPY_DTYPE(LegRow, number, active, start, duration, pulse_rate, first, end);
  py::class_<Simulation> simulation(m, "Simulation",
                                    "A survey with its scene loaded and its legs planned, ready to run.");
  simulation
      .def(py::init(&simulation_of), "survey"_a, py::kw_only(), "assets"_a = Paths{}, "meshes"_a = py::none(),
           "trajectories"_a = std::map<std::string, py::object>{}, "seed"_a = py::none(), "echo_width"_a = false,
           "waveforms"_a = false, "waveform_noise"_a = false, "fixed_incidence"_a = false, "library_physics"_a = false,
           "light_paths"_a = false, "uncertainty"_a = false, "platform_noise"_a = true, "leg_noise"_a = true,
           "threads"_a = 0, "repetition"_a = 0,
           "survey: SurveySettings. assets: search folders before the catalogue. meshes: a Mesh, or several, in "
           "addition "
           "to the survey's parts. "
           "trajectories: arrays by the names that legs have as `trajectory.file`, one pose a row: time [s], x, y, z "
           "[m, world], and roll, pitch, yaw [rad; yaw clockwise from north] or a quaternion x, y, z, w from the "
           "axes right, forward, up to the world; without either, the platform heads along its path. Also what "
           "`trajectory` returns. seed: by default the survey's own, or 0. echo_width: fit echo widths. waveforms: "
           "keep the waveforms. waveform_noise: add receiver noise. fixed_incidence: scatter as at normal incidence. "
           "library_physics: physics of the library in place of HELIOS++'s. light_paths: follow light from mirrors, "
           "glass and water. uncertainty: points can have columns of their covariance. platform_noise, leg_noise: "
           "False removes those of the survey. threads: for building the scene; 0: all. repetition: index of the "
           "scene, of a survey with swapped parts. Raises SettingError or FileError.")
      .def(
          "__len__", [](const Simulation& s) { return s.compiled().source.size(); }, "Number of pulse slots.")
      .def("__repr__",
           [](const Simulation& s) {
             return "<Simulation of " + std::to_string(s.compiled().legs.size()) + " legs, " +
                    std::to_string(s.compiled().source.size()) + " pulse slots, " +
                    std::to_string(s.scene().triangles) + " triangles>";
           })
      .def("trajectory", &trajectory_of, "interval"_a,
           "Poses of the platform every `interval` seconds (from 1e-6) of each leg and at its end: a structured array "
           "of time [s], "
           "x, y, z [m, world], roll, pitch, yaw [rad; yaw clockwise from north] and leg.")
      .def_property_readonly(
          "legs", &legs_of,
          "Structured array: number, active, start [s], duration [s], pulse_rate [Hz]; first, end: its slots.")
      .def_property_readonly("repetitions", &Simulation::repetitions, "Number of repetitions, each with its own scene.")
      .def_property_readonly(
          "bounds",
          [](const Simulation& s) -> py::object {
            const Simulation::Scene scene = s.scene();
            if (scene.empty) return py::none();
            return py::make_tuple(py::make_tuple(scene.min.x, scene.min.y, scene.min.z),
                                  py::make_tuple(scene.max.x, scene.max.y, scene.max.z));
          },
          "Two corners of the scene's bounding box [m, world]; None for an empty scene.")
      .def_property_readonly(
          "triangles", [](const Simulation& s) { return s.scene().triangles; }, "Number of triangles in the scene.")
      .def_property_readonly(
          "memory", [](const Simulation& s) { return s.scene().memory; }, "Memory of the scene [byte].");
  bind_run_to_files(simulation);
  bind_accuracy(simulation);
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.attr("__version__") = PULSECAST_VERSION;
  python::bind_common(m);
  bind_settings(m);
  bind_documents(m);
  bind_planning(m);
  bind_scene(m);
  bind_simulation(m);
  bind_write(m);
}
