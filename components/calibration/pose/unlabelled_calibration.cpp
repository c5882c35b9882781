// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/unlabelled_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/pose/actuator_misfit.hpp"
#include "components/calibration/pose/tension_range.hpp"
#include "libs/core/text.hpp"

namespace palpate::calibration {

namespace {

constexpr double kNoFit = std::numeric_limits<double>::infinity();

/// An assignment and its calibration.
struct Attempt {
  FrameLabels labels;
  std::vector<CalibrationFrame> frames;
  JointCalibration joint;

  /// Robust sum of squares of all rows.
  double Cost() const { return joint.status.ok() ? 2.0 * joint.objectives.back() : kNoFit; }
  /// Reduced chi-squared, at least 1.
  double Excess() const {
    return std::max(1.0, joint.chi_squared / std::max(1, joint.degrees_of_freedom));
  }
};

/// Assignment of points that have names.
FrameAssignment TakeNames(const std::vector<UnlabelledFrame>& frames) {
  FrameAssignment assignment;
  FrameLabels& labels = assignment.choices.emplace_back();
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<int> markers;
    for (const MarkerSighting& point : frames[f].points) markers.push_back(point.marker);
    if (std::none_of(markers.begin(), markers.end(), [](int marker) { return marker >= 0; })) {
      assignment.left_out.push_back(frames[f].frame.name + ": no marker has a name");
      continue;
    }
    labels.frames.push_back(f);
    labels.marker_of_point.push_back(std::move(markers));
  }
  assignment.status = labels.frames.empty()
                          ? Status(StatusCode::kUnobservable, assignment.left_out.front())
                          : Status::Ok();
  return assignment;
}

/// Assignment by the shapes in the range of tensions.
FrameAssignment Assign(robot::RobotModel& model, const std::vector<UnlabelledFrame>& frames,
                       const geometry::RigidTransform* T_rough,
                       const UnlabelledSettings& settings) {
  if (settings.named) return TakeNames(frames);
  FrameAssignment assignment;
  std::vector<CalibrationFrame> inputs;
  for (const UnlabelledFrame& frame : frames) inputs.push_back(frame.frame);
  Eigen::VectorXd most_N;
  assignment.status =
      FindTensionRange(model, inputs, settings.request.actuator_offset_sigma_m, &most_N);
  if (!assignment.status.ok()) return assignment;
  const SolvedShapes solved = SolveMarkerShapes(model, most_N);
  assignment.status = solved.status;
  if (!solved.status.ok()) return assignment;
  return AssignFrames(solved.shapes, frames, T_rough, settings.model_sigma_m);
}

/// Removes choices that contradict the actuators.
void RejectByActuators(robot::RobotModel& model, const std::vector<UnlabelledFrame>& frames,
                       const UnlabelledSettings& settings, std::vector<FrameLabels>* choices) {
  if (choices->size() < 2) return;
  const ActuatorErrors errors{.displacement_m = settings.model_sigma_m,
                              .offset_m = settings.request.actuator_offset_sigma_m};
  std::vector<CalibrationFrame> inputs;
  for (const UnlabelledFrame& frame : frames) inputs.push_back(frame.frame);
  const Eigen::MatrixXd commanded_m = CommandedDisplacements_m(model, inputs);
  std::vector<double> misfits;
  for (const FrameLabels& labels : *choices) {
    misfits.push_back(ActuatorMisfit(model, LabelledFrames(frames, labels), labels.tension_N,
                                     commanded_m(Eigen::all, labels.frames), errors));
  }
  const double most =
      *std::min_element(misfits.begin(), misfits.end()) + settings.most_actuator_misfit;
  std::vector<FrameLabels> kept;
  for (std::size_t k = 0; k < choices->size(); ++k) {
    if (misfits[k] <= most) kept.push_back(std::move((*choices)[k]));
  }
  *choices = std::move(kept);
}

bool FitsAsWell(const Attempt& other, const Attempt& best, const UnlabelledSettings& settings) {
  return (other.Cost() - best.Cost()) / best.Excess() <= settings.ambiguous_below;
}

/// Whether a camera at this pose sees the points about where the attempt's camera does.
bool StandsAt(const geometry::RigidTransform& T_robot_camera, const Attempt& attempt) {
  Eigen::Matrix3Xd points_m(3, 0);
  for (const CalibrationFrame& frame : attempt.frames) {
    Eigen::Matrix3Xd all_m(3, points_m.cols() + std::ssize(frame.markers));
    all_m << points_m, PositionsOf(frame.markers);
    points_m = all_m;
  }
  const Eigen::Vector3d middle_m = points_m.rowwise().mean();
  const double spread_m = (points_m.colwise() - middle_m).norm();
  const Eigen::Matrix3Xd off_m =
      T_robot_camera.Apply(points_m) - attempt.joint.T_robot_camera.Apply(points_m);
  return off_m.norm() <= kSamePoseShare * spread_m;
}

/// Of those that fit as well as the best: that of the last pose; nullptr: none.
const Attempt* AtLastPose(const std::vector<Attempt>& attempts, const Attempt& best,
                          const UnlabelledSettings& settings) {
  if (!settings.T_robot_camera_last) return nullptr;
  for (const Attempt& one : attempts) {
    const bool candidate = one.joint.status.ok() && FitsAsWell(one, best, settings);
    if (candidate && StandsAt(*settings.T_robot_camera_last, one)) return &one;
  }
  return nullptr;
}

Status Compare(const std::vector<Attempt>& attempts, const Attempt& best,
               const UnlabelledSettings& settings) {
  for (const Attempt& other : attempts) {
    if (&other == &best || !FitsAsWell(other, best, settings)) continue;
    return {StatusCode::kUnobservable,
            "ambiguous: two assignments of the markers explain all frames equally well "
            "(chi-squared " +
                FormatNumber(best.Cost()) + " and " + FormatNumber(other.Cost()) +
                "); an approximate camera pose decides, or other settings of the cables, or "
                "markers without symmetry"};
  }
  return Status::Ok();
}

}  // namespace

