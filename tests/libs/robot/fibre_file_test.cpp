// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "libs/core/error.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "libs/robot/fibre_paths.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kHelix =
    "{name: thread, helix: {axis_m: [[0, 0.01, 0], [0, 0.09, 0]], radius_m: 0.007, pitch_m: "
    "0.01}, axial_stiffness_N: 200}";

std::string WithFibres(const std::string& fibres) {
  return Changed("regions:\n", "fibres:\n  - " + fibres + "\nregions:\n");
}

/// The beam of the full robot file: 0.1 m along y, x and z from -0.01 to 0.01 m.
class FibreFile : public testing::Test {
 protected:
  FibreFile() { WriteVtk(Beam_mm(), folder_ / "beam.vtk"); }

  RobotBody Build(const std::string& text) const {
    return BuildRobotBody(ReadText(text, folder_ / "robot.yaml"));
  }
  std::string BuildRefusal(const std::string& text) const {
    try {
      Build(text);
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }

  TestFolder folder_;
};

TEST_F(FibreFile, AHelixHasItsTurnsAndItsLength) {
  const RobotBody body = Build(WithFibres(kHelix));
  ASSERT_EQ(body.fibres.size(), 1u);
  const BodyFibre& fibre = body.fibres[0];
  ASSERT_EQ(fibre.paths_m.size(), 1u);
  const Eigen::Matrix3Xd& path_m = fibre.paths_m[0];
  EXPECT_LE((path_m.col(0) - Eigen::Vector3d(0.007, 0.01, 0)).norm(), 1e-12);
  EXPECT_LE((path_m.rightCols(1) - Eigen::Vector3d(0.007, 0.09, 0)).norm(), 1e-12);
  for (const auto& point_m : path_m.colwise()) {
    EXPECT_NEAR(std::hypot(point_m.x(), point_m.z()), 0.007, 1e-12);
  }
  // A right-handed screw along +y turns from +x to -z.
  EXPECT_LT(path_m(2, 1), 0.0);
  const double exact_m = 8.0 * std::hypot(2.0 * std::numbers::pi * 0.007, 0.01);
  EXPECT_NEAR(fibre.length_m, exact_m, 0.002 * exact_m);
  EXPECT_EQ(fibre.embedded.axial_stiffness_N, 200.0);
}

TEST_F(FibreFile, TheOtherHandIsItsMirrorImage) {
  const RobotBody right = Build(WithFibres(kHelix));
  std::string text = kHelix;
  text.replace(text.find("pitch_m: 0.01"), 13, "turns: 8, hand: left");
  const RobotBody left = Build(WithFibres(text));
  const Eigen::Vector3d mirror(1.0, 1.0, -1.0);
  EXPECT_LE((mirror.asDiagonal() * right.fibres[0].paths_m[0] - left.fibres[0].paths_m[0]).norm(),
            1e-12);
}

TEST_F(FibreFile, RingsAreClosedAndEvenlySpaced) {
  for (const std::string spacing : {"count: 5", "spacing_m: 0.02"}) {
    const RobotBody body =
        Build(WithFibres("{name: rings, rings: {axis_m: [[0, 0.01, 0], [0, 0.09, 0]], radius_m: "
                         "0.007, " +
                         spacing + "}}"));
    const BodyFibre& fibre = body.fibres[0];
    ASSERT_EQ(fibre.paths_m.size(), 5u);
    for (size_t k = 0; k < 5; ++k) {
      const Eigen::Matrix3Xd& path_m = fibre.paths_m[k];
      EXPECT_NEAR(path_m(1, 0), 0.01 + 0.02 * static_cast<double>(k), 1e-12);
      EXPECT_LE((path_m.col(0) - path_m.rightCols(1)).norm(), 1e-12);
    }
  }
}

/// Where no stiffness is given it is that of 30 times the body of its largest modulus.
TEST_F(FibreFile, AnInextensibleFibreIsStiffAgainstTheBody) {
  const RobotBody body = Build(WithFibres("{name: l, path_m: [[0, 0.01, 0], [0, 0.09, 0]]}"));
  const double diagonal_m = std::sqrt(0.1 * 0.1 + 2.0 * 0.02 * 0.02);
  EXPECT_NEAR(body.fibres[0].embedded.axial_stiffness_N,
              30.0 * 65e3 * (0.1 * 0.02 * 0.02) / diagonal_m, 1e-6);
}

/// The beam hangs from its root along gravity: a fibre on its axis takes its load.
TEST_F(FibreFile, AnInextensibleFibreKeepsItsLengthWhereTheBodyStretches) {
  std::string plain = Changed("gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: [0, 9.81, 0]");
  std::string held = plain;
  held.insert(held.find("regions:\n"), "fibres: [{name: l, path_m: [[0, 0, 0], [0, 0.1, 0]]}]\n");
  const auto longer_m = [&](const std::string& text) {
    RobotModel model(Build(text));
    fem::StaticState state = model.RestState();
    const auto result = model.Solve({{}, {}}, {}, &state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    const Eigen::Vector3d tip_m =
        model.locator().Embed({0.0, 0.1, 0.0}).weights.Position(state.x_m);
    return tip_m.y() - 0.1;
  };
  const double free_m = longer_m(plain);
  EXPECT_GT(free_m, 0.005);
  EXPECT_LT(longer_m(held), 0.05 * free_m);
}

TEST_F(FibreFile, AScaledBodyHasNoForceAtRest) {
  RobotBody body = Build(WithFibres(kHelix));
  ScaleBody(1.5, &body);
  RobotModel model(std::move(body));
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(model.elastic_body().rest_m().size());
  model.elastic_body().fibres().AddForces(model.elastic_body().rest_m(), force_N);
  EXPECT_LE(force_N.cwiseAbs().maxCoeff(), 1e-11);
}

TEST_F(FibreFile, WhatLeavesTheBodyIsRefusedWithThePlace) {
  const std::string refusal =
      BuildRefusal(WithFibres("{name: out, path_m: [[0, 0.01, 0], [0, 0.05, 0.03]]}"));
  EXPECT_THAT(refusal, StartsWith((folder_ / "robot.yaml").string() + ":12:"));
  EXPECT_THAT(refusal, AllOf(HasSubstr("fibre 'out' leaves the body near (0, "),
                             HasSubstr("mm from it; allowed are 1 mm")));
}

TEST_F(FibreFile, WhatIsJustOutsideIsNoted) {
  const RobotBody body =
      Build(WithFibres("{name: skin, path_m: [[0.0105, 0.01, 0], [0.0105, 0.09, 0]]}"));
  EXPECT_THAT(body.notes, testing::Contains(HasSubstr("fibre skin 0.5 mm outside the mesh")));
}

TEST(FibreKeysOfTheRobotFile, AreChecked) {
  const auto refused = [](const std::string& fibre) { return RefusalOf(WithFibres(fibre)); };
  EXPECT_THAT(refused("{name: l, path_m: [[0, 0, 0], [0, 0.1, 0]], axial_stiffness_N: 0}"),
              AllOf(HasSubstr("robot.yaml:12:"), HasSubstr("axial_stiffness_N")));
  EXPECT_THAT(refused("{name: l, path_m: [[0, 0, 0], [0, 0.1, 0]], axial_stiffness_N: .nan}"),
              HasSubstr("axial_stiffness_N"));
  EXPECT_THAT(refused("{name: l, path_m: [[0, 0, 0], [0, 0, 0]]}"),
              AllOf(HasSubstr("robot.yaml:12:"), HasSubstr("same point")));
  EXPECT_THAT(refused("{name: l, path_m: [[0, 0, 0]]}"), HasSubstr("at least 2 points"));
  EXPECT_THAT(refused("{name: l}"), HasSubstr("path_m"));
  EXPECT_THAT(refused("{name: l, rings: {axis_m: [[0, 0, 0], [0, 0, 0]], radius_m: 1, count: 2}}"),
              HasSubstr("same point"));
  EXPECT_THAT(refused("{name: l, rings: {axis_m: [[0, 0, 0], [0, 1, 0]], radius_m: 0, count: 2}}"),
              HasSubstr("radius_m"));
  EXPECT_THAT(refused("{name: l, rings: {axis_m: [[0, 0, 0], [0, 1, 0]], radius_m: 1}}"),
              HasSubstr("count"));
  EXPECT_THAT(
      refused("{name: l, helix: {axis_m: [[0, 0, 0], [0, 1, 0]], radius_m: 1, pitch_m: 1e-7}}"),
      HasSubstr("10000 turns"));
  EXPECT_THAT(refused("{name: l, path_mm: [[0, 0, 0], [0, 0.1, 0]]}"), HasSubstr("path_m"));
  EXPECT_THAT(refused("{name: l, path_m: [[0, 0, 0], [0, 0.1, 0]]}\n"
                      "  - {name: l, path_m: [[0, 0, 0], [0, 0.1, 0]]}"),
              HasSubstr("given twice"));
}

}  // namespace
}  // namespace palpate::robot
