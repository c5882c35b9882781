// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/calibration/node/node.hpp"
#include "components/force_estimation/node/calibration_input.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/support/perception_sender.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::calibration {

inline constexpr auto kCameraFrame = "camera_depth_optical_frame";
inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

using RobotMaker = std::function<std::unique_ptr<robot::RobotModel>()>;

/// Stands in for the fit: remembers its jobs, and does not return while it is held, but where it is
/// stopped and heeds that.
class ScriptedFit {
 public:
  Worker::Fit Fit() {
    return [this](robot::RobotModel& model, const LiveJob& job) { return Answer(model, job); };
  }
  void Hold(bool hold) {
    const std::lock_guard lock(mutex_);
    hold_ = hold;
    changed_.notify_all();
  }
  std::vector<LiveJob> jobs() const {
    const std::lock_guard lock(mutex_);
    return jobs_;
  }
  Status status = Status::Ok();  ///< of what comes of it
  bool heeds_stop = false;

 private:
  LiveResult Answer(robot::RobotModel& model, const LiveJob& job) {
    std::unique_lock lock(mutex_);
    jobs_.push_back(job);
    if (heeds_stop) {
      changed_.wait(lock, job.request.stop, [this] { return !hold_; });
    } else {
      changed_.wait(lock, [this] { return !hold_; });
    }
    LiveResult result;
    result.status = status;
    result.file = robot::DescribeForCalibration(model);
    result.file.date_utc = "2026-01-31T12:00:00Z";
    result.file.data = job.data;
    result.file.data_hash = "sha256-of-it";
    result.file.pose.emplace().T_robot_camera.translation().z() = 0.25;
    return result;
  }

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  bool hold_ = false;
  std::vector<LiveJob> jobs_;
};

/// The node in a thread of its own, and a participant that plays robot, perception and requester.
class CalibrationNodeTest : public testing::Test {
 protected:
  struct Told {
    std::string id, state, status, reason;
    std::uint32_t taken = 0, wanted = 0;
  };

  explicit CalibrationNodeTest(RobotMaker make_robot = force_estimation::NodeTestRobot)
      : make_robot_(std::move(make_robot)),
        test_("test"),
        perception_(test_),
        markers_(test_.participant.CreateWriter(dds::kMarkersTopic, test_.Waker())),
        requests_(test_.participant.CreateWriter(dds::kCalibrationRequestTopic, test_.Waker())),
        statuses_(test_.participant.CreateReader(dds::kCalibrationStatusTopic, test_.Waker())),
        calibrations_(test_.participant.CreateReader(dds::kCalibrationTopic, test_.Waker())) {
    test_.loop.Attach(statuses_, [this] { TakeStatuses(); });
    test_.loop.Attach(calibrations_, [this] {
      for (const auto& message : calibrations_.Take()) {
        EXPECT_TRUE(force_estimation::FromCalibration(message, &found_.emplace_back()).ok());
      }
    });
  }
  ~CalibrationNodeTest() override {
    fit_.Hold(false);
    StopNode();
  }

  void StopNode() {
    if (!node_) return;
    node_->Stop();
    thread_.join();
    node_.reset();
  }

  NodeConfig TestConfig() const {
    NodeConfig config;
    config.calibration_file = (folder_.path() / "calibration.yaml").string();
    config.source = "markers";
    config.frames = 2;
    config.still_s = 0.1;
    config.marker_pictures = 3;
    return config;
  }

