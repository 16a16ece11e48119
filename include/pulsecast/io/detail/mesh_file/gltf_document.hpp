// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_GLTF_DOCUMENT_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_GLTF_DOCUMENT_HPP

#include <set>

#include <rapidjson/document.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

using Json = rapidjson::Value;

/// Member of an object, or a member of it, and so on; null if there is none.
template <class... Names>
[[nodiscard]] Json* member(Json& object, std::string_view name, const Names&... names) {
  const Json key(name.data(), static_cast<rapidjson::SizeType>(name.size()));
  if (!object.IsObject() || !object.HasMember(key)) return nullptr;  // iterators do not compare in C++20
  if constexpr (sizeof...(names) > 0)
    return member(object[key], names...);
  else
    return &object[key];
}

/// Elements of an array, or none.
[[nodiscard]] inline std::span<Json> elements(Json* array) {
  return array && array->IsArray() && !array->Empty() ? std::span(array->Begin(), array->Size()) : std::span<Json>();
}

[[nodiscard]] inline std::string_view text_of(const Json* value) {
  return value && value->IsString() ? std::string_view(value->GetString(), value->GetStringLength()) : "";
}

/// glTF or GLB file as a document for assimp, without what assimp 5.2 does not apply: quantized coordinates are
/// floating-point numbers, hidden nodes are gone, instances and transforms of pictures stand apart. Source: glTF 2.0.
class GltfDocument {
 public:
  /// `open` gives the content of a buffer by its URI. @throws FileError for what a rule refuses, text that is no JSON
  /// or nested more than 200 deep, and values outside their buffers
  GltfDocument(const std::filesystem::path& path, std::string_view file,
               const std::function<std::string(const std::string&)>& open, std::vector<std::string>& warnings)
      : path_(path), open_(open), is_binary_(file.starts_with("glTF")) {
    const std::string_view text = text::without_byte_order_mark(is_binary_ ? chunks(file) : file);
    require_flat(text);
    root_.Parse<rapidjson::kParseIterativeFlag>(text.data(), text.size());
    if (root_.HasParseError()) fail("is no right JSON from byte ", root_.GetErrorOffset(), " on");
    if (!root_.IsObject()) fail("is no glTF: expected a JSON object");
    keep_rules(warnings);
    for (std::size_t i = 0, count = elements(member(root_, "nodes")).size(); i < count; ++i) apply_node(i);
    std::uint64_t number = 0;
    for (Json& mesh : elements(member(root_, "meshes"))) apply_mesh(mesh, boned_.contains(number++));
    for (Json& material : elements(member(root_, "materials"))) transforms.push_back(transform_of(material));
    for (const char* one : {"animations", "skins"}) root_.RemoveMember(one);
    for (Json& buffer : elements(member(root_, "buffers")))
      if (is_binary_ && buffer.IsObject() && !member(buffer, "uri")) buffer.AddMember("uri", "<binary>", memory());
    if (!made_.empty()) append("buffers", R"({"uri":"<made>","byteLength":)", made_.size(), "}");
    rapidjson::Writer<rapidjson::StringBuffer> writer(text_);
    root_.Accept(writer);
  }

  /// Name of a child node that has the mesh of instances, before their number.
  static constexpr char instance_mark = '\x01';
  std::vector<std::vector<Affine>> instances;  ///< in the frames of their nodes, by that number
  /// Transforms of the upward coordinates (u, v, 1) of the base colour's picture, by material.
  std::vector<std::optional<Matrix3>> transforms;

  /// Files for assimp, by name.
  [[nodiscard]] std::map<std::string, std::string_view, std::less<>> files() const {
    return {{"<document>.gltf", {text_.GetString(), text_.GetSize()}}, {"<binary>", binary_}, {"<made>", made_}};
  }

 private:
  [[noreturn]] void fail(const auto&... problem) const { detail::fail(path_, problem...); }
  [[nodiscard]] rapidjson::Document::AllocatorType& memory() { return root_.GetAllocator(); }

  /// JSON of a GLB file, whose other chunk is kept. Source: glTF 2.0, 4.4 (binary glTF layout).
  [[nodiscard]] std::string_view chunks(std::string_view file) {
    const auto chunk = [&](std::size_t at) {
      std::uint32_t size = 0;
      for (std::size_t k = 0; k < 4; ++k) size |= std::uint32_t{static_cast<unsigned char>(file[at + k])} << 8 * k;
      if (size > file.size() - at - 8) fail("ends within its chunk of ", size, " bytes at byte ", at);
      return file.substr(at + 8, size);
    };
    if (file.size() < 20) fail("ends within its header");
    const std::string_view json = chunk(12);
    if (file.size() >= 28 + json.size()) binary_ = chunk(20 + json.size());
    return json;
  }

