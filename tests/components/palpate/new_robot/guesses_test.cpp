// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "components/palpate/new_robot/body_shape.hpp"
#include "components/palpate/new_robot/cable_routes.hpp"
#include "components/palpate/new_robot/channels.hpp"
#include "components/palpate/new_robot/fixed_boxes.hpp"
#include "components/palpate/new_robot/fixed_region.hpp"
#include "components/palpate/new_robot/silicones.hpp"
#include "components/palpate/new_robot/unit_guess.hpp"
#include "libs/core/index.hpp"
#include "tests/components/palpate/new_robot/drawn_mesh.hpp"

namespace palpate::command {
namespace {

using Eigen::Vector3d;
using test::Bar;
using test::DrawnGroup;
using test::Moved;
using test::Tube;
using test::WriteMsh;
using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

const Vector3d kUp = Vector3d::UnitZ();

class NewRobotGuess : public testing::Test {
 protected:
  SourceMesh Read(const fem::TetMesh& mesh, const std::vector<DrawnGroup>& groups = {}) const {
    return ReadSourceMesh(WriteMsh(folder_, "mesh.msh", mesh, groups));
  }
  Decision UnitOf(double length) const {
    return DecideUnit(Read(Bar({length, 0.2 * length, 0.2 * length}, {5, 1, 1})), "");
  }

