// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "components/capture/frame_source.hpp"
#include "components/capture/node/convert.hpp"
#include "libs/dds/camera_publisher.hpp"

namespace palpate::capture {

/// Writes frame sets: depth, colour and frame info of each, one stamp for all; camera infos and
/// setup whenever the epoch changes. To be used by one thread: writing 2 MB takes up to 25 ms.
class FramePublisher {
 public:
  /// `camera`: name of a camera beside the first; empty: the first. Throws InputError for a name
  /// that is none.
  FramePublisher(dds::Participant& participant, const std::function<void()>& on_change,
                 double subpixel_sigma_px, const std::string& camera);

  /// False where DDS did not take all of it.
  bool Publish(const SourceFrame& frame, const SourceHealth& health);
  /// Waits until all reliable readers have what was sent.
  bool WaitUntilReceived(std::chrono::nanoseconds at_most) {
    return topics_.WaitUntilReceived(at_most);
  }
  std::uint32_t readers() const { return topics_.readers(); }

 private:
  dds::CameraPublisher topics_;
  dds::Message<idl::palpate_msgs::FrameInfo> info_message_;
  double subpixel_sigma_px_;
  std::shared_ptr<const rgbd::RgbdCamera> camera_;  ///< last published
  std::uint32_t epoch_ = 0;
  std::uint64_t counter_ = 0;
};

}  // namespace palpate::capture
