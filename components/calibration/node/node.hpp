// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/live/frame_collector.hpp"
#include "components/calibration/node/cloud_source.hpp"
#include "components/calibration/node/convert.hpp"
#include "components/calibration/node/node_config.hpp"
#include "components/calibration/node/worker.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::calibration {

/// On a /calibration/request, collects frames of the running robot, calibrates, and publishes the
/// result on /calibration (latched). Every request is answered on /calibration/status, and one at a
/// time is processed.
class CalibrationNode {
 public:
  /// `fit`: runs a job. `cameras`: those beside the first, with their approximate poses where these
  /// are known. Publishes the last calibration where its file exists. Throws InputError for
  /// bad settings and for a file of another robot, RunError where DDS fails.
  CalibrationNode(const NodeConfig& config, std::unique_ptr<robot::RobotModel> model, int domain_id,
                  dds::TopicTable table, dds::NodeLog::ProcessLog process_log,
                  Worker::Fit fit = CalibrateLive,
                  const std::vector<dds::FurtherCamera>& cameras = {});

  /// Runs until Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using Clock = dds::WaitSet::Clock;

  void ReadLastCalibration();
  void TakePosesOf(const robot::CalibrationFile& file);
  void ExpectInputs();
  CloudEvents EventsOfClouds();
  void TakeRequests();
  void TakeJointStates();
  void TakeMarkers();
  Request Defaults() const;
  Status Check(const Request& request) const;
  void Begin(const Request& request);
  void Cancel(const Request& request);
  void Refuse(const Request& request, const Status& status);
  void Obstruct(const Status& status, std::string* obstacle);
  bool Collects(const char* source) const;
  bool IsGoing() const;
  void Advance();
  LiveJob MakeJob() const;
  std::vector<FurtherCameraJob> FurtherJobs() const;
  void TakeResult();
  void Adopt(const LiveResult& result);
  void Publish(const robot::CalibrationFile& file, const Eigen::Matrix<double, 6, 6>& covariance);
  void End(const std::string& state, const Status& status, const std::string& reason = {});
  void Tick();
  void SendProgress();
  void ReportHealth();

  NodeConfig config_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  Worker worker_;
  std::vector<std::string> marker_names_;
  std::vector<std::string> cable_names_;
  std::vector<std::string> part_names_;
  FrameCollector collector_;
  dds::Reader<idl::palpate_msgs::CalibrationRequest> requests_;
  dds::Reader<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Writer<idl::palpate_msgs::Calibration> calibration_;
  dds::Writer<idl::palpate_msgs::CalibrationStatus> status_;
  std::vector<dds::FurtherCamera> cameras_;  ///< beside the first, with their initial poses
  CloudSource clouds_;
  std::optional<robot::CalibrationFile> last_;              ///< estimated or read
  std::optional<geometry::RigidTransform> T_robot_camera_;  ///< initial pose
  Request request_;                                         ///< the last accepted one
  Progress progress_;
  std::string obstacle_;        ///< why the last cloud or markers were refused; empty: accepted
  std::string cable_obstacle_;  ///< the same of the cable inputs
  bool drop_result_ = false;    ///< of a cancelled request
  Clock::time_point last_step_;
  std::string sent_reason_;
  dds::HealthCounts counts_;
  dds::InputMonitor inputs_;
};

}  // namespace palpate::calibration
