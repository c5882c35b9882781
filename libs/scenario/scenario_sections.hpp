// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/scenario/scenario.hpp"
#include "libs/scenario/scenario_keys.hpp"

namespace palpate::scenario {

// The sections of scenario.yaml (README.md), each read strictly: InputError with file:line:column.

std::vector<Effect> ReadEffects(const ConfigNode& node);
std::vector<Tool> ReadTools(const ConfigNode& node);
Stage ReadStage(const ConfigNode& node);

/// A `file` in it is read by `load`.
CameraSpec ReadCameraSpec(const ConfigNode& node, const ConfigLoader& load);
/// The list `cameras`, beside `camera`.
std::vector<FurtherCamera> ReadFurtherCameras(const ConfigNode& node, const ConfigLoader& load);
DepthNoise ReadDepthNoise(const ConfigNode& node);

/// Where a camera is: `T_robot_camera`, or `eye_m` and `target_m`, of the map. Nothing: neither.
std::optional<Eigen::Isometry3d> ReadCameraPose(MapReader& reader);

/// A camera at `eye_m` that looks at `target_m`: z there, x level, y as far down (-z of the robot)
/// as that leaves. Looking straight up or down: x along the robot's x.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m);

/// `scenario`: tools and camera are there already.
std::vector<RecordingPlan> ReadRecordings(const ConfigNode& node, const Scenario& scenario);

/// The items of a list; throws InputError for anything else.
const std::vector<ConfigNode>& ReadList(const ConfigNode& node, const std::string& of_what);

}  // namespace palpate::scenario
