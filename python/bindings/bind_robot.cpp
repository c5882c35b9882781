// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/robot_description.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/equilibrium.hpp"
#include "python/bindings/patch.hpp"
#include "python/bindings/robot.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using RobotPtr = std::shared_ptr<Robot>;
using RobotClass = py::class_<Robot, RobotPtr>;

RobotPtr LoadRobot(const std::string& robot, const std::string& calibration,
                   const std::string& solver, int threads) {
  if (threads < 1 || threads > 64) {
    throw InputError("threads is " + std::to_string(threads) + ": 1 to 64 are allowed");
  }
  const py::gil_scoped_release released;
  return std::make_shared<Robot>(robot, calibration,
                                 fem::SolverSettings{.solver = solver, .threads = threads});
}

/// [triangles x 3] of the outer surface, for drawing.
py::array Triangles(const Robot& robot) {
  const Eigen::Matrix3Xi triangles = robot.body().boundary.DrawnTriangles();
  return py::array_t<int>({triangles.cols(), Eigen::Index{3}}, triangles.data());
}

void BindBody(RobotClass& bound) {
  bound.def_property_readonly("name", [](const Robot& robot) { return robot.body().name; })
      .def_property_readonly("file", &Robot::file)
      .def_property_readonly("mesh_hash", [](const Robot& robot) { return robot.body().mesh_hash; })
      .def_property_readonly(
          "element",
          [](const Robot& robot) {
            return std::string(robot.body().mesh.cells.rows() == 10 ? "tet10" : "tet4");
          })
      .def_property_readonly("cables", &Robot::cable_names)
      .def_property_readonly("markers", &Robot::marker_names)
      .def_property_readonly("parts", &Robot::part_names)
      .def_property_readonly("notes", [](const Robot& robot) { return robot.body().notes; })
      .def_property_readonly("warnings", [](const Robot& robot) { return robot.body().warnings; })
      .def_property_readonly("rest_m",
                             [](const py::object& self) {
                               const auto& robot = self.cast<const Robot&>();
                               return ViewOfColumns(robot.body().mesh.nodes_m, self);
                             })
      .def_property_readonly("cells",
                             [](const py::object& self) {
                               const auto& robot = self.cast<const Robot&>();
                               return ViewOfColumns(robot.body().mesh.cells, self);
                             })
      .def_property_readonly("triangles", &Triangles)
      .def("patch", &PatchAt, py::arg("position_m"), py::arg("radius_m") = 0.0)
      .def("marker", &MarkerPatch, py::arg("name"));
}

py::array Gravity(Robot& robot) {
  const Eigen::Vector3d gravity_m_s2 =
      robot.Use([](const robot::RobotModel& model) { return model.gravity_m_s2(); });
  return CopyOfVector(gravity_m_s2);
}

void SetGravity(Robot& robot, const DoubleArray& gravity_m_s2) {
  const Eigen::Vector3d value = ReadVector3(gravity_m_s2, "gravity_m_s2");
  robot.Use([&](robot::RobotModel& model) { model.SetGravity(value); });
}

double YoungsModulus(Robot& robot, const std::string& part) {
  const int material = IndexOfWord(part, robot.part_names(), "part");
  return robot.Use([&](const robot::RobotModel& model) {
    return model.body().materials[At(material)].youngs_modulus_Pa;
  });
}

void SetYoungsModulus(Robot& robot, const std::string& part, double youngs_modulus_Pa) {
  const int material = robot.MaterialWithElements(part);
  if (!(youngs_modulus_Pa > 0.0) || std::isinf(youngs_modulus_Pa)) {
    throw InputError("youngs_modulus_Pa is " + std::to_string(youngs_modulus_Pa) +
                     ": more than 0 is allowed");
  }
  robot.Use([&](robot::RobotModel& model) { model.SetYoungsModulus(material, youngs_modulus_Pa); });
}

double PoissonsRatio(Robot& robot, const std::string& part) {
  const int material = IndexOfWord(part, robot.part_names(), "part");
  return robot.Use([&](const robot::RobotModel& model) {
    return model.body().materials[At(material)].poissons_ratio;
  });
}

void SetPoissonsRatio(Robot& robot, const std::string& part, double poissons_ratio) {
  const int material = robot.MaterialWithElements(part);
  if (!(poissons_ratio > -1.0 && poissons_ratio <= robot::kLargestPoissonsRatio)) {
    throw InputError("poissons_ratio is " + std::to_string(poissons_ratio) +
                     ": more than -1, at most " + FormatNumber(robot::kLargestPoissonsRatio) +
                     " is allowed");
  }
  robot.Use([&](robot::RobotModel& model) { model.SetPoissonsRatio(material, poissons_ratio); });
}

void SetDrive(Robot& robot, const std::string& cable, double offset_m, double gain) {
  const int index = IndexOfWord(cable, robot.cable_names(), "cable");
  const robot::DriveCalibration drive{.offset_m = RequireFinite(offset_m, "offset_m"),
                                      .gain = RequireFinite(gain, "gain")};
  robot.Use([&](robot::RobotModel& model) { model.SetDrive(index, drive); });
}

void BindModel(RobotClass& bound) {
  bound.def_property("gravity_m_s2", &Gravity, &SetGravity)
      .def("youngs_modulus_Pa", &YoungsModulus, py::arg("part") = "body")
      .def("set_youngs_modulus", &SetYoungsModulus, py::arg("part"), py::arg("youngs_modulus_Pa"))
      .def("poissons_ratio", &PoissonsRatio, py::arg("part") = "body")
      .def("set_poissons_ratio", &SetPoissonsRatio, py::arg("part"), py::arg("poissons_ratio"))
      .def("set_drive", &SetDrive, py::arg("cable"), py::arg("offset_m") = 0.0,
           py::arg("gain") = 0.0)
      .def(
          "solve",
          [](const RobotPtr& robot, CableValues displacement_m, CableValues tension_N,
             CableValues air_m3, std::vector<Load> loads, std::shared_ptr<Equilibrium> start,
             const std::string& cable_input) {
            return Solve(robot, {std::move(displacement_m), std::move(tension_N), std::move(air_m3),
                                 std::move(loads), std::move(start), ReadCableInput(cable_input)});
          },
          py::arg("displacement_m") = py::none(), py::arg("tension_N") = py::none(), py::kw_only(),
          py::arg("air_m3") = py::none(), py::arg("loads") = std::vector<Load>(),
          py::arg("start") = py::none(), py::arg("cable_input") = "displacement");
}

}  // namespace

void BindRobot(py::module_& module) {
  RobotClass bound(module, "Robot", "A robot file with its finite-element model.");
  bound.def(py::init(&LoadRobot), py::arg("robot"), py::arg("calibration") = "", py::kw_only(),
            py::arg("solver") = fem::SolverSettings().solver,
            py::arg("threads") = fem::SolverSettings().threads);
  BindBody(bound);
  BindModel(bound);
}

}  // namespace palpate::python
