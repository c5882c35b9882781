// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

#include "components/force_estimation/fit/force_newton.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::test_support {

/// The body with its feature points as its markers.
inline robot::RobotBody WithFeaturePointsAsMarkers(robot::RobotBody body) {
  body.markers.clear();
  for (const fem::BodyPoint& point : body.feature_points) {
    body.markers.push_back({"feature_" + std::to_string(body.markers.size()), point});
  }
  return body;
}

/// All markers where the configuration x_m [3n] has them, without noise, known to `sigma_m`.
inline force_estimation::RowTargets ExactTargets(const robot::RobotModel& model,
                                                 const Eigen::VectorXd& x_m, double sigma_m) {
  const auto& markers = model.body().markers;
  force_estimation::RowTargets targets;
  targets.rows = static_cast<int>(3 * markers.size());
  targets.weight = Eigen::VectorXd::Constant(targets.rows, 1.0 / (sigma_m * sigma_m));
  targets.value_m.resize(targets.rows);
  for (size_t m = 0; m < markers.size(); ++m) {
    targets.value_m.segment<3>(static_cast<Eigen::Index>(3 * m)) =
        markers[m].point.weights.Position(x_m);
  }
  return targets;
}

}  // namespace palpate::test_support
