// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/cable_geometry.hpp"

#include <map>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/cable_path.hpp"

namespace palpate::virtual_robot {

CableGeometry::CableGeometry(const Eigen::Vector3d& guide_m,
                             const std::vector<fem::InterpolationWeights>& eyelets) {
  PALPATE_CHECK(!eyelets.empty());
  for (size_t e = 0; e < eyelets.size(); ++e) {
    Piece piece;
    std::map<int, double> coefficients;
    if (e == 0) piece.offset_m = -guide_m;
    for (size_t k = 0; k < eyelets[e].nodes.size(); ++k) {
      coefficients[eyelets[e].nodes[k]] += eyelets[e].weights[k];
    }
    for (size_t k = 0; e > 0 && k < eyelets[e - 1].nodes.size(); ++k) {
      coefficients[eyelets[e - 1].nodes[k]] -= eyelets[e - 1].weights[k];
    }
    for (const auto& [node, coefficient] : coefficients) {
      piece.nodes.push_back(node);
      piece.coefficients.push_back(coefficient);
    }
    pieces_.push_back(std::move(piece));
  }
}

fem::NodePairs CableGeometry::CoupledPairs() const {
  fem::NodePairs pairs;
  for (const Piece& piece : pieces_) {
    for (size_t k = 1; k < piece.nodes.size(); ++k) {
      for (size_t l = 0; l < k; ++l) pairs.emplace_back(piece.nodes[k], piece.nodes[l]);
    }
  }
  return pairs;
}

void CableGeometry::BindTo(const fem::StiffnessMatrix& stiffness) {
  for (Piece& piece : pieces_) {
    piece.slots.clear();
    for (size_t k = 0; k < piece.nodes.size(); ++k) {
      for (size_t l = 0; l <= k; ++l) {
        piece.slots.push_back(stiffness.Slot(piece.nodes[k], piece.nodes[l]));
      }
    }
  }
}

void CableGeometry::Evaluate(const Eigen::VectorXd& x_m) {
  for (Piece& piece : pieces_) {
    Eigen::Vector3d vector_m = piece.offset_m;
    for (size_t k = 0; k < piece.nodes.size(); ++k) {
      vector_m += piece.coefficients[k] * x_m.segment<3>(3 * piece.nodes[k]);
    }
    piece.length_m = vector_m.norm();
    if (piece.length_m < robot::kShortestPiece_m) {
      piece.direction.setZero();
    } else {
      piece.direction = vector_m / piece.length_m;
    }
  }
}

double CableGeometry::TotalLength_m() const {
  double length_m = 0.0;
  for (const Piece& piece : pieces_) length_m += piece.length_m;
  return length_m;
}

double CableGeometry::TurningAngle_rad(int piece) const {
  const Eigen::Vector3d& before = pieces_[static_cast<size_t>(piece) - 1].direction;
  const Eigen::Vector3d& after = pieces_[At(piece)].direction;
  if (before.isZero() || after.isZero()) return 0.0;
  return robot::TurningAngle(before, after);
}

double CableGeometry::SquaredEyeletForces() const {
  double sum = pieces_.back().direction.squaredNorm();
  for (size_t e = 1; e < pieces_.size(); ++e) {
    sum += (pieces_[e].direction - pieces_[e - 1].direction).squaredNorm();
  }
  return sum;
}

void CableGeometry::AddGradient(int index, double factor, Eigen::VectorXd& nodal) const {
  const Piece& piece = pieces_[At(index)];
  for (size_t k = 0; k < piece.nodes.size(); ++k) {
    nodal.segment<3>(3 * piece.nodes[k]) += factor * piece.coefficients[k] * piece.direction;
  }
}

void CableGeometry::AddCurvature(int index, double tension_N,
                                 fem::StiffnessMatrix& stiffness) const {
  const Piece& piece = pieces_[At(index)];
  if (piece.direction.isZero() || tension_N == 0.0) return;
  const Eigen::Matrix3d curvature =
      tension_N / piece.length_m *
      (Eigen::Matrix3d::Identity() - piece.direction * piece.direction.transpose());
  size_t slot = 0;
  for (size_t k = 0; k < piece.nodes.size(); ++k) {
    for (size_t l = 0; l <= k; ++l) {
      const Eigen::Matrix3d block = piece.coefficients[k] * piece.coefficients[l] * curvature;
      stiffness.Add(piece.slots[slot++], block);
    }
  }
}

}  // namespace palpate::virtual_robot
