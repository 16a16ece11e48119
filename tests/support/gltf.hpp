// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

/// glTF files made by hand. Source: glTF 2.0 specification.
namespace pulsecast::support {

/// Bytes in base 64. Source: RFC 4648, 4.
[[nodiscard]] inline std::string base64(std::string_view bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

class Gltf {
 public:
  using Place = std::array<float, 3>;
  using Corners = std::array<std::uint32_t, 3>;

  /// Part of the next mesh; `members` are its other ones, as of `,"material":0`.
  void primitive(const std::vector<Place>& vertices, const std::vector<Corners>& triangles,
                 const std::string& members = "", const std::vector<std::array<float, 2>>& texture = {}) {
    std::string attributes = "\"POSITION\":" + accessor(vertices, 5126, "VEC3", vertices.size());
    if (!texture.empty()) attributes += ",\"TEXCOORD_0\":" + accessor(texture, 5126, "VEC2", texture.size());
    add(primitives_, "{\"attributes\":{" + attributes +
                         "},\"indices\":" + accessor(triangles, 5125, "SCALAR", 3 * triangles.size()) + members + "}");
  }
  /// Part of the next mesh, of accessors by number.
  void primitive(const std::string& attributes, const std::string& members) {
    add(primitives_, "{\"attributes\":{" + attributes + "}" + members + "}");
  }
  /// Mesh of the parts so far. Returns its number.
  std::size_t mesh(const std::string& name) {
    add(meshes_, "{\"name\":\"" + name + "\",\"primitives\":[" + primitives_ + "]}");
    primitives_.clear();
    return mesh_count_++;
  }
  void node(const std::string& members) { add(nodes_, "{" + members + "}"); }
  void material(const std::string& members) { add(materials_, "{" + members + "}"); }

  std::string roots = "0";  ///< numbers of the nodes of the scene
  std::string more{};       ///< other members of the file, as of `"images":[],`

  [[nodiscard]] std::string text() const {
    return json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes_) + "\"");
  }
  /// Text for a file with a buffer of its own, of the bytes `buffer()`.
  [[nodiscard]] std::string text(const std::string& uri) const { return json(",\"uri\":\"" + uri + "\""); }
  [[nodiscard]] const std::string& buffer() const noexcept { return bytes_; }
  [[nodiscard]] std::string binary() const {
    std::string head = json(""), bytes = bytes_;
    while (head.size() % 4 != 0) head += ' ';
    while (bytes.size() % 4 != 0) bytes += '\0';
    std::string all = "glTF";
    const auto number = [&](std::size_t value) {
      for (int k = 0; k < 4; ++k) all += static_cast<char>(value >> 8 * k & 0xFF);
    };
    number(2);
    number(28 + head.size() + bytes.size());
    number(head.size());
    all += "JSON" + head;
    number(bytes.size());
    all += std::string("BIN\0", 4) + bytes;
    return all;
  }

  /// Adds a picture, or other bytes, to the buffer. Returns the number of its view.
  std::string view(const void* data, std::size_t size, const std::string& members = "") {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    add(views_, "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
                    ",\"byteLength\":" + std::to_string(size) + members + "}");
    bytes_.append(static_cast<const char*>(data), size);
    return std::to_string(view_count_++);
  }
  /// Adds elements, of a component type and a shape, as in `5126` and `VEC3`. Returns the number of their accessor.
  template <class T>
  std::string accessor(const std::vector<T>& elements, int type, const std::string& shape, std::size_t count,
                       const std::string& members = "", const std::string& members_of_view = "") {
    const std::string number = view(elements.data(), elements.size() * sizeof(T), members_of_view);
    add(accessors_, "{\"bufferView\":" + number + ",\"componentType\":" + std::to_string(type) + ",\"type\":\"" +
                        shape + "\",\"count\":" + std::to_string(count) + members + "}");
    return std::to_string(accessor_count_++);
  }

 private:
  static void add(std::string& list, const std::string& item) { list += (list.empty() ? "" : ",") + item; }

  [[nodiscard]] std::string json(const std::string& uri) const {
    return "{\"asset\":{\"version\":\"2.0\"}," + more + "\"scene\":0,\"scenes\":[{\"nodes\":[" + roots +
           "]}],\"nodes\":[" + nodes_ + "],\"meshes\":[" + meshes_ + "]," +
           (materials_.empty() ? "" : "\"materials\":[" + materials_ + "],") + "\"accessors\":[" + accessors_ +
           "],\"bufferViews\":[" + views_ + "],\"buffers\":[{\"byteLength\":" + std::to_string(bytes_.size()) + uri +
           "}]}";
  }

  std::string primitives_, meshes_, nodes_, materials_, accessors_, views_, bytes_;
  std::size_t mesh_count_ = 0, view_count_ = 0, accessor_count_ = 0;
};

}  // namespace pulsecast::support
