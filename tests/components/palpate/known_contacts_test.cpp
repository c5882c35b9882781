// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/known_contacts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/palpate/find_robot.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using force_estimation::KnownBeforeSeen;
using force_estimation::KnownContacts;
using force_estimation::SeenContact;
using force_estimation::SitesOfLoads;
using testing::SizeIs;

SeenContact SeenAt(const std::string& name, const Eigen::Vector3d& position_m) {
  SeenContact contact;
  contact.name = name;
  contact.position_m = position_m;
  return contact;
}

TEST(KnownContacts, RideOnTheSurface) {
  const TestFolder folder;
  const auto model = LoadRobot(WriteBarRobot(folder));
  const KnownContacts known(model->body());
  // 5 mm above the bar's upper side: the contact lies on that side.
  const std::vector<force_estimation::ContactSite> sites = {
      {"tip", {0.073, 0.012, 0.025}, 0.004, Eigen::Vector3d::Zero()}};
  const auto at_rest = known.At(sites, {});
  ASSERT_THAT(at_rest, SizeIs(1));
  EXPECT_EQ(at_rest[0].name, "tip");
  EXPECT_TRUE(at_rest[0].position_m.isApprox(Eigen::Vector3d(0.073, 0.012, 0.020), 1e-9));
  EXPECT_NEAR(at_rest[0].extent_m.x(), 0.008, 1e-12);
  EXPECT_GT(at_rest[0].covariance_m2.trace(), 0.0);
  EXPECT_LT(at_rest[0].covariance_m2.trace(), 3.0 * 1e-3 * 1e-3);
  // An affine motion of all nodes moves it exactly so.
  Eigen::Matrix3d A;
  A << 1.1, 0.2, 0.0, 0.0, 0.9, 0.1, -0.2, 0.0, 1.0;
  const Eigen::Vector3d shift_m(0.01, -0.02, 0.03);
  const Eigen::Matrix3Xd moved_m = (A * model->body().mesh.nodes_m).colwise() + shift_m;
  const auto moved =
      known.At(sites, Eigen::Map<const Eigen::VectorXd>(moved_m.data(), moved_m.size()));
  EXPECT_TRUE(moved[0].position_m.isApprox(A * at_rest[0].position_m + shift_m, 1e-9));
}

TEST(SitesOfLoads, NamesThePlacesThatCarryALoadNow) {
  std::vector<experiment::KnownLoad> loads(3);
  loads[0].t_s = loads[1].t_s = 1.0;
  loads[0].position_m = {0.01, 0.0, 0.0};
  loads[0].force_N = {0.0, 0.0, -1.0};
  loads[1].position_m = {0.02, 0.0, 0.0};
  loads[1].patch_radius_m = 0.003;
  loads[2] = loads[1];
  loads[2].t_s = 2.0;
  loads[2].force_N = {0.0, 0.5, 0.0};
  EXPECT_THAT(SitesOfLoads(loads, 0.5), SizeIs(0));
  ASSERT_THAT(SitesOfLoads(loads, 1.5), SizeIs(1));
  EXPECT_EQ(SitesOfLoads(loads, 1.5)[0].name, "load_1");
  const auto later = SitesOfLoads(loads, 2.5);
  ASSERT_THAT(later, SizeIs(1));
  EXPECT_EQ(later[0].name, "load_2");
  EXPECT_EQ(later[0].position_m, loads[1].position_m);
  EXPECT_EQ(later[0].patch_radius_m, 0.003);
}

TEST(KnownBeforeSeen, LeavesOutWhatIsSeenOfAKnownContact) {
  SeenContact wide = SeenAt("contact_3", {0.03, 0.0, 0.0});
  wide.extent_m.y() = 0.07;
  const auto all = KnownBeforeSeen(
      {SeenAt("tip", {0.0, 0.0, 0.0})},
      {SeenAt("contact_1", {0.01, 0.0, 0.0}), SeenAt("contact_2", {0.02, 0.0, 0.0}), wide});
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].name, "tip");
  EXPECT_EQ(all[1].name, "contact_2");
  EXPECT_THAT(KnownBeforeSeen({}, {wide}), SizeIs(1));
}

}  // namespace
}  // namespace palpate::command
