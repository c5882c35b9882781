// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/check.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

class PullPoint final : public Parameter {
 public:
  PullPoint(int cable, const Eigen::Vector3d& direction, CableZero zero)
      : cable_(cable), direction_(direction), zero_(zero) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    const Eigen::Index points = at.path(cable_).PieceCount() + 1;
    Eigen::Matrix3Xd motion = Eigen::Matrix3Xd::Zero(3, points);
    motion.col(0) = direction_;
    at.MovePath(cable_, motion, column);
    if (zero_ == CableZero::kKept) return;
    column->commanded_length_m[cable_] += at.rest_path(cable_).LengthAlong(motion);
  }

 private:
  int cable_;
  Eigen::Vector3d direction_;
  CableZero zero_;
};

/// The eyelet's place changes as well as what it holds on to.
class Eyelet final : public Parameter {
 public:
  Eyelet(int cable, int eyelet, fem::InterpolationWeights weights_along, CableZero zero)
      : cable_(cable), eyelet_(eyelet), weights_(std::move(weights_along)), zero_(zero) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    const Eigen::Index points = at.path(cable_).PieceCount() + 1;
    PALPATE_CHECK(eyelet_ >= 0 && eyelet_ + 1 < points, eyelet_);
    Eigen::Matrix3Xd motion = Eigen::Matrix3Xd::Zero(3, points);
    motion.col(eyelet_ + 1) = weights_.Position(at.x_m());
    at.MovePath(cable_, motion, column);
    const Eigen::Vector3d force_N = at.tension_N(cable_) * at.path(cable_).force().col(eyelet_ + 1);
    column->AddForce(weights_, force_N);
    if (zero_ == CableZero::kKept) return;
    motion.col(eyelet_ + 1) = weights_.Position(at.model().elastic_body().rest_m());
    column->commanded_length_m[cable_] += at.rest_path(cable_).LengthAlong(motion);
  }

 private:
  int cable_;
  int eyelet_;
  fem::InterpolationWeights weights_;
  CableZero zero_;
};

}  // namespace

ParameterPtr PullPointMove(int cable, const Eigen::Vector3d& direction, CableZero zero) {
  return std::make_unique<PullPoint>(cable, direction, zero);
}

ParameterPtr EyeletMove(int cable, int eyelet, fem::InterpolationWeights weights_along,
                        CableZero zero) {
  return std::make_unique<Eyelet>(cable, eyelet, std::move(weights_along), zero);
}

}  // namespace palpate::robot
