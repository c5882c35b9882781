// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/shape_senses.hpp"

#include <memory>

#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "components/perception/perception.hpp"

namespace palpate::command {

ShapeSenses MakeShapeSenses(const EstimateSettings& settings, robot::RobotModel* model,
                            double modulus_error) {
  const auto perception = std::make_shared<perception::Perception>(settings.perception);
  const auto estimator = std::make_shared<force_estimation::ShapeForceEstimator>(
      *model, settings.forces, settings.shape, modulus_error);
  ShapeSenses senses;
  senses.open_camera = [perception](const rgbd::RgbdCamera& camera) {
    perception->SetCamera(camera);
  };
  senses.look = [perception](const rgbd::RgbdFrame& frame,
                             const perception::PredictedSurface* predicted)
      -> const perception::Observation& { return perception->Update(frame, predicted); };
  senses.feel = [estimator](const force_estimation::ShapeFrame& frame)
      -> const force_estimation::ForceEstimate& { return estimator->Update(frame); };
  return senses;
}

}  // namespace palpate::command
