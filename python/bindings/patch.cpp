// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/patch.hpp"

#include <pybind11/stl.h>

#include <cmath>
#include <string>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

double Diagonal_m(const robot::RobotBody& body) {
  const Eigen::Matrix3Xd& nodes_m = body.mesh.nodes_m;
  return (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).norm();
}

}  // namespace

void RequirePatchesOf(const Robot& robot, const std::vector<Patch>& patches) {
  for (const Patch& patch : patches) {
    if (patch.robot.get() != &robot) throw InputError("a patch is of another robot");
  }
}

void RequireLoadsOf(const Robot& robot, const std::vector<Load>& loads) {
  for (const Load& load : loads) RequirePatchesOf(robot, {load.patch});
}

Patch PatchAt(const std::shared_ptr<Robot>& robot, const DoubleArray& position_m, double radius_m) {
  const Eigen::Vector3d position = ReadVector3(position_m, "position_m");
  if (!(radius_m >= 0.0) || !std::isfinite(radius_m)) {
    throw InputError("radius_m is " + std::to_string(radius_m) + ": at least 0 is allowed");
  }
  Patch patch{robot, robot->Use([&](const robot::RobotModel& model) {
                return model.Patch(position, radius_m);
              })};
  const double farthest_m = 0.5 * Diagonal_m(robot->body());
  if (patch.surface.distance_m > farthest_m) {
    throw InputError("the patch is " + FormatNumber(patch.surface.distance_m) +
                     " m from the body; at most " + FormatNumber(farthest_m) +
                     " m, half its diagonal, are allowed");
  }
  return patch;
}

Patch MarkerPatch(const std::shared_ptr<Robot>& robot, const std::string& marker) {
  const int index = IndexOfWord(marker, robot->marker_names(), "marker");
  const fem::BodyPoint& point = robot->body().markers[At(index)].point;
  Patch patch{robot, {}};
  patch.surface.weights = point.weights;
  patch.surface.centre_m = point.rest_m;
  patch.surface.distance_m = point.distance_m;
  return patch;
}

void BindPatches(py::module_& module) {
  py::class_<Patch>(module, "Patch", "A point or patch of a robot's body.")
      .def_property_readonly(
          "centre_m", [](const Patch& patch) { return CopyOfVector(patch.surface.centre_m); })
      .def_property_readonly("normal",
                             [](const Patch& patch) { return CopyOfVector(patch.surface.normal); })
      .def_property_readonly("area_m2", [](const Patch& patch) { return patch.surface.area_m2; })
      .def_property_readonly("distance_m",
                             [](const Patch& patch) { return patch.surface.distance_m; })
      .def_property_readonly("nodes",
                             [](const Patch& patch) { return patch.surface.weights.nodes; })
      .def_property_readonly("weights",
                             [](const Patch& patch) { return patch.surface.weights.weights; });
  py::class_<Load>(module, "Load", "A dead load: its direction stays as the body moves.")
      .def(py::init([](const Patch& patch, const DoubleArray& force_N) {
             return Load{patch, ReadVector3(force_N, "force_N")};
           }),
           py::arg("patch"), py::arg("force_N"))
      .def_readonly("patch", &Load::patch)
      .def_property_readonly("force_N",
                             [](const Load& load) { return CopyOfVector(load.force_N); });
}

}  // namespace palpate::python
