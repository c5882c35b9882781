// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/cable_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/check.hpp"

namespace palpate::calibration {

namespace {

using Kind = robot::ActuatorCommand::Kind;

/// Largest delay of clouds and markers behind the cable readings of their time.
constexpr double kLatest_s = 10.0;

std::int64_t Nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(1e9 * seconds));
}

/// First reading at or after a time.
auto FirstFrom(const std::deque<CableReading>& readings, std::int64_t stamp_ns) {
  return std::lower_bound(
      readings.begin(), readings.end(), stamp_ns,
      [](const CableReading& reading, std::int64_t stamp) { return reading.stamp_ns < stamp; });
}

}  // namespace

void CableWatch::Add(CableReading reading) {
  PALPATE_CHECK(reading.cables.size() == cable_count_, reading.cables.size(), cable_count_);
  if (!readings_.empty() && reading.stamp_ns < readings_.back().stamp_ns) readings_.clear();
  if (!readings_.empty() && reading.stamp_ns == readings_.back().stamp_ns) readings_.pop_back();
  const std::int64_t oldest_ns =
      reading.stamp_ns - Nanoseconds(2.0 * settings_.still_s + kLatest_s);
  while (!readings_.empty() &&
         (readings_.front().stamp_ns < oldest_ns || readings_.size() == kCapacity)) {
    readings_.pop_front();
  }
  readings_.push_back(std::move(reading));
}

std::int64_t CableWatch::Begin(std::int64_t stamp_ns) const {
  return stamp_ns - Nanoseconds(settings_.still_s);
}

robot::ActuatorCommand CableWatch::CommandOf(const CableReading& reading, std::size_t cable) const {
  const CableReading::Inputs& inputs = reading.cables[cable];
  return robot::ChooseCommand(inputs.displacement_m, inputs.tension_N, preferred_);
}

CableWatch::State CableWatch::At(std::int64_t stamp_ns) const {
  if (cable_count_ == 0) return State::kResting;
  if (readings_.empty() || readings_.back().stamp_ns < stamp_ns) return State::kNotYet;
  if (readings_.front().stamp_ns > Begin(stamp_ns)) return State::kMoving;
  const auto first = static_cast<std::size_t>(
      std::prev(std::upper_bound(readings_.begin(), readings_.end(), Begin(stamp_ns),
                                 [](std::int64_t stamp, const CableReading& reading) {
                                   return stamp < reading.stamp_ns;
                                 })) -
      readings_.begin());
  const auto last = static_cast<std::size_t>(FirstFrom(readings_, stamp_ns) - readings_.begin());
  const std::int64_t longest_gap_ns = Nanoseconds(0.5 * settings_.still_s);
  for (std::size_t k = first; k < last; ++k) {
    if (readings_[k + 1].stamp_ns - readings_[k].stamp_ns > longest_gap_ns) return State::kMoving;
  }
  for (std::size_t cable = 0; cable < cable_count_; ++cable) {
    if (!IsStill(cable, first, last)) return State::kMoving;
  }
  return State::kResting;
}

/// Over readings first to last, both counted.
bool CableWatch::IsStill(std::size_t cable, std::size_t first, std::size_t last) const {
  const Kind kind = CommandOf(readings_[first], cable).kind;
  double least = CommandOf(readings_[first], cable).value;
  double most = least;
  for (std::size_t k = first; k <= last; ++k) {
    const robot::ActuatorCommand command = CommandOf(readings_[k], cable);
    if (command.kind != kind) return false;
    least = std::min(least, command.value);
    most = std::max(most, command.value);
  }
  return most - least <= (kind == Kind::kTension ? settings_.still_N : settings_.still_m);
}

std::vector<robot::ActuatorCommand> CableWatch::MeanAt(std::int64_t stamp_ns) const {
  std::vector<robot::ActuatorCommand> means(cable_count_);
  if (cable_count_ == 0) return means;
  const auto first = FirstFrom(readings_, Begin(stamp_ns));
  for (std::size_t cable = 0; cable < cable_count_; ++cable) {
    double sum = 0.0;
    int count = 0;
    for (auto reading = first; reading != readings_.end(); ++reading) {
      if (count > 0 && reading->stamp_ns > stamp_ns) break;
      const robot::ActuatorCommand command = CommandOf(*reading, cable);
      means[cable].kind = command.kind;
      sum += command.value;
      ++count;
    }
    if (count > 0) means[cable].value = sum / count;
  }
  return means;
}

}  // namespace palpate::calibration
