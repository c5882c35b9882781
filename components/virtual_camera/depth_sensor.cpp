// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/depth_sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::virtual_camera {

namespace {

using kernels::kRowPadding;

// Time of flight: below this amplitude (of white, perpendicular, at 1 m) nothing is measured.
constexpr float kLeastAmplitude = 0.02F;
// Without disparities, a depth edge is where z jumps by more than this share of it.
constexpr float kEdgeShare = 0.02F;
// Random lattice of the low-frequency bias: cells across and down.
constexpr int kBiasCells = 4;
constexpr std::size_t kLattice = kBiasCells + 3;  // points of a cubic spline over so many cells

void Require(bool holds, const char* name, double value, const char* rule) {
  if (holds) return;
  throw InputError(std::string(name) + " is " + FormatNumber(value) + ", must be " + rule);
}

void CheckSpec(const scenario::CameraSpec& spec) {
  const scenario::DepthNoise& noise = spec.noise;
  Require(spec.camera.depth_unit_m > 0.0, "depth_unit_m", spec.camera.depth_unit_m, "> 0");
  Require(noise.correlation_px >= 0.0 && noise.correlation_px <= 50.0, "correlation_px",
          noise.correlation_px, ">= 0 and <= 50");
  Require(noise.temporal_correlation >= 0.0 && noise.temporal_correlation < 1.0,
          "temporal_correlation", noise.temporal_correlation, ">= 0 and < 1");
  if (noise.sensor != scenario::DepthSensor::kStereo) return;
  Require(spec.camera.baseline_m > 0.0, "baseline_m", spec.camera.baseline_m,
          "> 0 for a stereo camera");
  Require(noise.disparity_step_px > 0.0, "disparity_step_px", noise.disparity_step_px, "> 0");
}

// Cubic B-spline: weights of four neighbours at t in [0, 1) between the middle two.
std::array<double, 4> SplineWeights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
}

// Smooth over the image, mean 0, root mean square 1; [height * width].
std::vector<double> SmoothField(int width_px, int height_px, std::uint64_t seed) {
  std::array<double, kLattice* kLattice> lattice = {};
  scenario::Random random(seed, "virtual_camera low-frequency bias");
  for (double& point : lattice) point = random.Uniform() - 0.5;
  std::vector<double> field;
  double sum = 0.0;
  for (int v = 0; v < height_px; ++v) {
    const double y = static_cast<double>(v) * kBiasCells / height_px;
    const std::array<double, 4> down = SplineWeights(y - std::floor(y));
    for (int u = 0; u < width_px; ++u) {
      const double x = static_cast<double>(u) * kBiasCells / width_px;
      const std::array<double, 4> across = SplineWeights(x - std::floor(x));
      double value = 0.0;
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t i = 0; i < 4; ++i) {
          const auto row = static_cast<std::size_t>(y) + j;
          const auto column = static_cast<std::size_t>(x) + i;
          value += down[j] * across[i] * lattice[row * kLattice + column];
        }
      }
      field.push_back(value);
      sum += value;
    }
  }
  const double mean = sum / static_cast<double>(field.size());
  double squares = 0.0;
  for (double& value : field) {
    value -= mean;
    squares += value * value;
  }
  const double rms = std::sqrt(squares / static_cast<double>(field.size()));
  for (double& value : field) value /= rms;
  return field;
}

}  // namespace

DepthSensor::DepthSensor(const scenario::CameraSpec& spec, const CameraFaults& faults,
                         std::uint64_t seed, const kernels::Kernels& loops)
    : loops_{loops},
      faults_{faults},
      noise_keys_{seed, "virtual_camera depth noise"},
      hole_keys_{seed, "virtual_camera depth holes"},
      kind_{spec.noise.sensor},
      width_px_{spec.camera.depth.width_px},
      height_px_{spec.camera.depth.height_px},
      stride_{(width_px_ + kRowPadding - 1) / kRowPadding * kRowPadding + 2 * kRowPadding},
      noise_{(CheckSpec(spec), width_px_), height_px_, spec.noise.correlation_px,
             spec.noise.temporal_correlation, loops} {
  SetLaws(spec);
  const bool ideal = kind_ == scenario::DepthSensor::kNone;
  LayGain(ideal ? 0.0 : spec.noise.low_frequency_bias, 1.0 + faults.depth_scale, seed);
  const auto row = static_cast<std::size_t>(stride_);
  cosine_.assign(row, 1.0F);
  reflection_.assign(row, 0.0F);
  scratch_.assign(row, 0.0F);
  depth_row_.assign(row, 0);
}

