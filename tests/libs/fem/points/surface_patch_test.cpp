// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/surface_patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

const Eigen::Vector3d kPatchBeam_m(0.10, 0.04, 0.03);
const Eigen::Vector3d kOnTop_m(0.052, 0.021, 0.03);

TetMesh PatchMesh(ElementType element) {
  const TetMesh mesh = BoxMesh(kPatchBeam_m, {10, 4, 3});
  return element == ElementType::kTet10 ? MakeQuadratic(mesh) : mesh;
}

double SumOfWeights(const InterpolationWeights& weights) {
  return std::accumulate(weights.weights.begin(), weights.weights.end(), 0.0);
}

double WeightOf(const InterpolationWeights& weights, int node) {
  double sum = 0.0;
  for (size_t k = 0; k < weights.nodes.size(); ++k) {
    if (weights.nodes[k] == node) sum += weights.weights[k];
  }
  return sum;
}

class Patch : public testing::TestWithParam<ElementType> {};

INSTANTIATE_TEST_SUITE_P(Elements, Patch, testing::Values(ElementType::kTet4, ElementType::kTet10),
                         [](const auto& element) {
                           return element.param == ElementType::kTet4 ? "tet4" : "tet10";
                         });

TEST_P(Patch, OnAPlaneIsADiscRoundThePoint) {
  const PointLocator locator(PatchMesh(GetParam()));
  for (const double radius_m : {0.001, 0.005, 0.012}) {
    const SurfacePatch patch = MakeSurfacePatch(locator, kOnTop_m, radius_m);
    EXPECT_NEAR(SumOfWeights(patch.weights), 1.0, 1e-13);
    const double disc_m2 = std::numbers::pi * radius_m * radius_m;
    EXPECT_NEAR(patch.area_m2, disc_m2, 2e-3 * disc_m2);
    EXPECT_LT((patch.centre_m - kOnTop_m).norm(), 2e-4 * radius_m);
    EXPECT_TRUE(patch.normal.isApprox(Eigen::Vector3d::UnitZ(), 1e-13));
    EXPECT_NEAR(patch.distance_m, 0.0, 1e-16);
  }
}

TEST_P(Patch, ShrinksToThePointItself) {
  const PointLocator locator(PatchMesh(GetParam()));
  const InterpolationWeights point = locator.Embed(kOnTop_m).weights;
  const InterpolationWeights small = MakeSurfacePatch(locator, kOnTop_m, 1e-7).weights;
  for (size_t k = 0; k < point.nodes.size(); ++k) {
    EXPECT_NEAR(WeightOf(small, point.nodes[k]), point.weights[k], 1e-5);
  }
}

TEST_P(Patch, OfRadiusZeroIsThePoint) {
  const PointLocator locator(PatchMesh(GetParam()));
  const SurfacePatch patch = MakeSurfacePatch(locator, kOnTop_m, 0.0);
  EXPECT_EQ(patch.weights.nodes, locator.Embed(kOnTop_m).weights.nodes);
  EXPECT_EQ(patch.weights.weights, locator.Embed(kOnTop_m).weights.weights);
  EXPECT_EQ(patch.area_m2, 0.0);
  EXPECT_TRUE(patch.normal.isApprox(Eigen::Vector3d::UnitZ(), 1e-13));
}

TEST_P(Patch, LargerThanTheBodyIsItsWholeSurface) {
  const PointLocator locator(PatchMesh(GetParam()));
  const SurfacePatch patch = MakeSurfacePatch(locator, kOnTop_m, 1.0);
  EXPECT_NEAR(patch.area_m2, geometry::SurfaceArea_m2(locator.surface().surface()), 1e-15);
  EXPECT_TRUE(patch.centre_m.isApprox(0.5 * kPatchBeam_m, 1e-12));
  EXPECT_TRUE(patch.normal.isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST_P(Patch, StartsAtTheNearestSurfacePointOfAPointThatStandsOff) {
  const PointLocator locator(PatchMesh(GetParam()));
  const Eigen::Vector3d above_m = kOnTop_m + Eigen::Vector3d(0, 0, 0.006);
  const SurfacePatch above = MakeSurfacePatch(locator, above_m, 0.005);
  EXPECT_EQ(above.weights.weights, MakeSurfacePatch(locator, kOnTop_m, 0.005).weights.weights);
  EXPECT_NEAR(above.distance_m, 0.006, 1e-15);
}

TEST_P(Patch, OnAnEdgeLooksBetweenTheFaces) {
  const PointLocator locator(PatchMesh(GetParam()));
  const SurfacePatch patch = MakeSurfacePatch(locator, {0.0, 0.02, 0.03}, 0.006);
  EXPECT_TRUE(patch.normal.isApprox(Eigen::Vector3d(-1, 0, 1).normalized(), 1e-3));
  EXPECT_NEAR(patch.area_m2, std::numbers::pi * 36e-6, 2e-3 * std::numbers::pi * 36e-6);
}

TEST(Patch, CornersOfWholeTet10FacesCarryNothing) {
  const TetMesh mesh = MakeQuadratic(BoxMesh(kPatchBeam_m, {4, 2, 2}));
  const int corners = BoxMesh(kPatchBeam_m, {4, 2, 2}).NodeCount();
  const PointLocator locator(mesh);
  const SurfacePatch patch = MakeSurfacePatch(locator, kOnTop_m, 1.0);
  double on_mid_edges = 0.0;
  for (size_t k = 0; k < patch.weights.nodes.size(); ++k) {
    if (patch.weights.nodes[k] < corners) {
      EXPECT_NEAR(patch.weights.weights[k], 0.0, 1e-15);
    } else {
      on_mid_edges += patch.weights.weights[k];
    }
  }
  EXPECT_NEAR(on_mid_edges, 1.0, 1e-13);
}

TEST(Patch, TheSameDiscOnAnotherMeshCarriesTheSameForceAndMoment) {
  const SurfacePatch coarse =
      MakeSurfacePatch(PointLocator(BoxMesh(kPatchBeam_m, {3, 2, 2})), kOnTop_m, 0.01);
  const SurfacePatch fine =
      MakeSurfacePatch(PointLocator(BoxMesh(kPatchBeam_m, {20, 8, 6})), kOnTop_m, 0.01);
  EXPECT_LT((coarse.centre_m - fine.centre_m).norm(), 1e-5);
  EXPECT_NEAR(coarse.area_m2, fine.area_m2, 2e-3 * fine.area_m2);
}

}  // namespace
}  // namespace palpate::fem
