// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/equilibrium.hpp"

#include <cstdint>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/robot/solve_with_gas.hpp"
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

std::vector<robot::ChamberGas> GasOf(const Robot& robot, const SolveRequest& request,
                                     const std::vector<robot::ActuatorCommand>& commands) {
  const auto air_m3 = robot.ReadCables(request.air_m3, "air_m3");
  std::vector<robot::ChamberGas> gas;
  for (std::size_t a = 0; a < air_m3.size(); ++a) {
    if (!air_m3[a]) continue;
    const robot::ActuatorTraits& traits = robot.traits(a);
    if (!traits.IsChamber()) throw InputError("air_m3: " + traits.Title() + " is no chamber");
    if (commands[a].kind != robot::ActuatorCommand::Kind::kNone) {
      throw InputError("air_m3: " + traits.Title() + " has a pressure or volume, too; give one");
    }
    gas.push_back({.actuator = static_cast<int>(a), .air_m3 = *air_m3[a]});
  }
  return gas;
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
  const std::vector<robot::ChamberGas> gas = GasOf(*robot, request, found->commands);
  found->has_gas = !gas.empty();
  Interrupts interrupts;
  robot->Use([&](robot::RobotModel& model) {
    const std::int64_t start_ns = MonotonicNow_ns();
    const WatchedSolver watched(model, interrupts);
    found->state = request.start ? request.start->state : model.RestState();
    found->result = gas.empty()
                        ? model.Solve(found->commands, loads, &found->state)
                        : robot::SolveWithGas(model, found->commands, gas, loads, &found->state);
    ReadOff(model, found.get());
    found->time_s = NsToSeconds(MonotonicNow_ns() - start_ns);
  });
  interrupts.Raise();
  const fem::StaticResult& result = found->result;
  if (!result.status.ok()) throw SolveFailure(result.status, result.load_fraction);
  return found;
}

void RequireNoGas(const Equilibrium& equilibrium) {
  if (!equilibrium.has_gas) return;
  throw InputError(
      "the equilibrium has a chamber of given air, and its derivatives are not known; solve for "
      "its "
      "pressure or its volume");
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
