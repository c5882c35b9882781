// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/depth_misfit.hpp"
#include "components/offline/images/image_samples.hpp"
#include "libs/rgbd/depth_noise.hpp"

namespace palpate::offline {

/// calibration::FindDepthMisfit for recorded frames of one camera. Throws InputError where a file
/// cannot be read, RunError where the model has no equilibrium under the frames' inputs.
calibration::DepthMisfit FindImageMisfit(const std::vector<ImageSample>& samples,
                                         const rgbd::DepthNoise& noise,
                                         const calibration::DepthMisfitRequest& request,
                                         robot::RobotModel* model);

/// "the images do not fit the robot: ...", `consequence`, and the likely reasons.
std::string MisfitText(const calibration::MisfitReasons& reasons, const std::string& consequence);

}  // namespace palpate::offline
