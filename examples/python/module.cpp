// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The Python module `pulsecast`: surveys of documents, run as the survey program runs them. For user-defined pipelines
// there is `bind_survey`; see `own_scanner.cpp`.

#include <algorithm>
#include <array>
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
#include <pulsecast/io/detail/trajectory/attitude.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/material/water_types.hpp>
#include <pulsecast/python/bind.hpp>
#include <pulsecast/python/ray_queries.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/version.hpp>

#include "../pulsecast/loading.hpp"
#include "outputs.hpp"
#include "settings.hpp"

namespace py = pybind11;
using namespace pulsecast;
using namespace py::literals;
using helios::CompiledSurvey;
using helios::Simulation;
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

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& text : warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

/// Appearance of a mesh, and labels of its points.
struct MeshLooks {
  std::optional<std::array<double, 3>> colour{};
  std::optional<py::array_t<std::uint8_t, py::array::c_style>> picture{};
  std::optional<std::map<std::string, double>> attributes{};
};

/// Picture of an array of shape (rows, columns) or (rows, columns, channels), from the top.
std::shared_ptr<const Image> picture_of(const py::array_t<std::uint8_t, py::array::c_style>& array) {
  if (array.ndim() != 2 && array.ndim() != 3)
    throw SettingError("Mesh::picture (dimensions)", static_cast<double>(array.ndim()), "",
                       "2 or 3: shape (rows, columns, channels)");
  const auto size = [](py::ssize_t count) {
    return static_cast<std::uint32_t>(std::min<py::ssize_t>(count, 1'000'000));
  };
  const std::vector<std::uint8_t> samples(array.data(), array.data() + array.size());
  auto picture = std::make_shared<const Image>(
      Image{size(array.shape(1)), size(array.shape(0)), array.ndim() == 2 ? 1 : size(array.shape(2)), samples});
  picture->validate();
  return picture;
}

void set_looks(const MeshLooks& looks, Simulation::Mesh& mesh) {
  if (looks.colour) mesh.material.colour = {(*looks.colour)[0], (*looks.colour)[1], (*looks.colour)[2]};
  if (looks.picture) mesh.material.picture = picture_of(*looks.picture);
  std::vector<Attribute> all;
  for (const auto& [name, value] : looks.attributes.value_or(std::map<std::string, double>()))
    all.push_back({name, value});
  if (!all.empty()) mesh.attributes = attributes(std::move(all));
}

