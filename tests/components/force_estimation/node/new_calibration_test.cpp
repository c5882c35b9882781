// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "components/force_estimation/node/node.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/force_estimation/node/scripted_pipeline.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/support/perception_sender.hpp"

/// palpate-force-estimation takes what comes on /calibration without a restart.
namespace palpate::force_estimation {
namespace {

using ::testing::HasSubstr;

constexpr double kTold_m = 0.002;

class NewCalibrationTest : public testing::Test {
 protected:
  NewCalibrationTest()
      : test_("test"),
        perception_(test_),
        calibrations_(test_.participant.CreateWriter(dds::kCalibrationTopic, test_.Waker())),
        forces_(test_.participant.CreateReader(dds::kForcesTopic, test_.Waker())),
        log_(test_.participant.CreateReader(dds::kRosoutTopic, test_.Waker())) {
    test_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) {
        answered_ns_ = dds::StampNs(message.header.stamp);
        status_ = dds::Text(message.status);
        reason_ = dds::Text(message.reason);
      }
    });
    test_.loop.Attach(log_, [this] {
      for (const auto& message : log_.Take()) said_.emplace_back(dds::Text(message.msg));
    });
  }
  ~NewCalibrationTest() override {
    if (!node_) return;
    node_->Stop();
    thread_.join();
  }

  static NodeConfig Config() {
    NodeConfig config;
    config.source = "shape";
    config.camera_pose = "{translation_m: [0, 0, 0.5], rotation_xyzw: [0, 0, 0, 1]}";
    return config;
  }

  /// `in_use`: date of the calibration that was given at the start; empty: none.
  void Start(const NodeConfig& config, const std::string& in_use = {}) {
    robot::CalibrationFile given;
    given.date_utc = in_use;
    node_ = std::make_unique<ForceEstimationNode>(
        config, NodeTestRobot(), given, static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
        dds::NodeLog::ProcessLog(), script_.Maker());
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] {
      return perception_.IsMatched(true) && calibrations_.matched() == 1 &&
             forces_.matched() == 1 && log_.matched() >= 1;
    }));
  }

  struct Sent {
    double z_m = 0.75;
    std::string date_utc = "2026-01-31T12:00:00Z";
    std::string robot = {}, mesh = {}, element = {};  ///< empty: as the node has it
    int depth_bias_width_px = 0;                      ///< of its images; 0: it holds none
    double scale = 1.0;                               ///< of the robot; 1: not said
  };
  void Send(const Sent& sent) {
    const robot::CalibrationFile present = robot::DescribeForCalibration(*robot_);
    dds::Message<idl::palpate_msgs::Calibration> message;
    const auto given_or = [](const std::string& given, const std::string& other) {
      return given.empty() ? other : given;
    };
    dds::SetText(message->robot, given_or(sent.robot, present.robot));
    dds::SetText(message->mesh_hash, given_or(sent.mesh, present.mesh_hash));
    dds::SetText(message->element, given_or(sent.element, present.element));
    dds::SetText(message->material_model, present.model);
    dds::SetText(message->volumetric, present.volumetric);
    message->poissons_ratio = present.poissons_ratio;
    dds::SetText(message->date_utc, sent.date_utc);
    dds::SetText(message->data, "this test");
    message->has_camera = true;
    message->camera_in_robot =
        dds::ToPose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, sent.z_m)));
    message->has_geometry_scale = sent.scale != 1.0;
    message->geometry_scale = sent.scale;
    if (sent.depth_bias_width_px > 0) SetDepthBias(sent.depth_bias_width_px, &*message);
    dds::Resize(message->drives, 1);
    dds::SetText(message->drives._buffer[0].cable, "top");
    message->drives._buffer[0].offset_m = 1e-3;
    dds::Resize(message->moduli, 1);
    dds::SetText(message->moduli._buffer[0].part, "body");
    message->moduli._buffer[0].youngs_modulus_pa = 321e3;
    ASSERT_TRUE(calibrations_.Write(message));
  }

  static geometry::DepthPicture PictureOfWidth(int width_px) {
    return {width_px, 480, 425.0, 425.0, 423.5, 239.5};
  }
  static void SetDepthBias(int width_px, idl::palpate_msgs::Calibration* message) {
    message->has_depth_bias = true;
    auto& bias = message->depth_bias;
    dds::SetPicture(bias.picture, PictureOfWidth(width_px));
    bias.span = 0.25;
    const double coefficient = 1e-3;
    dds::SetNumbers(bias.coefficients, &coefficient, 1);
    const std::vector<double> covariance(49, 0.0);
    dds::SetNumbers(bias.covariance, covariance.data(), covariance.size());
  }

  /// Sends a frame with its cable input and waits for the answer; the frame as the estimator saw it
  /// is the last call of the script.
  void Ask(std::int64_t stamp_ns, int width_px = 0) {
    perception_.SendCable(stamp_ns, kTold_m);
    perception_.Send({.stamp_ns = stamp_ns, .picture = PictureOfWidth(width_px)});
    ASSERT_TRUE(test_.WaitFor([&] { return answered_ns_ == stamp_ns; })) << stamp_ns;
  }
  bool WaitUntilSaid(const std::string& text) {
    return test_.WaitFor([&] {
      return std::any_of(said_.begin(), said_.end(), [&](const std::string& line) {
        return line.find(text) != std::string::npos;
      });
    });
  }
  double LastCameraZ_m() const {
    return script_.calls().back().shape.frame.views[0].T_robot_camera.translation().z();
  }

  Script script_;
  std::unique_ptr<robot::RobotModel> robot_ = NodeTestRobot();
  dds::TestNode test_;
  test_support::PerceptionSender perception_;
  dds::Writer<idl::palpate_msgs::Calibration> calibrations_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::rcl_interfaces::Log> log_;
  std::int64_t answered_ns_ = 0;
  std::string status_, reason_;
  std::vector<std::string> said_;
  std::unique_ptr<ForceEstimationNode> node_;
  std::thread thread_;
};

