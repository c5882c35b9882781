// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/eyelets.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Moduli, Poisson's ratios, cable routes, drives and gravity of a model, for restoring them.
class ModelSnapshot {
 public:
  /// `model` must outlive it.
  explicit ModelSnapshot(robot::RobotModel& model)
      : model_(model),
        materials_(model.body().materials),
        cables_(model.body().cables),
        drives_(model.drives()),
        gravity_m_s2_(model.gravity_m_s2()) {
    for (int c = 0; c < model.CableCount(); ++c) {
      pull_points_m_.push_back(model.cable(c).pull_point_m());
    }
  }

  void Restore() const {
    for (std::size_t m = 0; m < materials_.size(); ++m) {
      model_.SetYoungsModulus(static_cast<int>(m), materials_[m].youngs_modulus_Pa);
      model_.SetPoissonsRatio(static_cast<int>(m), materials_[m].poissons_ratio);
    }
    for (int c = 0; c < model_.CableCount(); ++c) {
      model_.SetPullPoint(c, pull_points_m_[At(c)]);
      RestoreEyelets(c);
    }
    for (int a = 0; a < model_.ActuatorCount(); ++a) model_.SetDrive(a, drives_[At(a)]);
    RestoreGravity();
  }
  void RestoreGravity() const { model_.SetGravity(gravity_m_s2_); }

 private:
  void RestoreEyelets(int cable) const {
    const robot::BodyCable& before = cables_[At(cable)];
    const robot::BodyCable& now = model_.body().cables[At(cable)];
    for (int e = 0; e < static_cast<int>(before.eyelets.size()); ++e) {
      const Eigen::Vector3d moved_m = robot::EyeletMoved_m(before, e);
      if (robot::EyeletMoved_m(now, e) == moved_m) continue;
      const Status moved = model_.MoveEyelet(cable, e, moved_m);
      PALPATE_CHECK(moved.ok(), cable, e);  // it was there before
    }
  }

  robot::RobotModel& model_;
  std::vector<fem::Material> materials_;
  std::vector<robot::BodyCable> cables_;
  std::vector<robot::DriveCalibration> drives_;
  std::vector<Eigen::Vector3d> pull_points_m_;
  Eigen::Vector3d gravity_m_s2_;
};

}  // namespace palpate::calibration
