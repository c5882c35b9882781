// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "tests/components/calibration/node/node_fixture.hpp"

namespace palpate::calibration {
namespace {

using ::testing::HasSubstr;
constexpr auto kPose = "{translation_m: [0, 0, 0.5], rotation_xyzw: [1, 0, 0, 0]}";

/// Anything; the fit is scripted.
Eigen::Matrix3Xd SomeMarkers() { return Eigen::Matrix3Xd::Identity(3, 3); }

TEST_F(CalibrationNodeTest, FindsPoseAndActuatorWritesThemAndKeepsThemForLateJoiners) {
  StartNode(TestConfig(), CalibrateLive);
  Ask({.id = "first", .frames = 3});
  EXPECT_EQ(WaitForState("first", "collecting").wanted, 3u);
  for (int k = 0; k < 3; ++k) {
    SendSetting((k + 1) * kSecond_ns, 2e-3 * k, MarkersSeen(2e-3 * k));
  }
  EXPECT_EQ(WaitForState("first", "computing").taken, 3u);
  const Told done = WaitForState("first", "done");
  EXPECT_EQ(done.status, "ok");
  EXPECT_EQ(done.reason, "");
  ASSERT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
  const robot::CalibrationFile& found = found_.back();
  ASSERT_TRUE(found.pose);
  EXPECT_TRUE(found.pose->T_robot_camera.isApprox(TruePose(), 1e-5));
  EXPECT_GT(found.pose->translation_error_m.minCoeff(), 0.0);
  ASSERT_EQ(found.drives.size(), 1u);
  EXPECT_NEAR(found.drives[0].drive.offset_m, kOffset_m, 1e-6);
  EXPECT_TRUE(robot::CheckCalibration(found, *robot_).ok());
  const auto file = robot::ReadCalibrationFile(folder_.path() / "calibration.yaml", app::LoadYaml);
  EXPECT_EQ(file.data_hash, found.data_hash);
  EXPECT_TRUE(file.pose->T_robot_camera.isApprox(found.pose->T_robot_camera, 1e-12));
  EXPECT_TRUE(file.pose->rotation_error_rad.isApprox(found.pose->rotation_error_rad, 1e-9));
  dds::TestNode late("late");
  auto reader = late.participant.CreateReader(dds::kCalibrationTopic, late.Waker());
  std::string hash;
  late.loop.Attach(reader, [&] {
    for (const auto& message : reader.Take()) hash = dds::Text(message.data_hash);
  });
  EXPECT_TRUE(late.WaitFor([&] { return hash == found.data_hash; }));
}

TEST_F(CalibrationNodeTest, AnotherRobotsMarkersAreNoCalibration) {
  StartNode(TestConfig(), CalibrateLive);
  Ask({});
  WaitForState("one", "collecting");
  for (int k = 0; k < 2; ++k) {
    Eigen::Matrix3Xd seen_m = MarkersSeen(2e-3 * k);
    const Eigen::Vector3d first_m = seen_m.col(0);
    constexpr double kBigger = 1.3;  // that robot
    seen_m = (kBigger * (seen_m.colwise() - first_m)).colwise() + first_m;
    SendSetting((k + 1) * kSecond_ns, 2e-3 * k, seen_m);
  }
  const Told failed = WaitForState("one", "failed");
  EXPECT_EQ(failed.status, "invalid_input");
  EXPECT_THAT(failed.reason, HasSubstr("the sizes disagree: markers are "));
  EXPECT_TRUE(found_.empty());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "calibration.yaml"));
}

