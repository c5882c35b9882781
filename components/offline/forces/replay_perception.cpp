// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/replay_perception.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "libs/core/error.hpp"

namespace palpate::offline {

namespace {

void RequirePicture(const robot::CalibratedDepthBias& bias, const rgbd::CameraModel& camera) {
  const Status status = robot::CheckDepthPicture(bias, rgbd::PictureOf(camera));
  if (!status.ok()) throw InputError(status.message());
}

}  // namespace

ReplayPerception MakeReplayPerception(
    const perception::Config& config,
    const std::vector<std::optional<robot::CalibratedDepthBias>>& depth_biases) {
  const auto perception = std::make_shared<perception::JointPerception>(config);
  return {
      .open =
          [perception, depth_biases](const std::vector<std::optional<rgbd::RgbdCamera>>& cameras) {
            for (std::size_t k = 0; k < std::min(cameras.size(), depth_biases.size()); ++k) {
              if (cameras[k] && depth_biases[k]) {
                RequirePicture(*depth_biases[k], cameras[k]->depth);
              }
            }
            perception->Open(cameras);
          },
      .update = [perception](std::int64_t stamp_ns,
                             const std::vector<perception::CameraFrame>& frames)
          -> const perception::JointObservation& { return perception->Update(stamp_ns, frames); }};
}

std::vector<std::optional<robot::CalibratedDepthBias>> DepthBiasesOf(
    const robot::CalibrationFile& calibration, const std::vector<std::string>& cameras) {
  std::vector<std::optional<robot::CalibratedDepthBias>> biases = {calibration.depth_bias};
  for (const std::string& name : cameras) {
    auto& bias = biases.emplace_back();
    for (const robot::CalibratedCamera& camera : calibration.cameras) {
      if (camera.name == name) bias = camera.depth_bias;
    }
  }
  return biases;
}

}  // namespace palpate::offline
