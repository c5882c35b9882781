// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libs/core/statistics.hpp"

namespace palpate::test_support {

namespace {

using force_estimation::ContactForce;
using virtual_robot::TrueForce;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double Angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

ForceScore Score(const TrueForce& truth, const ContactForce& contact) {
  ForceScore score;
  score.true_N = truth.force_N.norm();
  score.found = true;
  const double off_N = std::abs(contact.force_N.norm() - score.true_N);
  score.relative_error = off_N / score.true_N;
  score.inside_interval = off_N <= contact.ci95_N;
  score.location_error_m = (contact.position_m - truth.position_m).norm();
  score.inside_location = score.location_error_m <= contact.location_ci95_m;
  score.has_direction = contact.status.ok();
  score.direction_error_rad = Angle_rad(contact.force_N, truth.force_N);
  return score;
}

/// [contacts] index of the true force that each belongs to, or -1. Names first, then the nearest
/// pairs.
std::vector<int> Assign(const std::vector<TrueForce>& truth,
                        const std::vector<ContactForce>& contacts) {
  std::vector<int> owner(contacts.size(), -1);
  std::vector<bool> taken(truth.size(), false);
  const auto assign = [&](std::size_t contact, std::size_t force) {
    owner[contact] = static_cast<int>(force);
    taken[force] = true;
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    for (std::size_t f = 0; f < truth.size(); ++f) {
      if (contacts[c].name == truth[f].name && !taken[f]) assign(c, f);
    }
  }
  while (true) {
    double nearest_m = Accuracy::kFarthest_m;
    std::size_t best_contact = contacts.size();
    std::size_t best_force = 0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      for (std::size_t f = 0; f < truth.size(); ++f) {
        const double away_m = (contacts[c].position_m - truth[f].position_m).norm();
        if (owner[c] >= 0 || taken[f] || away_m > nearest_m) continue;
        nearest_m = away_m;
        best_contact = c;
        best_force = f;
      }
    }
    if (best_contact == contacts.size()) return owner;
    assign(best_contact, best_force);
  }
}

template <typename Condition, typename Value>
std::vector<double> Collect(const std::vector<ForceScore>& scores, Condition condition,
                            Value value) {
  std::vector<double> values;
  for (const ForceScore& score : scores) {
    if (condition(score)) values.push_back(value(score));
  }
  return values;
}

}  // namespace

double Largest(const std::vector<double>& values) {
  return values.empty() ? kNothing : *std::max_element(values.begin(), values.end());
}

void Accuracy::Add(const std::vector<TrueForce>& truth,
                   const force_estimation::ForceEstimate& estimate) {
  ++frames_;
  const bool usable = estimate.status.ok();
  if (!usable && estimate.status.code() != StatusCode::kNoContact) ++failed_frames_;
  std::vector<ContactForce> contacts;
  if (usable) contacts = estimate.contacts;
  const std::vector<int> owner = Assign(truth, contacts);
  for (std::size_t f = 0; f < truth.size(); ++f) {
    if (truth[f].force_N.norm() < smallest_N_) continue;
    const auto found = std::find(owner.begin(), owner.end(), static_cast<int>(f));
    if (found == owner.end()) {
      scores_.push_back({.true_N = truth[f].force_N.norm()});
    } else {
      const ContactForce& contact = contacts[static_cast<std::size_t>(found - owner.begin())];
      scores_.push_back(Score(truth[f], contact));
      consistency_.Add(
          std::to_string(contacts_begun_) + " " + truth[f].name,
          force_estimation::Normalise(contact.force_N - truth[f].force_N, contact.covariance_N2));
    }
  }
  false_alarms_ += static_cast<int>(std::count(owner.begin(), owner.end(), -1));
}

AccuracySummary Accuracy::Summary() const {
  const auto all = [](const ForceScore&) { return true; };
  const auto found = [](const ForceScore& score) { return score.found; };
  const auto directed = [](const ForceScore& score) { return score.found && score.has_direction; };
  const auto share = [](bool yes) { return yes ? 1.0 : 0.0; };
  const auto relative =
      Collect(scores_, all, [](const ForceScore& score) { return score.relative_error; });
  const auto location =
      Collect(scores_, found, [](const ForceScore& score) { return score.location_error_m; });
  const auto direction =
      Collect(scores_, directed, [](const ForceScore& score) { return score.direction_error_rad; });
  AccuracySummary summary;
  summary.forces = static_cast<int>(scores_.size());
  summary.found_share =
      Mean(Collect(scores_, all, [&](const ForceScore& score) { return share(score.found); }));
  summary.mean_relative_error = Mean(relative);
  summary.median_relative_error = Median(relative);
  summary.largest_relative_error = Largest(relative);
  summary.median_location_error_m = Median(location);
  summary.largest_location_error_m = Largest(location);
  summary.force_coverage = Mean(Collect(
      scores_, found, [&](const ForceScore& score) { return share(score.inside_interval); }));
  summary.location_coverage = Mean(Collect(
      scores_, found, [&](const ForceScore& score) { return share(score.inside_location); }));
  summary.nees_per_degree = consistency_.NeesPerDegree();
  summary.lowest_nees = consistency_.LowestExpected();
  summary.highest_nees = consistency_.HighestExpected();
  summary.within_ellipsoid = consistency_.ShareWithin95();
  summary.directions = static_cast<int>(direction.size());
  summary.mean_direction_error_rad = Mean(direction);
  summary.largest_direction_error_rad = Largest(direction);
  summary.frames = frames_;
  summary.false_alarms = false_alarms_;
  summary.failed_frames = failed_frames_;
  return summary;
}

}  // namespace palpate::test_support
