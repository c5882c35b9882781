// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/palpate/child_process.hpp"
#include "components/palpate/node/demo/demo_place.hpp"

namespace palpate::command {

/// The processes of a system on one machine, each with its log in the demonstration's folder. All
/// end with this object.
class SystemProcesses {
 public:
  /// `remap`: rules for the names of topics, as every process takes them.
  SystemProcesses(const DemoPlace& place, std::vector<std::string> remap)
      : place_(place), remap_(std::move(remap)) {}

  /// palpate-virtual-camera and palpate-capture, over GigE Vision on loopback.
  void StartVirtualCamera(const std::filesystem::path& robot,
                          const std::filesystem::path& scenario);
  void StartVirtualRobot(const std::filesystem::path& robot, const std::filesystem::path& scenario);
  /// palpate-player: images and cables of recordings, frame after frame.
  void StartPlayer(const std::filesystem::path& data);
  /// palpate-perception and palpate-force-estimation. `calibration`: empty: none. `overrides`:
  /// settings of the estimation.
  void StartSensing(const std::filesystem::path& robot, const std::filesystem::path& calibration,
                    const Eigen::Isometry3d& T_robot_camera,
                    const std::vector<std::string>& overrides = {});

  /// Throws RunError where one has ended by itself with another code than 0.
  void CheckAlive();
  /// Whether all programs of this name have ended.
  bool HasEnded(const std::string& program);
  /// Lets all end, the youngest first.
  void Stop();

 private:
  void Start(const std::string& program, std::vector<std::string> arguments);

  const DemoPlace& place_;
  std::vector<std::string> remap_;
  std::vector<std::unique_ptr<ChildProcess>> processes_;
};

}  // namespace palpate::command
