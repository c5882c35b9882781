// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the model leaves unexplained of some markers.
struct ModelGapPart {
  std::string name;
  double residual_rms_m = 0.0;  ///< per coordinate
  double noise_rms_m = 0.0;     ///< per coordinate, expected from the noise alone
  int marker_count = 0;         ///< 0: nothing is known
};

struct ModelGapReport {
  ModelGapPart whole;
  std::vector<ModelGapPart> regions;  ///< "body", then the robot's regions
  std::vector<ModelGapPart> cables;   ///< markers nearer to this cable's attachment than to others
};

/// Splits the residual of an estimate over the parts of the robot.
class ModelGapMeter {
 public:
  /// Noise where a marker does not say its own: `default_sigma_m`; `bias_m` comes on top of both.
  ModelGapMeter(const robot::RobotBody& body, double default_sigma_m, double bias_m);

  ModelGapReport Measure(const MarkerFrame& frame, const ForceEstimate& estimate) const;

 private:
  double default_sigma_m_;
  double bias_m_;
  std::vector<std::string> region_names_;
  std::vector<std::string> cable_names_;
  std::vector<size_t> region_of_marker_;
  std::vector<size_t> cable_of_marker_;  ///< empty without cables
};

}  // namespace palpate::force_estimation
