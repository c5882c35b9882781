// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_model.hpp"

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

}  // namespace

CableCommand ChooseCommand(std::optional<double> displacement_m, std::optional<double> tension_N,
                           CableInput preferred) {
  const bool by_tension =
      tension_N.has_value() && (preferred == CableInput::kTension || !displacement_m.has_value());
  if (by_tension) return {CableCommand::Kind::kTension, *tension_N};
  if (displacement_m.has_value()) return {CableCommand::Kind::kDisplacement, *displacement_m};
  return {};
}

RobotModel::RobotModel(RobotBody body, const fem::StaticSettings& settings,
                       const fem::SolverSettings& solver, const ConstraintList& further)
    : body_(std::move(body)),
      locator_(body_.mesh),
      elastic_body_(body_.mesh, body_.materials, body_.material_of_cell),
      cables_(MakeCables(body_, elastic_body_.rest_m())),
      linearisation_(elastic_body_, Constraints(further), body_.fixed, solver),
      static_solver_(linearisation_, settings),
      cable_rest_length_m_(ToIndex(cables_.size())),
      gravity_m_s2_(body_.gravity_m_s2),
      drives_(cables_.size()) {
  for (int c = 0; c < CableCount(); ++c) cable_rest_length_m_[c] = cable(c).rest_length_m();
}

ConstraintList RobotModel::Constraints(const ConstraintList& further) {
  ConstraintList constraints;
  for (Cable& cable : cables_) constraints.push_back(&cable);
  constraints.insert(constraints.end(), further.begin(), further.end());
  return constraints;
}

std::vector<std::string> RobotModel::CableNames() const {
  std::vector<std::string> names;
  for (const BodyCable& cable : body_.cables) names.push_back(cable.name);
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
  cable_rest_length_m_[cable] = moved.rest_length_m();
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
  cable_rest_length_m_[cable_index] = cables_[index].rest_length_m();
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

CableCommand RobotModel::CommandFor(int cable, std::optional<double> displacement_m,
                                    std::optional<double> tension_N, CableInput preferred) const {
  if (displacement_m) {
    displacement_m = drives_.at(At(cable)).TakenIn_m(*displacement_m);
  }
  return ChooseCommand(displacement_m, tension_N, preferred);
}

void RobotModel::AddWeight(Eigen::VectorXd& force_N) const {
  for (Eigen::Index node = 0; node < body_.node_mass_kg.size(); ++node) {
    force_N.segment<3>(3 * node) += body_.node_mass_kg[node] * gravity_m_s2_;
  }
  if (history_force_N_.size() > 0) force_N += history_force_N_;
}

fem::ConstraintCommand RobotModel::ToConstraint(int cable_index,
                                                const CableCommand& command) const {
  const double limit = body_.cables[At(cable_index)].max_tension_N;
  switch (command.kind) {
    case CableCommand::Kind::kNone: return {};
    case CableCommand::Kind::kTension:
      return {.mode = Mode::kMultiplier, .value = command.value, .max_multiplier_N = limit};
    case CableCommand::Kind::kDisplacement:
      return {.mode = Mode::kUpperBound,
              .value = cable(cable_index).rest_length_m() - command.value,
              .max_multiplier_N = limit,
              .compliance_m_N = cable(cable_index).compliance_m_N()};
  }
  PALPATE_CHECK(false, static_cast<int>(command.kind));
  return {};
}

fem::LoadState RobotModel::Loads(const std::vector<CableCommand>& cables,
                                 const std::vector<DeadLoad>& loads) const {
  PALPATE_CHECK(static_cast<int>(cables.size()) == CableCount(), cables.size(), CableCount());
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
  for (int c = 0; c < CableCount(); ++c) {
    state.commands.push_back(ToConstraint(c, cables[At(c)]));
  }
  state.commands.resize(linearisation_.constraints().size());
  return state;
}

fem::StaticResult RobotModel::Solve(const std::vector<CableCommand>& cables,
                                    const std::vector<DeadLoad>& loads, fem::StaticState* state) {
  const fem::LoadState target = Loads(cables, loads);
  for (int c = 0; c < CableCount(); ++c) {
    const CableCommand& command = cables[At(c)];
    const BodyCable& driven = body_.cables[At(c)];
    if (command.kind == CableCommand::Kind::kTension &&
        !(command.value >= 0.0 && command.value <= driven.max_tension_N)) {
      fem::StaticResult refused;
      refused.status =
          Status(StatusCode::kTensionLimit,
                 "cable " + driven.name + ": tension " + FormatNumber(command.value) +
                     " N is not within 0 to " + FormatNumber(driven.max_tension_N) + " N");
      return refused;
    }
  }
  fem::StaticResult result = static_solver_.Solve(target, state);
  if (result.status.code() != StatusCode::kTensionLimit) return result;
  for (int c = 0; c < CableCount(); ++c) {
    const CableCommand& command = cables[At(c)];
    const BodyCable& driven = body_.cables[At(c)];
    if (command.kind != CableCommand::Kind::kDisplacement ||
        result.multipliers_N[c] < driven.max_tension_N) {
      continue;
    }
    result.status = Status(StatusCode::kTensionLimit,
                           "cable " + driven.name + ": a displacement of " +
                               FormatNumber(command.value) + " m needs more than max_tension_N (" +
                               FormatNumber(driven.max_tension_N) + " N)");
  }
  return result;
}

CableState RobotModel::StateOfCable(int cable_index, const fem::StaticState& state) const {
  const Cable& one = cable(cable_index);
  const double length = one.Value(state.x_m);
  const double tension_N = state.multipliers_N[cable_index];
  return {.length_m = length,
          .displacement_m = one.rest_length_m() - length + one.compliance_m_N() * tension_N,
          .tension_N = tension_N};
}

}  // namespace palpate::robot
