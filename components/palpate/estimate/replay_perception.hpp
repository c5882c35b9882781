// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <optional>

#include "components/perception/config.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

/// The methods of perception::Perception that a replay uses, which a test may replace.
struct ReplayPerception {
  /// A sequence of images begins: perception::Perception::SetCamera.
  std::function<void(const rgbd::RgbdCamera&)> set_camera;
  /// perception::Perception::Update
  std::function<const perception::Observation&(const rgbd::RgbdFrame&,
                                               const perception::PredictedSurface*)>
      update;
};

/// `depth_bias`: of the calibration. Throws InputError for settings that do not go together;
/// set_camera throws it for images of another size or lens than the depth bias is for.
ReplayPerception MakeReplayPerception(const perception::Config& config,
                                      const std::optional<robot::CalibratedDepthBias>& depth_bias);

}  // namespace palpate::command
