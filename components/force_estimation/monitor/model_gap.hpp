// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the model leaves unexplained of some markers or feature points.
struct ModelGapPart {
  std::string name;
  double residual_rms_m = 0.0;  ///< per coordinate
  double noise_rms_m = 0.0;     ///< per coordinate, expected from the noise alone
  int sample_count = 0;         ///< 0: nothing is known
};

struct ModelGapReport {
  ModelGapPart whole;
  std::vector<ModelGapPart> regions;  ///< "body", then the robot's regions
  std::vector<ModelGapPart> cables;   ///< points nearer to this cable's attachment than to others
};

/// Shares the residuals of points out among the parts of the robot that they stand on.
class ModelGapParts {
 public:
  ModelGapParts(const robot::RobotBody& body, const std::vector<fem::BodyPoint>& points);

  std::size_t PointCount() const { return region_of_point_.size(); }
  ModelGapReport Begin() const;
  /// Adds a point: the sum of its residual's squares and that of their variances.
  void Add(std::size_t point, double squares_m2, double variances_m2, ModelGapReport* report) const;
  /// Makes root mean squares of the sums, over points of so many coordinates.
  static void Finish(int coordinates, ModelGapReport* report);

 private:
  std::vector<std::string> region_names_;
  std::vector<std::string> cable_names_;
  std::vector<size_t> region_of_point_;
  std::vector<size_t> cable_of_point_;  ///< empty without cables
};

/// Splits the residual of an estimate from markers over the parts of the robot.
class ModelGapMeter {
 public:
  /// Noise where a marker does not say its own: `default_sigma_m`; `bias_m` comes on top of both.
  ModelGapMeter(const robot::RobotBody& body, double default_sigma_m, double bias_m);

  ModelGapReport Measure(const MarkerFrame& frame, const ForceEstimate& estimate) const;

 private:
  double default_sigma_m_;
  double bias_m_;
  ModelGapParts parts_;
};

/// The same of an estimate from the robot's shape: residuals of its feature points, one coordinate
/// each, along the normal.
class FeatureGapMeter {
 public:
  explicit FeatureGapMeter(const robot::RobotBody& body) : parts_(body, body.feature_points) {}

  ModelGapReport Measure(const std::vector<FeatureReport>& features, const Status& status) const;

 private:
  ModelGapParts parts_;
};

}  // namespace palpate::force_estimation
