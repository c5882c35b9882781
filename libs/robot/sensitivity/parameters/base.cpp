// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A small rigid motion of the base: turn about a pivot (0-2), translation (3-5).
class Base {
 public:
  Base(const Eigen::Vector3d& pivot_m, BaseRiders riders) : pivot_m_(pivot_m), riders_(riders) {}

  void Move(const EquilibriumPoint& at, const Vector6d& motion, ParameterColumn* column) const {
    const Eigen::Vector3d turn = motion.head<3>();
    const Eigen::Vector3d translation = motion.tail<3>();
    for (Eigen::Index node = 0; node < at.x_m().size() / 3; ++node) {
      const Eigen::Vector3d arm_m = at.x_m().segment<3>(3 * node) - pivot_m_;
      at.MoveHeldNode(node, turn.cross(arm_m) + translation, column);
    }
    if (riders_ == BaseRiders::kHeldNodes) return;
    for (int c = 0; c < at.model().CableCount(); ++c) {
      Eigen::Matrix3Xd path = Eigen::Matrix3Xd::Zero(3, at.path(c).PieceCount() + 1);
      path.col(0) = turn.cross(at.model().cable(c).pull_point_m() - pivot_m_) + translation;
      at.MovePath(c, path, column);
    }
  }

  /// Moment about the pivot and force with which body and riding pull points act on the base.
  Vector6d Wrench(const EquilibriumPoint& at) const {
    Vector6d wrench = Vector6d::Zero();
    for (Eigen::Index node = 0; node < at.x_m().size() / 3; ++node) {
      Eigen::Vector3d force_N = at.force_on_base_N().segment<3>(3 * node);
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (!at.Holds(node, i)) force_N[i] = 0.0;
      }
      AddForce(at.x_m().segment<3>(3 * node), force_N, &wrench);
    }
    if (riders_ == BaseRiders::kHeldNodes) return wrench;
    for (int c = 0; c < at.model().CableCount(); ++c) {
      AddForce(at.model().cable(c).pull_point_m(), at.tension_N(c) * at.path(c).force().col(0),
               &wrench);
    }
    return wrench;
  }

 private:
  void AddForce(const Eigen::Vector3d& point_m, const Eigen::Vector3d& force_N,
                Vector6d* wrench) const {
    wrench->head<3>() += (point_m - pivot_m_).cross(force_N);
    wrench->tail<3>() += force_N;
  }

  Eigen::Vector3d pivot_m_;
  BaseRiders riders_;
};

class BaseMotion final : public Parameter {
 public:
  BaseMotion(const Base& base, const Vector6d& motion) : base_(base), motion_(motion) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    base_.Move(at, motion_, column);
  }

 private:
  Base base_;
  Vector6d motion_;
};

class ElasticBase final : public Parameter {
 public:
  ElasticBase(const Base& base, const Matrix6d& compliance)
      : base_(base), compliance_(compliance) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    base_.Move(at, compliance_ * base_.Wrench(at), column);
  }

 private:
  Base base_;
  Matrix6d compliance_;
};

Vector6d Motion(const Eigen::Vector3d& turn, const Eigen::Vector3d& translation) {
  Vector6d motion;
  motion << turn, translation;
  return motion;
}

}  // namespace

ParameterPtr BaseRotation(const Eigen::Vector3d& axis, const Eigen::Vector3d& pivot_m,
                          BaseRiders riders) {
  return std::make_unique<BaseMotion>(Base(pivot_m, riders), Motion(axis, Eigen::Vector3d::Zero()));
}

ParameterPtr BaseTranslation(const Eigen::Vector3d& direction, BaseRiders riders) {
  return std::make_unique<BaseMotion>(Base(Eigen::Vector3d::Zero(), riders),
                                      Motion(Eigen::Vector3d::Zero(), direction));
}

ParameterPtr BaseCompliance(const Matrix6d& compliance, const Eigen::Vector3d& pivot_m,
                            BaseRiders riders) {
  return std::make_unique<ElasticBase>(Base(pivot_m, riders), compliance);
}

}  // namespace palpate::robot
