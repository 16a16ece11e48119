// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_IMPORTER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_IMPORTER_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>

#if PULSECAST_DEFINES(IO_MESH_IMPORT) && !defined(PULSECAST_IMPORTS_APART)
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <pulsecast/io/detail/mesh_file/gltf_document.hpp>
#include <pulsecast/io/detail/mesh_file/raw_material.hpp>
#include <pulsecast/io/detail/obj/polygon.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Regular files of a folder and of those below it, for reading.
class FolderSystem : public Assimp::IOSystem {
 public:
  /// Calls `opened` with the size of each file [byte] before it is first opened.
  FolderSystem(std::filesystem::path folder, bool anywhere, std::function<void(std::uint64_t)> opened)
      : folder_(std::move(folder)), anywhere_(anywhere), opened_(std::move(opened)) {}

  mutable std::string refused;               ///< first file that was refused, as outside; or empty
  mutable std::set<std::string> looked_for;  ///< files that were requested, existing or not
  /// Content of files that are not on disk, by name.
  std::map<std::string, std::string_view, std::less<>> in_memory;

  bool Exists(const char* file) const override { return has_in_memory(file) || is_open_to(found(file)); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* named, const char* mode) override {
    if (const std::string_view* const bytes = has_in_memory(named))
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size());
    const std::string file = found(named);
    if (std::strpbrk(mode, "wa+") || !is_open_to(file)) return nullptr;
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file, ignored);
    if (!ignored && opened_ && known_.insert(file).second) opened_(size);
    return files_.Open(file.c_str(), mode);
  }
  void Close(Assimp::IOStream* stream) override { files_.Close(stream); }

 private:
  [[nodiscard]] const std::string_view* has_in_memory(std::string_view file) const {
    const auto known = in_memory.find(file.substr(file.rfind('/') + 1));
    return known == in_memory.end() ? nullptr : &known->second;
  }
  /// Name as it is, or decoded if there is no such file. Source: glTF 2.0, 3.6.1.1 (URIs).
  [[nodiscard]] std::string found(const char* file) const {
    looked_for.insert(file);
    std::error_code ignored;
    return std::filesystem::exists(file, ignored) ? file : unescaped(file);
  }
  [[nodiscard]] bool is_open_to(const std::string& file) const {
    looked_for.insert(file);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;
    if (anywhere_ || is_inside(folder_, file)) return true;
    if (refused.empty()) refused = file;
    return false;
  }

  Assimp::DefaultIOSystem files_;
  std::filesystem::path folder_;
  bool anywhere_;
  std::function<void(std::uint64_t)> opened_;
  std::set<std::string> known_;  ///< files that were opened
};

