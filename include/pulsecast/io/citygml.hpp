// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_CITYGML_HPP
#define PULSECAST_IO_CITYGML_HPP

#include <set>

#include <citygml/citygml.h>
#include <citygml/citygmllogger.h>
#include <citygml/citymodel.h>
#include <citygml/geometry.h>
#include <citygml/implictgeometry.h>
#include <citygml/polygon.h>
#include <citygml/transformmatrix.h>

#include <pulsecast/io/detail/mesh_file/file_maker.hpp>
#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>
#include <pulsecast/io/detail/plain_xml.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>
#include <pulsecast/io/mesh_file.hpp>

/// City models of CityGML 1 and 2 files, by libcitygml.
namespace PULSECAST_NAMESPACE::io {

/// Settings for CityGML files.
struct CityGmlSettings {
  unsigned max_lod = 4;               ///< of the levels of detail up to it, an object's highest is read
  bool interior = false;              ///< true: rooms, their surfaces and furniture, too
  std::filesystem::path materials{};  ///< MTL file that replaces materials by name; or none
  SpectralLibrary spectra{};          ///< spectra for `helios_spectra` in that file
  bool isolated = false;              ///< true: in a child process; for untrusted files
  ImportLimits limits{};              ///< of that process

  void validate() const {
    require_within("CityGmlSettings::max_lod", max_lod, 0, 4, "");
    limits.validate();
  }
};

/// Content of a CityGML file.
struct CityGml {
  /// A placement for each city object with surfaces, named by its gml:id, with its origin near it.
  /// Materials are named by classes of CityGML, and have ASPRS classes: 2 for relief, land use and
  /// ground, 5 for vegetation, 6 for buildings, 9 for water, 10 for railways, 11 for roads, tracks
  /// and squares, 17 for bridges, 0 for others. Implicit geometries are shared.
  MeshFile file;
  std::optional<std::uint16_t> epsg{};  ///< code of the reference system of coordinates, if any
};

namespace detail {

using CityClass = citygml::CityObject::CityObjectsType;

/// ASPRS class of a class of CityGML, and how it is read.
struct CityClassRule {
  std::uint16_t classification = 0;
  bool ground = false;    ///< may carry set-ups
  bool interior = false;  ///< is inside a building
};
[[nodiscard]] inline CityClassRule rule_of(CityClass type) {
  using enum citygml::CityObject::CityObjectsType;
  const auto is = [type](auto... classes) { return ((type == classes) || ...); };
  if (is(COT_Room, COT_BuildingFurniture, COT_InteriorWallSurface, COT_CeilingSurface, COT_FloorSurface,
         COT_IntBuildingInstallation))
    return {.classification = 6, .interior = true};
  if (is(COT_Building, COT_BuildingPart, COT_BuildingInstallation, COT_Door, COT_Window, COT_WallSurface,
         COT_RoofSurface, COT_OuterCeilingSurface, COT_OuterFloorSurface))
    return {.classification = 6};
  if (is(COT_GroundSurface)) return {.classification = 2};
  if (is(COT_ReliefFeature, COT_ReliefComponent, COT_TINRelief, COT_LandUse))
    return {.classification = 2, .ground = true};
  if (is(COT_PlantCover, COT_SolitaryVegetationObject)) return {.classification = 5};
  if (is(COT_WaterBody)) return {.classification = 9};
  if (is(COT_Railway)) return {.classification = 10, .ground = true};
  if (is(COT_Road, COT_Track, COT_Square, COT_TransportationObject)) return {.classification = 11, .ground = true};
  if (is(COT_Bridge, COT_BridgePart, COT_BridgeInstallation, COT_BridgeConstructionElement))
    return {.classification = 17, .ground = true};
  return {};
}

/// EPSG code of the horizontal system in a name, as in `crs:EPSG:6.12:25832,crs:EPSG::5783`.
[[nodiscard]] inline std::optional<std::uint16_t> epsg_of(std::string_view name) {
  const std::size_t at = name.find("EPSG");
  if (at == name.npos) return std::nullopt;
  name = name.substr(at, std::min(name.find(',', at), name.find('+', at)) - at);
  const std::size_t last = name.find_last_of(":/#");
  return last == name.npos ? std::nullopt : text::number_in<std::uint16_t>(name.substr(last + 1));
}

class CityGmlLog final : public citygml::CityGMLLogger {
 public:
  CityGmlLog() : CityGMLLogger(LOGLEVEL::LL_WARNING) {}
  void log(LOGLEVEL level, const std::string& message, const char* /*file*/, int /*line*/) const override {
    if (messages.size() < 20) messages.push_back(message);
    if (level == LOGLEVEL::LL_ERROR && error.empty()) error = message;
  }
  mutable std::vector<std::string> messages;
  mutable std::string error;
};

class CityGmlImport {
 public:
  CityGmlImport(const std::filesystem::path& path, const CityGmlSettings& settings)
      : path_(path), settings_(settings) {}

