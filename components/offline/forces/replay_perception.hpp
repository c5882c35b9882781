// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/joint_perception.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::offline {

/// The methods of perception::JointPerception that a replay uses, which a test may replace.
struct ReplayPerception {
  std::function<void(const std::vector<std::optional<rgbd::RgbdCamera>>&)> open;
  std::function<const perception::JointObservation&(std::int64_t stamp_ns,
                                                    const std::vector<perception::CameraFrame>&)>
      update;
};

/// `depth_biases`: of the calibration, by number of the camera. Throws InputError for settings that
/// do not go together; open throws it for images of another size or lens than the depth bias is
/// for.
ReplayPerception MakeReplayPerception(
    const perception::Config& config,
    const std::vector<std::optional<robot::CalibratedDepthBias>>& depth_biases);

/// The biases of a calibration in this order: that of the first camera, then those of the cameras
/// of these names.
std::vector<std::optional<robot::CalibratedDepthBias>> DepthBiasesOf(
    const robot::CalibrationFile& calibration, const std::vector<std::string>& cameras);

}  // namespace palpate::offline