  /// Refuses JSON text whose values nest so deep that a recursive reader would end.
  void require_flat(std::string_view text) const {
    bool in_string = false;
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (c == '\\') ++i;
      in_string = in_string != (c == '"');
      if (in_string) continue;
      depth += (c == '[' || c == '{') - (c == ']' || c == '}');
      if (depth > 200) fail("is nested more than 200 deep at byte ", i);
    }
  }

  /// Member that is a whole number. @throws FileError for another, or without it
  [[nodiscard]] std::uint64_t whole(Json& of, std::string_view name, std::optional<std::uint64_t> otherwise = {}) {
    const Json* const found = member(of, name);
    if (!found && otherwise) return *otherwise;
    if (!found || !found->IsUint64() || found->GetUint64() >> 53 != 0)
      fail("has no right ", name, ": expected a whole number");
    return found->GetUint64();
  }

  [[nodiscard]] Json& item(std::string_view list, std::uint64_t number) {
    const std::span<Json> all = elements(member(root_, list));
    if (number >= all.size()) fail("has no number ", number, " of its ", list);
    return all[number];
  }

  /// Appends JSON text to a list of the document. Returns the number of the element.
  std::uint64_t append(std::string_view list, const auto&... text) {
    Json* const to = member(root_, list);
    if (!to || !to->IsArray()) fail("has no ", list);
    to->PushBack(rapidjson::Document(&memory()).Parse(text::message(text...).c_str()).Move(), memory());
    return to->Size() - 1;
  }

  /// Keeps to the rules for extensions, whether required, declared or only there, and for members. An extension that is
  /// not required may be ignored. Source: glTF 2.0, 3.12.
  void keep_rules(std::vector<std::string>& warnings) {
    constexpr std::span<const FormatRule> all(gltf_rules), listed = all.first(all.size() - 1);
    std::set<std::string, std::less<>> seen;
    const auto keep = [&](std::string_view name, bool is_required) {
      if (!seen.emplace(name).second) return;
      const FormatRule* const rule = rule_of(listed, name);
      const bool is_ignored = !is_required && (!rule || rule->use == FormatUse::refused);
      keep_rule(is_ignored ? all.last(1) : listed, path_, "glTF feature", name, warnings);
    };
    for (const char* list : {"extensionsRequired", "extensionsUsed"})
      for (Json& one : elements(member(root_, list))) keep(text_of(&one), list[10] == 'R');
    is_quantized_ = seen.contains("KHR_mesh_quantization");
    std::vector<std::pair<Json*, bool>> open{{&root_, false}};  // true: a list of extensions
    while (!open.empty()) {
      const auto [value, is_list] = open.back();
      open.pop_back();
      for (Json& one : elements(value)) open.push_back({&one, false});
      if (!value->IsObject()) continue;
      value->RemoveMember("extras");
      for (std::size_t k = 0; k < value->MemberCount(); ++k) {
        auto& one = value->MemberBegin()[static_cast<std::ptrdiff_t>(k)];
        const std::string_view name = text_of(&one.name);
        if (is_list || (rule_of(listed, name) && has_effect(name, one.value))) keep(name, !is_list);
        open.push_back({&one.value, name == "extensions"});
      }
    }
  }

  [[nodiscard]] static bool has_effect(std::string_view name, Json& value) {
    if (name == "minVersion") return text_of(&value) != "2.0";
    if (name == "scenes") return elements(&value).size() > 1;
    const auto is_set = [&](const Json& one) { return name != "weights" || !one.IsNumber() || one.GetDouble() != 0; };
    return !value.IsArray() || std::ranges::any_of(elements(&value), is_set);
  }

  /// Takes the content from a hidden node, and leaves the mesh of instances to a child.
  void apply_node(std::size_t number) {
    Json& node = item("nodes", number);
    const Json* const shown = member(node, "extensions", "KHR_node_visibility", "visible");
    if (shown && shown->IsFalse())
      for (const char* one : {"mesh", "children"}) node.RemoveMember(one);
    if (!member(node, "mesh")) return;
    const std::uint64_t mesh = whole(node, "mesh");
    if (node.RemoveMember("skin")) boned_.insert(mesh);
    Json* const attributes = member(node, "extensions", "EXT_mesh_gpu_instancing", "attributes");
    if (!attributes) return;
    instances.push_back(instances_of(*attributes));
    node.RemoveMember("mesh");
    if (!member(node, "children")) node.AddMember("children", Json(rapidjson::kArrayType), memory());
    Json* const children = member(node, "children");
    if (!children->IsArray()) fail("has a node with children that are no list");
    children->PushBack(static_cast<std::uint64_t>(elements(member(root_, "nodes")).size()), memory());
    append("nodes", R"({"name":"\u0001)", instances.size() - 1, R"(","mesh":)", mesh, "}");
  }

  /// Places of instances in the frame of their node. Source: EXT_mesh_gpu_instancing.
  [[nodiscard]] std::vector<Affine> instances_of(Json& attributes) {
    std::vector<Affine> made;
    const auto each = [&](std::string_view name, std::size_t width, const auto& take) {
      if (!member(attributes, name)) return;
      const std::vector<double> all = numbers(whole(attributes, name), width);
      if (made.empty()) made.resize(all.size() / width);
      if (all.size() != made.size() * width) fail("has instances with not as many ", name, " as others");
      for (std::size_t i = 0; i < made.size(); ++i) take(made[i], &all[i * width]);
    };
    each("TRANSLATION", 3, [](Affine& one, const double* v) { one.shift = {v[0], v[1], v[2]}; });
    each("ROTATION", 4,
         [](Affine& one, const double* v) { one.linear = matrix_of(normalize(Rotation(v[3], v[0], v[1], v[2]))); });
    each("SCALE", 3, [](Affine& one, const double* v) {
      for (int k = 0; k < 3; ++k) one.linear[k] *= v[k];
    });
    if (made.empty()) fail("has instances without TRANSLATION, ROTATION and SCALE");
    return made;
  }

  /// Leaves positions and texture coordinates to a mesh, as floating-point numbers.
  void apply_mesh(Json& mesh, bool has_bones) {
    if (mesh.IsObject()) mesh.RemoveMember("weights");
    for (Json& primitive : elements(member(mesh, "primitives"))) {
      Json* const attributes = member(primitive, "attributes");
      if (!attributes || !attributes->IsObject()) continue;
      const bool is_compressed = member(primitive, "extensions", "KHR_draco_mesh_compression");
      if (!is_compressed) primitive.RemoveMember("targets");
      for (rapidjson::SizeType k = attributes->MemberCount(); k-- > 0;) {
        const auto one = attributes->MemberBegin() + static_cast<std::ptrdiff_t>(k);
        const std::string_view name = text_of(&one->name);
        const bool is_place = name == "POSITION";
        const char* const bound = is_compressed ? "compression by Draco" : is_place && has_bones ? "bones" : nullptr;
        if (is_place || name.starts_with("TEXCOORD_"))
          one->value.SetUint64(as_float(whole(*attributes, name), is_place, bound));
        else if (!is_compressed)
          attributes->EraseMember(one);
      }
      if (is_compressed || !member(*attributes, "POSITION") || !member(primitive, "indices")) continue;
      const std::uint64_t count = whole(item("accessors", whole(*attributes, "POSITION")), "count");
      const std::vector<double> corners = numbers(whole(primitive, "indices"), 1);
      if (corners.size() % 3 != 0 && (!member(primitive, "mode") || whole(primitive, "mode") == 4))
        fail("has triangles of ", corners.size(), " corners: expected three each");
      for (const double vertex : corners)  // as assimp drops such faces
        if (!(vertex < static_cast<double>(count)))
          fail("has a face of the vertex ", vertex, ": expected less than their number, ", count);
    }
  }

  /// Number of an accessor, or of one of floating-point numbers in its place. Source: KHR_mesh_quantization.
  [[nodiscard]] std::uint64_t as_float(std::uint64_t number, bool is_place, const char* bound) {
    const std::uint64_t type = whole(item("accessors", number), "componentType");
    const std::string_view shape = is_place ? "VEC3" : "VEC2",
                           given = text_of(member(item("accessors", number), "type"));
    if (given != shape) fail("has coordinates of the type ", given, " (accessor ", number, "): expected ", shape);
    if (type == 5126) return number;
    if (type > 5123 || (is_place && !is_quantized_))
      fail("has positions of the component type ", type, " (accessor ", number,
           "): expected 5126, floating-point numbers, or KHR_mesh_quantization");
    if (bound) fail("has ", bound, " and quantized positions: expected a file as gltfpack makes with -noq");
    const auto [known, is_new] = floats_.try_emplace(number, 0);
    if (!is_new) return known->second;
    const std::size_t width = is_place ? 3 : 2;
    const std::vector<double> exact = numbers(number, width);
    const std::vector<float> values(exact.begin(), exact.end());
    const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    const std::uint64_t view = append("bufferViews", R"({"buffer":)", elements(member(root_, "buffers")).size(),
                                      R"(,"byteOffset":)", made_.size(), R"(,"byteLength":)", bytes.size(), "}");
    made_ += bytes;
    return known->second = append("accessors", R"({"bufferView":)", view, R"(,"componentType":5126,"count":)",
                                  values.size() / width, R"(,"type":"VEC)", width, R"("})");
  }

  /// Elements of an accessor as numbers, `width` each. Source: glTF 2.0, 3.6.2; shares by 3.11 (animations).
  [[nodiscard]] std::vector<double> numbers(std::uint64_t number, std::size_t width) {
    constexpr std::array<std::string_view, 5> shapes{"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    Json& accessor = item("accessors", number);
    const std::uint64_t component = whole(accessor, "componentType"), count = whole(accessor, "count");
    if (text_of(member(accessor, "type")) != shapes[width] || component < 5120 || component > 5126 ||
        component == 5124 || member(accessor, "sparse"))
      fail("has the accessor ", number, ": expected ", shapes[width], " of a known component type, not sparse");
    const auto type = static_cast<NumberType>(component - 5119);  // in the same order
    Json& view = item("bufferViews", whole(accessor, "bufferView"));
    const std::string_view buffer = bytes(whole(view, "buffer"));
    const std::uint64_t begin = whole(view, "byteOffset", 0), end = begin + whole(view, "byteLength"),
                        first = begin + whole(accessor, "byteOffset", 0), row = width * size_of(type),
                        stride = whole(view, "byteStride", row);
    if (count == 0 || end > buffer.size() || first + row > end || stride < row ||
        count - 1 > (end - first - row) / stride)
      fail("has the accessor ", number, " of ", count, " elements: expected them in a buffer, within its view");
    const Json* const normalized = member(accessor, "normalized");
    const bool is_share = normalized && normalized->IsTrue() && type <= NumberType::uint16;
    std::vector<double> made(count * width);
    visit_number_type(type, [&]<class Number>() {
      constexpr auto greatest = static_cast<double>(std::numeric_limits<Number>::max());
      for (std::size_t i = 0; i < made.size(); ++i) {
        Number value;
        std::memcpy(&value, buffer.data() + first + i / width * stride + i % width * sizeof value, sizeof value);
        made[i] = static_cast<double>(value);
        if (is_share) made[i] = std::max(made[i] / greatest, -1.0);
      }
    });
    return made;
  }

  /// Content of a buffer, or of a data URI. Source: RFC 4648, 4 (base 64).
  [[nodiscard]] std::string_view bytes(std::uint64_t number) {
    const std::string uri(text_of(member(item("buffers", number), "uri")));
    if (uri.empty()) return binary_;
    const auto [known, is_new] = buffers_.try_emplace(number);
    if (!is_new) return known->second;
    if (!uri.starts_with("data:")) return known->second = open_(uri);
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::size_t word = 0;
    const std::size_t begin = std::min(uri.find(','), uri.size() - 1) + 1;
    for (std::size_t i = 0; begin + i < uri.size() && digits.find(uri[begin + i]) != digits.npos; ++i) {
      word = word << 6 | digits.find(uri[begin + i]);
      if (i % 4 != 0) known->second += static_cast<char>(word >> (6 - 2 * (i % 4)) & 0xFF);
    }
    return known->second;
  }

  /// Transform of the picture of the base colour, which goes from the document. Source: KHR_texture_transform, whose
  /// rotation is counter-clockwise as seen; its coordinates are downward.
  [[nodiscard]] std::optional<Matrix3> transform_of(Json& material) {
    Json* const picture = member(material, "pbrMetallicRoughness", "baseColorTexture");
    Json* const from = picture ? member(*picture, "extensions", "KHR_texture_transform") : nullptr;
    if (!from) return std::nullopt;
    const auto number = [&](std::string_view name, std::size_t i, double otherwise) {
      Json* const value = member(*from, name);
      const Json* const one = i < elements(value).size() ? &elements(value)[i] : value;
      return one && one->IsNumber() ? one->GetDouble() : otherwise;
    };
    const double turn = number("rotation", 0, 0), c = std::cos(turn), s = std::sin(turn);
    const Vec3 u = Vec3(c, -s, 0) * number("scale", 0, 1), v = Vec3(s, c, 0) * number("scale", 1, 1);
    const Matrix3 upward(Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 1));
    const Matrix3 made = upward * Matrix3(u, v, Vec3(number("offset", 0, 0), number("offset", 1, 0), 1)) * upward;
    const std::uint64_t set = whole(*from, "texCoord", whole(*picture, "texCoord", 0));
    picture->RemoveMember("texCoord");
    picture->AddMember("texCoord", set, memory());
    picture->RemoveMember("extensions");
    return made;
  }

  const std::filesystem::path& path_;
  const std::function<std::string(const std::string&)>& open_;
  rapidjson::Document root_;
  rapidjson::StringBuffer text_;
  std::string_view binary_;
  std::string made_;  ///< buffer of our own
  bool is_binary_, is_quantized_ = false;
  std::set<std::uint64_t> boned_;                  ///< meshes with bones
  std::map<std::uint64_t, std::uint64_t> floats_;  ///< accessors of our own, by those that they replace
  std::map<std::uint64_t, std::string> buffers_;   ///< by number
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
