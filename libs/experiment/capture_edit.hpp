// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

/// The rotation that "z,-y,x" stands for: model x is laboratory z, model y is laboratory -y, model
/// z is laboratory x; p_model = R * p_laboratory. Throws InputError where an axis is missing or
/// doubled, or where the three would mirror the data.
Eigen::Matrix3d ParseAxes(const std::string& axes);

/// Turns all positions: p -> R * p.
void Rotate(const Eigen::Matrix3d& R, CapturedMarkers& captured);

/// Gives markers other names. Throws InputError (with "did you mean") for a name that is not there,
/// and where two markers would have the same name.
void RenameMarkers(const std::map<std::string, std::string>& new_names, CapturedMarkers& captured);

/// Keeps the named markers, in that order. Throws InputError (with "did you mean") for a name that
/// is not there or is given twice.
void KeepMarkers(const std::vector<std::string>& names, CapturedMarkers& captured);

/// Keeps the frames inside the window. Throws InputError where none is left.
void CropTime(const TimeWindow& window, CapturedMarkers& captured);

/// Keeps every k-th frame so that `rate_Hz` are left. Throws InputError unless the present rate is
/// a whole multiple of it, within 1 %.
void ThinFrames(double rate_Hz, CapturedMarkers& captured);

/// Adds to every time.
void ShiftTime(double offset_s, CapturedMarkers& captured);

/// What is known of one marker's quality.
struct MarkerQuality {
  std::string name;
  int seen = 0;                            ///< frames
  int gaps = 0;                            ///< runs of frames that did not see it
  std::optional<double> residual_m;        ///< median
  std::optional<Eigen::Vector3d> noise_m;  ///< MarkerMean::deviation_m over the noise window
};

struct CaptureQuality {
  std::vector<MarkerQuality> markers;
  TimeWindow noise_window_s;
  int missing_frames = 0;  ///< that the rate promises and the times lack
};

/// Static noise is taken over `noise_window`, or, where none is given, over that half second in
/// which the markers deviate least.
CaptureQuality AssessCapture(const CapturedMarkers& captured,
                             const std::optional<TimeWindow>& noise_window);

}  // namespace palpate::experiment
