// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/compliance.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <vector>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/equilibrium.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/patch.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

/// The matrices of robot::Compliance, which is bound to the state of the model.
struct ComplianceMatrices {
  Eigen::MatrixXd W_ea, W_ef, W_aa, W_af;
  Eigen::VectorXd delta_e_free_m, delta_a_free_m;
};

std::vector<fem::InterpolationWeights> WeightsOf(const std::vector<Patch>& patches) {
  std::vector<fem::InterpolationWeights> weights;
  for (const Patch& patch : patches) weights.push_back(patch.surface.weights);
  return weights;
}

/// x, y and z at each.
std::vector<robot::ForceDirection> DirectionsOf(const std::vector<Patch>& patches) {
  std::vector<robot::ForceDirection> directions;
  for (const Patch& patch : patches) {
    for (int axis = 0; axis < 3; ++axis) {
      directions.push_back({patch.surface.weights, Eigen::Vector3d::Unit(axis)});
    }
  }
  return directions;
}

std::shared_ptr<ComplianceMatrices> ComputeCompliance(const Equilibrium& equilibrium,
                                                      const std::vector<Patch>& observed,
                                                      const std::vector<Patch>& loaded) {
  RequireNoGas(equilibrium);
  Robot& robot = *equilibrium.robot;
  RequirePatchesOf(robot, observed);
  RequirePatchesOf(robot, loaded);
  auto found = std::make_shared<ComplianceMatrices>();
  const fem::StaticState& state = equilibrium.state;
  const Status status = robot.Use([&](robot::RobotModel& model) {
    fem::Linearisation& linearisation = model.linearisation();
    Status updated =
        linearisation.Update(state.x_m, state.multipliers_N, state.loads.external_force_N);
    if (!updated.ok()) return updated;
    robot::Compliance compliance(linearisation, robot::RowsOfPoints(WeightsOf(observed)));
    compliance.SetForces(DirectionsOf(loaded));
    const auto forces = static_cast<Eigen::Index>(compliance.forces().size());
    compliance.Compute(state.x_m, model.actuator_rest_m(), state.multipliers_N,
                       Eigen::VectorXd::Zero(forces));
    *found = {compliance.W_ea(), compliance.W_ef(),           compliance.W_aa(),
              compliance.W_af(), compliance.delta_e_free_m(), compliance.delta_a_free_m()};
    return updated;
  });
  if (!status.ok()) throw SolveFailure(status);
  return found;
}

using BoundCompliance = py::class_<ComplianceMatrices, std::shared_ptr<ComplianceMatrices>>;

void BindMatrix(BoundCompliance& bound, const char* name,
                Eigen::MatrixXd ComplianceMatrices::*matrix) {
  bound.def_property_readonly(name, [matrix](const py::object& self) {
    return ViewOfMatrix(self.cast<const ComplianceMatrices&>().*matrix, self);
  });
}

void BindVector(BoundCompliance& bound, const char* name,
                Eigen::VectorXd ComplianceMatrices::*vector) {
  bound.def_property_readonly(name, [vector](const py::object& self) {
    return ViewOfVector(self.cast<const ComplianceMatrices&>().*vector, self);
  });
}

}  // namespace

void BindCompliance(py::module_& module) {
  BoundCompliance bound(module, "Compliance",
                        "Compliances about one equilibrium, m/N: paper, eqs. (3)-(5).");
  BindMatrix(bound, "W_ea", &ComplianceMatrices::W_ea);
  BindMatrix(bound, "W_ef", &ComplianceMatrices::W_ef);
  BindMatrix(bound, "W_aa", &ComplianceMatrices::W_aa);
  BindMatrix(bound, "W_af", &ComplianceMatrices::W_af);
  BindVector(bound, "delta_e_free_m", &ComplianceMatrices::delta_e_free_m);
  BindVector(bound, "delta_a_free_m", &ComplianceMatrices::delta_a_free_m);
  module.def("compliance", &ComputeCompliance, py::arg("equilibrium"), py::kw_only(),
             py::arg("observed") = std::vector<Patch>(), py::arg("loaded") = std::vector<Patch>());
}

}  // namespace palpate::python
