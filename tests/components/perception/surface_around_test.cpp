// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/surface_around.hpp"

#include <gtest/gtest.h>

#include "components/perception/model/model_segmenter.hpp"
#include "tests/components/perception/contact_scene.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

/// A plate of 0.2 m whose upper side is z = 0.5 in the camera's frame and faces it.
PredictedSurface Plate() {
  return test::PlateSeenBy({.distance_m = 0.5, .tilt_rad = 0.0, .turn_rad = 0.0}, 0.1);
}

TEST(SurfaceAround, TellsTheNearestPointAndWhichSideOfItAPlaceIs) {
  const SurfaceAround around(Plate(), {0.0, 0.0, 0.48}, 0.03);
  ASSERT_TRUE(SurfaceAround(Plate(), {0.0, 0.0, 0.4}, 0.03).empty());
  ASSERT_FALSE(around.empty());
  for (const double height_m : {0.012, -0.006}) {
    const NearestSurface nearest = around.Nearest({0.03, -0.02, 0.5 - height_m});
    EXPECT_LT((nearest.position_m - Eigen::Vector3d(0.03, -0.02, 0.5)).norm(), 1e-9);
    EXPECT_NEAR(nearest.height_m, height_m, 1e-9);
    EXPECT_LT((nearest.outward + Eigen::Vector3d::UnitZ()).norm(), 1e-9) << "towards the camera";
  }
  const NearestSurface beside = around.Nearest({0.104, 0.0, 0.497});
  EXPECT_NEAR(beside.height_m, 0.005, 1e-9);
  EXPECT_LT((beside.position_m - Eigen::Vector3d(0.1, 0.0, 0.5)).norm(), 1e-9);
}

TEST(SurfaceAround, ItsPartsMakeUpItsArea) {
  const SurfaceAround around(Plate(), {0.0, 0.0, 0.49}, 0.015);  // the upper side alone
  double area_m2 = 0.0;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  around.ForEachPart([&](const Eigen::Vector3d& part_m, double part_m2) {
    area_m2 += part_m2;
    middle_m += part_m2 * part_m;
  });
  EXPECT_NEAR(area_m2, 0.04, 1e-9);
  EXPECT_LT((middle_m / area_m2 - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(), 1e-9);
}

/// The far side is where contacts are that the camera does not see.
TEST(SurfaceAround, TheSegmenterGivesTheWholeSurface) {
  const scenario::Scenario scenario = PushScenario();
  const virtual_camera::View view = RestView(scenario);
  const PredictedSurface predicted = Predict(scenario, view.nodes_m);
  ReadySegmenter segmenter(scenario);
  LabelledScene scene(scenario);
  scene.Take(view);
  ASSERT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok());
  const PredictedSurface* fitted = segmenter.FittedSurface();
  ASSERT_NE(fitted, nullptr);
  EXPECT_TRUE(fitted->triangles == predicted.triangles) << fitted->triangles.cols() << " triangles";
  EXPECT_LT((fitted->vertices_m - predicted.vertices_m).colwise().norm().maxCoeff(), 0.003);
}

}  // namespace
}  // namespace palpate::perception
