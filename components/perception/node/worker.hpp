// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "components/perception/node/convert.hpp"
#include "components/perception/node/frame_pairing.hpp"
#include "components/perception/node/frame_perception.hpp"
#include "components/perception/node/prediction_history.hpp"
#include "libs/core/worker.hpp"

namespace palpate::perception {

/// One camera's part of a frame to be processed.
struct CameraJob {
  rgbd::RgbdFrame images;  ///< where the status of its outcome is ok
  std::optional<Prediction> prediction;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  std::optional<Config> reset;             ///< the colour model of earlier frames is void
  std::optional<rgbd::RgbdCamera> camera;  ///< another one than before, or reopened
};

/// A frame to be processed.
struct PerceptionJob {
  FrameOutcome outcome;            ///< all but the observation
  std::vector<CameraJob> cameras;  ///< as those of `outcome`
  bool begins = false;             ///< all that is known of earlier frames is void
  FrameSet::Time taken;
};

/// The result of a job.
struct PerceptionResult {
  FrameOutcome outcome;
  FrameSet::Time taken;
};

/// Runs perception in a thread of its own, one frame at a time.
using Worker = palpate::Worker<PerceptionJob, PerceptionResult>;

/// What the worker does with a frame: settings and camera that a job brings replace those before.
/// Throws InputError for settings that do not go together.
std::function<PerceptionResult(PerceptionJob&)> MakePerceive(const Config& config,
                                                             FramePerceptionMaker maker);

}  // namespace palpate::perception
