// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/markers/color_spots.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

constexpr int kMostColors = 100;

Eigen::Matrix3Xf Directions(const std::vector<double>& rgb) {
  if (rgb.empty() || rgb.size() % 3 != 0 || rgb.size() > 3 * kMostColors) {
    throw InputError("color_rgb has " + std::to_string(rgb.size()) +
                     " numbers; must have three for each of 1 to " + std::to_string(kMostColors) +
                     " colours");
  }
  Eigen::Matrix3Xf directions =
      Eigen::Map<const Eigen::Matrix3Xd>(rgb.data(), 3, ToIndex(rgb.size() / 3)).cast<float>();
  for (auto color : directions.colwise()) {
    const float length = color.norm();
    if (!(length > 0.0f)) throw InputError("color_rgb has black, which has no direction");
    color /= length;
  }
  return directions;
}

}  // namespace

Eigen::Vector3f ColorDirection(const std::uint8_t* rgb) {
  const Eigen::Vector3f color(rgb[0], rgb[1], rgb[2]);
  const float length = color.norm();
  return length > 0.0f ? Eigen::Vector3f(color / length) : Eigen::Vector3f::Zero();
}

ColorSpots::ColorSpots(const FiducialConfig& config, const ColorSpotsTuning& tuning)
    : tuning_{tuning},
      directions_{Directions(config.color_rgb)},
      tolerance_{static_cast<float>(config.color_tolerance)},
      min_level_{static_cast<int>(std::lround(255.0 * config.min_brightness))} {}

void ColorSpots::Classify(const std::uint8_t* rgb, std::size_t pixel) {
  if (std::max({rgb[0], rgb[1], rgb[2]}) < std::max(1, min_level_)) return;
  const Eigen::Vector3f direction = ColorDirection(rgb);
  Eigen::Index nearest = 0;
  const float distance_squared =
      (directions_.colwise() - direction).colwise().squaredNorm().minCoeff(&nearest);
  const float distance = std::sqrt(distance_squared);
  if (distance <= tolerance_) {
    color_[pixel] = static_cast<std::int8_t>(nearest);
  } else if (distance <= tuning_.near_tolerances * tolerance_) {
    near_[pixel] = static_cast<std::int8_t>(nearest);
  }
}

void ColorSpots::Mark(const RegisteredFrame& frame) {
  width_px_ = frame.color.width_px;
  height_px_ = frame.color.height_px;
  color_.assign(frame.color_known.size(), kNone);
  near_.assign(frame.color_known.size(), kNone);
  for (std::size_t i = 0; i < color_.size(); ++i) {
    if (frame.color_known[i] != 0) Classify(frame.color.values.data() + 3 * i, i);
  }
}

const std::vector<ColorSpot>& ColorSpots::Find(const RegisteredFrame& frame) {
  Mark(frame);
  spots_.clear();
  for (int v = 0; v < height_px_; ++v) {
    for (int u = 0; u < width_px_; ++u) {
      const std::int8_t color = color_[At(u, v)];
      if (color == kNone) continue;
      ColorSpot& spot = spots_.emplace_back();
      spot.color = color;
      spot.first = spot.last = {u, v};
      Gather(u, v, &spot);
    }
  }
  return spots_;
}

void ColorSpots::Take(int u_px, int v_px, ColorSpot* spot) {
  spot->pixels.push_back({u_px, v_px});
  spot->first = {std::min(spot->first.u_px, u_px), std::min(spot->first.v_px, v_px)};
  spot->last = {std::max(spot->last.u_px, u_px), std::max(spot->last.v_px, v_px)};
}

void ColorSpots::Gather(int u_px, int v_px, ColorSpot* spot) {
  const auto color = static_cast<std::int8_t>(spot->color);
  color_[At(u_px, v_px)] = kNone;
  open_.assign(1, {u_px, v_px});
  while (!open_.empty()) {
    const SpotPixel pixel = open_.back();
    open_.pop_back();
    Take(pixel.u_px, pixel.v_px, spot);
    for (int v = std::max(0, pixel.v_px - 1); v <= std::min(height_px_ - 1, pixel.v_px + 1); ++v) {
      for (int u = std::max(0, pixel.u_px - 1); u <= std::min(width_px_ - 1, pixel.u_px + 1); ++u) {
        const std::size_t at = At(u, v);
        if (color_[at] == color) {
          open_.push_back({u, v});
        } else if (near_[at] == color) {
          Take(u, v, spot);
        } else {
          continue;
        }
        color_[at] = near_[at] = kNone;
      }
    }
  }
}

}  // namespace palpate::perception
