// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/fit_markers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "components/calibration/joint/fit_check.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::command {

namespace {

using calibration::AdjustedPose;
using calibration::CalibrationFrame;
using calibration::FitCheck;
using calibration::JointCalibration;
using calibration::JointRequest;

std::string OffBy(const AdjustedPose& pose) {
  constexpr double kDegrees = 57.29577951308232;
  return fmt::format("{} is off by {:.1f} mm and {:.2f} degrees, more than its standard error says",
                     pose.name, 1e3 * pose.from_prior.tail<3>().norm(),
                     kDegrees * pose.from_prior.head<3>().norm());
}

[[noreturn]] void Refuse(const std::string& what, const std::vector<CalibrationFrame>& frames,
                         const JointRequest& request, robot::RobotModel* model) {
  const std::string reasons = calibration::FindMisfitReasons(*model, frames, request).Text();
  throw RunError(what + "; nothing was written. Likely reasons, the best first:\n" + reasons);
}

const AdjustedPose* MovedPose(const FitCheck& check, const JointRequest& request) {
  if (!request.pose_prior) return nullptr;
  const auto found =
      std::find_if(check.moved_poses.begin(), check.moved_poses.end(),
                   [&](const AdjustedPose& pose) { return pose.name == request.pose_prior->name; });
  return found == check.moved_poses.end() ? nullptr : &*found;
}

/// The robot file's modulus is the prior mean, so that a factor of ten is a mistake in one of both.
void NoteModuli(const JointCalibration& fit) {
  constexpr double kOtherUnit = 10.0;
  for (const calibration::FittedValue& value : fit.values) {
    if (!value.name.starts_with("youngs_modulus:") || !value.determined) continue;
    const double ratio = value.value / value.prior_mean;
    if (ratio < kOtherUnit && ratio > 1.0 / kOtherUnit) continue;
    fmt::print(stderr,
               "note: {} is {:.3g} times that of the robot file: is its youngs_modulus_Pa in kPa "
               "or MPa?\n",
               value.name, ratio);
  }
}

JointCalibration Fit(const std::vector<CalibrationFrame>& frames, const JointRequest& request,
                     robot::RobotModel* model) {
  JointCalibration fit = calibration::CalibrateFrames(*model, frames, nullptr, request);
  if (!fit.status.ok()) Refuse(FailureText(fit.status), frames, request, model);
  return fit;
}

}  // namespace

JointCalibration FitMarkers(const std::vector<CalibrationFrame>& frames, JointRequest request,
                            robot::RobotModel* model) {
  const calibration::ModelSnapshot kept(*model);
  JointCalibration fit = Fit(frames, request, model);
  const FitCheck check = calibration::CheckFit(*model, frames, fit);
  if (const AdjustedPose* moved = MovedPose(check, request)) {
    const geometry::RigidTransform stated = request.pose_prior->T_robot_camera;
    kept.Restore();
    request.pose_prior.reset();
    fit = Fit(frames, request, model);
    AdjustedPose alone = *moved;
    alone.from_prior = calibration::ChangeBetween(stated, fit.T_robot_camera);
    fmt::print(stderr, "note: {}; the pose is estimated from the markers alone\n", OffBy(alone));
  }
  RequirePossible(frames, fit, request, model);
  NoteModuli(fit);
  return fit;
}

void RequirePossible(const std::vector<CalibrationFrame>& frames, const JointCalibration& fit,
                     const JointRequest& request, robot::RobotModel* model) {
  const FitCheck check = calibration::CheckFit(*model, frames, fit);
  const AdjustedPose* camera = MovedPose(check, request);
  const auto moved = std::find_if(check.moved_poses.begin(), check.moved_poses.end(),
                                  [&](const AdjustedPose& pose) { return &pose != camera; });
  if (check.possible && moved == check.moved_poses.end()) return;
  std::string what = "the fit cannot be: ";
  if (check.possible) {
    what += OffBy(*moved);
  } else {
    what += fmt::format(
        "the markers are {:.2f} mm from the model (RMS), where noise and tolerances explain {:.2f} "
        "mm (chi-squared {:.3g} for {} degrees of freedom; with tolerances {:.3g})",
        1e3 * check.residual_rms_m, 1e3 * check.expected_rms_m, fit.chi_squared,
        check.degrees_of_freedom, check.chi_squared);
  }
  Refuse(what, frames, request, model);
}

double OffsetOfMarkers_m(const robot::RobotModel& model) {
  constexpr double kShareOfExtent = 0.02;
  const Eigen::Matrix3Xd& nodes_m = model.body().mesh.nodes_m;
  return kShareOfExtent * (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).maxCoeff();
}

std::string WhatTellsAModulus(const std::vector<const experiment::Recording*>& recordings) {
  std::vector<std::string> loaded;
  for (const experiment::Recording* recording : recordings) {
    double largest_N = 0.0;
    for (const experiment::KnownLoad& load : recording->loads) {
      largest_N = std::max(largest_N, load.force_N.norm());
    }
    if (largest_N > 0.0) loaded.push_back(fmt::format("{} ({:.3g} N)", recording->name, largest_N));
  }
  if (loaded.empty()) {
    return "a recording with a known load, or with cables whose tension is measured";
  }
  return "larger known loads than those that counted, " + Listed(loaded) +
         ", or measured tensions of the cables";
}

void NameKnownLoads(const std::vector<const experiment::Recording*>& recordings,
                    robot::CalibrationFile* file) {
  for (robot::Undetermined& number : file->undetermined) {
    if (number.name.starts_with("youngs_modulus:")) {
      number.what_would_tell = WhatTellsAModulus(recordings);
    }
  }
}

void RequireSomething(const robot::CalibrationFile& file) {
  if (!file.moduli.empty() || !file.poissons_ratios.empty() || file.gravity || file.pose ||
      !file.drives.empty() || file.geometry_scale || !file.cable_routes.empty()) {
    return;
  }
  std::string text = "these data determine nothing";
  for (const robot::Undetermined& number : file.undetermined) {
    text += "\n" + UndeterminedText(number);
  }
  throw RunError(text);
}

}  // namespace palpate::command
