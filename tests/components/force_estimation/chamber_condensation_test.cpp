// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/fit/actuator_condensation.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

/// The linear response of the arm's three chambers about its undeformed shape; one force on it.
class ChamberCondensation : public testing::Test {
 protected:
  ChamberCondensation()
      : model_(Build(test_support::QuickRobot("pneumatic_arm"))),
        compliance_(model_->linearisation(), {Row()}),
        condensation_(1, model_->traits()) {
    const fem::StaticState rest = model_->RestState();
    const Eigen::VectorXd no_thrust_N = Eigen::VectorXd::Zero(3);
    EXPECT_TRUE(model_->linearisation()
                    .Update(rest.x_m, no_thrust_N, Eigen::VectorXd::Zero(rest.x_m.size()))
                    .ok());
    const auto patch = model_->Patch({0.02, 0.0, 0.075}, 0.004);
    compliance_.SetForces({{patch.weights, -patch.normal}});
    compliance_.Compute(rest.x_m, model_->actuator_rest_m(), no_thrust_N, Eigen::VectorXd::Zero(1));
  }

  robot::ObservationRow Row() const {
    return robot::RowOfPoint(model_->Patch({0.0, 0.0, 0.09}, 0.0).weights,
                             Eigen::Vector3d::UnitX());
  }

  /// The thrusts under these commands and a push of `push_N`.
  Eigen::VectorXd Settled(const std::vector<robot::ActuatorCommand>& commands, double push_N) {
    constexpr int kMost = 10;
    const Eigen::VectorXd lambda_f_N = Eigen::VectorXd::Constant(1, push_N);
    condensation_.Start(commands, Eigen::VectorXd::Zero(3));
    bool settled = false;
    for (int k = 0; k < kMost && !settled; ++k) {
      EXPECT_TRUE(condensation_.Condense(compliance_, commands).ok());
      settled = condensation_.Settle(compliance_, commands, lambda_f_N);
    }
    EXPECT_TRUE(settled);
    Eigen::VectorXd lambda_a_N;
    condensation_.CableForces(lambda_f_N, &lambda_a_N);
    return lambda_a_N;
  }

  robot::ActuatorCommand Volume(int chamber, double change_m3) const {
    return {robot::ActuatorCommand::Kind::kDisplacement,
            model_->traits(chamber).Displacement_m(change_m3)};
  }
  double Pressure_Pa(int chamber, const Eigen::VectorXd& lambda_a_N) const {
    return model_->traits(chamber).ReportedForce(lambda_a_N[chamber]);
  }
  /// Change of the chamber's volume, m3.
  double Change_m3(int chamber, const Eigen::VectorXd& lambda_a_N, double push_N) const {
    Eigen::VectorXd displacement_m;
    compliance_.CableDisplacements(lambda_a_N, Eigen::VectorXd::Constant(1, push_N),
                                   &displacement_m);
    return model_->traits(chamber).ReportedDisplacement(displacement_m[chamber]);
  }

  std::unique_ptr<robot::RobotModel> model_;
  robot::Compliance compliance_;
  ActuatorCondensation condensation_;
};

TEST_F(ChamberCondensation, HoldsAVolumeByAPressureBelowAmbient) {
  const double change_m3 = -1e-8;
  const Eigen::VectorXd thrust_N =
      Settled({Volume(0, change_m3), Volume(1, 0.0), Volume(2, 0.0)}, 0.3);
  EXPECT_LT(Pressure_Pa(0, thrust_N), 0.0);
  EXPECT_GT(Pressure_Pa(0, thrust_N), robot::kVacuum_Pa);
  EXPECT_NEAR(Change_m3(0, thrust_N, 0.3), change_m3, 1e-14);
  EXPECT_NEAR(Change_m3(1, thrust_N, 0.3), 0.0, 1e-14);
}

TEST_F(ChamberCondensation, AtAVacuumAChamberKeepsMoreThanItsCommandedVolume) {
  const double change_m3 = -1e-3;  // far more than the chamber holds
  const Eigen::VectorXd thrust_N =
      Settled({Volume(0, change_m3), Volume(1, 0.0), Volume(2, 0.0)}, 0.3);
  EXPECT_NEAR(Pressure_Pa(0, thrust_N), robot::kVacuum_Pa, 1e-6);
  EXPECT_GT(Change_m3(0, thrust_N, 0.3), change_m3);
  EXPECT_NEAR(Change_m3(1, thrust_N, 0.3), 0.0, 1e-14);
}

TEST_F(ChamberCondensation, APrescribedPressureIsTheSameWhateverPushes) {
  const robot::ActuatorCommand pressure{robot::ActuatorCommand::Kind::kTension,
                                        model_->traits(1).Force_N(-5e3)};
  const std::vector<robot::ActuatorCommand> commands{{}, pressure, Volume(2, 0.0)};
  for (const double push_N : {0.0, 0.5}) {
    const Eigen::VectorXd thrust_N = Settled(commands, push_N);
    EXPECT_NEAR(Pressure_Pa(0, thrust_N), 0.0, 1e-9);  // open to the air
    EXPECT_NEAR(Pressure_Pa(1, thrust_N), -5e3, 1e-6);
  }
}

}  // namespace
}  // namespace palpate::force_estimation
