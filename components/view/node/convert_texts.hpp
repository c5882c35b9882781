// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/view/serve/out_message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/monitor/system_snapshot.hpp"

namespace palpate::view {

/// `kind`: "forces" or "truth_forces".
OutMessage ForcesMessage(const std::string& kind, const idl::palpate_msgs::ForceArray& message);

/// `judgement`: of the model residual monitor; may be empty.
OutMessage ModelErrorMessage(const idl::palpate_msgs::ModelGap& message,
                             const std::string& judgement);

/// Joints whose names are in `chambers` are chambers, with volume_m3 and pressure_Pa.
OutMessage CablesMessage(const idl::sensor_msgs::JointState& message,
                         const std::vector<std::string>& chambers);

/// One topic that is shown.
struct TopicState {
  std::string name;
  monitor::TopicFlow flow;
};

OutMessage HealthMessage(const monitor::SystemSnapshot& snapshot,
                         const std::vector<TopicState>& topics);

/// What /calibration and /calibration/status have said.
class ShownCalibration {
 public:
  ShownCalibration();

  void Take(const idl::palpate_msgs::CalibrationStatus& message);
  void Take(const idl::palpate_msgs::Calibration& message);
  OutMessage Message() const;

 private:
  nlohmann::json fields_;
};

}  // namespace palpate::view
