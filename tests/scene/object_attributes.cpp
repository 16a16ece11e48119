// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/object_attributes.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/refused_field.hpp"

using namespace pulsecast;
using pulsecast::support::refused_field;

namespace {

using Map = Scene<TriangleMesh<>>;

/// Triangle of an object with attributes.
Map::Part part(ObjectId object, std::vector<Attribute> all) {
  static const auto triangle =
      std::make_shared<const TriangleMesh<>>(MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  return {
      .geometry = triangle, .object = object, .attributes = all.empty() ? Attributes{} : attributes(std::move(all))};
}

std::vector<double> values_of(const ObjectAttributes& all, ObjectId object) {
  const std::span<const double> values = all.of(object);
  return {values.begin(), values.end()};
}

}  // namespace

TEST_CASE("an object has the attributes of its parts, in the order of their first use in the scene") {
  const Map scene({part(7, {{"species", 3}, {"age", 120}}), part(2, {{"leaf", 1}, {"age", 8.5}}), part(9, {})});
  const ObjectAttributes known(scene.parts());
  REQUIRE(known.names() == std::vector<std::string>{"species", "age", "leaf"});
  CHECK_FALSE(known.empty());
  CHECK(known.of(7)[0] == 3);
  CHECK(known.of(7)[1] == 120);
  CHECK(std::isnan(known.of(7)[2]));
  CHECK(std::isnan(known.of(2)[0]));
  CHECK(known.of(2)[1] == 8.5);
  CHECK(known.of(2)[2] == 1);
}

TEST_CASE("objects without attributes, and those that no part has, have NaN for each name") {
  const std::vector<Map::Part> parts{part(5, {{"age", 1}}), part(8, {})};
  const ObjectAttributes known{std::span(std::as_const(parts))};
  for (const ObjectId object : {0u, 4u, 6u, 8u, std::numeric_limits<ObjectId>::max()}) {
    CAPTURE(object);
    REQUIRE(known.of(object).size() == 1);
    CHECK(std::isnan(known.of(object)[0]));
  }
}

TEST_CASE("scenes without attributes have no names, and no values of any object") {
  const std::vector<Map::Part> parts{part(5, {})};
  for (const ObjectAttributes& known : {ObjectAttributes(), ObjectAttributes(std::span(std::as_const(parts)))}) {
    CHECK(known.empty());
    CHECK(known.names().empty());
    CHECK(known.of(5).empty());
  }
}

TEST_CASE("several parts of an object give it all their attributes, and may repeat a value but not change it") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Map::Part> stem_and_crown{part(1, {{"species", 4}, {"health", unknown}}),
                                              part(1, {{"species", 4}, {"height", 21}, {"health", unknown}})};
  const ObjectAttributes tree{std::span(std::as_const(stem_and_crown))};
  REQUIRE(tree.names() == std::vector<std::string>{"species", "health", "height"});
  CHECK(tree.of(1)[0] == 4);
  CHECK(std::isnan(tree.of(1)[1]));
  CHECK(tree.of(1)[2] == 21);

  const auto refused = [](double first, double second) {
    const std::vector<Map::Part> parts{part(3, {{"age", first}}), part(4, {{"age", second}}),
                                       part(3, {{"age", second}})};
    return refused_field([&] { ObjectAttributes{std::span(std::as_const(parts))}; });
  };
  CHECK(refused(1, 1).empty());
  CHECK(refused(1, 2) == "Part::attributes 'age' of object 3");
  CHECK(refused(1, unknown) == "Part::attributes 'age' of object 3");
  CHECK(refused(unknown, 1) == "Part::attributes 'age' of object 3");
}

TEST_CASE("of very many objects, each has its own values") {
  std::vector<Map::Part> parts;
  for (ObjectId n = 0; n < 1000; ++n)
    parts.push_back(part(n * 2654435761u, {{"number", 1.0 * n}, {n % 2 == 0 ? "even" : "odd", 1}}));
  const ObjectAttributes known{std::span(std::as_const(parts))};
  REQUIRE(known.names().size() == 3);
  for (ObjectId n = 0; n < 1000; ++n) {
    const std::vector<double> values = values_of(known, n * 2654435761u);
    CHECK(values[0] == n);
    CHECK(std::isnan(values[n % 2 == 0 ? 2 : 1]));
    CHECK(values[n % 2 == 0 ? 1 : 2] == 1);
  }
}

TEST_CASE("attributes without a name, and two of one name, are refused") {
  const auto refused = [](std::vector<Attribute> all) {
    return refused_field([&] { (void)attributes(std::move(all)); });
  };
  CHECK(refused({}).empty());
  CHECK(refused({{"age", 1}, {"Age", 1}}).empty());
  CHECK(refused({{"", 1}}) == "Attribute::name (number of '')");
  CHECK(refused({{"age", 1}, {"leaf", 1}, {"age", 1}}) == "Attribute::name (number of 'age')");
}
