// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/live_comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

constexpr std::size_t kNodesKept = 40;

// Share of the true forces in a frame that was detected; steady forces are preferred.
double WorthOfPicture(const std::vector<ComparedForce>& compared, bool with_truth) {
  constexpr double kUnsteady = 0.01;
  double sum_N = 0.0;
  for (const ComparedForce& force : compared) {
    if (!force.estimate || (with_truth && !force.truth)) continue;
    sum_N += with_truth ? (force.due ? 1.0 : kUnsteady) * force.truth->force_N.norm()
                        : force.estimate->force_N.norm();
  }
  return sum_N;
}

}  // namespace

LiveComparison::LiveComparison(bool with_truth, double same_place_m)
    : with_truth_(with_truth),
      rules_{.same_place_m = same_place_m, .smallest_N = 0.0},
      // Each state of the bench comes: between two of them there was none, however slow it is.
      truth_({.longest_gap_s = std::numeric_limits<double>::infinity()}),
      tracks_(with_truth) {}

void LiveComparison::AddTruth(double t_s, std::vector<TrueContact> contacts) {
  for (const TrueContact& contact : contacts) {
    largest_N_ = std::max(largest_N_, contact.force_N.norm());
  }
  rules_.smallest_N = SmallestForce_N(largest_N_);
  truth_.Add(t_s, std::move(contacts));
}

void LiveComparison::AddNodes(double t_s, Eigen::VectorXd nodes_m) {
  nodes_m_.insert_or_assign(t_s, std::move(nodes_m));
  if (nodes_m_.size() > kNodesKept) nodes_m_.erase(nodes_m_.begin());
}

void LiveComparison::AddEstimate(const force_estimation::ForceEstimate& estimate,
                                 std::optional<double> latency_s) {
  ++statuses_[std::string(ToString(estimate.status.code()))];
  if (estimate.status.code() == StatusCode::kStale) return;  // no frame, or one that came too late
  first_s_ = frames_ == 0 ? estimate.t_s : first_s_;
  last_s_ = estimate.t_s;
  ++frames_;
  // Frames before the robot starts do not count in the rate.
  if (frames_with_robot_ > 0 || estimate.status.code() != StatusCode::kNoRobotSeen) {
    if (frames_with_robot_++ == 0) robot_since_s_ = estimate.t_s;
  }
  results_ += HasResult(estimate.status) ? 1 : 0;
  if (latency_s && HasResult(estimate.status)) latencies_s_.push_back(*latency_s);
  waiting_.push_back(estimate);
}

void LiveComparison::Advance(const TakeFrame& take) {
  while (!waiting_.empty()) {
    const double t_s = waiting_.front().t_s;
    const bool truth_is_known = !with_truth_ || (!truth_.empty() && truth_.last_s() >= t_s);
    if (!truth_is_known && last_s_ - t_s < kLongestWait_s) return;
    const force_estimation::ForceEstimate estimate = std::move(waiting_.front());
    waiting_.pop_front();
    const bool has_result = HasResult(estimate.status);
    const bool is_compared = has_result && (!with_truth_ || truth_.At(t_s).has_value());
    const std::vector<ComparedForce> compared = Compare(estimate);
    if (is_compared) summary_.Add(compared);
    tracks_.Add(t_s - first_s_, is_compared, compared);
    KeepIfBest(t_s, compared);
    take(estimate, with_truth_ ? compared : std::vector<ComparedForce>{});
  }
}

std::vector<ComparedForce> LiveComparison::Compare(
    const force_estimation::ForceEstimate& estimate) const {
  return with_truth_ ? CompareFrame(estimate, truth_, rules_) : WithoutTruth(estimate);
}

void LiveComparison::KeepIfBest(double t_s, const std::vector<ComparedForce>& compared) {
  const auto nodes = nodes_m_.find(t_s);
  const double worth = WorthOfPicture(compared, with_truth_);
  if (nodes == nodes_m_.end() || worth <= best_worth_) return;
  best_worth_ = worth;
  best_ = ForceFrame{t_s - first_s_, nodes->second, compared};
}

double LiveComparison::Rate_hz() const {
  if (frames_with_robot_ < 2 || !(last_s_ > robot_since_s_)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return (frames_with_robot_ - 1) / (last_s_ - robot_since_s_);
}

std::string LiveComparison::ToText() const {
  std::string text = fmt::format("  {:<18} {}", "frames", frames_);
  if (frames_with_robot_ > 1) text += fmt::format(", {:.1f} Hz", Rate_hz());
  for (const auto& [status, count] : statuses_) text += fmt::format("; {} {}", count, status);
  text += "\n";
  if (!latencies_s_.empty()) {
    text +=
        fmt::format("  {:<18} {:.0f} ms median, {:.0f} ms p99, from exposure to force\n", "latency",
                    1e3 * Quantile(latencies_s_, 0.5), 1e3 * Quantile(latencies_s_, 0.99));
  }
  return with_truth_ ? text + summary_.ToText() : text;
}

}  // namespace palpate::command
