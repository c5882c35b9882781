// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/experiment/estimated_forces.hpp"

#include <algorithm>
#include <cmath>

#include "libs/experiment/force_table.hpp"

namespace palpate::view {

namespace {

const double kUnknown = std::nan("");

ShownForce ForceOf(const experiment::TabledForce& row) {
  return {.name = row.contact,
          .position_m = row.position_m.value_or(Eigen::Vector3d::Constant(kUnknown)),
          .force_N = row.force_N,
          .covariance_N2 = row.covariance_N2.value_or(Eigen::Matrix3d::Constant(kUnknown)),
          .ci95_N = row.ci95_N.value_or(0.0),
          .location_ci95_m = row.location_ci95_m.value_or(0.0),
          .location_covariance_m2 =
              row.location_covariance_m2.value_or(Eigen::Matrix3d::Constant(kUnknown)),
          .status = row.status};
}

}  // namespace

EstimatedForces EstimatedForces::Read(const std::filesystem::path& file) {
  EstimatedForces forces;
  for (const experiment::TabledForce& row : experiment::ReadForceTable(file).rows) {
    auto& frames = forces.frames_[row.recording];
    if (frames.empty() || row.t_s > frames.back().t_s) {
      frames.push_back({.t_s = row.t_s, .forces = {}});
    }
    if (row.contact.empty()) {
      frames.back().status = row.status;
    } else {
      frames.back().forces.push_back(ForceOf(row));
    }
  }
  return forces;
}

const EstimatedFrame* EstimatedForces::At(const std::string& recording, double t_s) const {
  const auto frames = frames_.find(recording);
  if (frames == frames_.end()) return nullptr;
  const auto next =
      std::upper_bound(frames->second.begin(), frames->second.end(), t_s,
                       [](double t, const EstimatedFrame& frame) { return t < frame.t_s; });
  return next == frames->second.begin() ? nullptr : &*std::prev(next);
}

}  // namespace palpate::view
