// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_READER_HPP
#define PULSECAST_IO_DETAIL_OBJ_READER_HPP

#include <set>

#include <pulsecast/io/detail/obj/piece.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/io/obj.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Reader of a file in windows of some pieces, read in parallel, and triangulated in parallel once
/// the vertices before them are known; results are joined in the order of the file.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, const ObjSettings& settings, const Workers& workers,
            std::size_t piece_bytes = std::size_t{1} << 18)
      : file_(path), folder_(path.parent_path()), settings_(settings), workers_(workers), piece_bytes_(piece_bytes) {}

  [[nodiscard]] ObjModel read() {
    while (read_window()) continue;
    notes_.tell(file_.path(), model_.warnings);
    if (model_.mesh.vertices.empty()) file_.fail("holds no vertex: expected an OBJ file, with 'v' and 'f' statements");
    if (model_.mesh.triangles.empty())
      warn(0, "holds no face with an area: expected at least one 'f' statement of such a one");
    resolve_materials();
    return std::move(model_);
  }

 private:
  using Use = ObjPiece::Use;

  bool read_window() {
    std::vector<std::unique_ptr<ObjPiece>> pieces;
    while (pieces.size() < std::size_t{4} * workers_.count()) {
      std::string text = file_.next(piece_bytes_);
      if (text.empty()) break;
      const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
      pieces.push_back(std::make_unique<ObjPiece>(file_.path(), std::move(text), lines_, settings_.texture));
      lines_ += lines;
    }
    for_each_index(pieces.size(), workers_, [&](std::size_t i) {
      pieces[i]->read();
      if (settings_.up == UpAxis::z) return;
      for (Vec3& p : pieces[i]->vertices) p = {p.x, -p.z, p.y};
    });
    std::vector<Vec3>& vertices = model_.mesh.vertices;
    std::vector<std::size_t> before, places_before;  // numbers before each piece
    for (const auto& piece : pieces) {
      before.push_back(vertices.size());
      places_before.push_back(places_.size());
      vertices.insert(vertices.end(), piece->vertices.begin(), piece->vertices.end());
      places_.insert(places_.end(), piece->places.begin(), piece->places.end());
      if (vertices.size() > 0x7FFFFFFF) file_.fail("has too many vertices: expected fewer than 2^31");
    }
    for_each_index(pieces.size(), workers_,
                   [&](std::size_t i) { pieces[i]->triangulate(vertices, before[i], places_, places_before[i]); });
    for (const auto& piece : pieces) add(*piece);
    return !pieces.empty();
  }

  void add(ObjPiece& piece) {
    for (const ObjPiece::Libraries& statement : piece.libraries) {
      if (statement.line > piece.failure.line) break;
      libraries(statement);
    }
    if (piece.failure.error) std::rethrow_exception(piece.failure.error);

    piece.uses.front() = use_;
    MeshData& mesh = model_.mesh;
    mesh.triangles.insert(mesh.triangles.end(), piece.triangles.begin(), piece.triangles.end());
    mesh.texture.insert(mesh.texture.end(), piece.texture.begin(), piece.texture.end());
    for (std::size_t use = 0; use < piece.without_place.size(); ++use)
      without_place_[piece.uses[use].name] += piece.without_place[use];
    for (const std::uint32_t use : piece.triangle_uses) mesh.materials.push_back(material(piece.uses[use]));
    use_ = piece.uses.back();
    notes_.add(piece.notes);
  }

  /// Number of a material in use, assigned when a triangle first needs it.
  [[nodiscard]] std::uint32_t material(Use& use) {
    if (!use.number) {
      use.number = numbers_.try_emplace(use.name, static_cast<std::uint32_t>(numbers_.size())).first->second;
      if (*use.number == uses_.size()) uses_.push_back(use);
    }
    return *use.number;
  }

  /// Reads the files of `mtllib`: one file, whose name may have blanks, or several.
  void libraries(const ObjPiece::Libraries& statement) {
    std::error_code ignored;
    if (std::filesystem::exists(library_path(statement.rest), ignored)) return library(statement.rest, statement);
    model_.files.push_back(library_path(statement.rest));
    for (std::string_view left = statement.rest; !left.empty();) library(std::string(text::take_word(left)), statement);
  }

  [[nodiscard]] std::filesystem::path library_path(std::string path) const {
    std::replace(path.begin(), path.end(), '\\', '/');
    return folder_ / path;
  }

  void library(const std::string& name, const ObjPiece::Libraries& statement) {
    const std::filesystem::path path = library_path(name);
    model_.files.push_back(path);
    std::error_code ignored_error;
    if (!std::filesystem::is_regular_file(path, ignored_error)) {
      warn(statement.line, statement.quoted, ": expected an MTL file at ", path.string(), ", but there is none");
      return;
    }
    if (!read_.insert(path.string()).second) return;
    MaterialLibrary more = read_mtl(path, settings_.spectra);
    for (const auto& [material, pictures] : more.pictures)
      if (!library_.contains(material)) pictures_[material] = pictures;
    library_.merge(more.materials);  // of one name, the first counts
    model_.warnings.insert(model_.warnings.end(), more.warnings.begin(), more.warnings.end());
  }

  void resolve_materials() {
    for (const Use& use : uses_) {
      const auto found = library_.find(use.name);
      if (found == library_.end() && use.line > 0)
        warn(use.line, "no MTL file describes the material '", use.name, "': a reflectance of 0.5 is assumed");
      model_.materials.push_back(found == library_.end() ? undescribed(use.name) : found->second);
      const auto pictures = pictures_.find(use.name);
      if (pictures == pictures_.end()) continue;
      if (const std::size_t count = without_place_[use.name]; count > 0)
        warn(0, count, " corners of material '", use.name, "' have no texture coordinates: 0, 0 is assumed");
      model_.pictures.resize(model_.materials.size());
      model_.pictures.back() = pictures->second;
    }
  }

  void warn(std::size_t line, const auto&... oddity) {
    model_.warnings.push_back(warning(file_.path(), line, oddity...));
  }

  StatementFile file_;
  std::filesystem::path folder_;
  ObjSettings settings_;
  Workers workers_;
  std::size_t piece_bytes_, lines_ = 0;  // `lines_`: number of those read
  ObjModel model_;
  std::vector<Vec2> places_;  // texture coordinates, if they are read
  std::map<std::string, Material, std::less<>> library_;
  std::map<std::string, MaterialPictures, std::less<>> pictures_;  // of materials of the library
  std::set<std::string> read_;                                     // paths of MTL files
  Use use_;                                                        // in force
  std::vector<Use> uses_;                                          // in use by triangles
  std::map<std::string, std::uint32_t> numbers_;                   // indices into `uses_` by name
  StatementNotes notes_{obj_rules};
  std::map<std::string, std::size_t> without_place_;  // corners, by material
};

}  // namespace detail

PULSECAST_INLINE ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings,
                                   const Workers& workers) {
  return reading(path, [&] {
    ObjModel model = detail::ObjReader(path, settings, workers).read();
    if (model.pictures.empty() || settings.texture) return model;
    ObjSettings textured = settings;  // not at first, as few files have pictures
    textured.texture = true;
    return detail::ObjReader(path, textured, workers).read();
  });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
