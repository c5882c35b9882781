// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/perception/config.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::offline {

/// The settings of forces from recordings: those of force estimation under their own names, as in
/// the file of palpate-force-estimation, and those that only images need.
struct ForceSettings {
  force_estimation::Config forces;
  perception::Config perception;
  force_estimation::ShapeConfig shape;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    forces.Visit(v);
    v("perception", perception, "Image processing: clouds and contacts");
    v("shape", shape, "Forces from the robot's shape");
  }
};

/// Defaults, with the depth noise of the experiment. `as_process`: with the work per frame of
/// palpate-force-estimation, else without a limit.
ForceSettings DefaultForceSettings(const experiment::Experiment& experiment, bool as_process);

}  // namespace palpate::offline
