// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_REFERENCE_HPP
#define PULSECAST_IO_REFERENCE_HPP

#include <memory>

#include <proj.h>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/spatial_reference.hpp>

/// Reference systems by PROJ, without network. Each call has a context of its own. In a program that includes this
/// header, readers of files ask PROJ for the units of systems that these name by codes alone.
namespace PULSECAST_NAMESPACE::io {

/// Reference by a text, or else by codes, also of a compound system, with its units, codes and WKT 1 for LAS. Heights
/// are in metres without a vertical system. `name` is that of a text in messages, such as its file. Source: OGC 01-009.
/// @throws FileError for a system that PROJ does not know, that is not projected, whose axes do not go east and north
/// or whose heights go down, and that WKT 1 cannot express; if PROJ finds no database
[[nodiscard]] SpatialReference complete_reference(const SpatialReference& given, const std::string& name = {});

/// Projector from latitude and longitude in `from`, or for 0 in the datum of `to`, to the map `to`, by EPSG codes. The
/// first point chooses the operation. Copies share it: each thread needs a projector of its own.
/// @throws FileError for other systems. So does the projector outside the area of the operation, and for one that is
/// ballpark, errs by more than 0.1 m or lacks its grid
[[nodiscard]] MapProjector map_projector(std::uint16_t from, std::uint16_t to);

namespace detail {

struct ProjDeleter {
  void operator()(PJ_CONTEXT* one) const noexcept { proj_context_destroy(one); }
  void operator()(PJ* one) const noexcept { proj_destroy(one); }
  void operator()(PJ_OBJ_LIST* one) const noexcept { proj_list_destroy(one); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* one) const noexcept { proj_operation_factory_context_destroy(one); }
};
using ProjObject = std::unique_ptr<PJ, ProjDeleter>;

/// Context of PROJ for one name, which begins its errors.
class Proj {
 public:
  explicit Proj(std::string name) : name_(std::move(name)) {
    proj_log_level(*this, PJ_LOG_NONE);
    proj_context_set_enable_network(*this, 0);
    if (proj_context_get_database_path(*this) == nullptr)
      fail("needs the database of PROJ, proj.db: expected the Debian package proj-data, or its folder in PROJ_DATA");
  }

  operator PJ_CONTEXT*() const noexcept { return context_.get(); }

  [[noreturn]] void fail(const auto&... problem) const { throw FileError(name_, "", text::message(problem...)); }

  [[nodiscard]] ProjObject system(const std::string& definition, std::string_view otherwise) const {
    ProjObject found(proj_create(*this, definition.c_str()));
    if (!found || proj_is_crs(found.get()) == 0) fail(otherwise);
    return found;
  }

  /// Horizontal or vertical system, 0 or 1, of a compound one, or the system; without its way to WGS 84.
  [[nodiscard]] ProjObject part(const PJ* whole, int index) const {
    ProjObject found(proj_get_type(whole) == PJ_TYPE_COMPOUND_CRS ? proj_crs_get_sub_crs(*this, whole, index)
                                                                  : proj_clone(*this, whole));
    if (found && proj_get_type(found.get()) == PJ_TYPE_BOUND_CRS) found.reset(proj_get_source_crs(*this, found.get()));
    return found;
  }

  struct Axis {
    std::string direction{};  ///< as in "east"; empty if the system has no such axis
    double unit = 1;          ///< [m]
  };
  [[nodiscard]] Axis axis(const PJ* system, int index) const {
    const ProjObject axes(proj_crs_get_coordinate_system(*this, system));
    const char* way = nullptr;
    double unit = 1;
    if (!axes ||
        proj_cs_get_axis_info(*this, axes.get(), index, nullptr, nullptr, &way, &unit, nullptr, nullptr, nullptr) == 0)
      return {};
    return {way, unit};
  }

  /// EPSG code of a system; 0 if it has none.
  [[nodiscard]] static std::uint16_t code(const PJ* system) {
    const char *authority = proj_get_id_auth_name(system, 0), *code = proj_get_id_code(system, 0);
    if (authority == nullptr || code == nullptr || std::string_view(authority) != "EPSG") return 0;
    return text::number_in<std::uint16_t>(code).value_or(0);
  }

