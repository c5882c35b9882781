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

/// Absolute errors of many forces.
struct Errors {
  std::vector<double> signed_N, size_N, relative, along_N, across_N, angles_rad, distances_m;
  std::vector<double> inside, inside_location;  ///< 1 or 0
};

void AddDirected(const ComparedForce& force, Errors* errors) {
  const Eigen::Vector3d error_N = force.estimate->force_N - force.truth->force_N;
  const Eigen::Vector3d along = force.truth->force_N.normalized();
  errors->along_N.push_back(std::abs(along.dot(error_N)));
  errors->across_N.push_back((error_N - along * along.dot(error_N)).norm());
  errors->angles_rad.push_back(Angle_rad(force.estimate->force_N, force.truth->force_N));
}

void Add(const ComparedForce& force, Errors* errors) {
  const force_estimation::ContactForce& estimate = *force.estimate;
  const double error_N = ForceError_N(force);
  const double distance_m = (estimate.position_m - force.truth->position_m).norm();
  errors->signed_N.push_back(error_N);
  errors->size_N.push_back(std::abs(error_N));
  errors->relative.push_back(std::abs(error_N) / force.truth->force_N.norm());
  errors->distances_m.push_back(distance_m);
  if (std::isfinite(estimate.ci95_N)) {
    errors->inside.push_back(std::abs(error_N) <= estimate.ci95_N ? 1.0 : 0.0);
  }
  if (estimate.location_ci95_m > 0.0) {  // 0: it was given
    errors->inside_location.push_back(distance_m <= estimate.location_ci95_m ? 1.0 : 0.0);
  }
  if (DirectionIsKnown(force)) AddDirected(force, errors);
}

force_estimation::ErrorConsistency ConsistencyOf(const std::vector<ComparedForce>& forces) {
  force_estimation::ErrorConsistency consistency;
  for (const ComparedForce& force : forces) {
    consistency.Add(force.recording + "/" + force.truth->name,
                    force_estimation::Normalise(force.estimate->force_N - force.truth->force_N,
                                                force.estimate->covariance_N2));
  }
  return consistency;
}

/// Across the surface a place has no variance, and no error either.
force_estimation::ErrorConsistency LocationConsistencyOf(const std::vector<ComparedForce>& forces) {
  force_estimation::ErrorConsistency consistency;
  for (const ComparedForce& force : forces) {
    consistency.Add(
        force.recording + "/" + force.truth->name,
        force_estimation::Normalise(force.estimate->position_m - force.truth->position_m,
                                    force.estimate->location_covariance_m2));
  }
  return consistency;
}

ForceScore ScoreOf(const std::vector<ComparedForce>& forces) {
  Errors errors;
  for (const ComparedForce& force : forces) Add(force, &errors);
  return {.frames = static_cast<int>(forces.size()),
          .mean_relative_error = Mean(errors.relative),
          .median_relative_error = Quantile(errors.relative, 0.5),
          .p95_relative_error = Quantile(errors.relative, 0.95),
          .bias_N = Mean(errors.signed_N),
          .median_error_N = Quantile(errors.size_N, 0.5),
          .p95_error_N = Quantile(errors.size_N, 0.95),
          .median_along_N = Quantile(errors.along_N, 0.5),
          .median_across_N = Quantile(errors.across_N, 0.5),
          .median_location_error_m = Quantile(errors.distances_m, 0.5),
          .p95_location_error_m = Quantile(errors.distances_m, 0.95),
          .mean_direction_error_rad = Mean(errors.angles_rad),
          .coverage = Mean(errors.inside),
          .location_coverage = Mean(errors.inside_location),
          .consistency = ConsistencyOf(forces),
          .location_consistency = LocationConsistencyOf(forces)};
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
  if (std::isfinite(score.coverage)) {
    text += fmt::format("; {:.0f} % inside the 95 % interval", 100.0 * score.coverage);
  }
  return text + "\n";
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
