// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/perception/observation.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {

/// The skin's point nearest to the middle of a ball of `radius_m`, camera frame: deepest in the
/// dent. Fails the test where the ball does not touch.
Eigen::Vector3d TouchOf(const PredictedSurface& skin, const scenario::Scenario& scenario,
                        const virtual_camera::ToolPose& tool);

/// Contacts of `seen` are as many as the tools (balls) of `view`, each within `largest_error_m` of
/// where its tool touches, and within the 95 % of its covariance.
void ExpectContacts(const Observation& seen, const scenario::Scenario& scenario,
                    const virtual_camera::View& view, double largest_error_m);

}  // namespace palpate::perception
