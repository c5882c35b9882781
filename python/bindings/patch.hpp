// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "libs/fem/surface_patch.hpp"
#include "python/bindings/robot.hpp"

namespace palpate::python {

/// A point or patch of one robot's body: where something acts, or is observed.
struct Patch {
  std::shared_ptr<Robot> robot;
  fem::SurfacePatch surface;
};

/// A dead load.
struct Load {
  Patch patch;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// Throws InputError unless all patches are of this robot.
void RequirePatchesOf(const Robot& robot, const std::vector<Patch>& patches);
void RequireLoadsOf(const Robot& robot, const std::vector<Load>& loads);

/// palpate.Patch and palpate.Load. Before the classes that take them.
void BindPatches(pybind11::module_& module);

/// Robot.patch and Robot.marker.
Patch PatchAt(const std::shared_ptr<Robot>& robot, const DoubleArray& position_m, double radius_m);
Patch MarkerPatch(const std::shared_ptr<Robot>& robot, const std::string& marker);

}  // namespace palpate::python
