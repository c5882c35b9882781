// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/marker_means.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "components/calibration/pose/assignment_hypotheses.hpp"

namespace palpate::calibration {

namespace {

/// The sightings of each mean.
using Groups = std::map<int, std::vector<const MarkerSighting*>>;

Groups GroupByName(const std::vector<SeenMarkers>& messages) {
  Groups groups;
  for (const SeenMarkers& message : messages) {
    for (const MarkerSighting& one : message.markers) {
      if (one.marker >= 0) groups[one.marker].push_back(&one);
    }
  }
  return groups;
}

Groups GroupByPlace(const std::vector<SeenMarkers>& messages) {
  Groups groups;
  const auto fullest = std::max_element(
      messages.begin(), messages.end(),
      [](const auto& a, const auto& b) { return a.markers.size() < b.markers.size(); });
  if (fullest == messages.end()) return groups;
  const Eigen::Matrix3Xd places_m = PositionsOf(fullest->markers);
  for (const SeenMarkers& message : messages) {
    const std::vector<int> of_point =
        MatchNearest(PositionsOf(message.markers), places_m, kStillMarker_m);
    for (std::size_t p = 0; p < of_point.size(); ++p) {
      if (of_point[p] >= 0) groups[of_point[p]].push_back(&message.markers[p]);
    }
  }
  return groups;
}

/// Covariance of one message: the larger of stated and observed variance along the common principal
/// directions of both, so that it does not depend on the frame.
Eigen::Matrix3d LargerOf(const Eigen::Matrix3d& said_m2, const Eigen::Matrix3d& varies_m2) {
  const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(said_m2).matrixL();
  const Eigen::Matrix3d half =
      root.triangularView<Eigen::Lower>().solve(varies_m2).transpose().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> ratio(
      root.triangularView<Eigen::Lower>().solve(half).eval());
  const Eigen::Matrix3d directions = root * ratio.eigenvectors();
  return directions * ratio.eigenvalues().cwiseMax(1.0).asDiagonal() * directions.transpose();
}

MarkerSighting MeanOf(const std::vector<const MarkerSighting*>& seen, double bias_m) {
  const auto count = static_cast<double>(seen.size());
  MarkerSighting mean{.marker = seen.front()->marker};
  for (const MarkerSighting* one : seen) {
    mean.position_m += one->position_m / count;
    mean.covariance_m2 += one->covariance_m2 / count;
  }
  Eigen::Matrix3d squares_m2 = Eigen::Matrix3d::Zero();
  for (const MarkerSighting* one : seen) {
    const Eigen::Vector3d off_m = one->position_m - mean.position_m;
    squares_m2 += off_m * off_m.transpose();
  }
  if (seen.size() > 2) {
    mean.covariance_m2 = LargerOf(mean.covariance_m2, squares_m2 / (count - 1.0));
  }
  mean.covariance_m2 /= count;
  mean.covariance_m2.diagonal().array() += bias_m * bias_m;
  return mean;
}

}  // namespace

bool HaveNames(const std::vector<MarkerSighting>& markers) {
  return std::any_of(markers.begin(), markers.end(),
                     [](const MarkerSighting& one) { return one.marker >= 0; });
}

std::vector<MarkerSighting> MeanMarkers(const std::vector<SeenMarkers>& messages, double bias_m) {
  const bool named = std::any_of(messages.begin(), messages.end(),
                                 [](const auto& message) { return HaveNames(message.markers); });
  std::vector<MarkerSighting> means;
  for (const auto& [mean, seen] : named ? GroupByName(messages) : GroupByPlace(messages)) {
    means.push_back(MeanOf(seen, bias_m));
  }
  return means;
}

}  // namespace palpate::calibration
