// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/convert.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::virtual_robot {

dds::Message<idl::sensor_msgs::JointState> ToJointState(const std::vector<std::string>& names,
                                                        const std::vector<CableReading>& cables,
                                                        std::int64_t stamp_ns) {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::Resize(message->name, names.size());
  dds::Resize(message->position, names.size());
  dds::Resize(message->effort, names.size());
  for (size_t c = 0; c < names.size(); ++c) {
    dds::SetText(message->name._buffer[c], names[c]);
    message->position._buffer[c] = cables[c].displacement_m;
    message->effort._buffer[c] = cables[c].tension_N;
  }
  return message;
}

Status FromCommand(const idl::sensor_msgs::JointState& message,
                   const std::vector<std::string>& names, Eigen::VectorXd* displacement_m) {
  if (message.position._length != message.name._length) {
    return {StatusCode::kInvalidInput, "command with " + std::to_string(message.name._length) +
                                           " names and " +
                                           std::to_string(message.position._length) + " positions"};
  }
  Eigen::VectorXd commanded_m = *displacement_m;
  for (uint32_t i = 0; i < message.name._length; ++i) {
    const std::string name(dds::Text(message.name._buffer[i]));
    const auto cable = std::find(names.begin(), names.end(), name);
    if (cable == names.end()) {
      return {StatusCode::kInvalidInput,
              "the robot has no actuator '" + name + "'" + DidYouMean(name, names)};
    }
    if (std::isinf(message.position._buffer[i])) {
      return {StatusCode::kInvalidInput, "command of '" + name + "' is infinite"};
    }
    commanded_m[cable - names.begin()] = message.position._buffer[i];
  }
  *displacement_m = commanded_m;
  return Status::Ok();
}

dds::Message<idl::palpate_msgs::ForceArray> ToForceArray(const std::vector<TrueForce>& forces,
                                                         const std::string& recording,
                                                         std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::SetText(message->recording, recording);
  dds::SetText(message->status, ToString(StatusCode::kOk));
  dds::Resize(message->forces, forces.size());
  for (size_t i = 0; i < forces.size(); ++i) {
    auto& target = message->forces._buffer[i];
    dds::SetText(target.name, forces[i].name);
    dds::SetVector(target.position_m, forces[i].position_m);
    dds::SetVector(target.force_n, forces[i].force_N);
    dds::SetText(target.status, ToString(StatusCode::kOk));
  }
  return message;
}

dds::Message<idl::palpate_msgs::BenchState> ToBenchState(const BenchFacts& facts,
                                                         const std::vector<ToolPose>& tools,
                                                         std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::BenchState> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::SetText(message->scenario, facts.scenario_sha256);
  message->seed = facts.seed;
  message->recording = static_cast<uint32_t>(facts.moment.recording);
  message->t_s = facts.moment.t_s;
  message->camera_in_robot = dds::ToPose(facts.T_robot_camera);
  dds::Resize(message->tools, tools.size());
  for (size_t i = 0; i < tools.size(); ++i) {
    dds::SetText(message->tools._buffer[i].name, tools[i].tool);
    message->tools._buffer[i].pose = dds::ToPose(tools[i].T_robot_tool);
  }
  return message;
}

}  // namespace palpate::virtual_robot
