// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_OBJECT_ATTRIBUTES_HPP
#define PULSECAST_SCENE_OBJECT_ATTRIBUTES_HPP

#include <map>

#include <pulsecast/scene/part.hpp>

namespace PULSECAST_NAMESPACE {

/// Named numbers of the objects of a scene, which points get by the id of their object.
class ObjectAttributes {
 public:
  ObjectAttributes() = default;
  /// Those of parts, such as `scene.parts()`. Names come in order of first use. An object of
  /// several parts has all their attributes.
  /// @throws SettingError if two parts of an object have different values of one name
  template <class PartOfScene>
  explicit ObjectAttributes(std::span<const PartOfScene> parts) {
    std::map<ObjectId, std::map<std::string, double>> all;
    for (const PartOfScene& part : parts) {
      if (!part.attributes) continue;
      for (const auto& [name, value] : *part.attributes) {
        if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
        const double known = all[part.object].emplace(name, value).first->second;
        if (!(known == value) && !(known != known && value != value))
          throw_setting_error("Part::attributes '" + name + "' of object " + std::to_string(part.object), value, "",
                              "as of its other parts");
      }
    }
    for (const auto& [object, values] : all) {
      objects_.push_back(object);
      for (const std::string& name : names_) {
        const auto found = values.find(name);
        values_.push_back(found == values.end() ? unknown : found->second);
      }
    }
    unknown_.assign(names_.size(), unknown);
  }

  /// Names, in order of the values.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] bool empty() const noexcept { return names_.empty(); }

  /// Values of an object, one a name; NaN where it has none.
  [[nodiscard]] std::span<const double> of(ObjectId object) const noexcept {
    const auto found = std::lower_bound(objects_.begin(), objects_.end(), object);
    if (found == objects_.end() || *found != object) return unknown_;
    const auto i = static_cast<std::size_t>(found - objects_.begin());
    return {values_.data() + i * names_.size(), names_.size()};
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::vector<std::string> names_{};
  std::vector<ObjectId> objects_{};  ///< ascending
  std::vector<double> values_{};     ///< of each object, one a name
  std::vector<double> unknown_{};    ///< of an object without any
};

}  // namespace PULSECAST_NAMESPACE

#endif
