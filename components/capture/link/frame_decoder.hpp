// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>
#include <span>

#include "components/capture/decode/depth_decoder.hpp"
#include "components/capture/frame_source.hpp"
#include "components/capture/genicam/device_setup.hpp"

namespace palpate::capture {

/// Turns the parts of one buffer into depth and colour, for one configuration of a device.
class FrameDecoder {
 public:
  FrameDecoder(const DeviceSetup& setup, const std::optional<double>& depth_unit_m);

  double depth_unit_m() const { return decoder_ ? decoder_->depth_unit_m() : 0.0; }

  /// Fills images and valid ratio. Not ok where the depth is missing, undecodable or of another
  /// size than the camera was configured for; a missing or broken colour image leaves an empty one.
  Status Decode(std::span<const ImagePart> parts, SourceFrame* frame) const;

 private:
  Status DecodeDepth(std::span<const ImagePart> parts, SourceFrame* frame) const;
  Status DecodeColorPart(std::span<const ImagePart> parts, SourceFrame* frame) const;

  std::unique_ptr<DepthDecoder> decoder_;  ///< none: a colour camera
  rgbd::CameraModel depth_camera_;
  int color_width_px_;
};

}  // namespace palpate::capture