  TestFolder folder_;
};

TEST_F(NewRobotGuess, TakesTheUnitInWhichTheBodyHasTheSizeOfARobot) {
  EXPECT_EQ(UnitOf(120).value, "mm");
  EXPECT_EQ(UnitOf(120).trust, Trust::kLikely);
  EXPECT_EQ(UnitOf(0.12).value, "m");
  EXPECT_EQ(UnitOf(0.12).trust, Trust::kLikely);
  EXPECT_EQ(UnitOf(12).trust, Trust::kUnsure);  // 12 mm or 12 cm
  EXPECT_THAT(UnitOf(120).why, AllOf(HasSubstr("120 mm as mm"), HasSubstr("120 m as m")));
}

TEST_F(NewRobotGuess, BelievesAUnitThatTheFileSays) {
  const auto file = folder_.Write("mesh.inp",
                                  "** exported, UNITS: cm\n*NODE\n1,0,0,0\n2,120,0,0\n3,0,20,0\n"
                                  "4,0,0,20\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n");
  const Decision unit = DecideUnit(ReadSourceMesh(file), "");
  EXPECT_EQ(unit.value, "cm");
  EXPECT_EQ(unit.trust, Trust::kNamed);
  EXPECT_THAT(unit.why, HasSubstr("UNITS: cm"));
}

/// Nodes of the region at the guessed place, and the reason.
FixedRegion GuessOf(const SourceMesh& source, const std::vector<Vector3d>& pulls_m = {},
                    const Vector3d& up = kUp) {
  return GuessFixed(source, MeasureShape(source.mesh), pulls_m, up);
}

TEST_F(NewRobotGuess, FixesAGroupThatIsNamedSo) {
  const DrawnGroup clamp{.name = "FixedFace",
                         .holds = [](const Vector3d& at) { return at.x() > 0.0999; }};
  const FixedRegion fixed = GuessOf(Read(Bar({0.1, 0.02, 0.02}, {5, 2, 2}), {clamp}));
  EXPECT_EQ(fixed.decision.trust, Trust::kNamed);
  EXPECT_THAT(fixed.decision.value, HasSubstr("FixedFace"));
  EXPECT_EQ(fixed.nodes.size(), 25U);  // 9 corners, 16 middles
  EXPECT_NEAR(fixed.centre_m.x(), 0.1, 1e-9);
}

TEST_F(NewRobotGuess, FixesTheLargerEndOfATaperedBody) {
  const fem::TetMesh trunk = Moved(Bar({0.02, 0.02, 0.1}, {2, 2, 5}), [](const Vector3d& at) {
    const double wide = 1.0 - 4.0 * at.z();
    return Vector3d(wide * (at.x() - 0.01), wide * (at.y() - 0.01), -at.z());
  });
  // Mirrored in z, so it hangs; the elements are then turned by the reader.
  const FixedRegion fixed = GuessOf(Read(trunk));
  EXPECT_EQ(fixed.decision.trust, Trust::kLikely);
  EXPECT_THAT(fixed.decision.why, HasSubstr("larger"));
  EXPECT_NEAR(fixed.centre_m.z(), 0.0, 1e-9);
}

TEST_F(NewRobotGuess, SaysThatEqualEndsAreAGuessAndTakesTheOneThatHoldsTheOrigin) {
  const FixedRegion fixed = GuessOf(Read(Bar({0.1, 0.02, 0.02}, {5, 2, 2})));
  EXPECT_EQ(fixed.decision.trust, Trust::kUnsure);
  EXPECT_THAT(fixed.decision.why, AllOf(HasSubstr("alike"), HasSubstr("origin")));
  EXPECT_NEAR(fixed.centre_m.x(), 0.0, 1e-9);
}

TEST_F(NewRobotGuess, FixesTheEndFromWhichCablesArePulled) {
  const FixedRegion fixed =
      GuessOf(Read(Bar({0.1, 0.02, 0.02}, {5, 2, 2})), {Vector3d(0.11, 0.01, 0.015)});
  EXPECT_EQ(fixed.decision.trust, Trust::kLikely);
  EXPECT_NEAR(fixed.centre_m.x(), 0.1, 1e-9);
}

TEST_F(NewRobotGuess, FixesTheLowestFaceOfACompactBodyWhereverUpIs) {
  const SourceMesh block = Read(Bar({0.05, 0.05, 0.06}, {2, 2, 2}));
  EXPECT_NEAR(GuessOf(block).centre_m.z(), 0.0, 1e-9);
  EXPECT_NEAR(GuessOf(block, {}, -kUp).centre_m.z(), 0.06, 1e-9);
}

TEST_F(NewRobotGuess, FixesAllFeetInOnePlane) {
  // A table: two feet of a quarter of its length, and the plate above.
  fem::TetMesh table = Bar({0.04, 0.01, 0.03}, {4, 1, 3});
  std::vector<int> kept;
  for (int cell = 0; cell < table.CellCount(); ++cell) {
    const Vector3d at_m = table.nodes_m(Eigen::all, table.cells.col(cell)).rowwise().mean();
    if (at_m.z() > 0.02 || at_m.x() < 0.01 || at_m.x() > 0.03) kept.push_back(cell);
  }
  table.cells = table.cells(Eigen::all, kept).eval();
  const FixedRegion fixed = GuessOf(Read(table));
  EXPECT_NEAR(fixed.centre_m.z(), 0.0, 1e-9);
  EXPECT_NEAR(fixed.centre_m.x(), 0.02, 1e-9);
  EXPECT_EQ(fixed.nodes.size(), 18U);  // 4 corners and 5 middles of each foot
}

TEST_F(NewRobotGuess, FixesWhatAWordNames) {
  const SourceMesh bar = Read(Bar({100, 20, 20}, {5, 2, 2}));
  fem::TetMesh in_m = bar.mesh;
  in_m.nodes_m *= 1e-3;
  const BodyShape shape = MeasureShape(in_m);
  EXPECT_NEAR(FixedByWords({"x_max"}, bar, shape, 1e-3).centre_m.x(), 0.1, 1e-9);
  EXPECT_EQ(FixedByWords({"0,0,0;20,20,20"}, bar, shape, 1e-3).nodes.size(), 75U);
  EXPECT_EQ(FixedByWords({"x_min", "x_max"}, bar, shape, 1e-3).nodes.size(), 50U);
  EXPECT_THAT(MessageOf([&] { FixedByWords({"x_mni"}, bar, shape, 1e-3); }),
              AllOf(HasSubstr("did you mean 'x_min'"), HasSubstr("the mesh has no groups")));
  EXPECT_THAT(MessageOf([&] { FixedByWords({"0,0,0;0,20,0"}, bar, shape, 1e-3); }),
              HasSubstr("span a triangle"));
}

TEST_F(NewRobotGuess, CoversAnObliqueFaceByBoxesThatHoldNoOtherNode) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const SourceMesh source = Read(Moved(Bar({0.1, 0.02, 0.02}, {5, 2, 2}),
                                       [&](const Vector3d& at) { return Vector3d(turn * at); }));
  const BodyShape shape = MeasureShape(source.mesh);
  const FixedRegion fixed = GuessFixed(source, shape, {}, kUp);
  std::vector<int> held;
  for (int node = 0; node < shape.mesh.NodeCount(); ++node) {
    const bool inside = std::any_of(fixed.boxes.begin(), fixed.boxes.end(), [&](const auto& box) {
      return box.Contains(shape.mesh.nodes_m.col(node));
    });
    if (inside) held.push_back(node);
  }
  EXPECT_EQ(fixed.nodes.size(), 25U);
  EXPECT_EQ(held, fixed.nodes);
  EXPECT_GT(fixed.boxes.size(), 1U);
  for (const int node : held) {
    EXPECT_NEAR((turn.transpose() * shape.mesh.nodes_m.col(node)).x(), 0.0, 1e-9);
  }
}

TEST_F(NewRobotGuess, FindsAStraightChannelAndNoOtherHole) {
  const BodyShape tube = MeasureShape(Tube(0.001, 0.012, 0.08));
  const std::vector<Channel> channels = FindChannels(tube);
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_NEAR(channels[0].radius_m, 0.001, 1e-6);
  EXPECT_NEAR((channels[0].end_m - channels[0].start_m).norm(), 0.08, 1e-9);
  EXPECT_NEAR(channels[0].start_m.head<2>().norm(), 0.0, 1e-9);
  EXPECT_TRUE(FindChannels(MeasureShape(Tube(0.009, 0.012, 0.08))).empty());  // a wide chamber
  EXPECT_TRUE(FindChannels(MeasureShape(Tube(0.001, 0.012, 0.01))).empty());  // a short hole
  EXPECT_TRUE(FindChannels(MeasureShape(Bar({0.1, 0.02, 0.02}, {5, 2, 2}))).empty());
  // The outside of a thin tube is round and long, too, and no hole.
  const auto thin = FindChannels(MeasureShape(Tube(0.0005, 0.001, 0.08)));
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_NEAR(thin[0].radius_m, 0.0005, 1e-6);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.0, Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  const auto turned = FindChannels(MeasureShape(
      Moved(Tube(0.001, 0.012, 0.08), [&](const Vector3d& at) { return Vector3d(turn * at); })));
  ASSERT_EQ(turned.size(), 1U);
  EXPECT_NEAR(std::abs((turned[0].end_m - turned[0].start_m).normalized().dot(turn.col(2))), 1.0,
              1e-9);
}

TEST_F(NewRobotGuess, RunsACableThroughAChannelFromTheFixedEnd) {
  const SourceMesh source = Read(Tube(0.001, 0.012, 0.08));
  const BodyShape shape = MeasureShape(source.mesh);
  const auto cables = GuessCables(source, shape, FindChannels(shape), {0, 0, 0.08});
  ASSERT_EQ(cables.size(), 1U);
  EXPECT_NEAR(cables[0].path_m.col(0).z(), 0.08, 1e-9);
  EXPECT_GE(cables[0].path_m.cols(), 4);
  EXPECT_GT(cables[0].guide_radius_m, cables[0].channel_radius_m);
  RefuseFarPoints(shape, cables[0], 1.0);
}

TEST_F(NewRobotGuess, ReadsCablesFromNamedPointsAndCurves) {
  const auto at = [](double x, double z) {
    return [x, z](const Vector3d& node) { return (node - Vector3d(x, 0.01, z)).norm() < 1e-6; };
  };
  const SourceMesh source =
      Read(Bar({0.1, 0.02, 0.02}, {5, 2, 2}),
           {{.name = "cable_up_2", .dimension = 0, .holds = at(0.1, 0.02)},
            {.name = "cable_up_1", .dimension = 0, .holds = at(0.0, 0.02)},
            {.name = "tendonDown",
             .dimension = 1,
             .chain = {{0.1, 0.01, 0}, {0.06, 0.01, 0}, {0.02, 0.01, 0}, {0, 0.01, 0}}},
            {.name = "tip", .dimension = 0, .holds = at(0.1, 0.01)}});
  const BodyShape shape = MeasureShape(source.mesh);
  auto cables = GuessCables(source, shape, {}, {0, 0.01, 0.01});
  ASSERT_EQ(cables.size(), 2U);
  EXPECT_EQ(cables[0].name, "up");
  EXPECT_EQ(cables[0].trust, Trust::kNamed);
  EXPECT_NEAR(cables[0].path_m(0, 0), 0.0, 1e-9);
  EXPECT_EQ(cables[0].path_m.cols(), 2);
  AddEyelets(shape, &cables[0]);
  EXPECT_GE(cables[0].path_m.cols(), 4);
  EXPECT_EQ(cables[1].name, "down");
  EXPECT_EQ(cables[1].path_m.cols(), 4);
  EXPECT_NEAR(cables[1].path_m(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(cables[1].path_m(0, 3), 0.1, 1e-9);
}

TEST_F(NewRobotGuess, ParsesCablesInTheUnitOfTheMesh) {
  const SourceMesh source = Read(Bar({100, 20, 20}, {5, 2, 2}),
                                 {{.name = "tip", .dimension = 0, .holds = [](const Vector3d& at) {
                                     return (at - Vector3d(100, 10, 10)).norm() < 1e-6;
                                   }}});
  fem::TetMesh in_m = source.mesh;
  in_m.nodes_m *= 1e-3;
  const BodyShape shape = MeasureShape(in_m);
  const auto parse = [&](const std::string& text) { return ParseCable(text, source, shape, 1e-3); };
  const CableRoute route = parse("up = -10, 10, 15 ; 50,10,15; tip");
  EXPECT_EQ(route.name, "up");
  ASSERT_EQ(route.path_m.cols(), 3);
  EXPECT_TRUE(route.path_m.col(0).isApprox(Vector3d(-0.01, 0.01, 0.015)));
  EXPECT_TRUE(route.path_m.col(2).isApprox(Vector3d(0.1, 0.01, 0.01)));
  RefuseFarPoints(shape, route, 1e-3);
  EXPECT_THAT(MessageOf([&] { parse("up"); }), HasSubstr("NAME=x,y,z"));
  EXPECT_THAT(MessageOf([&] { parse("up=1,2,3"); }), HasSubstr("at least two points"));
  EXPECT_THAT(MessageOf([&] { parse("up=1,2;3,4,5"); }), HasSubstr("is no point x,y,z"));
  EXPECT_THAT(MessageOf([&] { parse("up=0,0,0;tpi"); }), HasSubstr("did you mean 'tip'"));
  EXPECT_THAT(MessageOf([&] { parse("up=0,0,0;0,0,0"); }), HasSubstr("are the same"));
  EXPECT_THAT(MessageOf([&] { parse("up=0,0,nan;0,0,0"); }), HasSubstr("is no point"));
}

TEST_F(NewRobotGuess, RefusesAnEyeletOffTheBodyWithItsDistanceAndTheNearestPoint) {
  const SourceMesh source = Read(Bar({100, 20, 20}, {5, 2, 2}));
  fem::TetMesh in_m = source.mesh;
  in_m.nodes_m *= 1e-3;
  const BodyShape shape = MeasureShape(in_m);
  const auto refuse = [&](const std::string& text) {
    RefuseFarPoints(shape, ParseCable(text, source, shape, 1e-3), 1e-3);
  };
  EXPECT_THAT(MessageOf([&] { refuse("up=0,10,10;100,10,45"); }),
              AllOf(HasSubstr("cable up: eyelet 100,10,45"), HasSubstr("25 mm outside the body"),
                    HasSubstr("nearest point of the body is 100,10,20")));
  EXPECT_THAT(MessageOf([&] { refuse("up=-1000,10,10;100,10,10"); }), HasSubstr("pull point"));
  refuse("up=-50,10,10;100,10,10");
}

TEST(Silicones, HaveTheModulusWhoseNeoHookeanStressIsThatOfTheDataSheet) {
  for (const Silicone& silicone : Silicones()) {
    const double mu_Pa = silicone.YoungsModulus_Pa() / 3.0;
    const double stretch = 2.0;
    EXPECT_NEAR(mu_Pa * (stretch - 1.0 / (stretch * stretch)), silicone.modulus_100_Pa, 1e-6);
  }
  EXPECT_THAT(MessageOf([] { FindSilicone("dragon_skin_1"); }), HasSubstr("did you mean"));
}

}  // namespace
}  // namespace palpate::command
