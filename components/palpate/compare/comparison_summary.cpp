// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/comparison_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

bool DirectionIsKnown(const ComparedForce& force) { return force.estimate->status.ok(); }

double Angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

ForceScore ScoreOf(const std::vector<ComparedForce>& forces) {
  std::vector<double> errors;
  std::vector<double> distances_m;
  std::vector<double> angles_rad;
  std::vector<double> inside;
  for (const ComparedForce& force : forces) {
    const double error_N = std::abs(ForceError_N(force));
    errors.push_back(error_N / force.truth->force_N.norm());
    distances_m.push_back((force.estimate->position_m - force.truth->position_m).norm());
    inside.push_back(error_N <= force.estimate->ci95_N ? 1.0 : 0.0);
    if (!DirectionIsKnown(force)) continue;
    angles_rad.push_back(Angle_rad(force.estimate->force_N, force.truth->force_N));
  }
  return {.frames = static_cast<int>(forces.size()),
          .mean_relative_error = Mean(errors),
          .median_relative_error = Quantile(errors, 0.5),
          .p95_relative_error = Quantile(errors, 0.95),
          .median_location_error_m = Quantile(distances_m, 0.5),
          .mean_direction_error_rad = Mean(angles_rad),
          .coverage = Mean(inside)};
}

std::string ScoreText(const std::string& name, const ForceScore& score) {
  if (score.frames == 0) return fmt::format("  {:<18} none detected\n", name);
  std::string text = fmt::format(
      "  {:<18} {:.1f} % mean error over {} frames; location error {:.1f} mm (median)", name,
      100.0 * score.mean_relative_error, score.frames, 1e3 * score.median_location_error_m);
  if (std::isfinite(score.mean_direction_error_rad)) {
    text += fmt::format(", direction error {:.0f} deg",
                        score.mean_direction_error_rad * 180.0 / std::numbers::pi);
  }
  return text + fmt::format("; {:.0f} % inside the 95 % interval\n", 100.0 * score.coverage);
}

}  // namespace

void ComparisonSummary::Add(const std::vector<ComparedForce>& frame) {
  ++frames_;
  const int false_alarms_before = false_alarms_;
  for (const ComparedForce& force : frame) {
    if (!force.truth) {
      ++false_alarms_;
    } else if (force.due) {
      ++due_;
      if (!force.estimate) {
        ++misses_;
      } else if (force.true_forces > 1) {
        together_.push_back(force);
      } else {
        const bool hidden = force.estimate->status.code() == StatusCode::kHidden;
        (hidden ? hidden_ : seen_).push_back(force);
      }
    }
  }
  frames_with_false_alarm_ += false_alarms_ > false_alarms_before ? 1 : 0;
}

ForceScore ComparisonSummary::Seen() const { return ScoreOf(seen_); }

ForceScore ComparisonSummary::Hidden() const { return ScoreOf(hidden_); }

ForceScore ComparisonSummary::Together() const { return ScoreOf(together_); }

ForceScore ComparisonSummary::All() const {
  std::vector<ComparedForce> all = seen_;
  all.insert(all.end(), hidden_.begin(), hidden_.end());
  all.insert(all.end(), together_.begin(), together_.end());
  return ScoreOf(all);
}

std::string ComparisonSummary::ToText() const {
  std::string text = ScoreText("one, in view", Seen());
  text += ScoreText("one, out of view", Hidden());
  text += ScoreText("two at once", Together());
  text += ScoreText("all", All());
  text +=
      fmt::format("  {:<18} {} of {} steady forces were not detected\n", "misses", misses_, due_);
  text +=
      fmt::format("  {:<18} {} of {} frames\n", "false alarms", frames_with_false_alarm_, frames_);
  return text;
}

}  // namespace palpate::command
