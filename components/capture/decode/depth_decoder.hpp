// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "components/capture/decode/image_part.hpp"
#include "components/capture/genicam/scan3d_description.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/image.hpp"

namespace palpate::capture {

/// Turns the pixels of one device into z in steps of `depth_unit_m`. A pixel without a value, with
/// z <= 0, or beyond 65535 steps becomes 0. Holds tables for 16-bit coordinates; decoding allocates
/// nothing where the image has its size already.
class DepthDecoder {
 public:
  DepthDecoder(const Scan3dDescription& description, double depth_unit_m);

  double depth_unit_m() const { return depth_unit_m_; }

  /// Ok, or kInvalidInput with the reason; then the image is not to be used. `valid_pixels`: those
  /// with a value. Reads no byte beyond the part's size.
  Status Decode(const ImagePart& part, rgbd::DepthImage* image, std::size_t* valid_pixels) const;

 private:
  std::uint16_t Steps(double raw) const;
  bool Invalid(std::size_t axis, double raw) const;
  template <typename Scalar>
  std::uint16_t PixelOf(const std::uint8_t* pixel, int scalars) const;
  template <typename Scalar>
  void DecodeRows(const ImagePart& part, int scalars, std::size_t step, rgbd::DepthImage* image,
                  std::size_t* valid_pixels) const;

  Scan3dDescription description_;
  double depth_unit_m_;
  std::vector<std::uint16_t> steps_of_raw_;  ///< [65536]
};

/// The depth unit to send: `wanted_m` where given; else one step of a 16-bit z with no offset; else
/// 0.1 mm.
double ChooseDepthUnit(const Scan3dDescription& description, PixelFormat format,
                       const std::optional<double>& wanted_m);

}  // namespace palpate::capture
