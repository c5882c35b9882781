// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/force_table.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kForceHeader =
    "recording,t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,ci95_N,location_ci95_m,status,"
    "cov_xx_N2,cov_xy_N2,cov_xz_N2,cov_yy_N2,cov_yz_N2,cov_zz_N2\n";

ForceTable ParseForces(const std::string& content) {
  const TestFolder folder;
  return ReadForceTable(folder.Write("forces.csv", content));
}

std::string ForcesRefusal(const std::string& content) {
  return MessageOf([&] { ParseForces(content); });
}

TEST(ForceTable, HasTheRowsOfEstimate) {
  const ForceTable table =
      ParseForces(std::string(kForceHeader) +
                  "r1,0.1,,,,,,,,,,no_contact,,,,,,\n"
                  "r1,0.2,a,0.01,0.02,0.03,0,0,-0.5,0.1,0.002,ok,1,0.1,0.2,2,0.3,3\n"
                  "r2,0.1,b,0.01,0.02,0.03,,,,,,unobservable,,,,,,\n");
  EXPECT_THAT(table.unused, IsEmpty());
  ASSERT_THAT(table.rows, SizeIs(3));
  EXPECT_TRUE(table.rows[0].contact.empty());
  EXPECT_EQ(table.rows[0].status, "no_contact");
  EXPECT_FALSE(table.rows[0].position_m);
  const TabledForce& force = table.rows[1];
  EXPECT_EQ(force.recording, "r1");
  EXPECT_EQ(force.t_s, 0.2);
  EXPECT_EQ(force.position_m, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(force.force_N, Eigen::Vector3d(0.0, 0.0, -0.5));
  EXPECT_EQ(force.ci95_N, 0.1);
  EXPECT_EQ(force.location_ci95_m, 0.002);
  Eigen::Matrix3d covariance_N2;
  covariance_N2 << 1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 3.0;
  EXPECT_EQ(force.covariance_N2, covariance_N2);
  EXPECT_EQ(force.where.line, 3);
  EXPECT_FALSE(table.rows[2].force_N);
  EXPECT_FALSE(table.rows[2].covariance_N2);
}

TEST(ForceTable, HasTheCovarianceOfThePlace) {
  const std::string columns =
      "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,location_cov_xx_m2,location_cov_xy_m2,location_cov_xz_m2,"
      "location_cov_yy_m2,location_cov_yz_m2,location_cov_zz_m2\n";
  const ForceTable table = ParseForces(columns + "0,0,0,0,0,0,-1,4e-6,1e-6,0,9e-6,0,0\n");
  EXPECT_THAT(table.unused, IsEmpty());
  Eigen::Matrix3d covariance_m2;
  covariance_m2 << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 0.0, 0.0, 0.0, 0.0;
  EXPECT_EQ(table.rows.at(0).location_covariance_m2, covariance_m2);
  EXPECT_THAT(ForcesRefusal(columns + "0,0,0,0,0,0,-1,4e-6,1e-5,0,9e-6,0,0\n"),
              AllOf(HasSubstr("no covariance"), HasSubstr(" m2")));
}

TEST(ForceTable, NeedsNoMoreThanTimesPlacesAndForces) {
  const ForceTable table = ParseForces(
      "sensor,fx_N,fy_N,fz_N,x_m,y_m,z_m,t_s\n"
      "7,0,0,-1,0.1,0,0,5\n7,0,0,-2,0.2,0,0,5\n7,0,0,-3,0.1,0,0,6\n");
  EXPECT_THAT(table.unused, ElementsAre("sensor"));
  ASSERT_THAT(table.rows, SizeIs(3));
  EXPECT_EQ(table.rows[1].contact, "2");
  EXPECT_EQ(table.rows[2].contact, "1");
  EXPECT_EQ(table.rows[2].status, "ok");
  EXPECT_FALSE(table.rows[2].ci95_N);
  EXPECT_FALSE(table.rows[2].covariance_N2);
}

TEST(ForceTable, IsRefusedAtTheFieldThatIsWrong) {
  EXPECT_THAT(ForcesRefusal("t_s,x_m,y_m,z_m,fx_N,fy_N\n0,0,0,0,0,0\n"),
              AllOf(HasSubstr("forces.csv:1:"), HasSubstr("'fz_N' is missing")));
  EXPECT_THAT(ForcesRefusal("t_s,x_mm,y_m,z_m,fx_N,fy_N,fz_N\n0,0,0,0,0,0,0\n"),
              AllOf(HasSubstr("forces.csv:1:5"), HasSubstr("x_mm")));
  const std::string header = kForceHeader;
  EXPECT_THAT(ForcesRefusal(header + "r,2,,,,,,,,,,ok,,,,,,\nr,1,,,,,,,,,,ok,,,,,,\n"),
              AllOf(HasSubstr("forces.csv:3:"), HasSubstr("time falls")));
  EXPECT_THAT(ForcesRefusal(header + "r,1,a,0,,0,0,0,1,,,ok,,,,,,\n"),
              AllOf(HasSubstr("forces.csv:2:"), HasSubstr("y_m"), HasSubstr("is missing")));
  EXPECT_THAT(ForcesRefusal(header + "r,1,a,,,,0,0,1,,,ok,,,,,,\n"),
              HasSubstr("a force needs its place"));
  EXPECT_THAT(ForcesRefusal(header + "r,1,a,0,0,0,0,0,1,-0.1,,ok,,,,,,\n"),
              AllOf(HasSubstr("ci95_N"), HasSubstr("0 or more")));
  EXPECT_THAT(ForcesRefusal(header + "r,1,a,0,0,0,0,0,1,0.1,,ok,1,2,0,1,0,1\n"),
              AllOf(HasSubstr("forces.csv:2:"), HasSubstr("no covariance")));
  EXPECT_THAT(ForcesRefusal("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,cov_xx_N2\n0,0,0,0,0,0,0,1\n"),
              AllOf(HasSubstr("forces.csv:1:"), HasSubstr("here some are missing")));
}

TEST(ForceTable, TakesNanForAMissingNumber) {
  const ForceTable table = ParseForces("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0.1,0,0,nan,nan,nan\n");
  EXPECT_TRUE(table.rows.at(0).position_m);
  EXPECT_FALSE(table.rows.at(0).force_N);
}

}  // namespace
}  // namespace palpate::experiment
