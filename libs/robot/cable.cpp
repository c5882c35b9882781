// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/cable.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/cable_path.hpp"

namespace palpate::robot {

namespace {

/// The fraction of the actuator's tension in one piece after the other, from the actuator on.
class TensionAlong {
 public:
  explicit TensionAlong(const CableFriction& friction) : friction_(friction) {}

  /// `direction`: of a piece after the one before, unit; it begins at eyelet `piece` - 1.
  double Next(std::size_t piece, const Eigen::Vector3d& direction) {
    if (friction_.coefficient == 0.0) return 1.0;
    if (started_) {
      lost_ += friction_.Signed(piece - 1) * TurningAngle(before_, direction);
    }
    started_ = true;
    before_ = direction;
    return std::exp(-lost_);
  }

 private:
  const CableFriction& friction_;
  bool started_ = false;
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero();
  double lost_ = 0.0;  ///< the logarithm of the fraction that is not there
};

}  // namespace

Eigen::Vector3d Cable::Piece::Vector(const Eigen::VectorXd& x_m) const {
  Eigen::Vector3d vector = offset_m;
  for (size_t k = 0; k < nodes.size(); ++k) {
    vector += coefficients[k] * x_m.segment<3>(3 * nodes[k]);
  }
  return vector;
}

Cable::Cable(const Eigen::Vector3d& pull_point_m, std::vector<fem::InterpolationWeights> eyelets,
             const Eigen::VectorXd& rest_x_m)
    : pull_point_m_(pull_point_m), eyelets_(std::move(eyelets)) {
  PALPATE_CHECK(!eyelets_.empty());
  for (size_t e = 0; e < eyelets_.size(); ++e) pieces_.push_back(MakePiece(e));
  SetRestValue(Value(rest_x_m));
}

Cable::Piece Cable::MakePiece(size_t eyelet) const {
  Piece piece;
  std::map<int, double> coefficients;
  const auto add = [&](double sign, const fem::InterpolationWeights& end) {
    for (size_t k = 0; k < end.nodes.size(); ++k) {
      coefficients[end.nodes[k]] += sign * end.weights[k];
    }
  };
  add(1.0, eyelets_[eyelet]);
  if (eyelet == 0) {
    piece.offset_m = -pull_point_m_;
  } else {
    add(-1.0, eyelets_[eyelet - 1]);
  }
  for (const auto& [node, coefficient] : coefficients) {
    piece.nodes.push_back(node);
    piece.coefficients.push_back(coefficient);
  }
  return piece;
}

void Cable::SetPullPoint(const Eigen::Vector3d& pull_point_m, const Eigen::VectorXd& rest_x_m) {
  pull_point_m_ = pull_point_m;
  pieces_.front().offset_m = -pull_point_m;
  SetRestValue(Value(rest_x_m));
}

void Cable::SetEyelet(int eyelet, const std::vector<double>& weights,
                      const Eigen::VectorXd& rest_x_m) {
  const auto moved = static_cast<size_t>(eyelet);
  PALPATE_CHECK(weights.size() == eyelets_.at(moved).nodes.size(), weights.size(), eyelet);
  eyelets_[moved].weights = weights;
  for (size_t e = moved; e < std::min(moved + 2, pieces_.size()); ++e) {
    pieces_[e].coefficients = MakePiece(e).coefficients;
  }
  SetRestValue(Value(rest_x_m));
}

void Cable::SetFriction(const CableFriction& friction) {
  PALPATE_CHECK(friction.coefficient >= 0.0 && std::isfinite(friction.coefficient),
                friction.coefficient);
  const std::size_t count = friction.sliding.size();
  PALPATE_CHECK(count <= 1 || count == eyelets_.size(), count, eyelets_.size());
  for (const double sliding : friction.sliding) PALPATE_CHECK(std::abs(sliding) <= 1.0, sliding);
  friction_ = friction;
}

Eigen::Matrix3Xd Cable::Path_m(const Eigen::VectorXd& x_m) const {
  Eigen::Matrix3Xd path_m;
  FindPath(x_m, &path_m);
  return path_m;
}

void Cable::FindPath(const Eigen::VectorXd& x_m, Eigen::Matrix3Xd* path_m) const {
  path_m->resize(3, ToIndex(eyelets_.size()) + 1);
  path_m->col(0) = pull_point_m_;
  for (size_t e = 0; e < eyelets_.size(); ++e) {
    path_m->col(ToIndex(e) + 1) = eyelets_[e].Position(x_m);
  }
}

double Cable::Value(const Eigen::VectorXd& x_m) const {
  double length = 0.0;
  for (const Piece& piece : pieces_) length += piece.Vector(x_m).norm();
  return length;
}

void Cable::AddGradient(const Eigen::VectorXd& x_m, double factor, Eigen::VectorXd& nodal) const {
  TensionAlong tension(friction_);
  for (size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const Eigen::Vector3d vector = piece.Vector(x_m);
    const double length = vector.norm();
    if (length < kShortestPiece_m) continue;
    const double pull = factor * tension.Next(p, vector / length);
    const Eigen::Vector3d direction = pull / length * vector;
    for (size_t k = 0; k < piece.nodes.size(); ++k) {
      nodal.segment<3>(3 * piece.nodes[k]) += piece.coefficients[k] * direction;
    }
  }
}

fem::NodePairs Cable::CoupledPairs() const {
  fem::NodePairs pairs;
  for (const Piece& piece : pieces_) {
    for (size_t k = 1; k < piece.nodes.size(); ++k) {
      for (size_t l = 0; l < k; ++l) pairs.emplace_back(piece.nodes[k], piece.nodes[l]);
    }
  }
  return pairs;
}

void Cable::BindTo(const fem::StiffnessMatrix& stiffness) {
  for (Piece& piece : pieces_) {
    piece.slots.clear();
    for (size_t k = 0; k < piece.nodes.size(); ++k) {
      for (size_t l = 0; l <= k; ++l) {
        piece.slots.push_back(stiffness.Slot(piece.nodes[k], piece.nodes[l]));
      }
    }
  }
}

void Cable::AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                         fem::StiffnessMatrix& stiffness) const {
  TensionAlong tension(friction_);
  for (size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const Eigen::Vector3d vector = piece.Vector(x_m);
    const double length = vector.norm();
    if (length < kShortestPiece_m) continue;
    const Eigen::Vector3d u = vector / length;
    const double pull = multiplier * tension.Next(p, u);
    const Eigen::Matrix3d curvature =
        pull / length * (Eigen::Matrix3d::Identity() - u * u.transpose());
    size_t slot = 0;
    for (size_t k = 0; k < piece.nodes.size(); ++k) {
      for (size_t l = 0; l <= k; ++l) {
        const Eigen::Matrix3d block = piece.coefficients[k] * piece.coefficients[l] * curvature;
        stiffness.Add(piece.slots[slot++], block);
      }
    }
  }
}

}  // namespace palpate::robot
