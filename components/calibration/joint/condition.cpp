// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/condition.hpp"

#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

constexpr double kPerMillimetre = 1e3;

class CableLengthsCondition final : public Condition {
 public:
  CableLengthsCondition(int frame, std::vector<double> shares, double lower_m, double upper_m)
      : Condition(frame, kPerMillimetre * lower_m, kPerMillimetre * upper_m),
        shares_(std::move(shares)) {}

  double Value(const robot::RobotModel& model, const fem::StaticState& state) const override {
    PALPATE_CHECK(static_cast<int>(shares_.size()) == model.ActuatorCount(), shares_.size());
    double sum_m = 0.0;
    for (int c = 0; c < model.ActuatorCount(); ++c) {
      sum_m += shares_[At(c)] * model.actuator(c).Displacement_m(state.x_m);
    }
    return kPerMillimetre * sum_m;
  }

  Eigen::RowVectorXd Derivative(const robot::SensitivitySolver& sensitivity) const override {
    const Eigen::Map<const Eigen::RowVectorXd> shares(shares_.data(), ToIndex(shares_.size()));
    return -kPerMillimetre * shares * sensitivity.length_m();
  }

 private:
  std::vector<double> shares_;
};

class PlaneCondition final : public Condition {
 public:
  PlaneCondition(int frame, fem::InterpolationWeights point, const Eigen::Vector3d& plane_point_m,
                 const Eigen::Vector3d& normal, double distance_m)
      : Condition(frame, kPerMillimetre * distance_m, std::numeric_limits<double>::infinity()),
        point_(std::move(point)),
        plane_point_m_(plane_point_m),
        normal_(normal) {}

  double Value(const robot::RobotModel&, const fem::StaticState& state) const override {
    return kPerMillimetre * normal_.dot(point_.Position(state.x_m) - plane_point_m_);
  }

  Eigen::RowVectorXd Derivative(const robot::SensitivitySolver& sensitivity) const override {
    return kPerMillimetre * normal_.transpose() * sensitivity.PointMotion(point_);
  }

 private:
  fem::InterpolationWeights point_;
  Eigen::Vector3d plane_point_m_;
  Eigen::Vector3d normal_;
};

}  // namespace

ConditionPtr CableLengths(int frame, std::vector<double> shares, double lower_m, double upper_m) {
  return std::make_unique<CableLengthsCondition>(frame, std::move(shares), lower_m, upper_m);
}

ConditionPtr StaysBeyondPlane(int frame, fem::InterpolationWeights point,
                              const Eigen::Vector3d& plane_point_m, const Eigen::Vector3d& normal,
                              double distance_m) {
  return std::make_unique<PlaneCondition>(frame, std::move(point), plane_point_m, normal,
                                          distance_m);
}

}  // namespace palpate::calibration
