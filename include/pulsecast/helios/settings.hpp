// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/rotation_list.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

/// What the documents of a survey say, as plain structs in SI units and radians that a program may change before it builds the survey from
/// them. Templates, references and inheritance are resolved: each struct says all that counts. After each field stands the attribute
/// or element that it is in a document. Where 0 stands for a default or for none, less is no setting: `validate` refuses it.
namespace pulsecast::helios {

namespace detail {

/// Refuses a whole number less than `least`.
inline void require_at_least(int least, std::string_view field, int value) {
  require_within(field, value, least, std::numeric_limits<int>::max(), "");
}

}  // namespace detail

enum class Axis : std::uint8_t { x, y, z };

/// One turn of a list: `<rot>`.
struct AxisTurn {
  Axis axis = Axis::z;  ///< `axis`
  double angle = 0;     ///< right-handed; `angle_deg` [rad]

  bool operator==(const AxisTurn&) const = default;
};

/// Turns, one after the other: the `<rot>` children of an element.
struct RotationList {
  std::vector<AxisTurn> turns{};
  bool local = false;  ///< about the axes of what is turned, rather than the fixed ones outside; `rotations="local"`

  /// All turns in one.
  [[nodiscard]] Rotation rotation() const {
    std::vector<AxisAngle> all;
    for (const AxisTurn& turn : turns)
      all.push_back({turn.axis == Axis::x ? axis::right : turn.axis == Axis::y ? axis::forward : axis::up, turn.angle});
    return local ? intrinsic(all) : extrinsic(all);
  }

  bool operator==(const RotationList&) const = default;
};

/// Where and how a thing sits on another: `<scannerMount>`, `<beamOrigin>`.
struct MountSettings {
  Vec3 position{};          ///< in the frame of what carries it; `x`, `y`, `z` [m]
  RotationList rotation{};  ///< from the frame of what is carried to that of what carries it

  bool operator==(const MountSettings&) const = default;
};

// ---------------------------------------------------------------------------------------------------------------- scanner

/// A mirror that swings to and fro: `optics="oscillating"`.
struct OscillatingOptic {
  double scan_product_max = radians(1e6);  ///< of half the scan angle and the scan frequency; `scanProduct` in deg Hz [rad/s]

  bool operator==(const OscillatingOptic&) const = default;
};

/// A polygon mirror that rotates: `optics="rotating"`. It sweeps `scan_angle_max` to either side and measures in part of that.
struct RotatingOptic {
  /// To either side, where it measures at most; all of `scan_angle_max` unless given. `scanAngleEffectiveMax_deg` [rad]
  std::optional<double> effective_angle_max{};

  bool operator==(const RotatingOptic&) const = default;
};

/// A Palmer mirror, whose beam goes round a cone: `optics="conic"`.
struct ConicOptic {
  bool operator==(const ConicOptic&) const = default;
};

/// An array of fibres, side by side: `optics="line"`.
struct LineOptic {
  int fibers = 1;  ///< `numFibers`

  bool operator==(const LineOptic&) const = default;
};

/// One wedge of glass that rotates.
struct RisleyPrism {
  double angle = 0;             ///< of the wedge; inclined where light enters if positive, else where it leaves. `angle1_deg`... [rad]
  double rotor_frequency = 0;   ///< right-handed if positive; `rotorFreq1_Hz`... [Hz]
  double refractive_index = 1;  ///< `refrIndex1`...

  bool operator==(const RisleyPrism&) const = default;
};

/// Risley prisms: `optics="risley"`.
struct RisleyOptic {
  std::array<RisleyPrism, 3> prisms{};  ///< those without an angle are not there
  double air_refractive_index = 1;      ///< `refrIndex_air`
  Vec3 incident_beam = axis::forward;   ///< of any length but zero; `<incidentBeam>`

  bool operator==(const RisleyOptic&) const = default;
};

using OpticSettings = std::variant<OscillatingOptic, RotatingOptic, ConicOptic, LineOptic, RisleyOptic>;

/// How waveforms are sampled: `<FWFSettings>`.
struct FullWaveformSettings {
  double bin_size = 0.25e-9;       ///< `binSize_ns` [s]
  std::optional<double> window{};  ///< to either side of a peak; a quarter of the pulse length unless given. `winSize_ns` [s]
  int rings = 3;                   ///< of subrays, with the centre as the first; `beamSampleQuality`
  double duration_max = 0;         ///< 0 stands for no limit; `maxFullwaveRange_ns` [s]

