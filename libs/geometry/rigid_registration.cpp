// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/svd.hpp"

namespace palpate::geometry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Points = Eigen::Ref<const Eigen::Matrix3Xd>;

/// Points whose spread across the best line is below this part of their spread along it lie on a
/// line: the turn about it is not determined.
constexpr double kCollinearRatio = 1e-6;
/// A turn known no better (one sigma) counts as not determined.
constexpr double kOpenTurn_rad = 0.3;
/// A reflection that leaves less than this part of the distances explains the points far better.
constexpr double kMirroredRatio = 1.0 / 3.0;
/// Beside rounding: distances up to this part of the points' spread are none.
constexpr double kExact = 1e-7;

Registration Refusal(StatusCode code, const std::string& reason) {
  Registration refusal;
  refusal.status = Status(code, reason);
  return refusal;
}

/// Three digits, for messages.
std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Both sets about their weighted means.
struct CentredPairs {
  Eigen::VectorXd weight;  ///< adds up to 1
  Eigen::Vector3d source_mean_m, target_mean_m;
  Eigen::Matrix3Xd source_m, target_m;
};

CentredPairs Centre(const Points& source_m, const Points& target_m, const Eigen::VectorXd& weight) {
  CentredPairs pairs;
  pairs.weight = weight / weight.sum();
  pairs.source_mean_m = source_m * pairs.weight;
  pairs.target_mean_m = target_m * pairs.weight;
  pairs.source_m = source_m.colwise() - pairs.source_mean_m;
  pairs.target_m = target_m.colwise() - pairs.target_mean_m;
  return pairs;
}

/// Ok where the points span a plane at least.
Status CheckSpread(const Eigen::Matrix3Xd& centred_m, double distance_to_origin_m) {
  const Eigen::Vector3d spread_m = linalg::SingularValues(centred_m);
  if (!(spread_m(0) > kCollinearRatio * kCollinearRatio * distance_to_origin_m)) {
    return {StatusCode::kUnobservable, "the points are all in one place"};
  }
  if (!(spread_m(1) > kCollinearRatio * spread_m(0))) {
    return {StatusCode::kUnobservable,
            "the points lie on one line: the turn about it is not determined"};
  }
  return Status::Ok();
}

Status CheckPairs(const Points& source_m, const Points& target_m) {
  if (source_m.cols() != target_m.cols()) {
    return {StatusCode::kInvalidInput,
            "point sets of different size: " + std::to_string(source_m.cols()) + " and " +
                std::to_string(target_m.cols())};
  }
  if (!source_m.allFinite() || !target_m.allFinite()) {
    return {StatusCode::kInvalidInput, "a coordinate is not finite"};
  }
  if (source_m.cols() < 3) {
    return {StatusCode::kUnobservable,
            "a rigid motion needs 3 points, there are " + std::to_string(source_m.cols())};
  }
  return Status::Ok();
}

/// The orthogonal matrices that maximise the trace of R H', H = sum of target * source': the best
/// rotation, and the best reflection.
struct NearestTurns {
  Eigen::Matrix3d rotation, reflection;
};

NearestTurns FindNearestTurns(const Eigen::Matrix3d& H_m2) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H_m2, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant();
  const Eigen::Vector3d proper(1.0, 1.0, handedness < 0.0 ? -1.0 : 1.0);
  const Eigen::Vector3d improper(1.0, 1.0, -proper.z());
  return {svd.matrixU() * proper.asDiagonal() * svd.matrixV().transpose(),
          svd.matrixU() * improper.asDiagonal() * svd.matrixV().transpose()};
}

double Rms_m(const Eigen::Matrix3Xd& distances_m) {
  return std::sqrt(distances_m.squaredNorm() / static_cast<double>(distances_m.cols()));
}

