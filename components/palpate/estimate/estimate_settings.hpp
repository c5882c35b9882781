// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/perception/config.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The settings of `palpate estimate`: those of force estimation under their own names, as in the
/// file of palpate-force-estimation, and those that only images need.
struct EstimateSettings {
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

/// Defaults, the depth noise of the experiment, `file` (empty: none), `overrides`
/// (KEY=VALUE), and `contacts` added to the settings' own; later ones override. Throws InputError.
/// `as_process`: with the work per frame of palpate-force-estimation, else without a limit.
EstimateSettings ReadEstimateSettings(const experiment::Experiment& experiment,
                                      const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides,
                                      const std::vector<std::string>& contacts,
                                      bool as_process = false);

}  // namespace palpate::command
