// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_SCENE_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_SCENE_HPP

#include <pulsecast/helios/detail/settings/mount.hpp>
#include <pulsecast/helios/detail/settings/part_source.hpp>
#include <pulsecast/material/media.hpp>
#include <pulsecast/scene/part.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Placement: `translation + scale * (rotations * vertex)`. Filters `rotate`, `scale`, `translate`.
struct TransformSettings {
  double scale = 1;                       ///< `scale`
  std::vector<RotationList> rotations{};  ///< in sequence, about fixed axes; `rotation`
  Vec3 translation{};                     ///< `offset` [m]
  int on_ground = 0;                      ///< not 0: by its lowest point; -1: at first contact. `onGround`

  bool operator==(const TransformSettings&) const = default;
};

/// `<motion type="identity">`
struct NoMotion {
  bool operator==(const NoMotion&) const = default;
};

/// `<motion type="translation">`
struct TranslationMotion {
  Vec3 by{};  ///< `vec` [m]

  bool operator==(const TranslationMotion&) const = default;
};

/// `<motion type="rotation">` and, with `glide`, `<motion type="helical">`
struct RotationMotion {
  Vec3 axis = axis::up;           ///< non-zero, any length; `axis`
  double angle = 0;               ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};   ///< point on the axis, default the origin; `center` [m]
  std::optional<double> glide{};  ///< helical only: shift along it, in its lengths; `glide`

  bool operator==(const RotationMotion&) const = default;
};

/// `<motion type="reflection">` and, with `shift`, `<motion type="glideplane">`
struct ReflectionMotion {
  Vec3 normal = axis::up;       ///< of a plane through the origin; non-zero, any length. `ortho`
  std::optional<Vec3> shift{};  ///< along the plane: glide plane only. `shift` [m]

  bool operator==(const ReflectionMotion&) const = default;
};

/// `<motion type="rotsym">`: a rotation, then a reflection at the plane normal to the axis.
struct RotoreflectionMotion {
  Vec3 axis = axis::up;          ///< non-zero, any length; `axis`
  double angle = 0;              ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};  ///< `center` [m]

  bool operator==(const RotoreflectionMotion&) const = default;
};

/// Motion of a part in each step: `<motion>`.
struct MotionSettings {
  std::variant<NoMotion, TranslationMotion, RotationMotion, ReflectionMotion, RotoreflectionMotion> kind{};
  bool about_itself = false;  ///< in a frame at the part's centre; `selfMode`
  double shift_factor = 0;    ///< multiple of the scene's centre that is added; `autoCRS`

  bool operator==(const MotionSettings&) const = default;
};

/// Motions of a part for a number of steps, and their successor: `<dmotion>`.
struct MotionSequenceSettings {
  std::string id{};                       ///< `id`
  int loop = 1;                           ///< number of steps; 0: forever. `loop`
  std::optional<std::string> next{};      ///< id of the next sequence, default rest; `next`
  std::vector<MotionSettings> motions{};  ///< all applied in each step, in this order

  void fields(FieldIo& io) {
    io.require({"id", "loop"});
    io.text("id", id);
    io.whole("loop", loop, 0, 2'000'000'000);
    io.text("next", next);
  }
  bool operator==(const MotionSequenceSettings&) const = default;
};

/// Replacement of a part in later runs of the survey: `<swap>`.
struct SwapSettings {
  int step = 1;                        ///< number of runs; `swapStep`
  bool removes = false;                ///< removes the part; `force_null`
  std::optional<PartSource> source{};  ///< default: that of the part
  TransformSettings transform{};