UnlabelledCalibration CalibrateUnlabelled(robot::RobotModel& model,
                                          const std::vector<UnlabelledFrame>& frames,
                                          const geometry::RigidTransform* T_rough,
                                          const UnlabelledSettings& settings) {
  const ModelSnapshot kept(model);
  UnlabelledCalibration result;
  FrameAssignment assignment = Assign(model, frames, T_rough, settings);
  result.status = assignment.status;
  result.left_out = std::move(assignment.left_out);
  if (!result.status.ok()) return result;
  result.choices = static_cast<int>(assignment.choices.size());
  RejectByActuators(model, frames, settings, &assignment.choices);
  std::vector<Attempt> attempts;
  for (FrameLabels& labels : assignment.choices) {
    Attempt& attempt = attempts.emplace_back();
    attempt.frames = LabelledFrames(frames, labels);
    attempt.labels = std::move(labels);
    attempt.joint = CalibrateFrames(model, attempt.frames, nullptr, settings.request);
    kept.Restore();
  }
  auto best = std::min_element(attempts.begin(), attempts.end(),
                               [](const auto& a, const auto& b) { return a.Cost() < b.Cost(); });
  result.status = best->joint.status;
  if (result.status.ok()) result.status = Compare(attempts, *best, settings);
  const bool ambiguous = best->joint.status.ok() && !result.status.ok();
  if (const Attempt* decided = ambiguous ? AtLastPose(attempts, *best, settings) : nullptr) {
    best = attempts.begin() + (decided - attempts.data());
    result.status = Status::Ok();
    result.decided_by_last_pose = true;
  }
  result.joint = std::move(best->joint);
  result.labels = std::move(best->labels);
  result.frames = std::move(best->frames);
  return result;
}

}  // namespace palpate::calibration
