// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>

#include "libs/app/version.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/equilibrium.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/patch.hpp"
#include "python/bindings/robot.hpp"

// A class is bound before what names it in a signature or a default.
PYBIND11_MODULE(_engine, module) {
  module.doc() = "The engine of palpate in C++; import palpate.";
  module.attr("__version__") = palpate::app::Version();
  palpate::python::BindErrors(module);
  palpate::python::BindPatches(module);
  palpate::python::BindEquilibrium(module);
  palpate::python::BindRobot(module);
  palpate::python::BindCompliance(module);
  palpate::python::BindSensitivity(module);
  palpate::python::BindExperiment(module);
  palpate::python::BindForceEstimate(module);
  palpate::python::BindEstimation(module);
  palpate::python::BindImageEstimator(module);
  palpate::python::BindReplay(module);
  palpate::python::BindCalibration(module);
}