/// Closed form, one weight per point.
Registration RegisterWeighted(const Points& source_m, const Points& target_m,
                              const Eigen::VectorXd& weight) {
  const CentredPairs pairs = Centre(source_m, target_m, weight);
  for (const auto& [points_m, mean_m] : {std::pair(&pairs.source_m, &pairs.source_mean_m),
                                         std::pair(&pairs.target_m, &pairs.target_mean_m)}) {
    if (const Status status = CheckSpread(*points_m, mean_m->norm()); !status.ok()) {
      return Refusal(status.code(), status.message());
    }
  }
  const Eigen::Matrix3d H_m2 =
      pairs.target_m * pairs.weight.asDiagonal() * pairs.source_m.transpose();
  const NearestTurns turns = FindNearestTurns(H_m2);
  const Eigen::Matrix3d& R = turns.rotation;

  Registration result;
  result.status = Status::Ok();
  result.T_target_source = RigidTransform(R, pairs.target_mean_m - R * pairs.source_mean_m);
  result.rms_m = Rms_m(pairs.target_m - R * pairs.source_m);
  result.mirrored_rms_m = Rms_m(pairs.target_m - turns.reflection * pairs.source_m);
  result.degrees_of_freedom = static_cast<int>(3 * source_m.cols() - 6);
  result.mirrored = result.rms_m > kExact * Rms_m(pairs.target_m) &&
                    result.mirrored_rms_m < kMirroredRatio * result.rms_m;
  return result;
}

/// Normal equations of the whitened distances e = L^-1 (R' (q - T) - p) in (theta, tau).
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double chi_squared = 0.0;
};

NormalEquations Linearise(const Points& source_m, const Points& target_m,
                          const std::vector<Eigen::LLT<Eigen::Matrix3d>>& factors,
                          const RigidTransform& T_target_source) {
  NormalEquations equations;
  const Eigen::Matrix3d R_back = T_target_source.rotation().toRotationMatrix().transpose();
  for (Eigen::Index k = 0; k < source_m.cols(); ++k) {
    const auto& L = factors[At(k)].matrixL();
    const Eigen::Vector3d arm_m = target_m.col(k) - T_target_source.translation_m();
    const Eigen::Vector3d e = L.solve(R_back * arm_m - source_m.col(k));
    Eigen::Matrix<double, 3, 6> J;
    J << R_back * CrossMatrix(arm_m), -R_back;
    L.solveInPlace(J);
    equations.information += J.transpose() * J;
    equations.gradient += J.transpose() * e;
    equations.chi_squared += e.squaredNorm();
  }
  return equations;
}

Status RefineByGaussNewton(const Points& source_m, const Points& target_m,
                           const std::vector<Eigen::LLT<Eigen::Matrix3d>>& factors,
                           Registration* result) {
  constexpr int kMaxSteps = 100;
  constexpr double kSmallest = 1e-13;  // rad, and m
  constexpr double kRounding = 1e-9;   // below it a change that does not fall is rounding
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMaxSteps; ++step) {
    const NormalEquations equations =
        Linearise(source_m, target_m, factors, result->T_target_source);
    result->chi_squared = equations.chi_squared;
    const Eigen::LDLT<Matrix6d> factor(equations.information);
    result->covariance = factor.solve(Matrix6d::Identity());
    const Vector6d change = -factor.solve(equations.gradient);
    if (!change.allFinite()) break;
    result->T_target_source =
        Perturbed(result->T_target_source, change.head<3>(), change.tail<3>());
    const double size = change.cwiseAbs().maxCoeff();
    if (size < kSmallest || (size < kRounding && size > 0.5 * last)) return Status::Ok();
    last = size;
  }
  return {StatusCode::kNotConverged, "no motion with the least Mahalanobis distances was found"};
}

/// A turn that the errors of the points leave open, and points the wrong way round, are no result.
void RefuseWhatIsNotKnown(Registration* result) {
  const Eigen::Matrix3d turn_rad2 = result->covariance.topLeftCorner<3, 3>();
  const double worst_rad =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(turn_rad2).eigenvalues().maxCoeff());
  if (result->mirrored) {
    result->status = Status(StatusCode::kInvalidInput,
                            "the points are mirrored: a reflection leaves " +
                                Short(1e3 * result->mirrored_rms_m) + " mm RMS, a rigid motion " +
                                Short(1e3 * result->rms_m) + " mm");
  } else if (!(worst_rad <= kOpenTurn_rad)) {
    result->status = Status(StatusCode::kUnobservable,
                            "the points are too near to one line for their errors: a turn is known "
                            "to " +
                                Short(worst_rad) + " rad only");
  }
  if (!result->status.ok()) result->T_target_source = RigidTransform();
}

}  // namespace

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d V;
  V << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return V;
}

