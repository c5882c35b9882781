// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

using experiment::ActuatorQuantity;

constexpr double kNotDriven = std::numeric_limits<double>::quiet_NaN();

const experiment::ActuatorColumn* ColumnOf(const experiment::Recording& recording,
                                           const robot::ActuatorTraits& actuator) {
  if (!recording.actuation) return nullptr;
  const auto* displacement =
      recording.actuation->Find(actuator.name, ActuatorQuantity::kDisplacement);
  const auto* force = recording.actuation->Find(actuator.name, ActuatorQuantity::kTension);
  if (displacement == nullptr || force == nullptr) return displacement ? displacement : force;
  return actuator.IsChamber() ? force : displacement;
}

Eigen::VectorXd CommandOf(const experiment::Recording& recording,
                          const std::vector<robot::ActuatorTraits>& actuators, double t_s) {
  Eigen::VectorXd command(ToIndex(actuators.size()));
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    command[ToIndex(a)] = kNotDriven;
    const auto* column = ColumnOf(recording, actuators[a]);
    if (column == nullptr) continue;
    const double reported = recording.actuation->ValueAt(*column, t_s);
    command[ToIndex(a)] = column->quantity == ActuatorQuantity::kTension
                              ? actuators[a].Force_N(reported)
                              : actuators[a].Displacement_m(reported);
  }
  return command;
}

double FirstStamp(const experiment::Recording& recording) {
  double t_s = std::numeric_limits<double>::infinity();
  if (recording.actuation) t_s = recording.actuation->t_s.front();
  if (recording.markers) t_s = std::min(t_s, recording.markers->frames.front().t_s);
  for (const auto* files : {&recording.depth_images, &recording.clouds}) {
    if (!files->empty()) t_s = std::min(t_s, files->front().t_s());
  }
  return std::isfinite(t_s) ? t_s : 0.0;
}

double LastStamp(const experiment::Recording& recording) {
  double t_s = -std::numeric_limits<double>::infinity();
  if (recording.actuation) t_s = recording.actuation->t_s.back();
  if (recording.markers) t_s = std::max(t_s, recording.markers->frames.back().t_s);
  for (const auto* files : {&recording.depth_images, &recording.clouds}) {
    if (!files->empty()) t_s = std::max(t_s, files->back().t_s());
  }
  return std::isfinite(t_s) ? t_s : 0.0;
}

void Append(double t_s, Eigen::VectorXd command, Timeline* timeline) {
  if (!timeline->t_s.empty() && t_s <= timeline->t_s.back()) return;
  timeline->t_s.push_back(t_s);
  timeline->command.push_back(std::move(command));
}

/// Commands at zero, of the actuators that are driven before and after.
void AppendRest(double begin_s, double end_s, Timeline* timeline) {
  Eigen::VectorXd zero = timeline->command.back();
  for (double& value : zero) value = std::isnan(value) ? value : 0.0;
  Append(0.5 * (begin_s + end_s), std::move(zero), timeline);
}

}  // namespace

Eigen::VectorXd Timeline::CommandAt(double now_s) const {
  const auto after = std::upper_bound(t_s.begin(), t_s.end(), now_s);
  if (after == t_s.begin()) return command.front();
  const auto next = static_cast<std::size_t>(after - t_s.begin());
  if (next == t_s.size()) return command.back();
  const double share = (now_s - t_s[next - 1]) / (t_s[next] - t_s[next - 1]);
  return command[next - 1] + share * (command[next] - command[next - 1]);
}

Timeline ReadTimeline(const experiment::Experiment& experiment,
                      const std::vector<robot::ActuatorTraits>& actuators) {
  Timeline timeline;
  timeline.actuators = actuators;
  timeline.by_tension.assign(actuators.size(), false);
  for (const experiment::Recording& recording : experiment.recordings) {
    const double begin_s = FirstStamp(recording);
    const double end_s = LastStamp(recording);
    if (!timeline.t_s.empty()) {
      const double rest_s = experiment.rest_between_s.value_or(begin_s - timeline.t_s.back());
      const double rest_begin_s = std::max(timeline.t_s.back(), begin_s - rest_s);
      AppendRest(rest_begin_s, begin_s, &timeline);
    }
    for (std::size_t c = 0; c < actuators.size(); ++c) {
      const auto* column = ColumnOf(recording, actuators[c]);
      if (column != nullptr && column->quantity == ActuatorQuantity::kTension) {
        timeline.by_tension[c] = true;
      }
    }
    Append(begin_s, CommandOf(recording, actuators, begin_s), &timeline);
    if (recording.actuation) {
      for (const double t_s : recording.actuation->t_s) {
        Append(t_s, CommandOf(recording, actuators, t_s), &timeline);
      }
    }
    Append(end_s, CommandOf(recording, actuators, end_s), &timeline);
    timeline.begin_s.push_back(begin_s);
    timeline.end_s.push_back(end_s);
  }
  return timeline;
}

}  // namespace palpate::diagnosis
