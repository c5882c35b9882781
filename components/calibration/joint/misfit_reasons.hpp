// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/misfit_reason.hpp"

namespace palpate::calibration {

/// Tries mistakes one at a time: exchanged labels, a wrong pose or axes, a mirrored frame, another
/// unit or size, another modulus, one recording unlike the others. The markers of all frames are
/// registered rigidly with the model's at the equilibria under the frames' inputs, or with the
/// undeformed body where those are not reached. A mistake counts where mending it halves the
/// residual. The model is unchanged.
MisfitReasons FindMisfitReasons(robot::RobotModel& model,
                                const std::vector<CalibrationFrame>& frames,
                                const JointRequest& request);

}  // namespace palpate::calibration
