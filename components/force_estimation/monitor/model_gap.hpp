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

/// Residual of some markers or surface points.
struct ModelGapPart {
  std::string name;
  double residual_rms_m = 0.0;  ///< per coordinate
  double noise_rms_m = 0.0;     ///< per coordinate, expected from the noise alone
  int sample_count = 0;         ///< 0: no data
};

struct ModelGapReport {
  ModelGapPart whole;
  std::vector<ModelGapPart> regions;  ///< "body", then the robot's regions
  std::vector<ModelGapPart> cables;   ///< points nearer to this cable's attachment than to others
};

/// Sums the residuals of points over the parts of the robot on which they are.
class ModelGapParts {
 public:
  ModelGapParts(const robot::RobotBody& body, const std::vector<fem::BodyPoint>& points);

  std::size_t PointCount() const { return region_of_point_.size(); }
  ModelGapReport Begin() const;
  /// Adds a point: the sum of its residual's squares and that of their variances.
  void Add(std::size_t point, double squares_m2, double variances_m2, ModelGapReport* report) const;
  /// Converts the sums to root mean squares, for points of so many coordinates.
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
  /// `default_sigma_m`: of markers without their own sigma; `bias_m` is added to both.
  ModelGapMeter(const robot::RobotBody& body, double default_sigma_m, double bias_m);

  ModelGapReport Measure(const MarkerFrame& frame, const ForceEstimate& estimate) const;

 private:
  double default_sigma_m_;
  double bias_m_;
  ModelGapParts parts_;
};

/// The same for an estimate from the robot's shape: residuals of its surface points, one coordinate
/// each, along the normal.
class FeatureGapMeter {
 public:
  explicit FeatureGapMeter(const robot::RobotBody& body) : parts_(body, body.feature_points) {}

  ModelGapReport Measure(const std::vector<FeatureReport>& features, const Status& status) const;

 private:
  ModelGapParts parts_;
};

}  // namespace palpate::force_estimation
