// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/calibration/joint/joint_request.hpp"
#include "libs/app/verbs.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::command {

struct CalibrateOptions {
  std::filesystem::path robot;
  std::string what = "auto";           ///< material, camera, joint (both); auto: what the data lack
  std::filesystem::path data;          ///< experiment or recording folder, or recorded messages
  std::vector<std::string> remap;      ///< FROM:=TO, of recorded messages
  std::string from;                    ///< markers, images; empty: what the recordings have
  std::string camera_pose;             ///< start of the fit to images; empty: the experiment's
  std::filesystem::path earlier;       ///< an earlier calibration file; empty: none
  std::vector<std::string> overrides;  ///< perception.*=VALUE
  std::vector<std::string> recordings;  ///< names; empty: all that are suitable
  std::vector<std::string> parts;       ///< "body" or names of regions; empty: the body
  std::string cable_input = "displacement";
  fem::SolverSettings solver;
  double marker_bias_m = 0.0;             ///< standard deviation of a marker's constant error
  double actuator_offset_sigma_m = 2e-3;  ///< prior standard deviation of an actuator's offset
  bool actuator_gains = false;            ///< estimate the actuators' gains, too
  double pressure_zero_sigma_Pa = calibration::JointRequest{}.pressure_zero_sigma_Pa;
  double pressure_gain_sigma = calibration::JointRequest{}.pressure_gain_sigma;
  bool fit_depth_bias = false;  ///< the default, said explicitly
  bool no_depth_bias = false;   ///< do not estimate the depth bias
  // Prior standard deviations; 0: not estimated.
  double marker_offset_sigma_m = 0.0;
  double gravity_tilt_sigma_deg = 0.0;
  double mass_relative_sigma = 0.0;
  double poissons_ratio_sigma = 0.0;
  double geometry_scale_sigma = 0.0;
  double cable_route_sigma_m = 0.0;
  double cable_eyelet_sigma_m = 0.0;
  double depth_scale_sigma = 0.0;
  std::filesystem::path out;
  bool unlabelled = false;            ///< names in markers.csv mean nothing
  std::filesystem::path assignment;   ///< SVG to draw (assignment_plot.hpp); empty: none
  std::filesystem::path convergence;  ///< SVG to draw (convergence_plot.hpp); empty: none
  bool json = false;
};

/// `palpate calibrate`: estimates camera pose and actuator offsets (from markers in the camera
/// frame, or from depth and colour images), Young's moduli (static phases under known loads or self
/// weight), or both jointly, and writes the calibration file. Returns 0; throws InputError, and
/// RunError where the data do not determine the parameters to estimate.
int Calibrate(const CalibrateOptions& options);

app::Verb CalibrateVerb();

}  // namespace palpate::command
