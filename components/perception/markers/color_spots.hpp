// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/perception/fiducial_config.hpp"
#include "components/perception/registered_frame.hpp"

namespace palpate::perception {

struct SpotPixel {
  int u_px = 0;
  int v_px = 0;
};

/// Neighbouring pixels of one of the markers' colours, and those next to them of a similar colour:
/// blur leaves few pixels of a small marker's own colour.
struct ColorSpot {
  int color = 0;
  std::vector<SpotPixel> pixels;
  SpotPixel first;  ///< bounds, both within
  SpotPixel last;
};

/// Colour as a direction; zero where it is black.
Eigen::Vector3f ColorDirection(const std::uint8_t* rgb);

struct ColorSpotsTuning {
  /// Distance of a similar colour from a marker's, in tolerances. Larger: more pixels of small
  /// markers, and of their surroundings.
  float near_tolerances = 1.6f;
};

/// Finds spots of the markers' colours in an image.
class ColorSpots {
 public:
  /// Throws InputError where color_rgb is not a list of colours.
  explicit ColorSpots(const FiducialConfig& config, const ColorSpotsTuning& tuning = {});

  /// From the top of the image to its bottom. Holds until the next call.
  const std::vector<ColorSpot>& Find(const RegisteredFrame& frame);

 private:
  static constexpr std::int8_t kNone = -1;

  void Mark(const RegisteredFrame& frame);
  void Classify(const std::uint8_t* rgb, std::size_t pixel);
  void Gather(int u_px, int v_px, ColorSpot* spot);
  void Take(int u_px, int v_px, ColorSpot* spot);
  std::size_t At(int u_px, int v_px) const {
    return static_cast<std::size_t>(v_px) * static_cast<std::size_t>(width_px_) +
           static_cast<std::size_t>(u_px);
  }

  ColorSpotsTuning tuning_;
  Eigen::Matrix3Xf directions_;  ///< [3 x colours]
  float tolerance_;
  int min_level_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::int8_t> color_;  ///< [pixels] kNone once gathered
  std::vector<std::int8_t> near_;   ///< [pixels] likewise, of pixels of a similar colour
  std::vector<SpotPixel> open_;
  std::vector<ColorSpot> spots_;
};

}  // namespace palpate::perception
