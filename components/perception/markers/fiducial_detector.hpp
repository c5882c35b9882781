// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/perception/fiducial_config.hpp"
#include "components/perception/markers/fiducial.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::perception {

/// Finds coloured discs on the robot's surface: pixels whose colour direction is a marker's make
/// spots; of each pixel the share that is marker is unmixed from the spot's colour and that of its
/// surroundings, which gives the place to a fraction of a pixel; a bent surface fitted to the depth
/// round it gives the place in space, the size and the shape on the surface. Each frame stands for
/// itself; the same frame gives the same bits.
class FiducialDetector {
 public:
  /// Throws InputError for colours that are none, ranges without anything in them, and names that
  /// are not one for each colour.
  explicit FiducialDetector(const FiducialConfig& config);
  ~FiducialDetector();

  /// Before the first Detect.
  void SetCamera(const rgbd::RgbdCamera& camera);

  /// The result holds until the next call.
  const FiducialFrame& Detect(const rgbd::RgbdFrame& frame);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::perception
