// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/trajectory/format.hpp>

#include <string>

#include <doctest/doctest.h>

namespace pulsecast::io {
namespace {

TEST_CASE("the formats that have a name can be") {
  for (const TrajectoryFormat& format : {csv_format(), helios_format(), helios_output_format(), tum_format()})
    CHECK_NOTHROW(format.validate());
}

TEST_CASE("impossible formats are refused") {
  TrajectoryFormat format;
  format.separator = '.';
  CHECK_THROWS_AS(format.validate(), SettingError);
  format = {};
  format.angles.turns[0].axis = axis::right;
  CHECK_THROWS_AS(format.validate(), SettingError);
  format = {};
  format.columns.clear();
  CHECK_THROWS_AS(format.validate(), SettingError);
  format = {};
  format.columns[4] = "rol_deg";
  CHECK_THROWS_WITH_AS(format.validate(), doctest::Contains("'roll_deg'"), SettingError);
  format.left_out = {"rol_deg"};
  CHECK_NOTHROW(format.validate());
  format = {};
  for (const char* name : {"roll,deg", "roll;deg", "#roll_deg", "roll\n_deg", "\"roll_deg\""}) {
    CAPTURE(name);
    format.columns[4] = name;
    CHECK_THROWS_AS(format.validate(), SettingError);
  }
  format.columns[4] = "Roll [deg]";
  CHECK_NOTHROW(format.validate());
  format.separator = ' ';
  CHECK_THROWS_AS(format.validate(), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
