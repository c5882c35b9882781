// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/depth_bias.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::force_estimation {

namespace {

constexpr int kPoseParameters = 6;

/// L with L L' = `covariance`, which may be singular.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd over_sigma =
      (sigma.array() > 0.0).select(sigma.cwiseInverse(), Eigen::VectorXd::Ones(sigma.size()));
  const Eigen::MatrixXd scaled = over_sigma.asDiagonal() * covariance * over_sigma.asDiagonal();
  const linalg::SymmetricEigen eigen = linalg::DecomposeSymmetric(scaled);
  return sigma.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// Variance of the mean of `count` values over that of a mean of independent ones: 1 + 2 sum_k
/// (1 - k / count) correlation^k.
double MeanInflation(int count, double correlation) {
  double inflation = 1.0;
  double power = 1.0;
  for (int k = 1; k < count && power > 1e-12; ++k) {
    power *= correlation;
    inflation += 2.0 * (1.0 - static_cast<double>(k) / count) * power;
  }
  return inflation;
}

}  // namespace

DepthBias::DepthBias(int feature_count, const ShapeConfig& config, const DepthBiasTuning& tuning)
    : feature_count_(feature_count),
      config_(config),
      tuning_(tuning),
      correlation_(tuning.prior_correlation),
      series_(static_cast<size_t>(feature_count)) {
  basis_.order = config.depth_bias_order;
  SetPrior();
}

/// The prior of the settings.
void DepthBias::SetPrior() {
  shared_count_ = kPoseParameters + geometry::CountOf(basis_);
  prior_mean_.setZero(shared_count_);
  Eigen::VectorXd sigma(shared_count_);
  sigma.head<3>().setConstant(config_.pose_prior_m);
  sigma.segment<3>(3).setConstant(config_.pose_prior_rad);
  sigma.tail(shared_count_ - kPoseParameters).setConstant(config_.depth_bias_prior);
  prior_root_ = sigma.asDiagonal();
  Reset();
}

void DepthBias::Reset() {
  const Eigen::Index parameters = shared_count_ + feature_count_;
  information_.setZero(parameters, parameters);
  right_side_.setZero(parameters);
  solution_.setZero(parameters);
  covariance_.setIdentity(parameters, parameters);
}

/// Errors of the calibration are estimate - truth. Targets are computed with the estimated pose, so
/// that its error shifts them; the true map is the estimated one less its error.
void DepthBias::StartFrom(const geometry::DepthBiasMap& map,
                          const Eigen::Isometry3d& T_robot_camera) {
  PALPATE_CHECK(frames_ == 0, frames_);
  basis_ = map.basis;
  const int count = geometry::CountOf(basis_);
  shared_count_ = kPoseParameters + count;
  PALPATE_CHECK(map.coefficients.size() == count, map.coefficients.size());
  PALPATE_CHECK(map.covariance.rows() == shared_count_, map.covariance.rows());
  Eigen::MatrixXd per_error = Eigen::MatrixXd::Zero(shared_count_, shared_count_);
  const Eigen::Matrix3d R_camera_robot = T_robot_camera.linear().transpose();
  per_error.block<3, 3>(0, 3) = R_camera_robot;
  per_error.block<3, 3>(3, 0) = R_camera_robot;
  per_error.bottomRightCorner(count, count) = -Eigen::MatrixXd::Identity(count, count);
  prior_mean_.setZero(shared_count_);
  prior_mean_.tail(count) = map.coefficients;
  prior_root_ = RootOf(per_error * map.covariance * per_error.transpose());
  Reset();
  known_ = true;
}

Eigen::VectorXd DepthBias::SharedBasis(const correspondence::FeatureMatch& match,
                                       const Eigen::Isometry3d& T_robot_camera) const {
  const Eigen::Vector3d normal = T_robot_camera.linear().transpose() * match.normal;
  const Eigen::Vector3d& position_m = match.position_m;
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(shared_count_);
  if (!(position_m.z() > 0.0)) return basis;
  basis.head<3>() = normal;
  basis.segment<3>(3) = position_m.cross(normal);
  // The measured point is short of the true one by b p.
  basis.tail(shared_count_ - kPoseParameters) =
      -normal.dot(position_m) * geometry::ValuesAt(basis_, position_m);
  return basis;
}

Eigen::VectorXd DepthBias::ScaledBasis(const correspondence::FeatureMatch& match,
                                       const Eigen::Isometry3d& T_robot_camera) const {
  return prior_root_.transpose() * SharedBasis(match, T_robot_camera);
}

double DepthBias::PriorResidual_m(const correspondence::FeatureMatch& match,
                                  const Eigen::VectorXd& x_m,
                                  const Eigen::Isometry3d& T_robot_camera) const {
  return match.target_m - match.row.Value(x_m) -
         SharedBasis(match, T_robot_camera).dot(prior_mean_);
}

