// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <memory>

#include "components/force_estimation/force_estimate.hpp"
#include "python/bindings/robot.hpp"

namespace palpate::python {

/// The forces of one frame, as Python keeps them.
struct Estimate {
  force_estimation::ForceEstimate forces;
  Eigen::VectorXd tension_N, displacement_m;  ///< [actuators]; Pa and m3 of chambers
  double time_s = 0.0;                        ///< in C++
};
using EstimatePtr = std::shared_ptr<Estimate>;

/// A copy of what a pipeline holds until its next frame.
EstimatePtr KeepEstimate(const force_estimation::ForceEstimate& forces, const Robot& robot,
                         double time_s);

}  // namespace palpate::python
