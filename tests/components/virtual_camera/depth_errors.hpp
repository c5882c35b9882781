// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cmath>
#include <vector>

#include "components/virtual_camera/virtual_camera.hpp"

namespace palpate::virtual_camera {

inline double DepthAt(const rgbd::RgbdFrame& frame, const scenario::Scenario& scenario, int u,
                      int v) {
  return *frame.depth.Pixel(u, v) * scenario.camera->camera.depth_unit_m;
}

inline bool IsHole(const rgbd::RgbdFrame& frame, int u, int v) {
  return *frame.depth.Pixel(u, v) == 0;
}

struct Moments {
  double mean = 0.0;
  double sigma = 0.0;
};
inline Moments MomentsOf(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.mean += value;
  moments.mean /= static_cast<double>(values.size());
  for (const double value : values) moments.sigma += std::pow(value - moments.mean, 2);
  moments.sigma = std::sqrt(moments.sigma / static_cast<double>(values.size()));
  return moments;
}

inline double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments of_a = MomentsOf(a);
  const Moments of_b = MomentsOf(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - of_a.mean) * (b[i] - of_b.mean);
  return sum / static_cast<double>(a.size()) / (of_a.sigma * of_b.sigma);
}

}  // namespace palpate::virtual_camera
