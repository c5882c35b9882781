// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/offline/forces/estimate_plan.hpp"
#include "components/offline/forces/shape_replay.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::offline {

/// Where the depth bias may come from.
struct BiasRequest {
  const experiment::Experiment& experiment;  ///< must outlive the replays
  const std::vector<PlannedRecording>& plan;
  bool is_calibrated = false;  ///< the calibration file has the bias
  int most_first_frames = 0;   ///< of a recording that may have contacts
};

/// A replay that has processed the bias frames, and what there is to say of them.
struct BiasFrames {
  std::unique_ptr<ShapeReplay> replay;
  std::vector<std::string> notes;
};

/// The bias frames are those of the contact-free recordings. That nothing touches the robot there
/// is checked: a recording that does not pass is named and not used. Where no frame is left and no
/// calibration has the bias, they are the first frames of a planned recording in which perception
/// locates no contact and which pass the check; else the bias is fitted along with the forces.
/// Throws InputError as ShapeReplay does.
BiasFrames FindBiasFrames(const BiasRequest& request,
                          const std::function<std::unique_ptr<ShapeReplay>()>& make_replay);

}  // namespace palpate::offline
