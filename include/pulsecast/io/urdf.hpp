// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_URDF_HPP
#define PULSECAST_IO_URDF_HPP

#include <map>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/platform/platform.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Frame of a robot in another, as messages of frames have it.
struct FrameLink {
  std::string parent, child;              ///< names of the frames
  Pose<frame::Body, frame::Body> pose{};  ///< from the child to the parent, both of axes x right, y forward, z up
  bool fixed = true;                      ///< false if the joint between them moves
};

/// Frames of the links of a robot.
struct RobotFrames {
  std::string root;                ///< link that carries all others, such as base_link
  std::vector<FrameLink> links{};  ///< all others, each after its parent

  /// Mount of a sensor in the frame of a link, on a body in the frame of another, by default the root. A sensor looks
  /// along x of its link in the file. @throws SettingError for a link that the robot has not
  [[nodiscard]] Mount mount(const std::string& link, const std::string& on = {}) const {
    const auto pose = pose_of(on.empty() ? root : on).inverse() * pose_of(link);
    return {pose.position, pose.rotation};
  }

 private:
  /// Pose in the root.
  [[nodiscard]] Pose<frame::Body, frame::Body> pose_of(const std::string& link) const {
    Pose<frame::Body, frame::Body> pose;
    std::string at = link;
    for (std::size_t i = links.size(); i-- > 0 && at != root;)
      if (links[i].child == at) {
        pose = links[i].pose * pose;
        at = links[i].parent;
      }
    if (at == root) return pose;
    std::vector<std::string> known{root};
    for (const FrameLink& other : links) known.push_back(other.child);
    throw SettingError("RobotFrames::mount (link)",
                       text::joined({" is '", link, "', which the robot has not", text::suggestion(link, known)}));
  }
};

namespace detail {

/// Keeps the errors of the parser, which would print them.
class UrdfErrors : public console_bridge::OutputHandler {
 public:
  UrdfErrors() { console_bridge::useOutputHandler(this); }
  UrdfErrors(const UrdfErrors&) = delete;
  UrdfErrors& operator=(const UrdfErrors&) = delete;
  ~UrdfErrors() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first.empty()) first = text;
  }

  std::string first;
};

/// From axes x forward, y left, z up to x right, y forward, z up.
[[nodiscard]] inline Pose<frame::Body, frame::Body> pose_of(const Vec3& position, const Rotation& turn) {
  const Vec3 axis = from_forward_left_up({turn.x, turn.y, turn.z});
  return {Rotation{turn.w, axis.x, axis.y, axis.z}, from_forward_left_up(position)};
}

[[nodiscard]] inline bool limited(const urdf::Joint& joint) noexcept {
  return joint.limits && joint.type != urdf::Joint::CONTINUOUS;
}

/// Value of a joint, by those that it mimics, one after another [rad] or [m]. @throws FileError if they mimic in a
/// circle
[[nodiscard]] inline double value_of(const urdf::ModelInterface& robot, const urdf::Joint& joint,
                                     const std::map<std::string, double>& values, const std::string& path) {
  double factor = 1, offset = 0;
  const urdf::Joint* at = &joint;
  for (std::size_t i = 0; at->mimic; ++i) {
    offset += factor * at->mimic->offset;
    factor *= at->mimic->multiplier;
    const auto next = robot.joints_.find(at->mimic->joint_name);
    if (next == robot.joints_.end() || i > robot.joints_.size())
      throw FileError(path, "",
                      text::joined({"has joint '", joint.name, "', which mimics ", at->mimic->joint_name,
                                    ": expected another joint of the robot"}));
    at = next->second.get();
  }
  if (const auto found = values.find(at->name); found != values.end()) return factor * found->second + offset;
  const bool beyond = limited(*at) && (at->limits->lower > 0 || at->limits->upper < 0);
  return factor * (beyond ? std::midpoint(at->limits->lower, at->limits->upper) : 0) + offset;
}

