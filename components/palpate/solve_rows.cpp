// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_rows.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

using experiment::KnownLoad;
using robot::ActuatorCommand;

constexpr double kNotedDistance_m = 1e-3;

double Diagonal_m(const robot::RobotModel& model) {
  const Eigen::Matrix3Xd& nodes_m = model.body().mesh.nodes_m;
  return (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).norm();
}

// The patches of all loads, each made once.
class LoadPatches {
 public:
  explicit LoadPatches(const robot::RobotModel& model)
      : model_(model), farthest_m_(0.5 * Diagonal_m(model)) {}

  const fem::SurfacePatch& Of(const KnownLoad& load) {
    const Key key{load.position_m.x(), load.position_m.y(), load.position_m.z(),
                  load.patch_radius_m};
    const auto [entry, is_new] = patches_.try_emplace(key);
    if (is_new) {
      entry->second = model_.Patch(load.position_m, load.patch_radius_m);
      CheckDistance(load, entry->second.distance_m);
    }
    return entry->second;
  }

 private:
  using Key = std::tuple<double, double, double, double>;

  void CheckDistance(const KnownLoad& load, double distance_m) const {
    if (distance_m > farthest_m_) {
      throw InputError(load.where,
                       fmt::format("the load at ({:g}, {:g}, {:g}) m is {:.3g} m from the body; at "
                                   "most {:.3g} m, half its diagonal, are allowed",
                                   load.position_m.x(), load.position_m.y(), load.position_m.z(),
                                   distance_m, farthest_m_));
    }
  }

  const robot::RobotModel& model_;
  double farthest_m_;
  std::map<Key, fem::SurfacePatch> patches_;
};

std::vector<robot::DeadLoad> DeadLoadsOf(const LoadCase& row, LoadPatches* patches) {
  std::vector<robot::DeadLoad> loads;
  for (const KnownLoad& load : row.loads) {
    loads.push_back({patches->Of(load).weights, load.force_N});
  }
  return loads;
}

/// "0.005 m" of a cable, "2e-06 m3" of a chamber.
std::string DisplacementText(const robot::ActuatorTraits& traits, double displacement_m) {
  return fmt::format("{:.6g} {}", traits.ReportedDisplacement(displacement_m),
                     traits.displacement_unit());
}

std::string ForceText(const robot::ActuatorTraits& traits, double force_N) {
  return fmt::format("{:.6g} {}", traits.ReportedForce(force_N), traits.force_unit());
}

void ReadActuators(const LoadCase& row, const robot::RobotModel& model,
                   const fem::StaticState& state, RowResult* result) {
  for (int a = 0; a < model.ActuatorCount(); ++a) {
    const robot::ActuatorTraits& traits = model.traits(a);
    const robot::ActuatorState reached = model.StateOfActuator(a, state);
    const ActuatorCommand& command = row.cables[At(a)];
    if (command.kind == ActuatorCommand::Kind::kDisplacement &&
        reached.tension_N <= traits.least_force_N) {
      result->notes.push_back(fmt::format("{} {}: {} prescribed, the body is at {}", traits.Title(),
                                          traits.IsChamber() ? "is at a vacuum" : "is slack",
                                          DisplacementText(traits, command.value),
                                          DisplacementText(traits, reached.displacement_m)));
    }
    result->actuators.push_back(reached);
  }
}

// The actuator whose tension or pressure was followed least of its way; empty where none has a
// prescribed one.
std::string ExplainForces(const LoadCase& row, const robot::RobotModel& model,
                          const fem::StaticState& state) {
  constexpr double kReached = 1.0 - 1e-6;
  double smallest_share = kReached;
  std::string explanation;
  for (int a = 0; a < model.ActuatorCount(); ++a) {
    const ActuatorCommand& command = row.cables[At(a)];
    if (command.kind != ActuatorCommand::Kind::kTension || command.value == 0.0) continue;
    const double reached_N = state.multipliers_N[a];
    if (reached_N / command.value >= smallest_share) continue;
    smallest_share = reached_N / command.value;
    const robot::ActuatorTraits& traits = model.traits(a);
    explanation = fmt::format(
        "{}: followed up to {:.3g} {} of the {} prescribed; near its limit a {} no longer "
        "determines the shape: prescribe the {} ({}.{}) instead: ",
        traits.Title(), traits.ReportedForce(reached_N), traits.force_unit(),
        ForceText(traits, command.value), traits.IsChamber() ? "pressure" : "tension",
        traits.IsChamber() ? "volume" : "displacement", traits.name,
        traits.IsChamber() ? "volume_m3" : "displacement_m");
  }
  return explanation;
}

// Adds to a failure which actuator is farthest from what is prescribed.
void ExplainFailure(const LoadCase& row, const robot::RobotModel& model,
                    const fem::StaticState& state, fem::StaticResult* result) {
  if (result->status.code() == StatusCode::kTensionLimit) {
    return;  // names its actuator already
  }
  double largest_gap_m = 1e-6;
  std::string culprit;
  for (int a = 0; a < model.ActuatorCount(); ++a) {
    const ActuatorCommand& command = row.cables[At(a)];
    const robot::ActuatorTraits& traits = model.traits(a);
    const double reached_m = model.StateOfActuator(a, state).displacement_m;
    const double gap_m = command.value - reached_m;
    const double missing_m = traits.IsChamber() ? std::abs(gap_m) : gap_m;
    if (command.kind == ActuatorCommand::Kind::kDisplacement && missing_m > largest_gap_m) {
      largest_gap_m = missing_m;
      culprit = fmt::format(
          "{}: no equilibrium found beyond a {} of {} of the {} prescribed: ", traits.Title(),
          traits.IsChamber() ? "change of volume" : "displacement",
          DisplacementText(traits, reached_m), DisplacementText(traits, command.value));
    }
  }
  if (culprit.empty()) culprit = ExplainForces(row, model, state);
  result->status = Status(result->status.code(), culprit + result->status.message());
}

