// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/marker_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "libs/geometry/rigid_registration.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

namespace {

constexpr int kLeastMarkers = 3;  // of a rigid motion

/// [3m x 6] how markers move with turn and shift.
Eigen::Matrix<double, Eigen::Dynamic, 6> MotionOf(const Eigen::Matrix3Xd& model_m,
                                                  const Eigen::Vector3d& middle_m) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> motion(3 * model_m.cols(), 6);
  for (Eigen::Index m = 0; m < model_m.cols(); ++m) {
    motion.middleRows<3>(3 * m) << -geometry::CrossMatrix(model_m.col(m) - middle_m),
        Eigen::Matrix3d::Identity();
  }
  return motion;
}

/// The weights projected off the response to contact forces: W - W A (A' W A)^-1 A' W.
Eigen::MatrixXd Unexplained(const MarkerMisfit& misfit) {
  Eigen::MatrixXd weight = misfit.weight.asDiagonal();
  if (misfit.response_m.cols() == 0) return weight;
  const Eigen::MatrixXd weighted = weight * misfit.response_m;
  Eigen::MatrixXd information = misfit.response_m.transpose() * weighted;
  // Regularised: forces without a response of any marker.
  information.diagonal().array() += 1e-12 * information.trace();
  weight -= weighted * linalg::SolveSymmetric(information, Eigen::MatrixXd(weighted.transpose()));
  return weight;
}

}  // namespace

MotionSighting SeeMotion(const MarkerMisfit& misfit, const Eigen::Matrix3Xd& model_m,
                         const Eigen::Vector3d& middle_m, const MarkerMotionTuning& tuning) {
  MotionSighting seen;
  const auto rows = static_cast<int>((misfit.weight.array() > 0.0).count());
  seen.points = rows / 3;
  const auto unknowns = static_cast<int>(misfit.response_m.cols()) + 6;
  if (seen.points < kLeastMarkers || rows <= unknowns) return seen;
  const Eigen::MatrixXd weight = Unexplained(misfit);
  const Eigen::Matrix<double, Eigen::Dynamic, 6> motion = MotionOf(model_m, middle_m);
  const Motion pull = motion.transpose() * weight * misfit.residual_m;
  const Eigen::Matrix<double, 6, 6> information =
      motion.transpose() * weight * motion + UnknownMotion();
  seen.motion = Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(information).solve(pull);
  const double left = misfit.residual_m.dot(weight * misfit.residual_m) - pull.dot(seen.motion);
  const double freedom = rows - unknowns;
  if (left <= freedom + tuning.far_sigmas * std::sqrt(2.0 * freedom))
    seen.information = information;
  return seen;
}

}  // namespace palpate::force_estimation
