// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/pose_registration.hpp"

#include <algorithm>
#include <vector>

#include "components/diagnosis/forward/simulator.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::diagnosis {

Status RegisterUnknownPoses(const robot::RobotBody& body, int threads,
                            ObservedExperiment* observed) {
  const bool known = std::all_of(observed->recordings.begin(), observed->recordings.end(),
                                 [](const auto& recording) { return recording.knows_pose; });
  if (known) return Status::Ok();
  const Simulation simulation =
      Simulator(*observed, threads).Run(NominalHypothesis(body, *observed));
  for (std::size_t r = 0; r < observed->recordings.size(); ++r) {
    ObservedRecording& recording = observed->recordings[r];
    if (recording.knows_pose) continue;
    const auto shares = [&](const Sample& sample) {
      const auto& other = observed->recordings[At(sample.recording)];
      const bool own = recording.kind == "camera_moved" || other.kind == "camera_moved";
      return own ? static_cast<std::size_t>(sample.recording) == r : !other.knows_pose;
    };
    std::vector<Eigen::Vector3d> robot_m;
    std::vector<Eigen::Vector3d> measured_m;
    for (std::size_t s = 0; s < observed->samples.size(); ++s) {
      const Sample& sample = observed->samples[s];
      if (!simulation.samples[s].status.ok() || !shares(sample)) continue;
      for (Eigen::Index m = 0; m < sample.count.size(); ++m) {
        if (sample.count[m] == 0) continue;
        robot_m.emplace_back(simulation.samples[s].markers_m().col(m));
        measured_m.emplace_back(sample.position_m.col(m));
      }
    }
    const auto columns = [](const std::vector<Eigen::Vector3d>& points) {
      return Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3, std::ssize(points));
    };
    if (robot_m.empty()) continue;  // nothing was seen that a pose would be needed for
    const geometry::Registration found =
        geometry::RegisterRigid(columns(robot_m), columns(measured_m));
    if (!found.status.ok()) {
      return {StatusCode::kInvalidInput, "the pose of recording " + recording.name +
                                             " is missing (set T_robot_camera), and its "
                                             "markers do not determine it: " +
                                             found.status.message()};
    }
    recording.T_measurement_robot = Eigen::Isometry3d::Identity();
    recording.T_measurement_robot.linear() = found.T_target_source.rotation().toRotationMatrix();
    recording.T_measurement_robot.translation() = found.T_target_source.translation_m();
  }
  return Status::Ok();
}

}  // namespace palpate::diagnosis
