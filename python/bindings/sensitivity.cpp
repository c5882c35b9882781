// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/robot/sensitivity/parameters.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/equilibrium.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/patch.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

/// Something that an equilibrium depends on, by the names of the robot file.
struct Parameter {
  std::string name;
  std::function<robot::ParameterPtr(const Robot&)> make;
};

Eigen::Vector3d ReadDirection(const DoubleArray& values, const std::string& name) {
  const Eigen::Vector3d direction = ReadVector3(values, name);
  if (!(direction.norm() > 0.0)) throw InputError(name + " is zero");
  return direction.normalized();
}

Parameter OfPart(const std::string& name, const std::string& part,
                 robot::ParameterPtr (*make)(int)) {
  return {name + " of " + part,
          [=](const Robot& robot) { return make(IndexOfWord(part, robot.part_names(), "part")); }};
}

Parameter OfCable(const std::string& name, const std::string& cable,
                  const std::function<robot::ParameterPtr(int)>& make) {
  return {name + " of " + cable, [=](const Robot& robot) {
            return make(IndexOfWord(cable, robot.cable_names(), "cable"));
          }};
}

using BoundParameter = py::class_<Parameter>;

void BindOfBody(BoundParameter& bound) {
  bound
      .def_static(
          "youngs_modulus",
          [](const std::string& part) {
            return OfPart("Young's modulus", part, &robot::YoungsModulus);
          },
          py::arg("part") = "body", "Pa")
      .def_static(
          "poissons_ratio",
          [](const std::string& part) {
            return OfPart("Poisson's ratio", part, &robot::PoissonsRatio);
          },
          py::arg("part") = "body")
      .def_static(
          "mass_factor",
          [] {
            return Parameter{"mass factor", [](const Robot&) { return robot::MassFactor(); }};
          })
      .def_static(
          "gravity_turn",
          [](const DoubleArray& axis) {
            const Eigen::Vector3d unit = ReadDirection(axis, "axis");
            return Parameter{"gravity turn",
                             [unit](const Robot&) { return robot::GravityTurn(unit); }};
          },
          py::arg("axis"), "rad")
      .def_static(
          "external_force",
          [](const Patch& patch, const DoubleArray& direction) {
            const Eigen::Vector3d unit = ReadDirection(direction, "direction");
            return Parameter{"external force", [patch, unit](const Robot& robot) {
                               RequirePatchesOf(robot, {patch});
                               return robot::ExternalForce(patch.surface.weights, unit);
                             }};
          },
          py::arg("patch"), py::arg("direction"), "N");
}

void BindOfCables(BoundParameter& bound) {
  bound
      .def_static(
          "cable_offset",
          [](const std::string& cable) {
            return OfCable("displacement offset", cable, &robot::CableOffset);
          },
          py::arg("cable"), "m")
      .def_static(
          "cable_gain",
          [](const std::string& cable) {
            return OfCable("displacement gain", cable,
                           [](int index) { return robot::CableGain(index); });
          },
          py::arg("cable"))
      .def_static(
          "tension_offset",
          [](const std::string& cable) {
            return OfCable("tension offset", cable,
                           [](int index) { return robot::TensionOffset(index); });
          },
          py::arg("cable"), "N")
      .def_static(
          "cable_friction",
          [](const std::string& cable) {
            return OfCable("friction coefficient", cable, &robot::CableFrictionCoefficient);
          },
          py::arg("cable"))
      .def_static(
          "cable_compliance",
          [](const std::string& cable) {
            return OfCable("compliance", cable, &robot::CableCompliance);
          },
          py::arg("cable"), "m/N")
      .def_static(
          "pull_point_move",
          [](const std::string& cable, const DoubleArray& direction) {
            const Eigen::Vector3d unit = ReadDirection(direction, "direction");
            return OfCable("pull point", cable,
                           [unit](int index) { return robot::PullPointMove(index, unit); });
          },
          py::arg("cable"), py::arg("direction"), "m");
}

