// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "components/force_estimation/contact_search.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/core/error.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

/// Place where a force on a feature point acts at rest: the centre of its patch.
Eigen::Vector3d CandidateCentre(const robot::RobotModel& model, size_t point) {
  return model.Patch(model.body().feature_points[point].rest_m, 0.005).centre_m;
}

/// The feature point nearest to `position_m`.
size_t Nearest(const robot::RobotModel& model, const Eigen::Vector3d& position_m) {
  const auto& points = model.body().feature_points;
  const auto nearer = [&](const fem::BodyPoint& a, const fem::BodyPoint& b) {
    return (a.rest_m - position_m).norm() < (b.rest_m - position_m).norm();
  };
  return static_cast<size_t>(std::min_element(points.begin(), points.end(), nearer) -
                             points.begin());
}

Eigen::Vector3d Deformed(const robot::RobotModel& model, const Eigen::Vector3d& position_m,
                         const fem::StaticState& state) {
  return model.Patch(position_m, 0.005).weights.Position(state.x_m);
}

TEST(ContactSearch, FindsAContactAtAFeaturePoint) {
  const auto model = Build(BeamRobot());
  for (const Eigen::Vector3d& about :
       {Eigen::Vector3d(0.0, 0.015, 0.03), Eigen::Vector3d(-0.04, 0.0, 0.015)}) {
    const Eigen::Vector3d place = model->body().feature_points[Nearest(*model, about)].rest_m;
    const Eigen::Vector3d force_N(0.05, 0.3, -0.4);
    const fem::StaticState truth = SolveTruth(*model, {}, {LoadAt(*model, place, 0.005, force_N)});
    MarkerForceEstimator estimator(*model, Config{});
    const ForceEstimate& estimate = estimator.Update(FrameOf(*model, truth, {}));
    ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
    ASSERT_EQ(estimate.contacts.size(), 1U);
    EXPECT_EQ(estimate.contacts[0].name, "contact_1");
    EXPECT_LT((estimate.contacts[0].position_m - Deformed(*model, place, truth)).norm(), 1e-6);
    EXPECT_LT((estimate.contacts[0].force_N - force_N).norm(), 1e-6);
    EXPECT_GT(estimate.contacts[0].location_ci95_m, 0.0);
  }
}

TEST(ContactSearch, FindsAContactBetweenFeaturePointsWithinItsInterval) {
  const auto model = Build(BeamRobot());
  const std::vector<Eigen::Vector3d> places = {
      {-0.01, 0.015, 0.03}, {-0.035, 0.03, 0.015}, {-0.02, 0.0, 0.012}, {-0.005, 0.02, 0.0}};
  std::mt19937 random(9);
  for (const Eigen::Vector3d& place : places) {
    const fem::SurfacePatch patch = model->Patch(place, 0.005);
    const fem::StaticState truth = SolveTruth(*model, {}, {{patch.weights, -0.1 * patch.normal}});
    MarkerFrame frame = FrameOf(*model, truth, {});
    AddNoise(1e-4, random, &frame);
    MarkerForceEstimator estimator(*model, Config{});
    const ForceEstimate& estimate = estimator.Update(frame);
    ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
    const ContactForce& contact = estimate.contacts[0];
    const double error_m = (contact.position_m - patch.weights.Position(truth.x_m)).norm();
    const double nearest_m =
        (Deformed(*model, CandidateCentre(*model, Nearest(*model, place)), truth) -
         patch.weights.Position(truth.x_m))
            .norm();
    EXPECT_LE(error_m, std::max(contact.location_ci95_m, nearest_m + 1e-3)) << place.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(contact.location_covariance_m2);
    EXPECT_GE(eigen.eigenvalues()[0], -1e-12);
    EXPECT_GT(eigen.eigenvalues()[2], 1e-8);
    EXPECT_LT(std::sqrt(eigen.eigenvalues()[2]), contact.location_ci95_m);
  }
}

TEST(ContactSearch, ReportsNoContactAtRest) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = FrameUnder(*model, {}, {});
  std::mt19937 random(2);
  AddNoise(1e-4, random, &frame);
  MarkerForceEstimator estimator(*model, Config{});
  const ForceEstimate& estimate = estimator.Update(frame);
  EXPECT_EQ(estimate.status.code(), StatusCode::kNoContact);
  EXPECT_TRUE(estimate.contacts.empty());
  EXPECT_EQ(estimate.degrees_of_freedom, 36);
  EXPECT_GT(estimate.chi_squared, 0.0);
}

