// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include <pulsecast/helios/detail/mesh_parts.hpp>
#include <pulsecast/io/detail/trajectory/attitude.hpp>
#include <pulsecast/material/water_types.hpp>
#include <pulsecast/platform/waypoints.hpp>
#include <pulsecast/python/ray_queries.hpp>
#include <pulsecast/scene/scene.hpp>

#include "outputs.hpp"
#include "settings.hpp"

namespace py = pybind11;
using namespace pulsecast;
using namespace py::literals;
using helios::Simulation;
using python::NumberArray;
using Picture = py::array_t<std::uint8_t, py::array::c_style>;

namespace {

// --------------------------------------------------------------------------------------------------------- numbers

/// Numbers of an array or sequence. @throws TypeError for others
NumberArray numbers_of(const py::object& given, const std::string& name) {
  const auto numbers = NumberArray::ensure(given);
  if (numbers) return numbers;
  PyErr_Clear();
  throw py::type_error(name + ": expected numbers, not " + std::string(py::repr(given)));
}

/// Refuses all but one number, or `count` in a row. @throws SettingError
void require_one_or(const py::array& numbers, py::ssize_t count, const std::string& name, const std::string& of) {
  if (numbers.ndim() == 0 || (numbers.ndim() == 1 && numbers.shape(0) == count)) return;
  throw SettingError(name + " (number)", static_cast<double>(numbers.size()), "",
                     "1, or one a " + of + ", " + std::to_string(count));
}

/// Number i of one for all, or of one for each.
template <class Number>
Number number_at(const py::array_t<Number, py::array::c_style | py::array::forcecast>& numbers, std::size_t i) {
  return numbers.data()[numbers.size() == 1 ? 0 : i];
}

/// Columns of a structured array, or the array itself.
NumberArray pose_columns(const py::object& given, const std::string& name) {
  if (!py::hasattr(given, "dtype") || given.attr("dtype").attr("names").is_none()) return numbers_of(given, name);
  py::list columns;
  for (const char* const column : {"time", "x", "y", "z", "roll", "pitch", "yaw"}) columns.append(given[column]);
  return numbers_of(py::module_::import("numpy").attr("column_stack")(columns), name);
}

/// Warns of roll, pitch and yaw in degrees: from 0, or from one pose to the next, they turn by more than a turn; those
/// of a platform tilt beyond the vertical.
void ask_for_degrees(const NumberArray& rows, bool platform, const std::string& name) {
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    for (py::ssize_t k = 4; k < 7; ++k) {
      const double angle = rows.at(i, k), before = i > 0 ? rows.at(i - 1, k) : 0;
      const bool tilts = platform && ((k == 4 && std::fabs(angle) > max_angle) ||
                                      (k == 5 && std::fabs(std::remainder(angle, 2 * pi)) > pi / 2 + 1e-6));
      if (!tilts && !(std::fabs(angle - before) > max_angle)) continue;
      return warn({name + ": " + std::array{"roll", "pitch", "yaw"}[static_cast<std::size_t>(k - 4)] + " of row " +
                   std::to_string(i) + " is " + text::to_text(angle) + " rad: given in degrees, not radians?"});
    }
}

/// Poses of rows of 4, 7 or 8 numbers, as `trajectory_poses`; those of 4 are not turned.
std::vector<TimedPose> timed_poses_of(const NumberArray& rows, const std::string& name, bool platform) {
  const py::ssize_t columns = rows.ndim() == 2 ? rows.shape(1) : 0;
  if (columns != 4 && columns != 7 && columns != 8)
    throw SettingError(name + " (columns)", static_cast<double>(columns), "",
                       "4, 7 or 8: time, x, y, z, and roll, pitch, yaw or a quaternion x, y, z, w");
  if (columns == 7) ask_for_degrees(rows, platform, name);
  std::vector<TimedPose> poses;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const double* const row = rows.data(i);
    TimedPose& pose = poses.emplace_back(TimedPose{row[0], {row[1], row[2], row[3]}});
    if (columns == 7) pose.rotation = io::rotation_of({row[4], row[5], row[6]}, io::heading_pitch_roll);
    if (columns == 8) pose.rotation = Rotation(row[7], row[4], row[5], row[6]);
  }
  return poses;
}

// ---------------------------------------------------------------------------------------------------------- meshes

void require_rows_of_three(const py::array& array, const std::string& field) {
  if (array.ndim() != 2)
    throw SettingError(field + " (dimensions)", static_cast<double>(array.ndim()), "", "2: shape (n, 3)");
  if (array.shape(1) != 3)
    throw SettingError(field + " (columns)", static_cast<double>(array.shape(1)), "", "3: shape (n, 3)");
}

