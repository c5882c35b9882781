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

/// Largest distance between poses of one camera, as a share of the points' spread. Poses of single
/// frames are rough; equivalent poses of a symmetric robot differ by about the whole spread.
inline constexpr double kSamePoseShare = 0.25;

/// Unlabelled points of one frame, and its inputs.
struct UnlabelledFrame {
  CalibrationFrame frame;              ///< without markers
  std::vector<MarkerSighting> points;  ///< camera frame; `marker` has no meaning
};

/// Assignment of all frames of one camera at a fixed pose.
struct FrameLabels {
  geometry::RigidTransform T_robot_camera;        ///< rough
  std::vector<std::size_t> frames;                ///< frames that agree with it, ascending
  std::vector<std::vector<int>> marker_of_point;  ///< [of these frames][points]; -1: none
  std::vector<Eigen::VectorXd> tension_N;         ///< [of these frames][a] rough
};

struct FrameAssignment {
  /// kUnobservable: no frame has an assignment. kInvalidInput: not finite, or a robot of another
  /// size.
  Status status;
  std::vector<FrameLabels> choices;   ///< several: the frames alone are ambiguous
  std::vector<std::string> left_out;  ///< frames without an assignment, and why
};

/// AssignMarkers for each frame. Its sigma_m combines the noise of the points and `model_sigma_m`
/// (model and marker placement). Of ambiguous frames those choices remain that need one camera pose
/// in all frames; `T_rough` (nullptr: unknown) selects the nearest of them.
FrameAssignment AssignFrames(const MarkerShapes& shapes, const std::vector<UnlabelledFrame>& frames,
                             const geometry::RigidTransform* T_rough, double model_sigma_m = 1e-3);

/// The frames of one choice with labelled markers.
std::vector<CalibrationFrame> LabelledFrames(const std::vector<UnlabelledFrame>& frames,
                                             const FrameLabels& labels);

}  // namespace palpate::calibration