  void validate() const {
    detail::require_at_least(1, "beamSampleQuality", rings);
    require_not_negative("maxFullwaveRange_ns", duration_max * 1e9, "ns");
  }

  bool operator==(const FullWaveformSettings&) const = default;
};

/// How a scanner errs, as formulas of an angle or range: `<deflectionError>`, `<headError>`, `<rangeError>`.
struct ErrorFormulas {
  std::string deflection{};        ///< added to the deflection, of it [rad]; `expr` in THETA
  std::string head{};              ///< added to the angle of the head, of the deflection [rad]; `expr` in THETA
  double head_zero_threshold = 0;  ///< by which the argument is kept off 0 and pi; `zeroSinThreshold_deg` [rad]
  std::string range{};             ///< added to the range, of the deflection [m]; `expr` in THETA
  std::string range_noise{};       ///< by which noise of the range is multiplied, of it [m]; `distanceMeasurementError` in t

  bool operator==(const ErrorFormulas&) const = default;
};

/// One laser with its optic and receiver: `<scanner>`, or each of its `<channel>` elements. The position of its `beam_origin` counts along
/// the axes of the platform, as that of the mount: the rotation of the mount does not turn it, but heading and head do.
struct ChannelSettings {
  std::string id{};                                            ///< `id` of the channel; empty if the scanner has but one
  OpticSettings optic{};                                       ///< `optics` and what belongs to it
  double scan_angle_max = 0;                                   ///< to either side; `scanAngleMax_deg` [rad]
  double scan_frequency_min = 0;                               ///< `scanFreqMin_Hz` [Hz]
  double scan_frequency_max = 0;                               ///< 0 stands for no limit; `scanFreqMax_Hz` [Hz]
  MountSettings beam_origin{};                                 ///< rotated in the frame of the instrument; `<beamOrigin>`
  Vec3 head_axis = axis::up;                                   ///< of any length but zero; `<headRotateAxis>`
  double head_speed_max = 0;                                   ///< 0: it cannot turn; `headRotatePerSecMax_deg` [rad/s]
  double divergence = 0.3e-3;                                  ///< full angle at 1/e^2 of the peak; `beamDivergence_rad` [rad]
  double pulse_length = 4e-9;                                  ///< full width at half maximum; `pulseLength_ns` [s]
  double average_power = 4;                                    ///< `averagePower_w` [W]
  std::optional<double> beam_quality{};                        ///< M^2; comes from a point unless given. `beamQualityFactor` but for 1
  double wavelength = 1064e-9;                                 ///< `wavelength_nm` [m]
  double efficiency = 0.99;                                    ///< `opticalEfficiency`
  double receiver_diameter = 0.15;                             ///< `receiverDiameter_m` [m]
  double visibility = 23e3;                                    ///< of the atmosphere; `atmosphericVisibility_km` [m]
  double accuracy = 0;                                         ///< standard deviation of the range; `accuracy_m` [m]
  double range_min = 0;                                        ///< `rangeMin_m` [m]
  double range_max = std::numeric_limits<double>::infinity();  ///< `rangeMax_m` [m]
  int returns_max = 0;                                         ///< of one pulse; 0 stands for no limit; `maxNOR`
  double received_power_min = 1e-4 / 1e9;                      ///< of an echo; `receivedEnergyMin_W`, which is in nW [W]
  FullWaveformSettings waveform{};                             ///< `<FWFSettings>`
  ErrorFormulas errors{};                                      ///< `<deflectionError>`...

  void validate() const {
    require_not_negative("scanAngleMax_deg", degrees(scan_angle_max), "deg");
    require_not_negative("scanFreqMin_Hz", scan_frequency_min, "Hz");
    require_not_negative("scanFreqMax_Hz", scan_frequency_max, "Hz");
    require_not_negative("headRotatePerSecMax_deg", degrees(head_speed_max), "deg/s");
    detail::require_at_least(0, "maxNOR", returns_max);
    waveform.validate();
  }

  bool operator==(const ChannelSettings&) const = default;
};

/// `<scanner>`, with what the survey sets of it.
struct ScannerSettings {
  std::string id{};                         ///< `id`
  std::string name{};                       ///< `name`
  std::vector<double> pulse_rates{};        ///< that it is made for, the usual one first; `pulseFreqs_Hz` [Hz]
  std::vector<ChannelSettings> channels{};  ///< at least one; they fire at the same time, in this order

