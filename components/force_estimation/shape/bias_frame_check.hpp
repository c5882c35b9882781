// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "components/force_estimation/shape/depth_bias.hpp"
#include "libs/correspondence/feature_match.hpp"

namespace palpate::force_estimation {

struct BiasFrameCheckTuning {
  /// Mean square of a sequence's residuals over their variance above which something else than a
  /// depth bias is in them. Larger: weak contacts pass as a bias; smaller: model errors of postures
  /// far apart count as contacts.
  double largest_misfit = 9.0;
  /// Share of a surface point's offset that depends on the posture from which it is seen. Larger:
  /// weak contacts pass; smaller: the facets of the mesh count as contacts.
  double posture_share = 0.3;
};

/// A sequence of bias frames, as BiasFrameCheck finds it.
struct BiasSequence {
  std::uint32_t epoch = 0;  ///< ShapeFrame::epoch
  int frames = 0;           ///< with matched surface points
  /// Mean square of its residuals over their variance: against what the other sequences predict;
  /// against the prior where there is no other. 1 where nothing but the depth bias is in them.
  double misfit = 0.0;
  double difference_m = 0.0;  ///< RMS of those residuals
  bool contact_free = false;  ///< misfit <= BiasFrameCheckTuning::largest_misfit
};

/// Checks that frames which are said to be contact-free are so, before the depth bias is taken from
/// them. What the camera's errors may be, the priors of DepthBias say; they are the same in all
/// sequences. A contact is in one of them: it bends the body as no depth bias does, and as the
/// other sequences do not.
class BiasFrameCheck {
 public:
  BiasFrameCheck(const ShapeConfig& config, const BiasFrameCheckTuning& tuning = {})
      : config_(config), tuning_(tuning) {}

  /// As DepthBias::Learn, of `bias`, whose prior counts.
  void Add(const DepthBias& bias, std::uint32_t epoch,
           std::span<const correspondence::FeatureMatch> matches, const Eigen::VectorXd& x_m,
           const Eigen::Isometry3d& T_robot_camera);

  /// The verdict on each sequence, by rising epoch. The sequence that fits the others least is
  /// taken out until the rest agree; of two that do not agree it is the one that fits the prior
  /// less.
  std::vector<BiasSequence> Judge() const;

 private:
  /// Means of one surface point over the frames of a sequence.
  struct Point {
    int count = 0;
    double residual_m = 0.0;   ///< sum
    double variance_m2 = 0.0;  ///< sum, of the noise
    Eigen::VectorXd basis;     ///< sum, of DepthBias' shared parameters at a prior sigma of 1
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< sum, camera frame
  };
  struct Sequence {
    int frames = 0;
    std::map<int, Point> points;  ///< by surface point
  };
  struct Misfit {
    double value = 0.0;
    double difference_m = 0.0;
  };

  Misfit MisfitOf(std::uint32_t epoch, const std::vector<std::uint32_t>& others) const;
  double VarianceOf_m2(const Point& point, double moved_m) const;

  ShapeConfig config_;
  BiasFrameCheckTuning tuning_;
  std::map<std::uint32_t, Sequence> sequences_;
};

}  // namespace palpate::force_estimation
