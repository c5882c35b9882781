// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "components/capture/link/camera_link.hpp"
#include "components/capture/link/camera_of_setup.hpp"
#include "components/capture/stream/frame_pairing.hpp"
#include "components/capture/stream/frame_queue.hpp"

namespace palpate::capture {

struct GenicamSettings {
  LinkSettings depth;                 ///< or depth and colour in one
  std::optional<LinkSettings> color;  ///< a second device
  ColorOverrides color_overrides;
  std::size_t queue_frames = 3;
};

/// One GenICam device that sends depth and perhaps colour, or a depth and a colour device whose
/// frames are paired by time.
class GenicamSource : public FrameSource {
 public:
  explicit GenicamSource(GenicamSettings settings);
  ~GenicamSource() override;

  FramePtr Next(double timeout_s) override { return queue_.Pop(timeout_s); }
  /// Of two devices: the state of the one that is worse off, counters of both.
  SourceHealth Health() const override;

 private:
  void OnDepthSetup(const DeviceSetup& setup, double depth_unit_m);
  void OnColorSetup(const DeviceSetup& setup);
  void RebuildCamera();
  void OnDepthFrame(std::shared_ptr<SourceFrame> frame);
  void OnColorFrame(std::shared_ptr<SourceFrame> frame);
  void Publish(std::shared_ptr<SourceFrame> frame);

  GenicamSettings settings_;
  FrameQueue queue_;
  mutable std::mutex mutex_;  ///< all below, which the links' threads share
  std::optional<DeviceSetup> depth_setup_;
  std::optional<DeviceSetup> color_setup_;
  double depth_unit_m_ = 0.0;
  std::uint32_t epoch_ = 0;
  std::shared_ptr<const rgbd::RgbdCamera> camera_;
  std::optional<FramePairing> pairing_;
  std::uint64_t unpaired_before_ = 0;  ///< of pairings of earlier epochs
  std::unique_ptr<CameraLink> color_link_;
  std::unique_ptr<CameraLink> depth_link_;
};

}  // namespace palpate::capture