MeshData mesh_data_of(const NumberArray& vertices, const py::object& triangles_given) {
  const auto numbers = py::array::ensure(triangles_given);
  if (!numbers)
    throw py::type_error("Mesh triangles: expected an array, not " + std::string(py::repr(triangles_given)));
  require_rows_of_three(vertices, "Mesh::vertices");
  require_rows_of_three(numbers, "Mesh::triangles");
  if (const char kind = numbers.dtype().kind(); kind != 'i' && kind != 'u')  // else 1.7 would become 1
    throw py::type_error("Mesh triangles: expected whole numbers, not " + std::string(py::str(numbers.dtype())));
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> triangles(numbers);
  MeshData data;
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i)
    data.vertices.push_back({vertices.at(i, 0), vertices.at(i, 1), vertices.at(i, 2)});
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i) {
    std::array<std::uint32_t, 3>& corners = data.triangles.emplace_back();
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t corner = triangles.at(i, k);
      if (corner < 0 || corner >= vertices.shape(0))
        throw SettingError("Mesh::triangles", static_cast<double>(corner), "",
                           "the number of a vertex; see triangle " + std::to_string(i));
      corners[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(corner);
    }
  }
  return data;
}

void set_texture(const NumberArray& texture, MeshData& data) {
  if (texture.ndim() != 3 || texture.shape(1) != 3 || texture.shape(2) != 2)
    throw SettingError("Mesh::texture (dimensions)", static_cast<double>(texture.ndim()), "", "3: shape (m, 3, 2)");
  for (py::ssize_t i = 0; i < texture.shape(0); ++i) {
    std::array<Vec2, 3>& corners = data.texture.emplace_back();
    for (py::ssize_t k = 0; k < 3; ++k)
      corners[static_cast<std::size_t>(k)] = {texture.at(i, k, 0), texture.at(i, k, 1)};
  }
}

/// Picture of an array of shape (rows, columns) or (rows, columns, channels), from the top.
std::shared_ptr<const Image> picture_of(const Picture& array) {
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

/// Materials by reflectance and class: one for all triangles, or one for each pair that triangles have.
void set_materials(const py::object& reflectance_given, const py::object& class_given, Simulation::Mesh& mesh) {
  const std::size_t count = mesh.data.triangles.size();
  const NumberArray reflectance = numbers_of(reflectance_given, "Mesh reflectance");
  const auto classes = python::detail::whole_numbers(class_given, "Mesh classification");
  require_one_or(reflectance, static_cast<py::ssize_t>(count), "Mesh::reflectance", "triangle");
  require_one_or(classes, static_cast<py::ssize_t>(count), "Mesh::classification", "triangle");
  const bool by_triangle = reflectance.ndim() + classes.ndim() > 0;
  std::map<std::pair<double, std::int64_t>, std::uint32_t> known;
  for (std::size_t i = 0; i < (by_triangle ? count : 1); ++i) {
    const std::pair pair(number_at(reflectance, i), number_at(classes, i));
    require_within("Mesh::reflectance", pair.first, 0, 1, "");
    require_within("Mesh::classification", static_cast<double>(pair.second), 0, 65535, "");
    const auto [at, is_new] = known.try_emplace(pair, static_cast<std::uint32_t>(mesh.materials.size()));
    if (by_triangle) mesh.data.materials.push_back(at->second);
    if (!is_new) continue;
    Material& material = mesh.materials.emplace_back(mesh.material);
    material.reflectance = pair.first;
    material.classification = static_cast<std::uint16_t>(pair.second);
    material.validate();
  }
}

/// Holes where the opacity of the picture, its last channel, is below `cutoff`.
void set_holes(double cutoff, Simulation::Mesh& mesh) {
  const Image* const picture = mesh.material.picture.get();
  if (picture == nullptr || !picture->has_opacity())
    throw SettingError("Mesh::picture (channels)", picture == nullptr ? 0 : picture->channels, "",
                       "2 or 4, the last one opacity, with a cutoff");
  mesh.data.masks.assign(mesh.materials.size(), Mask::of(*picture, picture->channels - 1, cutoff));
}

/// Placements of positions, shape (n, 3), or of matrices, shape (n, 4, 4).
std::vector<Placement> placements_of(const NumberArray& array) {
  const bool turned = array.ndim() == 3 && array.shape(1) == 4 && array.shape(2) == 4;
  if (!turned && (array.ndim() != 2 || array.shape(1) != 3))
    throw SettingError("Mesh::placements (dimensions)", static_cast<double>(array.ndim()), "",
                       "shape (n, 3): positions; or (n, 4, 4): matrices");
  if (array.shape(0) == 0) throw SettingError("Mesh::placements (number)", 0, "", "at least 1");
  std::vector<Placement> placements;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* const m = array.data(i);  // row by row
    if (!turned) {
      placements.push_back({.translation = {m[0], m[1], m[2]}});
      continue;
    }
    Matrix3 axes(0);  // its columns are those of the mesh
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) axes[column][row] = m[4 * row + column];
    const double volume = dot(cross(axes[0], axes[1]), axes[2]), scale = std::cbrt(volume);
    double error = std::fabs(m[12]) + std::fabs(m[13]) + std::fabs(m[14]) + std::fabs(m[15] - 1);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) error += std::fabs(dot(axes[a], axes[b]) / (scale * scale) - (a == b ? 1 : 0));
    if (!(scale > 0 && error <= 1e-5))
      throw SettingError("Mesh::placements: placement " + std::to_string(i) + " (error)", error, "",
                         "a rotation, one scale for all axes and a translation");
    placements.push_back({unit(rotation_of((1 / scale) * axes)), scale, {m[3], m[7], m[11]}});
  }
  for (const Placement& placement : placements) placement.validate();
  return placements;
}