  void validate() const {
    for (const ChannelSettings& channel : channels) channel.validate();
  }

  bool operator==(const ScannerSettings&) const = default;
};

// --------------------------------------------------------------------------------------------------------------- platform

enum class PlatformKind : std::uint8_t {
  stationary,      ///< `type="static"`
  linear_path,     ///< `type="linearpath"`
  multicopter,     ///< `type="multicopter"`
  ground_vehicle,  ///< `type="groundvehicle"`
  interpolated,    ///< `platform="interpolated"`: as its trajectory says
};

/// What roll, pitch and yaw of a trajectory mean: `rotationSpec`.
enum class RotationSpec : std::uint8_t {
  arinc_705,  ///< `ARINC 705`
  canonical,  ///< `CANONICAL`
};

/// How a multicopter flies.
struct MulticopterDynamics {
  double yaw_speed = radians(85.94);  ///< at most; `yaw_speed_deg` [rad/s]
  double pitch_offset = radians(35);  ///< by which it leans at most; `pitch_offset_deg` [rad]

  bool operator==(const MulticopterDynamics&) const = default;
};

enum class NoiseDistribution : std::uint8_t {
  normal,   ///< `type="NORMAL"`
  uniform,  ///< `type="UNIFORM"`
};

/// A random number that is added at each pulse: `<positionXNoise>`...
struct NoiseSettings {
  NoiseDistribution distribution = NoiseDistribution::normal;  ///< `type`
  double mean = 0;                                             ///< of the normal one; `mean` [m] or [rad]
  double deviation = 1;                                        ///< of the normal one; `stdev` [m] or [rad]
  double low = 0;                                              ///< of the uniform one; `min` [m] or [rad]
  double high = 1;                                             ///< of the uniform one; `max` [m] or [rad]
  bool clipped = false;                                        ///< `clipEnabled`
  double clip_low = 0;                                         ///< `clipMin` [m] or [rad]
  double clip_high = 1;                                        ///< `clipMax` [m] or [rad]
  int lifespan = 1;                                            ///< for how many pulses each number is used, 0 for all; `fixedLifespan`

  void validate() const { detail::require_at_least(0, "fixedLifespan", lifespan); }

  bool operator==(const NoiseSettings&) const = default;
};

/// `<platform>`, with what the survey sets of it.
struct PlatformSettings {
  std::string id{};                                              ///< `id`
  std::string name{};                                            ///< `name`
  PlatformKind kind = PlatformKind::stationary;                  ///< `type`
  MountSettings mount{};                                         ///< of the instrument on the body; `<scannerMount>`
  MulticopterDynamics multicopter{};                             ///< of the multicopter
  RotationSpec rotation_spec = RotationSpec::arinc_705;          ///< of the interpolated one; `rotationSpec`
  std::array<std::optional<NoiseSettings>, 3> position_noise{};  ///< `<positionXNoise>`, Y and Z [m]
  std::array<std::optional<NoiseSettings>, 3> attitude_noise{};  ///< `<attitudeXNoise>`, Y and Z [rad]

  void validate() const {
    for (const auto* noises : {&position_noise, &attitude_noise})
      for (const std::optional<NoiseSettings>& noise : *noises)
        if (noise) noise->validate();
  }

  bool operator==(const PlatformSettings&) const = default;
};

// ------------------------------------------------------------------------------------------------------------------ scene

/// The materials of what brings none of its own.
struct MaterialSource {
  std::filesystem::path file{};       ///< MTL; empty: all is undescribed. `matfile`
  std::optional<std::string> name{};  ///< the first by alphabet unless given; `matname`
  int random = 0;                     ///< how many variants are made; `randomMaterials`
  double random_range = 1;            ///< by which colours of variants differ at most; `randomRange`

  void validate() const {
    detail::require_at_least(0, "randomMaterials", random);
    require_not_negative("randomRange", random_range, "");
  }

  bool operator==(const MaterialSource&) const = default;
};

/// Triangles: filter `objloader`.
struct ObjSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  bool y_up = false;                           ///< `up`

  bool operator==(const ObjSource&) const = default;
};

/// A raster of heights: filter `geotiffloader`.
struct GeoTiffSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};

  void validate() const { material.validate(); }

  bool operator==(const GeoTiffSource&) const = default;
};

