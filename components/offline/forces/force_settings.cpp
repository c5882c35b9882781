// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/force_settings.hpp"

namespace palpate::offline {

ForceSettings DefaultForceSettings(const experiment::Experiment& experiment, bool as_process) {
  ForceSettings settings;
  if (!as_process) settings.shape.frame_work = 0.0;
  if (experiment.depth_noise && experiment.depth_noise->subpixel_px > 0.0) {
    settings.perception.depth_subpixel_px = experiment.depth_noise->subpixel_px;
  }
  return settings;
}

}  // namespace palpate::offline