class MeshImport {
 public:
  MeshImport(const std::filesystem::path& path, const MeshFileSettings& settings,
             std::function<void(std::uint64_t)> opened = {})
      : path_(path), settings_(settings) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    system_ = new FolderSystem(folder, settings.files_elsewhere, std::move(opened));
    importer_->SetIOHandler(system_);  // which takes it
  }

  [[nodiscard]] RawScene read() {
    const MappedFile content(path_, "a mesh file");
    const std::string main = main_file(content.text());
    Assimp::Importer& importer = *importer_;
    for (const char* off : {AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS,
                            AI_CONFIG_IMPORT_FBX_READ_CAMERAS, AI_CONFIG_IMPORT_FBX_READ_LIGHTS})
      importer.SetPropertyBool(off, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, settings_.up.has_value());
    const aiScene* const found = importer.ReadFile(main, 0);
    if (!found || !found->mRootNode) fail(importer.GetErrorString());
    require_own_folder();
    format(*found);
    for (unsigned i = 0; i < found->mNumMaterials; ++i) {
      const ImportedMaterial& one =
          materials_.emplace_back(MaterialImport(*found, *found->mMaterials[i], is_gltf()).read());
      scene_.materials.push_back(one.material);
      const RawOptics& o = one.material.optics;
      const std::array shares{o.colour[0],   o.colour[1], o.colour[2],    o.specular[0], o.specular[1],
                              o.specular[2], o.opacity,   o.transmission, o.metallic};
      if (!std::ranges::all_of(shares, [](float share) { return share >= 0 && share <= 1; }))
        warn("material '", one.material.name, "' has a number beyond 0 to 1, for which the nearest of these is taken");
      if (one.moved_picture)
        warn("material '", one.material.name, "' transforms its texture coordinates, which has no effect");
    }
    for (unsigned i = 0; i < found->mNumTextures; ++i)
      scene_.embedded.push_back(embedded_picture(*found->mTextures[i]));
    for (unsigned i = 0; i < found->mNumMeshes; ++i) mesh(*found->mMeshes[i]);
    nodes(*found->mRootNode);
    if (posed_ > 0) warn(posed_, " meshes have bones or morph targets, which are not applied");
    if (crossings_ > 0) warn(crossings_, " polygons cross themselves, and become fans about their first corners");
    if (left_out_ > 0) warn("points and lines are left out: ", left_out_, " in all");
    for (const std::string& file : system_->looked_for)
      if (file != std::filesystem::absolute(path_)) scene_.files.push_back(file);
    return std::move(scene_);
  }

 private:
  /// Name of the file for assimp: for glTF and GLB, that of a document of our own.
  [[nodiscard]] std::string main_file(std::string_view content) {
    const std::filesystem::path path = std::filesystem::absolute(path_);
    const std::string ending = text::lower(path.extension().string());
    for (const FormatRule& rule : mesh_rules)
      if ((ending == ".dae" || ending == ".fbx") && content.find(rule.name) != content.npos)
        keep_rule(mesh_rules, path_, "item", rule.name, scene_.warnings);
    if (ending == ".dae") require_names(content);
    if (!content.starts_with("glTF") && ending != ".gltf" && ending != ".glb") return path.string();
    const auto open = [&](const std::string& uri) {
      Assimp::IOStream* const stream = system_->Open((path.parent_path() / uri).c_str(), "rb");
      if (!stream) fail("could not open referenced file ", text::quoted(uri));
      std::string bytes(stream->FileSize(), '\0');
      bytes.resize(bytes.empty() ? 0 : stream->Read(bytes.data(), 1, bytes.size()));
      system_->Close(stream);
      return bytes;
    };
    system_->in_memory = gltf_.emplace(path_, content, open, scene_.warnings).files();
    return (path.parent_path() / "<document>.gltf").string();
  }

  /// Refuses numbers of a DAE file by other names: assimp takes the first of a row for each that it misses, as for z.
  void require_names(std::string_view text) {
    text = text.substr(std::min(text.find("<library_geometries"), text.size()));
    text = text.substr(0, text.find("</library_geometries"));
    for (std::size_t at = text.find("<accessor"); at != text.npos; at = text.find("<accessor", at + 1)) {
      const std::string_view params = text.substr(at, text.find("</accessor", at) - at);
      std::string names = "|";
      for (std::size_t i = params.find("name="); i < params.size() - 6; i = params.find("name=", i + 6))
        names += params.substr(i + 6, params.find(params[i + 5], i + 6) - i - 6);
      if (names == "|" || std::string_view("|XYZ|ST|STP|UV|UVW|RGB|RGBA|").find(names + "|") == text.npos)
        keep_rule(mesh_rules, path_, "item", "params of other names", scene_.warnings);
    }
  }

  [[noreturn]] void fail(const auto&... what) const {
    require_own_folder();
    const std::string problem = text::message(what...);
    if (problem.find("bad_alloc") != problem.npos) throw std::bad_alloc();
    const bool no_format = problem.starts_with("No suitable reader");
    detail::fail(path_, "is no mesh file that can be read: ",
                 no_format ? "assimp finds none of its formats in it" : printable(problem));
  }
  void require_own_folder() const {
    if (!system_->refused.empty())
      detail::fail(path_, "refers to '", system_->refused, "': expected files in its own folder");
  }
  void warn(const auto&... oddity) { scene_.warnings.push_back(warning(path_.string(), 0, oddity...)); }

  /// Unit and axes of the file, unless assimp applies them, as to DAE files: y up, in metres.
  void format(const aiScene& found) {
    aiString name;
    if (found.mMetaData) found.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, name);
    const std::string_view word = name.C_Str();
    const bool fbx = word.find("FBX") != word.npos, dae = word.starts_with("Collada");
    if (is_gltf() || fbx || dae) scene_.upright = y_up;
    if (dae && settings_.unit)  // assimp scales the root by the unit, and turns it
      scene_.applied_unit = std::cbrt(std::fabs(double{found.mRootNode->mTransformation.Determinant()}));
    if (!fbx) return;
    const auto whole = [&](const char* key, int otherwise) {
      std::int32_t value = otherwise;
      found.mMetaData->Get(key, value);
      return value;
    };
    const int up = whole("UpAxis", 1), right = whole("CoordAxis", 0);
    if (up != right && up >= 0 && up < 3 && right >= 0 && right < 3) {
      Vec3 upward{}, rightward{};
      upward[up] = whole("UpAxisSign", 1) < 0 ? -1 : 1;
      rightward[right] = whole("CoordAxisSign", 1) < 0 ? -1 : 1;
      const Vec3 forward = cross(upward, rightward);
      for (int i = 0; i < 3; ++i) scene_.upright[i] = {rightward[i], forward[i], upward[i]};
    }
    float single = 1;
    double centimetres = 1;
    if (!found.mMetaData->Get("UnitScaleFactor", centimetres) && found.mMetaData->Get("UnitScaleFactor", single))
      centimetres = double{single};
    scene_.unit = centimetres / 100;
  }

  void mesh(const aiMesh& from) {
    static_assert(sizeof(aiVector3D) == sizeof(Float3) && sizeof(ai_real) == sizeof(float));
    RawMesh made{.name = from.mName.C_Str(), .material = from.mMaterialIndex};
    const std::span<aiAnimMesh* const> targets(from.mAnimMeshes, from.mAnimMeshes ? from.mNumAnimMeshes : 0);
    const bool is_morphed =
        std::ranges::any_of(targets, [](const aiAnimMesh* one) { return one && one->mWeight != 0; });
    posed_ += from.mNumBones > 0 || is_morphed ? 1 : 0;
    if (from.mMaterialIndex >= materials_.size()) fail("a mesh has a material that is not there");
    const auto shared = [&](const aiVector3D* values) {
      const std::size_t count = values ? from.mNumVertices : 0;
      return SharedArray<Float3>({reinterpret_cast<const Float3*>(values), count}, importer_);
    };
    made.vertices = shared(from.mVertices);
    made.triangles = triangles_of(from);
    if (from.mNumFaces == 0) left_out_ += from.mNumVertices;
    const auto& [material, channel, is_moved] = materials_[from.mMaterialIndex];
    const bool pictured = !material.colour.name.empty() || !material.opacity.name.empty();
    const bool has_channel = channel < AI_MAX_NUMBER_OF_TEXTURECOORDS && from.HasTextureCoords(channel);
    if (pictured || settings_.texture || !settings_.materials.empty())
      made.texture = shared(from.mTextureCoords[has_channel ? channel : 0]);
    if (gltf_ && from.mMaterialIndex < gltf_->transforms.size() && gltf_->transforms[from.mMaterialIndex]) {
      const SharedBuffer<Float3> moved(made.texture.size());
      std::ranges::transform(made.texture, moved.data(), [&](const Float3& t) {
        const Vec3 to = *gltf_->transforms[from.mMaterialIndex] * Vec3(double{t.x}, double{t.y}, 1);
        return Float3{static_cast<float>(to.x), static_cast<float>(to.y), 0};
      });
      made.texture = moved;
    }
    scene_.meshes.push_back(std::move(made));
  }

  /// Triangles of all faces: n - 2 of one with n corners.
  [[nodiscard]] SharedBuffer<Corners3> triangles_of(const aiMesh& from) {
    const std::span<const aiFace> faces(from.mFaces, from.mNumFaces);
    std::size_t count = 0;
    for (const aiFace& face : faces) count += face.mNumIndices < 3 ? 0 : face.mNumIndices - 2;
    SharedBuffer<Corners3> triangles(count);
    Corners3* to = triangles.data();
    const auto place_of = [&](unsigned vertex) {
      const aiVector3D& v = from.mVertices[vertex];
      return Vec3(v.x, v.y, v.z);
    };
    for (const aiFace& face : faces) {
      if (face.mNumIndices < 3) {
        ++left_out_;
        continue;
      }
      const std::span<const unsigned> corners(face.mIndices, face.mNumIndices);
      if (corners.size() > max_polygon_corners)
        fail("a polygon has ", corners.size(), " corners, expected at most ", max_polygon_corners);
      for (const unsigned one : corners)
        if (one >= from.mNumVertices)
          fail("a face has the vertex ", one, ", expected less than the number of vertices, ", from.mNumVertices);
      crossings_ += cut_polygon(corners, place_of, to) ? 0 : 1;
      to += face.mNumIndices - 2;
    }
    return triangles;
  }

  /// Nodes with meshes, each before those below it.
  void nodes(const aiNode& root) {
    struct Step {
      const aiNode* node;
      Affine above;
      std::string name;  // of the nodes above
      unsigned depth;
    };
    std::vector<Step> open{{&root, {}, {}, 0}};
    while (!open.empty()) {
      const Step step = std::move(open.back());
      open.pop_back();
      const aiNode& node = *step.node;
      if (step.depth > 1000) fail("its nodes are nested more than 1000 deep");
      const aiMatrix4x4& m = node.mTransformation;
      const Matrix3 linear(Vec3(m.a1, m.b1, m.c1), Vec3(m.a2, m.b2, m.c2), Vec3(m.a3, m.b3, m.c3));
      std::string name = node.mName.C_Str();  // of a root, often without a meaning
      const bool means_nothing = name.starts_with('<') || (node.mNumMeshes == 0 && !(is_gltf() && name != "ROOT"));
      if (step.depth == 0 && means_nothing) name.clear();
      RawNode made{.name = step.name.empty() ? name : step.name + "/" + name,
                   .place = step.above * Affine{linear, Vec3(m.a4, m.b4, m.c4)}};
      for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene_.meshes.size()) fail("a node has a mesh that is not there");
        made.meshes.push_back(node.mMeshes[i]);
      }
      for (unsigned i = node.mNumChildren; i-- > 0;)
        open.push_back({node.mChildren[i], made.place, made.name, step.depth + 1});
      if (!made.meshes.empty()) add(std::move(made), name, step.name);
    }
  }

  /// Adds a node, or one for each instance, named as its node with a number.
  void add(RawNode node, std::string_view name, const std::string& above) {
    const bool is_marked = gltf_ && name.starts_with(GltfDocument::instance_mark);
    const auto number = is_marked ? text::number_in<std::size_t>(name.substr(1)) : std::nullopt;
    if (!number || *number >= gltf_->instances.size()) {
      scene_.nodes.push_back(std::move(node));
      return;
    }
    const std::vector<Affine>& all = gltf_->instances[*number];
    for (std::size_t i = 0; i < all.size(); ++i)
      scene_.nodes.push_back(
          {above + (above.empty() ? "" : "/") + std::to_string(i), node.place * all[i], node.meshes});
  }

  [[nodiscard]] bool is_gltf() const noexcept { return gltf_.has_value(); }

  const std::filesystem::path& path_;
  const MeshFileSettings& settings_;
  std::shared_ptr<Assimp::Importer> importer_ = std::make_shared<Assimp::Importer>();  // owns its scene
  FolderSystem* system_;                                                               // of the importer
  RawScene scene_;
  std::vector<ImportedMaterial> materials_;
  std::optional<GltfDocument> gltf_;
  std::uint64_t left_out_ = 0, posed_ = 0, crossings_ = 0;
};

PULSECAST_INLINE RawScene foreign_scene(const std::filesystem::path& path, const MeshFileSettings& settings) {
  const auto import = [&](const auto& opened) { return MeshImport(path, settings, opened).read(); };
  return settings.isolated ? imported_apart(path, settings.limits, import) : import(nullptr);
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif

#endif
