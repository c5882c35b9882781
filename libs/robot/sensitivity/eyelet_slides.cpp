// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/eyelet_slides.hpp"

#include "libs/core/index.hpp"
#include "libs/robot/cable_path.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

using Kind = ActuatorCommand::Kind;

/// [eyelets of the cable x parameters] by how much the length from each to the cable's end grows.
Eigen::MatrixXd LengthsBeyond(const Cable& cable, const Eigen::VectorXd& x_m,
                              const SensitivitySolver& solver) {
  CablePath path;
  path.Evaluate(cable.Path_m(x_m), {});
  Eigen::MatrixXd motions_m;
  solver.PointMotions(cable.eyelets(), &motions_m);
  Eigen::MatrixXd beyond_m = Eigen::MatrixXd::Zero(std::ssize(cable.eyelets()), motions_m.cols());
  for (Eigen::Index e = beyond_m.rows() - 2; e >= 0; --e) {
    const Eigen::MatrixXd piece_m =
        motions_m.middleRows(3 * e + 3, 3) - motions_m.middleRows(3 * e, 3);
    beyond_m.row(e) = beyond_m.row(e + 1) + path.direction().col(e + 1).transpose() * piece_m;
  }
  return beyond_m;
}

}  // namespace

std::vector<RubbingEyelet> RubbingEyelets(const RobotBody& body) {
  std::vector<RubbingEyelet> eyelets;
  for (std::size_t c = 0; c < body.cables.size(); ++c) {
    for (std::size_t e = 0; e + 1 < body.cables[c].eyelets.size(); ++e) {
      eyelets.push_back({static_cast<int>(c), static_cast<int>(e)});
    }
  }
  return eyelets;
}

Eigen::VectorXd FrictionAt(const std::vector<RubbingEyelet>& eyelets, const RobotBody& body) {
  Eigen::VectorXd coefficient(std::ssize(eyelets));
  for (std::size_t k = 0; k < eyelets.size(); ++k) {
    const auto cable = static_cast<std::size_t>(eyelets[k].cable);
    coefficient[ToIndex(k)] = body.cables[cable].friction_coefficient;
  }
  return coefficient;
}

EyeletSlides SlidesAbout(const std::vector<RubbingEyelet>& eyelets,
                         const std::vector<ActuatorCommand>& commands,
                         const fem::StaticState& state, const RobotModel& model,
                         SensitivitySolver* solver) {
  std::vector<ParameterPtr> parameters;
  for (const RubbingEyelet& one : eyelets) {
    parameters.push_back(CableFrictionAt(one.cable, one.eyelet));
  }
  std::vector<Eigen::Index> driven;  // cables
  for (std::size_t c = 0; c < commands.size(); ++c) {
    const int cable = static_cast<int>(c);
    if (commands[c].kind == Kind::kDisplacement) {
      parameters.push_back(CableOffset(cable));
    } else if (commands[c].kind == Kind::kTension) {
      parameters.push_back(TensionOffset(cable));
    } else {
      continue;
    }
    driven.push_back(cable);
  }
  EyeletSlides slides;
  if (!solver->Compute(commands, state, parameters).ok()) return slides;
  const auto count = std::ssize(eyelets);
  slides.by_friction.resize(count, count);
  slides.by_command.setZero(count, std::ssize(commands));
  Eigen::MatrixXd beyond_m;
  for (Eigen::Index k = 0; k < count; ++k) {
    const RubbingEyelet& one = eyelets[At(k)];
    if (one.eyelet == 0) beyond_m = LengthsBeyond(model.cable(one.cable), state.x_m, *solver);
    const Eigen::RowVectorXd row = beyond_m.row(one.eyelet);
    slides.by_friction.row(k) = row.head(count);
    for (Eigen::Index d = 0; d < std::ssize(driven); ++d) {
      slides.by_command(k, driven[At(d)]) = row[count + d];
    }
  }
  return slides;
}

}  // namespace palpate::robot
