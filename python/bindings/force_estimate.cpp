// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/force_estimate.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "libs/core/index.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using force_estimation::ContactForce;
using force_estimation::ForceEstimate;

void BindContact(py::module_& module) {
  py::class_<ContactForce>(module, "ContactForce", "The force of one contact.")
      .def_readonly("name", &ContactForce::name)
      .def_property_readonly(
          "status",
          [](const ContactForce& contact) { return std::string(ToString(contact.status.code())); })
      .def_property_readonly("position_m",
                             [](const ContactForce& one) { return CopyOfVector(one.position_m); })
      .def_property_readonly("force_N",
                             [](const ContactForce& one) { return CopyOfVector(one.force_N); })
      .def_property_readonly(
          "covariance_N2",
          [](const ContactForce& one) { return CopyOfPoints(one.covariance_N2.transpose()); })
      .def_readonly("ci95_N", &ContactForce::ci95_N)
      .def_readonly("location_ci95_m", &ContactForce::location_ci95_m)
      .def_property_readonly("location_covariance_m2", [](const ContactForce& one) {
        return CopyOfPoints(one.location_covariance_m2.transpose());
      });
}

using BoundEstimate = py::class_<Estimate, EstimatePtr>;

void BindNumber(BoundEstimate& bound, const char* name, double ForceEstimate::*number) {
  bound.def_property_readonly(name, [number](const Estimate& one) { return one.forces.*number; });
}

void BindNumber(BoundEstimate& bound, const char* name, int ForceEstimate::*number) {
  bound.def_property_readonly(name, [number](const Estimate& one) { return one.forces.*number; });
}

void BindEstimateOfFrame(py::module_& module) {
  BoundEstimate bound(module, "ForceEstimate", "The forces of one frame.");
  bound
      .def_property_readonly(
          "status",
          [](const Estimate& one) { return std::string(ToString(one.forces.status.code())); })
      .def_property_readonly("message",
                             [](const Estimate& one) { return one.forces.status.message(); })
      .def_property_readonly(
          "usable",
          [](const Estimate& one) { return force_estimation::IsUsable(one.forces.status); })
      .def_property_readonly("contacts", [](const Estimate& one) { return one.forces.contacts; })
      .def_property_readonly("positions_m",
                             [](const py::object& self) {
                               return ViewOfPoints(self.cast<const Estimate&>().forces.x_m, self);
                             })
      .def_property_readonly("marker_residual_m",
                             [](const py::object& self) {
                               const auto& forces = self.cast<const Estimate&>().forces;
                               return ViewOfPoints(forces.marker_residual_m, self);
                             })
      .def_property_readonly("tension_N",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Estimate&>().tension_N, self);
                             })
      .def_property_readonly("displacement_m",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Estimate&>().displacement_m,
                                                   self);
                             })
      .def_readonly("time_s", &Estimate::time_s);
  BindNumber(bound, "t_s", &ForceEstimate::t_s);
  BindNumber(bound, "residual_rms_m", &ForceEstimate::residual_rms_m);
  BindNumber(bound, "noise_rms_m", &ForceEstimate::noise_rms_m);
  BindNumber(bound, "chi_squared", &ForceEstimate::chi_squared);
  BindNumber(bound, "degrees_of_freedom", &ForceEstimate::degrees_of_freedom);
  BindNumber(bound, "iterations", &ForceEstimate::iterations);
}

}  // namespace

EstimatePtr KeepEstimate(const ForceEstimate& forces, const Robot& robot, double time_s) {
  auto estimate = std::make_shared<Estimate>();
  estimate->forces = forces;
  estimate->time_s = time_s;
  const Eigen::Index cables = ToIndex(forces.cables.size());
  estimate->tension_N.resize(cables);
  estimate->displacement_m.resize(cables);
  for (Eigen::Index c = 0; c < cables; ++c) {
    const robot::ActuatorTraits& traits = robot.traits(At(c));
    estimate->tension_N[c] = traits.ReportedForce(forces.cables[At(c)].tension_N);
    estimate->displacement_m[c] = traits.ReportedDisplacement(forces.cables[At(c)].displacement_m);
  }
  return estimate;
}

void BindForceEstimate(py::module_& module) {
  BindContact(module);
  BindEstimateOfFrame(module);
}

}  // namespace palpate::python
