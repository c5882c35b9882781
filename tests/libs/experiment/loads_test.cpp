// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/loads.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kHeader = "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n";

std::vector<KnownLoad> ParseLoads(const std::string& content) {
  const TestFolder folder;
  return ReadLoads(folder.Write("loads.csv", content));
}

std::string LoadsRefusal(const std::string& content) {
  return MessageOf([&] { ParseLoads(content); });
}

TEST(Loads, ASingleRowHoldsForTheWholeRecording) {
  const auto loads = ParseLoads(std::string(kHeader) + "3,0.1,0,0.03,0,0,-0.51\n");
  ASSERT_THAT(LoadsAt(loads, 0.0), SizeIs(1));
  EXPECT_EQ(LoadsAt(loads, 0.0)[0].force_N, Eigen::Vector3d(0, 0, -0.51));
  EXPECT_EQ(LoadsAt(loads, 9.0)[0].position_m, Eigen::Vector3d(0.1, 0, 0.03));
  EXPECT_EQ(loads[0].patch_radius_m, 0.0);
}

TEST(Loads, ARowHoldsUntilTheNextAndRowsOfEqualTimeActTogether) {
  const auto loads = ParseLoads(
      std::string(kHeader) + "1,0,0,0,0,0,-1\n2,0,0,0,0,0,-2\n2,0.1,0,0,0,0,-3\n4,0,0,0,0,0,0\n");
  EXPECT_THAT(LoadsAt(loads, 0.5), IsEmpty());
  ASSERT_THAT(LoadsAt(loads, 1.99), SizeIs(1));
  EXPECT_EQ(LoadsAt(loads, 1.99)[0].force_N.z(), -1.0);
  ASSERT_THAT(LoadsAt(loads, 2.0), SizeIs(2));
  EXPECT_EQ(LoadsAt(loads, 3.0)[1].force_N.z(), -3.0);
  ASSERT_THAT(LoadsAt(loads, 9.0), SizeIs(1));
  EXPECT_EQ(LoadsAt(loads, 9.0)[0].force_N.z(), 0.0);
  EXPECT_THAT(LoadsAt({}, 1.0), IsEmpty());
}

TEST(Loads, ReadBackExactlyWhatTheyWrote) {
  const TestFolder folder;
  const auto first = ParseLoads(
      "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
      "0,0.1,0.2,0.3,1,2,3,0.005\n0,0,0,0,1,1,1,\n");
  EXPECT_EQ(first[1].patch_radius_m, 0.0);
  WriteLoads(first, folder.path() / "l.csv");
  const auto second = ReadLoads(folder.path() / "l.csv");
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[0].position_m, first[0].position_m);
  EXPECT_EQ(second[0].force_N, first[0].force_N);
  EXPECT_EQ(second[0].patch_radius_m, 0.005);
}

TEST(Loads, RefuseAnUnknownForceOrPlace) {
  EXPECT_THAT(LoadsRefusal(std::string(kHeader) + "0,0,0,0,0,0,\n"),
              AllOf(HasSubstr("loads.csv:2:13"), HasSubstr("must not be empty")));
  EXPECT_THAT(LoadsRefusal(std::string(kHeader) + "0,nan,0,0,0,0,1\n"), HasSubstr("loads.csv:2:3"));
  EXPECT_THAT(LoadsRefusal(std::string(kHeader) + "0,97,0,0,0,0,1\n"), HasSubstr("millimetres?"));
  EXPECT_THAT(LoadsRefusal("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n0,0,0,0,0,0,1,-1\n"),
              HasSubstr("loads.csv:2:15"));
  EXPECT_THAT(LoadsRefusal("t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_mm\n0,0,0,0,0,0,1,5\n"),
              HasSubstr("'patch_radius_m'"));
  EXPECT_THAT(LoadsRefusal("t_s,x_m,y_m,z_m,fx_mN,fy_N,fz_N\n0,0,0,0,0,0,1\n"),
              HasSubstr("newtons"));
}

TEST(Loads, RefuseFallingTimeAndTwoLoadsAtOnePoint) {
  EXPECT_THAT(LoadsRefusal(std::string(kHeader) + "1,0,0,0,0,0,1\n0,0,0,0,0,0,1\n"),
              HasSubstr("loads.csv:3:1"));
  EXPECT_THAT(LoadsRefusal(std::string(kHeader) + "1,0,0,0,0,0,1\n1,0,0,0,0,0,2\n"),
              AllOf(HasSubstr("loads.csv:3"), HasSubstr("second load")));
}

}  // namespace
}  // namespace palpate::experiment
