// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/motion_capture/natnet_packet.hpp"

namespace palpate::motion_capture {

/// A marker in the robot frame.
struct CapturedMarker {
  std::string name;                           ///< empty: unlabelled
  std::optional<Eigen::Vector3d> position_m;  ///< nullopt: not seen
};

/// Names markers and maps them to the robot frame. A marker is "SET-1", "SET-2", ... after its set
/// and its place there, from 1; the set "all", which Motive sends too, repeats the others.
class MarkerMap {
 public:
  /// `rename`: "SET-1:=NAME". Throws InputError for a rule that is none or comes twice.
  MarkerMap(const Eigen::Isometry3d& T_robot_mocap, const std::vector<std::string>& rename,
            bool with_unlabelled);

  std::vector<CapturedMarker> Map(const NatNetFrame& frame) const;
  /// Of the motion capture's frame, in the robot frame.
  Eigen::Vector3d origin_m() const { return T_robot_mocap_.translation(); }

 private:
  CapturedMarker Mapped(const std::string& name, const Eigen::Vector3f& position_m) const;

  Eigen::Isometry3d T_robot_mocap_;
  std::map<std::string, std::string> names_;  ///< by the name that a marker has of itself
  bool with_unlabelled_;
};

}  // namespace palpate::motion_capture
