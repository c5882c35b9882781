// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/contact_config.hpp"
#include "components/perception/observation.hpp"

namespace palpate::perception {

/// Gives the contacts of each frame the names that they had before. Contacts and tracks are brought
/// together so that the sum of the squared distances is least, each within the gate. Of two
/// contacts that merge the one that was seen last keeps the name; when they part within
/// vanish_frames the other gets its name back, later a new one.
class ContactTracker {
 public:
  explicit ContactTracker(const TrackingConfig& config) : config_(config) {}

  /// `detected`: contacts of one frame, names not used. Gives those that are there by now, by
  /// rising number; a contact that is missing in this frame stays where it was, with frames_seen 0,
  /// until it has vanished. Holds until the next call.
  const std::vector<DetectedContact>& Update(const std::vector<DetectedContact>& detected);

  /// All contacts are gone. Their names are not given again. What the next frame shows may have
  /// been there for long: it is there at once.
  void Forget();

 private:
  struct Track {
    DetectedContact contact;
    int number = 0;  ///< 0: not there yet
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
