// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/perception/fiducial_config.hpp"
#include "components/perception/markers/fiducial.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::perception {

/// Finds coloured discs on the robot's surface: pixels with the colour direction of a marker form
/// spots. Unmixing each pixel's colour into those of spot and surroundings gives its share of the
/// marker, and the image position to a fraction of a pixel. A curved surface, fitted to the depth
/// around it, gives the position in space, and size and shape on the surface. Frames are
/// independent; the same frame gives the same bits.
class FiducialDetector {
 public:
  /// Throws InputError for invalid colours, empty ranges, and names that are not one for each
  /// colour.
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
