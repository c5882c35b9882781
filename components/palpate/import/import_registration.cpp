// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_registration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "components/force_estimation/recording_frames.hpp"
#include "components/force_estimation/rest_markers.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

using experiment::TimeWindow;
using force_estimation::ReferenceShape;
using force_estimation::RestAgreement;
using force_estimation::RestMarkers;

namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;

/// Where the robot's markers are at rest.
struct RobotMarkers {
  std::vector<std::string> names;
  Eigen::Matrix3Xd rest_m;  // [3 x n] robot frame
};

/// The window in which the body is at rest; nullopt: it is not known to be.
std::optional<TimeWindow> RestWindow(const ImportOptions& options,
                                     const experiment::Recording& recording) {
  const auto& frames = recording.markers->frames;
  if (recording.reference) return recording.reference->window_s;
  const bool rests = recording.kind == experiment::RecordingKind::kRest;
  if (rests || !options.register_markers.empty()) {
    return TimeWindow{frames.front().t_s, frames.back().t_s};
  }
  return std::nullopt;
}

bool IsEquilibrium(const ImportOptions& options, const experiment::Recording& recording) {
  if (recording.reference) {
    return recording.reference->shape == experiment::ReferenceShape::kEquilibrium;
  }
  return options.register_markers.empty();  // named ones do not move
}

RobotMarkers Undeformed(const robot::RobotDescription& robot) {
  RobotMarkers markers;
  markers.rest_m.resize(3, ToIndex(robot.markers.size()));
  for (const robot::MarkerSettings& marker : robot.markers) {
    markers.rest_m.col(ToIndex(markers.names.size())) = marker.position_m;
    markers.names.push_back(marker.name);
  }
  return markers;
}

/// Under gravity and the cable inputs in the middle of `window`.
RobotMarkers InEquilibrium(const ImportOptions& options, const experiment::Recording& recording,
                           const TimeWindow& window, std::ostream& report) {
  const auto model = LoadRobot(options.robot);
  model->SetGravity(experiment::BaseRotation(recording).transpose() * model->gravity_m_s2());
  const auto cables = force_estimation::CablesAt(
      recording, *model, robot::CableInput::kDisplacement, 0.5 * (window.begin_s + window.end_s));
  Eigen::VectorXd positions_m;
  const Status status = force_estimation::ReferenceMarkers(*model, ReferenceShape::kEquilibrium,
                                                           cables, &positions_m);
  if (!status.ok()) {
    throw InputError("the equilibrium of the rest window is not found: " + status.message() +
                     "; give --rest-shape undeformed where the body was held straight");
  }
  const Eigen::Vector3d g = model->gravity_m_s2();
  const double mean_sag_m =
      (positions_m.reshaped(3, positions_m.size() / 3) -
       Undeformed(robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml)).rest_m)
          .colwise()
          .norm()
          .mean();
  report << fmt::format(
      "rest shape: equilibrium under gravity ({:g}, {:g}, {:g}) m/s2, markers {:.2f} mm from the "
      "undeformed shape{}\n",
      g.x(), g.y(), g.z(), 1e3 * mean_sag_m,
      options.rest_shape == "auto" ? "; --rest-shape undeformed where the body was held straight"
                                   : "");
  return {model->MarkerNames(), positions_m.reshaped(3, positions_m.size() / 3)};
}

RobotMarkers MarkersAtRest(const ImportOptions& options, const experiment::Recording& recording,
                           const TimeWindow& window, std::ostream& report) {
  if (IsEquilibrium(options, recording)) return InEquilibrium(options, recording, window, report);
  report << "rest shape: undeformed\n";
  return Undeformed(robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml));
}

/// The markers of the recording paired with the robot's: those of --register-markers, or all.
RestMarkers PairMarkers(const ImportOptions& options, const experiment::Recording& recording,
                        const TimeWindow& window, const RobotMarkers& robot) {
  const experiment::MarkerTracks& tracks = *recording.markers;
  const auto means = MeanOver(tracks, window);
  RestMarkers pairs;
  const bool chosen = !options.register_markers.empty();
  pairs.names = chosen ? SplitNames(options.register_markers, ',') : tracks.names;
  if (!chosen) {
    std::erase_if(pairs.names, [&](const std::string& name) {
      return experiment::IsUnlabelled(name) || means[*tracks.IndexOf(name)].count == 0;
    });
  }
  const auto count = ToIndex(pairs.names.size());
  pairs.measured_m.resize(3, count);
  pairs.model_m.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::string& name = pairs.names[At(i)];
    const std::optional<std::size_t> index = tracks.IndexOf(name);
    const auto marker = std::find(robot.names.begin(), robot.names.end(), name);
    if (!index || marker == robot.names.end() || means[*index].count == 0) {
      throw InputError("marker '" + name + "' cannot be registered: " +
                       (!index                        ? "it is not in the data"
                        : marker == robot.names.end() ? "the robot file has no such marker"
                                                      : "it is not seen in the window"));
    }
    pairs.measured_m.col(i) = means[*index].mean_m;
    pairs.model_m.col(i) = robot.rest_m.col(marker - robot.names.begin());
  }
  return pairs;
}

