// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using RobotModelTest = BeamModelTest;

std::string Replaced(std::string text, const std::string& old_text, const std::string& new_text) {
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

/// The beam of one stiff material, its cable led by wide eyelets, as linear tetrahedra.
std::string StiffBeam(const std::string& law) {
  std::string text = Changed("stable_neo_hookean", law);
  text = Replaced(text, "element: tet10", "element: tet4");
  text = Replaced(text, "65.0e3", "180e3");
  text = Replaced(text, "30e3", "180e3");
  return Replaced(text, "guide_radius_m: 0}", "guide_radius_m: 0.004}");
}

TEST_F(RobotModelTest, HangsUnderItsWeight) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  ASSERT_TRUE(model->Solve({{}, {}}, {}, &state).status.ok());
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(state.x_m.size());
  model->AddWeight(weight);
  EXPECT_NEAR(weight.reshaped(3, weight.size() / 3).row(2).sum(), -0.5 * 9.81, 1e-12);
  EXPECT_LE(weight.reshaped(3, weight.size() / 3).topRows(2).norm(), 0.0);
  const auto z = [&](const fem::StaticState& of) {
    return model->body().markers[1].point.weights.Position(of.x_m).z();
  };
  EXPECT_LT(z(state), -0.002);

  model->SetGravity(Eigen::Vector3d::Zero());
  fem::StaticState weightless = model->RestState();
  ASSERT_TRUE(model->Solve({{}, {}}, {}, &weightless).status.ok());
  EXPECT_NEAR(z(weightless), 0.0, 1e-12);
}

TEST_F(RobotModelTest, ATautCableHasTheCommandedLengthAndASlackOneNoTension) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  const fem::StaticResult result = model->Solve({Displace(0.008), Displace(-0.02)}, {}, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  const ActuatorState north = model->StateOfActuator(0, state);
  EXPECT_NEAR(north.displacement_m, 0.008, 1e-9);
  EXPECT_NEAR(north.length_m, model->actuator_rest_m()[0] - 0.008, 1e-9);
  EXPECT_GT(north.tension_N, 0.1);
  const ActuatorState south = model->StateOfActuator(1, state);
  EXPECT_EQ(south.tension_N, 0.0);
  EXPECT_GT(south.displacement_m, -0.02);
}