/// Derivatives of one equilibrium with respect to p parameters.
struct Sensitivity {
  Eigen::MatrixXd observed_m;           ///< [3 patches x p]
  Eigen::MatrixXd positions_m;          ///< [3n x p]
  Eigen::MatrixXd length_m, tension_N;  ///< [cables x p]
};

void ReadOff(const robot::SensitivitySolver& solver,
             const std::vector<fem::InterpolationWeights>& observed, Eigen::Index coordinates,
             Sensitivity* found) {
  found->observed_m.resize(3 * static_cast<Eigen::Index>(observed.size()), solver.ParameterCount());
  if (!observed.empty()) solver.PointMotions(observed, &found->observed_m);
  found->positions_m.resize(coordinates, solver.ParameterCount());
  Eigen::VectorXd column;
  for (int p = 0; p < solver.ParameterCount(); ++p) {
    solver.NodalMotion(p, &column);
    found->positions_m.col(p) = column;
  }
  found->length_m = solver.length_m();
  found->tension_N = solver.tension_N();
}

std::shared_ptr<Sensitivity> ComputeSensitivity(const Equilibrium& equilibrium,
                                                const std::vector<Parameter>& parameters,
                                                const std::vector<Patch>& observed) {
  RequireNoGas(equilibrium);
  Robot& robot = *equilibrium.robot;
  RequirePatchesOf(robot, observed);
  std::vector<robot::ParameterPtr> made;
  for (const Parameter& parameter : parameters) made.push_back(parameter.make(robot));
  std::vector<fem::InterpolationWeights> weights;
  for (const Patch& patch : observed) weights.push_back(patch.surface.weights);
  auto found = std::make_shared<Sensitivity>();
  const Status status = robot.Use([&](robot::RobotModel& model) {
    robot::SensitivitySolver solver(model);
    Status computed = solver.Compute(equilibrium.commands, equilibrium.state, made);
    if (computed.ok()) ReadOff(solver, weights, equilibrium.state.x_m.size(), found.get());
    return computed;
  });
  if (!status.ok()) throw SolveFailure(status);
  return found;
}

/// [count x 3 x p] of a matrix [3 count x p], a view.
py::array ViewOfMotions(const Eigen::MatrixXd& motions, py::handle owner) {
  return ViewOfMatrix(motions, owner)
      .attr("T")
      .attr("reshape")(motions.cols(), motions.rows() / 3, 3)
      .attr("transpose")(1, 2, 0);
}

}  // namespace

void BindSensitivity(py::module_& module) {
  BoundParameter parameter(module, "Parameter",
                           "What an equilibrium depends on; SI units, robot frame.");
  parameter.def_readonly("name", &Parameter::name);
  BindOfBody(parameter);
  BindOfCables(parameter);
  py::class_<Sensitivity, std::shared_ptr<Sensitivity>>(
      module, "Sensitivity", "Exact derivatives of an equilibrium, per unit of each parameter.")
      .def_property_readonly("observed_m",
                             [](const py::object& self) {
                               const auto& found = self.cast<const Sensitivity&>();
                               return ViewOfMotions(found.observed_m, self);
                             })
      .def_property_readonly("positions_m",
                             [](const py::object& self) {
                               const auto& found = self.cast<const Sensitivity&>();
                               return ViewOfMotions(found.positions_m, self);
                             })
      .def_property_readonly("length_m",
                             [](const py::object& self) {
                               return ViewOfMatrix(self.cast<const Sensitivity&>().length_m, self);
                             })
      .def_property_readonly("tension_N", [](const py::object& self) {
        return ViewOfMatrix(self.cast<const Sensitivity&>().tension_N, self);
      });
  module.def("sensitivity", &ComputeSensitivity, py::arg("equilibrium"), py::arg("parameters"),
             py::kw_only(), py::arg("observed") = std::vector<Patch>());
}

}  // namespace palpate::python
