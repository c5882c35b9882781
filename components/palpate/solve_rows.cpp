// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_rows.hpp"

#include <fmt/core.h>

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
using robot::CableCommand;

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

void ReadCables(const LoadCase& row, const robot::RobotModel& model, const fem::StaticState& state,
                RowResult* result) {
  for (int c = 0; c < model.CableCount(); ++c) {
    const auto index = static_cast<std::size_t>(c);
    const robot::CableState cable = model.StateOfCable(c, state);
    const CableCommand& command = row.cables[index];
    if (command.kind == CableCommand::Kind::kDisplacement && cable.tension_N <= 0.0) {
      result->notes.push_back(
          fmt::format("cable {} is slack: {:.6g} m prescribed, the body is at {:.6g} m",
                      model.body().cables[index].name, command.value, cable.displacement_m));
    }
    result->cables.push_back(cable);
  }
}

// The cable whose tension was followed least of its way; empty where none has a prescribed one.
std::string ExplainTensions(const LoadCase& row, const robot::RobotModel& model,
                            const fem::StaticState& state) {
  constexpr double kReached = 1.0 - 1e-6;
  double smallest_share = kReached;
  std::string explanation;
  for (int c = 0; c < model.CableCount(); ++c) {
    const CableCommand& command = row.cables[At(c)];
    if (command.kind != CableCommand::Kind::kTension || !(command.value > 0.0)) continue;
    const double reached_N = state.multipliers_N[c];
    if (reached_N / command.value >= smallest_share) continue;
    smallest_share = reached_N / command.value;
    const std::string& cable = model.body().cables[At(c)].name;
    explanation = fmt::format(
        "cable {}: followed up to {:.3g} N of the {:.6g} N prescribed; near its limit a tension no "
        "longer determines the shape: prescribe the displacement ({}.displacement_m) instead: ",
        cable, reached_N, command.value, cable);
  }
  return explanation;
}

// Adds to a failure which cable is farthest from its prescribed displacement or tension.
void ExplainFailure(const LoadCase& row, const robot::RobotModel& model,
                    const fem::StaticState& state, fem::StaticResult* result) {
  if (result->status.code() == StatusCode::kTensionLimit) {
    return;  // names its cable already
  }
  double largest_gap_m = 1e-6;
  std::string culprit;
  for (int c = 0; c < model.CableCount(); ++c) {
    const CableCommand& command = row.cables[At(c)];
    const double reached_m = model.StateOfCable(c, state).displacement_m;
    if (command.kind == CableCommand::Kind::kDisplacement &&
        command.value - reached_m > largest_gap_m) {
      largest_gap_m = command.value - reached_m;
      culprit = fmt::format(
          "cable {}: no equilibrium found beyond a displacement of {:.6g} m of "
          "the {:.6g} m prescribed: ",
          model.body().cables[At(c)].name, reached_m, command.value);
    }
  }
  if (culprit.empty()) culprit = ExplainTensions(row, model, state);
  result->status = Status(result->status.code(), culprit + result->status.message());
}

// A cable cannot be shortened by more than its length; nullopt where no cable is.
std::optional<Status> RefuseImpossible(const LoadCase& row, const robot::RobotModel& model) {
  for (int c = 0; c < model.CableCount(); ++c) {
    const CableCommand& command = row.cables[At(c)];
    const double length_m = model.cable(c).rest_length_m();
    if (command.kind == CableCommand::Kind::kDisplacement && command.value >= length_m) {
      return Status(StatusCode::kNotConverged,
                    fmt::format("cable {}: no equilibrium reaches a displacement of {:.6g} m: the "
                                "cable is {:.6g} m long at rest",
                                model.body().cables[At(c)].name, command.value, length_m));
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
  result = model->Solve(row.cables, loads, state);
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
      ReadCables(rows[i], *model, state, &result);
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
