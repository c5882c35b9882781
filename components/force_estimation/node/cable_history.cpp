// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/cable_history.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

std::optional<double> Between(const std::optional<double>& before,
                              const std::optional<double>& after, double share) {
  if (!before || !after) return before;
  return share == 0.0 ? *before : *before + share * (*after - *before);
}

}  // namespace

void CableHistory::Add(CableReading reading) {
  PALPATE_CHECK(reading.cables.size() == cable_count_, reading.cables.size(), cable_count_);
  if (!readings_.empty() && reading.stamp_ns < readings_.back().stamp_ns) {
    readings_.clear();
    went_back_ = true;
  }
  if (!readings_.empty() && reading.stamp_ns == readings_.back().stamp_ns) readings_.pop_back();
  if (readings_.size() == kCapacity) readings_.pop_front();
  readings_.push_back(std::move(reading));
}

void CableHistory::BeginSequence(bool time_went_back) {
  // Cable inputs of the new sequence may come before its first frame, or after.
  if (time_went_back && !went_back_) readings_.clear();
  went_back_ = false;
}

std::optional<std::vector<robot::ActuatorCommand>> CableHistory::At(int64_t stamp_ns) const {
  if (cable_count_ == 0) return std::vector<robot::ActuatorCommand>();
  const auto after = std::lower_bound(
      readings_.begin(), readings_.end(), stamp_ns,
      [](const CableReading& reading, int64_t stamp) { return reading.stamp_ns < stamp; });
  if (after == readings_.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return Commands(*after, *after, 0.0);
  if (after == readings_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double share = static_cast<double>(stamp_ns - before->stamp_ns) /
                       static_cast<double>(after->stamp_ns - before->stamp_ns);
  return Commands(*before, *after, share);
}

Status CableHistory::LastBefore(int64_t stamp_ns, double max_age_s,
                                std::vector<robot::ActuatorCommand>* commands) const {
  const auto after = std::upper_bound(
      readings_.begin(), readings_.end(), stamp_ns,
      [](int64_t stamp, const CableReading& reading) { return stamp < reading.stamp_ns; });
  if (after == readings_.begin()) {
    return {StatusCode::kStale, "no cable inputs on /robot/joint_states for the time of the frame"};
  }
  const CableReading& last = *std::prev(after);
  const double age_s = 1e-9 * static_cast<double>(stamp_ns - last.stamp_ns);
  if (age_s > max_age_s) {
    return {StatusCode::kStale,
            "the cable inputs are " + FormatNumber(age_s) +
                " s older than the frame (max_cable_age_s: " + FormatNumber(max_age_s) + ")"};
  }
  *commands = Commands(last, last, 0.0);
  return Status::Ok();
}

std::vector<robot::ActuatorCommand> CableHistory::Commands(const CableReading& before,
                                                           const CableReading& after,
                                                           double share) const {
  std::vector<robot::ActuatorCommand> commands;
  for (size_t i = 0; i < cable_count_; ++i) {
    const auto& first = before.cables[i];
    const auto& second = after.cables[i];
    auto displacement_m = Between(first.displacement_m, second.displacement_m, share);
    if (displacement_m) displacement_m = drives_[i].TakenIn_m(*displacement_m);
    auto force_N = Between(first.tension_N, second.tension_N, share);
    if (force_N) force_N = forces_[i].Force_N(*force_N);
    commands.push_back(robot::ChooseCommand(displacement_m, force_N, preferred_));
  }
  return commands;
}

}  // namespace palpate::force_estimation
