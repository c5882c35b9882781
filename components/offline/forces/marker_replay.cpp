// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/marker_replay.hpp"

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/force_estimation/rest_markers.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::offline {

namespace {

using force_estimation::MarkerFrame;
using force_estimation::ReferenceShape;
using force_estimation::RestAgreement;
using force_estimation::RestMarkers;

/// Reference frames cost nothing, and all of them count for the marker offsets.
std::vector<MarkerFrame> Thinned(std::vector<MarkerFrame> frames, double rate_Hz) {
  std::vector<double> t_s;
  for (const MarkerFrame& frame : frames) t_s.push_back(frame.t_s);
  const std::vector<bool> kept = KeptFrames(t_s, rate_Hz);
  std::vector<MarkerFrame> thinned;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_reference = frames[i].reference != force_estimation::ReferenceShape::kNone;
    if (kept[i] || is_reference) thinned.push_back(std::move(frames[i]));
  }
  return thinned;
}

/// The means of the markers over `frames`, and of the model in their shape; without the markers
/// that no frame has.
Status MeanMarkers(const std::vector<const MarkerFrame*>& frames, ReferenceShape shape,
                   robot::RobotModel& model, RestMarkers* markers) {
  Eigen::VectorXd model_m;
  const auto& cables = frames.front()->cables;
  if (Status status = force_estimation::ReferenceMarkers(model, shape, cables, &model_m);
      !status.ok()) {
    return status;
  }
  std::vector<Eigen::Index> seen;
  Eigen::Matrix3Xd mean_m = Eigen::Matrix3Xd::Zero(3, model_m.size() / 3);
  const std::vector<std::string> names = model.MarkerNames();
  for (Eigen::Index m = 0; m < mean_m.cols(); ++m) {
    int count = 0;
    for (const MarkerFrame* frame : frames) {
      const auto& marker = frame->markers[At(m)];
      if (!marker.valid) continue;
      mean_m.col(m) += marker.position_m;
      ++count;
    }
    if (count == 0) continue;
    mean_m.col(m) /= count;
    seen.push_back(m);
    markers->names.push_back(names[At(m)]);
  }
  markers->measured_m = mean_m(Eigen::all, seen);
  markers->model_m = model_m.reshaped(3, model_m.size() / 3)(Eigen::all, seen);
  return Status::Ok();
}

void TakeDirections(const std::vector<experiment::KnownLoad>& loads, double t_s,
                    std::vector<force_estimation::ContactSite>* sites) {
  for (const experiment::KnownLoad& load : experiment::LoadsAt(loads, t_s)) {
    for (force_estimation::ContactSite& site : *sites) {
      if (site.position_m == load.position_m) site.direction = load.force_N.normalized();
    }
  }
}

}  // namespace

/// Frames of a reference shape count as displacements, a rest recording without one as positions.
/// Where neither says what the shape is, nothing is compared.
void MarkerReplay::CheckAtRest(const experiment::Recording& recording,
                               const std::vector<MarkerFrame>& frames) const {
  std::vector<const MarkerFrame*> at_rest;
  for (const MarkerFrame& frame : frames) {
    if (frame.reference != ReferenceShape::kNone) at_rest.push_back(&frame);
  }
  const bool by_kind = at_rest.empty() && recording.kind == experiment::RecordingKind::kRest;
  if (by_kind) {
    for (const MarkerFrame& frame : frames) at_rest.push_back(&frame);
  }
  if (at_rest.empty()) return;
  const ReferenceShape shape = by_kind ? ReferenceShape::kEquilibrium : at_rest.front()->reference;
  RestMarkers markers;
  Status status = MeanMarkers(at_rest, shape, *inputs_.model, &markers);
  if (status.ok()) {
    status = force_estimation::CheckRestMarkers(
        markers, by_kind ? RestAgreement::kShapeTurnAndPlace : RestAgreement::kShapeAndTurn);
  }
  if (!status.ok()) throw InputError(SourceLocation{recording.folder.string()}, status.message());
}

/// A calibrated pose replaces that of the experiment, and so does its error.
void MarkerReplay::CountCalibratedPose(const experiment::Recording& recording,
                                       std::vector<MarkerFrame>* frames) const {
  if (!calibration_.pose || recording.T_robot_camera) return;
  const Eigen::Vector3d middle_m = inputs_.model->body().mesh.nodes_m.rowwise().mean();
  const auto error = force_estimation::CalibratedPoseError(*calibration_.pose, middle_m);
  for (MarkerFrame& frame : *frames) {
    if (!frame.pose_error.IsZero()) frame.pose_error = error;
  }
}

ReplayCount MarkerReplay::Estimate(const experiment::Recording& recording,
                                   const TakeEstimate& take) const {
  robot::RobotModel& model = *inputs_.model;
  const Eigen::Vector3d gravity_m_s2 = model.gravity_m_s2();
  model.SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2);
  force_estimation::MarkerPipeline pipeline(model, config_, calibration_);
  auto frames = Thinned(force_estimation::FramesOfRecording(inputs_.experiment, recording, model,
                                                            inputs_.cable_input),
                        inputs_.limits.rate_Hz);
  CountCalibratedPose(recording, &frames);
  CheckAtRest(recording, frames);
  if (inputs_.tare != nullptr && !recording.reference) {
    const auto tare = inputs_.tare->FramesFor(recording);
    if (!tare.empty()) CheckAtRest(recording, tare);
    for (const MarkerFrame& frame : tare) static_cast<void>(pipeline.Update(frame));
  }
  ReplayCount count{.done = 0, .total = static_cast<int>(frames.size())};
  inputs_.limits.Report(0, count.total);
  for (MarkerFrame& frame : frames) {
    if (inputs_.limits.StopRequested()) break;
    frame.loads = force_estimation::SitesOfLoads(recording.loads, frame.t_s);
    if (inputs_.knows_directions) TakeDirections(recording.loads, frame.t_s, &frame.loads);
    take(pipeline.Update(std::move(frame)).estimate);
    inputs_.limits.Report(++count.done, count.total);
  }
  model.SetGravity(gravity_m_s2);
  return count;
}

}  // namespace palpate::offline
