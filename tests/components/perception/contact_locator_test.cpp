// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/contact_locator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

#include "tests/components/perception/contact_scene.hpp"

namespace palpate::perception {
namespace {

using test::BallsOnPlate;
using test::CloudOf;
using test::Clouds;
using test::ContactView;
using test::Look;
using test::SampleAll;

constexpr double kSpacing_m = 0.0014;

std::vector<DetectedContact> Locate(const Clouds& clouds, const ContactConfig& config = {}) {
  return ContactLocator(config).Locate(clouds.robot, clouds.object);
}

/// Where SampleAll puts a place of the plate.
Eigen::Vector3d OnPlate(const Eigen::Vector2d& touch_m) {
  return {touch_m.x(), -touch_m.y(), 0.45};
}

std::vector<Eigen::Vector2d> Lattice(int along_x, int along_y, double apart_m) {
  std::vector<Eigen::Vector2d> places_m;
  for (int i = 0; i < along_x; ++i) {
    for (int j = 0; j < along_y; ++j) {
      places_m.emplace_back((i - 0.5 * (along_x - 1)) * apart_m,
                            (j - 0.5 * (along_y - 1)) * apart_m);
    }
  }
  return places_m;
}

rgbd::SensedCloud Moved(const rgbd::SensedCloud& cloud, const Eigen::Isometry3d& motion) {
  rgbd::SensedCloud moved = cloud;
  moved.points_m = (motion.cast<float>() * cloud.points_m.colwise().homogeneous()).topRows<3>();
  return moved;
}

rgbd::SensedCloud Shuffled(const rgbd::SensedCloud& cloud, std::mt19937* random) {
  std::vector<int> order(static_cast<std::size_t>(cloud.Count()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), *random);
  rgbd::SensedCloud shuffled = cloud;
  shuffled.points_m = cloud.points_m(Eigen::all, order);
  shuffled.sigma_m = cloud.sigma_m(order);
  return shuffled;
}

TEST(ContactLocator, ABallOnAPlateIsLocatedWithinItsSpacing) {
  const Eigen::Vector2d touch_m(0.0213, -0.0347);
  const auto contacts = Locate(SampleAll({.touch_m = {touch_m}}, kSpacing_m));
  ASSERT_EQ(contacts.size(), 1u);
  const Eigen::Vector3d off_m = contacts[0].position_m - OnPlate(touch_m);
  EXPECT_LT(off_m.head<2>().norm(), kSpacing_m);
  EXPECT_LT(std::abs(off_m.z()), 1e-6);  // on the plate
  EXPECT_TRUE(contacts[0].name.empty());
}

TEST(ContactLocator, ManyBallsAreAsManyContacts) {
  for (const auto& [x, y] : {std::pair(2, 1), std::pair(5, 4)}) {
    const auto places_m = Lattice(x, y, 0.034);
    const auto contacts =
        Locate(SampleAll({.plate_half_m = 0.11, .touch_m = places_m}, kSpacing_m));
    ASSERT_EQ(contacts.size(), places_m.size());
    for (const Eigen::Vector2d& place_m : places_m) {
      const auto near = [&](const DetectedContact& contact) {
        return (contact.position_m - OnPlate(place_m)).norm() < 2.0 * kSpacing_m;
      };
      EXPECT_EQ(std::count_if(contacts.begin(), contacts.end(), near), 1);
    }
  }
}

TEST(ContactLocator, FarObjectsAndEmptyCloudsGiveNoContact) {
  Clouds clouds = SampleAll({.touch_m = {{0.0, 0.0}}, .gap_m = 0.016}, kSpacing_m);
  EXPECT_TRUE(Locate(clouds).empty());
  clouds = SampleAll({.touch_m = {{0.0, 0.0}}}, kSpacing_m);
  ContactLocator locator({});
  ASSERT_EQ(locator.Locate(clouds.robot, clouds.object).size(), 1u);
  EXPECT_TRUE(locator.Locate(clouds.robot, {}).empty());
  EXPECT_TRUE(locator.Locate({}, clouds.object).empty());
  EXPECT_TRUE(locator.Locate({}, {}).empty());
  const auto single = CloudOf({{0.0, 0.0, 0.45}}, 1e-4);
  EXPECT_TRUE(locator.Locate(single, single).empty());
  ASSERT_EQ(locator.Locate(clouds.robot, clouds.object).size(), 1u);
}

TEST(ContactLocator, TouchingNeedsMoreNeighboursThanNNeigh) {
  // Five of the robot's points lie within 5 mm of the object's point, a sixth does not.
  std::vector<Eigen::Vector3d> robot;
  for (int k = 0; k < 5; ++k) robot.emplace_back(0.001 * k, 0.0, 0.5);
  robot.emplace_back(-0.006, 0.0, 0.5);
  const Clouds clouds = {CloudOf(robot, 1e-4), CloudOf({{0.0, 0.0, 0.4995}}, 1e-4)};
  ContactConfig config{.r_search_m = 0.005, .n_neigh = 4, .min_points = 1};
  EXPECT_EQ(Locate(clouds, config).size(), 1u);
  config.n_neigh = 5;
  EXPECT_TRUE(Locate(clouds, config).empty());
  config.r_search_m = 0.0065;
  EXPECT_EQ(Locate(clouds, config).size(), 1u);
  config.min_points = 2;
  EXPECT_TRUE(Locate(clouds, config).empty());
}

TEST(ContactLocator, TouchingPointsFartherApartThanTheClusterDistanceAreTwoContacts) {
  const Clouds plate = SampleAll({}, kSpacing_m);
  const Clouds clouds = {
      plate.robot,
      CloudOf({{0.0, 0.0, 0.449}, {0.0028, 0.0, 0.449}, {0.0112, 0.0, 0.449}, {0.014, 0.0, 0.449}},
              1e-4)};
  ContactConfig config{.cluster_distance_m = 0.0095, .min_points = 1};
  auto contacts = Locate(clouds, config);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].point_count, 4);
  EXPECT_NEAR(contacts[0].position_m.x(), 0.007, 1e-7);
  EXPECT_NEAR(contacts[0].extent_m.x(), 0.014, 1e-7);
  EXPECT_NEAR(contacts[0].extent_m.z(), 0.0, 1e-7);
  config.cluster_distance_m = 0.0080;
  contacts = Locate(clouds, config);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(std::abs(contacts[0].position_m.x() - contacts[1].position_m.x()), 0.0112, 1e-7);
}

