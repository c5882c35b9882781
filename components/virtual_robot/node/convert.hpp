// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/scenario/schedule.hpp"

namespace palpate::virtual_robot {

dds::Message<idl::sensor_msgs::JointState> ToJointState(const std::vector<std::string>& names,
                                                        const std::vector<CableReading>& cables,
                                                        std::int64_t stamp_ns);

/// Displacements in the order of `names` into `displacement_m`; cables that the message does not
/// name keep theirs, NaN: not driven. kInvalidInput, and nothing is changed, for a cable that is
/// not among `names` (with "did you mean"), numbers that do not go with the names, or an infinite
/// one.
Status FromCommand(const idl::sensor_msgs::JointState& message,
                   const std::vector<std::string>& names, Eigen::VectorXd* displacement_m);

/// The true forces as an estimator without error would send them.
dds::Message<idl::palpate_msgs::ForceArray> ToForceArray(const std::vector<TrueForce>& forces,
                                                         const std::string& recording,
                                                         std::int64_t stamp_ns);

/// What the message says about the bench as a whole.
struct BenchFacts {
  std::string scenario_sha256;
  std::uint64_t seed = 0;
  scenario::Moment moment;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< nominal
};

dds::Message<idl::palpate_msgs::BenchState> ToBenchState(const BenchFacts& facts,
                                                         const std::vector<ToolPose>& tools,
                                                         std::int64_t stamp_ns);

}  // namespace palpate::virtual_robot