void DepthSensor::SetLaws(const scenario::CameraSpec& spec) {
  const scenario::DepthNoise& noise = spec.noise;
  const bool ideal = kind_ == scenario::DepthSensor::kNone;
  kernels::CommonLaw common = {};
  common.incidence_bias_m = static_cast<float>(faults_.incidence_bias_m);
  common.inverse_unit_1_m = static_cast<float>(1.0 / spec.camera.depth_unit_m);
  common.invalid = static_cast<std::uint16_t>(spec.camera.invalid_value);
  common.hole_ratio = ideal ? 0.0F : static_cast<float>(noise.edge_hole_ratio);
  const double flying = (ideal ? 0.0 : noise.flying_pixel_ratio) + faults_.flying_pixel_ratio;
  common.flying_ratio = static_cast<float>(flying);
  stereo_.common = direct_.common = common;
  stereo_.focal_baseline_px_m =
      static_cast<float>(spec.camera.depth.fx_px * spec.camera.baseline_m);
  stereo_.sigma_px = static_cast<float>(noise.subpixel_px);
  stereo_.periodic_bias_px = static_cast<float>(noise.periodic_bias_px);
  stereo_.step_px = static_cast<float>(noise.disparity_step_px);
  stereo_.grazing_cosine = static_cast<float>(std::cos(noise.grazing_angle_rad));
  direct_.sigma_m = ideal ? 0.0F : static_cast<float>(noise.range_sigma_m);
  direct_.least_amplitude = kLeastAmplitude;
  direct_.edge_share = kEdgeShare;
}

void DepthSensor::LayGain(double low_frequency_bias, double scale, std::uint64_t seed) {
  gain_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_px_),
               static_cast<float>(scale));
  if (low_frequency_bias == 0.0) return;
  const std::vector<double> field = SmoothField(width_px_, height_px_, seed);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const auto width = static_cast<std::size_t>(width_px_);
    gain_[i / width * static_cast<std::size_t>(stride_) + i % width] =
        static_cast<float>(scale * (1.0 + low_frequency_bias * field[i]));
  }
}

void DepthSensor::MeasureRow(const kernels::DepthRow& row) const {
  if (kind_ == scenario::DepthSensor::kStereo) {
    loops_.stereo_row(row, stereo_);
  } else {
    loops_.direct_row(row, direct_);
  }
}

void DepthSensor::Measure(SceneCamera* camera, double t_s, rgbd::RangeImage* truth,
                          rgbd::DepthImage* depth) {
  if (depth->width_px != width_px_ || depth->height_px != height_px_ || depth->empty()) {
    *depth = rgbd::DepthImage(width_px_, height_px_);
  }
  if (kind_ != scenario::DepthSensor::kNone) {
    noise_.Advance(noise_keys_.Bits());
  }
  const std::uint64_t key = hole_keys_.Bits();
  for (kernels::CommonLaw* law : {&stereo_.common, &direct_.common}) {
    law->offset_m = static_cast<float>(faults_.DriftAt(t_s));
    law->key_low = static_cast<std::uint32_t>(key);
    law->key_high = static_cast<std::uint32_t>(key >> 32);
  }
  ZBuffer& seen = camera->z_buffer();
  for (int v = 0; v < height_px_; ++v) {
    const kernels::Incidence incidence = {.cosine = cosine_.data(),
                                          .reflection = reflection_.data(),
                                          .inverse_ray_length = seen.InverseRayLength(v)};
    loops_.incidence_row(seen.Row(v), camera->palette(), incidence);
    loops_.range_row(seen.InverseZ(v), width_px_, truth->Pixel(0, v));
    const kernels::DepthRow row = {
        .width_px = width_px_,
        .v = v,
        .inverse_z = seen.InverseZ(v),
        .above = seen.InverseZ(std::max(v - 1, 0)),
        .below = seen.InverseZ(std::min(v + 1, height_px_ - 1)),
        .cosine = cosine_.data(),
        .reflection = reflection_.data(),
        .inverse_ray_length = seen.InverseRayLength(v),
        .noise = noise_.Row(v),
        .gain = gain_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_),
        .scratch = scratch_.data(),
        .depth = depth_row_.data()};
    MeasureRow(row);
    std::copy_n(depth_row_.data(), width_px_, depth->Pixel(0, v));
  }
}

}  // namespace palpate::virtual_camera
