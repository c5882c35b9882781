// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/model_hypothesis.hpp"
#include "components/diagnosis/forward/shapes_in_time.hpp"
#include "components/diagnosis/surface/seen_cloud.hpp"
#include "components/diagnosis/surface/surface_source.hpp"
#include "libs/correspondence/patch_matching.hpp"

namespace palpate::diagnosis {

/// Brings what depth frames show of the surface into the samples of an experiment: one coordinate
/// for each feature point of the robot that is in view (SurfaceMeasurement).
class SurfaceMatcher {
 public:
  /// Throws InputError where the robot has no feature points.
  explicit SurfaceMatcher(const robot::RobotBody& body);

  /// [3 x features] of the undeformed body.
  const Eigen::Matrix3Xd& rest_m() const { return features_.rest_m(); }

  /// Looks at all depth frames; `shapes` [samples]: where the robot is thought to be then.
  void Read(const ObservedExperiment& observed, const std::vector<ShapesInTime>& shapes,
            SurfaceSource* source);
  const SurfaceClouds& clouds() const { return clouds_; }

  /// Fills Sample::surface of all samples, matched about `shapes` [samples] of `hypothesis`.
  void Match(const ModelHypothesis& hypothesis, const std::vector<ShapesInTime>& shapes,
             ObservedExperiment* observed);
  /// Of the last Match: features in view whose clouds lie on the surface, and beyond it.
  int matched() const { return matched_; }
  int outliers() const { return outliers_; }

 private:
  struct MeanOf {
    double sum = 0.0;
    double count = 0.0;

    void Add(double value) {
      sum += value;
      ++count;
    }
    double Mean() const { return sum / count; }
  };

  /// One feature in one depth frame.
  struct FeatureInFrame {
    double height_m;  ///< mean of its cloud points over the surface as it is expected
    double sigma_m;
    robot::ObservationRow row;                              ///< of that surface
    Eigen::Vector3d normal;                                 ///< camera frame
    Eigen::Vector2d ripple_m_px = Eigen::Vector2d::Zero();  ///< SurfaceMeasurement::ripple_m_px
  };

  void MatchSample(const ModelHypothesis& hypothesis, const ShapesInTime& shapes, std::size_t s,
                   ObservedExperiment* observed);
  void MeasureFeatures(const Eigen::VectorXd& measured_m, double stereo_px_m, SeenCloud* seen,
                       std::vector<std::vector<FeatureInFrame>>* in_frames);
  static SurfaceMeasurement Mean(const std::vector<FeatureInFrame>& depth_frames);
  static void AddScatter(const std::vector<FeatureInFrame>& depth_frames, MeanOf* variance_m2);
  void SetSigmas(ObservedExperiment* observed) const;

  const robot::RobotBody& body_;
  correspondence::SurfaceFeatures features_;
  correspondence::MovingSurface surface_;
  correspondence::PredictedView view_;
  correspondence::PatchMatching patches_;
  SurfaceClouds clouds_;
  std::vector<MeanOf>
      measured_;                 ///< [features] variance of one depth frame where nothing moves, m2
  std::vector<MeanOf> nominal_;  ///< [features] as the depth noise makes it, m2
  int matched_ = 0;
  int outliers_ = 0;
};

}  // namespace palpate::diagnosis