void set_objects(const py::object& given, Simulation::Mesh& mesh) {
  const auto objects = python::detail::whole_numbers(given, "Mesh object");
  require_one_or(objects, static_cast<py::ssize_t>(std::max<std::size_t>(1, mesh.placements.size())), "Mesh::object",
                 "placement");
  for (py::ssize_t i = 0; i < objects.size(); ++i) {
    require_within("Mesh::object", static_cast<double>(objects.data()[i]), 0, std::numeric_limits<ObjectId>::max(), "");
    mesh.objects.push_back(static_cast<ObjectId>(objects.data()[i]));
  }
  if (objects.ndim() == 0) mesh.object = std::exchange(mesh.objects, {}).front();
}

Simulation::Mesh mesh_of(const py::object& vertices, const py::object& triangles, const py::object& object,
                         const py::object& reflectance, const py::object& classification, bool ground,
                         const std::optional<NumberArray>& texture, const std::optional<SmoothInterface>& smooth,
                         const std::optional<std::array<double, 3>>& colour, const std::optional<Picture>& picture,
                         const std::optional<std::map<std::string, double>>& attributes_given, const py::object& law,
                         std::optional<double> cutoff, const std::optional<NumberArray>& placements,
                         const py::object& motion) {
  Simulation::Mesh mesh{.data = mesh_data_of(numbers_of(vertices, "Mesh vertices"), triangles),
                        .material = {.ground = ground}};
  if (texture) set_texture(*texture, mesh.data);
  if (smooth) mesh.material.smooth = *smooth;
  if (!law.is_none()) mesh.material.law = law_of(law);
  if (colour) mesh.material.colour = {(*colour)[0], (*colour)[1], (*colour)[2]};
  if (picture) mesh.material.picture = picture_of(*picture);
  set_materials(reflectance, classification, mesh);
  if (cutoff) set_holes(*cutoff, mesh);
  if (placements) mesh.placements = placements_of(*placements);
  set_objects(object, mesh);
  std::vector<Attribute> all;
  for (const auto& [name, value] : attributes_given.value_or(std::map<std::string, double>()))
    all.push_back({name, value});
  if (!all.empty()) mesh.attributes = attributes(std::move(all));
  if (!motion.is_none())
    mesh.motion =
        std::make_shared<const PartMotion>(timed_poses_of(pose_columns(motion, "Mesh::motion"), "Mesh::motion", false));
  mesh.data.validate();
  return mesh;
}

// ----------------------------------------------------------------------------------------------------- ray queries

/// Scene of meshes by themselves, for ray queries.
using RaycastingScene = Scene<MaskedMesh<>>;

std::vector<RaycastingScene::Part> parts_of(const std::vector<Simulation::Mesh>& meshes, unsigned threads) {
  std::vector<RaycastingScene::Part> all;
  for (const Simulation::Mesh& mesh : meshes)
    for (auto& part : helios::parts_of<RaycastingScene::Part>(mesh, threads)) all.push_back(std::move(part));
  return all;
}

std::unique_ptr<RaycastingScene> raycasting_scene_of(const py::object& given,
                                                     python::Whole<"RaycastingScene threads", unsigned> threads) {
  const std::vector<Simulation::Mesh> meshes = meshes_of(given);
  const py::gil_scoped_release free;
  return std::make_unique<RaycastingScene>(parts_of(meshes, threads));
}

