// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

#include "components/perception/node/camera_pose.hpp"
#include "components/perception/node/camera_streams.hpp"
#include "components/perception/node/node_config.hpp"
#include "components/perception/node/outputs.hpp"
#include "components/perception/node/prediction_history.hpp"
#include "components/perception/node/worker.hpp"
#include "libs/core/lateness.hpp"
#include "libs/core/repetition_check.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::perception {

/// Takes the camera's frames and the model's last state, publishes the clouds of robot and objects
/// and the contacts. Each frame that was taken is answered, on /perception/report at least; while
/// one is in work only the newest of the others waits.
class PerceptionNode {
 public:
  /// `T_robot_camera`: of the depth camera; nullopt: unknown. Throws InputError for bad settings,
  /// RunError where DDS refuses.
  PerceptionNode(const NodeConfig& config, std::optional<Eigen::Isometry3d> T_robot_camera,
                 FramePerceptionMaker maker, int domain_id, dds::TopicTable table,
                 dds::NodeLog::ProcessLog process_log);

  /// Works until Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using Clock = dds::WaitSet::Clock;

  std::unique_ptr<CameraStreams> MakeStreams();
  void AttachReaders();
  void ExpectInputs();
  void TakeMesh();
  void TakeCalibration();
  void AdoptCalibration();
  void SendPose();
  void TakeMeshStates();
  void Advance();
  void WorkOnNext();
  void SetAlarm();
  bool BeginsSequence(const FrameSet& set) const;
  Clock::time_point PredictionOverdue() const;
  bool MustAwaitPrediction() const;
  void Work(FrameSet set);
  Status CheckIsNew(const FrameSet& set);
  Status FollowFrames();
  PerceptionJob HeadOf(const FrameSet& set) const;
  PerceptionJob MakeJob(FrameSet& set, const rgbd::RgbdCamera& camera);
  void PublishResults();
  void Publish(const FrameOutcome& outcome, Clock::time_point taken);
  void ReportHealth();
  bool IsSilent() const;
  Status CurrentStatus();

  NodeConfig config_;
  CameraPose pose_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Alarm& overdue_;  ///< the next part or prediction that is waited for no longer
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Reader<idl::palpate_msgs::Mesh> meshes_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::Calibration> calibrations_;
  Outputs outputs_;
  dds::TransformBroadcaster transforms_;
  std::unique_ptr<CameraStreams> streams_;
  PredictionHistory predictions_;
  Worker worker_;
  std::optional<FrameSet> next_;               ///< waits for the worker or the prediction
  std::optional<rgbd::RgbdCamera> set_;        ///< the camera that perception knows
  std::uint64_t set_setups_ = 0;               ///< of streams_, when it was set
  std::optional<double> sigma_px_;             ///< of the disparity, that perception knows
  std::optional<std::int64_t> last_stamp_ns_;  ///< given to perception; none: none yet
  std::uint32_t last_epoch_ = 0;
  std::string last_device_;
  Clock::time_point published_at_;
  Status last_state_ = Status::Ok();  ///< of the last message on /robot/mesh_state
  RepetitionCheck repetition_;        ///< of depth images
  Lateness lateness_;                 ///< of frames
  dds::HealthCounts counts_;
  Status last_status_{StatusCode::kNotRun, "no images on /camera/depth/image_raw yet"};
  dds::InputMonitor inputs_;
};

}  // namespace palpate::perception