TEST(ContactSearch, FindsTwoContactsWhereTwoAreAllowed) {
  const auto model = Build(BeamRobot());
  const size_t tip = Nearest(*model, {0.0, 0.015, 0.03});
  const size_t side = Nearest(*model, {-0.05, 0.0, 0.015});
  const Eigen::Vector3d tip_m = model->body().feature_points[tip].rest_m;
  const Eigen::Vector3d side_m = model->body().feature_points[side].rest_m;
  const Eigen::Vector3d tip_N(0.0, 0.1, -0.4);
  const Eigen::Vector3d side_N(0.1, 1.2, 0.1);
  const MarkerFrame frame = FrameUnder(
      *model, {}, {LoadAt(*model, tip_m, 0.005, tip_N), LoadAt(*model, side_m, 0.005, side_N)});
  Config config;
  config.max_contacts = 2;
  MarkerForceEstimator estimator(*model, config);
  const ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok());
  ASSERT_EQ(estimate.contacts.size(), 2U);
  EXPECT_EQ(estimate.contacts[1].name, "contact_2");
  const Eigen::Vector3d sum_N = estimate.contacts[0].force_N + estimate.contacts[1].force_N;
  EXPECT_LT((sum_N - tip_N - side_N).norm(), 0.25 * (tip_N + side_N).norm());
  MarkerForceEstimator only_one(*model, Config{});
  const ForceEstimate& one = only_one.Update(frame);
  ASSERT_EQ(one.contacts.size(), 1U);
  EXPECT_LT(estimate.chi_squared, 0.1 * one.chi_squared);
}

TEST(ContactSearch, OneContactIsNotTakenForTwo) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d place =
      model->body().feature_points[Nearest(*model, {0.0, 0.015, 0.03})].rest_m;
  const MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, place, 0.005, {0, 0.1, -0.4})});
  Config config;
  config.max_contacts = 2;
  MarkerForceEstimator estimator(*model, config);
  EXPECT_EQ(estimator.Update(frame).contacts.size(), 1U);
}

TEST(ContactSearch, NeverPutsTwoContactsOnOnePoint) {
  const auto model = Build(BeamRobot());
  const MarkerFrame frame = [&] {
    MarkerFrame noisy =
        FrameUnder(*model, {}, {LoadAt(*model, {0, 0.015, 0.03}, 0.005, {0, 0, -0.4})});
    std::mt19937 random(8);
    AddNoise(1e-3, random, &noisy);  // ten times what the frame says: more contacts are tried
    return noisy;
  }();
  Config config;
  config.max_contacts = 3;
  MarkerForceEstimator estimator(*model, config);
  const ForceEstimate& estimate = estimator.Update(frame);
  ASSERT_TRUE(estimate.status.ok());
  ASSERT_EQ(estimate.contacts.size(), 3U);
  for (size_t a = 0; a < 3; ++a) {
    for (size_t b = 0; b < a; ++b) {
      EXPECT_GT((estimate.contacts[a].position_m - estimate.contacts[b].position_m).norm(), 1e-3);
    }
  }
}

TEST(ContactSearch, FindsTheSameContactAgainAfterItsRelease) {
  const auto model = Build(BeamRobot());
  const Eigen::Vector3d place =
      model->body().feature_points[Nearest(*model, {0.0, 0.015, 0.03})].rest_m;
  const Eigen::Vector3d force_N(0.05, 0.3, -0.4);
  MarkerForceEstimator estimator(*model, Config{});
  double t_s = 0.0;
  const auto update = [&](double share) -> const ForceEstimate& {
    MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, place, 0.005, share * force_N)});
    frame.t_s = (t_s += 0.1);
    return estimator.Update(frame);
  };
  for (const double share : {1.0, 0.0, 0.5, 0.0, 1.0}) {
    const ForceEstimate& estimate = update(share);
    if (share == 0.0) {
      EXPECT_EQ(estimate.status.code(), StatusCode::kNoContact);
      EXPECT_TRUE(estimate.contacts.empty());
      continue;
    }
    ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
    ASSERT_EQ(estimate.contacts.size(), 1U);
    EXPECT_EQ(estimate.contacts[0].name, "contact_1");
    EXPECT_LT((estimate.contacts[0].force_N - share * force_N).norm(), 1e-5);
  }
}