  /// Horizontal system with axes to the east and north. @throws FileError
  [[nodiscard]] ProjObject projected(const PJ* whole) const {
    ProjObject system = part(whole, 0);
    const PJ_TYPE type = system ? proj_get_type(system.get()) : PJ_TYPE_UNKNOWN;
    if (type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS)
      fail("is in degrees (a geographic reference system): expected a projected one");
    if (type != PJ_TYPE_PROJECTED_CRS)
      fail("is not a projected reference system, alone or with a vertical one: expected such a one");
    const std::string first = axis(system.get(), 0).direction, second = axis(system.get(), 1).direction;
    const bool is_polar = first == second && first != "west";  // along two meridians
    const auto is_usual = [](const std::string& way) { return way == "east" || way == "north"; };
    if (!is_polar && !(is_usual(first) && is_usual(second)))
      fail("has axes to the ", first, " and ", second, ": expected a system to the east and north");
    return system;
  }

 private:
  std::string name_;
  std::unique_ptr<PJ_CONTEXT, ProjDeleter> context_{proj_context_create()};
};

/// Name of codes, as in "EPSG:25832+7837".
[[nodiscard]] inline std::string epsg_name(std::uint16_t code, std::uint16_t vertical = 0) {
  return vertical == 0 ? text::message("EPSG:", code) : text::message("EPSG:", code, '+', vertical);
}

/// Chooses the operation at the first point.
class ProjProjector {
 public:
  ProjProjector(std::uint16_t from, std::uint16_t to)
      : proj_(epsg_name(from == 0 ? to : from)), to_(proj_.system(epsg_name(to), unknown)) {
    to_ = proj_.projected(to_.get());
    const ProjObject base(proj_crs_get_geodetic_crs(proj_, to_.get()));
    from_ = proj_.system(epsg_name(from == 0 ? Proj::code(base.get()) : from), unknown);
    const PJ_TYPE type = proj_get_type(from_.get());
    if (type == PJ_TYPE_GEOGRAPHIC_3D_CRS || type == PJ_TYPE_COMPOUND_CRS)
      proj_.fail("has heights: expected a system of latitude and longitude alone, as heights are kept");
    if (type != PJ_TYPE_GEOGRAPHIC_2D_CRS) proj_.fail("is not in degrees: expected a geographic reference system");
    same_datum_ = proj_is_equivalent_to_with_ctx(proj_, from_.get(), base.get(),
                                                 PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS) != 0;
    base_ = text::message(epsg_name(Proj::code(base.get())), " (", proj_get_name(base.get()), ")");
    unit_ = proj_.axis(to_.get(), 0).unit;
  }

  [[nodiscard]] MapPoint operator()(double longitude, double latitude) {
    if (!(std::fabs(longitude) <= 360) || !(std::fabs(latitude) <= 90))
      proj_.fail("has no place at longitude ", longitude, ", latitude ", latitude, ": expected degrees");
    if (!operation_) choose(longitude, latitude);
    const double aside = std::fabs(std::remainder(longitude - (west_ + east_) / 2, 360)) - (east_ - west_) / 2;
    const double margin = same_datum_ ? 3 : nearby;  // half a zone of UTM: states extend zones so far [deg]
    if (latitude < south_ - margin || latitude > north_ + margin || aside > margin)
      proj_.fail("has longitude ", longitude, ", latitude ", latitude, " outside the area of '",
                 proj_get_name(operation_.get()), "': expected a system for that place");
    const Vec2 place = at(longitude, latitude);
    constexpr double step = 1e-4;  // 11 m [deg]
    const Vec2 northward = at(longitude, latitude + step) - at(longitude, latitude - step);
    return {place, std::atan2(northward.x, northward.y)};
  }

 private:
  static constexpr const char* unknown = "is unknown to PROJ: expected a code that epsg.org lists";
  static constexpr double nearby = 1e-3;  // [deg]

  [[nodiscard]] Vec2 at(double longitude, double latitude) const {
    const PJ_COORD to = proj_trans(operation_.get(), PJ_FWD, proj_coord(longitude, latitude, 0, 0));
    if (!std::isfinite(to.xy.x) || !std::isfinite(to.xy.y))
      proj_.fail("cannot be projected at longitude ", longitude, ", latitude ", latitude,
                 ": expected a place in its area");
    return {to.xy.x * unit_, to.xy.y * unit_};
  }