/// A point cloud that becomes voxels: filter `xyzloader`.
struct XyzSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};
  std::string separator{};                     ///< any of these separates columns; found unless given. `separator`
  double voxel_size = 1;                       ///< edge; `voxelSize` [m]
  std::optional<Vec3> default_normal{};        ///< of any length but zero; `defaultNormal`
  int estimate_normals = 0;                    ///< 0: from the file, else a plane is fitted in each voxel; `estimateNormals`
  bool snap_neighbor_normal = false;           ///< the normal of the point nearest to the centre, not the mean; `snapNeighborNormal`
  std::array<int, 3> normal_columns{3, 4, 5};  ///< from 0; `normalXIndex`, Y and Z

  void validate() const {
    material.validate();
    detail::require_at_least(0, "estimateNormals", estimate_normals);
  }

  bool operator==(const XyzSource&) const = default;
};

enum class VoxelMode : std::uint8_t {
  transmittive,  ///< rays pass by chance
  fixed,         ///< opaque cubes
  scaled,        ///< opaque cubes, the smaller the less there is in them
};

/// Voxels with what fills them: filter `detailedvoxels`.
struct VoxelSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or those that `efilepath` matches, by name
  MaterialSource material{};
  VoxelMode mode = VoxelMode::transmittive;  ///< `intersectionMode`
  double scaling_exponent = 0.5;             ///< if scaled; `intersectionArgument`
  bool random_shift = false;                 ///< if scaled, cubes stand anywhere in their cells; `randomShift`
  std::filesystem::path leaf_angles{};       ///< look-up table; empty: there is none. `ladlut`

  void validate() const { material.validate(); }

  bool operator==(const VoxelSource&) const = default;
};

using PartSource = std::variant<ObjSource, GeoTiffSource, XyzSource, VoxelSource>;

namespace detail {

inline void validate_source(const PartSource& source) {
  std::visit([](const auto& one) { (void)validated(one); }, source);
}

}  // namespace detail

/// How geometry is placed: each vertex goes to `translation + scale * (rotations * vertex)`. Filters `rotate`, `scale`, `translate`.
struct TransformSettings {
  double scale = 1;                       ///< `scale`
  std::vector<RotationList> rotations{};  ///< one after the other, about fixed axes; `rotation` of each filter
  Vec3 translation{};                     ///< `offset` [m]
  int on_ground = 0;                      ///< if not 0, it is let down onto the ground; the search depth. `onGround`

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
  Vec3 axis = axis::up;           ///< of any length but zero; `axis`
  double angle = 0;               ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};   ///< through which the axis goes; the origin unless given. `center` [m]
  std::optional<double> glide{};  ///< along the axis, in its lengths: helical only. `glide`

  bool operator==(const RotationMotion&) const = default;
};

/// `<motion type="reflection">` and, with `shift`, `<motion type="glideplane">`
struct ReflectionMotion {
  Vec3 normal = axis::up;       ///< of a plane through the origin, of any length but zero; `ortho`
  std::optional<Vec3> shift{};  ///< along the plane: glide plane only. `shift` [m]

  bool operator==(const ReflectionMotion&) const = default;
};

/// `<motion type="rotsym">`: a rotation, and then a reflection at the plane across the axis.
struct RotoreflectionMotion {
  Vec3 axis = axis::up;          ///< of any length but zero; `axis`
  double angle = 0;              ///< right-handed; `angle` in degrees [rad]
  std::optional<Vec3> center{};  ///< `center` [m]

  bool operator==(const RotoreflectionMotion&) const = default;
};

/// What a part does in each step: `<motion>`.
struct MotionSettings {
  std::variant<NoMotion, TranslationMotion, RotationMotion, ReflectionMotion, RotoreflectionMotion> kind{};
  bool about_itself = false;  ///< in a frame at the part's centre; `selfMode`
  double shift_factor = 0;    ///< times the centre of the scene, added to the coordinates given; `autoCRS`

  bool operator==(const MotionSettings&) const = default;
};

/// What a part does for a number of steps, and what then: `<dmotion>`.
struct MotionSequenceSettings {
  std::string id{};                       ///< `id`
  int loop = 1;                           ///< for how many steps; 0 stands for ever. `loop`
  std::optional<std::string> next{};      ///< the sequence that follows; it stops unless given. `next`
  std::vector<MotionSettings> motions{};  ///< all of them in each step, one after the other

