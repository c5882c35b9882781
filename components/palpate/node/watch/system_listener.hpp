// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/monitor/snapshot_builder.hpp"

namespace palpate::command {

/// Reads what the processes of a domain say about themselves and the last results, without images
/// and clouds. Publishes nothing.
class SystemListener {
 public:
  /// `remap`: other names of its topics, "__ns:=/left". `robot`: the robot file that says which
  /// joints are chambers; empty: that of config/robots with the name of the published mesh, if
  /// there is one. Throws InputError for a rule that is none and for a robot file that cannot be
  /// read, RunError where DDS refuses.
  explicit SystemListener(int domain_id, const std::vector<std::string>& remap = {},
                          const std::filesystem::path& robot = {});

  /// Takes messages until `done()` holds, which is asked at least every 50 ms, or `limit` passes.
  void Listen(const std::function<bool()>& done, std::chrono::duration<double> limit);

  monitor::SystemSnapshot Snapshot() const;

  /// Whether every process that DDS has found has reported, and there is one.
  bool HeardAll() const;

 private:
  template <typename T>
  void Attach(dds::Reader<T>& reader);
  void TakeRobotOfMesh();

  dds::Participant participant_;
  dds::WaitSet loop_;
  monitor::SnapshotBuilder builder_;
  std::optional<dds::Reader<idl::palpate_msgs::Mesh>> mesh_at_rest_;  ///< without a robot file
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  dds::Reader<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::ModelGap> model_errors_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::FrameInfo> frames_;
  dds::Reader<idl::palpate_msgs::MeshState> meshes_;
  dds::Reader<idl::sensor_msgs::JointState> cables_;
  dds::Reader<idl::palpate_msgs::CalibrationStatus> calibrations_;
};

}  // namespace palpate::command