  void choose(double longitude, double latitude) {
    const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, ProjDeleter> search(
        proj_create_operation_factory_context(proj_, nullptr));
    proj_operation_factory_context_set_allow_ballpark_transformations(proj_, search.get(), 0);
    proj_operation_factory_context_set_grid_availability_use(proj_, search.get(), PROJ_GRID_AVAILABILITY_IGNORED);
    proj_operation_factory_context_set_area_of_interest(proj_, search.get(), longitude - nearby, latitude - nearby,
                                                        longitude + nearby, latitude + nearby);
    const std::unique_ptr<PJ_OBJ_LIST, ProjDeleter> all(
        proj_create_operations(proj_, from_.get(), to_.get(), search.get()));
    std::string why, grid;
    for (int i = 0; all && i < proj_list_get_count(all.get()); ++i) {
      ProjObject one(proj_list_get(proj_, all.get(), i));
      const double error = proj_coordoperation_get_accuracy(proj_, one.get());  // below 0: unknown
      const std::string missing = missing_grid(one.get());
      constexpr double largest_error = 0.1;  // [m]
      const bool is_exact = same_datum_ || (error >= 0 && error <= largest_error);
      if (is_exact && missing.empty()) {
        operation_.reset(proj_normalize_for_visualization(proj_, one.get()));
        if (!operation_) break;
        (void)proj_get_area_of_use(proj_, one.get(), &west_, &south_, &east_, &north_, nullptr);
        if (east_ < west_) east_ += 360;
        return;
      }
      if (is_exact && grid.empty()) grid = text::message("; PROJ finds no grid ", missing, " in its folders");
      if (why.empty())
        why = text::message("; '", proj_get_name(one.get()), "' errs by ",
                            error < 0 ? "an unknown length" : text::message(error, " m"));
    }
    proj_.fail("cannot be projected to ", proj_get_name(to_.get()), " to 0.1 m: expected latitude and longitude in ",
               base_, grid.empty() ? why : grid);
  }

  [[nodiscard]] std::string missing_grid(const PJ* operation) const {
    for (int k = 0; k < proj_coordoperation_get_grid_used_count(proj_, operation); ++k) {
      const char* name = nullptr;
      int available = 0;
      (void)proj_coordoperation_get_grid_used(proj_, operation, k, &name, nullptr, nullptr, nullptr, nullptr, nullptr,
                                              &available);
      if (available == 0) return name == nullptr ? "that it needs" : name;
    }
    return {};
  }

  Proj proj_;
  ProjObject to_, from_, operation_;
  std::string base_;
  bool same_datum_ = false;
  double unit_ = 1, west_ = -180, south_ = -90, east_ = 180, north_ = 90;  // [m], [deg]
};

}  // namespace detail

inline SpatialReference complete_reference(const SpatialReference& given, const std::string& name) {
  const bool by_text = !given.wkt.empty();
  const std::string codes = detail::epsg_name(given.epsg, given.vertical_epsg);
  const detail::Proj proj(!by_text ? codes : name.empty() ? "the well-known text" : name);
  const detail::ProjObject whole = proj.system(
      by_text ? given.wkt : codes, by_text ? "is not understood by PROJ: expected the text of a reference system"
                                           : "is unknown to PROJ: expected codes that epsg.org lists");
  const detail::ProjObject horizontal = proj.projected(whole.get());
  const bool is_compound = proj_get_type(whole.get()) == PJ_TYPE_COMPOUND_CRS;
  const detail::ProjObject vertical = proj.part(whole.get(), 1);  // of three axes, if not compound
  const detail::Proj::Axis up = proj.axis(vertical.get(), is_compound ? 0 : 2);
  if (up.direction == "down") proj.fail("has depths, by its vertical system: expected one of heights");
  SpatialReference found{.epsg = detail::Proj::code(horizontal.get()),
                         .vertical_epsg = is_compound ? detail::Proj::code(vertical.get()) : std::uint16_t{0},
                         .unit = proj.axis(horizontal.get(), 0).unit,
                         .vertical_unit = up.unit};
  const char* const options[] = {"MULTILINE=NO", "ALLOW_ELLIPSOIDAL_HEIGHT_AS_VERTICAL_CRS=YES", nullptr};
  const char* const wkt = proj_as_wkt(proj, whole.get(), PJ_WKT1_GDAL, options);
  if (wkt == nullptr) proj.fail("cannot be written as WKT 1, which LAS files need: expected another system, or none");
  found.wkt = wkt;
  return found;
}

namespace detail {
/// Lets readers ask PROJ.
inline const bool is_database_set = (reference_database = &complete_reference) != nullptr;
}  // namespace detail

inline MapProjector map_projector(std::uint16_t from, std::uint16_t to) {
  const auto shared = std::make_shared<detail::ProjProjector>(from, to);
  return [shared](double longitude, double latitude) { return (*shared)(longitude, latitude); };
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
