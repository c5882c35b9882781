// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/virtual_camera/node/config.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/gige_vision/device.hpp"
#include "libs/scenario/schedule.hpp"

namespace palpate::virtual_camera {

/// The scenario in front of the camera; the virtual robot runs the same.
struct Scene {
  scenario::Schedule schedule;
  std::string scenario_sha256;
  std::uint64_t seed = 0;
  std::vector<scenario::ActiveEffect> effects;
  Eigen::Matrix3Xd markers_m;  ///< [3 x markers] at rest
  std::size_t camera = 0;      ///< number in the scenario; 0: the first
};

/// A GigE Vision camera in front of the virtual robot: draws each of its states and streams the
/// frames to any client of real cameras.
class VirtualCameraNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS or the network refuses.
  VirtualCameraNode(const NodeConfig& config, Scene scene, int domain_id, dds::TopicTable table,
                    dds::NodeLog::ProcessLog process_log);

  /// Until Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using States = std::map<std::int64_t, View>;  ///< by stamp

  void TakeMesh();
  void TakeBenchStates();
  void TakeMeshStates();
  void TakePicture(std::int64_t stamp_ns, const View& view);
  void Refuse(const Status& status, std::int64_t stamp_ns);
  Status StatusNow() const;
  void ReportHealth();

  Scene scene_;
  double silence_s_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Reader<idl::palpate_msgs::Mesh> meshes_;
  dds::Reader<idl::palpate_msgs::BenchState> bench_states_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  gige_vision::Device device_;
  RobotSurface robot_surface_;
  std::string mesh_hash_;
  std::unique_ptr<VirtualCamera> camera_;  ///< none before the first mesh
  States benches_;                         ///< that no mesh state has come for yet
  rgbd::RgbdFrame frame_;
  std::int64_t last_state_ns_;
  std::string last_refusal_;
  dds::HealthCounts counts_;
  dds::InputMonitor inputs_;
};

}  // namespace palpate::virtual_camera
