// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <ostream>
#include <vector>

#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/parameters.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::robot {

/// A robot with everything that loads it: what parameters change.
struct RobotCase {
  RobotBody body;
  std::vector<ActuatorCommand> cables;
  std::vector<DeadLoad> loads;
  Eigen::VectorXd held_motion_m;        ///< [3n] of held nodes, from their rest positions
  std::vector<CableFriction> friction;  ///< [cables]
  Eigen::VectorXd compliance_m_N;       ///< [cables]
};

/// Balanced to rounding.
struct Balance {
  std::unique_ptr<RobotModel> model;
  fem::StaticState state;

  Eigen::VectorXd Points_m() const;  ///< of the markers
  Eigen::VectorXd Lengths_m() const;
  const Eigen::VectorXd& Tensions_N() const { return state.multipliers_N; }
};
/// From the rest shape or from `start`, a state of a robot with the same nodes.
Balance Solve(const RobotCase& robot, const fem::StaticState* start = nullptr);

enum class Control {
  kDisplacement,  ///< every cable taut at a given displacement
  kTension,       ///< every cable at a given tension
  kMixed,         ///< one taut at a displacement, one at a tension, one slack
};

struct CaseKind {
  fem::ElementType element;
  Control control;
};
void PrintTo(const CaseKind& kind, std::ostream* out);

/// A soft beam of 100 x 20 x 20 mm along x, held at x = 0, of two materials (1: the far part), with
/// gravity, a load on a patch and three cables; tet10 with mean dilatation. Pull points lie off the
/// body, and some eyelets reach out of it.
RobotCase SoftBeam(const CaseKind& kind);

/// Points of the cables' paths as they were embedded, and their guides' radius.
struct GuidePlan {
  std::vector<Eigen::Matrix3Xd> eyelets_m;  ///< [cables]
  double radius_m;
};
GuidePlan SoftBeamGuides();

/// Length of a cable on the undeformed body, which displacement commands count from.
double RestLength_m(const RobotBody& body, size_t cable);

/// The case with the parameter moved by this much.
using Change = std::function<RobotCase(double)>;

/// Expects the derivative of marker positions, cable lengths and tensions to be that of central
/// differences (of order 4) between re-solved equilibria.
void ExpectDerivative(const RobotCase& robot, ParameterPtr parameter, const Change& changed,
                      double step, double tolerance = 2e-7);

/// Rows of one-parameter results.
struct Derivative {
  Eigen::VectorXd points_m;
  Eigen::VectorXd lengths_m;
  Eigen::VectorXd tensions_N;
};
Derivative Differentiate(Balance& balance, const RobotCase& robot, ParameterPtr parameter);

class SensitivityCase : public testing::TestWithParam<CaseKind> {
 protected:
  RobotCase robot_ = SoftBeam(GetParam());
};

inline auto AllCases() {
  return testing::Values(CaseKind{fem::ElementType::kTet4, Control::kDisplacement},
                         CaseKind{fem::ElementType::kTet4, Control::kTension},
                         CaseKind{fem::ElementType::kTet4, Control::kMixed},
                         CaseKind{fem::ElementType::kTet10, Control::kDisplacement},
                         CaseKind{fem::ElementType::kTet10, Control::kTension},
                         CaseKind{fem::ElementType::kTet10, Control::kMixed});
}

}  // namespace palpate::robot