TEST_F(CalibrationNodeTest, TakesEachSettingOnceAndOnlyAtRest) {
  StartNode(TestConfig(), fit_.Fit());
  Ask({});
  WaitForState("one", "collecting");
  SendSetting(1 * kSecond_ns, 1e-3, SomeMarkers());
  EXPECT_EQ(WaitForState("one", "collecting").taken, 1u);
  SendSetting(2 * kSecond_ns, 1e-3, SomeMarkers());  // the same setting
  Told told;
  do {
    told = WaitForState("one", "collecting");
  } while (told.reason.find("this setting was taken") == std::string::npos && !HasFailure());
  EXPECT_EQ(told.taken, 1u);
  SendRest(3 * kSecond_ns, 1e-3);
  SendRest(3 * kSecond_ns + 220'000'000, 5e-3);  // not for long enough before these markers
  SendMarkers(3 * kSecond_ns + 40'000'000, SomeMarkers());
  do {
    told = WaitForState("one", "collecting");
  } while (told.reason.find("must rest") == std::string::npos && !HasFailure());
  EXPECT_EQ(told.taken, 1u);
  SendSetting(4 * kSecond_ns, 5e-3, SomeMarkers());
  WaitForState("one", "done");
  const LiveJob job = fit_.jobs().at(0);
  ASSERT_EQ(job.markers.size(), 2u);
  EXPECT_NEAR(job.markers[0].cables.at(0).value, 1e-3, 1e-15);
  EXPECT_NEAR(job.markers[1].cables.at(0).value, 5e-3, 1e-15);
}

TEST_F(CalibrationNodeTest, TakesCloudsOfTheUntouchedRobotAndStartsFromThePoseThatIsSet) {
  NodeConfig config = TestConfig();
  config.camera_pose = kPose;
  StartNode(config, fit_.Fit());
  Ask({.source = "clouds"});
  WaitForState("one", "collecting");
  SendRest(1 * kSecond_ns, 1e-3);
  SendCloud({.stamp_ns = 1 * kSecond_ns, .points = 3, .contacts = 1});
  Told told;
  do {
    told = WaitForState("one", "collecting");
  } while (told.reason != "perception detects a contact" && !HasFailure());
  SendCloud({.stamp_ns = 1 * kSecond_ns - 1, .points = 4, .status = "no_robot_seen"});
  do {
    told = WaitForState("one", "collecting");
  } while (told.reason.find("perception reports") == std::string::npos && !HasFailure());
  EXPECT_EQ(told.taken, 0u);
  SendCloud({.stamp_ns = 1 * kSecond_ns - 2, .points = 5});
  EXPECT_EQ(WaitForState("one", "collecting").taken, 1u);
  SendRest(2 * kSecond_ns, 3e-3);
  SendCloud({.stamp_ns = 2 * kSecond_ns, .points = 6});
  WaitForState("one", "done");
  const LiveJob job = fit_.jobs().at(0);
  ASSERT_EQ(job.clouds.size(), 2u);
  EXPECT_EQ(job.clouds[0].cloud.Count(), 5);
  EXPECT_EQ(job.clouds[1].cloud.Count(), 6);
  EXPECT_NEAR(job.clouds[1].cables.at(0).value, 3e-3, 1e-15);
  ASSERT_TRUE(job.T_robot_camera_start);
  EXPECT_EQ(job.T_robot_camera_start->translation_m().z(), 0.5);
  // The next search starts from what was found.
  Ask({.id = "two", .source = "clouds", .frames = 1});
  WaitForState("two", "collecting");
  SendRest(3 * kSecond_ns, 1e-3);
  SendCloud({.stamp_ns = 3 * kSecond_ns});
  WaitForState("two", "done");
  EXPECT_EQ(fit_.jobs().at(1).T_robot_camera_start->translation_m().z(), 0.25);
}

TEST_F(CalibrationNodeTest, FailsWhereTheCameraIsAnotherOneHalfWay) {
  NodeConfig config = TestConfig();
  config.camera_pose = kPose;
  StartNode(config, fit_.Fit());
  Ask({.source = "clouds"});
  SendRest(1 * kSecond_ns, 1e-3);
  WaitForState("one", "collecting");
  SendCloud({.stamp_ns = 1 * kSecond_ns});
  EXPECT_EQ(WaitForState("one", "collecting").taken, 1u);
  SendCloud({.stamp_ns = 1 * kSecond_ns + 1, .device = "Palpate-2"});
  EXPECT_THAT(WaitForState("one", "failed").reason, HasSubstr("'Palpate-2'"));
}

