// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/schedule.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::scenario {

namespace {

constexpr double kNothingDriven = std::numeric_limits<double>::quiet_NaN();

/// Those of the last time that is not after `t_s`.
std::vector<HungWeight> WeightsAt(const std::vector<HungWeight>& weights, double t_s) {
  double latest_s = -std::numeric_limits<double>::infinity();
  for (const HungWeight& weight : weights) {
    if (weight.t_s <= t_s) latest_s = std::max(latest_s, weight.t_s);
  }
  std::vector<HungWeight> hanging;
  for (const HungWeight& weight : weights) {
    if (weight.t_s == latest_s && weight.mass_kg > 0.0) hanging.push_back(weight);
  }
  return hanging;
}

}  // namespace

Schedule::Schedule(Scenario scenario, std::vector<std::string> cables)
    : scenario_(std::move(scenario)), cables_(std::move(cables)) {
  PALPATE_CHECK(!scenario_.recordings.empty(), scenario_.name);
  starts_s_.push_back(0.0);
  for (const RecordingPlan& plan : scenario_.recordings) {
    for (const std::string& cable : plan.commands.cables) {
      if (std::find(cables_.begin(), cables_.end(), cable) == cables_.end()) {
        throw InputError("recording '" + plan.name + "': the robot has no actuator '" + cable +
                         "'" + DidYouMean(cable, cables_));
      }
    }
    starts_s_.push_back(starts_s_.back() + scenario_.rest_between_s + plan.duration_s);
  }
}

double Schedule::Begin_s(int recording) const {
  return starts_s_.at(palpate::At(recording)) + scenario_.rest_between_s;
}

Moment Schedule::At(double bench_s) const {
  const auto after = std::upper_bound(starts_s_.begin(), starts_s_.end(), bench_s);
  const auto last = ToIndex(scenario_.recordings.size()) - 1;
  const auto recording = std::clamp<std::ptrdiff_t>(after - starts_s_.begin() - 1, 0, last);
  const int index = static_cast<int>(recording);
  const double end_s = scenario_.recordings[palpate::At(index)].duration_s;
  return {index, std::min(bench_s - Begin_s(index), end_s)};
}

BenchInputs Schedule::InputsAt(double bench_s) const {
  const Moment moment = At(bench_s);
  if (moment.t_s < 0.0) {
    return RestBefore(moment.recording, 1.0 + moment.t_s / scenario_.rest_between_s);
  }
  return During(scenario_.recordings[palpate::At(moment.recording)], moment.t_s);
}

BenchInputs Schedule::RestBefore(int recording, double done) const {
  const auto index = static_cast<std::size_t>(recording);
  const RecordingPlan& next = scenario_.recordings[index];
  const RecordingPlan& last = scenario_.recordings[index > 0 ? index - 1 : 0];
  BenchInputs inputs;
  inputs.displacement_m = Commands(next, 0.0);
  inputs.base_tilt_deg = next.base_tilt_deg;
  const Eigen::VectorXd held_m = Commands(last, last.duration_s);
  const double left = index > 0 ? std::max(0.0, 1.0 - 2.0 * done) : 0.0;
  for (Eigen::Index c = 0; c < held_m.size(); ++c) {
    const bool was_driven = index > 0 && held_m[c] == held_m[c];
    const bool will_be = inputs.displacement_m[c] == inputs.displacement_m[c];
    inputs.displacement_m[c] = was_driven ? left * held_m[c] : will_be ? 0.0 : kNothingDriven;
  }
  if (index > 0) {
    inputs.base_tilt_deg =
        last.base_tilt_deg + std::clamp(done, 0.0, 1.0) * (next.base_tilt_deg - last.base_tilt_deg);
  }
  return inputs;
}

BenchInputs Schedule::During(const RecordingPlan& plan, double t_s) const {
  BenchInputs inputs;
  inputs.displacement_m = Commands(plan, t_s);
  for (const ToolPath& path : plan.tool_paths) {
    if (const auto pose = PoseAt(plan, path.tool, t_s)) inputs.tools.push_back({path.tool, *pose});
  }
  inputs.weights = WeightsAt(plan.weights, t_s);
  inputs.base_tilt_deg = plan.base_tilt_deg;
  return inputs;
}

Eigen::VectorXd Schedule::Commands(const RecordingPlan& plan, double t_s) const {
  Eigen::VectorXd commands = Eigen::VectorXd::Constant(ToIndex(cables_.size()), kNothingDriven);
  if (plan.commands.cables.empty()) return commands;
  const Eigen::VectorXd driven = plan.commands.At(t_s);
  for (std::size_t i = 0; i < plan.commands.cables.size(); ++i) {
    const auto cable = std::find(cables_.begin(), cables_.end(), plan.commands.cables[i]);
    commands[cable - cables_.begin()] = driven[ToIndex(i)];
  }
  return commands;
}

}  // namespace palpate::scenario
