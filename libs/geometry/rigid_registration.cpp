// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_registration.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <string>

namespace palpate::geometry {

namespace {

/// Points whose spread across the best line is below this part of their spread along it lie on a
/// line: the turn about it is not determined.
constexpr double kCollinearRatio = 1e-6;

Registration Refusal(StatusCode code, const std::string& reason) {
  Registration refusal;
  refusal.status = Status(code, reason);
  return refusal;
}

bool AreCollinear(const Eigen::Matrix3Xd& centred_m) {
  const Eigen::Matrix3d scatter_m2 = centred_m * centred_m.transpose();
  const Eigen::Vector3d spread_m2 = Eigen::JacobiSVD<Eigen::Matrix3d>(scatter_m2).singularValues();
  return !(spread_m2(1) > kCollinearRatio * kCollinearRatio * spread_m2(0));
}

/// The rotation that maximises the trace of R H', H = sum of target * source'.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& H_m2) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H_m2, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant();
  const Eigen::Vector3d signs(1.0, 1.0, handedness < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Registration RegisterRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& source_m,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& target_m) {
  if (source_m.cols() != target_m.cols()) {
    return Refusal(StatusCode::kInvalidInput,
                   "point sets of different size: " + std::to_string(source_m.cols()) + " and " +
                       std::to_string(target_m.cols()));
  }
  if (!source_m.allFinite() || !target_m.allFinite()) {
    return Refusal(StatusCode::kInvalidInput, "a coordinate is not finite");
  }
  if (source_m.cols() < 3) {
    return Refusal(StatusCode::kUnobservable,
                   "a rigid motion needs 3 points, there are " + std::to_string(source_m.cols()));
  }
  const Eigen::Vector3d source_mean_m = source_m.rowwise().mean();
  const Eigen::Vector3d target_mean_m = target_m.rowwise().mean();
  const Eigen::Matrix3Xd source_centred_m = source_m.colwise() - source_mean_m;
  const Eigen::Matrix3Xd target_centred_m = target_m.colwise() - target_mean_m;
  if (AreCollinear(source_centred_m) || AreCollinear(target_centred_m)) {
    return Refusal(StatusCode::kUnobservable,
                   "the points lie on one line: the turn about it is not determined");
  }
  const Eigen::Matrix3d R = NearestRotation(target_centred_m * source_centred_m.transpose());
  const double squares_m2 = (target_centred_m - R * source_centred_m).squaredNorm();

  Registration result;
  result.status = Status::Ok();
  result.T_target_source = RigidTransform(R, target_mean_m - R * source_mean_m);
  result.rms_m = std::sqrt(squares_m2 / static_cast<double>(source_m.cols()));
  return result;
}

}  // namespace palpate::geometry
