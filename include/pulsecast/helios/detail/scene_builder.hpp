// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SCENE_BUILDER_HPP
#define PULSECAST_HELIOS_DETAIL_SCENE_BUILDER_HPP

#include <numeric>

#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/material/variation.hpp>
#include <pulsecast/scene/on_ground.hpp>

namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE int SceneBuilder::runs() const {
  const auto later = [](int all, const SwapSettings& swap) { return all + swap.step; };
  int most = 1;
  for (const PartSettings& part : settings_.parts)
    most = std::max(most, std::accumulate(part.swaps.begin(), part.swaps.end(), 1, later));
  return most;
}

PULSECAST_INLINE std::vector<SurveyPart> SceneBuilder::parts(int run) {
  std::vector<SurveyPart> all;
  std::vector<int> lifted;  // `on_ground` of each part
  for (std::size_t i = 0; i < settings_.parts.size(); ++i) {
    const PartSettings& part = settings_.parts[i];
    const PartSource* source = &part.source;
    const TransformSettings* transform = &part.transform;
    int begin = 1;
    bool removed = false;
    for (const SwapSettings& swap : part.swaps) {
      if (run < begin) break;
      removed = swap.removes;
      source = swap.source ? &*swap.source : &part.source;
      transform = &swap.transform;
      begin += swap.step;
    }
    if (removed) continue;
    const std::size_t before = all.size();
    add(part, *source, *transform, i, all);
    const bool has_nodes = std::holds_alternative<MeshSource>(*source) && all.size() > before + 1;
    if (has_nodes && transform->on_ground != 0)
      warn({"part '" + part.id + "': onGround has no effect on a mesh file of several nodes, which keep their places"});
    lifted.resize(all.size(), has_nodes ? 0 : transform->on_ground);
  }
  warn(options_.spectra.warnings);
  warn_of_shared_objects(all);
  stand_on_ground(all, lifted);
  move(all);
  return all;
}

PULSECAST_INLINE void SceneBuilder::warn(const std::vector<std::string>& what) {
  for (const std::string& text : what)
    if (warned_.insert(text).second) warnings_.push_back(text);
}

/// Reads each source once.
PULSECAST_INLINE auto SceneBuilder::load(const PartSource& source) -> const std::vector<Loaded>& {
  for (const auto& [known, loaded] : loaded_)
    if (known == source) return loaded;
  auto made = std::visit([&](const auto& s) { return read(s); }, source);
  return loaded_.emplace_back(source, std::move(made)).second;
}

/// Loads files in order. A `SettingError` becomes a `FileError` of that file.
PULSECAST_INLINE auto SceneBuilder::each(const Files& files, const Load& load) -> std::vector<Loaded> {
  std::vector<Loaded> all;
  add_files(files);
  for (const std::filesystem::path& file : files) try {
      io::reading(file, [&] { load(file, all); });
    } catch (const SettingError& error) {
      throw FileError(file.string(), "", error.what());
    }
  return all;
}

PULSECAST_INLINE Material SceneBuilder::material(const MaterialSource& source) {
  if (source.file.empty()) return io::undescribed("default");
  add_files({source.file});
  const io::MaterialLibrary library = io::read_mtl(source.file, options_.spectra);
  warn(library.warnings);
  if (library.materials.empty() && !source.name) {
    warn({source.file.string() + ": holds no material: a reflectance of 0.5 is assumed"});
    return io::undescribed("default");
  }
  if (!source.name) return library.materials.begin()->second;
  const auto found = library.materials.find(*source.name);
  if (found != library.materials.end()) return found->second;
  std::string known;
  for (const auto& [name, m] : library.materials) known += (known.empty() ? "" : ", ") + name;
  throw FileError(source.file.string(), "", "holds no material '" + *source.name + "'; it has " + known);
}

PULSECAST_INLINE MaterialTable SceneBuilder::table(std::vector<Material> materials) const {
  if (options_.fixed_incidence)
    for (Material& m : materials) m.law = DirectionIndependent{};
  return material_table(std::move(materials));
}

/// Material of voxels, its variants in turn, or, if it has no class, copies with the classes of the voxels.
PULSECAST_INLINE MaterialTable SceneBuilder::assign_materials(const MaterialSource& source, VoxelData& voxels,
                                                              std::span<const std::uint32_t> classes) {
  std::vector<Material> all{material(source)};
  if (source.random > 0) {
    const auto count = static_cast<std::size_t>(source.random);
    const auto variants = vary_reflectance(all[0], count, std::min(1.0, source.random_range), options_.seed);
    all.insert(all.end(), variants.begin(), variants.end());
    const auto turns = assign_round_robin(voxels.cells.size(), static_cast<std::uint32_t>(all.size()));
    voxels.materials.assign(turns.begin(), turns.end());
  } else if (!classes.empty() && all[0].classification == 0) {
    std::map<std::uint32_t, std::uint16_t> materials{{0, std::uint16_t{0}}};
    voxels.materials.resize(voxels.cells.size());
    for (std::size_t i = 0; i < voxels.materials.size(); ++i) {
      const std::uint32_t number = std::min<std::uint32_t>(classes[i], 65535);
      const auto [known, is_new] = materials.try_emplace(number, static_cast<std::uint16_t>(all.size()));
      if (is_new) all.emplace_back(all[0]).classification = static_cast<std::uint16_t>(number);
      voxels.materials[i] = known->second;
    }
  }
  return table(std::move(all));
}

