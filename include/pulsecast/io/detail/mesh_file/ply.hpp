// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_PLY_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_PLY_HPP

#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/io/detail/obj/polygon.hpp>
#include <pulsecast/io/detail/ply/file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Mesh of a PLY file, of polygons, also concave ones, and strips, with coordinates of double precision.
class PlyMesh {
 public:
  PlyMesh(const std::filesystem::path& path, const MeshFileSettings& settings)
      : file_(InputFile(path, "a mesh file")), takes_texture_(settings.texture || !settings.materials.empty()) {
    file_.keep_rules(ply_mesh_rules, scene_.warnings);
    RawMaterial& material = scene_.materials.emplace_back(RawMaterial{.name = "DefaultMaterial"});
    for (const std::string& remark : file_.remarks()) {
      std::string_view rest = remark;
      if (!text::is_same_word(text::take_word(rest), "TextureFile")) continue;
      if (std::exchange(material.colour.name, rest).empty()) continue;
      (void)keep_rule(ply_mesh_rules, path, "header line", "comment texturefile 2", scene_.warnings);
      material.colour.name.clear();
      break;
    }
    takes_texture_ = takes_texture_ || !material.colour.name.empty();
  }

  [[nodiscard]] RawScene read() {
    const auto warn = [&](const auto&... oddity) { scene_.warnings.push_back(warning(file_.path(), 0, oddity...)); };
    std::uint64_t faces = 0;
    while (file_.next_element()) {
      const std::string& name = file_.element().name;
      if (name == "vertex") take_vertices();
      if (name == "face") take_faces();
      if (name == "tristrips") take_strips();
      if (name == "face" || name == "tristrips") faces += file_.element().count;
    }
    if (faces == 0)
      fail(file_.path(), "has no faces: expected a mesh; xyzloader (read_point_cloud) reads the points of a cloud");
    if (farthest_ * 0x1p-24 > 1e-3)  // of 24 bits. Source: IEEE 754-2019, binary32
      warn("has coordinates up to ", std::llround(farthest_),
           " of single precision: expected properties of the type double so far from the origin");
    if (crossings_ > 0) warn(crossings_, " polygons cross themselves, and become fans about their first corners");
    if (left_out_ > 0) warn("points and lines are left out: ", left_out_, " in all");
    scene_.meshes.push_back(
        {.precise = std::move(vertices_), .triangles = std::move(triangles_), .texture = std::move(texture_)});
    scene_.nodes.push_back({.meshes = {0}});
    return std::move(scene_);
  }

 private:
  void take_vertices() {
    const PlyElement& e = file_.element();
    const std::optional<std::size_t> x = e.find("x"), y = e.find("y"), z = e.find("z"), u = e.find("u"),
                                     v = e.find("v");
    if (!x || !y || !z || e.count > 0xFFFFFFFF)
      fail(file_.path(), "has ", e.count, " vertices: expected fewer than 2^32, with properties x, y and z");
    const bool is_single = !file_.is_text() && e.properties[*x].type == NumberType::float32;
    vertices_.reserve(e.count);
    while (file_.next()) {
      vertices_.emplace_back(file_.number(*x), file_.number(*y), file_.number(*z));
      if (is_single) farthest_ = std::max(farthest_, max_norm(vertices_.back()));
      if (u && v && takes_texture_) add_texture(file_.number(*u), file_.number(*v));
    }
  }

  void add_texture(double u, double v) { texture_.push_back({static_cast<float>(u), static_cast<float>(v), 0}); }

  [[nodiscard]] std::size_t list_of_vertices() const {
    if (const auto found = file_.element().find("vertex_indices", true)) return *found;
    fail(file_.path(), "has no list vertex_indices of the element ", file_.element().name, ": expected one");
  }

  [[nodiscard]] std::uint32_t vertex(double number) const {
    if (!(number >= 0 && number < static_cast<double>(vertices_.size()) && number == std::floor(number)))
      file_.fail_here("has the vertex ", number, ", expected less than the number of vertices, ", vertices_.size());
    return static_cast<std::uint32_t>(number);
  }

  void take_faces() {
    const std::size_t indices = list_of_vertices();
    const std::size_t texture = file_.element().find("texcoord", true).value_or(indices);
    const bool unfolds = takes_texture_ && texture != indices;
    triangles_.reserve(file_.element().count);
    std::vector<std::uint32_t> corners;
    while (file_.next()) {
      const std::vector<double>& list = file_.list(indices);
      left_out_ += list.size() < 3 ? 1 : 0;
      if (list.size() < 3) continue;
      if (list.size() > max_polygon_corners)
        file_.fail_here("has ", list.size(), " corners, expected at most ", max_polygon_corners);
      corners.clear();
      for (const double one : list) corners.push_back(vertex(one));
      if (unfolds && file_.list(texture).size() == 2 * list.size()) unfold(corners, file_.list(texture));
      const std::size_t first = triangles_.size();
      triangles_.resize(first + corners.size() - 2);
      const auto place_of = [&](std::uint32_t k) { return vertices_[k]; };
      crossings_ += cut_polygon(corners, place_of, &triangles_[first]) ? 0 : 1;
    }
  }

  /// Gives the corners of a face vertices of their own, with their texture coordinates.
  void unfold(std::vector<std::uint32_t>& corners, const std::vector<double>& uv) {
    texture_.resize(vertices_.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      vertices_.push_back(vertices_[corners[k]]);
      add_texture(uv[2 * k], uv[2 * k + 1]);
      corners[k] = static_cast<std::uint32_t>(texture_.size() - 1);
    }
  }

  /// Triangles of strips, every second turned; a negative number, or the largest of 32 bits, ends a strip.
  void take_strips() {
    const std::size_t indices = list_of_vertices();
    while (file_.next()) {
      Corners3 c{};
      std::size_t taken = 0;
      for (const double number : file_.list(indices)) {
        const bool ends = number < 0 || number == 4294967295.0;
        taken = ends ? 0 : taken + 1;
        if (!ends) c = {c[1], c[2], vertex(number)};
        if (taken < 3 || c[0] == c[1] || c[1] == c[2] || c[0] == c[2]) continue;
        triangles_.push_back(taken % 2 == 1 ? c : Corners3{c[1], c[0], c[2]});
      }
    }
  }

  PlyFile file_;
  RawScene scene_;
  bool takes_texture_;
  std::vector<Vec3> vertices_;
  std::vector<Float3> texture_;  // of the vertices, or empty
  std::vector<Corners3> triangles_;
  double farthest_ = 0;  // greatest coordinate of single precision
  std::uint64_t left_out_ = 0, crossings_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