void DepthBias::Learn(const std::vector<correspondence::FeatureMatch>& matches,
                      const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_robot_camera) {
  PALPATE_CHECK(static_cast<int>(matches.size()) == feature_count_, matches.size());
  const auto matched = [](const auto& match) {
    return match.state == correspondence::MatchState::kMatched;
  };
  if (std::none_of(matches.begin(), matches.end(), matched)) return;
  ++frames_;
  for (int feature = 0; feature < feature_count_; ++feature) {
    const correspondence::FeatureMatch& match = matches[At(feature)];
    if (!matched(match)) continue;
    const Eigen::VectorXd basis = SharedBasis(match, T_robot_camera);
    const double residual_over_sigma =
        (match.target_m - match.row.Value(x_m) - basis.dot(prior_mean_)) / match.sigma_m;
    PALPATE_CHECK(match.sigma_m > 0.0 && std::isfinite(residual_over_sigma), match.sigma_m);
    const Eigen::VectorXd shared = prior_root_.transpose() * basis / match.sigma_m;
    const double own = config_.feature_offset_prior_m / match.sigma_m;
    const Eigen::Index at = shared_count_ + feature;
    information_.topLeftCorner(shared_count_, shared_count_) += shared * shared.transpose();
    information_.col(at).head(shared_count_) += own * shared;
    information_.row(at).head(shared_count_) += own * shared.transpose();
    information_(at, at) += own * own;
    right_side_.head(shared_count_) += residual_over_sigma * shared;
    right_side_[at] += residual_over_sigma * own;
    AddToSeries(feature, residual_over_sigma);
  }
}

void DepthBias::SetShared(const Eigen::VectorXd& shared) {
  PALPATE_CHECK(!known_ && shared.size() == shared_count_, known_, shared.size());
  shared_is_given_ = true;
  solution_.setZero();
  solution_.head(shared_count_) = shared;
}

void DepthBias::AddToSeries(int feature, double residual_over_sigma) {
  Series& series = series_[At(feature)];
  if (series.count > 0 && series.last_frame == frames_ - 1) {
    ++series.neighbours;
    series.sum_products += residual_over_sigma * series.last;
  }
  ++series.count;
  series.sum += residual_over_sigma;
  series.sum_squares += residual_over_sigma * residual_over_sigma;
  series.last_frame = frames_;
  series.last = residual_over_sigma;
}

/// Scatter and correlation about each surface point's own mean.
void DepthBias::LearnNoise() {
  double squares = 0.0;
  double products = 0.0;
  double pairs_per_value = 0.0;
  int values = 0;
  for (const Series& series : series_) {
    if (series.count < 2) continue;
    const double mean = series.sum / series.count;
    squares += series.sum_squares - series.count * mean * mean;
    products += series.sum_products - series.neighbours * mean * mean;
    pairs_per_value += series.neighbours;
    values += series.count;
  }
  if (values > 0) pairs_per_value /= values;
  correlation_ =
      std::clamp((products + tuning_.prior_residuals * tuning_.prior_correlation) /
                     (std::max(pairs_per_value, 1e-3) * squares + tuning_.prior_residuals),
                 0.0, 0.9);
  double freedom = 0.0;
  for (const Series& series : series_) {
    if (series.count >= 2) freedom += series.count - MeanInflation(series.count, correlation_);
  }
  noise_scale_ =
      std::sqrt((squares + tuning_.prior_residuals) / (freedom + tuning_.prior_residuals));
}

Status DepthBias::Finish() {
  const auto seen = std::count_if(series_.begin(), series_.end(),
                                  [](const Series& series) { return series.count > 0; });
  if (seen < tuning_.fewest_features && !known_) {
    return {StatusCode::kNoCalibration, "depth bias: only " + std::to_string(seen) +
                                            " features seen in " + std::to_string(frames_) +
                                            " frames without contact"};
  }
  LearnNoise();
  const double worth = 1.0 / (noise_scale_ * noise_scale_ * MeanInflation(frames_, correlation_));
  const Eigen::Index parameters = information_.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(parameters, parameters);
  const linalg::Cholesky factor(identity + worth * information_);
  covariance_ = factor.Inverse();
  solution_ = factor.Solve(Eigen::VectorXd(worth * right_side_));
  known_ = true;
  shared_is_given_ = false;
  return Status::Ok();
}

double DepthBias::Correction_m(int feature, const correspondence::FeatureMatch& match,
                               const Eigen::Isometry3d& T_robot_camera) const {
  const Eigen::VectorXd basis = SharedBasis(match, T_robot_camera);
  return basis.dot(prior_mean_ + prior_root_ * solution_.head(shared_count_)) +
         config_.feature_offset_prior_m * solution_[shared_count_ + feature];
}

double DepthBias::CorrectionSigma_m(int feature, const correspondence::FeatureMatch& match,
                                    const Eigen::Isometry3d& T_robot_camera) const {
  const double own = config_.feature_offset_prior_m;
  if (shared_is_given_) return own;
  const Eigen::VectorXd shared = ScaledBasis(match, T_robot_camera);
  const Eigen::Index at = shared_count_ + feature;
  const double variance_m2 =
      shared.dot(covariance_.topLeftCorner(shared_count_, shared_count_) * shared) +
      2.0 * own * shared.dot(covariance_.col(at).head(shared_count_)) +
      own * own * covariance_(at, at);
  return std::sqrt(std::max(variance_m2, 0.0));
}

}  // namespace palpate::force_estimation
