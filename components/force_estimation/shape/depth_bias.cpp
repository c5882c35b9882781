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
      correlation_(tuning.prior_correlation) {
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
  known_ = is_calibrated_ = true;
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

void DepthBias::Learn(std::span<const correspondence::FeatureMatch> matches,
                      const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_robot_camera,
                      std::uint32_t sequence) {
  PALPATE_CHECK(static_cast<int>(matches.size()) == feature_count_, matches.size());
  const auto matched = [](const auto& match) {
    return match.state == correspondence::MatchState::kMatched;
  };
  if (std::none_of(matches.begin(), matches.end(), matched)) return;
  if (++frames_ == 1) first_x_m_ = x_m;
  if (frames_ == 1 || sequence != last_sequence_) sequences_.emplace_back(matches.size());
  last_sequence_ = sequence;
  for (std::size_t feature = 0; feature < matches.size(); ++feature) {
    const correspondence::FeatureMatch& match = matches[feature];
    if (!matched(match)) continue;
    const double residual_m = PriorResidual_m(match, x_m, T_robot_camera);
    PALPATE_CHECK(match.sigma_m > 0.0 && std::isfinite(residual_m), match.sigma_m);
    const double weight = 1.0 / (match.sigma_m * match.sigma_m);
    Series& series = sequences_.back()[feature];
    if (series.count == 0) series.weighted_basis.setZero(shared_count_);
    AddToSeries(residual_m / match.sigma_m, frames_, &series);
    series.weight += weight;
    series.weighted_residual += weight * residual_m;
    series.weighted_motion += weight * (match.row.Value(x_m) - match.row.Value(first_x_m_));
    series.weighted_basis += weight * ScaledBasis(match, T_robot_camera);
  }
}

void DepthBias::SetShared(const Eigen::VectorXd& shared) {
  PALPATE_CHECK(!known_ && shared.size() == shared_count_, known_, shared.size());
  shared_is_given_ = true;
  solution_.setZero();
  solution_.head(shared_count_) = shared;
}

void DepthBias::AddToSeries(double residual_over_sigma, int frame, Series* series) {
  if (series->count > 0 && series->last_frame == frame - 1) {
    ++series->neighbours;
    series->sum_products += residual_over_sigma * series->last;
  }
  ++series->count;
  series->sum += residual_over_sigma;
  series->sum_squares += residual_over_sigma * residual_over_sigma;
  series->last_frame = frame;
  series->last = residual_over_sigma;
}

/// Scatter and correlation about each surface point's own mean in each sequence.
void DepthBias::LearnNoise() {
  double squares = 0.0;
  double products = 0.0;
  double pairs_per_value = 0.0;
  int values = 0;
  for (const Sequence& sequence : sequences_) {
    for (const Series& series : sequence) {
      if (series.count < 2) continue;
      const double mean = series.sum / series.count;
      squares += series.sum_squares - series.count * mean * mean;
      products += series.sum_products - series.neighbours * mean * mean;
      pairs_per_value += series.neighbours;
      values += series.count;
    }
  }
  if (values > 0) pairs_per_value /= values;
  correlation_ =
      std::clamp((products + tuning_.prior_residuals * tuning_.prior_correlation) /
                     (std::max(pairs_per_value, 1e-3) * squares + tuning_.prior_residuals),
                 0.0, 0.9);
  double freedom = 0.0;
  for (const Sequence& sequence : sequences_) {
    for (const Series& series : sequence) {
      if (series.count >= 2) freedom += series.count - MeanInflation(series.count, correlation_);
    }
  }
  noise_scale_ =
      std::sqrt((squares + tuning_.prior_residuals) / (freedom + tuning_.prior_residuals));
}

/// Of the mean of a sequence.
double DepthBias::VarianceOf_m2(const Series& series, double posture_m) const {
  const double model_m = config_.model_relative_sigma * series.weighted_motion / series.weight;
  return noise_scale_ * noise_scale_ * MeanInflation(series.count, correlation_) / series.weight +
         posture_m * posture_m + model_m * model_m;
}

Status DepthBias::Finish() {
  std::vector<bool> is_seen(static_cast<std::size_t>(feature_count_));
  for (const Sequence& sequence : sequences_) {
    for (std::size_t f = 0; f < sequence.size(); ++f) {
      is_seen[f] = is_seen[f] || sequence[f].count > 0;
    }
  }
  const auto seen = std::count(is_seen.begin(), is_seen.end(), true);
  if (seen < tuning_.fewest_features && !known_) {
    return {StatusCode::kNoCalibration, "depth bias: only " + std::to_string(seen) +
                                            " features seen in " + std::to_string(frames_) +
                                            " frames without contact"};
  }
  LearnNoise();
  posture_m_ = PostureError_m();
  Equations equations = EquationsOf(posture_m_);
  if (is_calibrated_ && frames_ > 0) {
    // Covariance intersection (Julier and Uhlmann, Proc. ACC (1997) 2369): half of the prior's
    // information and half of the frames'. The offsets' own prior has nothing in common with both.
    equations.information *= 0.5;
    equations.information.diagonal().tail(feature_count_).array() += 0.5;
    equations.right_side *= 0.5;
  }
  const linalg::Cholesky factor(equations.information);
  covariance_ = factor.Inverse();
  solution_ = factor.Solve(equations.right_side);
  known_ = true;
  shared_is_given_ = false;
  return Status::Ok();
}

/// One sequence does not tell it from the offsets.
double DepthBias::PostureError_m() const {
  if (sequences_.size() < 2) return 0.0;
  const double prior_m = tuning_.posture_share * config_.feature_offset_prior_m;
  std::vector<double> squares_m2, logs;
  for (int k = 0; k <= tuning_.posture_errors; ++k) {
    const double sigmas = 4.0 * k / tuning_.posture_errors;
    const double posture_m = sigmas * prior_m;
    squares_m2.push_back(posture_m * posture_m);
    logs.push_back(LogLikelihood(EquationsOf(posture_m)) - 0.5 * sigmas * sigmas);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0, sum_m2 = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const double weight = std::exp(logs[k] - most);
    sum += weight;
    sum_m2 += weight * squares_m2[k];
  }
  return std::sqrt(sum_m2 / sum);
}

/// Marginal, but for a constant.
double DepthBias::LogLikelihood(const Equations& equations) {
  const linalg::Cholesky factor(equations.information);
  return 0.5 * (equations.rows + equations.right_side.dot(factor.Solve(equations.right_side)) -
                factor.LnDeterminant());
}

/// Parameters: the shared ones, then the offset of each surface point, all of prior sigma 1.
DepthBias::Equations DepthBias::EquationsOf(double posture_m) const {
  const Eigen::Index parameters = shared_count_ + feature_count_;
  const double own_m = config_.feature_offset_prior_m;
  Equations equations{.information = Eigen::MatrixXd::Identity(parameters, parameters),
                      .right_side = Eigen::VectorXd::Zero(parameters)};
  for (const Sequence& sequence : sequences_) {
    for (std::size_t f = 0; f < sequence.size(); ++f) {
      const Series& series = sequence[f];
      if (series.count == 0) continue;
      const double worth = 1.0 / VarianceOf_m2(series, posture_m);
      const Eigen::VectorXd shared = series.weighted_basis / series.weight;
      const double residual_m = series.weighted_residual / series.weight;
      const Eigen::Index at = shared_count_ + ToIndex(f);
      Eigen::MatrixXd& information = equations.information;
      information.topLeftCorner(shared_count_, shared_count_) +=
          worth * shared * shared.transpose();
      information.col(at).head(shared_count_) += worth * own_m * shared;
      information.row(at).head(shared_count_) += worth * own_m * shared.transpose();
      information(at, at) += worth * own_m * own_m;
      equations.right_side.head(shared_count_) += worth * residual_m * shared;
      equations.right_side[at] += worth * residual_m * own_m;
      equations.rows += std::log(worth) - worth * residual_m * residual_m;
    }
  }
  return equations;
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
  return std::sqrt(std::max(variance_m2, 0.0) + posture_m_ * posture_m_);
}

}  // namespace palpate::force_estimation
