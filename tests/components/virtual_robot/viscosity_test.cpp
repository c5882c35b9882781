// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/viscosity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "components/virtual_robot/bench_body.hpp"
#include "tests/components/virtual_robot/bench_setup.hpp"

namespace palpate::virtual_robot::test {
namespace {

class ViscoelasticLaw : public ::testing::Test {
 protected:
  fem::Viscosity Remembering(const std::vector<fem::PronyTerm>& prony, double damping_s) const {
    return {body_.mesh, body_.material_of_cell, prony, damping_s};
  }
  Eigen::VectorXd Mapped(const Eigen::Matrix3d& F) const {
    return (F * body_.mesh.nodes_m).reshaped();
  }
  Eigen::VectorXd Elastic_N(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    elastic_.AddForces(x_m, force_N);
    return force_N;
  }
  Eigen::VectorXd Force_N(const fem::Viscosity& memory, const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd force_N = memory.scale() * Elastic_N(x_m);
    memory.history().AddProduct(x_m, 1.0, force_N);
    return force_N;
  }

  BenchBody body_ =
      MakeBenchBody(BoxRobot({2, 1, 1}, {0.04, 0.02, 0.02}), PlainScenario().body, {});
  fem::ElasticBody elastic_{body_.mesh, body_.materials, body_.material_of_cell};
  Eigen::VectorXd ones_ = Eigen::VectorXd::Ones(body_.mesh.CellCount());
  Eigen::VectorXd rest_m_ = body_.rest_m();
};

TEST_F(ViscoelasticLaw, StressOfAHeldStretchRelaxesAsTheClosedForm) {
  fem::Viscosity memory = Remembering({{0.3, 2.0}, {0.2, 0.5}}, 0.0);
  const Eigen::VectorXd stretched_m = Mapped(Eigen::Vector3d(1.3, 0.9, 0.95).asDiagonal());
  memory.Reset(body_.materials, ones_, rest_m_);
  constexpr double kJump_s = 1e-7;
  memory.Prepare(kJump_s);
  memory.Advance(body_.materials, ones_, stretched_m, kJump_s);
  const Eigen::VectorXd settled_N = Elastic_N(stretched_m);
  constexpr double kStep_s = 0.05;
  for (int k = 1; k <= 40; ++k) {
    memory.Prepare(kStep_s);
    const double t_s = k * kStep_s;
    const double factor = 1.0 + 0.3 * std::exp(-t_s / 2.0) + 0.2 * std::exp(-t_s / 0.5);
    EXPECT_LE((Force_N(memory, stretched_m) - factor * settled_N).norm(), 1e-6 * settled_N.norm())
        << t_s;
    memory.Advance(body_.materials, ones_, stretched_m, kStep_s);
  }
}

TEST_F(ViscoelasticLaw, OfASteadyStretchingFollowsTheConvolutionIntegral) {
  fem::Viscosity memory = Remembering({{0.5, 0.4}}, 0.0);
  memory.Reset(body_.materials, ones_, rest_m_);
  constexpr double kRate_1_s = 1e-5;  // small: S grows in proportion
  constexpr double kStep_s = 0.1;
  for (int k = 1; k <= 10; ++k) {
    const double t_s = k * kStep_s;
    const Eigen::Matrix3d F =
        Eigen::Vector3d(1.0 + kRate_1_s * t_s, 1.0, 1.0).asDiagonal().toDenseMatrix();
    memory.Prepare(kStep_s);
    const double factor = 1.0 + 0.5 * 0.4 / t_s * (1.0 - std::exp(-t_s / 0.4));
    const Eigen::VectorXd x_m = Mapped(F);
    EXPECT_LE((Force_N(memory, x_m) - factor * Elastic_N(x_m)).norm(), 1e-4 * Elastic_N(x_m).norm())
        << t_s;
    memory.Advance(body_.materials, ones_, x_m, kStep_s);
  }
}

TEST_F(ViscoelasticLaw, FeelsNoRotation) {
  fem::Viscosity memory = Remembering({{0.5, 0.4}}, 1e-2);
  memory.Reset(body_.materials, ones_, rest_m_);
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  const double stiff_N = Elastic_N(Mapped(Eigen::Vector3d(1.1, 1.0, 1.0).asDiagonal())).norm();
  for (int k = 1; k <= 10; ++k) {
    const Eigen::VectorXd x_m = Mapped(Eigen::AngleAxisd(0.3 * k, axis).toRotationMatrix());
    memory.Prepare(0.01);
    EXPECT_LE(Force_N(memory, x_m).norm(), 1e-12 * stiff_N);
    memory.Advance(body_.materials, ones_, x_m, 0.01);
  }
}

TEST_F(ViscoelasticLaw, OfAStretchTurnsWithTheBody) {
  fem::Viscosity memory = Remembering({{0.5, 0.4}}, 1e-2);
  memory.Reset(body_.materials, ones_, rest_m_);
  const Eigen::Matrix3d F = Eigen::Vector3d(1.2, 0.95, 1.0).asDiagonal();
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  memory.Advance(body_.materials, ones_, Mapped(F), 0.01);
  memory.Prepare(0.1);
  const Eigen::VectorXd straight_N = Force_N(memory, Mapped(F));
  const Eigen::VectorXd turned_N = Force_N(memory, Mapped(R * F));
  const Eigen::VectorXd expected_N = (R * straight_N.reshaped(3, straight_N.size() / 3)).reshaped();
  EXPECT_LE((turned_N - expected_N).norm(), 1e-12 * straight_N.norm());
}

TEST_F(ViscoelasticLaw, OfDampingIsTheRateOfTheElasticForceForSmallStrains) {
  constexpr double kDamping_s = 0.02;
  constexpr double kStep_s = 0.01;
  fem::Viscosity memory = Remembering({}, kDamping_s);
  memory.Reset(body_.materials, ones_, rest_m_);
  memory.Prepare(kStep_s);
  const Eigen::VectorXd x_m = Mapped(Eigen::Vector3d(1.0 + 1e-6, 1.0, 1.0).asDiagonal());
  const Eigen::VectorXd elastic_N = Elastic_N(x_m);
  EXPECT_LE((Force_N(memory, x_m) - (1.0 + kDamping_s / kStep_s) * elastic_N).norm(),
            1e-5 * elastic_N.norm());
}

TEST(Creep, UnderAWeightGrowsFromTheInstantaneousToTheSettledShape) {
  robot::RobotDescription box = BoxRobot({4, 2, 2}, {0.06, 0.03, 0.03});
  box.gravity_m_s2 = {0.0, 0.0, -9.81};
  box.mass.density_kg_m3 = 1e-3;
  const Effects creep = {Effect("viscoelastic_creep", {"body"}, {{"g", 0.4}, {"tau_s", 1.0}})};
  VirtualRobot robot(box, PlainScenario(), creep, 1);
  ASSERT_TRUE(robot.Start(0.0, NoInputs(0)).ok());
  const auto tip_m = [&] {
    return robot.positions_m().reshaped(3, robot.mesh().NodeCount()).row(2).minCoeff();
  };
  Inputs hung = NoInputs(0);
  hung.weights = {Weight({0.06, 0.015, 0.015}, 1e-3, 0.012)};
  ASSERT_TRUE(robot.Advance(1e-4, hung).ok());
  const double at_once_m = tip_m();
  ASSERT_TRUE(robot.Advance(15.0, hung).ok());
  EXPECT_NEAR(tip_m() / at_once_m, 1.4, 0.01);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
