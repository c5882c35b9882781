// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/solve_with_gas.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::robot {

namespace {

/// A chamber of given gas in the units of its piston.
struct GasPiston {
  int actuator;
  GasLaw law;
  double area_m2;

  double Pressure_Pa(double thrust_N) const { return thrust_N / area_m2; }
  double Displacement_m(double thrust_N) const {
    return law.Change_m3(Pressure_Pa(thrust_N)) / area_m2;
  }
  double Compliance_m_N(double thrust_N) const {
    return law.Compliance_m3_Pa(Pressure_Pa(thrust_N)) / (area_m2 * area_m2);
  }
};

Status CheckGas(const RobotModel& model, const ChamberGas& gas) {
  const bool is_chamber =
      gas.actuator >= model.CableCount() && gas.actuator < model.ActuatorCount();
  if (!is_chamber) {
    return {StatusCode::kInvalidInput,
            "actuator " + std::to_string(gas.actuator) + " is no chamber and holds no gas"};
  }
  const BodyChamber& chamber = model.body().chambers[At(gas.actuator - model.CableCount())];
  const double holds_m3 = chamber.volume_m3 + chamber.dead_volume_m3;
  if (gas.air_m3 > -holds_m3) return Status::Ok();
  return {StatusCode::kInvalidInput, "chamber " + chamber.name + " cannot lose " +
                                         FormatNumber(-gas.air_m3) +
                                         " m3 of air: with its tube it "
                                         "holds " +
                                         FormatNumber(holds_m3) + " m3"};
}

GasPiston PistonOf(const RobotModel& model, const ChamberGas& gas) {
  const BodyChamber& chamber = model.body().chambers[At(gas.actuator - model.CableCount())];
  return {gas.actuator,
          GasLaw(chamber.volume_m3, chamber.dead_volume_m3, gas.air_m3, gas.ambient_Pa),
          model.traits(gas.actuator).area_m2};
}

/// The law's tangent at this thrust, as the command of a chamber of given volume.
fem::ConstraintCommand TangentAt(const RobotModel& model, const GasPiston& piston, double thrust_N,
                                 const GasSolveTuning& tuning) {
  const ActuatorTraits& limits = model.traits(piston.actuator);
  const double compliance_m_N = piston.Compliance_m_N(thrust_N);
  const double ambient_N = piston.law.ambient_Pa() * piston.area_m2;
  return {.mode = fem::ConstraintCommand::Mode::kUpperBound,
          .value = model.actuator(piston.actuator).rest_value_m() -
                   piston.Displacement_m(thrust_N) - compliance_m_N * thrust_N,
          .max_multiplier_N = limits.most_force_N,
          .min_multiplier_N = thrust_N - tuning.most_fall * (ambient_N + thrust_N),
          .compliance_m_N = compliance_m_N};
}

/// Largest relative error of p V.
double ErrorOf(const RobotModel& model, const std::vector<GasPiston>& pistons,
               const fem::StaticState& state) {
  double error = 0.0;
  for (const GasPiston& piston : pistons) {
    const double change_m3 =
        piston.area_m2 * model.actuator(piston.actuator).Displacement_m(state.x_m);
    const double by_law_m3 =
        piston.law.Change_m3(piston.Pressure_Pa(state.multipliers_N[piston.actuator]));
    error = std::max(error, std::abs(change_m3 - by_law_m3) / piston.law.volume_m3());
  }
  return error;
}

void NameChamber(const RobotModel& model, const std::vector<GasPiston>& pistons,
                 fem::StaticResult* result) {
  if (result->status.code() != StatusCode::kTensionLimit) return;
  for (const GasPiston& piston : pistons) {
    const ActuatorTraits& traits = model.traits(piston.actuator);
    if (result->multipliers_N[piston.actuator] < traits.most_force_N) continue;
    result->status =
        Status(StatusCode::kTensionLimit,
               traits.Title() + ": its air needs more than max_pressure_Pa (" +
                   FormatNumber(std::round(traits.ReportedForce(traits.most_force_N))) + " Pa)");
  }
}

}  // namespace

fem::StaticResult SolveWithGas(RobotModel& model, std::vector<ActuatorCommand> commands,
                               const std::vector<ChamberGas>& gas,
                               const std::vector<DeadLoad>& loads, fem::StaticState* state,
                               const GasSolveTuning& tuning) {
  fem::StaticResult result;
  std::vector<GasPiston> pistons;
  for (const ChamberGas& one : gas) {
    result.status = CheckGas(model, one);
    if (!result.status.ok()) return result;
    pistons.push_back(PistonOf(model, one));
    commands[At(one.actuator)] = {ActuatorCommand::Kind::kTension,
                                  state->multipliers_N[one.actuator]};
  }
  fem::StaticState reached = *state;
  // At the pressures that the chambers have: the limits of all others are checked, too.
  result = model.Solve(commands, loads, &reached);
  if (!result.status.ok()) return result;
  for (int k = 0; k < tuning.most_iterations; ++k) {
    fem::LoadState target = model.Loads(commands, loads);
    for (const GasPiston& piston : pistons) {
      target.commands[At(piston.actuator)] =
          TangentAt(model, piston, reached.multipliers_N[piston.actuator], tuning);
    }
    const int before = result.iterations;
    result = model.static_solver().Solve(target, &reached);
    result.iterations += before;
    NameChamber(model, pistons, &result);
    if (!result.status.ok()) return result;
    if (ErrorOf(model, pistons, reached) > tuning.relative_tolerance) continue;
    *state = std::move(reached);
    return result;
  }
  result.status = Status(StatusCode::kNotConverged, "the pressure of the gas has not settled");
  return result;
}

}  // namespace palpate::robot
