// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

/// The parts of the module that other parts do not include.
namespace palpate::python {

void BindCompliance(pybind11::module_& module);
void BindSensitivity(pybind11::module_& module);
void BindExperiment(pybind11::module_& module);
void BindForceEstimate(pybind11::module_& module);
void BindImageEstimator(pybind11::module_& module);
void BindReplay(pybind11::module_& module);
void BindEstimation(pybind11::module_& module);
void BindCalibration(pybind11::module_& module);

}  // namespace palpate::python
