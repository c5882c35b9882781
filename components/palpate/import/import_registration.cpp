// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_registration.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::command {

using experiment::TimeWindow;

namespace {

// Markers of the recording paired with those of the robot.
struct MarkerPairs {
  std::vector<std::string> names;
  Eigen::Matrix3Xd measured_m;  // [3 x n] mean over the window, measurement frame
  Eigen::Matrix3Xd rest_m;      // [3 x n] of the robot file, robot frame
};

MarkerPairs PairMarkers(const ImportOptions& options, const experiment::Recording& recording,
                        const robot::RobotDescription& robot) {
  const experiment::MarkerTracks& tracks = *recording.markers;
  const auto window = recording.reference
                          ? recording.reference->window_s
                          : TimeWindow{tracks.frames.front().t_s, tracks.frames.back().t_s};
  const auto means = MeanOver(tracks, window);
  MarkerPairs pairs;
  pairs.names =
      options.register_markers.empty() ? tracks.names : SplitNames(options.register_markers, ',');
  const auto count = ToIndex(pairs.names.size());
  pairs.measured_m.resize(3, count);
  pairs.rest_m.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::string& name = pairs.names[At(i)];
    const std::optional<std::size_t> index = tracks.IndexOf(name);
    const auto marker = std::find_if(robot.markers.begin(), robot.markers.end(),
                                     [&](const auto& entry) { return entry.name == name; });
    if (!index || marker == robot.markers.end() || means[*index].count == 0) {
      throw InputError("marker '" + name + "' cannot be registered: " +
                       (!index                          ? "it is not in the data"
                        : marker == robot.markers.end() ? "the robot file has no such marker"
                                                        : "it is not seen in the window"));
    }
    pairs.measured_m.col(i) = means[*index].mean_m;
    pairs.rest_m.col(i) = marker->position_m;
  }
  return pairs;
}

void CheckRegistrationIsMeant(const ImportOptions& options,
                              const experiment::Recording& recording) {
  if (!options.pose.empty()) throw InputError("--register and --pose exclude each other");
  const bool undeformed =
      recording.reference && recording.reference->shape == experiment::ReferenceShape::kUndeformed;
  if (!undeformed && options.register_markers.empty()) {
    throw InputError(
        "--register compares with the undeformed robot: give --rest-window with --rest-shape "
        "undeformed, or name markers that do not move with --register-markers");
  }
}

}  // namespace

Eigen::Isometry3d Register(const ImportOptions& options, const experiment::Recording& recording,
                           const robot::RobotDescription& robot, std::ostream& report) {
  CheckRegistrationIsMeant(options, recording);
  const MarkerPairs pairs = PairMarkers(options, recording, robot);
  const geometry::Registration result = geometry::RegisterRigid(pairs.measured_m, pairs.rest_m);
  if (!result.status.ok()) {
    throw InputError("the markers cannot be registered: " + result.status.message());
  }
  const Eigen::Matrix3Xd mapped_m = result.T_target_source.Apply(pairs.measured_m);
  report << fmt::format("registered {} markers to the robot file, RMS {:.3f} mm\n",
                        pairs.names.size(), 1e3 * result.rms_m);
  for (Eigen::Index i = 0; i < mapped_m.cols(); ++i) {
    report << fmt::format("  {:<16} residual {:.3f} mm\n", pairs.names[At(i)],
                          1e3 * (mapped_m.col(i) - pairs.rest_m.col(i)).norm());
  }
  return Eigen::Translation3d(result.T_target_source.translation_m()) *
         result.T_target_source.rotation();
}

}  // namespace palpate::command