TEST_F(RobotModelTest, ACableGoesSlackAndTautAgain) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  ASSERT_TRUE(model->Solve({Displace(0.005), {}}, {}, &state).status.ok());
  const Eigen::VectorXd pulled = state.x_m;
  ASSERT_TRUE(model->Solve({Displace(-0.06), {}}, {}, &state).status.ok());
  EXPECT_EQ(state.multipliers_N[0], 0.0);
  ASSERT_TRUE(model->Solve({Displace(0.005), {}}, {}, &state).status.ok());
  EXPECT_LE((state.x_m - pulled).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(RobotModelTest, TheTensionOfADisplacementGivesThatDisplacement) {
  const auto model = Build(FullRobotText());
  fem::StaticState by_displacement = model->RestState();
  ASSERT_TRUE(model->Solve({Displace(0.006), Displace(0.001)}, {}, &by_displacement).status.ok());
  fem::StaticState by_tension = model->RestState();
  const Eigen::VectorXd& tension_N = by_displacement.multipliers_N;
  ASSERT_TRUE(model->Solve({Pull(tension_N[0]), Pull(tension_N[1])}, {}, &by_tension).status.ok());
  EXPECT_LE((by_tension.x_m - by_displacement.x_m).cwiseAbs().maxCoeff(), 1e-8);
}

/// By full steps and by a line search, from rest in one go.
TEST_F(RobotModelTest, ACableThatStretchesIsShorterByLess) {
  for (const int full_steps : {fem::StaticSettings{}.max_full_steps, 0}) {
    for (const double compliance_m_N : {1e-3, -1e-4}) {
      const auto model = Build(FullRobotText(), {.max_full_steps = full_steps});
      model->SetCableCompliance(0, compliance_m_N);
      model->SetCableCompliance(1, compliance_m_N);
      fem::StaticState state = model->RestState();
      const fem::StaticResult result = model->Solve({Displace(0.012), Displace(-0.03)}, {}, &state);
      ASSERT_TRUE(result.status.ok()) << result.status.message();
      const ActuatorState north = model->StateOfActuator(0, state);
      ASSERT_GT(north.tension_N, 0.1);
      const double stretch_m = compliance_m_N * north.tension_N;
      EXPECT_NEAR(north.length_m, model->actuator_rest_m()[0] - 0.012 + stretch_m, 1e-9);
      EXPECT_NEAR(north.displacement_m, 0.012, 1e-9);
      EXPECT_EQ(model->StateOfActuator(1, state).tension_N, 0.0);
      const auto stiff = Build(FullRobotText());
      fem::StaticState held = stiff->RestState();
      ASSERT_TRUE(stiff->Solve({Displace(0.012 - stretch_m), {}}, {}, &held).status.ok());
      EXPECT_LE((state.x_m - held.x_m).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

/// Each is counted from where the one before left the cable.
TEST_F(RobotModelTest, ACableThatStretchesIsPulledOnInSmallerPieces) {
  const auto model = Build(FullRobotText(), {.max_newton_iterations = 10, .max_full_steps = 3});
  model->SetCableCompliance(0, 2e-3);
  fem::StaticState state = model->RestState();
  const fem::StaticResult result = model->Solve({Displace(0.02), {}}, {}, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_GT(result.load_steps, 1);
  EXPECT_NEAR(model->StateOfActuator(0, state).displacement_m, 0.02, 1e-9);
}

TEST_F(RobotModelTest, ReachesTwentyMillimetresOfCableInOneGo) {
  for (const char* law : {"neo_hookean", "stable_neo_hookean", "corotational"}) {
    const auto model = Build(StiffBeam(law));
    fem::StaticState state = model->RestState();
    const fem::StaticResult result = model->Solve({Displace(0.020), {}}, {}, &state);
    ASSERT_TRUE(result.status.ok()) << law << ": " << result.status.message();
    EXPECT_NEAR(model->StateOfActuator(0, state).displacement_m, 0.020, 1e-9);
    EXPECT_LE(result.residual_relative, 1e-10);
  }
}

TEST_F(RobotModelTest, TakesDeadLoads) {
  const auto model = Build(FullRobotText());
  const DeadLoad load{model->body().markers[0].point.weights, {0.0, 0.1, 0.4}};
  const fem::LoadState loads = model->Loads({{}, {}}, {load});
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(loads.external_force_N.size());
  model->AddWeight(weight);
  const Eigen::VectorXd rest = loads.external_force_N - weight;
  const Eigen::Vector3d sum = rest.reshaped(3, rest.size() / 3).rowwise().sum();
  EXPECT_LE((sum - load.force_N).norm(), 1e-13);
  fem::StaticState without = model->RestState();
  fem::StaticState with = model->RestState();
  ASSERT_TRUE(model->Solve({{}, {}}, {}, &without).status.ok());
  ASSERT_TRUE(model->Solve({{}, {}}, {load}, &with).status.ok());
  EXPECT_GT((load.weights.Position(with.x_m) - load.weights.Position(without.x_m)).z(), 1e-3);
}

TEST_F(RobotModelTest, NamesTheCableThatReachesItsTensionLimit) {
  const auto model =
      Build(Replaced(StiffBeam("stable_neo_hookean"), "max_tension_N: 20", "max_tension_N: 1.5"));
  model->SetGravity(Eigen::Vector3d::Zero());
  fem::StaticState state = model->RestState();
  ASSERT_TRUE(model->Solve({Displace(0.0005), {}}, {}, &state).status.ok());
  const Eigen::VectorXd before = state.x_m;
  const fem::StaticResult result = model->Solve({Displace(0.015), {}}, {}, &state);
  EXPECT_EQ(result.status.code(), StatusCode::kTensionLimit);
  EXPECT_THAT(result.status.message(),
              AllOf(HasSubstr("cable north"), HasSubstr("0.015"), HasSubstr("1.5")));
  EXPECT_EQ(state.x_m, before);
  EXPECT_EQ(result.multipliers_N[0], 1.5);
}

TEST_F(RobotModelTest, RefusesATensionOutOfRange) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  for (const double tension_N : {-0.1, 20.5, std::nan("")}) {
    const fem::StaticResult result = model->Solve({Pull(tension_N), {}}, {}, &state);
    EXPECT_EQ(result.status.code(), StatusCode::kTensionLimit);
    EXPECT_THAT(result.status.message(), HasSubstr("cable north"));
  }
  EXPECT_EQ(state.x_m, model->RestState().x_m);
}

TEST_F(RobotModelTest, SaysThatNoEquilibriumHasThisDisplacement) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  // The whole cable is shorter than that.
  const fem::StaticResult result = model->Solve({Displace(0.2), {}}, {}, &state);
  EXPECT_FALSE(result.status.ok());
  EXPECT_FALSE(result.status.message().empty());
  EXPECT_LT(result.load_fraction, 1.0);
  EXPECT_FALSE(model->Solve({Displace(std::nan("")), {}}, {}, &state).status.ok());
}

TEST_F(RobotModelTest, ChoosesTheCommandThatIsKnown) {
  const auto kind = [](std::optional<double> displacement_m, std::optional<double> tension_N,
                       CableInput preferred) {
    return ChooseCommand(displacement_m, tension_N, preferred).kind;
  };
  using Kind = ActuatorCommand::Kind;
  EXPECT_EQ(kind({}, {}, CableInput::kTension), Kind::kNone);
  EXPECT_EQ(kind(0.01, {}, CableInput::kTension), Kind::kDisplacement);
  EXPECT_EQ(kind({}, 2.0, CableInput::kDisplacement), Kind::kTension);
  EXPECT_EQ(kind(0.01, 2.0, CableInput::kDisplacement), Kind::kDisplacement);
  EXPECT_EQ(kind(0.01, 2.0, CableInput::kTension), Kind::kTension);
  EXPECT_EQ(ChooseCommand(0.01, 2.0, CableInput::kTension).value, 2.0);
  EXPECT_EQ(ChooseCommand(0.01, 2.0, CableInput::kDisplacement).value, 0.01);
}

TEST_F(RobotModelTest, KnowsItsNames) {
  const auto model = Build(FullRobotText());
  EXPECT_EQ(model->ActuatorNames(), (std::vector<std::string>{"north", "south"}));
  EXPECT_EQ(model->MarkerNames(), (std::vector<std::string>{"m1", "2"}));
  const fem::SurfacePatch patch = model->Patch({0.0, 0.05, 0.01}, 0.004);
  EXPECT_LE((patch.centre_m - Eigen::Vector3d(0.0, 0.05, 0.01)).norm(), 1e-4);
}

TEST_F(RobotModelTest, ASofterRegionBendsMore) {
  const auto model = Build(FullRobotText());
  const auto sag = [&] {
    fem::StaticState state = model->RestState();
    EXPECT_TRUE(model->Solve({{}, {}}, {}, &state).status.ok());
    return -model->body().markers[0].point.weights.Position(state.x_m).z();
  };
  const double stiff = sag();
  model->SetYoungsModulus(2, 20e3);  // the root
  EXPECT_EQ(model->body().materials[2].youngs_modulus_Pa, 20e3);
  EXPECT_GT(sag(), stiff + 0.002);
}

TEST_F(RobotModelTest, CommandsMustBeAsManyAsActuators) {
  const auto model = Build(FullRobotText());
  fem::StaticState state = model->RestState();
  EXPECT_DEATH(static_cast<void>(model->Solve({{}}, {}, &state)), "ActuatorCount");
}

}  // namespace
}  // namespace palpate::robot
