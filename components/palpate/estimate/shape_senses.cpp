// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/shape_senses.hpp"

#include <memory>
#include <optional>

#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "components/perception/perception.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

void RequirePicture(const robot::CalibratedDepthBias& bias, const rgbd::CameraModel& camera) {
  const Status status = robot::CheckDepthPicture(bias, rgbd::PictureOf(camera));
  if (!status.ok()) throw InputError(status.message());
}

}  // namespace

ShapeSenses MakeShapeSenses(const EstimateSettings& settings, robot::RobotModel* model,
                            const robot::CalibrationFile& calibration) {
  const auto perception = std::make_shared<perception::Perception>(settings.perception);
  const auto estimator = std::make_shared<force_estimation::ShapeForceEstimator>(
      *model, settings.forces, settings.shape, robot::RelativeModulusError(calibration));
  const std::optional<robot::CalibratedDepthBias> bias = calibration.depth_bias;
  if (bias) estimator->TakeDepthBias(bias->map, calibration.pose->T_robot_camera);
  ShapeSenses senses;
  senses.open_camera = [perception, bias](const rgbd::RgbdCamera& camera) {
    if (bias) RequirePicture(*bias, camera.depth);
    perception->SetCamera(camera);
  };
  senses.look = [perception](const rgbd::RgbdFrame& frame,
                             const perception::PredictedSurface* predicted)
      -> const perception::Observation& { return perception->Update(frame, predicted); };
  senses.feel =
      [estimator](
          const force_estimation::ShapeFrame& frame) -> const force_estimation::ForceEstimate& {
    const force_estimation::ForceEstimate& estimate = estimator->Update(frame);
    estimator->PrepareNext();
    return estimate;
  };
  return senses;
}

}  // namespace palpate::command
