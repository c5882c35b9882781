// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_targets.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

bool IsNearContact(const Eigen::Vector3d& position_m, const Eigen::VectorXd& x_m,
                   const std::vector<ShapeSite>& sites, double reach_m) {
  return std::any_of(sites.begin(), sites.end(), [&](const ShapeSite& site) {
    return (site.patch.weights.Position(x_m) - position_m).norm() < site.radius_m + reach_m;
  });
}

}  // namespace

ShapeTargets::ShapeTargets(const ShapeConfig& config, double contact_weight,
                           const ShapeTargetsTuning& tuning)
    : config_(config), tuning_(tuning), contact_weight_(contact_weight) {}

void ShapeTargets::Build(const std::vector<correspondence::FeatureMatch>& matches,
                         const std::vector<TextureMatch>& texture, const CameraBiases& bias,
                         const CameraPoses& poses, const Eigen::VectorXd& x_m,
                         const Eigen::VectorXd& bias_x_m, const std::vector<ShapeSite>& sites) {
  rows_.clear();
  features_.clear();
  matched_.clear();
  AddMatches(matches);
  AddTexture(texture, matches.size());
  const auto count = ToIndex(rows_.size());
  targets_.rows = static_cast<int>(count);
  targets_.value_m.resize(count);
  targets_.weight.resize(count);
  sigma_m_.resize(count);
  noise_m_.resize(count);
  for (Eigen::Index r = 0; r < along_normals_; ++r) {
    const correspondence::FeatureMatch& match = matches[matched_[At(r)]];
    targets_.value_m[r] = match.target_m - bias.Correction_m(match, poses);
    noise_m_[r] = bias.NoiseScale(match.camera) * match.sigma_m;
    const double moved_m = match.row.Value(x_m) - match.row.Value(bias_x_m);
    const Eigen::Vector3d position_m = poses[At(match.camera)] * match.position_m;
    Weigh(r,
          std::hypot(bias.CorrectionSigma_m(match, poses), config_.model_relative_sigma * moved_m),
          IsNearContact(position_m, x_m, sites, tuning_.feature_reach_m));
  }
  const double relative = std::hypot(config_.model_relative_sigma, config_.pose_prior_rad);
  for (Eigen::Index r = along_normals_; r < count; ++r) {
    const TextureMatch& match = texture[At((r - along_normals_) / 2)];
    targets_.value_m[r] = match.target_m[(r - along_normals_) % 2];
    noise_m_[r] = match.sigma_m;
    const Eigen::Vector3d position_m = match.place.Position(x_m);
    Weigh(r, relative * (position_m - match.place.Position(bias_x_m)).norm(),
          IsNearContact(position_m, x_m, sites, tuning_.feature_reach_m));
  }
  full_weight_ = targets_.weight;
}

void ShapeTargets::AddMatches(const std::vector<correspondence::FeatureMatch>& matches) {
  for (std::size_t m = 0; m < matches.size(); ++m) {
    if (matches[m].state != correspondence::MatchState::kMatched) continue;
    rows_.push_back(matches[m].row);
    features_.push_back(matches[m].feature);
    matched_.push_back(m);
  }
  along_normals_ = static_cast<int>(rows_.size());
}

/// `match_count`: of all features and cameras.
void ShapeTargets::AddTexture(const std::vector<TextureMatch>& texture, std::size_t match_count) {
  most_rows_ = 3 * match_count;
  for (const TextureMatch& match : texture) {
    for (std::size_t i = 0; i < 2; ++i) {
      rows_.push_back(match.rows[i]);
      features_.push_back(match.feature);
      matched_.push_back(match_count + 2 * match.number + i);
    }
  }
}

/// `constant_m`: sigma of what does not change from frame to frame.
void ShapeTargets::Weigh(Eigen::Index row, double constant_m, bool is_near) {
  sigma_m_[row] = std::hypot(noise_m_[row], constant_m);
  const double share = is_near ? contact_weight_ : 1.0;
  targets_.weight[row] = share / (sigma_m_[row] * sigma_m_[row]);
}

void ShapeTargets::WeighAt(const Eigen::VectorXd& x_m) {
  Eigen::VectorXd residual_m(targets_.value_m.size());
  for (Eigen::Index r = 0; r < residual_m.size(); ++r) {
    residual_m[r] = targets_.value_m[r] - rows_[At(r)].Value(x_m);
  }
  if (residual_m.cwiseQuotient(sigma_m_).squaredNorm() < tuning_.near_chi_squared * targets_.rows) {
    Reweight(residual_m);
  }
}

bool ShapeTargets::Reweight(const Eigen::VectorXd& residual_m) {
  bool changed = false;
  for (Eigen::Index r = 0; r < residual_m.size(); ++r) {
    const double off = std::abs(residual_m[r]) / sigma_m_[r];
    const double share = HuberWeight(off, config_.robust_threshold);
    const double weight = share * full_weight_[r];
    changed =
        changed || std::abs(weight - targets_.weight[r]) > tuning_.changed_weight * full_weight_[r];
    targets_.weight[r] = weight;
  }
  return changed;
}

}  // namespace palpate::force_estimation
