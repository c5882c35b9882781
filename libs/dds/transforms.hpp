// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "libs/core/status.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::dds {

/// The fixed transforms that one node knows, latched on /tf_static for the tools of ROS 2.
class TransformBroadcaster {
 public:
  explicit TransformBroadcaster(Participant& participant)
      : writer_(participant.CreateWriter(kTfStaticTopic)) {}

  /// Sends all transforms again where this one is new or another. False where DDS did not take it.
  bool Set(std::string_view parent, std::string_view child, const Eigen::Isometry3d& T_parent_child,
           std::int64_t stamp_ns);

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
    std::int64_t stamp_ns;
  };

  Writer<idl::tf2_msgs::TFMessage> writer_;
  std::map<std::string, Link> links_;  ///< by child
};

/// The transforms that other nodes have sent on /tf_static.
class TransformTree {
 public:
  /// kInvalidInput, with the reason, for a transform that is none; the others are taken.
  Status Add(const idl::tf2_msgs::TFMessage& message);

  /// p_target = T_target_source * p_source; nullopt where no chain of transforms joins the frames.
  std::optional<Eigen::Isometry3d> Find(const std::string& target, const std::string& source) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
  };

  /// Every frame above `frame` and itself, with p_above = T * p_frame.
  std::map<std::string, Eigen::Isometry3d> Above(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace palpate::dds
