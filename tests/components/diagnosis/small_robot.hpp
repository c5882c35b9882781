// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// A soft beam of 100 x 20 x 20 mm along x, held at x = 0, of two materials (region "far"), with
/// gravity, four markers and three cables that bend it up, sideways and down; the first runs
/// through three eyelets. Computed in milliseconds.
robot::RobotBody SmallRobot(fem::ElementType element = fem::ElementType::kTet4);
/// The robot of tet4 with the same elements as tet10.
robot::RobotBody SmallRobotOnFinerMesh();

/// What was commanded at a time.
struct Knot {
  double t_s;
  std::vector<double> command;  ///< of the first cables of the robot
};

/// A recording of all markers of SmallRobot: commands through the knots, one frame each `frame_s`
/// from the first to the last. `seen_m`: where a marker is seen then, m; by default at its rest.
using Seen = std::function<std::optional<Eigen::Vector3d>(double t_s, int marker)>;
experiment::Recording MakeRecording(const std::string& name, const robot::RobotBody& body,
                                    const std::vector<Knot>& knots, double frame_s,
                                    const Seen& seen_m = nullptr);

/// Everything that faults act on: a ramp up and down, a long hold under a hanging weight and a side
/// load, a tilted base seen by a camera that rides on it, the camera at another place.
experiment::Experiment SmallExperiment(const robot::RobotBody& body);
/// That and each cable pulled by itself: separates the effect of one from that of all.
experiment::Experiment SmallExperimentOfEachCable(const robot::RobotBody& body);
/// What is known of the camera of its last two recordings.
std::map<std::string, rgbd::CameraModel> SmallCameras();

}  // namespace palpate::diagnosis