TEST_F(CalibrationNodeTest, RefusesRequestsThatCannotBeServedWithTheReason) {
  StartNode(TestConfig(), fit_.Fit());
  Ask({.id = "a", .moduli = {"bodi"}});
  EXPECT_THAT(WaitForState("a", "refused").reason, HasSubstr("did you mean 'body'"));
  Ask({.id = "b", .source = "clouds"});
  const Told clouds = WaitForState("b", "refused");
  EXPECT_EQ(clouds.status, "no_calibration");
  EXPECT_THAT(clouds.reason, HasSubstr("set camera_pose"));
  Ask({.id = "c", .source = "cloud"});
  EXPECT_THAT(WaitForState("c", "refused").reason, HasSubstr("did you mean 'clouds'"));
  Ask({.id = "d", .frames = 101});
  EXPECT_THAT(WaitForState("d", "refused").reason, HasSubstr("frame_count 101"));
  Ask({.id = "e", .action = 7});
  EXPECT_THAT(WaitForState("e", "refused").reason, HasSubstr("unknown action 7"));
  Ask({.id = "f", .action = 1});
  EXPECT_THAT(WaitForState("f", "refused").reason, HasSubstr("no such request"));
  EXPECT_TRUE(fit_.jobs().empty());
}

TEST_F(CalibrationNodeTest, WorksOnOneRequestAtATimeWhichStaysTheLastWord) {
  StartNode(TestConfig(), fit_.Fit());
  Ask({});
  WaitForState("one", "collecting");
  Ask({.id = "two"});
  EXPECT_THAT(WaitForState("two", "refused").reason, HasSubstr("request 'one'"));
  WaitForState("one", "collecting");
  SendSetting(1 * kSecond_ns, 1e-3, SomeMarkers());
  SendSetting(2 * kSecond_ns, 3e-3, SomeMarkers());
  WaitForState("one", "done");
}

/// A fit that does not end by itself.
class HeldFit : public CalibrationNodeTest {
 protected:
  /// Two settings from this time on, of a request that is taken.
  void Compute(const std::string& id, std::int64_t first_ns) {
    SendSetting(first_ns, 1e-3, SomeMarkers());
    SendSetting(first_ns + kSecond_ns, 3e-3, SomeMarkers());
    WaitForState(id, "computing");
  }
  void BeginAndCancel() {
    StartNode(TestConfig(), fit_.Fit());
    fit_.Hold(true);
    Ask({});
    WaitForState("one", "collecting");
    Compute("one", kSecond_ns);
    Ask({.action = 1});
    WaitForState("one", "cancelled");
  }
  /// Until the fit before has ended.
  void AskUntilTaken(const std::string& id) {
    Told told;
    do {
      Ask({.id = id});
      EXPECT_TRUE(test_.WaitFor([&] { return read_ < told_.size(); }));
      told = told_[read_++];
    } while (told.state == "refused" && !HasFailure());
    EXPECT_EQ(told.id, id);
    EXPECT_EQ(told.state, "collecting");
  }
};

TEST_F(HeldFit, WhatIsCancelledIsNotPublishedAndTheNextRequestIsServed) {
  BeginAndCancel();
  Ask({.id = "two"});
  EXPECT_THAT(WaitForState("two", "refused").reason, HasSubstr("has not ended"));
  fit_.Hold(false);
  AskUntilTaken("three");
  Ask({.id = "three", .action = 1});
  WaitForState("three", "cancelled");
  EXPECT_TRUE(found_.empty());
}

TEST_F(HeldFit, IsNotWaitedForWhereNobodyWantsItAnyMore) {
  fit_.heeds_stop = true;
  BeginAndCancel();
  AskUntilTaken("two");  // though the first one is held
  Compute("two", 3 * kSecond_ns);
  StopNode();
  EXPECT_TRUE(found_.empty());
}

