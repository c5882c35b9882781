// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/bias_frame_check.hpp"

#include <algorithm>
#include <cmath>

#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

void BiasFrameCheck::Add(const DepthBias& bias, std::uint32_t epoch,
                         std::span<const correspondence::FeatureMatch> matches,
                         const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_robot_camera) {
  Sequence& sequence = sequences_[epoch];
  bool is_matched = false;
  for (std::size_t f = 0; f < matches.size(); ++f) {
    const correspondence::FeatureMatch& match = matches[f];
    if (match.state != correspondence::MatchState::kMatched) continue;
    is_matched = true;
    Point& point = sequence.points[static_cast<int>(f)];
    const Eigen::VectorXd basis = bias.ScaledBasis(match, T_robot_camera);
    if (point.count == 0) point.basis.setZero(basis.size());
    ++point.count;
    point.residual_m += bias.PriorResidual_m(match, x_m, T_robot_camera);
    point.variance_m2 += match.sigma_m * match.sigma_m;
    point.basis += basis;
    point.position_m += match.position_m;
  }
  sequence.frames += is_matched ? 1 : 0;
}

/// Of a mean: depth noise that is correlated in time, what the posture changes in the point's
/// offset, and the model's error, a share of the motion since the other sequences.
double BiasFrameCheck::VarianceOf_m2(const Point& point, double moved_m) const {
  const double posture_m = tuning_.posture_share * config_.feature_offset_prior_m;
  const double model_m = config_.model_relative_sigma * moved_m;
  const double count = point.count;
  return kTemporalCorrelation * point.variance_m2 / (count * count) + posture_m * posture_m +
         model_m * model_m;
}

/// Parameters: the shared ones, then the offset of each surface point, all of prior sigma 1.
BiasFrameCheck::Misfit BiasFrameCheck::MisfitOf(std::uint32_t epoch,
                                                const std::vector<std::uint32_t>& others) const {
  const Sequence& sequence = sequences_.at(epoch);
  if (sequence.points.empty()) return {};
  const Eigen::Index shared = sequence.points.begin()->second.basis.size();
  Eigen::Index features = sequence.points.rbegin()->first + 1;
  for (const std::uint32_t other : others) {
    const auto& points = sequences_.at(other).points;
    if (!points.empty()) features = std::max<Eigen::Index>(features, points.rbegin()->first + 1);
  }
  const Eigen::Index parameters = shared + features;
  const double own_m = config_.feature_offset_prior_m;
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(parameters, parameters);
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(parameters);
  const auto row_of = [&](int feature, const Point& point) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(parameters);
    row.head(shared) = point.basis / point.count;
    row[shared + feature] = own_m;
    return row;
  };
  const auto moved_m = [&](int feature, const Point& point) {
    double least_m = 0.0;
    bool is_first = true;
    for (const std::uint32_t other : others) {
      const auto& points = sequences_.at(other).points;
      const auto there = points.find(feature);
      if (there == points.end()) continue;
      const double off_m =
          (point.position_m / point.count - there->second.position_m / there->second.count).norm();
      least_m = is_first ? off_m : std::min(least_m, off_m);
      is_first = false;
    }
    return least_m;
  };
  for (const std::uint32_t other : others) {
    for (const auto& [feature, point] : sequences_.at(other).points) {
      const Eigen::VectorXd row = row_of(feature, point);
      const double variance_m2 = VarianceOf_m2(point, 0.0);
      information += row * row.transpose() / variance_m2;
      right_side += row * (point.residual_m / point.count / variance_m2);
    }
  }
  const linalg::Cholesky factor(information);
  const Eigen::VectorXd mean = factor.Solve(right_side);
  const auto count = ToIndex(sequence.points.size());
  Eigen::MatrixXd rows(count, parameters);
  Eigen::VectorXd difference_m(count), variance_m2(count);
  Eigen::Index r = 0;
  for (const auto& [feature, point] : sequence.points) {
    rows.row(r) = row_of(feature, point).transpose();
    difference_m[r] = point.residual_m / point.count - rows.row(r).dot(mean);
    variance_m2[r] = VarianceOf_m2(point, moved_m(feature, point));
    ++r;
  }
  Eigen::MatrixXd covariance_m2 = rows * factor.Solve(Eigen::MatrixXd(rows.transpose()));
  covariance_m2.diagonal() += variance_m2;
  const linalg::Cholesky spread(covariance_m2);
  return {.value = difference_m.dot(spread.Solve(difference_m)) / static_cast<double>(count),
          .difference_m = difference_m.norm() / std::sqrt(static_cast<double>(count))};
}

std::vector<BiasSequence> BiasFrameCheck::Judge() const {
  std::vector<std::uint32_t> trusted;
  std::map<std::uint32_t, BiasSequence> verdicts;
  for (const auto& [epoch, sequence] : sequences_) {
    verdicts[epoch] = {.epoch = epoch, .frames = sequence.frames};
    if (sequence.frames > 0) trusted.push_back(epoch);
  }
  const auto others_of = [&](std::uint32_t epoch) {
    std::vector<std::uint32_t> others = trusted;
    std::erase(others, epoch);
    return others;
  };
  for (bool agree = false; !agree && !trusted.empty();) {
    std::uint32_t worst = trusted.front();
    for (const std::uint32_t epoch : trusted) {
      const Misfit misfit = MisfitOf(epoch, others_of(epoch));
      verdicts[epoch].misfit = misfit.value;
      verdicts[epoch].difference_m = misfit.difference_m;
      if (misfit.value > verdicts[worst].misfit) worst = epoch;
    }
    agree = verdicts[worst].misfit <= tuning_.largest_misfit;
    if (agree) break;
    if (trusted.size() == 2 && MisfitOf(trusted[0], {}).value > MisfitOf(trusted[1], {}).value) {
      worst = trusted[0];
    } else if (trusted.size() == 2) {
      worst = trusted[1];
    }
    std::erase(trusted, worst);
  }
  std::vector<BiasSequence> sequences;
  for (auto& [epoch, verdict] : verdicts) {
    verdict.contact_free = std::find(trusted.begin(), trusted.end(), epoch) != trusted.end();
    sequences.push_back(verdict);
  }
  return sequences;
}

}  // namespace palpate::force_estimation
