// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/embedding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

const Eigen::Vector3d kEmbedded_m(0.10, 0.02, 0.03);

TetMesh MeshOf(ElementType element) {
  const TetMesh mesh = BoxMesh(kEmbedded_m, {5, 2, 3});
  return element == ElementType::kTet10 ? MakeQuadratic(mesh) : mesh;
}

/// Mid-edge nodes moved off the middle, as in a mesh of curved cells.
TetMesh CurvedMesh() {
  TetMesh mesh = MeshOf(ElementType::kTet10);
  const int corners = BoxMesh(kEmbedded_m, {5, 2, 3}).NodeCount();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> shift_m(-3e-4, 3e-4);
  for (int node = corners; node < mesh.NodeCount(); ++node) {
    for (int axis = 0; axis < 3; ++axis) mesh.nodes_m(axis, node) += shift_m(random);
  }
  return mesh;
}

/// Points in a box that stands 10 mm off the mesh on all sides.
std::vector<Eigen::Vector3d> PointsAround(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<Eigen::Vector3d> points(static_cast<size_t>(count));
  for (Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      point(axis) = -0.01 + part(random) * (kEmbedded_m(axis) + 0.02);
    }
  }
  return points;
}

Eigen::VectorXd Flat(const Eigen::Matrix3Xd& nodes) { return nodes.reshaped(); }

double WeightSum(const InterpolationWeights& weights) {
  return std::accumulate(weights.weights.begin(), weights.weights.end(), 0.0);
}

bool InsideBox(const Eigen::Vector3d& point) {
  return (point.array() >= 0.0).all() && (point.array() <= kEmbedded_m.array()).all();
}

double DistanceToBox(const Eigen::Vector3d& point) {
  return (point - point.cwiseMax(0.0).cwiseMin(kEmbedded_m)).norm();
}

class Embedding : public testing::TestWithParam<ElementType> {};

INSTANTIATE_TEST_SUITE_P(Elements, Embedding,
                         testing::Values(ElementType::kTet4, ElementType::kTet10),
                         [](const auto& element) {
                           return element.param == ElementType::kTet4 ? "tet4" : "tet10";
                         });

TEST_P(Embedding, WeightsAddUpToOneAndReproduceTheRestPosition) {
  const TetMesh mesh = MeshOf(GetParam());
  const PointLocator locator(mesh);
  for (const Eigen::Vector3d& point_m : PointsAround(500, 1)) {
    const BodyPoint point = locator.Embed(point_m);
    EXPECT_NEAR(WeightSum(point.weights), 1.0, 1e-12);
    EXPECT_LT((point.weights.Position(Flat(mesh.nodes_m)) - point_m).norm(), 1e-14);
    EXPECT_EQ(point.rest_m, point_m);
  }
}

TEST_P(Embedding, AnAffineMotionOfTheNodesMovesEveryPointByIt) {
  const TetMesh mesh = MeshOf(GetParam());
  const PointLocator locator(mesh);
  Eigen::Matrix3d A;
  A << 1.2, 0.3, -0.1, 0.2, 0.8, 0.4, -0.3, 0.1, 1.1;
  const Eigen::Vector3d b(0.5, -0.2, 0.1);
  const Eigen::VectorXd moved = Flat((A * mesh.nodes_m).colwise() + b);
  for (const Eigen::Vector3d& point_m : PointsAround(500, 2)) {
    const BodyPoint point = locator.Embed(point_m);
    EXPECT_LT((point.weights.Position(moved) - (A * point_m + b)).norm(), 1e-14);
    const BodyPoint ball = locator.EmbedBall(point_m, 0.004);
    EXPECT_LT((ball.weights.Position(moved) - (A * point_m + b)).norm(), 1e-13);
  }
}

TEST_P(Embedding, DistanceIsThatToTheBoxAndZeroInside) {
  const PointLocator locator(MeshOf(GetParam()));
  for (const Eigen::Vector3d& point_m : PointsAround(500, 3)) {
    const BodyPoint point = locator.Embed(point_m);
    EXPECT_NEAR(point.distance_m, DistanceToBox(point_m), 1e-14);
    if (InsideBox(point_m)) {
      EXPECT_EQ(point.distance_m, 0.0);
    }
  }
}

TEST_P(Embedding, InsideTheCellHoldsThePointAndOutsideItsCentroidIsTheNearest) {
  const TetMesh mesh = MeshOf(GetParam());
  const PointLocator locator(mesh);
  Eigen::Matrix3Xd centroids = Eigen::Matrix3Xd::Zero(3, mesh.CellCount());
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int k = 0; k < 4; ++k) centroids.col(cell) += 0.25 * mesh.nodes_m.col(mesh.cells(k, cell));
  }
  for (const Eigen::Vector3d& point_m : PointsAround(500, 4)) {
    const BodyPoint point = locator.Embed(point_m);
    Eigen::Index nearest = 0;
    (centroids.colwise() - point_m).colwise().norm().minCoeff(&nearest);
    if (!InsideBox(point_m)) {
      EXPECT_EQ(point.cell, nearest);
    }
    for (const int node : point.weights.nodes) {
      const auto cell = mesh.cells.col(point.cell);
      EXPECT_NE(std::find(cell.begin(), cell.end(), node), cell.end());
    }
    EXPECT_TRUE(std::is_sorted(point.weights.nodes.begin(), point.weights.nodes.end()));
  }
}