  void validate() const { detail::require_at_least(0, "loop", loop); }

  bool operator==(const MotionSequenceSettings&) const = default;
};

/// What stands in a part's place in later runs of the survey: `<swap>`.
struct SwapSettings {
  int step = 1;                        ///< for how many runs; `swapStep`
  bool removes = false;                ///< nothing stands there; `force_null`
  std::optional<PartSource> source{};  ///< the part's own unless given
  TransformSettings transform{};

  void validate() const {
    detail::require_at_least(1, "swapStep", step);
    if (source) detail::validate_source(*source);
  }

  bool operator==(const SwapSettings&) const = default;
};

/// `<part>`
struct PartSettings {
  std::string id{};                               ///< `id`; unless given, how many parts and files stand before it
  PartSource source{};                            ///< the filter that loads
  TransformSettings transform{};                  ///< the filters that place
  int dynamic_step = 1;                           ///< it moves once in so many updates of the scene; `dynStep`
  std::optional<double> dynamic_interval{};       ///< it moves once in this time, where the scene has one; `dynTimeStep` [s]
  std::vector<MotionSequenceSettings> motions{};  ///< the first one begins; none: it stands still
  std::vector<SwapSettings> swaps{};              ///< one after the other

  void validate() const {
    detail::validate_source(source);
    detail::require_at_least(1, "dynStep", dynamic_step);
    if (dynamic_interval) require_positive("dynTimeStep", *dynamic_interval, "s");
    for (const MotionSequenceSettings& sequence : motions) sequence.validate();
    for (const SwapSettings& swap : swaps) swap.validate();
  }

  bool operator==(const PartSettings&) const = default;
};

/// `<scene>`
struct SceneSettings {
  std::string id{};                          ///< `id`
  std::string name{};                        ///< `name`
  int dynamic_step = 1;                      ///< it is updated once in so many pulse slots; `dynStep`
  std::optional<double> dynamic_interval{};  ///< instead, once in this time; `dynTimeStep` [s]
  std::vector<PartSettings> parts{};

  void validate() const {
    detail::require_at_least(1, "dynStep", dynamic_step);
    if (dynamic_interval) require_positive("dynTimeStep", *dynamic_interval, "s");
    for (const PartSettings& part : parts) try {
        part.validate();
      } catch (const SettingError& error) {
        throw error.of("part '" + part.id + "'");
      }
  }

  bool operator==(const SceneSettings&) const = default;
};

// ------------------------------------------------------------------------------------------------------------------- legs

/// The column of each quantity, from 0.
struct TrajectoryIndices {
  int time = 0;   ///< `tIndex`
  int roll = 1;   ///< `rollIndex`
  int pitch = 2;  ///< `pitchIndex`
  int yaw = 3;    ///< `yawIndex`
  int x = 4;      ///< `xIndex`
  int y = 5;      ///< `yIndex`
  int z = 6;      ///< `zIndex`

  bool operator==(const TrajectoryIndices&) const = default;
};

/// What an interpolated platform follows: attributes of `<platformSettings>`.
struct TrajectorySettings {
  std::filesystem::path file{};                ///< `trajectory`
  std::optional<char> separator{};             ///< found unless given; `trajectory_separator`, or `trajectory_seperator`
  std::optional<TrajectoryIndices> columns{};  ///< the file's own head says it unless given; `tIndex`...
  bool position_only = false;                  ///< `interpolationDomain="position"`
  bool angles_in_degrees = true;               ///< of the file; `toRadians`
  bool sync_clock = false;                     ///< the clock begins at the time in the file; `syncGPSTime`
  bool teleports = false;                      ///< a jump comes before, as a leg without pulses: the optic starts anew. `teleportToStart`
  std::optional<double> start{};               ///< by the clock of the file, its first sample unless given; `tStart` [s]
  std::optional<double> end{};                 ///< by the clock of the file, its last sample unless given; `tEnd` [s]

  bool operator==(const TrajectorySettings&) const = default;
};

/// `<platformSettings>` of a leg
struct LegPlatformSettings {
  Vec3 position{};                                 ///< where the leg begins, in the scene's own coordinates; `x`, `y`, `z` [m]
  bool on_ground = false;                          ///< z is that of the ground; `onGround`
  double speed = 70;                               ///< `movePerSec_m` [m/s]
  bool smooth_turn = false;                        ///< multicopter: turns as it flies on; `smoothTurn`, or `stopAndTurn="false"`
  std::optional<double> yaw_at_departure{};        ///< multicopter; counter-clockwise from +y. `yawAtDeparture_deg` [rad]
  std::optional<TrajectorySettings> trajectory{};  ///< interpolated only

