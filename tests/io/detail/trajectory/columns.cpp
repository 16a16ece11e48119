// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/trajectory/columns.hpp>

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/relative.hpp"

namespace pulsecast::io {
namespace {

using support::relative;

TEST_CASE("a name says what a column holds and in which unit") {
  struct Case {
    const char* name;
    Quantity quantity;
    double per_si;
  };
  for (const Case& c : {Case{"time_s", Quantity::time, 1},
                        {"t", Quantity::time, 1},
                        {"gpsTime", Quantity::time, 1},
                        {"timestamp_ns", Quantity::time, 1e9},
                        {"x", Quantity::x, 1},
                        {"Y [mm]", Quantity::y, 1e3},
                        {"z_km", Quantity::z, 1e-3},
                        {"Easting (m)", Quantity::east, 1},
                        {"height_m", Quantity::up, 1},
                        {"down_m", Quantity::down, 1},
                        {"roll_deg", Quantity::roll, degrees(1)},
                        {"PITCH_RAD", Quantity::pitch, 1},
                        {"heading_deg", Quantity::yaw, degrees(1)},
                        {"yaw", Quantity::yaw, degrees(1)},
                        {"qw", Quantity::qw, 1}}) {
    CAPTURE(c.name);
    const auto column = trajectory_column(c.name, AngleUnit::degree);
    REQUIRE(column);
    CHECK(column->quantity == c.quantity);
    CHECK(column->per_si == relative(c.per_si, 1e-15));
  }
  CHECK(trajectory_column("yaw", AngleUnit::radian)->per_si == 1);
  CHECK(trajectory_column("yaw_deg", AngleUnit::radian)->per_si == relative(degrees(1), 1e-15));
}

TEST_CASE("what is no name, or a unit of something else, is no column; and the nearest name is found") {
  for (const char* name : {"", "_", "tim", "x_deg", "roll_m", "qw_m", "roll_grad", "xyz", "\xC2\xB0"}) {
    CAPTURE(name);
    CHECK_FALSE(trajectory_column(name, AngleUnit::degree));
  }
  CHECK(nearest_trajectory_column("rol_deg") == "roll_deg");
  CHECK(nearest_trajectory_column("headnig_rad") == "heading_rad");
  CHECK(nearest_trajectory_column("tmie") == "time");
  CHECK(nearest_trajectory_column(std::string(100000, 'a')).size() > 0);
}

TrajectoryColumns columns(const std::vector<std::string>& names, const std::vector<std::string>& left_out = {}) {
  return {names, left_out, AngleUnit::degree};
}

TEST_CASE("columns may come in any order, and some be left out") {
  const TrajectoryColumns c = columns({"yaw", "Satellites", "north", "t", "east", "up"}, {"satellites"});
  CHECK(c.problem().empty());
  CHECK(c.all().size() == 6);
  CHECK_FALSE(c.all()[1]);
  CHECK(c.all()[3]->quantity == Quantity::time);
  CHECK(c.has(Quantity::yaw));
  CHECK_FALSE(c.has(Quantity::roll));
}

TEST_CASE("columns that do not make one pose are told apart") {
  CHECK(columns({"t", "x", "y", "z", "rol"}).problem() == "is not a known column: did you mean 'roll'? Others must be set as left out");
  CHECK(columns({"t", "x", "y", "z", "rol"}).culprit() == 4);
  CHECK(columns({"t", "x", "y", "z", "heading", "yaw"}).culprit() == 5);
  CHECK(columns({"t", "x", "y", "z", "time_s"}).problem().find("duplicates column 1") != std::string::npos);
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{},
                                             {"x", "y", "z"},
                                             {"t", "x", "y"},
                                             {"t", "east", "north"},
                                             {"t", "east", "north", "up", "down"},
                                             {"t", "x", "y", "z", "up"},
                                             {"t", "x", "y", "z", "qx", "qy", "qz"},
                                             {"t", "x", "y", "z", "qx", "qy", "qz", "qw", "roll"}}) {
    CAPTURE(names.size());
    CHECK_FALSE(columns(names).problem().empty());
    CHECK_FALSE(columns(names).culprit());
  }
}

}  // namespace
}  // namespace pulsecast::io
