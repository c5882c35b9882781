// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/contact_tracker.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "components/perception/contacts/assignment.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

const std::vector<DetectedContact>& ContactTracker::Update(
    const std::vector<DetectedContact>& detected) {
  Associate(detected);
  std::vector<char> known(detected.size(), 0);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const int detection = detection_of_track_[t];
    if (detection >= 0) {
      known[At(detection)] = 1;
      See(detected[At(detection)], &tracks_[t]);
    } else {
      ++tracks_[t].frames_missing;
      tracks_[t].contact.frames_seen = 0;
    }
  }
  std::erase_if(tracks_, [this](const Track& track) {
    const bool is_settled = track.number > 0 && track.frames_seen >= config_.appear_frames;
    return track.frames_missing >= (is_settled ? config_.vanish_frames : 1);
  });
  for (std::size_t d = 0; d < detected.size(); ++d) {
    if (known[d] != 0) continue;
    Track& track = tracks_.emplace_back();
    track.contact = detected[d];
    track.contact.frames_seen = track.frames_seen = 1;
  }
  Report();
  return contacts_;
}

void ContactTracker::Forget() {
  tracks_.clear();
  contacts_.clear();
  begins_ = true;
}

/// Rows are tracks; columns are detections, and for each track one that means "missing".
void ContactTracker::Associate(const std::vector<DetectedContact>& detected) {
  const auto tracks = ToIndex(tracks_.size());
  const auto detections = ToIndex(detected.size());
  const double gate_m2 = config_.gate_m * config_.gate_m;
  const double missing = 2.0 * gate_m2;  // dearer than any match
  const double never = 4.0 * gate_m2 * static_cast<double>(tracks + 1);
  cost_.setConstant(tracks, detections + tracks, missing);
  for (Eigen::Index t = 0; t < tracks; ++t) {
    const Track& track = tracks_[At(t)];
    for (Eigen::Index d = 0; d < detections; ++d) {
      const double distance_m2 =
          (detected[At(d)].position_m - track.contact.position_m).squaredNorm();
      // Where contacts merge, the one that was detected last takes the detection.
      const bool behind = track.frames_missing > 0 || track.number == 0;
      cost_(t, d) = distance_m2 > gate_m2 ? never : distance_m2 + (behind ? 0.5 * gate_m2 : 0.0);
    }
  }
  detection_of_track_ = AssignRows(cost_);
  for (int& detection : detection_of_track_) {
    if (detection >= detections) detection = -1;
  }
}

void ContactTracker::See(const DetectedContact& detected, Track* track) const {
  const DetectedContact last = std::exchange(track->contact, detected);
  const double kept = config_.smoothing;
  const Eigen::Vector3d moved_m = detected.position_m - last.position_m;
  DetectedContact& contact = track->contact;
  contact.position_m -= kept * moved_m;
  // Covariance of the mixture of both locations, which includes the lag.
  contact.covariance_m2 += kept * (last.covariance_m2 - detected.covariance_m2) +
                           kept * (1.0 - kept) * moved_m * moved_m.transpose();
  contact.extent_m += kept * (last.extent_m - detected.extent_m);
  contact.frames_seen = last.frames_seen + 1;
  ++track->frames_seen;
  track->frames_missing = 0;
}

void ContactTracker::Report() {
  contacts_.clear();
  for (Track& track : tracks_) {
    if (track.number == 0 && (begins_ || track.contact.frames_seen >= config_.appear_frames)) {
      track.number = ++last_number_;
    }
    if (track.number == 0) continue;
    contacts_.push_back(track.contact);
    contacts_.back().name = "contact_" + std::to_string(track.number);
  }
  begins_ = false;
  const auto number = [](const DetectedContact& contact) {
    return std::pair(contact.name.size(), std::string_view(contact.name));
  };
  std::sort(contacts_.begin(), contacts_.end(),
            [&](const auto& a, const auto& b) { return number(a) < number(b); });
}

}  // namespace palpate::perception