/// Pose of the child of a joint in its parent. Source: URDF specification, joint: origin, then motion about the axis.
[[nodiscard]] inline Pose<frame::Body, frame::Body> pose_of(const urdf::Joint& joint, double value) {
  const auto& [place, turn] = joint.parent_to_joint_origin_transform;
  const auto origin = pose_of(Vec3{place.x, place.y, place.z}, Rotation{turn.w, turn.x, turn.y, turn.z});
  const Vec3 axis = normalize(from_forward_left_up({joint.axis.x, joint.axis.y, joint.axis.z}));
  if (joint.type == urdf::Joint::PRISMATIC) return origin * Pose<frame::Body, frame::Body>{no_rotation, value * axis};
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS)
    return origin * Pose<frame::Body, frame::Body>{rotation_about(axis, value), {}};
  return origin;
}

/// Place of what a message has in brackets or quotes, as "line 12"; empty if it has nothing.
[[nodiscard]] inline std::string place_of(const std::string& content, const std::string& message) {
  const std::size_t from = message.find_first_of("['"), to = message.find_first_of("]'", from + 1);
  if (from == message.npos || to == message.npos) return "";
  const std::size_t at = content.find(text::joined({"\"", message.substr(from + 1, to - from - 1), "\""}));
  if (at == content.npos) return "";
  return "line " +
         std::to_string(1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

}  // namespace detail

/// Reads the frames of a robot from a URDF file, with its joints at these values by name [rad], prismatic ones [m]. By
/// default they are at 0, or in the middle of limits beyond which it is, as joint_state_publisher has them; floating
/// and planar joints stay at their origin. Sets the output handler of console_bridge during the call, so that only one
/// thread may read. @throws FileError @throws SettingError for a value of a joint that does not move, or that is beyond
/// its limits
[[nodiscard]] inline RobotFrames read_urdf(const std::filesystem::path& path,
                                           const std::map<std::string, double>& joint_values = {}) {
  InputFile file(path, "a URDF");
  const std::string content = file.take_rest();
  detail::UrdfErrors errors;
  const urdf::ModelInterfaceSharedPtr robot = urdf::parseURDF(content);
  if (!robot || !robot->getRoot()) {
    if (content.find("<xacro:") != content.npos)
      throw FileError(path.string(), "", "is a xacro file: expected a URDF, as `xacro FILE > robot.urdf` writes it");
    throw FileError(path.string(), detail::place_of(content, errors.first),
                    text::joined({"expected a URDF of a tree of links: ", errors.first}));
  }
  std::vector<std::string> moving;
  for (const auto& [name, joint] : robot->joints_) {
    const bool turns = joint->type == urdf::Joint::REVOLUTE || joint->type == urdf::Joint::CONTINUOUS;
    if (!turns && joint->type != urdf::Joint::PRISMATIC) continue;
    if (joint->mimic) continue;  // moved by others
    moving.push_back(name);
    const auto value = joint_values.find(name);
    if (value == joint_values.end()) continue;
    const bool limited = detail::limited(*joint);
    require_within(text::joined({"read_urdf (joint '", name, "')"}), value->second,
                   limited ? joint->limits->lower : -1e6, limited ? joint->limits->upper : 1e6, turns ? "rad" : "m");
  }
  for (const auto& [name, value] : joint_values)
    if (std::ranges::find(moving, name) == moving.end())
      throw SettingError("read_urdf (joint)", text::joined({" is '", name, "', which does not move in ", path.string(),
                                                            text::suggestion(name, moving)}));
  RobotFrames frames{robot->getRoot()->name};
  std::vector<urdf::LinkConstSharedPtr> open{robot->getRoot()};
  for (std::size_t i = 0; i < open.size(); ++i)
    for (const urdf::LinkSharedPtr& child : open[i]->child_links) {
      open.push_back(child);
      const urdf::Joint& joint = *child->parent_joint;
      const bool is_fixed = joint.type == urdf::Joint::FIXED;
      frames.links.push_back({open[i]->name, child->name,
                              detail::pose_of(joint, detail::value_of(*robot, joint, joint_values, path.string())),
                              is_fixed});
      if (!frames.links.back().pose.rigid())
        throw FileError(path.string(), "",
                        text::joined({"has joint '", joint.name, "' without a direction: expected an axis"}));
    }
  if (open.size() != robot->links_.size())
    throw FileError(path.string(), "",
                    text::joined({"has links that ", frames.root, " does not carry: expected a tree"}));
  return frames;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
