// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SCENE_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SCENE_HPP

#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>

/// `<scene>`, its parts, their motions and placing filters.
namespace PULSECAST_NAMESPACE::helios::xml {

[[nodiscard]] inline bool has_direction(const Vec3& v) { return length(v) > 1e-9; }

/// Axis or normal of a motion.
inline void axis(FieldIo& io, const char* name, Vec3& v) {
  io.require({name});
  io.vector(name, v, 1e9);
  if (!has_direction(v)) io.fault(name, std::string(name) + " is too short for a direction");
}

inline void angle(FieldIo& io, double& value) {
  io.require({"angle"});
  io.number("angle", value, units::degree, -36000, 36000);
}

inline void fields(FieldIo& /*io*/, NoMotion& /*motion*/) {}

inline void fields(FieldIo& io, TranslationMotion& motion) {
  io.require({"vec"});
  io.vector("vec", motion.by, FieldIo::max_coordinate);
}

inline void fields(FieldIo& io, RotationMotion& rotation) {
  io.require({"axis"});
  io.vector("axis", rotation.axis, 1e9);
  angle(io, rotation.angle);
  if (rotation.glide) {
    io.require({"glide"});
    io.number("glide", *rotation.glide, units::one, -1e9, 1e9);
  } else {
    io.vector("center", rotation.center, FieldIo::max_coordinate);
  }
  if (has_direction(rotation.axis)) return;
  if (rotation.angle != 0) return io.fault("axis", "axis is too short for a direction");
  io.warn("axis", "axis is too short for a direction, and angle is 0: the motion does nothing");
}

inline void fields(FieldIo& io, ReflectionMotion& plane) {
  axis(io, "ortho", plane.normal);
  if (!plane.shift) return;
  io.require({"shift"});
  io.vector("shift", *plane.shift, FieldIo::max_coordinate);
  if (std::abs(dot(*plane.shift, plane.normal)) > 1e-6 * length(*plane.shift) * length(plane.normal))
    io.fault("shift", "shift is not along the plane: expected it at right angles to ortho");
}

inline void fields(FieldIo& io, RotoreflectionMotion& motion) {
  axis(io, "axis", motion.axis);
  angle(io, motion.angle);
  io.vector("center", motion.center, FieldIo::max_coordinate);
}

inline void fields(FieldIo& io, MotionSettings& motion) {
  static const std::array<decltype(motion.kind), 7> kinds{NoMotion{},
                                                          TranslationMotion{},
                                                          RotationMotion{},
                                                          RotationMotion{.glide = 0},
                                                          ReflectionMotion{},
                                                          ReflectionMotion{.shift = Vec3{}},
                                                          RotoreflectionMotion{}};
  const auto* const rotation = std::get_if<RotationMotion>(&motion.kind);
  const auto* const plane = std::get_if<ReflectionMotion>(&motion.kind);
  const bool shifts = (rotation && rotation->glide) || (plane && plane->shift);
  std::size_t kind = 0;
  while (kinds[kind].index() != motion.kind.index()) ++kind;
  kind += shifts ? 1 : 0;
  io.require({"type"});
  io.choice("type", kind,
            {{"identity", 0},
             {"translation", 1},
             {"rotation", 2},
             {"helical", 3},
             {"reflection", 4},
             {"glideplane", 5},
             {"rotsym", 6}});
  if (io.reads()) motion.kind = kinds[kind];
  std::visit([&](auto& of_kind) { fields(io, of_kind); }, motion.kind);
  const auto* const turn = std::get_if<RotationMotion>(&motion.kind);
  if (io.reads() && turn && turn->angle == 0 && !has_direction(turn->axis)) motion.kind = NoMotion{};
  io.flag("selfMode", motion.about_itself);
  io.number("autoCRS", motion.shift_factor, units::one, -1e6, 1e6);
}

inline void fields(FieldIo& io, MotionSequenceSettings& sequence) {
  sequence.fields(io);
  io.children("motion", sequence.motions, [](FieldIo& inner, MotionSettings& motion) { fields(inner, motion); });
  if (const std::string problem = motion_problem(sequence); !problem.empty())
    io.fault("", "<dmotion id=" + text::quoted(sequence.id) + "> is not supported: expected " + problem);
}

/// `filepath`, `efilepath`, or, as an extension, `filepaths` with `|` between them.
inline void files(XmlInput& io, std::vector<std::filesystem::path>& paths) {
  const auto take = [&](const char* name, const std::string& text, const AssetMatch& match) {
    io.take(name, text, match);
    paths.insert(paths.end(), match.files.begin(), match.files.end());
  };
  const auto one = io.given("filepath"), by_pattern = io.given("efilepath"), list = io.given("filepaths");
  if (by_pattern) return take("efilepath", *by_pattern, io.search().find_all(*by_pattern));
  if (!list && !one) return io.require({"filepath"});
  if (!list) return take("filepath", *one, io.search().find(*one));
  for (std::size_t at = 0, end = 0; end != list->npos && paths.size() < 100'000; at = end + 1) {
    end = list->find('|', at);
    const std::string path = list->substr(at, end - at);
    take("filepaths", path, io.search().find(path));
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
  const auto fields_of = [&](auto& of_kind) {
    io.reads() ? files(input(io), of_kind.files) : files(output(io), of_kind.files);
    of_kind.fields(io);
  };
  std::visit(fields_of, source);
}

/// Types of filters; the first are loading filters, in the order of `PartSource`.
inline constexpr std::array filter_types{"objloader",  "geotiffloader", "xyzloader", "detailedvoxels",
                                         "meshloader", "scale",         "rotate",    "translate"};

inline constexpr double least_scale = 1e-30, most_scale = 1e9;  ///< of a part
inline constexpr int most_on_ground = 1'000'000;                ///< `onGround` of a part

/// Writes the filters of a part or swap.
inline void filters(XmlOutput& io, PartSource* source, TransformSettings& transform) {
  const auto filter = [&](const char* type) {
    pugi::xml_node node = io.node().append_child("filter");
    node.append_attribute("type").set_value(type);
    return XmlOutput(node, true);
  };
  if (source) {
    XmlOutput loader = filter(filter_types[source->index()]);
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

/// Reads the filters of a part or swap.
inline void filters(XmlInput& io, std::optional<PartSource>& source, TransformSettings& transform) {
  static const std::array<PartSource, std::variant_size_v<PartSource>> sources{
      ObjSource{}, GeoTiffSource{}, XyzSource{}, VoxelSource{}, MeshSource{}};
  io.know({}, {"filter"});
  bool is_scaled = false, is_translated = false;
  for (const pugi::xml_node node : io.node().children("filter")) {
    XmlInput filter(io.document(), node, io.report(), io.search(), true);
    const std::string type = node.attribute("type").value();
    const auto once = [&](bool& before) {
      if (std::exchange(before, true))
        filter.warn("", "a second filter " + text::quoted(type) + ": it replaces the first");
    };
    const auto is = [&](std::string_view name) { return text::is_same_word(type, name); };
    const auto kind = static_cast<std::size_t>(std::ranges::find_if(filter_types, is) - filter_types.begin());
    if (kind < sources.size()) {
      if (source) filter.fault("", "a second loading filter: expected one per part");
      source = sources[kind];
      fields(filter, *source);
    } else if (is("scale")) {
      once(is_scaled);
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
      if (const pugi::xml_node param = filter.param("rotation"))
        io.inside(param, [&](XmlInput& list) {
          list.know({"type", "key"});
          list.without_effect({"value"});
          transform.rotations.emplace_back().fields(list);
        });
    } else if (is("translate")) {
      once(is_translated);
      filter.require({"offset"});
      transform.translation = {};
      transform.on_ground = 0;
      filter.vector("offset", transform.translation, FieldIo::max_coordinate);
      filter.whole("onGround", transform.on_ground, -most_on_ground, most_on_ground);
    } else {
      io.report().fault(io.document().place(node, "type"),
                        said("type", type) + " of a filter is not known" +
                            text::suggestion(type, std::vector<std::string>(filter_types.begin(), filter_types.end())));
      filter.check_attributes(node, {"type"});
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
  const auto is_next = [&](const auto& other) { return other.id == sequence.next; };
  return sequence.next && std::ranges::none_of(part.motions, is_next);
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
    return said("next", *sequence.next) + ": there is no such <dmotion> in this part";
  };
  if (!io.reads()) {
    for (const MotionSequenceSettings& sequence : part.motions)
      if (lacks_next(part, sequence)) io.fault("next", unknown(sequence));
    return;
  }
  if (part.motions.size() > 1000) return io.fault("", "<part> holds more than 1000 <dmotion>");
  const XmlInput& element = input(io);
  std::size_t i = 0;
  for (const pugi::xml_node node : element.node().children("dmotion"))
    if (const MotionSequenceSettings& sequence = part.motions[i++]; lacks_next(part, sequence))
      element.report().fault(element.document().place(node, "next"), unknown(sequence));
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
  scene_fields(io, scene);
  if (scene.light.size() > 1) io.warn("", "<scene> holds a second <light>: the first is used");
  std::size_t number = 0;
  io.each("part", 0, [&](FieldIo& inner, std::size_t) {
    PartSettings part;
    std::optional<PartSource> source;
    const auto id = input(inner).given("id");
    filters(input(inner), source, part.transform);
    dynamic_fields(inner, part);
    if (!source) {
      ++number;
      return inner.warn("", "<part> has no loading filter: it is left out");
    }
    part.source = *source;
    const std::vector<std::filesystem::path> loaded = std::visit([](auto& of_kind) { return of_kind.files; }, *source);
    const auto* const rasters = std::get_if<GeoTiffSource>(&*source);
    const bool is_split = !id && loaded.size() > 1 && !(rasters && rasters->mosaic);
    for (std::size_t i = 0; i < (is_split ? loaded.size() : 1); ++i) {
      part.id = id.value_or(std::to_string(number++));
      if (is_split) std::visit([&](auto& of_kind) { of_kind.files = {loaded[i]}; }, part.source);
      scene.parts.push_back(part);
    }
  });
  if (scene.parts.empty()) io.fault("", "<scene> holds no <part> with a loading filter");
}

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
