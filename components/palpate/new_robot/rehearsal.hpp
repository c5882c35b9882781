// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/new_robot/robot_draft.hpp"

namespace palpate::command {

/// Files that let a new robot be tried without hardware.
struct Rehearsal {
  std::string scenario;     ///< for palpate simulate: settings for a calibration, then a push
  std::string system;       ///< for palpate launch: virtual robot and camera, and the estimators
  std::string camera_pose;  ///< T_robot_camera of the virtual camera, as --camera-pose takes it
  std::string actuation;    ///< for palpate solve: each cable pulled in turn; empty without cables
};

/// `scenario_file`, `robot_file` and `calibration_file` as the system file names them, beside it.
Rehearsal MakeRehearsal(const RobotDraft& draft, const std::string& robot_file,
                        const std::string& scenario_file, const std::string& calibration_file);

}  // namespace palpate::command
