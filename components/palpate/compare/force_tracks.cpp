// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/force_tracks.hpp"

#include <algorithm>
#include <limits>

namespace palpate::command {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
const char* const kElsewhere = "no true force here";

}  // namespace

std::string ForceTracks::NameOf(const force_estimation::ContactForce& estimate) const {
  return with_truth_ ? kElsewhere : estimate.name;
}

void ForceTracks::Add(double t_s, bool has_result, const std::vector<ComparedForce>& compared) {
  Frame frame{t_s, has_result, {}};
  for (const ComparedForce& force : compared) {
    const std::string name = force.truth ? force.truth->name : NameOf(*force.estimate);
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
    frame.forces.emplace(name, force);
  }
  frames_.push_back(std::move(frame));
}

std::vector<view::ForceTrack> ForceTracks::Tracks() const {
  std::vector<view::ForceTrack> tracks;
  for (const std::string& name : names_) {
    view::ForceTrack track;
    track.contact = name;
    for (const Frame& frame : frames_) {
      const auto found = frame.forces.find(name);
      const ComparedForce* force = found == frame.forces.end() ? nullptr : &found->second;
      const force_estimation::ContactForce* estimate =
          force && force->estimate ? &*force->estimate : nullptr;
      const bool hidden = estimate && estimate->status.code() == StatusCode::kHidden;
      const double size_N = estimate ? estimate->force_N.norm() : kNone;
      const double ci95_N = estimate ? estimate->ci95_N : kNone;
      track.t_s.push_back(frame.t_s);
      track.estimated_N.push_back(hidden ? kNone : size_N);
      track.ci95_N.push_back(hidden ? kNone : ci95_N);
      track.hidden_N.push_back(hidden ? size_N : kNone);
      track.hidden_ci95_N.push_back(hidden ? ci95_N : kNone);
      const double nothing_N = frame.has_result ? 0.0 : kNone;
      if (!with_truth_) continue;
      track.true_N.push_back(force && force->truth ? force->truth->force_N.norm() : nothing_N);
    }
    tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace palpate::command
