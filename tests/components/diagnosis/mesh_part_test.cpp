// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/mesh_part.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "components/diagnosis/forward/anchor_error.hpp"
#include "components/diagnosis/forward/relative_mesh_error.hpp"
#include "libs/app/yaml.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/components/diagnosis/small_robot.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/robots.hpp"

namespace palpate::diagnosis {
namespace {

constexpr fem::ElementType kElements[] = {fem::ElementType::kTet4, fem::ElementType::kTet10};

/// On a mesh of half the element size.
robot::RobotBody OnRefinedMesh(robot::RobotBody body) {
  const MeshPart finer = Refined(WholeMesh(body));
  body.mesh = finer.mesh;
  body.material_of_cell = finer.material_of_cell;
  body.fixed = finer.fixed;
  const fem::PointLocator locator(body.mesh);
  for (robot::BodyCable& cable : body.cables) {
    for (fem::BodyPoint& eyelet : cable.eyelets) {
      eyelet = locator.EmbedBall(eyelet.rest_m, cable.guide_radius_m);
    }
  }
  return body;
}

robot::RobotBody Stiffer(robot::RobotBody body, double factor) {
  for (fem::Material& material : body.materials) material.youngs_modulus_Pa *= factor;
  return body;
}

/// The whole mesh at rest has the compliance of the robot's model there (eq. 5 of the paper).
TEST(MeshPart, HasTheModelsCompliance) {
  for (const fem::ElementType element : kElements) {
    const robot::RobotBody body = SmallRobot(element);
    const fem::InterpolationWeights& marker = body.markers.back().point.weights;
    PartAtRest part(WholeMesh(body), element, body);
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(3 * part.mesh().NodeCount(), 1);
    const fem::PointLocator locator(part.mesh());
    const auto weights = locator.Embed(body.markers.back().point.rest_m).weights;
    AddPointLoad(weights, Eigen::Vector3d::UnitZ(), load.col(0));
    const auto motion_m = part.MotionUnder(load);
    ASSERT_TRUE(motion_m);

    robot::RobotModel model(body);
    const Eigen::VectorXd rest_m = model.elastic_body().rest_m();
    const Eigen::VectorXd slack = Eigen::VectorXd::Zero(model.CableCount());
    ASSERT_TRUE(
        model.linearisation().Update(rest_m, slack, Eigen::VectorXd::Zero(rest_m.size())).ok());
    robot::Compliance compliance(model.linearisation(),
                                 {robot::RowOfPoint(marker, Eigen::Vector3d::UnitZ())});
    compliance.SetForces({{marker, Eigen::Vector3d::UnitZ()}});
    compliance.Compute(rest_m, model.cable_rest_length_m(), slack, Eigen::VectorXd::Zero(1));
    EXPECT_NEAR(weights.Position(motion_m->col(0)).z() / compliance.W_ef()(0, 0), 1.0, 1e-9);
  }
}

/// A part that is held where it meets the rest yields less than the whole.
TEST(MeshPart, IsHeldWhereItMeetsOtherElements) {
  const robot::RobotBody body = SmallRobot();
  const fem::BodyPoint& anchor = body.cables.front().eyelets.back();
  double yields_m[2];
  for (const bool whole : {false, true}) {
    PartAtRest part(whole ? WholeMesh(body) : PartAbout(body, anchor.cell), fem::ElementType::kTet4,
                    body);
    EXPECT_EQ(part.mesh().NodeCount() == body.mesh.NodeCount(), whole);
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(3 * part.mesh().NodeCount(), 1);
    const auto weights = fem::PointLocator(part.mesh()).Embed(anchor.rest_m).weights;
    AddPointLoad(weights, Eigen::Vector3d::UnitX(), load.col(0));
    const auto motion_m = part.MotionUnder(load);
    ASSERT_TRUE(motion_m);
    yields_m[whole ? 1 : 0] = motion_m->col(0).dot(load.col(0));
  }
  EXPECT_GT(yields_m[0], 0.0);
  EXPECT_LT(yields_m[0], yields_m[1]);
}

/// A point force yields by a multiple of 1 / (E h) in elements of size h.
TEST(AnchorErrors, GoWithOneOverTheModulus) {
  for (const fem::ElementType element : kElements) {
    const robot::RobotBody body = SmallRobot(element);
    const auto errors = FindAnchorErrors(body);
    const auto of_stiffer = FindAnchorErrors(Stiffer(body, 4.0));
    ASSERT_EQ(errors.size(), body.cables.size());
    for (std::size_t c = 0; c < errors.size(); ++c) {
      EXPECT_GT(errors[c].mean_m_N, 0.0) << "finer elements yield more";
      EXPECT_GT(errors[c].scatter_m_N, 0.0);
      EXPECT_NEAR(of_stiffer[c].mean_m_N / errors[c].mean_m_N, 0.25, 1e-6);
      EXPECT_NEAR(of_stiffer[c].scatter_m_N / errors[c].scatter_m_N, 0.25, 1e-6);
    }
  }
}

/// A guide that spreads the force over more than an element leaves little to the mesh.
TEST(AnchorErrors, VanishWhereTheGuideIsLarge) {
  robot::RobotBody body = SmallRobot();
  const double point_m_N = FindAnchorErrors(body)[0].mean_m_N;
  for (robot::BodyCable& cable : body.cables) cable.guide_radius_m = 0.02;
  EXPECT_LT(std::abs(FindAnchorErrors(body)[0].mean_m_N), 0.5 * point_m_N);
}

TEST(RelativeMeshError, FallsWithTheElementSizeAndNotWithTheModulus) {
  const robot::RobotBody body = SmallRobot();
  const auto error = RelativeMeshError(body);
  ASSERT_TRUE(error);
  EXPECT_GT(*error, 0.0);
  EXPECT_LT(*error, 0.2);
  EXPECT_NEAR(RelativeMeshError(Stiffer(body, 4.0)).value(), *error, 1e-6 * *error);
  EXPECT_LT(RelativeMeshError(OnRefinedMesh(body)).value(), 0.7 * *error);
}

/// What ten nodes add is no part of it.
TEST(RelativeMeshError, IsThatOfTenNodes) {
  const double of_four = RelativeMeshError(SmallRobot()).value();
  EXPECT_NEAR(RelativeMeshError(SmallRobotOnFinerMesh()).value() / of_four, 1.0, 1e-6);
}

/// The table of docs/diagnosis.md.
TEST(RelativeMeshError, PrintsTheTableOfRobots) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"four_leg", "rod", "beam"}) {
    files.push_back(test_support::RobotFile(name));
  }
  const auto trunk = test_support::MeasuredDataFolder() / "diagnosis_trunk/robot/robot.yaml";
  if (std::filesystem::exists(trunk)) files.push_back(trunk);
  for (const auto& file : files) {
    const robot::RobotBody body = robot::BuildRobotBody(robot::ReadRobotFile(file, app::LoadYaml));
    const auto relative = RelativeMeshError(body);
    ASSERT_TRUE(relative) << file;
    EXPECT_LT(*relative, 0.05);
    fmt::print("{}: {} elements, {:.1f} %\n", body.name, body.mesh.CellCount(), 100.0 * *relative);
    for (const AnchorError& error : FindAnchorErrors(body)) {
      EXPECT_GT(error.mean_m_N, error.scatter_m_N);
      fmt::print("  {:.2f} mm/N, {:.2f} mm/N\n", 1e3 * error.mean_m_N, 1e3 * error.scatter_m_N);
    }
  }
}

}  // namespace
}  // namespace palpate::diagnosis
