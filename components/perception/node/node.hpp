// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/node/camera_clocks.hpp"
#include "components/perception/node/camera_feed.hpp"
#include "components/perception/node/camera_pose.hpp"
#include "components/perception/node/frame_joining.hpp"
#include "components/perception/node/node_config.hpp"
#include "components/perception/node/outputs.hpp"
#include "components/perception/node/prediction_history.hpp"
#include "components/perception/node/worker.hpp"
#include "libs/core/lateness.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::perception {

/// Takes the frames of one or more cameras and the model's last state, publishes the clouds of
/// robot and objects and the contacts. Each frame that was taken is answered, on /perception/report
/// at least; while one is in work only the newest of the others waits.
class PerceptionNode {
 public:
  /// `T_robot_camera`: of the depth camera; nullopt: unknown. `cameras`: those beside it, each with
  /// its pose. `origin`: where poses are of a calibration file. Throws InputError for bad settings,
  /// RunError where DDS refuses.
  PerceptionNode(const NodeConfig& config, std::optional<Eigen::Isometry3d> T_robot_camera,
                 FramePerceptionMaker maker, int domain_id, dds::TopicTable table,
                 dds::NodeLog::ProcessLog process_log,
                 const std::vector<dds::FurtherCamera>& cameras = {},
                 const PoseOrigin& origin = {});

  /// Works until Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using Clock = dds::WaitSet::Clock;

  std::vector<CameraFeed> MakeFeeds(const std::vector<dds::FurtherCamera>& cameras);
  void AttachReaders();
  void ExpectInputs();
  void TakeMesh();
  void TakeCalibration();
  void AdoptCalibration();
  void SendPose();
  void TakeMeshStates();
  void Advance();
  bool MapToFirst(std::size_t camera, FrameSet* set);
  void HearClock(std::size_t camera);
  void WorkOnNext();
  void SetAlarm();
  bool BeginsSequence(const JointSet& set) const;
  Clock::time_point PredictionOverdue() const;
  bool MustAwaitPrediction() const;
  void Work(JointSet set);
  Status Examine(std::size_t camera, FrameSet& set, bool begins, rgbd::RgbdCamera* known);
  void NoteLateness(const FrameSet& set);
  Status FollowFrames();
  PerceptionJob MakeJob(JointSet& set);
  void Predict(std::int64_t stamp_ns, PerceptionJob* job) const;
  void Begin();
  void Finish(const JointSet& set, const PerceptionJob& job);
  void Refuse(PerceptionJob job);
  std::optional<Eigen::Isometry3d> PoseOf(std::size_t camera) const;
  void PublishResults();
  void Publish(const FrameOutcome& outcome, Clock::time_point taken);
  void ReportHealth();
  bool IsSilent() const;
  bool IsSilent(std::size_t camera) const;
  std::string MissingCameras() const;
  void AppendCameras(dds::HealthReporter::KeysAndValues* values) const;
  Clock::time_point LastDepth() const;
  Status CurrentStatus();

  NodeConfig config_;
  CameraPose pose_;
  std::vector<std::string> notes_;  ///< on the calibration in use, for each report
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
  std::vector<CameraFeed> feeds_;  ///< of each camera, the first in front
  CameraClocks clocks_;
  FrameJoining joining_;
  PredictionHistory predictions_;
  Worker worker_;
  std::optional<JointSet> next_;               ///< waits for the worker or the prediction
  std::optional<std::int64_t> last_stamp_ns_;  ///< given to perception; none: none yet
  std::uint32_t last_epoch_ = 0;               ///< of the first camera
  std::string last_device_;
  Clock::time_point published_at_;
  Status last_state_ = Status::Ok();  ///< of the last message on /robot/mesh_state
  Lateness lateness_;                 ///< of frames
  dds::HealthCounts counts_;
  Status last_status_{StatusCode::kNotRun, "no images on /camera/depth/image_raw yet"};
  dds::InputMonitor inputs_;
};

}  // namespace palpate::perception
