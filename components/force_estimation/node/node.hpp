// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "components/force_estimation/node/cable_history.hpp"
#include "components/force_estimation/node/calibration_input.hpp"
#include "components/force_estimation/node/force_lines.hpp"
#include "components/force_estimation/node/frame_source.hpp"
#include "components/force_estimation/node/node_config.hpp"
#include "components/force_estimation/node/outputs.hpp"
#include "components/force_estimation/node/worker.hpp"
#include "libs/core/lateness.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::force_estimation {

/// Takes frames (of markers, or of the robot's shape) and cable inputs, runs the pipeline, and
/// publishes forces and the model's state. Each frame that was estimated or refused is answered on
/// /forces.
class ForceEstimationNode {
 public:
  /// `calibration`: was applied to `model`; older ones on /calibration are stale. Without a date:
  /// none. `maker`: of the pipelines; empty: by the settings. Throws InputError for bad settings,
  /// RunError where DDS fails. `cameras`: those beside the first, each with its pose.
  ForceEstimationNode(const NodeConfig& config, std::unique_ptr<robot::RobotModel> model,
                      const robot::CalibrationFile& calibration, int domain_id,
                      dds::TopicTable table, dds::NodeLog::ProcessLog process_log,
                      PipelineMaker maker = {},
                      const std::vector<dds::FurtherCamera>& cameras = {});

  /// Returns after Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using Clock = dds::WaitSet::Clock;

  void TakeJointStates();
  void ExpectPosture(std::int64_t stamp_ns);
  void TakeCalibration();
  void KeepPosesOfAll(robot::CalibrationFile* calibration);
  void Adopt(const robot::CalibrationFile& calibration);
  void CorrectForces(const std::vector<robot::CalibratedPressureSensor>& sensors);
  std::unique_ptr<FrameSource> MakeSource();
  void Take(FrameArrival arrival);
  void BeginSequence(const SequenceStart& start);
  void Accept(FrameInput input);
  void Refuse(const FrameHead& head, const Status& status);
  void MatchWithCables();
  void PassOnStart(const FrameInput& refused);
  Clock::time_point CablesOverdue(const FrameInput& input) const;
  bool FindCables(FrameInput& input, Status* status) const;
  void PublishResults();
  void ReportHealth();
  bool IsSilent() const;
  bool IsOverdue() const;
  Status CurrentStatus();
  std::string NameOfCamera(int camera) const;
  void LogDrift(const DriftReport& drift);
  void LogBiasFrames(int to_come);
  void LogGap(const GapReport& gap);
  void ExpectInputs();
  void LogForces();

  NodeConfig config_;
  std::vector<dds::FurtherCamera> cameras_;  ///< beside the first
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Alarm& cables_overdue_;  ///< of the first frame in pending_
  dds::NodeLog log_;
  dds::HealthReporter health_;
  Worker worker_;
  std::vector<std::string> cable_names_;
  std::vector<robot::DriveCalibration> drives_;
  std::vector<ForceCorrection> forces_;  ///< [cable_names_] by pressure sensors
  CableHistory cables_;
  Outputs outputs_;
  dds::Reader<idl::sensor_msgs::JointState> joint_states_;
  CalibrationInput calibration_;
  robot::CalibrationFile in_use_;   ///< its moduli, poses and depth biases
  std::deque<FrameInput> pending_;  ///< frames that wait for the cable inputs of their time
  bool has_frame_ = false;          ///< one was accepted
  Clock::time_point last_posture_;  ///< when one was asked for
  bool sequence_pending_ = false;   ///< the next accepted frame begins a sequence
  std::shared_ptr<const NewCalibration> calibration_pending_;  ///< for that frame
  bool maker_is_given_;
  Lateness lateness_;  ///< of frames
  dds::HealthCounts counts_;
  Status last_status_;
  DriftReport drift_;
  GapReport gap_;
  int bias_frames_to_come_ = 0;  ///< of the last result
  Clock::time_point last_frame_;
  std::optional<Clock::time_point> working_since_;  ///< on frames; nullopt: the last one is done
  ForceLines force_lines_;
  std::unique_ptr<FrameSource> source_;
  dds::InputMonitor inputs_;
};

}  // namespace palpate::force_estimation
