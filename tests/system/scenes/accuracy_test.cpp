// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/accuracy.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

namespace palpate::test_support {
namespace {

using force_estimation::ContactForce;
using force_estimation::ForceEstimate;
using virtual_robot::TrueForce;

TrueForce Truth(const std::string& name, const Eigen::Vector3d& position_m, double force_N) {
  return {.name = name,
          .position_m = position_m,
          .rest_position_m = position_m,
          .force_N = {0.0, 0.0, -force_N}};
}

ContactForce Found(const std::string& name, const Eigen::Vector3d& position_m, double force_N,
                   double ci95_N = 0.0) {
  ContactForce contact;
  contact.status = Status::Ok();
  contact.name = name;
  contact.position_m = position_m;
  contact.force_N = {0.0, 0.0, -force_N};
  contact.ci95_N = ci95_N;
  contact.location_ci95_m = 3e-3;
  return contact;
}

ForceEstimate Estimate(const std::vector<ContactForce>& contacts) {
  ForceEstimate estimate;
  estimate.status = contacts.empty() ? Status(StatusCode::kNoContact, "") : Status::Ok();
  estimate.contacts = contacts;
  return estimate;
}

TEST(Accuracy, ComparesSizePlaceAndInterval) {
  Accuracy accuracy;
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)},
               Estimate({Found("ball", {0.004, 0, 0}, 0.9, 0.15)}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)},
               Estimate({Found("ball", {0.002, 0, 0}, 1.2, 0.15)}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)},
               Estimate({Found("ball", {0.003, 0, 0}, 1.0, 0.15)}));
  const AccuracySummary summary = accuracy.Summary();
  EXPECT_EQ(summary.forces, 3);
  EXPECT_EQ(summary.found_share, 1.0);
  EXPECT_NEAR(summary.mean_relative_error, 0.1, 1e-12);
  EXPECT_NEAR(summary.median_relative_error, 0.1, 1e-12);
  EXPECT_NEAR(summary.largest_relative_error, 0.2, 1e-12);
  EXPECT_NEAR(summary.median_location_error_m, 0.003, 1e-12);
  EXPECT_NEAR(summary.force_coverage, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(summary.location_coverage, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(summary.false_alarms, 0);
}

TEST(Accuracy, WhatIsNotFoundCountsInFull) {
  Accuracy accuracy;
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)}, Estimate({}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)}, Estimate({Found("ball", {0, 0, 0}, 1.0)}));
  EXPECT_EQ(accuracy.Summary().found_share, 0.5);
  EXPECT_EQ(accuracy.Summary().mean_relative_error, 0.5);
}

TEST(Accuracy, ForcesWithoutATrueOneAreFalseAlarms) {
  Accuracy accuracy;
  accuracy.Add({}, Estimate({Found("hidden_1", {0, 0, 0}, 0.1)}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)},
               Estimate({Found("hidden_1", {0.1, 0, 0}, 1.0), Found("ball", {0, 0, 0}, 1.0)}));
  accuracy.Add({}, Estimate({}));
  EXPECT_EQ(accuracy.Summary().false_alarms, 2);
  EXPECT_EQ(accuracy.Summary().frames, 3);
}

TEST(Accuracy, ForcesOfOtherNamesGoToTheNearestTrueOne) {
  Accuracy accuracy;
  accuracy.Add(
      {Truth("a", {0, 0, 0}, 1.0), Truth("b", {0.06, 0, 0}, 0.5)},
      Estimate({Found("contact_1", {0.05, 0, 0}, 0.5), Found("contact_2", {0, 0, 0}, 1.0)}));
  EXPECT_EQ(accuracy.Summary().mean_relative_error, 0.0);
  EXPECT_NEAR(accuracy.Summary().largest_location_error_m, 0.01, 1e-12);
}

TEST(Accuracy, DirectionsCountWhereTheyWereObservable) {
  ContactForce normal_only = Found("ball", {0, 0, 0}, 1.0);
  normal_only.status = Status(StatusCode::kTangentialUnobservable, "");
  ContactForce askew = Found("ball", {0, 0, 0}, 1.0);
  askew.force_N = {std::sin(0.2), 0.0, -std::cos(0.2)};
  Accuracy accuracy;
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)}, Estimate({normal_only}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)}, Estimate({askew}));
  EXPECT_EQ(accuracy.Summary().directions, 1);
  EXPECT_NEAR(accuracy.Summary().mean_direction_error_rad, 0.2, 1e-9);
}

TEST(Accuracy, EstimatesThatFailAreCountedAndTellNothing) {
  ForceEstimate failed = Estimate({Found("ball", {0, 0, 0}, 1.0)});
  failed.status = Status(StatusCode::kNotConverged, "");
  Accuracy accuracy;
  accuracy.Add({Truth("ball", {0, 0, 0}, 1.0)}, failed);
  EXPECT_EQ(accuracy.Summary().failed_frames, 1);
  EXPECT_EQ(accuracy.Summary().found_share, 0.0);
}

TEST(Accuracy, SmallForcesDoNotCount) {
  Accuracy accuracy(0.2);
  accuracy.Add({Truth("ball", {0, 0, 0}, 0.1)}, Estimate({}));
  accuracy.Add({Truth("ball", {0, 0, 0}, 0.1)}, Estimate({Found("ball", {0, 0, 0}, 0.1)}));
  EXPECT_EQ(accuracy.Summary().forces, 0);
  EXPECT_EQ(accuracy.Summary().false_alarms, 0);
}

}  // namespace
}  // namespace palpate::test_support
