// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SCENE_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SCENE_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <pugixml.hpp>

#include <pulsecast/base/text.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/asset_search.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/detail/xml/motion.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<scene>`, its parts, and their placing filters.
namespace PULSECAST_NAMESPACE::helios::xml {

/// `filepath`, `efilepath`, or, as an extension, `filepaths` with `|` between them.
inline void files(XmlInput& io, std::vector<std::filesystem::path>& paths) {
  const auto take = [&](const char* name, const std::string& text, const AssetMatch& match) {
    io.take(name, text, match);
    paths.insert(paths.end(), match.files.begin(), match.files.end());
  };
  const auto one = io.given("filepath"), by_pattern = io.given("efilepath"), list = io.given("filepaths");
  if (by_pattern) {
    take("efilepath", *by_pattern, io.search().find_all(*by_pattern));
  } else if (list) {
    for (std::string_view rest = *list; paths.size() < 100'000;) {
      const std::size_t end = rest.find('|');
      take("filepaths", std::string(rest.substr(0, end)), io.search().find(std::string(rest.substr(0, end))));
      if (end == std::string_view::npos) break;
      rest.remove_prefix(end + 1);
    }
  } else if (one) {
    take("filepath", *one, io.search().find(*one));
  } else {
    io.require({"filepath"});
  }
}
inline void files(XmlOutput& io, std::vector<std::filesystem::path>& paths) {
  if (paths.size() == 1) return io.file("filepath", paths.front());
  std::string text;
  for (const std::filesystem::path& path : paths)
    text.append(text.empty() ? "" : "|").append(std::filesystem::absolute(path).string());
  io.put("filepaths", text);
}

/// A loading filter.
inline void fields(FieldIo& io, PartSource& source) {
  std::visit(
      [&](auto& of_kind) {
        if (io.reads())
          files(input(io), of_kind.files);
        else
          files(output(io), of_kind.files);
        of_kind.fields(io);
      },
      source);
}

/// Types of loading filters, in the order of `PartSource`.
inline constexpr std::array loaders{"objloader", "geotiffloader", "xyzloader", "detailedvoxels", "meshloader"};
static_assert(loaders.size() == std::variant_size_v<PartSource>);

inline constexpr double least_scale = 1e-30, most_scale = 1e9;  ///< of a part, except 0, which has no effect
inline constexpr int most_on_ground = 1'000'000;                ///< `onGround` of a part

/// Writes the filters of a part or swap.
inline void filters(XmlOutput& io, PartSource* source, TransformSettings& transform) {
  const auto filter = [&](const char* type) {
    pugi::xml_node node = io.node().append_child("filter");
    node.append_attribute("type").set_value(type);
    return XmlOutput(node, true);
  };
  if (source) {
    XmlOutput loader = filter(loaders[source->index()]);
    fields(loader, *source);
  }
  if (transform.scale != 1) filter("scale").number("scale", transform.scale, units::one, least_scale, most_scale);
  for (RotationList& rotation : transform.rotations) {
    pugi::xml_node param = filter("rotate").node().append_child("param");
    param.append_attribute("type").set_value("rotation");
    param.append_attribute("key").set_value("rotation");
    XmlOutput list(param);
    rotation.fields(list);
  }
  if (transform.translation == Vec3{} && transform.on_ground == 0) return;
  XmlOutput translate = filter("translate");
  translate.vector("offset", transform.translation, FieldIo::max_coordinate);
  translate.whole("onGround", transform.on_ground, -most_on_ground, most_on_ground);
}

/// Source of a loading filter by its type; empty for another filter.
template <std::size_t kind = 0>
[[nodiscard]] std::optional<PartSource> source_of(std::string_view type) {
  if constexpr (kind < loaders.size()) {
    if (text::is_same_word(type, loaders[kind])) return PartSource(std::in_place_index<kind>);
    return source_of<kind + 1>(type);
  }
  return std::nullopt;
}

/// Reads the filters of a part or swap.
inline void filters(XmlInput& io, std::optional<PartSource>& source, TransformSettings& transform) {
  static const std::vector<std::string> types{"objloader",  "geotiffloader", "xyzloader", "detailedvoxels",
                                              "meshloader", "scale",         "rotate",    "translate"};
  io.know({}, {"filter"});
  bool is_scaled = false, is_translated = false;
  const auto once = [&](pugi::xml_node node, bool& before) {
    if (std::exchange(before, true))
      io.report().warn(io.document().place(node),
                       "a second filter " + text::quoted(node.attribute("type").value()) + ": it replaces the first");
  };
  for (pugi::xml_node node = io.node().child("filter"); node; node = node.next_sibling("filter")) {
    XmlInput filter(io.document(), node, io.report(), io.search(), true);
    const std::string_view type = node.attribute("type").value();
    const auto is = [&](std::string_view name) { return text::is_same_word(type, name); };
    if (std::optional<PartSource> made = source_of(type)) {
      if (source) io.report().fault(io.document().place(node), "a second loading filter: expected one per part");
      source = std::move(made);
      fields(filter, *source);
    } else if (is("scale")) {
      once(node, is_scaled);
      filter.require({"scale"});
      double scale = 0;
      filter.number("scale", scale, units::one, 0, most_scale);
      if (scale != 0) transform.scale = scale;
      if (scale == 0 && filter.has("scale")) filter.warn("scale", "a scale of 0 has no effect");
      if (scale > 0 && scale < least_scale)
        filter.fault("scale", "the scale is less than 1e-30: expected 0, or from there to 1e9");
    } else if (is("rotate")) {
      filter.require({"rotation"});
      filter.know({"rotation"});
      if (const pugi::xml_node param = filter.param("rotation")) {
        XmlInput list(io.document(), param, io.report(), io.search());
        list.know({"type", "key", "value"});
        transform.rotations.emplace_back().fields(list);
        list.finish();
      }
    } else if (is("translate")) {
      once(node, is_translated);
      filter.require({"offset"});
      transform.translation = {};
      transform.on_ground = 0;
      filter.vector("offset", transform.translation, FieldIo::max_coordinate);
      filter.whole("onGround", transform.on_ground, -most_on_ground, most_on_ground);
    } else {
      io.report().fault(io.document().place(node, "type"),
                        XmlInput::said("type", type) + " of a filter is not known" + text::suggestion(type, types));
      filter.check_filter();
      continue;
    }
    filter.finish();
  }
}

inline void fields(FieldIo& io, SwapSettings& swap) {
  swap.fields(io);
  if (!io.reads()) {
    if (swap.removes) io.flag("force_null", swap.removes);
    return filters(output(io), swap.source ? &*swap.source : nullptr, swap.transform);
  }
  bool keeps = true;
  io.flag("keepCRS", keeps);
  if (!keeps) io.warn("keepCRS", "keepCRS of false has no effect: coordinates are those of the files in all runs");
  swap.removes = input(io).given("force_null").has_value();
  filters(input(io), swap.source, swap.transform);
}

/// True if the successor of a sequence is not one of its part.
inline bool lacks_next(const PartSettings& part, const MotionSequenceSettings& sequence) {
  const auto is_next = [&](const MotionSequenceSettings& other) { return other.id == sequence.next; };
  return sequence.next && std::none_of(part.motions.begin(), part.motions.end(), is_next);
}

/// Attributes and children of a part, except its geometry and id.
inline void dynamic_fields(FieldIo& io, PartSettings& part) {
  part.fields(io);
  io.children("dmotion", part.motions,
              [](FieldIo& inner, MotionSequenceSettings& sequence) { fields(inner, sequence); });
  io.children("swap", part.swaps, [](FieldIo& inner, SwapSettings& swap) { fields(inner, swap); });
  io.children("attribute", part.attributes);
  valid(io, [&] { static_cast<void>(part.named_numbers()); });
  io.without_effect({"kdtDynStep", "kdtDynTimeStep"}, "has no effect: each pulse hits a part at its pose of that time");
  const auto unknown = [](const MotionSequenceSettings& sequence) {
    return XmlInput::said("next", *sequence.next) + ": there is no such <dmotion> in this part";
  };
  if (!io.reads()) {
    for (const MotionSequenceSettings& sequence : part.motions)
      if (lacks_next(part, sequence)) io.fault("next", unknown(sequence));
    return;
  }
  XmlInput& element = input(io);
  pugi::xml_node node = element.node().child("dmotion");
  if (part.motions.size() > 1000) io.fault("", "<part> holds more than 1000 <dmotion>");
  if (element.report().is_full() || part.motions.size() > 1000) return;
  for (const MotionSequenceSettings& sequence : part.motions) {
    if (lacks_next(part, sequence)) element.report().fault(element.document().place(node, "next"), unknown(sequence));
    node = node.next_sibling("dmotion");
  }
}

/// Attributes of a scene, its light and media.
inline void scene_fields(FieldIo& io, SceneSettings& scene) {
  scene.fields(io);
  io.children("light", scene.light);
  io.children("medium", scene.media, [](FieldIo& inner, MediumSettings& medium) {
    medium.fields(inner);
    valid(inner, [&] { medium.validate(); });
  });
  if (io.reads() && !input(io).report().is_clean()) return;
  valid(io, [&] { (void)scene.air(MediumSettings::known_wavelength); });
}

/// Reads a scene. A part of several files and no id becomes several parts, each with a number.
inline void fields(XmlInput& io, SceneSettings& scene) {
  io.know({}, {"part"});
  scene_fields(io, scene);
  if (scene.light.size() > 1) io.report().warn(io.place(), "<scene> holds a second <light>: the first is used");
  std::size_t number = 0;
  for (pugi::xml_node node = io.node().child("part"); node; node = node.next_sibling("part")) {
    XmlInput inner(io.document(), node, io.report(), io.search());
    PartSettings part;
    std::optional<PartSource> source;
    const auto id = inner.given("id");
    filters(inner, source, part.transform);
    dynamic_fields(inner, part);
    inner.finish();
    if (!source) {
      io.report().warn(inner.place(), "<part> has no loading filter: it is left out");
      ++number;
      continue;
    }
    std::vector<std::filesystem::path> loaded;
    std::visit([&](auto& of_kind) { loaded = std::move(of_kind.files); }, *source);
    const auto* const rasters = std::get_if<GeoTiffSource>(&*source);
    const bool is_split = !id && loaded.size() > 1 && !(rasters && rasters->mosaic);
    for (std::size_t i = 0; i < (is_split ? loaded.size() : 1); ++i) {
      PartSettings one = part;
      one.id = id ? *id : std::to_string(number + i);
      one.source = *source;
      std::visit([&](auto& of_kind) { of_kind.files = is_split ? std::vector{loaded[i]} : loaded; }, one.source);
      scene.parts.push_back(std::move(one));
    }
    number += is_split ? loaded.size() : 1;
  }
  if (scene.parts.empty()) io.report().fault(io.place(), "<scene> holds no <part> with a loading filter");
}

/// Writes a scene.
inline void fields(XmlOutput& io, SceneSettings& scene) {
  scene_fields(io, scene);
  for (PartSettings& part : scene.parts)
    io.child("part", "part '" + part.id + "'", [&](XmlOutput& inner) {
      inner.text("id", part.id);
      filters(inner, &part.source, part.transform);
      dynamic_fields(inner, part);
    });
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
