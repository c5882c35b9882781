// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_body.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/body_mesh.hpp"
#include "tests/libs/fem/points/meshes.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kVolume_m3 = 0.1 * 0.02 * 0.02;

/// The beam of the full robot file, lying along y from 0 to 0.1 m after its placement.
class RobotBodyTest : public testing::Test {
 protected:
  RobotBodyTest() { WriteVtk(Beam_mm(), folder_ / "beam.vtk"); }

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

  std::string At(const std::string& line_and_column) const {
    return (folder_ / "robot.yaml").string() + line_and_column;
  }

  TestFolder folder_;
};

Eigen::VectorXd RestNodes(const RobotBody& body) { return body.mesh.nodes_m.reshaped(); }

/// A box of 30 mm with a closed hollow of 10 mm in its middle.
fem::TetMesh HollowBox() {
  fem::TetMesh box = fem::BoxMesh({0.03, 0.03, 0.03}, {3, 3, 3});
  constexpr int kFirstOfTheMiddle = 6 * 13;
  Eigen::MatrixXi cells(4, box.CellCount() - 6);
  cells << box.cells.leftCols(kFirstOfTheMiddle),
      box.cells.rightCols(box.CellCount() - kFirstOfTheMiddle - 6);
  box.cells = cells;
  return box;
}

std::string HollowRobot(const std::string& eyelet_m, const std::string& youngs_modulus_Pa) {
  return "name: hollow\nmesh: {file: hollow.vtk, unit: m}\nelement: tet4\n"
         "material: {model: stable_neo_hookean, youngs_modulus_Pa: " +
         youngs_modulus_Pa +
         ", poissons_ratio: 0.45}\nmass: {density_kg_m3: 1000}\ngravity_m_s2: [0, 0, -9.81]\n"
         "fixed: [{box_m: [[-0.001, -0.001, -0.001], [0.031, 0.031, 0.001]]}]\n"
         "cables: [{name: c, path_m: [[0.01, 0.01, -0.01], " +
         eyelet_m + "], max_tension_N: 1, guide_radius_m: 0}]\n";
}

TEST_F(RobotBodyTest, WarnsOfACableInAHollow) {
  WriteVtk(HollowBox(), folder_ / "hollow.vtk");
  EXPECT_THAT(Build(HollowRobot("[0.0115, 0.015, 0.015]", "200.0e3")).warnings,
              testing::ElementsAre(AllOf(HasSubstr("cable c: attachment lies in a hollow, 1.5 mm"),
                                         HasSubstr("in the material?"))));
  EXPECT_TRUE(Build(HollowRobot("[0.005, 0.015, 0.015]", "200.0e3")).warnings.empty());
  // A guide that reaches the wall: the hollow is the channel of the cable.
  std::string guided = HollowRobot("[0.0115, 0.015, 0.015]", "200.0e3");
  guided.replace(guided.find("guide_radius_m: 0}"), 18, "guide_radius_m: 0.002}");
  EXPECT_TRUE(Build(guided).warnings.empty());
  // Off the outer side.
  const RobotBody outside = Build(HollowRobot("[-0.001, 0.015, 0.015]", "200.0e3"));
  EXPECT_TRUE(outside.warnings.empty());
  EXPECT_THAT(outside.notes, Contains(HasSubstr("cable c: attachment 1 mm outside the mesh")));
}

TEST_F(RobotBodyTest, WarnsOfAModulusThatNoSolidHas) {
  WriteVtk(HollowBox(), folder_ / "hollow.vtk");
  const auto warnings = [&](const std::string& youngs_modulus_Pa) {
    return Build(HollowRobot("[0.005, 0.015, 0.015]", youngs_modulus_Pa)).warnings;
  };
  EXPECT_THAT(warnings("0.2"),
              testing::ElementsAre(AllOf(HasSubstr("youngs_modulus_Pa: 0.2 Pa"),
                                         HasSubstr("is this MPa? Then write 200000"))));
  EXPECT_THAT(warnings("180"), testing::ElementsAre(HasSubstr("is this kPa? Then write 180000")));
  EXPECT_TRUE(warnings("1.0e3").empty());
}

TEST_F(RobotBodyTest, PlacesTheMesh) {
  const RobotBody body = Build(Changed("element: tet10", "element: tet4"));
  const Eigen::Vector3d lower = body.mesh.nodes_m.rowwise().minCoeff();
  const Eigen::Vector3d upper = body.mesh.nodes_m.rowwise().maxCoeff();
  EXPECT_TRUE(lower.isApprox(Eigen::Vector3d(-0.01, 0.0, -0.01), 1e-12)) << lower;
  EXPECT_TRUE(upper.isApprox(Eigen::Vector3d(0.01, 0.1, 0.01), 1e-12)) << upper;
  EXPECT_TRUE(body.mesh.nodes_m.col(0).isApprox(Eigen::Vector3d(0.01, 0.0, -0.01), 1e-12));
}

