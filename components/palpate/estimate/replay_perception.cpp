// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/replay_perception.hpp"

#include <memory>

#include "components/perception/perception.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

void RequirePicture(const robot::CalibratedDepthBias& bias, const rgbd::CameraModel& camera) {
  const Status status = robot::CheckDepthPicture(bias, rgbd::PictureOf(camera));
  if (!status.ok()) throw InputError(status.message());
}

}  // namespace

ReplayPerception MakeReplayPerception(const perception::Config& config,
                                      const std::optional<robot::CalibratedDepthBias>& depth_bias) {
  const auto perception = std::make_shared<perception::Perception>(config);
  return {.set_camera =
              [perception, depth_bias](const rgbd::RgbdCamera& camera) {
                if (depth_bias) RequirePicture(*depth_bias, camera.depth);
                perception->SetCamera(camera);
              },
          .update = [perception](const rgbd::RgbdFrame& frame,
                                 const perception::PredictedSurface* predicted)
              -> const perception::Observation& { return perception->Update(frame, predicted); }};
}

}  // namespace palpate::command
