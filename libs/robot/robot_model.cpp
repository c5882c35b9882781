// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_model.hpp"

#include <array>
#include <cstdio>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/eyelets.hpp"

namespace palpate::robot {

namespace {

using Mode = fem::ConstraintCommand::Mode;
using ConstraintList = std::vector<fem::ScalarConstraint*>;

std::vector<Cable> MakeCables(const RobotBody& body, const Eigen::VectorXd& rest_m) {
  std::vector<Cable> cables;
  for (const BodyCable& cable : body.cables) {
    std::vector<fem::InterpolationWeights> eyelets;
    for (const fem::BodyPoint& point : cable.eyelets) eyelets.push_back(point.weights);
    cables.emplace_back(cable.pull_point_m, std::move(eyelets), rest_m);
    cables.back().SetFriction({.coefficient = cable.friction_coefficient});
  }
  return cables;
}

std::vector<Chamber> MakeChambers(const RobotBody& body, const Eigen::VectorXd& rest_m) {
  std::vector<Chamber> chambers;
  for (const BodyChamber& chamber : body.chambers) chambers.emplace_back(chamber.wall, rest_m);
  return chambers;
}

/// What is converted has a rounding of its own, which no message should show.
std::string Rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// "12 N" of a cable, "120000 Pa" of a chamber.
std::string ForceText(const ActuatorTraits& traits, double force_N) {
  const double reported = traits.ReportedForce(force_N);
  return (traits.IsChamber() ? Rounded(reported) : FormatNumber(reported)) + " " +
         traits.force_unit();
}

std::string DisplacementText(const ActuatorTraits& traits, double displacement_m) {
  const double reported = traits.ReportedDisplacement(displacement_m);
  return (traits.IsChamber() ? Rounded(reported) : FormatNumber(reported)) + " " +
         traits.displacement_unit();
}

}  // namespace

ActuatorCommand ChooseCommand(std::optional<double> displacement_m, std::optional<double> tension_N,
                              CableInput preferred) {
  const bool by_tension =
      tension_N.has_value() && (preferred == CableInput::kTension || !displacement_m.has_value());
  if (by_tension) return {ActuatorCommand::Kind::kTension, *tension_N};
  if (displacement_m.has_value()) return {ActuatorCommand::Kind::kDisplacement, *displacement_m};
  return {};
}

ActuatorCommand ChooseCommand(const ActuatorTraits& traits, std::optional<double> displacement,
                              std::optional<double> force, CableInput preferred) {
  if (displacement) displacement = traits.Displacement_m(*displacement);
  if (force) force = traits.Force_N(*force);
  return ChooseCommand(displacement, force, preferred);
}

RobotModel::RobotModel(RobotBody body, const fem::StaticSettings& settings,
                       const fem::SolverSettings& solver, const ConstraintList& further)
    : body_(std::move(body)),
      locator_(body_.mesh),
      elastic_body_(body_.mesh, body_.materials, body_.material_of_cell,
                    EmbeddedFibres(body_.fibres)),
      cables_(MakeCables(body_, elastic_body_.rest_m())),
      chambers_(MakeChambers(body_, elastic_body_.rest_m())),
      traits_(ActuatorsOf(body_)),
      linearisation_(elastic_body_, Constraints(further), body_.fixed, solver),
      static_solver_(linearisation_, settings),
      actuator_rest_m_(ActuatorCount()),
      gravity_m_s2_(body_.gravity_m_s2),
      drives_(traits_.size()) {
  for (int a = 0; a < ActuatorCount(); ++a) actuator_rest_m_[a] = actuator(a).rest_value_m();
}

const Actuator& RobotModel::actuator(int index) const {
  if (index < CableCount()) return cable(index);
  return chamber(index - CableCount());
}

ConstraintList RobotModel::Constraints(const ConstraintList& further) {
  ConstraintList constraints;
  for (Cable& cable : cables_) constraints.push_back(&cable);
  for (Chamber& chamber : chambers_) constraints.push_back(&chamber);
  constraints.insert(constraints.end(), further.begin(), further.end());
  return constraints;
}

std::vector<std::string> RobotModel::ActuatorNames() const {
  std::vector<std::string> names;
  for (const ActuatorTraits& traits : traits_) names.push_back(traits.name);
  return names;
}

std::vector<std::string> RobotModel::CableNames() const {
  std::vector<std::string> names;
  for (const BodyCable& cable : body_.cables) names.push_back(cable.name);
  return names;
}

std::vector<std::string> RobotModel::ChamberNames() const {
  std::vector<std::string> names;
  for (const BodyChamber& chamber : body_.chambers) names.push_back(chamber.name);
  return names;
}

std::vector<std::string> RobotModel::MarkerNames() const {
  std::vector<std::string> names;
  for (const BodyMarker& marker : body_.markers) names.push_back(marker.name);
  return names;
}

fem::SurfacePatch RobotModel::Patch(const Eigen::Vector3d& position_m, double radius_m) const {
  return fem::MakeSurfacePatch(locator_, position_m, radius_m);
}

void RobotModel::SetPullPoint(int cable, const Eigen::Vector3d& pull_point_m) {
  Cable& moved = cables_.at(At(cable));
  moved.SetPullPoint(pull_point_m, elastic_body_.rest_m());
  actuator_rest_m_[cable] = moved.rest_length_m();
}

Status RobotModel::MoveEyelet(int cable_index, int eyelet, const Eigen::Vector3d& moved_m) {
  const auto index = static_cast<size_t>(cable_index);
  BodyCable moved = body_.cables.at(index);
  fem::BodyPoint& point = moved.eyelets.at(At(eyelet));
  const fem::InterpolationWeights before = point.weights;
  robot::MoveEyelet(locator_, body_.scale, eyelet, moved_m, &moved);
  point.weights = fem::Combine({point.weights, before}, {1.0, 0.0});
  if (point.weights.nodes != before.nodes) {
    return {StatusCode::kInvalidInput, "an eyelet of cable " + moved.name + " would be " +
                                           FormatNumber(moved_m.norm()) +
                                           " m off its place: more than the model has room for"};
  }
  cables_[index].SetEyelet(eyelet, point.weights.weights, elastic_body_.rest_m());
  actuator_rest_m_[cable_index] = cables_[index].rest_length_m();
  body_.cables[index] = std::move(moved);
  return Status::Ok();
}

void RobotModel::SetYoungsModulus(int material, double youngs_modulus_Pa) {
  elastic_body_.SetYoungsModulus(material, youngs_modulus_Pa);
  body_.materials.at(At(material)).youngs_modulus_Pa = youngs_modulus_Pa;
}

void RobotModel::SetPoissonsRatio(int material, double poissons_ratio) {
  elastic_body_.SetPoissonsRatio(material, poissons_ratio);
  body_.materials.at(At(material)).poissons_ratio = poissons_ratio;
}

ActuatorCommand RobotModel::CommandFor(int actuator, std::optional<double> displacement,
                                       std::optional<double> force, CableInput preferred) const {
  const ActuatorTraits& driven = traits(actuator);
  ActuatorCommand command = ChooseCommand(driven, displacement, force, preferred);
  if (command.kind == ActuatorCommand::Kind::kDisplacement) {
    command.value = drives_.at(At(actuator)).TakenIn_m(command.value);
  }
  return command;
}

void RobotModel::AddWeight(Eigen::VectorXd& force_N) const {
  for (Eigen::Index node = 0; node < body_.node_mass_kg.size(); ++node) {
    force_N.segment<3>(3 * node) += body_.node_mass_kg[node] * gravity_m_s2_;
  }
  if (history_force_N_.size() > 0) force_N += history_force_N_;
}

fem::ConstraintCommand RobotModel::ToConstraint(int index, const ActuatorCommand& command) const {
  const ActuatorTraits& limits = traits(index);
  switch (command.kind) {
    case ActuatorCommand::Kind::kNone: return {};
    case ActuatorCommand::Kind::kTension:
      return {.mode = Mode::kMultiplier,
              .value = command.value,
              .max_multiplier_N = limits.most_force_N,
              .min_multiplier_N = limits.least_force_N};
    case ActuatorCommand::Kind::kDisplacement:
      return {.mode = Mode::kUpperBound,
              .value = actuator(index).rest_value_m() - command.value,
              .max_multiplier_N = limits.most_force_N,
              .min_multiplier_N = limits.least_force_N,
              .compliance_m_N = actuator(index).compliance_m_N()};
  }
  PALPATE_CHECK(false, static_cast<int>(command.kind));
  return {};
}

fem::LoadState RobotModel::Loads(const std::vector<ActuatorCommand>& cables,
                                 const std::vector<DeadLoad>& loads) const {
  PALPATE_CHECK(static_cast<int>(cables.size()) == ActuatorCount(), cables.size(), ActuatorCount());
  fem::LoadState state;
  state.fixed_position_m = elastic_body_.rest_m();
  state.external_force_N = Eigen::VectorXd::Zero(state.fixed_position_m.size());
  AddWeight(state.external_force_N);
  for (const DeadLoad& load : loads) {
    for (size_t k = 0; k < load.weights.nodes.size(); ++k) {
      state.external_force_N.segment<3>(3 * load.weights.nodes[k]) +=
          load.weights.weights[k] * load.force_N;
    }
  }
  for (int c = 0; c < ActuatorCount(); ++c) {
    state.commands.push_back(ToConstraint(c, cables[At(c)]));
  }
  state.commands.resize(linearisation_.constraints().size());
  return state;
}

/// A tension or pressure that its actuator cannot have.
Status RobotModel::CheckForces(const std::vector<ActuatorCommand>& commands) const {
  for (int c = 0; c < ActuatorCount(); ++c) {
    const ActuatorCommand& command = commands[At(c)];
    const ActuatorTraits& driven = traits(c);
    if (command.kind != ActuatorCommand::Kind::kTension) continue;
    if (command.value >= driven.least_force_N && command.value <= driven.most_force_N) continue;
    return {StatusCode::kTensionLimit, driven.Title() + ": " +
                                           (driven.IsChamber() ? "pressure " : "tension ") +
                                           ForceText(driven, command.value) + " is not within " +
                                           Rounded(driven.ReportedForce(driven.least_force_N)) +
                                           " to " + ForceText(driven, driven.most_force_N)};
  }
  return Status::Ok();
}

fem::StaticResult RobotModel::Solve(const std::vector<ActuatorCommand>& cables,
                                    const std::vector<DeadLoad>& loads, fem::StaticState* state) {
  const fem::LoadState target = Loads(cables, loads);
  if (Status status = CheckForces(cables); !status.ok()) {
    fem::StaticResult refused;
    refused.status = std::move(status);
    return refused;
  }
  fem::StaticResult result = static_solver_.Solve(target, state);
  if (result.status.code() != StatusCode::kTensionLimit) return result;
  for (int c = 0; c < ActuatorCount(); ++c) {
    const ActuatorCommand& command = cables[At(c)];
    const ActuatorTraits& driven = traits(c);
    if (command.kind != ActuatorCommand::Kind::kDisplacement ||
        result.multipliers_N[c] < driven.most_force_N) {
      continue;
    }
    const std::string asked = DisplacementText(driven, command.value);
    result.status = Status(
        StatusCode::kTensionLimit,
        driven.Title() +
            (driven.IsChamber() ? ": a change of volume of " : ": a displacement of ") + asked +
            " needs more than " + (driven.IsChamber() ? "max_pressure_Pa (" : "max_tension_N (") +
            ForceText(driven, driven.most_force_N) + ")");
  }
  return result;
}

ActuatorState RobotModel::StateOfActuator(int index, const fem::StaticState& state) const {
  const Actuator& one = actuator(index);
  const double length = one.Value(state.x_m);
  const double tension_N = state.multipliers_N[index];
  return {.length_m = length,
          .displacement_m = one.rest_value_m() - length + one.compliance_m_N() * tension_N,
          .tension_N = tension_N};
}

}  // namespace palpate::robot
