// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/file.hpp"
#include "tests/components/palpate/markers/marked_bar.hpp"

/// `palpate calibrate` from markers.csv without names.
namespace palpate::command {
namespace {

using testing::HasSubstr;

class UnlabelledMarkers : public MarkedBar {
 protected:
  /// Nine of the twelve and two points that are none.
  BarSight NineAndTwo() const {
    return {.markers = {0, 1, 3, 4, 6, 7, 8, 10, 11},
            .names = false,
            .false_m = {T_robot_camera_.inverse() * Eigen::Vector3d(0.05, 0.05, 0.03),
                        T_robot_camera_.inverse() * Eigen::Vector3d(0.01, -0.03, 0.01)}};
  }
};

TEST_F(UnlabelledMarkers, AreToldApartByWhereTheyAreWithMissingAndFalseOnes) {
  RecordThree(NineAndTwo());
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("hold_5: 9 of 12 markers seen, 2 points are none"));
  ExpectPose();
  ASSERT_EQ(Found().drives.size(), 1U);
  EXPECT_NEAR(Found().drives[0].drive.offset_m, kOffset_m,
              4.0 * Found().drives[0].standard_error.offset_m);
  EXPECT_LT(Found().residual_rms_m, 3e-4);
}

TEST_F(UnlabelledMarkers, WrongNamesDoNotCountWhereToldSo) {
  RecordThree({});
  const auto file = folder_ / "data/recordings/hold_5/markers.csv";
  std::string text = ReadFile(file);
  text.replace(text.find(",m3,"), 4, ",m7x");
  text.replace(text.find(",m7,"), 4, ",m3,");
  text.replace(text.find(",m7x"), 4, ",m7,");
  WriteFile(file, text);
  ASSERT_EQ(Calibrate({"--unlabelled"}).exit_code, 0);
  ExpectPose();
  EXPECT_LT(Found().residual_rms_m, 3e-4);
  const double assigned_m = Found().residual_rms_m;
  std::filesystem::remove(folder_ / "calibration.yaml");
  Calibrate();
  if (!HasFile()) return;
  EXPECT_GT(Found().residual_rms_m, 10.0 * assigned_m);
}

TEST_F(UnlabelledMarkers, AreAveragedOverAStillRecordingWhateverTheirOrder) {
  RecordThree({.names = false});
  const auto file = folder_ / "data/recordings/hold_5/markers.csv";
  std::string text = ReadFile(file);
  const std::string head = "t_s,marker,x_m,y_m,z_m\n";
  const std::string first = text.substr(head.size());
  // The same points later, the last one first.
  std::string later;
  for (std::size_t end = first.size(); end > 0;) {
    const std::size_t begin = first.rfind('\n', end - 2);
    const std::size_t from = begin == std::string::npos ? 0 : begin + 1;
    later += "0.6" + first.substr(from + 3, end - from - 3);
    end = from;
  }
  WriteFile(file, head + first + later);
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("hold_5: 12 of 12 markers seen, 0 points are none"));
  ExpectPose();
}

TEST_F(UnlabelledMarkers, APictureShowsWhatWasTakenForWhat) {
  RecordThree(NineAndTwo());
  const auto picture = folder_ / "assignment.svg";
  ASSERT_EQ(Calibrate({"--assignment", picture.string()}).exit_code, 0);
  const std::string svg = ReadFile(picture);
  const auto count = [&](const std::string& text) {
    int found = 0;
    for (std::size_t at = 0; (at = svg.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("class=\"panel\""), 3);
  EXPECT_EQ(count(" not seen<"), 9 + 1) << "notes and legend";
  EXPECT_EQ(count(">no marker<"), 6);
  EXPECT_EQ(count(" mm</text>"), 27 + 3) << "residuals and scales";
  EXPECT_THAT(svg, HasSubstr(">m10 0."));
  EXPECT_THAT(svg, HasSubstr("holds it with 95 %"));
  const ProgramRun full = Calibrate({"--assignment", "/dev/full"});
  EXPECT_EQ(full.exit_code, 1) << full.output;
}

TEST_F(UnlabelledMarkers, MirroredOnesAreRefused) {
  RecordThree({.names = false, .spoil = [](const Eigen::Vector3d& p) {
                 return Eigen::Vector3d(-p.x(), p.y(), p.z());
               }});
  ExpectFailure(Calibrate(), "or mirrored points");
}

TEST_F(UnlabelledMarkers, OfAnotherRobotAreRefused) {
  RecordThree({.names = false});
  std::vector<Eigen::Vector3d> others_m = Twelve();
  for (std::size_t m = 0; m < others_m.size(); ++m) {
    others_m[m].x() = 0.08 - 0.9 * others_m[m].x() * (m % 2 == 0 ? 1.0 : 0.6);
  }
  robot_ = WriteRobot(others_m, "other.yaml");
  ExpectFailure(Calibrate(), "another robot");
}

TEST_F(UnlabelledMarkers, TooFewAreRefused) {
  RecordThree({.markers = {0, 3, 6, 9}, .names = false});
  ExpectFailure(Calibrate(), "an assignment needs 5 points, there are 4");
}

TEST_F(UnlabelledMarkers, OnOneLineAreRefused) {
  RecordThree({.names = false,
               .spoil = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), 0.3, 0.5); }});
  ExpectFailure(Calibrate(), "no pose and tensions match 5 of the points with markers");
}

TEST_F(UnlabelledMarkers, NeedACamerasFrame) {
  RecordThree({.names = false});
  folder_.Write("data/experiment.yaml", "frame: robot\nmarkers_sigma_m: 1.0e-4\n");
  const ProgramRun run = Calibrate({"--what", "joint"});
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_THAT(run.output, HasSubstr("need names"));
}

}  // namespace
}  // namespace palpate::command
