// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/drive_distance.hpp"

#include <algorithm>
#include <utility>

namespace palpate::diagnosis {

namespace {

/// What is not driven counts as at zero.
Eigen::VectorXd Driven(const SamplePart& part) {
  return part.taken_in.array().isNaN().select(0.0, part.taken_in);
}

}  // namespace

DriveDistance::DriveDistance(const ObservedExperiment& observed,
                             const std::vector<std::vector<SamplePart>>& parts) {
  const auto samples = std::ssize(parts);
  if (samples == 0) return;
  actuators_ = parts.front().front().taken_in.size();
  constexpr Eigen::Index kRotation = 9;
  begin_.resize(actuators_ + kRotation, samples);
  for (Eigen::Index s = 0; s < samples; ++s) {
    const auto recording = At(observed.samples[At(s)].recording);
    begin_.col(s) << Driven(parts[At(s)].front()),
        observed.recordings[recording].base_rotation.reshaped();
  }
  middle_ = begin_;
  for (Eigen::Index s = 0; s < samples; ++s)
    middle_.col(s).head(actuators_) = Driven(parts[At(s)][parts[At(s)].size() / 2]);
  for (Eigen::Index a = 0; a < actuators_; ++a) {
    const double range = middle_.row(a).maxCoeff() - middle_.row(a).minCoeff();
    const double per_range = range > 0.0 ? 1.0 / range : 0.0;
    begin_.row(a) *= per_range;
    middle_.row(a) *= per_range;
  }
}

std::vector<std::size_t> DriveDistance::FromNearToFar(
    const std::vector<std::size_t>& samples) const {
  std::vector<std::pair<double, std::size_t>> left;  // distance to the nearest in order
  for (const std::size_t s : samples) left.emplace_back(FromUndeformed(s), s);
  std::vector<std::size_t> in_order;
  while (!left.empty()) {
    const auto next = std::min_element(left.begin(), left.end());
    const bool is_first = in_order.empty();
    in_order.push_back(next->second);
    left.erase(next);
    for (auto& [distance, s] : left) {
      const double to_last = ToBegin(in_order.back(), s);
      distance = is_first ? to_last : std::min(distance, to_last);
    }
  }
  return in_order;
}

}  // namespace palpate::diagnosis