/// Triangles of arrays, with one material.
Simulation::Mesh mesh_of(const py::array_t<double, py::array::c_style | py::array::forcecast>& vertices,
                         const py::object& triangles_given, python::Whole<"Mesh::object", ObjectId> object,
                         double reflectance, python::Whole<"Mesh::classification", std::uint16_t> classification,
                         bool ground, const std::optional<python::NumberArray>& texture,
                         const std::optional<SmoothInterface>& smooth,
                         const std::optional<std::array<double, 3>>& colour,
                         std::optional<py::array_t<std::uint8_t, py::array::c_style>> picture,
                         std::optional<std::map<std::string, double>> attributes) {
  const auto require_rows_of_three = [](const py::array& array, const std::string& field) {
    if (array.ndim() != 2)
      throw SettingError(field + " (dimensions)", static_cast<double>(array.ndim()), "", "2: shape (n, 3)");
    if (array.shape(1) != 3)
      throw SettingError(field + " (columns)", static_cast<double>(array.shape(1)), "", "3: shape (n, 3)");
  };
  const auto numbers = py::array::ensure(triangles_given);
  if (!numbers)
    throw py::type_error("Mesh triangles: expected an array, not " + std::string(py::repr(triangles_given)));
  require_rows_of_three(vertices, "Mesh::vertices");
  require_rows_of_three(numbers, "Mesh::triangles");
  if (const char kind = numbers.dtype().kind(); kind != 'i' && kind != 'u')  // else 1.7 would become 1
    throw py::type_error("Mesh triangles: expected whole numbers, not " + std::string(py::str(numbers.dtype())));
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> triangles(numbers);
  Simulation::Mesh mesh{.material = {.reflectance = reflectance, .classification = classification, .ground = ground},
                        .object = object};
  if (smooth) mesh.material.smooth = *smooth;
  set_looks({colour, std::move(picture), std::move(attributes)}, mesh);
  mesh.material.validate();
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i)
    mesh.data.vertices.push_back({vertices.at(i, 0), vertices.at(i, 1), vertices.at(i, 2)});
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    std::array<std::uint32_t, 3>& corners = mesh.data.triangles.emplace_back();
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t corner = triangles.at(i, k);
      if (corner < 0 || corner >= vertices.shape(0))
        throw SettingError("Mesh::triangles", static_cast<double>(corner), "",
                           "the number of a vertex; see triangle " + std::to_string(i));
      corners[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(corner);
    }
  }
  if (texture) {
    if (texture->ndim() != 3 || texture->shape(1) != 3 || texture->shape(2) != 2)
      throw SettingError("Mesh::texture (dimensions)", static_cast<double>(texture->ndim()), "", "3: shape (m, 3, 2)");
    for (py::ssize_t i = 0; i < texture->shape(0); ++i) {
      std::array<Vec2, 3>& corners = mesh.data.texture.emplace_back();
      for (py::ssize_t k = 0; k < 3; ++k)
        corners[static_cast<std::size_t>(k)] = {texture->at(i, k, 0), texture->at(i, k, 1)};
    }
  }
  mesh.data.validate();
  return mesh;
}

/// Scene of meshes by themselves, for ray queries.
using RaycastingScene = Scene<TriangleMesh<>>;

std::vector<RaycastingScene::Part> parts_of(const std::vector<Simulation::Mesh>& meshes, unsigned threads) {
  std::vector<RaycastingScene::Part> parts;
  for (const Simulation::Mesh& mesh : meshes)
    parts.push_back({.geometry = std::make_shared<const TriangleMesh<>>(mesh.data, threads),
                     .materials = material_table({mesh.material}),
                     .object = mesh.object,
                     .attributes = mesh.attributes});
  return parts;
}

std::unique_ptr<RaycastingScene> raycasting_scene_of(const std::vector<Simulation::Mesh>& meshes, unsigned threads) {
  const py::gil_scoped_release free;
  return std::make_unique<RaycastingScene>(parts_of(meshes, threads));
}

std::unique_ptr<RaycastingScene> with_meshes(const RaycastingScene& scene, const std::vector<Simulation::Mesh>& meshes,
                                             unsigned threads) {
  const py::gil_scoped_release free;
  return std::make_unique<RaycastingScene>(scene.with_parts(parts_of(meshes, threads), threads));
}