TEST_F(CalibrationNodeTest, GivesUpAndSaysWhatDidNotCome) {
  NodeConfig config = TestConfig();
  config.patience_s = 0.3;
  StartNode(config, fit_.Fit());
  Ask({});
  Told told = WaitForState("one", "failed");
  EXPECT_EQ(told.status, "stale");
  EXPECT_THAT(told.reason, HasSubstr("no cloud or markers of the robot yet"));
  Ask({.id = "two"});
  WaitForState("two", "collecting");
  SendMarkers(kSecond_ns, SomeMarkers(), "robot");
  EXPECT_THAT(WaitForState("two", "failed").reason, HasSubstr("frame_id is 'robot'"));
  Ask({.id = "three"});
  WaitForState("three", "collecting");
  SendRest(2 * kSecond_ns, 1e-3, "topp");
  EXPECT_THAT(WaitForState("three", "failed").reason, HasSubstr("did you mean 'top'"));
}

TEST_F(CalibrationNodeTest, PassesOnWhyTheFitFailedAndKeepsTheLastCalibration) {
  fit_.status = {StatusCode::kUnobservable, "the data do not determine the camera's pose"};
  StartNode(TestConfig(), fit_.Fit());
  Ask({});
  WaitForState("one", "collecting");
  SendSetting(1 * kSecond_ns, 1e-3, SomeMarkers());
  SendSetting(2 * kSecond_ns, 3e-3, SomeMarkers());
  const Told told = WaitForState("one", "failed");
  EXPECT_EQ(told.status, "unobservable");
  EXPECT_THAT(told.reason, HasSubstr("do not determine"));
  EXPECT_TRUE(found_.empty());
}

TEST_F(CalibrationNodeTest, PublishesTheFileThatIsThereAndKeepsItsModuli) {
  robot::CalibrationFile before = robot::DescribeForCalibration(*robot_);
  before.date_utc = "2026-01-30T12:00:00Z";
  before.data = "a recording";
  before.data_hash = "sha256-of-it";
  before.moduli = {{"body", 123e3, 4e3}};
  robot::WriteCalibrationFile(before, folder_.path() / "calibration.yaml");
  StartNode(TestConfig(), CalibrateLive);
  ASSERT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
  EXPECT_EQ(found_.back().moduli.at(0).youngs_modulus_Pa, 123e3);
  robot_->SetYoungsModulus(0, 123e3);
  Ask({});
  WaitForState("one", "collecting");
  for (int k = 0; k < 2; ++k) {
    SendSetting((k + 1) * kSecond_ns, 3e-3 * k, MarkersSeen(3e-3 * k));
  }
  WaitForState("one", "done");
  ASSERT_TRUE(test_.WaitFor([&] { return found_.size() == 2; }));
  EXPECT_EQ(found_.back().moduli.at(0).youngs_modulus_Pa, 123e3);
  EXPECT_EQ(found_.back().moduli.at(0).standard_error_Pa, 4e3);
  EXPECT_LT(found_.back().residual_rms_m, 1e-6);
}

TEST_F(CalibrationNodeTest, AFileOfAnotherMeshStopsTheStart) {
  robot::CalibrationFile foreign = robot::DescribeForCalibration(*robot_);
  foreign.mesh_hash = "another";
  foreign.date_utc = foreign.data = foreign.data_hash = "some";
  foreign.moduli = {{"body", 123e3, 4e3}};
  robot::WriteCalibrationFile(foreign, folder_.path() / "calibration.yaml");
  EXPECT_THROW(
      CalibrationNode(TestConfig(), force_estimation::NodeTestRobot(),
                      static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {}, fit_.Fit()),
      InputError);
}

TEST_F(CalibrationNodeTest, SaysWhereTheFileCannotBeWrittenAndPublishesAllTheSame) {
  NodeConfig config = TestConfig();
  config.calibration_file = (folder_.path() / "missing/calibration.yaml").string();
  config.at_start = true;
  StartNode(config, fit_.Fit());
  SendSetting(1 * kSecond_ns, 1e-3, SomeMarkers());
  SendSetting(2 * kSecond_ns, 3e-3, SomeMarkers());
  EXPECT_THAT(WaitForState("", "done").reason, HasSubstr("not written"));
  EXPECT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
}

}  // namespace
}  // namespace palpate::calibration
