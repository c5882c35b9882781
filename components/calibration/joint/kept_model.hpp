// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The model's moduli, Poisson's ratios and gravity, to put back.
class KeptModel {
 public:
  /// `model` must outlive it.
  explicit KeptModel(robot::RobotModel& model)
      : model_(model), materials_(model.body().materials), gravity_m_s2_(model.gravity_m_s2()) {}

  void Restore() const {
    for (std::size_t m = 0; m < materials_.size(); ++m) {
      model_.SetYoungsModulus(static_cast<int>(m), materials_[m].youngs_modulus_Pa);
      model_.SetPoissonsRatio(static_cast<int>(m), materials_[m].poissons_ratio);
    }
    RestoreGravity();
  }
  void RestoreGravity() const { model_.SetGravity(gravity_m_s2_); }

 private:
  robot::RobotModel& model_;
  std::vector<fem::Material> materials_;
  Eigen::Vector3d gravity_m_s2_;
};

}  // namespace palpate::calibration
