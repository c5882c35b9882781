// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/cable_path.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

double TurningAngle(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  return std::atan2(before.cross(after).norm(), before.dot(after));
}

void CablePath::Evaluate(const Eigen::Matrix3Xd& points_m, const CableFriction& friction) {
  PALPATE_CHECK(points_m.cols() >= 2, points_m.cols());
  friction_ = friction.coefficient;
  const Eigen::Index pieces = points_m.cols() - 1;
  direction_.setZero(3, pieces);
  inverse_length_.setZero(pieces);
  for (Eigen::Index j = 0; j < pieces; ++j) {
    const Eigen::Vector3d vector = points_m.col(j + 1) - points_m.col(j);
    const double length = vector.norm();
    if (length < kShortestPiece_m) continue;
    direction_.col(j) = vector / length;
    inverse_length_[j] = 1.0 / length;
  }
  FindTurns(friction);
  length_gradient_.setZero(3, points_m.cols());
  force_.setZero(3, points_m.cols());
  for (Eigen::Index j = 0; j < pieces; ++j) {
    length_gradient_.col(j) -= direction_.col(j);
    length_gradient_.col(j + 1) += direction_.col(j);
    AddPieceForce(j, fraction_[j] * direction_.col(j), &force_);
  }
}

void CablePath::FindTurns(const CableFriction& friction) {
  constexpr double kStraight = 1e-12;  // rad
  turns_.clear();
  turned_.setZero(PieceCount());
  Eigen::Index before = -1;
  double turned = 0.0;
  for (Eigen::Index j = 0; j < PieceCount(); ++j) {
    turned_[j] = turned;
    if (inverse_length_[j] == 0.0) continue;
    if (before >= 0) {
      const Eigen::Vector3d u = direction_.col(before);
      const Eigen::Vector3d v = direction_.col(j);
      TurnData turn{.before = before,
                    .after = j,
                    .angle = TurningAngle(u, v),
                    .sliding = friction.Sliding(static_cast<std::size_t>(j - 1))};
      const double sine = u.cross(v).norm();
      if (sine > kStraight) {
        const double cosine = u.dot(v);
        turn.by_before = -inverse_length_[before] / sine * (v - cosine * u);
        turn.by_after = -inverse_length_[j] / sine * (u - cosine * v);
      }
      turned += turn.sliding * turn.angle;
      turned_[j] = turned;
      turns_.push_back(turn);
    }
    before = j;
  }
  fraction_ = (-friction_ * turned_.array()).exp();
}

Eigen::Vector3d CablePath::PieceAlong(Eigen::Index piece, const Eigen::Matrix3Xd& motion_m) const {
  return motion_m.col(piece + 1) - motion_m.col(piece);
}

/// `pull`: tension times the direction of the piece; it draws its two ends together.
void CablePath::AddPieceForce(Eigen::Index piece, const Eigen::Vector3d& pull,
                              Eigen::Matrix3Xd* force) const {
  force->col(piece) += pull;
  force->col(piece + 1) -= pull;
}

double CablePath::AngleAlong(const TurnData& turn, const Eigen::Matrix3Xd& motion_m) const {
  return turn.by_before.dot(PieceAlong(turn.before, motion_m)) +
         turn.by_after.dot(PieceAlong(turn.after, motion_m));
}

double CablePath::LengthAlong(const Eigen::Matrix3Xd& motion_m) const {
  return length_gradient_.cwiseProduct(motion_m).sum();
}

void CablePath::ForceAlong(const Eigen::Matrix3Xd& motion_m, Eigen::Matrix3Xd* force) const {
  force->setZero(3, PieceCount() + 1);
  double turned_along = 0.0;
  size_t next_turn = 0;
  for (Eigen::Index j = 0; j < PieceCount(); ++j) {
    if (next_turn < turns_.size() && turns_[next_turn].after == j) {
      turned_along += turns_[next_turn].sliding * AngleAlong(turns_[next_turn], motion_m);
      ++next_turn;
    }
    const Eigen::Vector3d u = direction_.col(j);
    const Eigen::Vector3d moved = PieceAlong(j, motion_m);
    const Eigen::Vector3d turned = inverse_length_[j] * (moved - u.dot(moved) * u);
    AddPieceForce(j, fraction_[j] * (turned - friction_ * turned_along * u), force);
  }
}

void CablePath::ForceAlongFriction(Eigen::Matrix3Xd* force) const {
  force->setZero(3, PieceCount() + 1);
  for (Eigen::Index j = 0; j < PieceCount(); ++j) {
    AddPieceForce(j, -turned_[j] * fraction_[j] * direction_.col(j), force);
  }
}

void CablePath::ForceAlongFrictionAt(Eigen::Index eyelet, Eigen::Matrix3Xd* force) const {
  force->setZero(3, PieceCount() + 1);
  for (const TurnData& turn : turns_) {
    if (turn.after - 1 != eyelet) continue;
    for (Eigen::Index j = turn.after; j < PieceCount(); ++j) {
      AddPieceForce(j, -turn.angle * fraction_[j] * direction_.col(j), force);
    }
  }
}

void CablePath::Turn(int turn, Eigen::Matrix3Xd* force, Eigen::Matrix3Xd* angle) const {
  const TurnData& data = turns_.at(At(turn));
  force->setZero(3, PieceCount() + 1);
  angle->setZero(3, PieceCount() + 1);
  for (Eigen::Index j = data.after; j < PieceCount(); ++j) {
    AddPieceForce(j, -friction_ * data.sliding * fraction_[j] * direction_.col(j), force);
  }
  angle->col(data.before) -= data.by_before;
  angle->col(data.before + 1) += data.by_before;
  angle->col(data.after) -= data.by_after;
  angle->col(data.after + 1) += data.by_after;
}

}  // namespace palpate::robot