/// At the start, and when a sequence begins while the robot is at work.
TEST_F(NewCalibrationTest, WhileTheDepthBiasIsLearntTheLogAsksNotToTouchTheRobot) {
  Start(Config());
  std::int64_t stamp_ns = 0;
  for (const int first : {30, 25}) {
    said_.clear();
    script_.SetBiasFramesToCome(first);
    Ask(stamp_ns += 10);
    EXPECT_TRUE(WaitUntilSaid("learning the depth bias from " + std::to_string(first) +
                              " frames: do not touch the robot"));
    script_.SetBiasFramesToCome(1);
    Ask(stamp_ns += 10);
    script_.SetBiasFramesToCome(0);
    Ask(stamp_ns += 10);
    EXPECT_TRUE(WaitUntilSaid("the depth bias is known"));
    EXPECT_EQ(said_.size(), 2u);
  }
}

TEST_F(NewCalibrationTest, HoldsFromTheNextFrameOnWhichBeginsASequence) {
  Start(Config());
  Ask(10);
  EXPECT_EQ(LastCameraZ_m(), 0.5);
  EXPECT_EQ(script_.calls().back().shape.frame.cables.at(0).value, kTold_m);
  EXPECT_EQ(script_.calls().back().youngs_modulus_Pa, 250e3);
  Send({});
  ASSERT_TRUE(WaitUntilSaid("takes the calibration of 2026-01-31"));
  Ask(20);
  const Script::Call call = script_.calls().back();
  EXPECT_EQ(call.shape.frame.views[0].T_robot_camera.translation().z(), 0.75);
  EXPECT_NEAR(call.shape.frame.cables.at(0).value, kTold_m + 1e-3, 1e-15);
  EXPECT_EQ(call.youngs_modulus_Pa, 321e3);
  EXPECT_EQ(call.pipeline, script_.calls().front().pipeline + 1);
  Ask(30);
  EXPECT_EQ(script_.calls().back().pipeline, call.pipeline);
}

TEST_F(NewCalibrationTest, IsRefusedWhereItIsForeignAndThatIsSaid) {
  Start(Config());
  Send({.robot = "another"});
  EXPECT_TRUE(WaitUntilSaid("refused: the calibration is for robot 'another'"));
  Send({.mesh = "another"});
  EXPECT_TRUE(WaitUntilSaid("refused: the calibration is for mesh 'another'"));
  Send({.element = "tet10"});
  EXPECT_TRUE(WaitUntilSaid("refused: the calibration is for element 'tet10'"));
  Send({.scale = 1.02});
  EXPECT_TRUE(WaitUntilSaid("refused: the calibration is for a robot 1.02 times as large"));
  Ask(10);
  EXPECT_EQ(LastCameraZ_m(), 0.5);
  EXPECT_EQ(script_.calls().back().youngs_modulus_Pa, 250e3);
}

TEST_F(NewCalibrationTest, IsRefusedWhereItIsOlderThanTheOneInUse) {
  Start(Config(), "2026-01-31T11:00:00Z");
  Send({.z_m = 0.6, .date_utc = "2026-01-31T10:59:59Z"});
  EXPECT_TRUE(WaitUntilSaid("older than the one in use"));
  Ask(10);
  EXPECT_EQ(LastCameraZ_m(), 0.5);
  Send({.z_m = 0.7, .date_utc = "2026-01-31T11:00:01Z"});
  EXPECT_TRUE(WaitUntilSaid("takes the calibration"));
  Ask(20);
  EXPECT_EQ(LastCameraZ_m(), 0.7);
}

TEST_F(NewCalibrationTest, ItsDepthBiasIsForImagesOfItsCameraOnly) {
  Start(Config());
  Ask(10, 640);
  EXPECT_EQ(status_, "ok");
  Send({.depth_bias_width_px = 848});
  ASSERT_TRUE(WaitUntilSaid("takes the calibration"));
  Ask(20, 640);
  EXPECT_EQ(status_, "invalid_input");
  EXPECT_THAT(reason_, HasSubstr("depth bias is for images {width_px: 848"));
  Ask(30, 848);
  EXPECT_EQ(status_, "ok");
  Send({.date_utc = "2026-02-01T12:00:00Z"});
  ASSERT_TRUE(WaitUntilSaid("takes the calibration of 2026-02-01"));
  Ask(40, 640);
  EXPECT_EQ(status_, "ok");
}

TEST_F(NewCalibrationTest, SaysWhereTheCameraStandsToANodeThatDidNotKnow) {
  NodeConfig config = Config();
  config.camera_pose.clear();
  Start(config);
  Ask(10);
  EXPECT_EQ(status_, "no_calibration");
  EXPECT_THAT(reason_, HasSubstr("where the camera stands is not known"));
  EXPECT_TRUE(script_.calls().empty());
  Send({});
  ASSERT_TRUE(WaitUntilSaid("takes the calibration"));
  Ask(20);
  EXPECT_EQ(status_, "ok");
  EXPECT_EQ(LastCameraZ_m(), 0.75);
}

}  // namespace
}  // namespace palpate::force_estimation
