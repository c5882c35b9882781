// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/fit_markers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "components/calibration/joint/fit_refusal.hpp"
#include "components/calibration/joint/misfit_reasons.hpp"
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
  if (!fit.status.ok()) RequirePossible(frames, fit, request, model);
  return fit;
}

}  // namespace

JointCalibration FitMarkers(const std::vector<CalibrationFrame>& frames, JointRequest request,
                            robot::RobotModel* model) {
  const calibration::ModelSnapshot kept(*model);
  JointCalibration fit = Fit(frames, request, model);
  const FitCheck check = calibration::CheckFit(*model, frames, fit);
  if (const AdjustedPose* moved = calibration::MovedCamera(check, request)) {
    const geometry::RigidTransform stated = request.pose_prior->T_robot_camera;
    kept.Restore();
    request.pose_prior.reset();
    fit = Fit(frames, request, model);
    AdjustedPose alone = *moved;
    alone.from_prior = calibration::ChangeBetween(stated, fit.T_robot_camera);
    fmt::print(stderr, "note: {}; the pose is estimated from the markers alone\n",
               calibration::OffBy(alone));
  }
  RequirePossible(frames, fit, request, model);
  NoteModuli(fit);
  return fit;
}

void RequirePossible(const std::vector<CalibrationFrame>& frames, const JointCalibration& fit,
                     const JointRequest& request, robot::RobotModel* model) {
  const std::string why = calibration::WhyRefused(*model, frames, fit, request);
  if (why.empty()) return;
  const std::string reasons = calibration::FindMisfitReasons(*model, frames, request).Text();
  throw RunError(why + "; nothing was written. Likely reasons, the best first:\n" + reasons);
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
      !file.drives.empty() || !file.pressure_sensors.empty() || file.geometry_scale ||
      !file.cable_routes.empty()) {
    return;
  }
  std::string text = "these data determine nothing";
  for (const robot::Undetermined& number : file.undetermined) {
    text += "\n" + UndeterminedText(number);
  }
  throw RunError(text);
}

}  // namespace palpate::command
