// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/equilibrium_sensitivity.hpp"

#include <gtest/gtest.h>

#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

/// Parameters: moduli of body, tip and root, and a force on marker m1 along y and z.
class SensitivityTest : public BeamModelTest {
 protected:
  static constexpr int kParameters = 5;

  fem::StaticState Equilibrium(const std::vector<ActuatorCommand>& cables,
                               const Eigen::VectorXd& parameters) {
    for (int k = 0; k < 3; ++k) model_->SetYoungsModulus(k, parameters[k]);
    const Eigen::Vector3d force_N(0.0, parameters[3], parameters[4]);
    fem::StaticState state = model_->RestState();
    const fem::StaticResult result = model_->Solve(cables, {{Point(), force_N}}, &state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    return state;
  }

  const fem::InterpolationWeights& Point() const { return model_->body().markers[0].point.weights; }

  Eigen::MatrixXd ForceDerivative(const Eigen::VectorXd& x_m) const {
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(x_m.size(), kParameters);
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd internal = Eigen::VectorXd::Zero(x_m.size());
      model_->elastic_body().AddForcesOfMaterial(k, x_m, internal);
      derivative.col(k) = -internal / parameters_[k];
    }
    for (size_t n = 0; n < Point().nodes.size(); ++n) {
      derivative(3 * Point().nodes[n] + 1, 3) = Point().weights[n];
      derivative(3 * Point().nodes[n] + 2, 4) = Point().weights[n];
    }
    return derivative;
  }

  void ExpectEqualsDifferences(const std::vector<ActuatorCommand>& cables) {
    const fem::StaticState state = Equilibrium(cables, parameters_);
    Eigen::MatrixXd dx_dp;
    const Status status =
        EquilibriumSensitivity(*model_, cables, state, ForceDerivative(state.x_m), &dx_dp);
    ASSERT_TRUE(status.ok()) << status.message();
    ASSERT_EQ(dx_dp.rows(), state.x_m.size());
    for (int k = 0; k < kParameters; ++k) {
      const double h = k < 3 ? 1e-4 * parameters_[k] : 1e-5;
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(kParameters, k);
      const Eigen::VectorXd expected = (Equilibrium(cables, parameters_ + step).x_m -
                                        Equilibrium(cables, parameters_ - step).x_m) /
                                       (2.0 * h);
      EXPECT_LE((dx_dp.col(k) - expected).norm(), 1e-5 * expected.norm()) << "parameter " << k;
    }
  }

  std::unique_ptr<RobotModel> model_ = Build(
      Changed("tet10", "tet4"), {.relative_tolerance = 1e-13, .constraint_tolerance_m = 1e-13});
  Eigen::VectorXd parameters_ =
      (Eigen::VectorXd(kParameters) << 65e3, 40e3, 70e3, 0.05, 0.1).finished();
};

TEST_F(SensitivityTest, WithoutCables) { ExpectEqualsDifferences({{}, {}}); }

TEST_F(SensitivityTest, UnderCableTension) { ExpectEqualsDifferences({Pull(0.8), Pull(0.3)}); }

TEST_F(SensitivityTest, UnderTautCablesOfGivenDisplacement) {
  model_->SetGravity(Eigen::Vector3d::Zero());
  const std::vector<ActuatorCommand> cables{Displace(0.003), Displace(0.002)};
  EXPECT_GT(Equilibrium(cables, parameters_).multipliers_N.minCoeff(), 0.01);
  ExpectEqualsDifferences(cables);
}

TEST_F(SensitivityTest, ASlackCableTakesNoPart) {
  const std::vector<ActuatorCommand> cables{Displace(0.004), Displace(-0.05)};
  EXPECT_EQ(Equilibrium(cables, parameters_).multipliers_N[1], 0.0);
  ExpectEqualsDifferences(cables);
}

TEST_F(SensitivityTest, ATautCableKeepsItsLength) {
  const std::vector<ActuatorCommand> cables{Displace(0.004), Pull(0.2)};
  const fem::StaticState state = Equilibrium(cables, parameters_);
  Eigen::MatrixXd dx_dp;
  ASSERT_TRUE(
      EquilibriumSensitivity(*model_, cables, state, ForceDerivative(state.x_m), &dx_dp).ok());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(state.x_m.size());
  model_->cable(0).AddGradient(state.x_m, 1.0, gradient);
  EXPECT_LE((gradient.transpose() * dx_dp).cwiseAbs().maxCoeff(),
            1e-10 * dx_dp.cwiseAbs().maxCoeff());
  Eigen::VectorXd other = Eigen::VectorXd::Zero(state.x_m.size());
  model_->cable(1).AddGradient(state.x_m, 1.0, other);
  EXPECT_GT((other.transpose() * dx_dp.rightCols(2)).cwiseAbs().minCoeff(), 1e-3);
}

TEST_F(SensitivityTest, CablesThatActAlikeAreRefused) {
  std::string text = Changed("tet10", "tet4");
  const std::string south = "  - {name: south, path_m: [[0, 0, -0.02], [0, 0.095, -0.009]]}\n";
  text.replace(text.find(south), south.size(),
               "  - {name: south, path_m: [[0, 0, 0.02], [0, 0.05, 0.0101], [0, 0.09, 0.009]], "
               "guide_radius_m: 0}\n");
  model_ = Build(text);
  fem::StaticState state = model_->RestState();
  ASSERT_TRUE(model_->Solve({Pull(0.3), Pull(0.3)}, {}, &state).status.ok());
  Eigen::MatrixXd dx_dp;
  const Status status = EquilibriumSensitivity(*model_, {Displace(0.0), Displace(0.0)}, state,
                                               Eigen::MatrixXd::Zero(state.x_m.size(), 1), &dx_dp);
  EXPECT_EQ(status.code(), StatusCode::kUnobservable);
}

}  // namespace
}  // namespace palpate::robot
