// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "components/capture/genicam/features.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::capture {

/// How the third coordinate becomes a distance (GenICam SFNC 2.7, Scan3dOutputMode).
enum class OutputMode {
  kProjectedC,         ///< z itself; x and y follow from the pixel
  kDisparityC,         ///< a disparity in px: z = f b / d
  kCalibratedAbcGrid,  ///< x, y, z themselves, one for each pixel of the image
};

/// value = raw * scale + offset, in distance units (px of a disparity).
struct CoordinateRule {
  double scale = 1.0;
  double offset = 0.0;
  bool marks_invalid = false;  ///< pixels of the raw value below have none
  double invalid_raw = 0.0;    ///< may be NaN
  bool operator==(const CoordinateRule&) const = default;
};

/// What turns the pixels of one device's range image into metres.
struct Scan3dDescription {
  OutputMode mode = OutputMode::kProjectedC;
  double distance_unit_m = 1e-3;             ///< of coordinates, > 0
  std::array<CoordinateRule, 3> coordinates; /**< A, B, C */
  rgbd::CameraModel camera;                  ///< of the image as it is sent (region taken off)
  double baseline_m = 0.0;                   ///< 0: unknown, or no stereo camera
};

/// What the user knows better than the camera. Unset: the camera's own.
struct Scan3dOverrides {
  std::optional<double> fx_px, fy_px, cx_px, cy_px;
  std::optional<double> baseline_m;
  std::optional<double> distance_unit_m;
  std::optional<double> scale_c;
  std::vector<double> distortion;  ///< k1, k2, p1, p2, k3[, k4, k5, k6]; empty: none
};

struct Scan3dReading {
  Status status;  ///< not ok: what is missing or absurd, and the setting that fixes it
  Scan3dDescription description;
  std::vector<std::string> notes;  ///< what was assumed, for a person
};

/// Reads the description of the range image of `width_px` x `height_px`, its component selected
/// already. Whatever the device says is tested: focal length in [50, 20000] px, principal point in
/// the image widened by half of it on each side, scale in [1e-9, 1e6], baseline in [5 mm, 2 m]
/// (taken in the distance unit, else in metres).
Scan3dReading ReadScan3d(Features& features, int width_px, int height_px,
                         const Scan3dOverrides& overrides);

}  // namespace palpate::capture