  void fields(FieldIo& io) { io.whole("swapStep", step, 1, 1'000'000); }
  void validate() const {
    check_fields(*this);
    if (source) std::visit([](const auto& one) { check_fields(one); }, *source);
  }
  bool operator==(const SwapSettings&) const = default;
};

/// Named number of the points of a part: `<attribute>`, of this library.
struct AttributeSettings {
  std::string name{};  ///< name of the column; `name`
  double value = 0;    ///< number; `value`
  void fields(FieldIo& io) {
    if (io.reads()) io.require({"name", "value"});
    io.text("name", name);
    io.number("value", value, units::one, -FieldIo::any, FieldIo::any);
  }
  bool operator==(const AttributeSettings&) const = default;
};

/// `<part>`
struct PartSettings {
  std::string id{};                               ///< `id`; default: number of files before it
  PartSource source{};                            ///< loading filter
  TransformSettings transform{};                  ///< placing filters
  int dynamic_step = 1;                           ///< scene updates per motion step; `dynStep`
  std::optional<double> dynamic_interval{};       ///< if the scene has one; `dynTimeStep` [s]
  std::vector<MotionSequenceSettings> motions{};  ///< the first one begins; none: at rest
  std::vector<SwapSettings> swaps{};              ///< in sequence
  std::vector<AttributeSettings> attributes{};    ///< named numbers, each name once

  void fields(FieldIo& io) {
    io.whole("dynStep", dynamic_step, 1, 1'000'000'000);
    io.number("dynTimeStep", dynamic_interval, units::second, 1e-9, 1e6);
  }
  void validate() const {
    std::visit([](const auto& one) { check_fields(one); }, source);
    check_fields(*this);
    for (const MotionSequenceSettings& sequence : motions) check_fields(sequence);
    for (const SwapSettings& swap : swaps) swap.validate();
    static_cast<void>(named_numbers());
  }
  /// The attributes of a part. @throws SettingError for a name that is empty or comes twice
  [[nodiscard]] Attributes named_numbers() const {
    std::vector<Attribute> all;
    for (const auto& [name, value] : attributes) all.push_back({name, value});
    return all.empty() ? Attributes() : pulsecast::attributes(std::move(all));
  }
  bool operator==(const PartSettings&) const = default;
};

/// Multi-bounce light from smooth surfaces: `<light>`, of this library. See `LightPaths`.
struct LightSettings {
  int passages = 8;             ///< maximum number of mirrors and faces on a path; `passages`
  double share_min = 1e-4;      ///< minimum share of a subray that is followed; `leastShare`
  int orders = 1;               ///< maximum number of surfaces that scatter it; `orders`
  int paths = 8;                ///< random paths of a pulse, for more than one order; `paths`
  double field_of_view = 2e-3;  ///< receiver's full angle, if orders > 1; `fieldOfView_deg` [rad]

  void fields(FieldIo& io) {
    io.whole("passages", passages, 0, 32);
    io.number("leastShare", share_min, units::one, 0, 1);
    io.whole("orders", orders, 1, 64);
    io.whole("paths", paths, 1, 100'000);
    io.number("fieldOfView_deg", field_of_view, units::degree, 0, 360);
  }
  bool operator==(const LightSettings&) const = default;
};

/// Media by visibility or rate: the functions of `material/weather.hpp`.
enum class MediumPreset : std::uint8_t { none, fog, haze, dust, smoke, rain, snow };

/// Medium in the air: `<medium>`, of this library. As `MediumRegion`.
struct MediumSettings {
  MediumPreset preset = MediumPreset::none;  ///< instead of coefficients; `preset`
  std::optional<double> visibility{};        ///< of fog, haze, dust and smoke; `visibility_m` [m]
  std::optional<double> rate{};              ///< of rain and snow, melted; `rate_mmPerH` [mm/h]
  double absorption = 0;                     ///< `absorption_perM` [1/m]
  double scattering = 0;                     ///< `scattering_perM` [1/m]
  double backscatter = 0;                    ///< `backscatter_perMSr` [1/(m sr)]
  std::optional<Vec3> min{};                 ///< lower corner of its box, default none; `min` [m]
  std::optional<Vec3> max{};                 ///< upper corner of its box, default none; `max` [m]

