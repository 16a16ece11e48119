// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "settings.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/material/lambert.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/normalized_phong.hpp>
#include <pulsecast/material/phong.hpp>
#include <pulsecast/material/tabulated.hpp>
#include <pulsecast/platform/block_flight.hpp>

#include "../field_list.hpp"

namespace py = pybind11;
using namespace pulsecast;

namespace {

/// Description of a struct or enum, generated from the header by `describe_settings.py`.
template <class Settings>
struct Described;
#include <settings_members.inc>

// A law, or what a program plans by: no settings of documents.
using AnyLaw = std::variant<Lambert, DirectionIndependent, Phong, NormalizedPhong, Microfacet, Tabulated>;

template <class T>
concept Struct = requires {
  Described<T>::doc;
};
template <class T>
concept Enum = std::is_enum_v<T>;
template <class T>
concept Tabled = requires(T& settings, helios::FieldIo& io) {
  settings.fields(io);
};

template <class T, template <class...> class Template>
inline constexpr bool is_a = false;
template <template <class...> class Template, class... Types>
inline constexpr bool is_a<Template<Types...>, Template> = true;
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;

template <class T>
inline constexpr bool is_list = is_a<T, std::vector> || is_a<T, SharedArray> || is_array<T>;

template <class T>
inline constexpr bool is_number =
    std::same_as<T, double> || std::same_as<T, int> || std::same_as<T, std::optional<double>>;

/// The Python class of a struct; as the module, it is never taken down.
template <Struct Settings>
py::handle& class_of() {
  static py::handle made;
  return made;
}

// ---------------------------------------------------------------------------------------------- to
// Python

template <class T>
py::object object_of(const T& value) {
  if constexpr (Enum<T>) {
    return py::str(Described<T>::values[static_cast<std::size_t>(value)]);
  } else if constexpr (std::same_as<T, std::filesystem::path>) {
    return py::str(value.string());
  } else if constexpr (std::same_as<T, Vec3>) {
    return py::make_tuple(value.x, value.y, value.z);
  } else if constexpr (std::same_as<T, Box>) {
    return py::make_tuple(object_of(value.min), object_of(value.max));
  } else if constexpr (std::same_as<T, char>) {
    return py::str(&value, 1);
  } else if constexpr (is_a<T, std::optional>) {
    return value ? object_of(*value) : py::none();
  } else if constexpr (is_a<T, std::variant>) {
    return std::visit([](const auto& one) { return object_of(one); }, value);
  } else if constexpr (is_list<T>) {
    py::list all;
    for (const auto& one : value) all.append(object_of(one));
    return all;
  } else if constexpr (Struct<T>) {
    py::list members;
    Described<T>::members(value, [&](const char*, const auto& member, auto...) { members.append(object_of(member)); });
    return class_of<T>()(*members);
  } else {
    return py::cast(value);
  }
}

// -------------------------------------------------------------------------------------------- from
// Python

[[noreturn]] void refuse(const std::string& where, const std::string& expected, py::handle found) {
  throw py::type_error(where + ": expected " + expected + ", not " + std::string(py::repr(found)));
}

template <class T>
T value_of(py::handle object, const std::string& where);

template <class T>
T number_of(py::handle object, const std::string& where) {
  if (PyBool_Check(object.ptr())) refuse(where, "a number", object);
  if constexpr (std::floating_point<T>) {
    const double number = PyFloat_AsDouble(object.ptr());
    if (number == -1 && PyErr_Occurred()) {
      PyErr_Clear();
      refuse(where, "a number", object);
    }
    if (std::isnan(number)) throw SettingError(where, number, "", "a number");
    return number;
  } else {
    const py::object whole = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
    if (!whole) {
      PyErr_Clear();
      refuse(where, "a whole number", object);
    }
    try {
      return whole.cast<T>();
    } catch (const py::cast_error&) {
      refuse(where, std::is_unsigned_v<T> ? "a whole number that is not negative" : "a whole number of 32 bits",
             object);
    }
  }
}

template <class Variant, std::size_t I = 0>
Variant alternative_of(py::handle object, const std::string& where, std::string names = {}) {
  if constexpr (I == std::variant_size_v<Variant>) {
    refuse(where, names, object);
  } else {
    using One = std::variant_alternative_t<I, Variant>;
    if (py::isinstance(object, class_of<One>())) return value_of<One>(object, where);
    return alternative_of<Variant, I + 1>(object, where,
                                          std::move(names) + (I > 0 ? " or " : "") + Described<One>::name);
  }
}

/// Refuses members beyond their limits in documents, by their names here and there.
template <Tabled Settings>
void check(Settings& settings, const std::string& where) {
  try {
    helios::check_fields(settings);
  } catch (const SettingError& error) {
    const FieldList list(settings);
    Described<Settings>::members(settings, [&](const char* name, auto& member, auto...) {
      for (const FieldList::Row& row : list.rows())
        if (row.name == error.field() && row.is_of(member) && !std::isnan(error.value()))
          throw SettingError(where + "." + name + " (" + error.field() + ")", error.value(), error.unit(),
                             error.allowed());
    });
    throw error.of(where);
  }
}

template <Enum T>
T enum_of(py::handle object, const std::string& where) {
  std::string names;
  for (std::size_t i = 0; i < Described<T>::values.size(); ++i) {
    if (py::str(Described<T>::values[i]).equal(object)) return static_cast<T>(i);
    names += std::string(i > 0 ? " or '" : "'") + Described<T>::values[i] + "'";
  }
  refuse(where, names, object);
}

template <Struct T>
T settings_of(py::handle object, const std::string& where) {
  if (!py::isinstance(object, class_of<T>())) refuse(where, Described<T>::name, object);
  T settings;
  Described<T>::members(settings, [&](const char* name, auto& member, auto...) {
    member = value_of<std::remove_cvref_t<decltype(member)>>(py::object(object.attr(name)), where + "." + name);
  });
  if constexpr (Tabled<T>) check(settings, where);
  return settings;
}

template <class T>
T value_of(py::handle object, const std::string& where) {
  if constexpr (Enum<T>) {
    return enum_of<T>(object, where);
  } else if constexpr (std::same_as<T, bool>) {
    py::detail::make_caster<bool> truth;  // Python's, or NumPy's
    if (!truth.load(object, false)) refuse(where, "True or False", object);
    return py::detail::cast_op<bool>(truth);
  } else if constexpr (std::same_as<T, std::string>) {
    py::detail::make_caster<std::string> text;
    if (!py::isinstance<py::str>(object) || !text.load(object, false))
      refuse(where, "a text", object);  // of Unicode: no halves of pairs
    return py::detail::cast_op<std::string>(std::move(text));
  } else if constexpr (std::same_as<T, char>) {
    const auto text = value_of<std::string>(object, where);
    if (text.size() != 1) refuse(where, "one character", object);
    return text.front();
  } else if constexpr (std::same_as<T, std::filesystem::path>) {
    const py::object path = py::reinterpret_steal<py::object>(PyOS_FSPath(object.ptr()));
    if (!path || !py::isinstance<py::str>(path)) {
      PyErr_Clear();
      refuse(where, "a path", object);
    }
    return path.cast<std::string>();
  } else if constexpr (std::same_as<T, Vec3>) {
    const auto [x, y, z] = value_of<std::array<double, 3>>(object, where);
    return {x, y, z};
  } else if constexpr (std::same_as<T, Box>) {
    const auto [low, high] = value_of<std::array<std::array<double, 3>, 2>>(object, where);
    return {Vec3{low[0], low[1], low[2]}, Vec3{high[0], high[1], high[2]}};
  } else if constexpr (is_a<T, SharedArray>) {
    return value_of<std::vector<std::remove_cvref_t<decltype(T()[0])>>>(object, where);
  } else if constexpr (is_a<T, std::optional>) {
    if (object.is_none()) return std::nullopt;
    return value_of<typename T::value_type>(object, where);
  } else if constexpr (is_a<T, std::variant>) {
    return alternative_of<T>(object, where);
  } else if constexpr (is_a<T, std::vector> || is_array<T>) {
    if (py::isinstance<py::str>(object) || !PySequence_Check(object.ptr())) refuse(where, "a list", object);
    const auto sequence = py::reinterpret_borrow<py::sequence>(object);
    const std::size_t n = py::len(sequence);
    T all{};
    if constexpr (is_array<T>) {
      if (n != all.size()) refuse(where, "a list of " + std::to_string(all.size()), object);
    } else {
      all.resize(n);
    }
    for (std::size_t i = 0; i < n; ++i)
      all[i] = value_of<typename T::value_type>(py::object(sequence[i]), where + "[" + std::to_string(i) + "]");
    return all;
  } else if constexpr (Struct<T>) {
    return settings_of<T>(object, where);
  } else {
    return number_of<T>(object, where);
  }
}

// ----------------------------------------------------------------------------------------- classes

/// `==` of members: an array, a list and a tuple of equal numbers are equal.
bool equal(py::handle a, py::handle b) {
  const auto size_of = [](py::handle object) {
    const bool is_row = PySequence_Check(object.ptr()) && !py::isinstance<py::str>(object);
    const py::ssize_t size = is_row ? PySequence_Size(object.ptr()) : -1;
    if (size < 0) PyErr_Clear();  // an array without dimensions
    return size;
  };
  const py::ssize_t size = size_of(a);
  if (size < 0 || size != size_of(b)) return size < 0 && a.equal(b);
  for (py::ssize_t i = 0; i < size; ++i)
    if (!equal(py::object(a[py::int_(i)]), py::object(b[py::int_(i)]))) return false;
  return true;
}

template <Struct Settings>
py::object equal_settings(const py::object& a, const py::object& b) {
  if (!py::type::of(a).is(py::type::of(b))) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
  bool same = true;
  const Settings described{};
  Described<Settings>::members(described, [&](const char* name, auto&&...) {
    same = same && equal(py::object(a.attr(name)), py::object(b.attr(name)));
  });
  return py::bool_(same);
}

template <Struct Settings>
void bind(py::module_& m) {
  const py::module_ dataclasses = py::module_::import("dataclasses"), functools = py::module_::import("functools");
  const py::object deepcopy = py::module_::import("copy").attr("deepcopy");
  py::list members;
  std::string doc = std::string(Described<Settings>::doc) + "\n\n";
  Settings defaults{};
  std::vector<FieldList::Row> rows;
  if constexpr (Tabled<Settings>) rows = FieldList(defaults).rows();
  Described<Settings>::members(defaults, [&](const char* name, const auto& member, const char* type, const char* what) {
    const py::object first = functools.attr("partial")(deepcopy, object_of(member));
    members.append(py::make_tuple(name, type, dataclasses.attr("field")(py::arg("default_factory") = first)));
    doc += std::string(name) + ": " + type + "\n    " + what;
    using Member = std::remove_cvref_t<decltype(member)>;
    for (const FieldList::Row& row : rows)
      if (is_number<Member> && row.is_of(member)) doc += "; in documents: " + row.values;
    doc += "\n";
  });
  py::dict space;
  space["__doc__"] = doc;
  space["__module__"] = "pulsecast";
  space["__eq__"] = py::cpp_function(&equal_settings<Settings>, py::is_method(py::none()), py::name("__eq__"));
  const char* name = Described<Settings>::name;
  py::object made =
      dataclasses.attr("make_dataclass")(name, members, py::arg("namespace") = space, py::arg("slots") = true);
  m.attr(name) = made;
  class_of<Settings>() = made.release();
}

template <Struct... Settings>
void bind_all(py::module_& m, const std::tuple<Settings...>*) {
  (bind<Settings>(m), ...);
}

}  // namespace

void bind_settings(py::module_& m) { bind_all(m, static_cast<const AllSettings*>(nullptr)); }

py::object to_python(const helios::SurveySettings& settings) { return object_of(settings); }

helios::SurveySettings survey_of(py::handle settings) {
  return value_of<helios::SurveySettings>(settings, "SurveySettings");
}

helios::LegScannerSettings leg_scanner_of(py::handle settings) {
  return value_of<helios::LegScannerSettings>(settings, "LegScannerSettings");
}

BlockFlight block_flight_of(py::handle settings) { return value_of<BlockFlight>(settings, "BlockFlight"); }

SurfaceLaw law_of(py::handle law) {
  return std::visit([](const auto& of_kind) { return SurfaceLaw(of_kind); }, value_of<AnyLaw>(law, "law"));
}

py::object to_python(const std::vector<helios::LegSettings>& legs) { return object_of(legs); }

py::object to_python(const helios::AssetDocument& assets) {
  py::dict all;
  all["scanners"] = object_of(assets.scanners);
  all["platforms"] = object_of(assets.platforms);
  all["scenes"] = object_of(assets.scenes);
  return all;
}
