// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/contact_config.hpp"
#include "components/perception/observation.hpp"

namespace palpate::perception {

/// Gives the contacts of each frame the names of their tracks. Contacts and tracks are assigned
/// with the least sum of squared distances, each within the gate. Of two contacts that merge the
/// one that was detected last keeps the name; when they separate within vanish_frames the other
/// regains its name, later a new one.
class ContactTracker {
 public:
  explicit ContactTracker(const TrackingConfig& config) : config_(config) {}

  /// `detected`: contacts of one frame, names not used. Returns the confirmed contacts by rising
  /// number; one that is missing in this frame keeps its position, with frames_seen 0, until it has
  /// vanished. One that was confirmed in the first frame and is missing before appear_frames
  /// vanishes at once: that frame's shape was a guess. Holds until the next call.
  const std::vector<DetectedContact>& Update(const std::vector<DetectedContact>& detected);

  /// Removes all contacts. Their names are not used again. Contacts of the next frame may be old:
  /// they are confirmed at once.
  void Forget();

 private:
  struct Track {
    DetectedContact contact;
    int number = 0;       ///< 0: not confirmed yet
    int frames_seen = 0;  ///< of all
    int frames_missing = 0;
  };

  void Associate(const std::vector<DetectedContact>& detected);
  void See(const DetectedContact& detected, Track* track) const;
  void Report();

  TrackingConfig config_;
  int last_number_ = 0;
  bool begins_ = true;         ///< no frame has come
  std::vector<Track> tracks_;  ///< in the order in which they were first seen
  Eigen::MatrixXd cost_;
  std::vector<int> detection_of_track_;  ///< -1: none
  std::vector<DetectedContact> contacts_;
};

}  // namespace palpate::perception
