// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/surface_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::perception {

void SurfaceFit::Lay(const SampleGrid& grid, const Settings& settings) {
  settings_ = settings;
  Eigen::Array3f low = Eigen::Array3f::Constant(1e9f), high = -low;
  for (const Eigen::Vector3f& site_m : grid.site_m) {
    if (site_m.z() <= 0.0f) continue;
    low = low.min(site_m.array());
    high = high.max(site_m.array());
  }
  unknowns_ = 0;
  counts_.setZero();
  if ((low > high).any()) return;
  origin_m_ = low;
  counts_ = ((high - low) / static_cast<float>(settings.spacing_m)).floor().cast<int>() + 2;
  Number(grid);
}

/// Only nodes of cells with sites in them are unknowns.
void SurfaceFit::Number(const SampleGrid& grid) {
  number_.resize(static_cast<std::size_t>(counts_.prod()));
  std::iota(number_.begin(), number_.end(), 0);
  first_site_m_ = grid.site_m;
  site_shares_.resize(grid.size());
  std::vector<char> used(number_.size(), 0);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.site_m[i].z() <= 0.0f) continue;
    for (const int node : SharesOf(grid.site_m[i]).node) used[palpate::At(node)] = 1;
  }
  for (std::size_t n = 0; n < used.size(); ++n) {
    number_[n] = used[n] != 0 ? unknowns_++ : SampleGrid::kNone;
  }
  displacement_m_ = Eigen::Matrix3Xf::Zero(3, unknowns_);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.site_m[i].z() > 0.0f) site_shares_[i] = SharesOf(grid.site_m[i]);
  }
}

SurfaceFit::Shares SurfaceFit::SharesOf(const Eigen::Vector3f& point_m) const {
  const Eigen::Array3f place =
      ((point_m - origin_m_).array() / static_cast<float>(settings_.spacing_m))
          .max(0.0f)
          .min((counts_ - 1).cast<float>() - 1e-3f);
  const Eigen::Array3i cell = place.cast<int>();
  const Eigen::Array3f part = place - cell.cast<float>();
  Shares shares;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Array3i corner(k & 1, k >> 1 & 1, k >> 2);
    const Eigen::Array3i at = cell + corner;
    const auto index =
        static_cast<std::size_t>((at.z() * counts_.y() + at.y()) * counts_.x() + at.x());
    shares.node[k] = number_[index];
    const Eigen::Array3f along = (corner == 1).select(part, 1.0f - part);
    shares.share[k] = shares.node[k] == SampleGrid::kNone ? 0.0f : along.prod();
  }
  return shares;
}

Eigen::Vector3f SurfaceFit::At(const Eigen::Vector3f& point_m) const {
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
  if (unknowns_ == 0) return sum_m;
  const Shares shares = SharesOf(point_m);
  for (int k = 0; k < 8; ++k) {
    if (shares.node[k] != SampleGrid::kNone) {
      sum_m += shares.share[k] * displacement_m_.col(shares.node[k]);
    }
  }
  const float known = shares.share.sum();
  return known > tuning_.least_known_share ? Eigen::Vector3f(sum_m / known)
                                           : Eigen::Vector3f::Zero();
}

void SurfaceFit::Fit(SampleGrid* grid) {
  if (unknowns_ == 0) return;
  for (const SurfaceFitRound& round : tuning_.rounds) {
    FindNearestSites(grid, 1);
    Improve(*grid, round);
    for (std::size_t i = 0; i < grid->size(); ++i) {
      if (first_site_m_[i].z() <= 0.0f) continue;
      Eigen::Vector3f moved_m = first_site_m_[i];
      for (int k = 0; k < 8; ++k) {
        moved_m += site_shares_[i].share[k] * displacement_m_.col(site_shares_[i].node[k]);
      }
      grid->site_m[i] = moved_m;
    }
  }
}

/// One step of Gauss and Newton on the distances along the normals, with Tukey's weights.
void SurfaceFit::Improve(const SampleGrid& grid, const SurfaceFitRound& round) {
  const float cut_m = round.cut * static_cast<float>(settings_.largest_error_m);
  normal_matrix_ = Eigen::MatrixXf::Zero(3 * unknowns_, 3 * unknowns_);
  right_side_ = Eigen::VectorXf::Zero(3 * unknowns_);
  AddSmoothness(round.difference);
  const auto sigma_m = settings_.point_sigma_m;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.measured_m[i].z() <= 0.0f || grid.nearest[i] == SampleGrid::kNone) continue;
    const auto site = static_cast<std::size_t>(grid.nearest[i]);
    const Eigen::Vector3f off_m = grid.measured_m[i] - grid.site_m[site];
    if (off_m.squaredNorm() >= cut_m * cut_m) continue;
    const Eigen::Vector3f& normal = grid.normal[site];
    const float distance_m = normal.dot(off_m);
    const float inlier = 1.0f - (distance_m / cut_m) * (distance_m / cut_m);
    const float trust = distance_m > sigma_m ? round.trust_before : 1.0f;
    const float weight = trust * inlier * inlier / (sigma_m * sigma_m);
    const Shares& shares = site_shares_[site];
    const float wanted_m = normal.dot(grid.measured_m[i] - first_site_m_[site]);
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3f row = weight * shares.share[a] * normal;
      const int at = 3 * shares.node[a];
      right_side_.segment<3>(at) += wanted_m * row;
      for (int b = 0; b < 8; ++b) {
        if (shares.node[b] > shares.node[a]) continue;  // the lower triangle
        normal_matrix_.block<3, 3>(at, 3 * shares.node[b]) +=
            row * (shares.share[b] * normal).transpose();
      }
    }
  }
  Eigen::VectorXf solution;
  if (!linalg::SolveSpdInPlace(&normal_matrix_, right_side_, &solution)) return;
  if (!solution.allFinite()) return;
  displacement_m_ = Eigen::Map<const Eigen::Matrix3Xf>(solution.data(), 3, unknowns_);
}

void SurfaceFit::AddSmoothness(float difference) {
  const auto largest_m = static_cast<float>(settings_.largest_error_m);
  const float keep = 1.0f / (tuning_.move_sigma * largest_m * tuning_.move_sigma * largest_m);
  const float coupling = 1.0f / (difference * largest_m * difference * largest_m);
  normal_matrix_.diagonal().setConstant(keep);
  const auto number = [this](int x, int y, int z) {
    if (x >= counts_.x() || y >= counts_.y() || z >= counts_.z()) return SampleGrid::kNone;
    return number_[palpate::At((z * counts_.y() + y) * counts_.x() + x)];
  };
  const auto tie = [&](int a, int b) {
    if (a == SampleGrid::kNone || b == SampleGrid::kNone) return;
    for (int k = 0; k < 3; ++k) {
      normal_matrix_(3 * a + k, 3 * a + k) += coupling;
      normal_matrix_(3 * b + k, 3 * b + k) += coupling;
      normal_matrix_(3 * std::max(a, b) + k, 3 * std::min(a, b) + k) -= coupling;
    }
  };
  for (int z = 0; z < counts_.z(); ++z) {
    for (int y = 0; y < counts_.y(); ++y) {
      for (int x = 0; x < counts_.x(); ++x) {
        const int here = number(x, y, z);
        tie(here, number(x + 1, y, z));
        tie(here, number(x, y + 1, z));
        tie(here, number(x, y, z + 1));
      }
    }
  }
}

}  // namespace palpate::perception
