// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/joint/joint_request.hpp"

namespace palpate::calibration {

/// A mistake in data or settings that explains markers which do not fit.
struct MisfitReason {
  enum class Kind { kLabels, kPose, kMirrored, kUnit, kSize, kModulus, kRecording };
  Kind kind = Kind::kPose;
  std::string text;             ///< what is wrong, by how much, and the remedy
  double residual_rms_m = 0.0;  ///< of the markers once it is mended
};

struct MisfitReasons {
  double residual_rms_m = 0.0;        ///< of the data as they are, each group registered
  std::vector<MisfitReason> reasons;  ///< those that explain the misfit, the best first

  /// One line for each, and what was not tested.
  std::string Text() const;
};

/// Tries mistakes one at a time: exchanged labels, a wrong pose or axes, a mirrored frame, another
/// unit or size, another modulus, one recording unlike the others. The markers of all frames are
/// registered rigidly with the model's at the equilibria under the frames' inputs, or with the
/// undeformed body where those are not reached. A mistake counts where mending it halves the
/// residual. The model is unchanged.
MisfitReasons FindMisfitReasons(robot::RobotModel& model,
                                const std::vector<CalibrationFrame>& frames,
                                const JointRequest& request);

}  // namespace palpate::calibration
