// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/captured_markers.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

CapturedMarkers Read(const std::string& content) {
  const TestFolder folder;
  return ReadCapturedCsv(folder.Write("mocap.csv", content));
}

TEST(CapturedCsv, ConvertsEachColumnFromItsUnitInAnyOrder) {
  const CapturedMarkers captured = Read(
      "marker,residual_mm,z_mm,y_cm,x_m,time_s\na,0.5,30,2,0.1,0\na,0.4,31,2,0.1,0.02\n"
      "a,0.3,32,2,0.1,0.04\n");
  EXPECT_LT((*captured.tracks.frames[0].positions_m[0] - Eigen::Vector3d(0.1, 0.02, 0.03)).norm(),
            1e-15);
  EXPECT_NEAR(*captured.residuals_m[0][0], 0.5e-3, 1e-15);
  EXPECT_NEAR(captured.rate_Hz, 50.0, 1e-9);
}

TEST(CapturedCsv, TakesANegativeResidualForAGap) {
  const CapturedMarkers captured =
      Read("t_s,marker,x_m,y_m,z_m,residual_m\n0,a,0,0,0,-1\n0,b,1,1,1,\n");
  EXPECT_FALSE(captured.tracks.frames[0].positions_m[0].has_value());
  EXPECT_FALSE(captured.residuals_m[0][0].has_value());
  EXPECT_TRUE(captured.tracks.frames[0].positions_m[1].has_value());
}

TEST(CapturedCsv, RefusesOtherColumns) {
  EXPECT_THAT(MessageOf([] { Read("t_s,marker,x_m,y_m\n0,a,1,2\n"); }), HasSubstr("'z_m'"));
  EXPECT_THAT(MessageOf([] { Read("t_ms,marker,x_m,y_m,z_m\n0,a,1,2,3\n"); }),
              HasSubstr("seconds are expected"));
  EXPECT_THAT(MessageOf([] { Read("t_s,marker,x_in,y_in,z_in\n0,a,1,2,3\n"); }),
              HasSubstr("metres are expected"));
  EXPECT_THAT(MessageOf([] { Read("t_s,marker,x_m,y_m,z_m,x_mm\n0,a,1,2,3,4\n"); }),
              HasSubstr("unknown column 'x_mm'"));
}

}  // namespace
}  // namespace palpate::experiment