  [[nodiscard]] RawScene read() {
    require_plain_xml(path_);
    keep_rules();
    citygml::ParserParams params;
    params.maxLOD = settings_.max_lod;
    const auto log = std::make_shared<CityGmlLog>();
    std::shared_ptr<const citygml::CityModel> model;
    try {
      model = citygml::load(path_.string(), params, log);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      fail(error.what());
    } catch (...) {  // of Xerces
      fail(log->error.empty() ? "its XML is malformed" : log->error);
    }
    if (!model) fail(log->error.empty() ? "no reason is given" : log->error);
    name_ = model->getSRSName().empty() ? model->getEnvelope().srsName() : model->getSRSName();
    for (unsigned i = 0; i < model->getNumRootCityObjects(); ++i) {
      const citygml::CityObject& object = model->getRootCityObject(static_cast<int>(i));
      if (name_.empty()) name_ = object.getEnvelope().srsName();
      root(object);
    }
    // systems of latitude and longitude have many codes; no model has objects of 5 cm at most
    const auto code = epsg_of(name_);
    if (name_.find("CRS84") != name_.npos || code == 4326 || code == 4258 || code == 4978 || code == 4979 ||
        (largest_ > 0 && largest_ < 0.05 && farthest_ <= 360))
      fail("its coordinates are in degrees or geocentric, by '", name_,
           "' or its size: expected a projected system in metres");
    if (code && is_between(systems_to_the_west, *code))
      keep_rule(reference_rules, path_, "reference system", "axis to the west", scene_.warnings);
    if (code && !is_between(systems_in_metres, *code))
      scene_.warnings.push_back(
          warning(path_.string(), 0, "is in EPSG:", *code, ", which may be in feet: metres are assumed"));
    for (const std::string& message : log->messages)
      if (message.find("Attribute>") == message.npos)
        scene_.warnings.push_back(
            warning(path_.string(), 0, "libcitygml: ", printable(message), ": ", rule_of(city_rules, "*")->meaning));
    scene_.reference = name_;
    return std::move(scene_);
  }

 private:
  struct Surfaces {
    std::vector<Vec3> vertices{};
    std::vector<Corners3> triangles{};
  };
  using ByClass = std::map<CityClass, Surfaces>;

  void keep(std::string_view item) {
    if (kept_.insert(rule_of(city_rules, item)).second) keep_rule(city_rules, path_, "item", item, scene_.warnings);
  }
  /// Keeps to the rules for elements and attributes, most of which libcitygml passes over.
  void keep_rules() {
    const MappedFile file(path_, "an XML file");
    std::optional<std::uint16_t> system;
    for (std::string_view rest = file.text(); !rest.empty();) {
      rest.remove_prefix(std::min(rest.find('<'), rest.size() - 1) + 1);
      std::string_view tag = rest.substr(0, rest.find_first_of("<>"));
      std::string_view name = text::take_word(tag, " \t\r\n/");
      name.remove_prefix(name.find(':') + 1);
      if (rule_of(city_rules, name)->name != "*") keep(name);
      for (const std::string_view part : {"srsDimension=\"2\"", "uomLabels", "citygml/3.0"})
        if (tag.find(part) != tag.npos) keep(part);
      const std::size_t named = tag.find("srsName=");
      const std::string_view value = tag.substr(std::min(tag.size(), named + 9));
      const auto code = named == tag.npos ? std::nullopt : epsg_of(value.substr(0, value.find_first_of("'\"")));
      if (system && code && code != system) keep("another srsName");
      if (!system) system = code;
    }
  }

