// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_layout.hpp>

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast::io {
namespace {

TEST_CASE("the layouts of drivers have the sizes and offsets of what they publish") {
  CHECK(layouts::velodyne().size == 22);
  CHECK(layouts::velodyne().fields[5].offset == 18);
  CHECK(layouts::hesai().size == 26);
  CHECK(layouts::hesai().fields[5].offset == 18);
  CHECK(layouts::livox().size == 26);
  CHECK(layouts::livox().fields[6].offset == 18);
  CHECK(layouts::ouster().size == 48);
  CHECK(layouts::autoware().size == 32);
  CHECK(layouts::autoware().fields[6].offset == 16);
  CHECK(layouts::map().fields[3].offset == 24);
  for (const PointLayout& layout :
       {layouts::velodyne(), layouts::hesai(), layouts::livox(), layouts::ouster(), layouts::autoware(), layouts::map(),
        layouts::velodyne().with(layouts::labels()), layouts::map().with(layouts::colours()),
        layouts::map().with(layouts::deep_colours()), layouts::xyzi().with(layouts::packed_colour())})
    layout.validate();
}

TEST_CASE("fields behind a padded layout begin behind its padding") {
  const PointLayout layout = layouts::ouster().with(layouts::labels());
  CHECK(layout.fields[9].offset == 48);
  CHECK(layout.needs(PointNeed::surface));
  CHECK_FALSE(layouts::ouster().needs(PointNeed::surface));
}

TEST_CASE("attributes have a field each, by their names") {
  const std::vector<std::string> names{"age", "species"};
  const PointLayout layout =
      layouts::xyzi().with(layouts::attributes(names, NumberType::uint16)).with(layouts::colours());
  REQUIRE(layout.fields.size() == 9);
  CHECK((layout.fields[4].name == "age" && layout.fields[5].name == "species" && layout.fields[6].name == "red"));
  CHECK((layout.fields[4].offset == 16 && layout.fields[5].offset == 18 && layout.fields[6].offset == 20 &&
         layout.size == 23));
  CHECK((layout.needs(PointNeed::attribute) && layout.needs(PointNeed::colour)));
  CHECK_FALSE(layouts::map().needs(PointNeed::colour));
}

TEST_CASE("fields that overlap or leave the record are refused") {
  PointLayout layout = layouts::velodyne();
  layout.fields[5].offset = 17;
  CHECK_THROWS_AS(layout.validate(), SettingError);
  layout.fields[5].offset = 19;
  CHECK_THROWS_AS(layout.validate(), SettingError);
  CHECK_THROWS_AS(PointLayout{}.validate(), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