TEST(ContactLocator, RigidMotionsMoveContactsWithTheClouds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto place = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
  std::vector<Eigen::Vector3d> unused;
  Clouds clouds = Look({.touch_m = {{0.03, 0.01}, {-0.03, 0.0}}}, {}, &random, &unused);
  // The noise along the view ray is the camera's, not the scene's: next to none here.
  clouds.robot.sigma_m.setConstant(1e-7f);
  clouds.object.sigma_m.setConstant(1e-7f);
  const auto before = Locate(clouds);
  ASSERT_EQ(before.size(), 2u);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.translate(0.1 * place());
    motion.rotate(Eigen::AngleAxisd(3.0 * any(random), Eigen::Vector3d::UnitZ()));
    motion.rotate(Eigen::AngleAxisd(0.3 * any(random), Eigen::Vector3d::UnitX()));
    const auto after = Locate({Moved(clouds.robot, motion), Moved(clouds.object, motion)});
    ASSERT_EQ(after.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_LT((after[k].position_m - motion * before[k].position_m).norm(), 1e-5);
      const Eigen::Matrix3d turned_m2 =
          motion.linear() * before[k].covariance_m2 * motion.linear().transpose();
      EXPECT_LT((after[k].covariance_m2 - turned_m2).norm(), 1e-2 * turned_m2.norm());
      EXPECT_EQ(after[k].point_count, before[k].point_count);
    }
  }
}

TEST(ContactLocator, DepthNoiseCountsAlongTheViewRayAndFallsWithTheNumber) {
  const Clouds plate = SampleAll({}, kSpacing_m);
  const auto covariance_m2 = [&](double sigma_m, int count) {
    const std::vector<Eigen::Vector3d> same(static_cast<std::size_t>(count),
                                            Eigen::Vector3d(0.09, 0.0, 0.449));
    const ContactConfig config{.r_search_m = 0.003, .cluster_distance_m = 0.003, .min_points = 1};
    return Locate({plate.robot, CloudOf(same, sigma_m)}, config).at(0).covariance_m2;
  };
  const Eigen::Vector3d ray = Eigen::Vector3d(0.09, 0.0, 0.449) / 0.449;
  const Eigen::Matrix3d of_few_m2 = covariance_m2(0.002, 4);
  const Eigen::Matrix3d of_many_m2 = covariance_m2(0.002, 16);
  const double variance_m2 = 0.002 * 0.002 * (1.0 / 4.0 - 1.0 / 16.0);
  const Eigen::Matrix3d expected_m2 = variance_m2 * ray * ray.transpose();
  EXPECT_LT((of_few_m2 - of_many_m2 - expected_m2).norm(), 1e-5 * variance_m2);
}

TEST(ContactLocator, TheOrderOfThePointsDoesNotMatter) {
  std::mt19937 random(6);
  std::vector<Eigen::Vector3d> unused;
  const Clouds clouds =
      Look({.radius_m = 0.008, .touch_m = Lattice(3, 3, 0.05)}, {}, &random, &unused);
  const auto before = Locate(clouds);
  ASSERT_EQ(before.size(), 9u);
  for (int trial = 0; trial < 5; ++trial) {
    const auto after = Locate({Shuffled(clouds.robot, &random), Shuffled(clouds.object, &random)});
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_LT((after[k].position_m - before[k].position_m).norm(), 1e-9);
      EXPECT_LT((after[k].covariance_m2 - before[k].covariance_m2).norm(), 1e-12);
    }
  }
}