  [[noreturn]] void fail(const auto&... problem) const {
    detail::fail(path_, "is no CityGML file that can be read: ", printable(text::message(problem...)));
  }
  void root(const citygml::CityObject& object) {
    std::optional<unsigned> lod;
    highest(object, lod, 0);
    if (!lod) return;
    ByClass all;
    taken_.clear();
    collect(object, *lod, all, object.getId());
    if (all.empty()) return;
    Box box;
    for (const auto& [type, surfaces] : all)
      for (const Vec3& vertex : surfaces.vertices) box.extend(vertex);
    if (!box.empty()) largest_ = std::max({largest_, box.size().x, box.size().y});
    if (!box.empty()) farthest_ = std::max({farthest_, max_norm(box.min), max_norm(box.max)});
    const auto first = std::ranges::find_if(all, [](const auto& one) { return !one.second.vertices.empty(); });
    Vec3 origin = first == all.end() ? Vec3{} : first->second.vertices.front();
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(origin[k]);
    RawNode node{.name = object.getId(), .place = {Matrix3(1), origin}};
    for (auto& [type, surfaces] : all) {
      for (Vec3& vertex : surfaces.vertices) vertex -= origin;
      if (!surfaces.triangles.empty()) node.meshes.push_back(mesh(type, std::move(surfaces)));
    }
    if (!node.meshes.empty()) scene_.nodes.push_back(std::move(node));
  }

  [[nodiscard]] bool is_left_out(CityClass type) const {
    return type == CityClass::COT_ClosureSurface || (!settings_.interior && rule_of(type).interior);
  }

  void check_depth(int depth) const {
    if (depth > 200) fail("its objects are nested more than 200 deep");
  }

  /// Highest level of detail of an object and those in it, to the limit, which libcitygml may pass.
  void highest(const citygml::CityObject& object, std::optional<unsigned>& lod, int depth) {
    check_depth(depth);
    if (is_left_out(object.getType())) return;
    const auto offer = [&](unsigned level) {
      if (level <= settings_.max_lod) lod = std::max(lod.value_or(0), level);
    };
    for (unsigned i = 0; i < object.getGeometriesCount(); ++i) offer(object.getGeometry(i).getLOD());
    for (unsigned i = 0; i < object.getImplicitGeometryCount(); ++i) {
      const citygml::ImplicitGeometry& implicit = object.getImplicitGeometry(i);
      for (unsigned k = 0; k < implicit.getGeometriesCount(); ++k) offer(implicit.getGeometry(k).getLOD());
    }
    for (unsigned i = 0; i < object.getChildCityObjectsCount(); ++i)
      highest(object.getChildCityObject(i), lod, depth + 1);
  }

  /// Surfaces of an object after those in it, which it may refer to.
  void collect(const citygml::CityObject& object, unsigned lod, ByClass& all, const std::string& id) {
    if (is_left_out(object.getType())) return;
    for (unsigned i = 0; i < object.getChildCityObjectsCount(); ++i)
      collect(object.getChildCityObject(i), lod, all, id);
    for (unsigned i = 0; i < object.getGeometriesCount(); ++i)
      if (object.getGeometry(i).getLOD() == lod) add(object.getGeometry(i), all[object.getType()], 0);
    for (unsigned i = 0; i < object.getImplicitGeometryCount(); ++i)
      implicit(object.getImplicitGeometry(i), object.getType(), id, lod);
  }

  void add(const citygml::Geometry& geometry, Surfaces& to, int depth) {
    check_depth(depth);
    for (unsigned i = 0; i < geometry.getPolygonsCount(); ++i) {
      const std::shared_ptr<const citygml::Polygon> polygon = geometry.getPolygon(i);
      if (!taken_.insert(polygon.get()).second) continue;
      const std::size_t first = to.vertices.size(), count = polygon->getVertices().size();
      if (first + count > 0xFFFFFFFFU) fail("an object has too many vertices: expected fewer than 2^32");
      for (const TVec3d& v : polygon->getVertices()) to.vertices.emplace_back(v.x, v.y, v.z);
      const std::vector<unsigned>& indices = polygon->getIndices();
      for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
        Corners3 corners{};
        for (std::size_t c = 0; c < 3; ++c) {
          if (indices[k + c] >= count) fail("a polygon has a vertex that is not there");
          corners[c] = static_cast<std::uint32_t>(first + indices[k + c]);
        }
        const auto place = [&](std::size_t c) { return to.vertices[corners[c]]; };
        if (place(0) != place(1) && place(1) != place(2) && place(2) != place(0))  // of the closing corner of a ring
          to.triangles.push_back(corners);
      }
    }
    for (unsigned i = 0; i < geometry.getGeometriesCount(); ++i) add(geometry.getGeometry(i), to, depth + 1);
  }

