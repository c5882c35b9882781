// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/markers.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "libs/experiment/recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

MarkerTracks Parse(const std::string& rows) {
  const TestFolder folder;
  return ReadMarkers(folder.Write("markers.csv", "t_s,marker,x_m,y_m,z_m\n" + rows));
}

std::string RefusalOf(const std::string& content) {
  const TestFolder folder;
  const auto file = folder.Write("markers.csv", content);
  return MessageOf([&] { ReadMarkers(file); });
}

std::string RefusalOfRows(const std::string& rows) {
  return RefusalOf("t_s,marker,x_m,y_m,z_m\n" + rows);
}

TEST(Markers, GroupsRowsOfEqualTimeToFramesInTheOrderOfNames) {
  const MarkerTracks tracks = Parse("0,a,1,2,3\n0,b,4,5,6\n0.5,b,7,8,9\n0.5,c,1,1,1\n");
  EXPECT_THAT(tracks.names, ElementsAre("a", "b", "c"));
  ASSERT_EQ(tracks.frames.size(), 2u);
  EXPECT_EQ(tracks.frames[1].t_s, 0.5);
  EXPECT_EQ(tracks.frames[1].line, 4);
  ASSERT_EQ(tracks.frames[0].positions_m.size(), 3u);
  ASSERT_EQ(tracks.frames[1].positions_m.size(), 3u);
  EXPECT_EQ(tracks.frames[0].positions_m[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(tracks.frames[1].positions_m[1], Eigen::Vector3d(7, 8, 9));
  EXPECT_FALSE(tracks.frames[0].positions_m[2].has_value());
  EXPECT_FALSE(tracks.frames[1].positions_m[0].has_value());
  EXPECT_EQ(tracks.IndexOf("c"), 2u);
  EXPECT_EQ(tracks.IndexOf("d"), std::nullopt);
}

TEST(Markers, AnEmptyFieldIsAMissingMarkerAndNeverTheOrigin) {
  const MarkerTracks tracks = Parse("0,a,,,\n0,b,1,1,1\n");
  EXPECT_FALSE(tracks.frames[0].positions_m[0].has_value());
  EXPECT_THAT(RefusalOfRows("0,a,1,,1\n"), AllOf(HasSubstr(":2:3"), HasSubstr("three")));
}

TEST(Markers, PointsWithoutANameAreNumberedAnewAtEachTime) {
  const MarkerTracks tracks = Parse("0,,1,2,3\n0,b,4,5,6\n0,,7,8,9\n0.5,,1,1,1\n0.5,b,2,2,2\n");
  EXPECT_THAT(tracks.names, ElementsAre("unlabelled_1", "b", "unlabelled_2"));
  EXPECT_TRUE(IsUnlabelled(tracks.names[2]));
  EXPECT_FALSE(IsUnlabelled("b"));
  EXPECT_EQ(*tracks.frames[0].positions_m[2], Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(*tracks.frames[1].positions_m[0], Eigen::Vector3d(1, 1, 1));
  EXPECT_FALSE(tracks.frames[1].positions_m[2]);
  Recording recording;
  recording.markers = tracks;
  EXPECT_NO_THROW(CheckMarkers(recording, {"b"}));
  EXPECT_THAT(MessageOf([&] { CheckMarkers(recording, {"c"}); }), HasSubstr("marker 'b'"));
}

TEST(Markers, ReadBackExactlyWhatTheyWrote) {
  const TestFolder folder;
  const MarkerTracks first = Parse("0.1,a,0.1,1e-17,-3\n0.1,b,,,\n0.3,b,1,2,0.30000000000000004\n");
  WriteMarkers(first, folder.path() / "m.csv");
  const MarkerTracks second = ReadMarkers(folder.path() / "m.csv");
  EXPECT_EQ(second.names, first.names);
  ASSERT_EQ(second.frames.size(), first.frames.size());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    EXPECT_EQ(second.frames[i].t_s, first.frames[i].t_s);
    EXPECT_EQ(second.frames[i].positions_m, first.frames[i].positions_m);
  }
}

TEST(Markers, RefuseNamesThatACsvFileCannotHold) {
  const TestFolder folder;
  MarkerTracks tracks = Parse("0,a,1,2,3\n");
  tracks.names[0] = "a,b";
  EXPECT_THAT(MessageOf([&] { WriteMarkers(tracks, folder.path() / "m.csv"); }),
              HasSubstr("'a,b'"));
}

TEST(Markers, SayWhenTheyCannotBeWritten) {
  const MarkerTracks tracks = Parse("0,a,1,2,3\n");
  EXPECT_THAT(MessageOf<RunError>([&] { WriteMarkers(tracks, "/dev/full"); }),
              HasSubstr("/dev/full"));
  EXPECT_THAT(MessageOf<RunError>([&] { WriteMarkers(tracks, "/nowhere/m.csv"); }),
              HasSubstr("/nowhere/m.csv"));
}

TEST(Markers, RefuseBadTimeWithFileAndLine) {
  EXPECT_THAT(RefusalOfRows("1,a,1,2,3\n0.5,a,1,2,3\n"),
              AllOf(HasSubstr("markers.csv:3:1"), HasSubstr("time must rise")));
  EXPECT_THAT(RefusalOfRows("1,a,1,2,3\n1,b,1,2,3\n1,a,1,2,3\n"),
              AllOf(HasSubstr("markers.csv:4:3"), HasSubstr("second sample of this marker")));
}

TEST(Markers, RefuseNaNAndTextAndWrongUnits) {
  EXPECT_THAT(RefusalOfRows("0,a,1,NaN,3\n"),
              AllOf(HasSubstr("markers.csv:2:3"), HasSubstr("three coordinates, or none")));
  EXPECT_THAT(RefusalOfRows("0,a,1,2,three\n"), HasSubstr("z_m 'three'"));
  EXPECT_THAT(RefusalOfRows("0,a,1,2,97.5\n"), HasSubstr("another unit"));
  EXPECT_THAT(
      RefusalOf("t_s,marker,x_mm,y_mm,z_mm\n0,a,1,2,3\n"),
      AllOf(HasSubstr("markers.csv:1:12"), HasSubstr("metres are expected"), HasSubstr("'x_m'")));
  EXPECT_THAT(RefusalOf("t_s,marker,x_m,y_m,z_m,colour\n0,a,1,2,3,red\n"),
              AllOf(HasSubstr(":1:24"), HasSubstr("unknown column 'colour'")));
  EXPECT_THAT(RefusalOf("t_s,markers,x_m,y_m,z_m\n0,a,1,2,3\n"), HasSubstr("'marker' is missing"));
  EXPECT_THAT(RefusalOf("t_s,marker,x_m,y_m,z_m\n"), HasSubstr("no row"));
}

TEST(Markers, MapIntoAnotherFrameKeepingGaps) {
  const MarkerTracks tracks = Parse("0,a,1,0,0\n0,b,,,\n");
  const Eigen::Isometry3d T_robot_camera =
      Eigen::Translation3d(0.0, 0.0, 5.0) *
      Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ());
  const MarkerTracks mapped = Transformed(tracks, T_robot_camera);
  EXPECT_NEAR((*mapped.frames[0].positions_m[0] - Eigen::Vector3d(0, 1, 5)).norm(), 0.0, 1e-15);
  EXPECT_FALSE(mapped.frames[0].positions_m[1].has_value());
}

TEST(Markers, MeanAndDeviationLeaveOutDriftAndFramesOutsideTheWindow) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1e-5);
  MarkerTracks tracks;
  tracks.names = {"a", "b"};
  for (int i = 0; i < 4000; ++i) {
    const double t_s = 0.01 * i;
    const double step_m = t_s < 10.0 ? 0.5 : 0.0;
    MarkerFrame frame;
    frame.t_s = t_s;
    frame.positions_m = {
        Eigen::Vector3d(step_m + 1e-3 * (t_s - 25.0) + noise(random), noise(random), 0.2),
        std::nullopt};
    tracks.frames.push_back(frame);
  }
  const std::vector<MarkerMean> means = MeanOver(tracks, {10.0, 40.0});
  EXPECT_EQ(means[0].count, 3000);
  EXPECT_NEAR(means[0].mean_m.x(), 0.0, 1e-5);
  EXPECT_NEAR(means[0].mean_m.z(), 0.2, 1e-15);
  EXPECT_NEAR(means[0].deviation_m.x(), 1e-5, 5e-7);
  EXPECT_NEAR(means[0].deviation_m.y(), 1e-5, 5e-7);
  EXPECT_NEAR(means[0].deviation_m.z(), 0.0, 1e-12);
  EXPECT_EQ(means[1].count, 0);
}

}  // namespace
}  // namespace palpate::experiment
