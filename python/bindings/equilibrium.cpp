// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/equilibrium.hpp"

#include <cstdint>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/interrupts.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

/// Asks for interrupts in each Newton iteration while it lives.
class WatchedSolver {
 public:
  WatchedSolver(robot::RobotModel& model, Interrupts& interrupts) : solver_(model.static_solver()) {
    solver_.SetObserver(
        [&interrupts](const fem::StaticResult&) { return !interrupts.Requested(); });
  }
  ~WatchedSolver() { solver_.SetObserver({}); }
  WatchedSolver(const WatchedSolver&) = delete;
  WatchedSolver& operator=(const WatchedSolver&) = delete;

 private:
  fem::StaticSolver& solver_;
};

void ReadOff(const robot::RobotModel& model, Equilibrium* found) {
  const int cables = model.ActuatorCount();
  found->tension_N.resize(cables);
  found->displacement_m.resize(cables);
  found->length_m.resize(cables);
  for (int c = 0; c < cables; ++c) {
    const robot::ActuatorState cable = model.StateOfActuator(c, found->state);
    found->tension_N[c] = model.traits(c).ReportedForce(cable.tension_N);
    found->displacement_m[c] = model.traits(c).ReportedDisplacement(cable.displacement_m);
    found->length_m[c] = cable.length_m;
  }
  const auto& markers = model.body().markers;
  found->markers_m.resize(3, static_cast<Eigen::Index>(markers.size()));
  for (Eigen::Index m = 0; m < found->markers_m.cols(); ++m) {
    const auto& point = markers[static_cast<std::size_t>(m)].point;
    found->markers_m.col(m) = point.weights.Position(found->state.x_m);
  }
}

py::array PositionOf(const Equilibrium& equilibrium, const Patch& patch) {
  RequirePatchesOf(*equilibrium.robot, {patch});
  return CopyOfVector(patch.surface.weights.Position(equilibrium.state.x_m));
}

void BindResults(py::class_<Equilibrium, std::shared_ptr<Equilibrium>>& bound) {
  bound
      .def_property_readonly("positions_m",
                             [](const py::object& self) {
                               return ViewOfPoints(self.cast<const Equilibrium&>().state.x_m, self);
                             })
      .def_property_readonly("markers_m",
                             [](const py::object& self) {
                               return ViewOfColumns(self.cast<const Equilibrium&>().markers_m,
                                                    self);
                             })
      .def_property_readonly("tension_N",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Equilibrium&>().tension_N, self);
                             })
      .def_property_readonly("displacement_m",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Equilibrium&>().displacement_m,
                                                   self);
                             })
      .def_property_readonly("length_m", [](const py::object& self) {
        return ViewOfVector(self.cast<const Equilibrium&>().length_m, self);
      });
}

}  // namespace

void RequireEquilibriumOf(const Robot& robot, const Equilibrium& equilibrium) {
  if (equilibrium.robot.get() != &robot) throw InputError("the equilibrium is of another robot");
}

std::shared_ptr<Equilibrium> Solve(const std::shared_ptr<Robot>& robot,
                                   const SolveRequest& request) {
  RequireLoadsOf(*robot, request.loads);
  if (request.start) RequireEquilibriumOf(*robot, *request.start);
  auto found = std::make_shared<Equilibrium>();
  found->robot = robot;
  found->commands =
      CommandsOf(*robot, request.displacement_m, request.tension_N, request.preferred);
  std::vector<robot::DeadLoad> loads;
  for (const Load& load : request.loads)
    loads.push_back({load.patch.surface.weights, load.force_N});
  Interrupts interrupts;
  robot->Use([&](robot::RobotModel& model) {
    const std::int64_t start_ns = MonotonicNow_ns();
    const WatchedSolver watched(model, interrupts);
    found->state = request.start ? request.start->state : model.RestState();
    found->result = model.Solve(found->commands, loads, &found->state);
    ReadOff(model, found.get());
    found->time_s = NsToSeconds(MonotonicNow_ns() - start_ns);
  });
  interrupts.Raise();
  const fem::StaticResult& result = found->result;
  if (!result.status.ok()) throw SolveFailure(result.status, result.load_fraction);
  return found;
}

void BindEquilibrium(py::module_& module) {
  py::class_<Equilibrium, std::shared_ptr<Equilibrium>> bound(
      module, "Equilibrium", "A static equilibrium; arrays are read-only views of its memory.");
  BindResults(bound);
  bound.def("position_m", &PositionOf, py::arg("patch"), "[3] mean position of a patch.")
      .def_property_readonly("robot", [](const Equilibrium& found) { return found.robot; })
      .def_property_readonly("iterations",
                             [](const Equilibrium& found) { return found.result.iterations; })
      .def_property_readonly("load_steps",
                             [](const Equilibrium& found) { return found.result.load_steps; })
      .def_property_readonly("residual_N",
                             [](const Equilibrium& found) { return found.result.residual_N; })
      .def_property_readonly(
          "residual_relative",
          [](const Equilibrium& found) { return found.result.residual_relative; })
      .def_readonly("time_s", &Equilibrium::time_s);
}

}  // namespace palpate::python
