// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/telling_samples.hpp"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>

namespace palpate::diagnosis {

namespace {

/// [actuators] how much of its way each is driven; NaN: it is not.
Eigen::VectorXd DrivenShares(const Timeline& timeline, const Eigen::VectorXd& most,
                             const Sample& sample) {
  const double t_s = 0.5 * (sample.frame_t_s.front() + sample.frame_t_s.back());
  return timeline.CommandAt(t_s).cwiseQuotient(most);
}

/// How much more of its way than the others in the mean an actuator is driven; NaN: it is not.
double DrivenApart(const Timeline& timeline, const Eigen::VectorXd& most, const Sample& sample,
                   Eigen::Index actuator) {
  const Eigen::VectorXd share = DrivenShares(timeline, most, sample);
  if (share.size() == 1) return share[0];
  const double sum = share.array().isNaN().select(0.0, share.array()).sum();
  return share[actuator] - (sum - share[actuator]) / static_cast<double>(share.size() - 1);
}

bool SeesTheRobot(const Sample& sample, bool in_frames) {
  return in_frames ? !sample.depth_frames.empty() : (sample.count.array() > 0).any();
}

/// The sample that sees the robot in which an actuator is driven apart from the others the most, of
/// one recording or, without it, of all. None where it is not driven.
std::optional<std::size_t> MostDriven(const ObservedExperiment& observed,
                                      const Eigen::VectorXd& most, Eigen::Index actuator,
                                      bool in_frames, std::optional<int> recording = {}) {
  std::optional<std::size_t> best;
  double farthest = 0.0;
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    if (!SeesTheRobot(sample, in_frames)) continue;
    if (recording && sample.recording != *recording) continue;
    const double apart = DrivenApart(observed.timeline, most, sample, actuator);
    if (!(apart > farthest)) continue;
    farthest = apart;
    best = s;
  }
  return best;
}

/// The sample that sees the robot in which actuators are driven the least, in the mean.
std::optional<std::size_t> LeastDriven(const ObservedExperiment& observed,
                                       const Eigen::VectorXd& most, bool in_frames) {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    if (!SeesTheRobot(sample, in_frames)) continue;
    const Eigen::ArrayXd share = DrivenShares(observed.timeline, most, sample);
    const double driven = share.isNaN().select(0.0, share).mean();
    if (!(driven < least)) continue;
    least = driven;
    best = s;
  }
  return best;
}

}  // namespace

Telling OfMostDriven(const ObservedExperiment& observed, const robot::RobotBody& body,
                     bool in_frames) {
  const Timeline& timeline = observed.timeline;
  Eigen::VectorXd most = Eigen::VectorXd::Zero(std::ssize(timeline.actuators));
  for (const Eigen::VectorXd& command : timeline.command) {
    most = command.array().isNaN().select(most, command.cwiseMax(most));
  }
  std::map<std::size_t, Eigen::Index> driven;
  for (Eigen::Index c = 0; c < most.size(); ++c) {
    if (const auto best = MostDriven(observed, most, c, in_frames)) driven.emplace(*best, c);
    if (c < std::ssize(body.cables)) continue;
    for (int r = 0; r < std::ssize(observed.recordings); ++r) {
      if (const auto best = MostDriven(observed, most, c, in_frames, r)) driven.emplace(*best, c);
    }
  }
  if (!body.chambers.empty() && !driven.empty()) {
    if (const auto best = LeastDriven(observed, most, in_frames)) driven.emplace(*best, -1);
  }
  Telling telling{observed, {}};
  telling.observed.samples.clear();
  for (const auto& [s, actuator] : driven) {
    telling.observed.samples.push_back(observed.samples[s]);
    telling.driven.push_back(actuator);
  }
  return telling;
}

}  // namespace palpate::diagnosis