// A cable cannot be shortened by more than its length, a chamber not be emptied of more than it
// holds; nullopt where none is.
std::optional<Status> RefuseImpossible(const LoadCase& row, const robot::RobotModel& model) {
  for (int a = 0; a < model.ActuatorCount(); ++a) {
    const ActuatorCommand& command = row.cables[At(a)];
    if (command.kind != ActuatorCommand::Kind::kDisplacement) continue;
    const robot::ActuatorTraits& traits = model.traits(a);
    const double rest_m = model.actuator(a).rest_value_m();
    if (!traits.IsChamber() && command.value >= rest_m) {
      return Status(StatusCode::kNotConverged,
                    fmt::format("{}: no equilibrium reaches a displacement of {:.6g} m: the cable "
                                "is {:.6g} m long at rest",
                                traits.Title(), command.value, rest_m));
    }
    if (traits.IsChamber() && command.value <= rest_m) {
      return Status(StatusCode::kNotConverged,
                    fmt::format("{}: no equilibrium has lost {}: the chamber holds {} at rest",
                                traits.Title(), DisplacementText(traits, -command.value),
                                DisplacementText(traits, -rest_m)));
    }
  }
  return std::nullopt;
}

fem::StaticResult SolveRow(const LoadCase& row, const std::vector<robot::DeadLoad>& loads,
                           robot::RobotModel* model, fem::StaticState* state) {
  fem::StaticResult result;
  if (const auto impossible = RefuseImpossible(row, *model)) {
    result.status = *impossible;
    return result;
  }
  result = row.gas.empty() ? model->Solve(row.cables, loads, state)
                           : robot::SolveWithGas(*model, row.cables, row.gas, loads, state);
  if (!result.status.ok()) {
    ExplainFailure(row, *model, *state, &result);
  }
  return result;
}

// Takes the observer off the solver again.
class ObserverScope {
 public:
  explicit ObserverScope(robot::RobotModel* model) : model_(model) {}
  ~ObserverScope() { model_->static_solver().SetObserver({}); }
  ObserverScope(const ObserverScope&) = delete;
  ObserverScope& operator=(const ObserverScope&) = delete;

 private:
  robot::RobotModel* model_;
};

}  // namespace

std::string ActuatorText(const robot::ActuatorTraits& traits, const robot::ActuatorState& state) {
  const double displacement = traits.ReportedDisplacement(state.displacement_m);
  const double force = traits.ReportedForce(state.tension_N);
  if (traits.IsChamber()) {
    return fmt::format("{} {:.1f} mm3 {:.2f} kPa", traits.name, 1e9 * displacement, 1e-3 * force);
  }
  return fmt::format("{} {:.3f} mm {:.3f} N", traits.name, 1e3 * displacement, force);
}

bool SolveRows(const std::vector<LoadCase>& rows, robot::RobotModel* model,
               const std::function<void(const RowResult&)>& take, const WatchRow& watch) {
  LoadPatches patches(*model);
  for (const LoadCase& row : rows) {
    DeadLoadsOf(row, &patches);  // refuses loads far from the body before anything is solved
  }
  const ObserverScope observer(model);
  fem::StaticState state = model->RestState();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RowResult result;
    result.row = static_cast<int>(i);
    result.t_s = rows[i].t_s;
    result.loads = DeadLoadsOf(rows[i], &patches);
    bool gave_up = false;
    model->static_solver().SetObserver([&](const fem::StaticResult& so_far) {
      gave_up = gave_up || !watch(result.row, so_far);
      return !gave_up;
    });
    if (!watch(result.row, result.solver)) return false;  // a row may need no iteration
    const std::int64_t start_ns = MonotonicNow_ns();
    result.solver = SolveRow(rows[i], result.loads, model, &state);
    result.time_s = static_cast<double>(MonotonicNow_ns() - start_ns) * 1e-9;
    if (gave_up) return false;
    if (result.converged()) {
      result.x_m = state.x_m;
      ReadActuators(rows[i], *model, state, &result);
    }
    take(result);
  }
  return true;
}

std::vector<std::string> NotesOnLoads(const std::vector<LoadCase>& rows,
                                      const robot::RobotModel& model) {
  LoadPatches patches(model);
  std::set<std::string> said;
  std::vector<std::string> notes;
  for (const LoadCase& row : rows) {
    for (const KnownLoad& load : row.loads) {
      const double distance_m = patches.Of(load).distance_m;
      const std::string note = fmt::format(
          "the load at ({:g}, {:g}, {:g}) m lies {:.2f} mm off the body", load.position_m.x(),
          load.position_m.y(), load.position_m.z(), 1e3 * distance_m);
      if (distance_m > kNotedDistance_m && said.insert(note).second) {
        notes.push_back(note);
      }
    }
  }
  return notes;
}

}  // namespace palpate::command
