// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/pose/marker_assignment.hpp"
#include "components/calibration/pose/marker_shapes.hpp"
#include "libs/core/status.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// Poses of one camera differ by less, as a share of how far the points are apart: those of single
/// pictures are rough, those of a robot that looks alike after a turn differ by about all of it.
inline constexpr double kSamePoseShare = 0.25;

/// Points of one picture that nobody has named, and what acted on the robot then.
struct UnlabelledFrame {
  CalibrationFrame frame;              ///< its markers are yet to come
  std::vector<MarkerSighting> points;  ///< camera frame; their `marker` means nothing
};

/// Which marker each point is, in all pictures of one camera that stands still.
struct FrameLabels {
  geometry::RigidTransform T_robot_camera;        ///< rough
  std::vector<std::size_t> frames;                ///< those that agree with it, rising
  std::vector<std::vector<int>> marker_of_point;  ///< [of these frames][points]; -1: none
  std::vector<Eigen::VectorXd> tension_N;         ///< [of these frames][a] rough
};

struct FrameAssignment {
  /// kUnobservable: no picture tells which marker is which. kInvalidInput: not finite, or of a
  /// robot of another size.
  Status status;
  std::vector<FrameLabels> choices;   ///< several: the pictures alone do not tell which holds
  std::vector<std::string> left_out;  ///< pictures without an assignment, and why
};

/// AssignMarkers for each picture, whose sigma_m is that of its points and `model_sigma_m` (of the
/// model, and of where the markers sit) together. Of what is ambiguous in one picture those choices
/// go on that need the same camera pose in all; `T_rough` (nullptr: not known) leaves the nearest.
FrameAssignment AssignFrames(const MarkerShapes& shapes, const std::vector<UnlabelledFrame>& frames,
                             const geometry::RigidTransform* T_rough, double model_sigma_m = 1e-3);

/// The frames of one choice with their markers.
std::vector<CalibrationFrame> LabelledFrames(const std::vector<UnlabelledFrame>& frames,
                                             const FrameLabels& labels);

}  // namespace palpate::calibration