std::unique_ptr<RaycastingScene> with_meshes(const RaycastingScene& scene, const py::object& given,
                                             python::Whole<"with_meshes threads", unsigned> threads) {
  const std::vector<Simulation::Mesh> meshes = meshes_of(given);
  const py::gil_scoped_release free;
  return std::make_unique<RaycastingScene>(scene.with_parts(parts_of(meshes, threads), threads.value));
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
      .def_readonly("index", &Medium::index, "Refractive index.")
      .def_readonly("group_index", &Medium::group_index, "Vacuum speed of light by that of a pulse; 0: the index.")
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
          "colour"_a = py::none(), "picture"_a = py::none(), "attributes"_a = py::none(), "law"_a = py::none(),
          "cutoff"_a = py::none(), "placements"_a = py::none(), "motion"_a = py::none(),
          "vertices: shape (n, 3) [m, world; with placements, in their frame]; triangles: shape (m, 3), vertex indices "
          "from 0; object: object id of its points, from which those of placements count on, or one a placement; "
          "reflectance: in [0, 1], and classification: ASPRS class, each one for all or one a triangle; ground: True "
          "if "
          "it may carry platforms; texture: shape (m, 3, 2), texture coordinates of the corners, which ray queries "
          "interpolate; smooth: SmoothInterface with specular light, in a simulation with light_paths; colour: red, "
          "green and blue of its points, in [0, 1]; picture: array of uint8, shape (rows, columns) or (rows, columns, "
          "channels), from the top, by which texture coordinates multiply the colour; attributes: named numbers of its "
          "points, as in {'age': 80}; law of the scattered light: Lambert(), the default, DirectionIndependent(), "
          "Phong(), NormalizedPhong(), Microfacet() or Tabulated(); cutoff: opacity, in [0, 1], below which a pixel of "
          "the picture is a hole, by its last channel of 2 or 4; placements: shape (n, 3), positions, or (n, 4, 4), "
          "matrices of a rotation, a scale for all axes and a translation: as many parts, which share the triangles; "
          "motion: poses on top of the placement, rows of time since the start [s], x, y, z [m] and nothing, or roll, "
          "pitch, yaw [rad], or a quaternion x, y, z, w: rotation about the origin of the world, then a shift; linear "
          "between, at rest before and after. Raises SettingError.")
      .def_property_readonly(
          "size", [](const Simulation::Mesh& mesh) { return mesh.data.triangles.size(); },
          "Number of triangles, of one placement.")
      .def("__repr__", [](const Simulation::Mesh& mesh) {
        const std::size_t placements = mesh.placements.size();
        return "<Mesh of " + std::to_string(mesh.data.triangles.size()) + " triangles, object " +
               std::to_string(mesh.objects.empty() ? mesh.object : mesh.objects.front()) +
               (placements > 0 ? ", " + std::to_string(placements) + " placements>" : ">");
      });
}

void bind_raycasting_scene(py::module_& m) {
  py::class_<RaycastingScene> scene(
      m, "RaycastingScene",
      "Meshes to be asked by rays, without a survey. Part i is mesh i, if each has one placement.");
  scene
      .def(py::init(&raycasting_scene_of), "meshes"_a, py::kw_only(), "threads"_a = 0,
           "meshes: a Mesh, or several. threads: for building the index; 0: all. Raises SettingError.")
      .def("with_meshes", &with_meshes, "meshes"_a, py::kw_only(), "threads"_a = 0,
           "RaycastingScene with more meshes after those of this one, whose memory it shares.")
      .def_property_readonly(
          "memory", [](const RaycastingScene& s) { return s.memory(); }, "Memory of the scene [byte].")
      .def("__repr__", [](const RaycastingScene& s) {
        return "<RaycastingScene of " + std::to_string(s.parts().size()) + " meshes>";
      });
  python::bind_ray_queries(scene);
}

}  // namespace

std::vector<Simulation::Mesh> meshes_of(const py::object& given) {
  std::vector<Simulation::Mesh> meshes;
  const auto add = [&](py::handle one) {
    if (!py::isinstance<Simulation::Mesh>(one))
      throw py::type_error("meshes: expected a Mesh or several, not " + std::string(py::repr(one)) +
                           "; files are parts of the survey's scene");
    meshes.push_back(one.cast<const Simulation::Mesh&>());
  };
  if (given.is_none()) return meshes;
  if (py::isinstance<py::iterable>(given) && !py::isinstance<py::str>(given))
    for (const py::handle one : py::iter(given)) add(one);
  else
    add(given);
  return meshes;
}

std::vector<TimedPose> trajectory_poses(const py::object& array, const std::string& name) {
  const NumberArray rows = pose_columns(array, name);
  std::vector<TimedPose> poses = timed_poses_of(rows, name, true);
  return rows.shape(1) == 4 ? with_headings(std::move(poses)) : poses;
}

void bind_scene(py::module_& m) {
  bind_light(m);  // before meshes, which use its types
  bind_mesh(m);
  bind_raycasting_scene(m);
}
