// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate::monitor {

/// How messages of one topic come.
struct TopicFlow {
  std::uint64_t received = 0;
  std::uint64_t lost = 0;  ///< by the counter that each message carries
  double rate_hz = 0.0;    ///< over the last 2 s
  double silence_s = 0.0;  ///< since the last message
};

/// What one process says about itself, once a second.
struct ProcessState {
  std::string name;    ///< of the component, "force_estimation"
  std::string status;  ///< "ok", or why it cannot work
  std::string reason;
  std::string waiting_for;  ///< inputs that do not come; empty: none
  double silence_s = 0.0;   ///< since its last report
  double uptime_s = 0.0;
  std::uint64_t received = 0;  ///< since its start, as the three below
  std::uint64_t published = 0;
  std::uint64_t dropped = 0;
  std::uint64_t refused = 0;
  double input_rate_hz = 0.0;
  double output_rate_hz = 0.0;
  double latency_mean_s = 0.0;
  double latency_max_s = 0.0;
  int restarts = 0;                                         ///< since this began to watch
  std::vector<std::pair<std::string, std::string>> values;  ///< further ones of /diagnostics

  /// Reports come once a second; whoever misses three has ended or hangs.
  bool IsSilent() const { return silence_s > 3.0; }
};

/// An entry of /diagnostics of another program.
struct OtherDiagnosis {
  std::string name;
  std::string level;  ///< ok, warning, error or stale
  std::string message;
  double silence_s = 0.0;
};

struct ForceState {
  std::string name;
  std::string status;
  std::string reason;
  Eigen::Vector3d position_m;  ///< on the deformed body, robot frame
  Eigen::Vector3d force_N;     ///< on the robot, robot frame; NaN: unobservable
  double ci95_N = 0.0;         ///< half-width of the 95 % interval of |F|
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();  ///< of force_N, robot frame
  double location_ci95_m = 0.0;
  Eigen::Matrix3d location_covariance_m2 = Eigen::Matrix3d::Zero();  ///< of position_m, robot frame
};

/// The last message of /forces.
struct ForcesState {
  TopicFlow flow;
  std::string status;
  std::string reason;
  std::int64_t stamp_ns = 0;
  double age_s = 0.0;      ///< from the exposure to publishing
  double latency_s = 0.0;  ///< from taking the frame to publishing
  std::vector<ForceState> forces;
};

/// The last message of /model_gap.
struct ModelErrorState {
  TopicFlow flow;
  std::string judgement;  ///< of the model residual monitor; empty: not told
  double residual_rms_m = 0.0;
  double noise_rms_m = 0.0;  ///< expected from the measurement noise
  std::uint32_t samples = 0;
};

/// The last message of /perception/report.
struct PerceptionState {
  TopicFlow flow;
  std::string status;
  std::string reason;
  std::uint32_t robot_points = 0;
  std::uint32_t object_points = 0;
  std::uint32_t contacts = 0;
  double age_s = 0.0;
  double latency_s = 0.0;
  std::vector<std::string> notes;
};

/// The last message of /camera/frame_info.
struct CameraState {
  TopicFlow flow;
  std::string device;
  std::uint32_t epoch = 0;
  double valid_ratio = 0.0;        ///< share of depth pixels with a value
  std::uint64_t packets_lost = 0;  ///< of the frames received here
  std::uint64_t frames_failed = 0;
  std::uint64_t frames_dropped = 0;
  std::uint64_t socket_drops = 0;
};

/// The last message of /robot/mesh_state.
struct MeshShapeState {
  TopicFlow flow;
  std::string status;
};

/// Of a cable, or of a chamber with its change of volume, m3, and pressure above ambient, Pa.
struct CableValue {
  std::string name;
  double displacement_m = 0.0;  ///< NaN: not told
  double tension_N = 0.0;       ///< NaN: not told
  bool is_chamber = false;
};

/// The last message of /robot/joint_states.
struct CablesState {
  TopicFlow flow;
  std::vector<CableValue> cables;
};

/// The last message of /calibration/status.
struct CalibrationState {
  std::string request_id;
  std::string state;
  std::string reason;
  std::uint32_t frames_taken = 0;
  std::uint32_t frames_wanted = 0;
};

/// What a process measured of the clock of another host.
struct ClockState {
  std::string host;  ///< of the process
  std::string other_host;
  double offset_s = 0.0;  ///< the other host's clock minus the process's
  double bound_s = 0.0;   ///< of the error
};

/// The whole running system at one time, as its messages tell. What has sent nothing is absent.
struct SystemSnapshot {
  int domain_id = 0;
  std::int64_t time_ns = 0;             ///< since 1970, UTC
  std::vector<ProcessState> processes;  ///< in the order of the data's flow, others by name
  std::vector<OtherDiagnosis> others;
  std::optional<ForcesState> forces;
  std::optional<ModelErrorState> model_error;
  std::optional<PerceptionState> perception;
  std::optional<CameraState> camera;
  std::optional<MeshShapeState> mesh;
  std::optional<CablesState> cables;
  std::optional<CalibrationState> calibration;
  std::vector<ClockState> clocks;  ///< one for each pair of hosts, the tightest
};

}  // namespace palpate::monitor