  /// The same for `LightPaths`, for a wavelength [m]. @throws SettingError for values out of range
  [[nodiscard]] MediumRegion region(double wavelength) const {
    const double seen = visibility.value_or(0), fallen = rate.value_or(0);
    const auto unbounded = [&]() -> MediumRegion {
      switch (preset) {
        case MediumPreset::fog:
          return {.medium = fog(seen, wavelength)};
        case MediumPreset::haze:
          return {.medium = haze(seen, wavelength)};
        case MediumPreset::dust:
          return {.medium = dust(seen, wavelength)};
        case MediumPreset::smoke:
          return {.medium = smoke(seen, wavelength)};
        case MediumPreset::rain:
          return MediumRegion::of(rain(fallen, wavelength));
        case MediumPreset::snow:
          return MediumRegion::of(snow(fallen, wavelength));
        case MediumPreset::none:
          break;
      }
      return {.medium = {.absorption = absorption, .scattering = scattering, .backscatter = backscatter}};
    };
    MediumRegion made = unbounded();
    const Box all = everywhere();
    made.bounds = {min.value_or(all.min), max.value_or(all.max)};
    return made;
  }
  void fields(FieldIo& io) {
    using enum MediumPreset;
    io.choice("preset", preset,
              {{"fog", fog}, {"haze", haze}, {"dust", dust}, {"smoke", smoke}, {"rain", rain}, {"snow", snow}});
    io.number("visibility_m", visibility, units::metre, 1, 1e5);
    io.number("rate_mmPerH", rate, units::millimetre_per_hour, 0.1, 300);
    io.number("absorption_perM", absorption, units::per_metre, 0, 1e6);
    io.number("scattering_perM", scattering, units::per_metre, 0, 1e6);
    io.number("backscatter_perMSr", backscatter, units::per_metre_steradian, 0, 1e6);
    io.vector("min", min, FieldIo::max_coordinate);
    io.vector("max", max, FieldIo::max_coordinate);
  }
  /// @throws SettingError for values out of range, or that do not go together
  void validate() const {
    const bool is_preset = preset != MediumPreset::none,
               drops = preset == MediumPreset::rain || preset == MediumPreset::snow;
    if (visibility && (drops || !is_preset))
      throw SettingError("visibility_m", *visibility, "m", "left out, but for fog, haze, dust and smoke");
    if (rate && !drops) throw SettingError("rate_mmPerH", *rate, "mm/h", "left out, but for rain and snow");
    if (is_preset)
      require_within("absorption_perM, scattering_perM or backscatter_perMSr, with a preset",
                     std::max({absorption, scattering, backscatter}), 0, 0, "");
    region(known_wavelength).validate();
    check_fields(*this);
  }
  static constexpr double known_wavelength = 905e-9;  ///< for which all presets are defined [m]

  bool operator==(const MediumSettings&) const = default;
};

/// `<scene>`
struct SceneSettings {
  std::string id{};                          ///< `id`
  std::string name{};                        ///< `name`
  int dynamic_step = 1;                      ///< pulse slots per update; `dynStep`
  std::optional<double> dynamic_interval{};  ///< of updates, instead of `dynStep`; `dynTimeStep` [s]
  std::vector<PartSettings> parts{};
  std::vector<LightSettings> light{};   ///< `<light>`: the first; without it and media, rays end at surfaces
  std::vector<MediumSettings> media{};  ///< `<medium>`

  void fields(FieldIo& io) {
    io.require({"id"});
    io.text("id", id);
    io.text("name", name);
    io.whole("dynStep", dynamic_step, 1, 1'000'000'000);
    io.number("dynTimeStep", dynamic_interval, units::second, 1e-9, 1e6);
  }
  /// Media in its air, for a wavelength [m]. @throws SettingError also for boxes that overlap
  [[nodiscard]] Media air(double wavelength) const {
    std::vector<MediumRegion> regions;
    for (const MediumSettings& medium : media) regions.push_back(medium.region(wavelength));
    return Media(std::move(regions));
  }
  /// True if its surfaces reflect or transmit light further.
  [[nodiscard]] bool follows_light() const { return !light.empty() || !media.empty(); }
  /// Settings of its light, or the defaults.
  [[nodiscard]] LightSettings light_or_default() const { return light.empty() ? LightSettings{} : light.front(); }

  void validate() const {
    check_fields(*this);
    for (const LightSettings& one : light) check_fields(one);
    for (const MediumSettings& medium : media) medium.validate();
    (void)air(MediumSettings::known_wavelength);
    for (const PartSettings& part : parts) naming("part '" + part.id + "'", [&] { part.validate(); });
  }
  bool operator==(const SceneSettings&) const = default;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
