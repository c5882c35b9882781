// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "components/player/experiment_player.hpp"
#include "libs/dds/camera_publisher.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::player {

/// Plays the images of an experiment as a camera of the folder's name would send them. Each
/// recording, and each time that one begins again, is an epoch.
class ImagePublisher {
 public:
  /// `camera`: name of a camera beside the first; empty: the first.
  ImagePublisher(dds::Participant& participant, const experiment::Experiment& experiment,
                 const std::function<void()>& on_change, const std::string& camera = {});

  /// Reads and sends the frame set of an event that has images; false where DDS did not take all
  /// of it. Throws InputError where an image cannot be read.
  [[nodiscard]] bool Publish(const ImageSet& images, std::int64_t stamp_ns);

  const std::string& device() const { return identity_.device; }
  const std::string& depth_topic() const { return camera_.depth_topic(); }
  bool is_read() const { return camera_.is_read(); }
  std::uint32_t readers() const { return camera_.readers(); }
  [[nodiscard]] bool WaitUntilReceived(std::chrono::nanoseconds at_most) {
    return camera_.WaitUntilReceived(at_most);
  }

 private:
  dds::CameraPublisher camera_;
  dds::CameraIdentity identity_;
  ImageSet last_;
  std::uint64_t counter_ = 0;
  rgbd::RgbdFrame frame_;
};

}  // namespace palpate::player
