// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/transforms.hpp"

#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::dds {

namespace {

/// tf2 names frames without a leading slash; older drivers write one.
std::string FrameName(const char* field) {
  const std::string_view name = Text(field);
  return std::string(name.starts_with('/') ? name.substr(1) : name);
}

}  // namespace

bool TransformBroadcaster::Set(std::string_view parent, std::string_view child,
                               const Eigen::Isometry3d& T_parent_child, std::int64_t stamp_ns) {
  const auto known = links_.find(std::string(child));
  if (known != links_.end() && known->second.parent == parent &&
      known->second.T_parent_child.matrix() == T_parent_child.matrix()) {
    return true;
  }
  links_.insert_or_assign(std::string(child), Link{std::string(parent), T_parent_child, stamp_ns});
  Message<idl::tf2_msgs::TFMessage> message;
  Resize(message->transforms, links_.size());
  std::size_t i = 0;
  for (const auto& [name, link] : links_) {
    auto& transform = message->transforms._buffer[i++];
    SetHeader(transform.header, link.stamp_ns, link.parent);
    SetText(transform.child_frame_id, name);
    const idl::geometry_msgs::Pose pose = ToPose(link.T_parent_child);
    transform.transform.translation = {pose.position.x, pose.position.y, pose.position.z};
    transform.transform.rotation = pose.orientation;
  }
  return writer_.Write(message);
}

Status TransformTree::Add(const idl::tf2_msgs::TFMessage& message) {
  Status status = Status::Ok();
  for (const auto& transform : Elements(message.transforms)) {
    const auto& [x, y, z] = transform.transform.translation;
    idl::geometry_msgs::Pose pose{};
    pose.position = {x, y, z};
    pose.orientation = transform.transform.rotation;
    Link link{FrameName(transform.header.frame_id), Eigen::Isometry3d::Identity()};
    const std::string child = FrameName(transform.child_frame_id);
    if (!FromPose(pose, &link.T_parent_child)) {
      status = Invalid("the transform from '" + link.parent + "' to '" + child + "' is none");
    } else {
      links_.insert_or_assign(child, link);
    }
  }
  return status;
}

std::map<std::string, Eigen::Isometry3d> TransformTree::Above(const std::string& frame) const {
  std::map<std::string, Eigen::Isometry3d> above{{frame, Eigen::Isometry3d::Identity()}};
  Eigen::Isometry3d T_here_frame = Eigen::Isometry3d::Identity();
  for (auto link = links_.find(frame); link != links_.end();
       link = links_.find(link->second.parent)) {
    T_here_frame = link->second.T_parent_child * T_here_frame;
    // A frame that is above itself would never end.
    if (!above.emplace(link->second.parent, T_here_frame).second) break;
  }
  return above;
}

std::optional<Eigen::Isometry3d> TransformTree::Find(const std::string& target,
                                                     const std::string& source) const {
  const auto above_target = Above(target);
  for (const auto& [frame, T_frame_source] : Above(source)) {
    const auto meeting = above_target.find(frame);
    if (meeting != above_target.end()) return meeting->second.inverse() * T_frame_source;
  }
  return std::nullopt;
}

}  // namespace palpate::dds