TEST_P(Embedding, ANodeIsItself) {
  const TetMesh mesh = MeshOf(GetParam());
  const PointLocator locator(mesh);
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    const BodyPoint point = locator.Embed(mesh.nodes_m.col(node));
    for (size_t k = 0; k < point.weights.nodes.size(); ++k) {
      EXPECT_NEAR(point.weights.weights[k], point.weights.nodes[k] == node ? 1.0 : 0.0, 1e-12);
    }
    EXPECT_EQ(point.distance_m, 0.0);
  }
}

TEST(PointLocator, InsideTet10APointFollowsAQuadraticMotion) {
  const TetMesh mesh = MeshOf(ElementType::kTet10);
  const PointLocator locator(mesh);
  const auto motion = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.x() * p.y(), p.z() * p.z() - p.x(),
                           p.y() * p.z() + 3.0 * p.x() * p.x());
  };
  Eigen::Matrix3Xd moved = mesh.nodes_m;
  for (auto node : moved.colwise()) node = motion(Eigen::Vector3d(node));
  for (const Eigen::Vector3d& point_m : PointsAround(500, 5)) {
    if (!InsideBox(point_m)) continue;
    const BodyPoint point = locator.Embed(point_m);
    EXPECT_LT((point.weights.Position(Flat(moved)) - motion(point_m)).norm(), 1e-15);
  }
}

TEST(PointLocator, OutsideTet10ExpandsLinearlyAboutTheNearestPointOfTheCell) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kEmbedded_m, {1, 1, 1}));
  const PointLocator locator(mesh);
  const Eigen::Vector3d outside(0.09, 0.005, -0.002);
  const BodyPoint point = locator.Embed(outside);
  const auto square = [](const Eigen::Vector3d& p) { return p.x() * p.x() + p.z() * p.z(); };
  double value = 0.0;
  for (size_t k = 0; k < point.weights.nodes.size(); ++k) {
    value += point.weights.weights[k] * square(mesh.nodes_m.col(point.weights.nodes[k]));
  }
  const Eigen::Vector3d nearest(0.09, 0.005, 0.0);
  EXPECT_NEAR(value, square(nearest) + Eigen::Vector3d(2 * 0.09, 0, 0).dot(outside - nearest),
              1e-16);
}

TEST(PointLocator, CurvedCellsReproduceRestPositionsToo) {
  const TetMesh mesh = CurvedMesh();
  const PointLocator locator(mesh);
  for (const Eigen::Vector3d& point_m : PointsAround(500, 6)) {
    const BodyPoint point = locator.Embed(point_m);
    EXPECT_NEAR(WeightSum(point.weights), 1.0, 1e-12);
    EXPECT_LT((point.weights.Position(Flat(mesh.nodes_m)) - point_m).norm(), 1e-14);
  }
}

TEST(PointLocator, InsideACurvedCellTheWeightsAreItsShapeFunctions) {
  const TetMesh mesh = CurvedMesh();
  const PointLocator locator(mesh);
  const Eigen::Vector3d xi(0.22, 0.27, 0.24);
  const Eigen::VectorXd shape = ShapeFunctions(ElementType::kTet10, xi);
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::Matrix3Xd nodes_m = mesh.nodes_m(Eigen::all, mesh.cells.col(cell));
    const BodyPoint point = locator.Embed(nodes_m * shape);
    ASSERT_EQ(point.cell, cell);
    for (int k = 0; k < 10; ++k) {
      const auto found =
          std::find(point.weights.nodes.begin(), point.weights.nodes.end(), mesh.cells(k, cell));
      const auto index = static_cast<size_t>(found - point.weights.nodes.begin());
      EXPECT_NEAR(point.weights.weights[index], shape(k), 1e-10);
    }
  }
}

TEST(EmbedBall, OfRadiusZeroIsThePoint) {
  const PointLocator locator(MeshOf(ElementType::kTet4));
  const Eigen::Vector3d point_m(0.031, 0.012, 0.017);
  EXPECT_EQ(locator.EmbedBall(point_m, 0.0).weights.weights,
            locator.Embed(point_m).weights.weights);
}

TEST(EmbedBall, TakesTheMeanOverTheVolumeOfTheBall) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kEmbedded_m, {1, 1, 1}));
  const PointLocator locator(mesh);
  constexpr double kRadius_m = 0.003;
  const Eigen::Vector3d centre_m(0.055, 0.0101, 0.0149);
  const BodyPoint ball = locator.EmbedBall(centre_m, kRadius_m);
  double mean_square = 0.0;
  for (size_t k = 0; k < ball.weights.nodes.size(); ++k) {
    mean_square += ball.weights.weights[k] * mesh.nodes_m.col(ball.weights.nodes[k]).squaredNorm();
  }
  EXPECT_NEAR(mean_square, centre_m.squaredNorm() + 0.6 * kRadius_m * kRadius_m, 1e-15);
}

TEST(EmbedBall, SpreadsTheForceOverMoreNodesThanThePoint) {
  const PointLocator locator(BoxMesh(kEmbedded_m, {20, 4, 6}));
  const Eigen::Vector3d point_m(0.0512, 0.0112, 0.0172);
  const auto largest = [](const InterpolationWeights& weights) {
    return *std::max_element(weights.weights.begin(), weights.weights.end());
  };
  const BodyPoint point = locator.Embed(point_m);
  const BodyPoint ball = locator.EmbedBall(point_m, 0.008);
  EXPECT_GT(ball.weights.nodes.size(), point.weights.nodes.size());
  EXPECT_LT(largest(ball.weights), largest(point.weights));
}

}  // namespace
}  // namespace palpate::fem
