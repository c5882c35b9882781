// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/drive_distance.hpp"

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
  const Eigen::Index actuators = parts.front().front().taken_in.size();
  constexpr Eigen::Index kRotation = 9;
  begin_.resize(actuators + kRotation, samples);
  for (Eigen::Index s = 0; s < samples; ++s) {
    const auto recording = At(observed.samples[At(s)].recording);
    begin_.col(s) << Driven(parts[At(s)].front()),
        observed.recordings[recording].base_rotation.reshaped();
  }
  middle_ = begin_;
  for (Eigen::Index s = 0; s < samples; ++s)
    middle_.col(s).head(actuators) = Driven(parts[At(s)][parts[At(s)].size() / 2]);
  for (Eigen::Index a = 0; a < actuators; ++a) {
    const double range = middle_.row(a).maxCoeff() - middle_.row(a).minCoeff();
    const double per_range = range > 0.0 ? 1.0 / range : 0.0;
    begin_.row(a) *= per_range;
    middle_.row(a) *= per_range;
  }
}

}  // namespace palpate::diagnosis
