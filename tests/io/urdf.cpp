// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/urdf.hpp>

#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "support/data_folder.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

const std::filesystem::path forklift = support::data_folder / "urdf" / "forklift.urdf";

bool near(const Vec3& a, const Vec3& b) { return length(a - b) < 1e-12; }

/// Direction of a link's x forward, in our axes, on the base.
Vec3 forward(const Mount& mount) { return mount.boresight * axis::forward; }

}  // namespace

TEST_CASE("links of a URDF are mounts in axes x right, y forward, z up") {
  const io::RobotFrames robot = io::read_urdf(forklift);
  CHECK(robot.root == "base_link");
  const Mount lidar = robot.mount("lidar_link");  // 0.5 m before and 0.2 m to the left of the base, turned to the left
  CHECK(near(lidar.lever_arm, {-0.2, 0.5, 2.1}));
  CHECK(near(forward(lidar), {-1, 0, 0}));
  CHECK(near(lidar.boresight * axis::up, axis::up));
  const Mount camera = robot.mount("camera_link");  // pitched down, by a turn about y to the left
  CHECK(near(camera.lever_arm, {-0.4, 1.1, 0.5}));
  CHECK(near(forward(camera), {0, std::cos(0.3), -std::sin(0.3)}));
  CHECK(near(robot.mount("base_link").lever_arm, {}));
  const Mount from_lidar = robot.mount("base_link", "lidar_link");
  CHECK(near(from_lidar.pose().point({-0.2, 0.5, 2.1}), {}));
}

TEST_CASE("joints move the links that they carry") {
  const io::RobotFrames robot = io::read_urdf(forklift, {{"mast_joint", 0.2}, {"fork_joint", 1.5}, {"wheel_joint", 2}});
  const Mount camera = robot.mount("camera_link");
  const double along = 0.1, up = 1.5 + 0.2;  // of the mast, which is tilted forward and down
  CHECK(near(camera.lever_arm,
             {-0.4, 1 + along * std::cos(0.2) + up * std::sin(0.2), 0.3 - along * std::sin(0.2) + up * std::cos(0.2)}));
  CHECK(near(forward(camera), {0, std::cos(0.5), -std::sin(0.5)}));
  CHECK(near(robot.mount("lidar_link").lever_arm, {-0.2, 0.5, 2.1}));
  const Mount wheel = robot.mount("wheel_link");  // whose z is to the left
  CHECK(near(wheel.boresight * axis::up, {-1, 0, 0}));
  CHECK(near(forward(wheel), {0, std::cos(2.0), -std::sin(2.0)}));
}

TEST_CASE("the frame tree has each link after its parent, and says which joints move") {
  const io::RobotFrames robot = io::read_urdf(forklift);
  REQUIRE(robot.links.size() == 5);
  std::string known = " base_link ";
  for (const io::FrameLink& link : robot.links) {
    CHECK(known.find(" " + link.parent + " ") != known.npos);
    known += link.child + " ";
    CHECK(link.fixed == (link.child == "lidar_link" || link.child == "camera_link"));
  }
}

TEST_CASE("a joint may mimic another, and an axis may have any length") {
  const support::TemporaryFolder folder;
  const auto file = folder.write("gripper.urdf", R"(<robot name="gripper">
  <link name="base"/><link name="left"/><link name="right"/>
  <joint name="left_joint" type="prismatic"><parent link="base"/><child link="left"/>
    <axis xyz="0 2 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="right_joint" type="prismatic"><parent link="base"/><child link="right"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="0" effort="1" velocity="1"/>
    <mimic joint="left_joint" multiplier="-1" offset="0.1"/></joint></robot>)");
  const io::RobotFrames robot = io::read_urdf(file, {{"left_joint", 0.5}});
  CHECK(near(robot.mount("left").lever_arm, {-0.5, 0, 0}));
  CHECK(near(robot.mount("right").lever_arm, {0.4, 0, 0}));
}

TEST_CASE("joints mimic one another in chains, and not in circles") {
  const support::TemporaryFolder folder;
  const auto finger = [](const std::string& parent, const std::string& child, const std::string& mimic) {
    return "<link name=\"" + child + "\"/><joint name=\"" + child + "_joint\" type=\"prismatic\"><parent link=\"" +
           parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"1 0 0\"/>" +
           "<limit lower=\"-9\" upper=\"9\" effort=\"1\" velocity=\"1\"/>" + mimic + "</joint>";
  };
  const std::string base = "<robot name=\"hand\"><link name=\"base\"/>";
  const auto chain = folder.write(
      "chain.urdf", base + finger("base", "a", "") +
                        finger("base", "b", R"(<mimic joint="a_joint" multiplier="2" offset="0.1"/>)") +
                        finger("base", "c", R"(<mimic joint="b_joint" multiplier="3" offset="0"/>)") + "</robot>");
  const io::RobotFrames robot = io::read_urdf(chain, {{"a_joint", 0.5}});
  CHECK(near(robot.mount("b").lever_arm, {0, 1.1, 0}));
  CHECK(near(robot.mount("c").lever_arm, {0, 3.3, 0}));
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_urdf(chain, {{"b_joint", 0.5}})),
                       doctest::Contains("is 'b_joint', which does not move"), SettingError);
  const auto circle = folder.write("circle.urdf", base + finger("base", "a", R"(<mimic joint="b_joint"/>)") +
                                                      finger("base", "b", R"(<mimic joint="a_joint"/>)") + "</robot>");
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_urdf(circle)), doctest::Contains("expected another joint"),
                       FileError);
}

