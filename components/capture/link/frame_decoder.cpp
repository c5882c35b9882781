// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/link/frame_decoder.hpp"

#include <algorithm>
#include <string>

#include "components/capture/decode/color_decoder.hpp"

namespace palpate::capture {

namespace {

constexpr std::uint32_t kIntensityId = 1;
constexpr std::uint32_t kRangeId = 4;
constexpr std::uint32_t kConfidenceId = 6;
constexpr std::uint32_t kDisparityId = 8;

/// A 16-bit grey image counts as depth where its component says so.
bool IsDepth(const ImagePart& part) {
  const bool named = part.component_id == kRangeId || part.component_id == kDisparityId;
  return CarriesDepth(part.format) || (named && part.format == PixelFormat::kMono16);
}

bool IsColor(const ImagePart& part) {
  if (!CarriesColor(part.format) || part.component_id == kConfidenceId) return false;
  return part.format == PixelFormat::kCoord3dAbcy16 || part.component_id == kIntensityId ||
         !IsDepth(part);
}

std::string Size(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

FrameDecoder::FrameDecoder(const DeviceSetup& setup, const std::optional<double>& depth_unit_m)
    : depth_camera_(setup.scan3d.camera), color_width_px_(setup.color.width_px) {
  if (setup.depth_format == PixelFormat::kUnknown) return;
  decoder_ = std::make_unique<DepthDecoder>(
      setup.scan3d, ChooseDepthUnit(setup.scan3d, setup.depth_format, depth_unit_m));
}

Status FrameDecoder::DecodeDepth(std::span<const ImagePart> parts, SourceFrame* frame) const {
  const auto depth = std::find_if(parts.begin(), parts.end(), IsDepth);
  if (depth == parts.end()) return {StatusCode::kInvalidInput, "a frame without a depth image"};
  if (depth->width_px != depth_camera_.width_px || depth->height_px != depth_camera_.height_px) {
    return {StatusCode::kInvalidInput, "a depth image of " +
                                           Size(depth->width_px, depth->height_px) + ", not " +
                                           Size(depth_camera_.width_px, depth_camera_.height_px)};
  }
  ImagePart part = *depth;
  if (part.format == PixelFormat::kMono16) part.format = PixelFormat::kCoord3dC16;
  std::size_t valid = 0;
  const Status status = decoder_->Decode(part, &frame->images.depth, &valid);
  if (!status.ok()) return status;
  frame->facts.valid_ratio =
      static_cast<double>(valid) / static_cast<double>(frame->images.depth.values.size());
  return status;
}

Status FrameDecoder::DecodeColorPart(std::span<const ImagePart> parts, SourceFrame* frame) const {
  const auto color = std::find_if(parts.begin(), parts.end(), IsColor);
  if (color_width_px_ > 0 && color != parts.end()) {
    const Status status = DecodeColor(*color, &frame->images.color);
    if (status.ok()) return status;
  }
  frame->images.color.width_px = frame->images.color.height_px = 0;
  frame->images.color.values.clear();
  return {StatusCode::kInvalidInput, "a frame without a colour image"};
}

Status FrameDecoder::Decode(std::span<const ImagePart> parts, SourceFrame* frame) const {
  const Status color = DecodeColorPart(parts, frame);
  if (decoder_) return DecodeDepth(parts, frame);
  frame->images.depth = rgbd::DepthImage();
  return color;
}

}  // namespace palpate::capture