TEST_F(RobotBodyTest, MakesTheElementThatTheFileNames) {
  EXPECT_EQ(Build(FullRobotText()).mesh.element_type(), fem::ElementType::kTet10);
  EXPECT_EQ(Build(Changed("element: tet10", "element: tet4")).mesh.element_type(),
            fem::ElementType::kTet4);
}

TEST_F(RobotBodyTest, NotesThatCellsLockNearIncompressibility) {
  const auto notes = [&](const std::string& ratio, const std::string& element = "tet10") {
    std::string text = Changed("poissons_ratio: 0.45", "poissons_ratio: " + ratio);
    text.replace(text.find("element: tet10"), 14, "element: " + element);
    return Build(text).notes;
  };
  EXPECT_THAT(notes("0.499, volumetric: pointwise"),
              Contains(AllOf(StartsWith("Poisson's ratio 0.499: tet10 with pointwise"),
                             HasSubstr("mean_dilatation"))));
  EXPECT_THAT(notes("0.48", "tet4"), Contains(HasSubstr("tet4 locks")));
  EXPECT_THAT(notes("0.499"), Not(Contains(HasSubstr("lock"))));
  EXPECT_THAT(notes("0.479, volumetric: pointwise"), Not(Contains(HasSubstr("lock"))));
}

TEST_F(RobotBodyTest, HoldsTheNodesInTheBoxMidEdgesIncluded) {
  const RobotBody body = Build(FullRobotText());
  int held = 0;
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    const bool in_box = body.mesh.nodes_m(1, node) <= 0.001;
    EXPECT_EQ(body.fixed.col(node).all(), in_box);
    EXPECT_EQ(body.fixed.col(node).any(), in_box);
    held += in_box ? 1 : 0;
  }
  EXPECT_EQ(held, 25);
  EXPECT_THAT(body.notes, Contains(HasSubstr("25 of")));
}

TEST_F(RobotBodyTest, MassByVolumeIsConsistent) {
  for (const char* element : {"element: tet4", "element: tet10"}) {
    const RobotBody body = Build(Changed("element: tet10", element));
    EXPECT_NEAR(body.node_mass_kg.sum(), 0.5, 1e-14);
    const Eigen::Vector3d centre_m = body.mesh.nodes_m * body.node_mass_kg / 0.5;
    EXPECT_TRUE(centre_m.isApprox(Eigen::Vector3d(0.0, 0.05, 0.0), 1e-12)) << centre_m;
  }
  EXPECT_LT(Build(FullRobotText()).node_mass_kg.minCoeff(), 0.0);
}

TEST_F(RobotBodyTest, MassFromDensityIsThatOfTheVolume) {
  const RobotBody body = Build(Changed("total_kg: 0.5", "density_kg_m3: 1070"));
  EXPECT_NEAR(body.node_mass_kg.sum(), 1070.0 * kVolume_m3, 1e-15);
}

TEST_F(RobotBodyTest, MassPerNodeIsSharedEqually) {
  const RobotBody body = Build(Changed("distribution: volume", "distribution: per_node"));
  const double share_kg = 0.5 / body.mesh.NodeCount();
  EXPECT_TRUE(body.node_mass_kg.isApproxToConstant(share_kg, 1e-14));
}

TEST_F(RobotBodyTest, RegionsTakeTheCellsWithTheirCentroidInside) {
  const RobotBody body = Build(FullRobotText());
  ASSERT_EQ(body.materials.size(), 3U);
  EXPECT_EQ(body.region_names, (std::vector<std::string>{"tip", "root"}));
  EXPECT_EQ(body.materials[0].youngs_modulus_Pa, 65e3);
  EXPECT_EQ(body.materials[1].youngs_modulus_Pa, 30e3);
  EXPECT_EQ(body.materials[2].youngs_modulus_Pa, 65e3);
  for (int cell = 0; cell < body.mesh.CellCount(); ++cell) {
    double y_m = 0.0;
    for (int k = 0; k < 4; ++k) y_m += body.mesh.nodes_m(1, body.mesh.cells(k, cell)) / 4.0;
    const int expected = y_m > 0.08 ? 1 : y_m < 0.02 ? 2 : 0;
    EXPECT_EQ(body.material_of_cell[static_cast<size_t>(cell)], expected);
  }
}

