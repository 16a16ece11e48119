// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_GLTF_CHECK_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_GLTF_CHECK_HPP

#include <algorithm>
#include <array>
#include <vector>

#include <pulsecast/io/input_file.hpp>

/// Features of glTF that change a mesh but are not read by assimp: extensions and numbers.
namespace PULSECAST_NAMESPACE::io::detail {

/// Removes the first value from JSON text. Returns it; empty if there is none. Source: RFC 8259.
[[nodiscard]] inline std::string_view take_json(std::string_view& text) {
  std::size_t end = 0, depth = 0;
  bool in_string = false;
  const auto is_end = [&] {
    return depth == 0 && std::string_view(",:]} \t\r\n").find(text[end]) != std::string_view::npos;
  };
  for (; end < text.size() && (in_string || !is_end()); ++end) {
    const char c = text[end];
    if (in_string && c == '\\')
      ++end;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '{' || c == '['))
      ++depth;
    else if (!in_string && (c == '}' || c == ']') && --depth == 0)
      return std::exchange(text, text.substr(end + 1)).substr(0, end + 1);
  }
  end = std::min(end, text.size());
  return std::exchange(text, text.substr(end)).substr(0, end);
}

/// Calls `visit` with name and value of each member of an object, or element of an array, unnamed.
void each_json(std::string_view value, const auto& visit) {
  const bool is_object = value.starts_with('{');
  if (!is_object && !value.starts_with('[')) return;
  value.remove_prefix(1);
  const auto skip = [&](std::string_view signs) {
    value.remove_prefix(std::min(value.find_first_not_of(signs), value.size()));
  };
  for (;;) {
    skip(", \t\r\n");
    std::string_view name = is_object ? take_json(value) : std::string_view();
    if (is_object) skip(": \t\r\n");
    const std::string_view item = take_json(value);
    if (item.empty()) return;
    if (name.size() >= 2) name = name.substr(1, name.size() - 2);
    visit(name, item);
  }
}

/// Value of a member of an object; empty without.
[[nodiscard]] inline std::string_view json_member(std::string_view object, std::string_view wanted) {
  std::string_view found;
  each_json(object, [&](std::string_view name, std::string_view value) {
    if (found.empty() && name == wanted) found = value;
  });
  return found;
}

/// JSON text of a glTF or GLB file; empty for another. Source: glTF 2.0, 4.4 (binary glTF layout).
[[nodiscard]] inline std::string_view gltf_text(std::string_view file) {
  if (file.size() >= 20 && file.starts_with("glTF")) {
    std::uint32_t size = 0;
    for (std::size_t k = 0; k < 4; ++k) size |= std::uint32_t{static_cast<unsigned char>(file[12 + k])} << 8 * k;
    return file.substr(20, size);
  }
  file = text::without_byte_order_mark(file);
  file.remove_prefix(std::min(file.find_first_not_of(" \t\r\n"), file.size()));
  return file.starts_with('{') ? file : std::string_view();
}

/// Refuses a glTF file that requires an extension which assimp does not read, or whose positions
/// are no floating-point numbers, as assimp takes them; notes extensions that move or hide meshes.
/// Source: glTF 2.0, 3.12 and 3.7.2.1 (positions are `float`); Khronos registry of extensions.
inline void check_gltf(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  // tested, with those for materials, which move nothing
  static constexpr std::array<std::string_view, 3> known{"KHR_draco_mesh_compression", "KHR_lights_punctual",
                                                         "KHR_texture_transform"};
  static constexpr std::array<std::string_view, 3> moving{"EXT_mesh_gpu_instancing", "CESIUM_RTC",
                                                          "KHR_node_visibility"};
  const MappedFile file(path, "a mesh file");
  const std::string_view text = gltf_text(file.text());
  const auto fail = [&](const auto&... problem) { detail::fail(path, problem...); };
  const auto unquoted = [](std::string_view s) { return s.size() >= 2 ? s.substr(1, s.size() - 2) : s; };
  each_json(text, [&](std::string_view name, std::string_view) {
    if (name.find('\\') != name.npos) fail("has the member ", text::quoted(name), ": expected a name without escapes");
  });
  each_json(json_member(text, "extensionsRequired"), [&](std::string_view, std::string_view value) {
    const std::string_view one = unquoted(value);
    if (!one.starts_with("KHR_materials_") && std::ranges::find(known, one) == known.end())
      fail("requires the glTF extension ", text::quoted(one),
           ", which is not supported: expected a file without it, as Blender exports it, or gltfpack with -noq");
  });
  each_json(json_member(text, "extensionsUsed"), [&](std::string_view, std::string_view value) {
    if (const std::string_view one = unquoted(value); std::ranges::find(moving, one) != moving.end())
      warnings.push_back(warning(path.string(), 0, "uses the glTF extension ", one, ", which has no effect"));
  });
  std::vector<std::string_view> types;
  each_json(json_member(text, "accessors"), [&](std::string_view, std::string_view accessor) {
    types.push_back(json_member(accessor, "componentType"));
  });
  each_json(json_member(text, "meshes"), [&](std::string_view, std::string_view mesh) {
    each_json(json_member(mesh, "primitives"), [&](std::string_view, std::string_view primitive) {
      const std::string_view positions = json_member(json_member(primitive, "attributes"), "POSITION");
      const auto number = text::number_in<std::size_t>(positions);
      if (number && *number < types.size() && types[*number] != "5126")
        fail("has positions of the component type ", types[*number], " (accessor ", *number,
             "): expected 5126, floating-point numbers");
    });
  });
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
