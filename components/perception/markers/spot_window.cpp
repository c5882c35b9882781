// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/markers/spot_window.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::perception {

namespace {

Eigen::Vector3d Direction(const Eigen::Vector3d& color) { return color.stableNormalized(); }

/// How many steps each pixel of a box is from those that are 0 now; none is farther than `most`.
void Spread(int width, int height, int most, std::vector<int>* distance) {
  const auto at = [width](int u, int v) { return static_cast<std::size_t>(v * width + u); };
  for (int step = 1; step <= most; ++step) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if ((*distance)[at(u, v)] != step - 1) continue;
        for (int b = std::max(0, v - 1); b <= std::min(height - 1, v + 1); ++b) {
          for (int a = std::max(0, u - 1); a <= std::min(width - 1, u + 1); ++a) {
            (*distance)[at(a, b)] = std::min((*distance)[at(a, b)], step);
          }
        }
      }
    }
  }
}

/// Median of the colours around the spot.
bool SurroundingColor(const std::vector<char>& on_surface, const SpotWindow& window,
                      const SpotWindowTuning& tuning, Eigen::Vector3d* around) {
  std::vector<double> channel[3];
  for (std::size_t i = 0; i < window.pixels.size(); ++i) {
    const SpotWindow::Pixel& pixel = window.pixels[i];
    const bool rim =
        pixel.distance_px > tuning.spot_reach_px && pixel.distance_px <= tuning.rim_end_px;
    if (!rim || !pixel.color_known || on_surface[i] == 0) continue;
    for (int k = 0; k < 3; ++k) channel[k].push_back(pixel.rgb[k]);
  }
  if (channel[0].size() < tuning.least_rim_px) return false;
  for (int k = 0; k < 3; ++k) (*around)[k] = UpperMedian(channel[k]);
  return true;
}

/// Pixels = amounts * (marker, around), by least squares.
void SetShares(const SpotColors& colors, const SpotWindowTuning& tuning, SpotWindow* window) {
  Eigen::Matrix<double, 3, 2> mix;
  mix << colors.marker, colors.around;
  const bool dark = colors.around.norm() < tuning.dark_share * colors.marker.norm();
  const Eigen::Matrix2d gram = mix.transpose() * mix;
  const Eigen::Matrix2d inverse =
      Eigen::Matrix2d{{gram(1, 1), -gram(0, 1)}, {-gram(1, 0), gram(0, 0)}} /
      std::max(gram(0, 0) * gram(1, 1) - gram(0, 1) * gram(1, 0), 1e-9);
  for (SpotWindow::Pixel& pixel : window->pixels) {
    const Eigen::Vector2d amounts = inverse * (mix.transpose() * pixel.rgb);
    const double alone = colors.marker.dot(pixel.rgb) / colors.marker.squaredNorm();
    const double share = dark ? alone : amounts[0] / std::max(amounts.sum(), 0.2);
    pixel.share = std::clamp(share, -tuning.share_slack, 1.0 + tuning.share_slack);
  }
}

/// Mean colour of the pixels with the largest shares.
Eigen::Vector3d PureColor(const SpotWindow& window, double pure_share) {
  double most = 0.0;
  const auto counts = [](const SpotWindow::Pixel& pixel) {
    return pixel.distance_px == 0 && pixel.color_known;
  };
  for (const SpotWindow::Pixel& pixel : window.pixels) {
    if (counts(pixel)) most = std::max(most, pixel.share);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const SpotWindow::Pixel& pixel : window.pixels) {
    if (!counts(pixel) || pixel.share < pure_share * most) continue;
    sum += pixel.rgb;
    count += 1.0;
  }
  return sum / std::max(1.0, count);
}

double RimNoise(const std::vector<char>& on_surface, const SpotWindow& window,
                const SpotWindowTuning& tuning) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < window.pixels.size(); ++i) {
    const SpotWindow::Pixel& pixel = window.pixels[i];
    if (pixel.distance_px <= tuning.spot_reach_px || pixel.distance_px > tuning.rim_end_px)
      continue;
    if (!pixel.color_known || on_surface[i] == 0) continue;
    squares += pixel.share * pixel.share;
    count += 1.0;
  }
  return std::sqrt(squares / std::max(1.0, count));
}

/// A pixel of unknown colour takes that of its neighbours.
void FillUnknown(SpotWindow* window) {
  for (SpotWindow::Pixel& pixel : window->pixels) {
    if (pixel.color_known) continue;
    double sum = 0.0, count = 0.0;
    for (const SpotWindow::Pixel& other : window->pixels) {
      const bool next = (other.at_px - pixel.at_px).cwiseAbs().maxCoeff() < 1.5;
      if (!next || !other.color_known) continue;
      sum += other.share;
      count += 1.0;
    }
    pixel.share = sum / std::max(1.0, count);
  }
}

}  // namespace

bool SpotWindow::Lay(const ColorSpot& spot, int reach_px, const RegisteredFrame& frame,
                     const Registration& registration) {
  pixels.clear();
  const int u_begin = spot.first.u_px - reach_px, v_begin = spot.first.v_px - reach_px;
  const int u_end = spot.last.u_px + reach_px + 1, v_end = spot.last.v_px + reach_px + 1;
  if (u_begin < 0 || v_begin < 0) return false;
  if (u_end > frame.z_m.width_px || v_end > frame.z_m.height_px) return false;
  const int width = u_end - u_begin, height = v_end - v_begin;
  std::vector<int> distance(static_cast<std::size_t>(width * height), reach_px + 1);
  for (const SpotPixel& pixel : spot.pixels) {
    distance[At((pixel.v_px - v_begin) * width + pixel.u_px - u_begin)] = 0;
  }
  Spread(width, height, reach_px, &distance);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] > reach_px) continue;
    const int u = u_begin + static_cast<int>(i) % width;
    const int v = v_begin + static_cast<int>(i) / width;
    const std::uint8_t* rgb = frame.color.Pixel(u, v);
    Pixel& pixel = pixels.emplace_back();
    pixel.at_px = {u, v};
    pixel.ray = registration.Ray(u, v).head<2>().cast<double>();
    pixel.z_m = static_cast<double>(*frame.z_m.Pixel(u, v));
    pixel.rgb = {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                 static_cast<double>(rgb[2])};
    pixel.color_known = frame.color_known[At(v * frame.z_m.width_px + u)] != 0;
    pixel.distance_px = distance[i];
  }
  return true;
}

bool Unmix(const std::vector<char>& on_surface, SpotWindow* window, SpotColors* colors,
           const SpotWindowTuning& tuning) {
  if (!SurroundingColor(on_surface, *window, tuning, &colors->around)) return false;
  for (SpotWindow::Pixel& pixel : window->pixels) pixel.share = pixel.distance_px == 0 ? 1.0 : 0.0;
  for (int round = 0; round < tuning.rounds; ++round) {
    colors->marker = PureColor(*window, tuning.pure_share);
    SetShares(*colors, tuning, window);
  }
  colors->contrast = (Direction(colors->marker) - Direction(colors->around)).norm();
  colors->share_sigma = RimNoise(on_surface, *window, tuning);
  FillUnknown(window);
  return true;
}

}  // namespace palpate::perception