  bool operator==(const LegPlatformSettings&) const = default;
};

/// `<scannerSettings>` of a leg
struct LegScannerSettings {
  bool active = true;                          ///< `active`
  double pulse_rate = 0;                       ///< the scanner's first unless given; `pulseFreq_hz` [Hz]
  double scan_frequency = 0;                   ///< `scanFreq_hz` [Hz]
  std::optional<double> scan_angle{};          ///< to either side; as far as the device can unless given. `scanAngle_deg` [rad]
  std::optional<double> vertical_angle_min{};  ///< rotating only; `verticalAngleMin_deg` [rad]
  std::optional<double> vertical_angle_max{};  ///< rotating only; `verticalAngleMax_deg` [rad]
  double head_speed = 0;                       ///< `headRotatePerSec_deg` [rad/s]
  double head_start = 0;                       ///< `headRotateStart_deg` [rad]
  double head_stop = 0;                        ///< `headRotateStop_deg` [rad]
  std::optional<double> divergence{};          ///< of all channels; each one's own unless given. `beamDivergence_rad` [rad]
  double trajectory_interval = 0;              ///< between records of the trajectory; 0: none. `trajectoryTimeInterval_s` [s]
  double warm_up = 0;                          ///< for which head and optic run before the first pulse; `opticsWarmupPhase_s` [s]

  void validate() const {
    require_not_negative("pulseFreq_hz", pulse_rate, "Hz");
    require_not_negative("scanFreq_hz", scan_frequency, "Hz");
    if (scan_angle) require_not_negative("scanAngle_deg", degrees(*scan_angle), "deg");
    require_not_negative("trajectoryTimeInterval_s", trajectory_interval, "s");
    require_not_negative("opticsWarmupPhase_s", warm_up, "s");
  }

  bool operator==(const LegScannerSettings&) const = default;
};

/// `<leg>`
struct LegSettings {
  std::optional<std::string> strip{};    ///< legs of one strip share their files; `stripId`
  std::optional<double> duration_max{};  ///< after which the leg ends in any case; `maxDuration_s` of leg or scannerSettings [s]
  LegPlatformSettings platform{};
  LegScannerSettings scanner{};

  void validate() const {
    if (duration_max) require_not_negative("maxDuration_s", *duration_max, "s");
    scanner.validate();
  }

  bool operator==(const LegSettings&) const = default;
};

/// Whether a leg of a platform that moves stays where it begins: the next one begins there, too, or there is none.
[[nodiscard]] inline bool stays_in_place(const std::vector<LegSettings>& legs, std::size_t k) {
  if (k + 1 >= legs.size()) return legs.size() == 1;
  const LegPlatformSettings &here = legs[k].platform, &next = legs[k + 1].platform;
  const bool is_above = here.position.x == next.position.x && here.position.y == next.position.y;
  return is_above && here.on_ground == next.on_ground && (here.on_ground || here.position.z == next.position.z);
}

// ----------------------------------------------------------------------------------------------------------------- survey

/// By how much legs begin elsewhere than they should: `legRandomOffset`.
struct LegOffsetSettings {
  double mean = 0;         ///< along each axis; `legRandomOffsetMean` [m]
  double deviation = 0.1;  ///< along each axis; `legRandomOffsetStdev` [m]

  bool operator==(const LegOffsetSettings&) const = default;
};

/// `<survey>`. What it sets of the scanner (`<FWFSettings>`, `<detectorSettings>`) and the platform (`<scannerMount>`, noise) stands there.
struct SurveySettings {
  std::string name{};                             ///< the file's unless given; `name`
  std::optional<std::uint64_t> seed{};            ///< `seed`
  std::optional<LegOffsetSettings> leg_offset{};  ///< `legRandomOffset`...
  ScannerSettings scanner{};                      ///< `scanner`
  PlatformSettings platform{};                    ///< `platform`, or `basePlatform` if that is interpolated
  SceneSettings scene{};                          ///< `scene`
  std::vector<LegSettings> legs{};                ///< `<leg>`, in this order

  bool operator==(const SurveySettings&) const = default;
};

}  // namespace pulsecast::helios
