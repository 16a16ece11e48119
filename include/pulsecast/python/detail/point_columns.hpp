// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_POINT_COLUMNS_HPP
#define PULSECAST_PYTHON_DETAIL_POINT_COLUMNS_HPP

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/python/detail/point_rows.hpp>
#include <pulsecast/python/detail/rows.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Data of points beyond their rows. A survey's run keeps its attributes, and its colours on request.
struct PointExtras {
  PointColours colours{};         ///< colours of echoes, see `colours_of`; empty: unknown
  ObjectAttributes attributes{};  ///< attributes of objects, a column each

  /// @throws SettingError for an attribute of the name of another column
  void validate() const {
    std::vector<std::string> taken(colour_names.begin(), colour_names.end());
    std::apply([&](const auto&... member) { (taken.emplace_back(member.name), ...); }, point_members);
    for (const std::string& name : attributes.names())
      if (std::find(taken.begin(), taken.end(), name) != taken.end())
        throw SettingError("Part::attributes '" + name + "' (number of such columns)", 2, "",
                           "1: another name than those of points");
  }

  /// Columns of colours.
  static constexpr std::array<const char*, 4> colour_names{"red", "green", "blue", "near_infrared"};
};

/// Extras of the points of a scene, which must outlive the survey: colours, and attributes of its parts.
template <class World>
[[nodiscard]] PointExtras extras_of(const World& world) {
  return {colours_of(world), ObjectAttributes(world.parts())};
}

/// Columns of the points of a run: numbers of all points, one after another.
class PointColumns {
 public:
  /// `whole`: true for the columns of `PointRow`, too. Colours are kept if `extras` has them, and black where unknown.
  PointColumns(bool whole, PointExtras extras) : whole_(whole), extras_(std::move(extras)) {
    extras_.validate();
    attributes_.resize(extras_.attributes.names().size());
  }

  /// Appends a point.
  void push_back(const EchoBatch& batch, const Shot& shot, const Echo& echo, const PointRow& row) {
    if (whole_) push_members(row, std::make_index_sequence<std::tuple_size_v<Members>>());
    if (extras_.colours) {
      const PointColour c = extras_.colours(batch, shot, echo).value_or(PointColour{});
      for (std::size_t k = 0; k < colours_.size(); ++k)
        colours_[k].push_back(std::array{c.red, c.green, c.blue, c.near_infrared}[k]);
    }
    if (attributes_.empty()) return;
    const std::span<const double> values = extras_.attributes.of(echo.object);
    for (std::size_t k = 0; k < attributes_.size(); ++k) attributes_[k].push_back(values[k]);
  }

  /// Columns so far, as NumPy arrays by name; leaves this empty. Requires the GIL.
  [[nodiscard]] pybind11::dict take() {
    pybind11::dict columns;
    if (whole_) take_members(columns, std::make_index_sequence<std::tuple_size_v<Members>>());
    for (std::size_t k = 0; extras_.colours && k < colours_.size(); ++k)
      columns[PointExtras::colour_names[k]] = colours_[k].take();
    for (std::size_t k = 0; k < attributes_.size(); ++k)
      columns[extras_.attributes.names()[k].c_str()] = attributes_[k].take();
    return columns;
  }

 private:
  template <class... Member>
  static std::tuple<Rows<typename Member::Number>...> columns_of(const std::tuple<Member...>&);
  using Members = decltype(columns_of(point_members));

  template <std::size_t... K>
  void push_members(const PointRow& row, std::index_sequence<K...>) {
    (std::get<K>(members_).push_back(row.*std::get<K>(point_members).member), ...);
  }
  template <std::size_t... K>
  void take_members(pybind11::dict& columns, std::index_sequence<K...>) {
    ((columns[std::get<K>(point_members).name] = std::get<K>(members_).take()), ...);
  }

  bool whole_;
  PointExtras extras_;
  Members members_;
  std::array<Rows<std::uint16_t>, PointExtras::colour_names.size()> colours_;
  std::vector<Rows<double>> attributes_;
};

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