RigidTransform Perturbed(const RigidTransform& T_target_source, const Eigen::Vector3d& theta_rad,
                         const Eigen::Vector3d& tau_m) {
  const double angle_rad = theta_rad.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle_rad > 0.0) turn = Eigen::AngleAxisd(angle_rad, theta_rad / angle_rad);
  return {turn * T_target_source.rotation(), T_target_source.translation_m() + tau_m};
}

Registration RegisterRigid(const Points& source_m, const Points& target_m) {
  if (const Status status = CheckPairs(source_m, target_m); !status.ok()) {
    return Refusal(status.code(), status.message());
  }
  const Eigen::Index count = source_m.cols();
  Registration result = RegisterWeighted(source_m, target_m, Eigen::VectorXd::Ones(count));
  if (!result.status.ok()) return result;
  const std::vector<Eigen::LLT<Eigen::Matrix3d>> unit(
      static_cast<size_t>(count), Eigen::LLT<Eigen::Matrix3d>(Eigen::Matrix3d::Identity()));
  const NormalEquations equations = Linearise(source_m, target_m, unit, result.T_target_source);
  result.covariance = Eigen::LDLT<Matrix6d>(equations.information).solve(Matrix6d::Identity()) *
                      (equations.chi_squared / result.degrees_of_freedom);
  RefuseWhatIsNotKnown(&result);
  return result;
}

Registration RegisterRigid(const Points& source_m, const Points& target_m,
                           const std::vector<Eigen::Matrix3d>& source_covariance_m2) {
  if (const Status status = CheckPairs(source_m, target_m); !status.ok()) {
    return Refusal(status.code(), status.message());
  }
  const auto count = static_cast<size_t>(source_m.cols());
  if (source_covariance_m2.size() != count) {
    return Refusal(StatusCode::kInvalidInput, std::to_string(source_covariance_m2.size()) +
                                                  " covariances for " + std::to_string(count) +
                                                  " points");
  }
  std::vector<Eigen::LLT<Eigen::Matrix3d>> factors;
  Eigen::VectorXd weight(source_m.cols());
  for (size_t k = 0; k < count; ++k) {
    const Eigen::Matrix3d& covariance_m2 = source_covariance_m2[k];
    factors.emplace_back(covariance_m2);
    if (!covariance_m2.allFinite() || factors.back().info() != Eigen::Success) {
      return Refusal(StatusCode::kInvalidInput,
                     "covariance of point " + std::to_string(k) + " is not positive definite");
    }
    weight(ToIndex(k)) = 3.0 / covariance_m2.trace();
  }
  Registration result = RegisterWeighted(source_m, target_m, weight);
  if (!result.status.ok()) return result;
  result.status = RefineByGaussNewton(source_m, target_m, factors, &result);
  // Noise alone can look like a reflection where the points are nearly in a plane.
  const double dof = result.degrees_of_freedom;
  if (result.chi_squared < dof + 6.0 * std::sqrt(2.0 * dof)) result.mirrored = false;
  result.rms_m = Rms_m(target_m - result.T_target_source.Apply(source_m));
  if (result.status.ok() || result.mirrored) RefuseWhatIsNotKnown(&result);
  return result;
}

Registration RegisterRigid(const Points& source_m, const Points& target_m,
                           const Eigen::Ref<const Eigen::VectorXd>& source_sigma_m) {
  std::vector<Eigen::Matrix3d> covariance_m2;
  for (const double sigma_m : source_sigma_m) {
    covariance_m2.emplace_back(sigma_m * sigma_m * Eigen::Matrix3d::Identity());
  }
  return RegisterRigid(source_m, target_m, covariance_m2);
}

}  // namespace palpate::geometry
