// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "components/virtual_camera/camera_faults.hpp"
#include "components/virtual_camera/noise_field.hpp"
#include "components/virtual_camera/scene_camera.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/scenario/random.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_camera {

/// Measures what the depth camera sees, with the noise of a stereo or a time-of-flight camera
/// (docs/architecture.md, "Depth noise") and its systematic errors.
class DepthSensor {
 public:
  /// `loops` must outlive this. Throws InputError for a stereo camera without a baseline, a depth
  /// unit or a noise that cannot be.
  DepthSensor(const scenario::CameraSpec& spec, const CameraFaults& faults, std::uint64_t seed,
              const kernels::Kernels& loops);

  /// The frame that follows the last one, `t_s` after the camera was switched on.
  void Measure(SceneCamera* camera, double t_s, rgbd::RangeImage* truth, rgbd::DepthImage* depth);

 private:
  void SetLaws(const scenario::CameraSpec& spec);
  void LayGain(double low_frequency_bias, double scale, std::uint64_t seed);
  void MeasureRow(const kernels::DepthRow& row) const;

  const kernels::Kernels& loops_;
  CameraFaults faults_;
  scenario::Random noise_keys_;  // one for each frame
  scenario::Random hole_keys_;   // likewise
  scenario::DepthSensor kind_;
  int width_px_;
  int height_px_;
  int stride_;
  kernels::StereoLaw stereo_ = {};
  kernels::DirectLaw direct_ = {};
  NoiseField noise_;
  std::vector<float> gain_;  // [height][stride] factor on z
  std::vector<float> cosine_;
  std::vector<float> reflection_;
  std::vector<float> scratch_;
  std::vector<std::uint16_t> depth_row_;
};

}  // namespace palpate::virtual_camera