TEST_CASE("a joint that cannot be at 0 is in the middle of its limits, unless it is set") {
  const support::TemporaryFolder folder;
  const auto of_limits = [&](const std::string& limits, const std::map<std::string, double>& values = {}) {
    const auto file = folder.write("robot.urdf",
                                   "<robot name=\"r\"><link name=\"base\"/><link name=\"fork\"/>"
                                   R"(<joint name="lift" type="prismatic"><parent link="base"/>)"
                                   R"(<child link="fork"/><axis xyz="0 0 1"/><limit effort="1" velocity="1" )" +
                                       limits + "/></joint></robot>");
    return io::read_urdf(file, values).mount("fork").lever_arm.z;
  };
  CHECK(of_limits(R"(lower="0.25" upper="1.25")") == 0.75);
  CHECK(of_limits(R"(lower="-2" upper="-1")") == -1.5);
  CHECK(of_limits(R"(lower="0" upper="1")") == 0);
  CHECK(of_limits(R"(lower="0.25" upper="1.25")", {{"lift", 0.5}}) == 0.5);
}

TEST_CASE("unknown links and joints are refused with the name that was meant, and values beyond the limits") {
  const io::RobotFrames robot = io::read_urdf(forklift);
  CHECK_THROWS_WITH_AS(static_cast<void>(robot.mount("lidar_lnk")),
                       "RobotFrames::mount (link) is 'lidar_lnk', which the robot has not; did you mean 'lidar_link'?",
                       SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(robot.mount("lidar_link", "bas_link")),
                       "RobotFrames::mount (link) is 'bas_link', which the robot has not; did you mean 'base_link'?",
                       SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_urdf(forklift, {{"mast_joint", 0.3}})),
                       "read_urdf (joint 'mast_joint') is 0.3 rad, but must be from -0.1 to 0.2", SettingError);
  const std::string moving = "read_urdf (joint) is 'mast_jiont', which does not move in " + forklift.string();
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_urdf(forklift, {{"mast_jiont", 0}})),
                       (moving + "; did you mean 'mast_joint'?").c_str(), SettingError);
}

TEST_CASE("a file that is no URDF of one tree is refused, with the line where one is known") {
  const support::TemporaryFolder folder;
  const auto message = [&](const std::string& text) -> std::string {
    try {
      static_cast<void>(io::read_urdf(folder.write("robot.urdf", text)));
    } catch (const FileError& error) {
      return std::string(error.what()).substr((folder / "robot.urdf").string().size());
    }
    return "";
  };
  const std::string expected = ": expected a URDF of a tree of links: ";
  CHECK(message("lidar: 3") == expected + "Error document empty.");
  CHECK(message("<robot name='a'>\n<link name=\"b\"/>\n<link name=\"c\"/></robot>") ==
        ", line 2" + expected + "Failed to find root link: Two root links found: [b] and [c]");
  const auto with_joint = [&](const std::string& joint) {
    return message("<robot name=\"a\">\n<link name=\"b\"/><link name=\"c\"/>\n" + joint + "</robot>");
  };
  CHECK(with_joint("<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/>\n<child link=\"d\"/></joint>") ==
        ", line 4" + expected + "Failed to build tree: child link [d] of joint [j] not found");
  CHECK(with_joint("<joint name=\"j\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/>"
                   "<axis xyz=\"0 0 0\"/></joint>") == ": has joint 'j' without a direction: expected an axis");
  const auto ring = [](const std::string& of) {
    return "<joint name=\"" + of + "\" type=\"fixed\"><parent link=\"" + of + "\"/><child link=\"" +
           (of == "b" ? "c" : "b") + "\"/></joint>";
  };
  CHECK(message("<robot name=\"a\"><link name=\"r\"/><link name=\"b\"/><link name=\"c\"/>" + ring("b") + ring("c") +
                "</robot>") == ": has links that r does not carry: expected a tree");
  CHECK(message("<robot name=\"a\"><xacro:lidar/></robot>") ==
        ": is a xacro file: expected a URDF, as `xacro FILE > robot.urdf` writes it");
  CHECK_THROWS_AS(static_cast<void>(io::read_urdf(folder / "none.urdf")), FileError);
}