TEST_F(RobotBodyTest, ARegionTakesAGroupOfTheMeshFile) {
  const fem::TetMesh beam = Beam_mm();
  std::string data = "CELL_DATA " + std::to_string(beam.CellCount()) +
                     "\nSCALARS part int 1\nLOOKUP_TABLE default\n";
  for (int cell = 0; cell < beam.CellCount(); ++cell) data += cell < 30 ? "1\n" : "2\n";
  const std::string vtk = ReadFile(folder_ / "beam.vtk");
  folder_.Write("beam.vtk", vtk + data);
  const std::string box = "box_m: [[-0.02, 0, -0.02], [0.02, 0.02, 0.02]]";
  const RobotBody body = Build(Changed(box, "mesh_group: part=1, youngs_modulus_Pa: 20e3"));
  EXPECT_EQ(body.materials[2].youngs_modulus_Pa, 20e3);
  for (int cell = 0; cell < body.mesh.CellCount(); ++cell) {
    EXPECT_EQ(body.material_of_cell[static_cast<size_t>(cell)] == 2, cell < 30) << cell;
  }
  EXPECT_THAT(BuildRefusal(Changed(box, "mesh_group: part=3")),
              AllOf(HasSubstr(":13:30:"), HasSubstr("the mesh has no group 'part=3' (did you mean"),
                    HasSubstr("there is part=1, part=2")));
  EXPECT_THAT(BuildRefusal(Changed(box, box + ", mesh_group: part=1")),
              HasSubstr("needs either box_m, or mesh_group"));
  folder_.Write("beam.vtk", vtk);
  EXPECT_THAT(BuildRefusal(Changed(box, "mesh_group: part=1")), HasSubstr("it has none"));
}

TEST_F(RobotBodyTest, ALaterRegionWins) {
  const RobotBody body =
      Build(Changed("{name: root, box_m: [[-0.02, 0, -0.02], [0.02, 0.02, 0.02]]}",
                    "{name: end, box_m: [[-0.02, 0.09, -0.02], [0.02, 0.2, 0.02]]}"));
  const auto count = [&](int index) {
    return std::count(body.material_of_cell.begin(), body.material_of_cell.end(), index);
  };
  EXPECT_EQ(count(1), 24);
  EXPECT_EQ(count(2), 24);
}

TEST_F(RobotBodyTest, CablesKeepTheirPathsAtRest) {
  const RobotBody body = Build(FullRobotText());
  ASSERT_EQ(body.cables.size(), 2U);
  EXPECT_EQ(body.cables[0].name, "north");
  EXPECT_EQ(body.cables[0].pull_point_m, Eigen::Vector3d(0, 0, 0.02));
  EXPECT_EQ(body.cables[0].max_tension_N, 20.0);
  ASSERT_EQ(body.cables[0].eyelets.size(), 2U);
  const Eigen::VectorXd rest = RestNodes(body);
  EXPECT_LT(
      (body.cables[0].eyelets[0].weights.Position(rest) - Eigen::Vector3d(0, 0.05, 0.0101)).norm(),
      1e-15);
  EXPECT_LT(
      (body.cables[0].eyelets[1].weights.Position(rest) - Eigen::Vector3d(0, 0.09, 0.009)).norm(),
      1e-15);
  EXPECT_LT(
      (body.cables[1].eyelets[0].weights.Position(rest) - Eigen::Vector3d(0, 0.095, -0.009)).norm(),
      1e-15);
}

TEST_F(RobotBodyTest, SaysWhichPointsLieOffTheMesh) {
  const RobotBody body = Build(FullRobotText());
  EXPECT_THAT(body.notes, Contains(AllOf(HasSubstr("cable north: point 2 0.1 mm outside"),
                                         HasSubstr("extrapolated"))));
  EXPECT_THAT(body.notes, Contains(HasSubstr("marker m1 6 mm outside")));
  EXPECT_THAT(body.notes, Not(Contains(HasSubstr("marker 2"))));
  EXPECT_THAT(body.notes, Contains(AllOf(HasSubstr("mesh beam.vtk: 99 nodes, 240 elements of 4"),
                                         HasSubstr("volume 40 cm3"))));
}

TEST_F(RobotBodyTest, MarkersMayStandOff) {
  const RobotBody body = Build(FullRobotText());
  ASSERT_EQ(body.markers.size(), 2U);
  EXPECT_EQ(body.markers[0].name, "m1");
  EXPECT_NEAR(body.markers[0].point.distance_m, 0.006, 1e-12);
  EXPECT_LT(
      (body.markers[0].point.weights.Position(RestNodes(body)) - Eigen::Vector3d(0, 0.1, 0.016))
          .norm(),
      1e-15);
}