PULSECAST_INLINE Placement SceneBuilder::placement_of(const PartSettings& part, const TransformSettings& transform) {
  Placement placement{.scale = transform.scale, .translation = transform.translation};
  for (const RotationList& turns : transform.rotations) placement.rotation = turns.rotation() * placement.rotation;
  placement.rotation = normalize(placement.rotation);
  naming("part '" + part.id + "'", [&] { placement.validate(); });
  return placement;
}

PULSECAST_INLINE void SceneBuilder::add(const PartSettings& part, const PartSource& source,
                                        const TransformSettings& transform, std::size_t place,
                                        std::vector<SurveyPart>& all) {
  const Placement placement = placement_of(part, transform);
  const auto number = text::number_in<ObjectId>(part.id);
  ObjectId object = number.value_or(static_cast<ObjectId>(place));
  if (!number && !part.id.empty())
    warn({text::joined({"part '", part.id, "': its id is not a number; the object id of its points is its place in ",
                        "the scene, ", std::to_string(place)})});
  const Attributes numbers = part.named_numbers();
  for (const Loaded& loaded : load(source)) {
    const Placement& inner = loaded.placement;
    Placement placed = placement;
    if (!inner.identity())
      placed = {normalize(placement.rotation * inner.rotation), placement.scale * inner.scale,
                placement.point(inner.translation)};
    const bool has_both = !loaded.name.empty() && !part.id.empty();
    const std::string name = part.id + (has_both ? "/" : "") + loaded.name;
    all.push_back({loaded.geometry, loaded.materials, placed, object++, name, {}, numbers});
    const Box box = box_of(all.back());
    const double extent = std::fmax(max_norm(box.min), max_norm(box.max));
    if (!(extent <= 1e18))
      throw SettingError("part '" + part.id + "': place", extent, "m", "within 1e18 m of the origin");
    settings_of_.resize(all.size());
    settings_of_.back() = &part;
  }
}

/// Warns of the first two parts with the same number in their points.
PULSECAST_INLINE void SceneBuilder::warn_of_shared_objects(const std::vector<SurveyPart>& all) {
  std::map<ObjectId, const PartSettings*> first;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [at, is_new] = first.try_emplace(all[i].object, settings_of_[i]);
    if (is_new) continue;
    warn({text::joined({"the parts '", at->second->id, "' and '", settings_of_[i]->id, "' have the same object id, ",
                        std::to_string(all[i].object), ": their points cannot be distinguished"})});
    return;
  }
}

PULSECAST_INLINE Box SceneBuilder::box_of(const SurveyPart& part) {
  return visit_shape([&](const auto& shape) { return part.placement.box(shape->bounds()); }, part.geometry);
}

PULSECAST_INLINE void SceneBuilder::stand_on_ground(std::vector<SurveyPart>& all, const std::vector<int>& lifted) {
  if (std::ranges::count(lifted, 0) == std::ssize(lifted)) return;
  std::vector<SurveyPart> fixed;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (lifted[i] == 0) fixed.push_back(all[i]);
  const SurveyScene carriers(std::move(fixed), {.to = 1});
  const auto ground = [&](const Vec2& at) { return carriers.ground_height(at); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (lifted[i] == 0) continue;
    const auto how = lifted[i] == -1 ? GroundPlacement::touching : GroundPlacement::lowest_point;
    if (auto stood = on_ground(all[i], ground, how))
      all[i] = std::move(*stood);
    else
      warn({"part '" + all[i].name + "': there is no ground under it: it is not moved"});
  }
}

PULSECAST_INLINE void SceneBuilder::move(std::vector<SurveyPart>& all) {
  Box box;
  for (const SurveyPart& part : all) box.extend(box_of(part));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PartSettings& part = *settings_of_[i];
    double step = settings_.dynamic_step * part.dynamic_step / options_.pulse_rate;  // [s]
    if (const auto scene = settings_.dynamic_interval)
      step = *scene * std::max(1.0, std::floor(part.dynamic_interval.value_or(0) / *scene));
    if (!part.motions.empty()) all[i].motion = part_motion(part, box.centre(), step);
  }
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