/// What comes of contacts that a camera sees from one side only.
struct Tally {
  int trials = 0;
  int found = 0;
  int held = 0;  ///< errors within the ellipsoid of 95 %
  double error_m = 0.0;
  double chi_squared = 0.0;

  void Add(const std::vector<DetectedContact>& contacts, const Eigen::Vector3d& touch_m) {
    ++trials;
    if (contacts.empty()) return;
    ++found;
    const Eigen::Vector3d off_m = contacts[0].position_m - touch_m;
    const double squares = off_m.dot(contacts[0].covariance_m2.inverse() * off_m);
    error_m += off_m.norm();
    chi_squared += squares;
    held += squares < 7.815 ? 1 : 0;
  }
};

/// `predicted`: the locator knows where the plate is, seen or not.
Tally LookAtMany(double post_height_m, double radius_from_m, double radius_to_m,
                 bool predicted = false) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  Tally tally;
  for (int trial = 0; trial < 60; ++trial) {
    BallsOnPlate scene{.radius_m = radius_from_m + (radius_to_m - radius_from_m) * any(random),
                       .plate_half_m = 0.06,
                       .touch_m = {{0.03 * any(random), 0.03 * any(random)}},
                       .post_height_m = post_height_m};
    const ContactView view{.tilt_rad = 0.7 + 0.6 * any(random), .turn_rad = 6.0 * any(random)};
    std::vector<Eigen::Vector3d> touch_m;
    const Clouds clouds = Look(scene, view, &random, &touch_m);
    const PredictedSurface plate = test::PlateSeenBy(view, scene.plate_half_m);
    ContactLocator locator({});
    tally.Add(locator.Locate(clouds.robot, clouds.object, predicted ? &plate : nullptr),
              touch_m[0]);
  }
  return tally;
}

TEST(ContactLocator, WhatABallHidesIsFound) {
  const Tally tally = LookAtMany(0.0, 0.005, 0.018);
  EXPECT_EQ(tally.found, tally.trials);
  EXPECT_EQ(tally.held, tally.found);
  EXPECT_LT(tally.error_m, 5e-4 * tally.found);
}

TEST(ContactLocator, WhatAPostHidesStandsInTheCovariance) {
  const Tally tally = LookAtMany(0.06, 0.003, 0.012);
  EXPECT_EQ(tally.found, tally.trials);
  EXPECT_GE(tally.held, tally.found * 9 / 10);
  EXPECT_GT(tally.chi_squared, 0.5 * tally.found);  // nor is it much too large
}

TEST(ContactLocator, WhatABallHidesIsFoundOnTheSkin) {
  const Tally tally = LookAtMany(0.0, 0.005, 0.018, true);
  EXPECT_EQ(tally.found, tally.trials);
  EXPECT_GE(tally.held, tally.found * 9 / 10);
  EXPECT_LT(tally.error_m, 1e-3 * tally.found);
}

TEST(ContactLocator, WhatAPostHidesIsFoundBetterOnTheSkin) {
  const Tally tally = LookAtMany(0.06, 0.003, 0.012, true);
  EXPECT_EQ(tally.found, tally.trials);
  EXPECT_GE(tally.held, tally.found * 9 / 10);
  EXPECT_GT(tally.chi_squared, 0.3 * tally.found);  // nor is it much too large
  EXPECT_LT(tally.error_m, 0.7 * LookAtMany(0.06, 0.003, 0.012).error_m);
}

TEST(ContactLocator, ABallThatHoversIsNoContact) {
  std::mt19937 random(8);
  std::vector<Eigen::Vector3d> unused;
  for (const double gap_m : {0.0, 0.008}) {
    const BallsOnPlate scene{.radius_m = 0.01, .touch_m = {{0.0, 0.0}}, .gap_m = gap_m};
    const ContactView view{.tilt_rad = 1.2};
    const Clouds clouds = Look(scene, view, &random, &unused);
    EXPECT_EQ(Locate(clouds).size(), gap_m > 0.0 ? 0u : 1u);
    // With a known plate, a smaller gap is distinguished from none.
    const PredictedSurface plate = test::PlateSeenBy(view, scene.plate_half_m);
    const Clouds nearer = Look({.radius_m = 0.01, .touch_m = {{0.0, 0.0}}, .gap_m = 0.6 * gap_m},
                               view, &random, &unused);
    ContactLocator locator({});
    EXPECT_EQ(locator.Locate(nearer.robot, nearer.object, &plate).size(), gap_m > 0.0 ? 0u : 1u);
  }
}

}  // namespace
}  // namespace palpate::perception
