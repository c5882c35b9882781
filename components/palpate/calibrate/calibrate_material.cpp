// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <string>
#include <vector>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "components/calibration/material_calibration.hpp"
#include "components/calibration/recording_observation.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/fit_markers.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

using calibration::MaterialCalibration;

void PrintMaterialFit(const MaterialCalibration& fit,
                      const std::vector<calibration::StaticObservation>& observations) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    fmt::print("{}: marker residual {:.3f} mm RMS\n", observations[i].name,
               1e3 * fit.residual_rms_of_observation_m[i]);
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n", fit.chi_squared,
             fit.degrees_of_freedom, fit.iterations);
}

/// With the fitted moduli the markers must lie where the model has them.
void RequireSound(const CalibrateOptions& options, const experiment::Experiment& experiment,
                  const std::vector<const experiment::Recording*>& chosen,
                  robot::RobotModel* model) {
  calibration::RecordedFrames recorded(experiment, *model, ParseCableInput(options.cable_input),
                                       options.marker_bias_m);
  for (const experiment::Recording* recording : chosen) recorded.Add(*recording, false);
  calibration::JointRequest request{.pose = false, .own_poses = recorded.own_poses()};
  if (recorded.has_reference())
    request.marker_offset_sigma_m = calibration::OffsetOfMarkers_m(*model);
  FitMarkers(recorded.frames(), request, model);
}

}  // namespace

robot::CalibrationFile CalibrateMaterial(const CalibrateOptions& options,
                                         const experiment::Experiment& experiment,
                                         const std::vector<int>& materials,
                                         robot::RobotModel* model) {
  const calibration::MaterialCalibrationSettings settings{.materials = materials};
  const auto chosen = options.recordings.empty() ? RecordingsWithKnownLoads(experiment)
                                                 : ChooseRecordings(experiment, options.recordings);
  std::vector<calibration::StaticObservation> observations;
  for (const experiment::Recording* recording : chosen) {
    RequireLoads(*recording);
    observations.push_back(calibration::ObserveRecording(experiment, *recording, *model,
                                                         ParseCableInput(options.cable_input),
                                                         options.marker_bias_m));
  }
  const MaterialCalibration fit = calibration::CalibrateMaterial(*model, observations, settings);
  if (fit.status.code() == StatusCode::kUnobservable) {
    throw RunError(FailureText(fit.status) + "; it needs " + WhatTellsAModulus(chosen));
  }
  RequireFit(fit.status);
  RequireSound(options, experiment, chosen, model);
  robot::CalibrationFile file = calibration::MakeCalibration(*model, chosen, options.data);
  const std::vector<std::string> parts = calibration::PartNames(model->body());
  for (const calibration::FittedModulus& modulus : fit.moduli) {
    file.moduli.push_back(
        {parts.at(At(modulus.material)), modulus.youngs_modulus_Pa, modulus.standard_error_Pa});
  }
  TakeQuality(fit, &file);
  if (!options.json) PrintMaterialFit(fit, observations);
  return file;
}

}  // namespace palpate::command