/// A pull on the top is a push on the bottom, until adhesion is asked for.
TEST(ContactSearch, ReportsAPullOnlyWithAdhesion) {
  const auto model = Build(BeamRobot());
  const size_t point = Nearest(*model, {-0.02, 0.015, 0.03});
  const fem::SurfacePatch patch = model->Patch(model->body().feature_points[point].rest_m, 0.005);
  ASSERT_GT(patch.normal.z(), 0.9);
  const fem::StaticState truth = SolveTruth(*model, {}, {{patch.weights, 0.3 * patch.normal}});
  const MarkerFrame frame = FrameOf(*model, truth, {});
  const Eigen::Vector3d place_m = patch.weights.Position(truth.x_m);
  Config config;
  config.adhesion = true;
  MarkerForceEstimator pulls(*model, config);
  const ForceEstimate& pulled = pulls.Update(frame);
  ASSERT_TRUE(pulled.status.ok());
  EXPECT_LT((pulled.contacts[0].position_m - place_m).norm(), 1e-6);
  EXPECT_GT(pulled.contacts[0].force_N.z(), 0.29);
  MarkerForceEstimator pushes(*model, Config{});
  const ForceEstimate& pushed = pushes.Update(frame);
  if (!pushed.status.ok()) return;
  EXPECT_LT(pushed.contacts[0].position_m.z(), place_m.z() - 0.01);
}

/// Noise of one frame moves the location by more than that of many.
TEST(ContactSearch, RefinesTheLocationOfAContactThatStays) {
  const auto model = Build(BeamRobot());
  const fem::SurfacePatch patch = model->Patch({-0.033, 0.021, 0.03}, 0.005);
  const fem::StaticState truth = SolveTruth(*model, {}, {{patch.weights, -0.05 * patch.normal}});
  const Eigen::Vector3d place_m = patch.weights.Position(truth.x_m);
  std::mt19937 random(12);
  double first_m2 = 0.0;
  double last_m2 = 0.0;
  constexpr int kContacts = 4;
  constexpr int kFrames = 129;
  for (int contact = 0; contact < kContacts; ++contact) {
    MarkerForceEstimator estimator(*model, Config{});
    for (int k = 0; k < kFrames; ++k) {
      MarkerFrame frame = FrameOf(*model, truth, {});
      frame.t_s = 0.01 * k;
      AddNoise(1e-4, random, &frame);
      const ForceEstimate& estimate = estimator.Update(frame);
      ASSERT_TRUE(estimate.status.ok()) << ToString(estimate.status.code());
      EXPECT_EQ(estimate.contacts.at(0).name, "contact_1");
      const double error_m2 = (estimate.contacts[0].position_m - place_m).squaredNorm();
      if (k == 0) first_m2 += error_m2 / kContacts;
      if (k + 1 == kFrames) last_m2 += error_m2 / kContacts;
    }
  }
  EXPECT_LT(last_m2, 0.5 * first_m2);
  EXPECT_LT(std::sqrt(last_m2), 0.005);
}

TEST(ContactSearch, LooksOnTheContactSurfaceOnly) {
  robot::RobotDescription robot = BeamRobot();
  robot::RobotBody body = robot::BuildRobotBody(robot);
  EXPECT_EQ(std::ssize(body.contact_faces), body.boundary.FaceCount());
  robot.regions.push_back({"end", {{-0.03, -1.0, -1.0}, {1.0, 1.0, 1.0}}, std::nullopt, {}});
  robot.feature_point_region = "end";
  body = robot::BuildRobotBody(robot);
  EXPECT_LT(std::ssize(body.contact_faces), body.boundary.FaceCount());
  for (const fem::BodyPoint& point : body.feature_points) {
    EXPECT_GT(point.rest_m.x(), -0.05);
  }
  const robot::RobotModel model(std::move(body));
  const ContactCandidates candidates(model, Config{});
  for (const FitSite& site : candidates.coarse()) EXPECT_GT(site.patch.centre_m.x(), -0.05);
  std::vector<Eigen::Vector3d> everywhere_m;
  for (const FitSite& site : candidates.coarse()) everywhere_m.push_back(site.patch.centre_m);
  for (const FitSite& site : candidates.FinePlaces(everywhere_m)) {
    EXPECT_GT(site.patch.centre_m.x(), -0.05);
  }
}

TEST(ContactSearch, TooFewMarkersAreSaid) {
  const auto model = Build(BeamRobot());
  MarkerFrame frame = FrameUnder(*model, {}, {LoadAt(*model, {0, 0.015, 0.03}, 0.005, {0, 0, -1})});
  for (size_t m = 0; m + 1 < frame.markers.size(); ++m) frame.markers[m].valid = false;
  MarkerForceEstimator estimator(*model, Config{});
  ASSERT_TRUE(estimator.Update(frame).status.ok());  // one marker, three coordinates
  frame.markers.back().valid = false;
  EXPECT_EQ(estimator.Update(frame).status.code(), StatusCode::kNoRobotSeen);
}

}  // namespace
}  // namespace palpate::force_estimation