  void StartNode(const NodeConfig& config, Worker::Fit fit,
                 const std::vector<dds::FurtherCamera>& cameras = {}) {
    node_ = std::make_unique<CalibrationNode>(
        config, make_robot_(), static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
        dds::NodeLog::ProcessLog(), std::move(fit), cameras);
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] {
      return perception_.IsMatched(false) && markers_.matched() == 1 && requests_.matched() == 1 &&
             statuses_.matched() == 1 && calibrations_.matched() == 1 && !told_.empty();
    }));
  }

  struct Asked {
    std::string id = "one";
    std::string source = {};
    std::uint32_t frames = 0;
    std::vector<std::string> moduli = {};
    std::uint8_t action = 0;
  };
  void Ask(const Asked& asked) {
    dds::Message<idl::palpate_msgs::CalibrationRequest> message;
    dds::SetText(message->id, asked.id);
    dds::SetText(message->source, asked.source);
    message->frame_count = asked.frames;
    message->action = asked.action;
    dds::Resize(message->moduli, asked.moduli.size());
    for (std::size_t k = 0; k < asked.moduli.size(); ++k) {
      dds::SetText(message->moduli._buffer[k], asked.moduli[k]);
    }
    ASSERT_TRUE(requests_.Write(message));
  }
  /// The next status message about the request with this state.
  Told WaitForState(const std::string& id, const std::string& state) {
    Told found;
    EXPECT_TRUE(test_.WaitFor([&] {
      for (; read_ < told_.size(); ++read_) {
        found = told_[read_];
        if (found.id == id && found.state == state) return true;
      }
      return false;
    })) << "no '"
        << state << "' of '" << id << "', but '" << found.state << "': " << found.reason;
    ++read_;
    return found;
  }

  /// The robot's markers with an actuator that counts from kOffset_m, as the camera sees them.
  Eigen::Matrix3Xd MarkersSeen(double told_m) {
    fem::StaticState state = robot_->RestState();
    const auto result = robot_->Solve(
        {{robot::ActuatorCommand::Kind::kDisplacement, told_m + kOffset_m}}, {}, &state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    const auto& markers = robot_->body().markers;
    Eigen::Matrix3Xd seen_m(3, std::ssize(markers));
    for (std::size_t k = 0; k < markers.size(); ++k) {
      seen_m.col(static_cast<Eigen::Index>(k)) =
          TruePose().inverse() * markers[k].point.weights.Position(state.x_m);
    }
    return seen_m;
  }

  /// The cable at rest at `taken_in_m` over 0.2 s before `stamp_ns` and at it.
  void SendRest(std::int64_t stamp_ns, double taken_in_m, const std::string& cable = "top") {
    for (std::int64_t back_ns = 200'000'000; back_ns >= 0; back_ns -= 20'000'000) {
      perception_.SendCable(stamp_ns - back_ns, taken_in_m, cable);
    }
  }
  /// `seen_m` [3 x markers], camera frame; any number of them where they have no names.
  void SendMarkers(std::int64_t stamp_ns, const Eigen::Matrix3Xd& seen_m,
                   const std::string& frame = kCameraFrame) {
    const auto names = robot_->MarkerNames();
    dds::Message<idl::palpate_msgs::MarkerArray3> message;
    dds::SetHeader(message->header, stamp_ns, frame);
    const auto count = static_cast<std::size_t>(seen_m.cols());
    dds::Resize(message->markers, count);
    for (std::size_t k = 0; k < count; ++k) {
      auto& marker = message->markers._buffer[k];
      if (send_names_) dds::SetText(marker.name, names.at(k));
      dds::SetVector(marker.position_m, seen_m.col(static_cast<Eigen::Index>(k)));
      dds::SetVector(marker.sigma_m, Eigen::Vector3d::Constant(marker_sigma_m_));
      marker.valid = true;
    }
    ASSERT_TRUE(markers_.Write(message));
  }
  /// A setting of the cable with enough pictures of the markers for a frame.
  void SendSetting(std::int64_t stamp_ns, double taken_in_m, const Eigen::Matrix3Xd& seen_m) {
    SendRest(stamp_ns, taken_in_m);
    for (std::int64_t k = 3; k > 0; --k) SendMarkers(stamp_ns - k, seen_m);
  }
  void SendCloud(const test_support::SeenFrame& seen) {
    perception_.SendCloud(seen);
    perception_.SendReport(seen);
  }

  void TakeStatuses() {
    for (const auto& message : statuses_.Take()) {
      told_.push_back(
          {std::string(dds::Text(message.request_id)), std::string(dds::Text(message.state)),
           std::string(dds::Text(message.status)), std::string(dds::Text(message.reason)),
           message.frames_taken, message.frames_wanted});
    }
  }

  static Eigen::Isometry3d TruePose() {
    return Eigen::Translation3d(0.3, -0.2, 0.4) *
           Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
  }
  static constexpr double kOffset_m = 4e-4;

  test_support::TestFolder folder_;
  ScriptedFit fit_;
  RobotMaker make_robot_;
  std::unique_ptr<robot::RobotModel> robot_ = make_robot_();
  bool send_names_ = true;        ///< of the markers
  double marker_sigma_m_ = 1e-5;  ///< that they are said to have
  dds::TestNode test_;
  test_support::PerceptionSender perception_;
  dds::Writer<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Writer<idl::palpate_msgs::CalibrationRequest> requests_;
  dds::Reader<idl::palpate_msgs::CalibrationStatus> statuses_;
  dds::Reader<idl::palpate_msgs::Calibration> calibrations_;
  std::vector<Told> told_;
  std::size_t read_ = 0;
  std::vector<robot::CalibrationFile> found_;
  std::unique_ptr<CalibrationNode> node_;
  std::thread thread_;
};

}  // namespace palpate::calibration
