// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/embedding.hpp"

namespace palpate::robot {

/// Derivative of PointLocator::EmbedBall(centre_m, radius_m).weights where the centre moves along
/// `direction` through the undeformed body, 1/m; the weights add up to 0. As long as every sample
/// of the ball stays in its element: on a border between elements, that of one side.
fem::InterpolationWeights EyeletWeightsAlong(const fem::PointLocator& locator,
                                             const Eigen::Vector3d& centre_m, double radius_m,
                                             const Eigen::Vector3d& direction);

}  // namespace palpate::robot
