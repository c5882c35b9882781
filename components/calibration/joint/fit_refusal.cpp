// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/fit_refusal.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace palpate::calibration {

const AdjustedPose* MovedCamera(const FitCheck& check, const JointRequest& request) {
  if (!request.pose_prior) return nullptr;
  const auto found =
      std::find_if(check.moved_poses.begin(), check.moved_poses.end(),
                   [&](const AdjustedPose& pose) { return pose.name == request.pose_prior->name; });
  return found == check.moved_poses.end() ? nullptr : &*found;
}

std::string OffBy(const AdjustedPose& pose) {
  constexpr double kDegrees = 57.29577951308232;
  return fmt::format("{} is off by {:.1f} mm and {:.2f} degrees, more than its standard error says",
                     pose.name, 1e3 * pose.from_prior.tail<3>().norm(),
                     kDegrees * pose.from_prior.head<3>().norm());
}

std::string WhyRefused(const robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                       const JointCalibration& fit, const JointRequest& request) {
  if (!fit.status.ok()) {
    return fmt::format("the fit failed ({}): {}", ToString(fit.status.code()),
                       fit.status.message());
  }
  const FitCheck check = CheckFit(model, frames, fit);
  if (!check.possible) {
    return fmt::format(
        "the fit cannot be: the markers are {:.2f} mm from the model (RMS), where noise and "
        "tolerances explain {:.2f} mm (chi-squared {:.3g} for {} degrees of freedom; with "
        "tolerances {:.3g})",
        1e3 * check.residual_rms_m, 1e3 * check.expected_rms_m, fit.chi_squared,
        check.degrees_of_freedom, check.chi_squared);
  }
  const AdjustedPose* camera = MovedCamera(check, request);
  const auto moved = std::find_if(check.moved_poses.begin(), check.moved_poses.end(),
                                  [&](const AdjustedPose& pose) { return &pose != camera; });
  return moved == check.moved_poses.end() ? std::string() : "the fit cannot be: " + OffBy(*moved);
}

}  // namespace palpate::calibration