TEST_F(RobotBodyTest, FeaturePointsLieOnTheSurfaceWithItsNormals) {
  const RobotBody body = Build(FullRobotText());
  ASSERT_EQ(body.feature_points.size(), 12U);
  for (size_t k = 0; k < 12; ++k) {
    const Eigen::Vector3d from_middle =
        body.feature_points[k].rest_m - Eigen::Vector3d(0.0, 0.05, 0.0);
    const Eigen::Vector3d part = from_middle.cwiseQuotient(Eigen::Vector3d(0.01, 0.05, 0.01));
    EXPECT_NEAR(part.cwiseAbs().maxCoeff(), 1.0, 1e-10);
    Eigen::Index face = 0;
    part.cwiseAbs().maxCoeff(&face);
    EXPECT_NEAR(body.feature_normals(face, static_cast<Eigen::Index>(k)), part(face), 1e-9);
    EXPECT_LT(body.feature_points[k].distance_m, 1e-15);
  }
}

TEST_F(RobotBodyTest, GivenFeaturePointsTakeTheNearestNormal) {
  const RobotBody body =
      Build(Changed("{count: 12}", "[[0.002, 0.1, 0.001], [0.003, 0.051, 0.01]]"));
  ASSERT_EQ(body.feature_points.size(), 2U);
  EXPECT_TRUE(body.feature_normals.col(0).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(body.feature_normals.col(1).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST_F(RobotBodyTest, NodesThatNoCellUsesAreHeldAndWeighNothing) {
  fem::TetMesh mesh = Beam_mm();
  mesh.nodes_m.conservativeResize(3, mesh.NodeCount() + 1);
  mesh.nodes_m.col(mesh.NodeCount() - 1) << -50.0, 0.0, 0.0;
  WriteVtk(mesh, folder_ / "beam.vtk");
  const std::string per_node = Changed("distribution: volume", "distribution: per_node");
  const RobotBody body = Build(per_node);
  EXPECT_TRUE(body.fixed.col(99).all());
  EXPECT_EQ(body.node_mass_kg(99), 0.0);
  EXPECT_NEAR(body.node_mass_kg.sum(), 0.5, 1e-14);
  EXPECT_THAT(body.notes, Contains(HasSubstr("1 nodes that no element uses")));
}

TEST_F(RobotBodyTest, HashNamesMeshAndElementAndNothingElse) {
  const std::string hash = Build(FullRobotText()).mesh_hash;
  EXPECT_EQ(hash.size(), 22U);
  EXPECT_THAT(hash, StartsWith("fnv1a-"));
  EXPECT_EQ(Build(FullRobotText()).mesh_hash, hash);
  EXPECT_EQ(Build(Changed("youngs_modulus_Pa: 65.0e3", "youngs_modulus_Pa: 1e3")).mesh_hash, hash);
  EXPECT_EQ(Build(Changed("total_kg: 0.5", "total_kg: 0.1")).mesh_hash, hash);
  EXPECT_NE(Build(Changed("element: tet10", "element: tet4")).mesh_hash, hash);
  fem::TetMesh mesh = Beam_mm();
  mesh.nodes_m(0, 50) += 1e-9;
  WriteVtk(mesh, folder_ / "beam.vtk");
  EXPECT_NE(Build(FullRobotText()).mesh_hash, hash);
}

TEST(HashMesh, IsTheSameOnEveryMachine) {
  fem::TetMesh mesh{Eigen::Matrix3Xd::Zero(3, 4), Eigen::MatrixXi(4, 1), {}};
  mesh.nodes_m.rightCols<3>().setIdentity();
  mesh.cells << 0, 1, 2, 3;
  EXPECT_EQ(HashMesh(mesh, fem::ElementType::kTet4), "fnv1a-6349ed10cff81079");
  mesh.nodes_m(0, 0) = -0.0;
  EXPECT_EQ(HashMesh(mesh, fem::ElementType::kTet4), "fnv1a-6349ed10cff81079");
}

TEST_F(RobotBodyTest, RefusesAMissingMeshFile) {
  EXPECT_THAT(BuildRefusal(Changed("beam.vtk", "bean.vtk")),
              AllOf(StartsWith(At(":2:14")), HasSubstr("bean.vtk")));
}

TEST_F(RobotBodyTest, RefusesTheWrongElement) {
  WriteVtk(fem::MakeQuadratic(Beam_mm()), folder_ / "beam.vtk");
  EXPECT_EQ(Build(FullRobotText()).mesh.element_type(), fem::ElementType::kTet10);
  EXPECT_THAT(BuildRefusal(Changed("element: tet10", "element: tet4")),
              AllOf(StartsWith(At(":2:")), HasSubstr("4-node")));
}

TEST_F(RobotBodyTest, TurnsACellThatIsWrittenTheOtherWayRound) {
  fem::TetMesh mesh = Beam_mm();
  std::swap(mesh.cells(0, 7), mesh.cells(1, 7));
  WriteVtk(mesh, folder_ / "beam.vtk");
  EXPECT_THAT(Build(FullRobotText()).notes, testing::Contains(HasSubstr("turned")));
}

TEST_F(RobotBodyTest, RefusesACellWithANodeBeyondItsFace) {
  fem::TetMesh mesh = Beam_mm();
  const int node = mesh.cells(0, 7);
  const Eigen::Vector3d others_m =
      mesh.nodes_m(Eigen::all, mesh.cells.col(7).tail(3)).rowwise().mean();
  mesh.nodes_m.col(node) = 2.0 * others_m - mesh.nodes_m.col(node);
  WriteVtk(mesh, folder_ / "beam.vtk");
  EXPECT_THAT(BuildRefusal(FullRobotText()), HasSubstr("inverted"));
}

TEST_F(RobotBodyTest, RefusesAFixedBoxWithoutANode) {
  EXPECT_THAT(BuildRefusal(Changed("[[-0.011, -0.001, -0.011], [0.011, 0.001, 0.011]]",
                                   "[[1, 1, 1], [2, 2, 2]]")),
              AllOf(StartsWith(At(":7:")), HasSubstr("no node"), HasSubstr("[0.01, 0.1, 0.01]")));
}

TEST_F(RobotBodyTest, RefusesABodyThatCanStillTurn) {
  EXPECT_THAT(BuildRefusal(Changed("[[-0.011, -0.001, -0.011], [0.011, 0.001, 0.011]]",
                                   "[[-0.011, -0.001, 0.009], [0.011, 0.001, 0.011]]")),
              AllOf(StartsWith(At(":7:")), HasSubstr("can still move")));
}

TEST_F(RobotBodyTest, RefusesAPieceThatNothingHolds) {
  const fem::TetMesh one = Beam_mm();
  const int count = one.NodeCount();
  fem::TetMesh two{Eigen::Matrix3Xd(3, 2 * count), Eigen::MatrixXi(4, 2 * one.CellCount()), {}};
  two.nodes_m << one.nodes_m, (one.nodes_m.colwise() + Eigen::Vector3d(200.0, 0.0, 0.0));
  two.cells << one.cells, (one.cells.array() + count).matrix();
  WriteVtk(two, folder_ / "beam.vtk");
  EXPECT_THAT(BuildRefusal(FullRobotText()),
              AllOf(HasSubstr("piece of the mesh"), HasSubstr("0 of its nodes are fixed")));
  const RobotBody held =
      Build(Changed("fixed: [", "fixed: [{box_m: [[-1, 0.29, -1], [1, 0.31, 1]]}, "));
  EXPECT_THAT(held.notes, Contains(HasSubstr("2 separate pieces")));
}

TEST_F(RobotBodyTest, RefusesARegionWithoutACell) {
  EXPECT_THAT(
      BuildRefusal(Changed("[[-0.02, 0, -0.02], [0.02, 0.02, 0.02]]", "[[1, 1, 1], [2, 2, 2]]")),
      AllOf(StartsWith(At(":13:")), HasSubstr("'root' has no element")));
}

TEST_F(RobotBodyTest, RefusesACableFarFromTheBody) {
  EXPECT_THAT(BuildRefusal(Changed("[0, 0.095, -0.009]", "[0, 0.095, -0.016]")),
              AllOf(StartsWith(At(":10:")), HasSubstr("cable south: attachment lies 6 mm"),
                    HasSubstr("5.2 mm"), HasSubstr("in metres?")));
  EXPECT_EQ(Build(Changed("[0, 0.095, -0.009]", "[0, 0.095, -0.015]")).cables.size(), 2U);
}

TEST_F(RobotBodyTest, RefusesAMarkerInAnotherUnit) {
  EXPECT_THAT(BuildRefusal(Changed("[0, 0.1, 0.016]", "[0, 100, 16]")),
              AllOf(StartsWith(At(":14:")), HasSubstr("marker m1")));
}

}  // namespace
}  // namespace palpate::robot