void RequireAgreement(const RestMarkers& pairs, RestAgreement agreement) {
  const Status status = force_estimation::CheckRestMarkers(pairs, agreement);
  if (!status.ok()) throw InputError(status.message());
}

/// From the residuals; along and about the axis where it is largest. Never 0: residuals of a
/// simulation may be, and no pose is exact.
geometry::PoseStandardError ErrorOf(const geometry::Registration& registration) {
  constexpr double kLeast = 1e-6;  // m, rad
  const Eigen::Matrix<double, 6, 1> error = registration.covariance.diagonal().cwiseSqrt();
  return {.translation_m = std::max(kLeast, error.tail<3>().maxCoeff()),
          .rotation_rad = std::max(kLeast, error.head<3>().maxCoeff())};
}

/// Sets the pose and its standard error.
void Register(const RestMarkers& pairs, std::ostream& report, experiment::Recording* recording) {
  RequireAgreement(pairs, RestAgreement::kShape);
  const geometry::Registration result = geometry::RegisterRigid(pairs.measured_m, pairs.model_m);
  if (!result.status.ok()) {
    throw InputError("the markers cannot be registered: " + result.status.message());
  }
  const Eigen::Matrix3Xd mapped_m = result.T_target_source.Apply(pairs.measured_m);
  report << fmt::format("registered {} markers to the robot's rest shape, RMS {:.3f} mm\n",
                        pairs.names.size(), 1e3 * result.rms_m);
  for (Eigen::Index i = 0; i < mapped_m.cols(); ++i) {
    report << fmt::format("  {:<16} residual {:.3f} mm\n", pairs.names[At(i)],
                          1e3 * (mapped_m.col(i) - pairs.model_m.col(i)).norm());
  }
  const geometry::PoseStandardError error = ErrorOf(result);
  report << fmt::format("standard error of the pose: {:.2f} mm, {:.2f} degrees\n",
                        1e3 * error.translation_m, kDegreesPerRadian * error.rotation_rad);
  recording->T_robot_camera = Eigen::Translation3d(result.T_target_source.translation_m()) *
                              result.T_target_source.rotation();
  recording->T_robot_camera_error = error;
}

/// Of markers whose pose is known or not to be estimated.
void CheckPlace(const experiment::Recording& recording, const ImportOptions& options,
                RestMarkers pairs) {
  const bool in_robot_frame = recording.frame == experiment::MeasurementFrame::kRobot;
  if (!in_robot_frame && !recording.T_robot_camera) {
    return RequireAgreement(pairs, RestAgreement::kShape);
  }
  if (!in_robot_frame) {
    pairs.measured_m = (*recording.T_robot_camera * pairs.measured_m.colwise().homogeneous());
  }
  // --axes gives the axes alone: the origin is the capture's.
  const bool origin_is_known = !in_robot_frame || options.axes.empty() || !recording.reference;
  RequireAgreement(
      pairs, origin_is_known ? RestAgreement::kShapeTurnAndPlace : RestAgreement::kShapeAndTurn);
}

}  // namespace

void PlaceMarkers(const ImportOptions& options, std::ostream& report,
                  experiment::Recording* recording) {
  if (options.register_to_robot && !options.pose.empty()) {
    throw InputError("--register and --pose exclude each other");
  }
  const std::optional<TimeWindow> window = RestWindow(options, *recording);
  if (!window && !options.register_to_robot) return;
  if (!window) {
    throw InputError(
        "--register compares with the robot at rest: give --rest-window, or name markers that do "
        "not move with --register-markers");
  }
  const RobotMarkers robot = MarkersAtRest(options, *recording, *window, report);
  const RestMarkers pairs = PairMarkers(options, *recording, *window, robot);
  if (options.register_to_robot) {
    Register(pairs, report, recording);
  } else {
    CheckPlace(*recording, options, pairs);
  }
}

}  // namespace palpate::command
