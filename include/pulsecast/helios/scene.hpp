// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SCENE_HPP
#define PULSECAST_HELIOS_SCENE_HPP

#include <set>

#include <pulsecast/helios/detail/city_reader.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/point_cloud.hpp>
#include <pulsecast/io/spectral_library.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

/// Converts the scene of a survey document to parts of the library.
namespace PULSECAST_NAMESPACE::helios {

/// Part with any shape of the document format.
using SurveyPart =
    Part<HeightField, MaskedMesh<>, VoxelGrid<OpaqueVoxels>, VoxelGrid<ScaledVoxels>, VoxelGrid<TransmissiveVoxels>>;
/// Scene of such parts.
using SurveyScene = MovingScene<HeightField, MaskedMesh<>, VoxelGrid<OpaqueVoxels>, VoxelGrid<ScaledVoxels>,
                                VoxelGrid<TransmissiveVoxels>>;

/// Options for building a scene.
struct SceneBuildOptions {
  io::SpectralLibrary spectra{};  ///< spectra for materials
  double pulse_rate = 100e3;      ///< pulse rate of the first leg, for motions per pulse [Hz]
  std::uint64_t seed = 0;         ///< seed of random properties of the scene
  bool fixed_incidence = false;   ///< perpendicular incidence on all surfaces, for scattering
  bool tilted_leaves = false;     ///< as in `TransmissiveVoxels`
  unsigned threads = 0;           ///< for reading and building, at most `max_threads`; 0: all
  CityReader city_models{};       ///< reader of CityGML files; empty: they are an error

  void validate() const { require_within("SceneBuildOptions::threads", threads, 0, max_threads, ""); }
};

/// Parts of a scene and the warnings from building it.
struct BuiltParts {
  std::vector<SurveyPart> parts{};          ///< parts of the scene
  std::vector<std::string> warnings{};      ///< warnings of the construction
  std::set<std::filesystem::path> files{};  ///< files that were looked for, also missing ones
};

/// Raster of heights in the world.
struct PlacedRaster {
  Raster raster;          ///< heights, in the frame of the part
  Placement placement{};  ///< from there to the world
};

/// Builds the parts of a scene, with warnings about its files, which are kept for other runs.
class SceneBuilder {
 public:
  /// Keeps the settings; `parts` reads the files. @throws SettingError for settings out of range
  SceneBuilder(SceneSettings settings, SceneBuildOptions options)
      : settings_(validated(std::move(settings))), options_(validated(std::move(options))) {}

  /// Number of runs of the survey, from its swaps.
  [[nodiscard]] int runs() const;

  /// Parts in a run, from 0.
  [[nodiscard]] std::vector<SurveyPart> parts(int run = 0);

  /// Reads the rasters of heights alone, placed as in the first run, but without `onGround`.
  [[nodiscard]] std::vector<PlacedRaster> rasters();

  /// Warnings so far, each once.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Files that `parts` has looked for, also missing ones; without the folders of spectra.
  [[nodiscard]] const std::set<std::filesystem::path>& files() const noexcept { return files_; }

 private:
  /// Geometry and materials of a file, or of one of its nodes, placed in the part.
  struct Loaded {
    decltype(SurveyPart::geometry) geometry;
    MaterialTable materials;
    Placement placement{};
    std::string name{};  ///< of the node
  };
  /// Raster of a file, and its colour table, if any.
  struct LoadedRaster {
    Raster raster;
    std::vector<Vec3> colours{};
  };
  /// Materials of rasters, and the raster of classes that chooses them, if any.
  struct GroundMaterials {
    MaterialTable table;
    std::optional<Raster> codes;
    std::vector<CodeMaterial> listed;
  };
  using Files = std::vector<std::filesystem::path>;
  using Load = std::function<void(const std::filesystem::path&, std::vector<Loaded>&)>;

  void warn(const std::vector<std::string>& what);
  void add_files(const Files& looked_for) { files_.insert(looked_for.begin(), looked_for.end()); }
  const std::vector<Loaded>& load(const PartSource& source);
  std::vector<Loaded> each(const Files& files, const Load& load);
  std::vector<Loaded> read(const ObjSource& source);
  std::vector<Loaded> read(const GeoTiffSource& source);
  std::vector<Loaded> read(const XyzSource& source);
  std::vector<Loaded> read(const VoxelSource& source);
  std::vector<Loaded> read(const MeshSource& source);
  void drop_bare(const std::filesystem::path& file, io::PointCloud& cloud);
  LoadedRaster raster(const std::filesystem::path& file, const GeoTiffSource& source);
  Raster ground(const std::filesystem::path& file, const GeoTiffSource& source);
  GroundMaterials ground_materials(const GeoTiffSource& source);
  Material material(const MaterialSource& source);
  MaterialTable table(std::vector<Material> materials) const;
  MaterialTable assign_materials(const MaterialSource& source, VoxelData& voxels,
                                 std::span<const std::uint32_t> classes);
  void add(const PartSettings& part, const PartSource& source, const TransformSettings& transform, std::size_t place,
           std::vector<SurveyPart>& all);
  static Placement placement_of(const PartSettings& part, const TransformSettings& transform);
  void warn_of_shared_objects(const std::vector<SurveyPart>& all);
  static Box box_of(const SurveyPart& part);
  void stand_on_ground(std::vector<SurveyPart>& all, const std::vector<int>& lifted);
  void move(std::vector<SurveyPart>& all);

  SceneSettings settings_;
  SceneBuildOptions options_;
  std::vector<std::pair<PartSource, std::vector<Loaded>>> loaded_;
  std::vector<const PartSettings*> settings_of_;  // one per part of the last run
  std::vector<std::string> warnings_;
  std::set<std::string> warned_;
  std::set<std::filesystem::path> files_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_SCENE)
#include <pulsecast/helios/detail/scene_builder.hpp>
#include <pulsecast/helios/detail/source_readers.hpp>
#endif

#endif