  /// A geometry in a frame of its own, which several objects may show.
  void implicit(const citygml::ImplicitGeometry& geometry, CityClass type, const std::string& id, unsigned lod) {
    std::vector<const citygml::Geometry*> shown;
    for (unsigned i = 0; i < geometry.getGeometriesCount(); ++i)
      if (geometry.getGeometry(i).getLOD() == lod) shown.push_back(&geometry.getGeometry(i));
    const auto [known, is_new] = shared_.try_emplace({shown, type});
    if (is_new) {
      Surfaces surfaces;
      for (const citygml::Geometry* const one : shown) add(*one, surfaces, 0);
      if (!surfaces.triangles.empty()) known->second = mesh(type, std::move(surfaces));
    }
    if (!known->second) return;
    const double* const m = geometry.getTransformMatrix().getMatrix();  // row by row
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) keep("last row of a transformationMatrix");
    const TVec3d at = geometry.getReferencePoint();
    const Matrix3 linear(Vec3(m[0], m[4], m[8]), Vec3(m[1], m[5], m[9]), Vec3(m[2], m[6], m[10]));
    const Vec3 shift(m[3] + at.x, m[7] + at.y, m[11] + at.z);
    scene_.nodes.push_back({.name = id, .place = {linear, shift}, .meshes = {*known->second}});
  }

  std::uint32_t mesh(CityClass type, Surfaces surfaces) {
    const auto [number, is_new] = materials_.try_emplace(type, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      const CityClassRule rule = rule_of(type);
      RawMaterial& material = scene_.materials.emplace_back();
      material.name = type == CityClass::COT_TINRelief ? "TINRelief" : citygml::cityObjectsTypeToString(type);
      material.optics.classification = rule.classification;
      material.optics.ground = rule.ground;
    }
    scene_.meshes.push_back({.material = number->second,
                             .precise = std::move(surfaces.vertices),
                             .triangles = std::move(surfaces.triangles)});
    return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
  }

  const std::filesystem::path& path_;
  const CityGmlSettings& settings_;
  std::string name_;  ///< of the reference system
  RawScene scene_;
  std::map<CityClass, std::uint32_t> materials_;
  std::set<const citygml::Polygon*> taken_;  ///< of the current object
  double largest_ = 0, farthest_ = 0;        ///< size and coordinates of objects, as far as they are their own
  std::set<const FormatRule*> kept_;         ///< rules of items of the file
  std::map<std::pair<std::vector<const citygml::Geometry*>, CityClass>, std::optional<std::uint32_t>> shared_;
};

}  // namespace detail

/// True for a name that ends in `.gml` or `.citygml`.
[[nodiscard]] inline bool is_citygml(const std::filesystem::path& path) {
  const std::string ending = text::lower(path.extension().string());
  return ending == ".gml" || ending == ".citygml";
}

/// Reads the surfaces of a CityGML file, in metres, without closure surfaces and textures. Source:
/// OGC City Geography Markup Language 2.0 (12-019); LAS 1.4 R15, table 17. @throws SettingError
/// @throws FileError for a missing or damaged file, coordinates in degrees or a document type
[[nodiscard]] inline CityGml read_citygml(const std::filesystem::path& path, const CityGmlSettings& settings = {},
                                          const Workers& workers = {}) {
  settings.validate();
  return reading(path, [&] {
    const auto import = [&](const auto&) { return detail::CityGmlImport(path, settings).read(); };
    const auto scene = settings.isolated ? detail::imported_apart(path, settings.limits, import) : import(0);
    const MeshFileSettings plain{.materials = settings.materials, .spectra = settings.spectra};
    CityGml city{.file = detail::MeshFileMaker(path, scene, plain, workers).make(),
                 .epsg = detail::epsg_of(scene.reference)};
    detail::replace_materials(city.file, plain);
    return city;
  });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
