// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/palpate/demo_data.hpp"
#include "components/view/picture/scene.hpp"

namespace palpate::command {

struct DemoResult {
  bool found = false;  ///< a force was found; else `scene` is empty
  std::string text;    ///< lines of text: force, interval, truth and their difference
  view::Scene scene;   ///< deformed body, markers, both forces
};

/// Compares the estimates of the recording with the hung weight, over its static phase, with the
/// truth. `estimates` by stamp in ns; `mesh_state_m` [3n] the model's last state.
/// Throws InputError where the data cannot be read again.
DemoResult EvaluateDemo(const DemoData& data, const std::filesystem::path& calibration,
                        const std::map<std::int64_t, force_estimation::ForceEstimate>& estimates,
                        const std::optional<Eigen::VectorXd>& mesh_state_m);

}  // namespace palpate::command