std::unique_ptr<Simulation> simulation_of(py::handle survey, Paths assets, std::vector<Simulation::Mesh> meshes,
                                          std::optional<std::uint64_t> seed, bool echo_width, bool waveforms,
                                          bool waveform_noise, bool fixed_incidence, bool library_physics,
                                          bool light_paths, bool uncertainty, bool platform_noise, bool leg_noise,
                                          unsigned threads, int run) {
  const helios::SurveySettings settings = survey_of(survey);
  require_within("Simulation repetition", run, 0, std::numeric_limits<int>::max(), "");
  for (std::filesystem::path& folder : py::module_::import("pulsecast").attr("asset_folders")().cast<Paths>())
    assets.push_back(std::move(folder));
  std::unique_ptr<Simulation> simulation;
  {
    const py::gil_scoped_release free;
    (void)helios::check_without_scene(settings);
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
                                 .meshes = std::move(meshes),
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

py::dict errors_of(const Simulation& simulation, std::size_t clusters, PulseIndex length, std::uint64_t seed,
                   unsigned threads) {
  const RunErrors errors = [&] {
    const py::gil_scoped_release release;
    return simulation.errors({.seed = seed, .clusters = clusters, .length = length, .threads = threads});
  }();
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
                 std::optional<double> intensity, double echoes, std::size_t clusters, PulseIndex length,
                 std::uint64_t seed, unsigned threads) {
  const Accuracy accuracy{range.value_or(Accuracy::any), position.value_or(Accuracy::any),
                          intensity.value_or(Accuracy::any), echoes};
  const SettingsChoice choice = [&] {
    const py::gil_scoped_release release;
    return simulation.choose(accuracy, {.seed = seed, .clusters = clusters, .length = length, .threads = threads});
  }();
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
      [](const std::filesystem::path& path, const Paths& assets) {
        helios::SurveyDocument document = helios::read_survey(path, {.assets = assets});
        warn(document.warnings);
        return to_python(document.survey);
      },
      "path"_a, "assets"_a = Paths{},
      "Reads the XML document of a survey, with all documents that it refers to, and returns its SurveySettings. "
      "Search folders: `assets`, "
      "then that of the document. Raises FileError with all errors; other defects are warnings.");
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
      [](const std::filesystem::path& path, const Paths& assets) {
        const helios::AssetDocument document = helios::read_assets(path, {.assets = assets});
        warn(document.warnings);
        return to_python(document);
      },
      "path"_a, "assets"_a = Paths{},
      "Reads an XML document of scanners, platforms and scenes: a dict of three lists of settings.");
}

void bind_light(py::module_& m) {
  py::class_<Medium>(m, "Medium", "Medium that light passes, at its wavelength.")
      .def(py::init([](double index, double group_index, double absorption, double scattering, double backscatter) {
             const Medium medium{index, group_index, absorption, scattering, backscatter};
             medium.validate();
             return medium;
           }),
           "index"_a = 1.0, "group_index"_a = 0.0, "absorption"_a = 0.0, "scattering"_a = 0.0, "backscatter"_a = 0.0,
           "index: refractive index, from 1 to 4; group_index: vacuum speed of light by that of a pulse, 0 for the "
           "index; absorption, "
           "scattering: coefficients [1/m]; backscatter: at most scattering [1/(m sr)]. Raises SettingError.")
      .def_readonly("index", &Medium::index)
      .def_readonly("group_index", &Medium::group_index)
      .def_readonly("absorption", &Medium::absorption, "[1/m]")
      .def_readonly("scattering", &Medium::scattering, "[1/m]")
      .def_readonly("backscatter", &Medium::backscatter, "[1/(m sr)]")
      .def_static(
          "of_water",
          [](const std::string& type, double wavelength) {
            const auto known = jerlov_type(type);
            if (!known)
              throw py::value_error("Medium.of_water: '" + type +
                                    "' is no type of water: expected I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C");
            return water(*known, wavelength);
          },
          "type"_a, "wavelength"_a,
          "Water of a type by Jerlov, from I, the clearest ocean, to III, and from 1C to 9C, coasts, for a laser's "
          "wavelength [m]. Raises "
          "ValueError and SettingError.");
  py::class_<SmoothInterface>(m, "SmoothInterface", "Surface that reflects or transmits light specularly.")
      .def_static("mirror", &SmoothInterface::mirror, "reflectance"_a = 0.95,
                  "Mirror that reflects a share of the light.")
      .def_static("pane", &SmoothInterface::pane, "thickness"_a = 4e-3, "Pane of clear glass [m].")
      .def_static("glass", &SmoothInterface::glass, "Face of a body of clear glass, drawn as a closed shape.")
      .def_static("water", &SmoothInterface::water, "inside"_a = Medium{.index = 1.33}, "Surface of water.");
}

