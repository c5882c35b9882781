// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>

#include "components/force_estimation/force_estimate.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::offline {

struct RestCheckTuning {
  /// Detections beyond this share of the frames are an error, whatever the significance is: noise
  /// has outliers that a normal distribution does not know.
  double accepted_share = 0.01;
  /// And beyond the number that chance gives, by this many of its standard deviations.
  double chance_sigmas = 5.0;
};

/// Counts the frames of a contact-free rest recording in which a contact is found, be its force
/// known or not. More than chance gives means that the model does not have the robot's rest shape:
/// all its forces are in doubt.
class RestCheck {
 public:
  struct Known {
    bool calibrated = false;     ///< a calibration file is given
    double significance = 1e-3;  ///< false-alarm probability per frame
    Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  };

  RestCheck(const experiment::Experiment& experiment, const experiment::Recording& recording,
            const Known& known, const RestCheckTuning& tuning = {});

  /// Frames of the static phase count.
  void Add(const force_estimation::ForceEstimate& estimate);

  /// The error and its likely reasons, the likeliest first; nullopt: as few forces as chance gives,
  /// or a recording of another kind.
  std::optional<std::string> Failure() const;

 private:
  std::string Reasons() const;

  const experiment::Experiment& experiment_;
  const experiment::Recording& recording_;
  Known known_;
  RestCheckTuning tuning_;
  int frames_ = 0;
  int touched_frames_ = 0;  ///< in which the shape without contact is rejected
  double largest_N_ = 0.0;
};

}  // namespace palpate::offline