void bind_mesh(py::module_& m) {
  py::class_<Simulation::Mesh>(m, "Mesh", "Triangles in the scene, in addition to the survey's own parts.")
      .def(
          py::init(&mesh_of), "vertices"_a, "triangles"_a, "object"_a = 0, "reflectance"_a = 0.5,
          "classification"_a = 0, "ground"_a = false, "texture"_a = py::none(), "smooth"_a = py::none(),
          "colour"_a = py::none(), "picture"_a = py::none(), "attributes"_a = py::none(),
          "vertices: shape (n, 3) [m, world]; triangles: shape (m, 3), vertex indices from 0; object: object id of its "
          "points; reflectance: Lambertian, in [0, 1]; classification: ASPRS class; ground: True if it may carry "
          "platforms; "
          "texture: shape (m, 3, 2), texture coordinates of the corners, which ray queries interpolate; "
          "smooth: SmoothInterface with specular light, in a simulation with light_paths; colour: red, green and blue "
          "of its points, in "
          "[0, 1]; picture: array of uint8, shape (rows, columns) or (rows, columns, channels), from the top, by which "
          "texture coordinates "
          "multiply the colour; attributes: named numbers of its points, as in {'age': 80}.")
      .def_property_readonly(
          "size", [](const Simulation::Mesh& mesh) { return mesh.data.triangles.size(); }, "Number of triangles.")
      .def("__repr__", [](const Simulation::Mesh& mesh) {
        return "<Mesh of " + std::to_string(mesh.data.triangles.size()) + " triangles, object " +
               std::to_string(mesh.object) + '>';
      });
}

void bind_raycasting_scene(py::module_& m) {
  py::class_<RaycastingScene> scene(m, "RaycastingScene",
                                    "Meshes to be asked by rays, without a survey. Part i is mesh i.");
  scene
      .def(py::init(&raycasting_scene_of), "meshes"_a, py::kw_only(), "threads"_a = 0,
           "meshes: list of Mesh. threads: for building the index; 0: all. Raises SettingError.")
      .def("with_meshes", &with_meshes, "meshes"_a, py::kw_only(), "threads"_a = 0,
           "RaycastingScene with more meshes after those of this one, whose memory it shares.")
      .def_property_readonly(
          "memory", [](const RaycastingScene& s) { return s.memory(); }, "Memory of the scene [byte].")
      .def("__repr__", [](const RaycastingScene& s) {
        return "<RaycastingScene of " + std::to_string(s.parts().size()) + " meshes>";
      });
  python::bind_ray_queries(scene);
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
      .def(py::init(&simulation_of), "survey"_a, py::kw_only(), "assets"_a = Paths{},
           "meshes"_a = std::vector<Simulation::Mesh>{}, "seed"_a = py::none(), "echo_width"_a = false,
           "waveforms"_a = false, "waveform_noise"_a = false, "fixed_incidence"_a = false, "library_physics"_a = false,
           "light_paths"_a = false, "uncertainty"_a = false, "platform_noise"_a = true, "leg_noise"_a = true,
           "threads"_a = 0, "repetition"_a = 0,
           "survey: SurveySettings. assets: search folders. meshes: triangles in addition to the survey's parts. seed: "
           "by default the "
           "survey's own, or 0. echo_width: fit echo widths. waveforms: keep the waveforms. waveform_noise: add "
           "receiver noise. "
           "fixed_incidence: scatter as at normal incidence. library_physics: physics of the library in place of "
           "HELIOS++'s. "
           "light_paths: follow light from mirrors, glass and water. "
           "uncertainty: points can have columns of their covariance. "
           "platform_noise, leg_noise: False removes those of the survey. threads: for "
           "building the scene; 0: all. repetition: index of the scene, of a survey with swapped parts. Raises "
           "SettingError or FileError.")
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
  bind_light(m);  // before meshes, which use its types
  bind_mesh(m);
  bind_raycasting_scene(m);
  bind_simulation(m);
  bind_write(m);
}
