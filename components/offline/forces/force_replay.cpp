// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/force_replay.hpp"

#include <algorithm>
#include <utility>

#include "components/force_estimation/contact_site.hpp"
#include "components/offline/forces/bias_frames.hpp"
#include "components/offline/forces/image_check.hpp"
#include "components/offline/forces/loads_on_body.hpp"
#include "components/offline/forces/rest_check.hpp"
#include "libs/experiment/cameras.hpp"

namespace palpate::offline {

namespace {

geometry::PoseStandardError ErrorOf(const robot::CalibratedPose& pose) {
  return {.translation_m = pose.translation_error_m.maxCoeff(),
          .rotation_rad = pose.rotation_error_rad.maxCoeff()};
}

bool HasPlanned(const std::vector<PlannedRecording>& plan,
                const std::function<bool(const PlannedRecording&)>& is_wanted) {
  return std::any_of(plan.begin(), plan.end(), is_wanted);
}

}  // namespace

void TakePoses(const robot::CalibrationFile& calibration, experiment::Experiment* experiment) {
  if (calibration.pose) {
    experiment->T_robot_camera = calibration.pose->T_robot_camera;
    experiment->T_robot_camera_error = ErrorOf(*calibration.pose);
  }
  for (const std::string& name : experiment::FurtherCameras(*experiment)) {
    for (const robot::CalibratedCamera& camera : calibration.cameras) {
      if (camera.name == name)
        experiment::SetPose(name, camera.pose.T_robot_camera, ErrorOf(camera.pose), experiment);
    }
  }
}

void WidenPosePriors(const experiment::Experiment& experiment,
                     force_estimation::ShapeConfig* shape) {
  const auto widen = [&](const std::optional<geometry::PoseStandardError>& error) {
    if (!error) return;
    shape->pose_prior_m = std::max(shape->pose_prior_m, error->translation_m);
    shape->pose_prior_rad = std::max(shape->pose_prior_rad, error->rotation_rad);
  };
  widen(experiment.T_robot_camera_error);
  for (const auto& camera : experiment.cameras) widen(camera.T_robot_camera_error);
  for (const auto& recording : experiment.recordings) {
    if (recording.T_robot_camera) widen(recording.T_robot_camera_error);
  }
}

ShapeStream MakeShapeStream(robot::RobotModel& model, const ForceSettings& settings,
                            const robot::CalibrationFile& calibration,
                            const std::vector<std::string>& cameras, BiasFrom bias) {
  ReplayPerception perception =
      MakeReplayPerception(settings.perception, DepthBiasesOf(calibration, cameras));
  force_estimation::ShapeConfig shape = settings.shape;
  if (bias != BiasFrom::kFirst || calibration.depth_bias) shape.untouched_frames = 0;
  return {model.body(), std::move(perception),
          std::make_unique<force_estimation::ShapePipeline>(model, settings.forces, shape,
                                                            calibration, cameras)};
}

ForceReplay::ForceReplay(Inputs inputs, ForceSettings settings)
    : inputs_(std::move(inputs)), settings_(std::move(settings)) {
  WidenPosePriors(inputs_.experiment, &settings_.shape);
}

void ForceReplay::Say(const std::string& text) const {
  if (inputs_.note) inputs_.note(text);
}

void ForceReplay::Prepare(const std::vector<PlannedRecording>& plan) {
  for (const PlannedRecording& planned : plan) {
    RequireLoadsOnBody(*planned.recording, inputs_.model->locator());
  }
  FindDepthBias(plan);
  FindMarkerOffsets(plan);
}

std::unique_ptr<ShapeReplay> ForceReplay::MakeShapeReplay() const {
  return std::make_unique<ShapeReplay>(
      ShapeReplay::Inputs{.experiment = inputs_.experiment,
                          .model = inputs_.model,
                          .cable_input = inputs_.cable_input,
                          .limits = inputs_.limits,
                          .expect_posture = inputs_.bias != BiasFrom::kFirst,
                          .open = inputs_.open},
      MakeShapeStream(*inputs_.model, settings_, inputs_.calibration,
                      experiment::FurtherCameras(inputs_.experiment), inputs_.bias));
}

void ForceReplay::FindDepthBias(const std::vector<PlannedRecording>& plan) {
  const bool from_shape = HasPlanned(
      plan, [](const PlannedRecording& planned) { return planned.from == EstimateFrom::kShape; });
  if (!from_shape) return;
  for (const auto& site : force_estimation::ParseContactSites(settings_.forces.contacts)) {
    if (site.direction.isZero(0.0)) continue;
    Say("the direction of contact '" + site.name + "' is used with markers only");
  }
  CheckImages(plan);
  if (inputs_.bias != BiasFrom::kRecordings) return;
  BiasFrames found = FindBiasFrames({.experiment = inputs_.experiment,
                                     .plan = plan,
                                     .is_calibrated = inputs_.calibration.depth_bias.has_value(),
                                     .most_first_frames = settings_.shape.untouched_frames},
                                    [this] { return MakeShapeReplay(); });
  shape_ = std::move(found.replay);
  for (const std::string& note : found.notes) Say(note);
}

void ForceReplay::CheckImages(const std::vector<PlannedRecording>& plan) const {
  RequireImagesFit(
      {.experiment = inputs_.experiment,
       .model = inputs_.model,
       .cable_input = inputs_.cable_input,
       .noise = perception::NoiseOf(settings_.perception),
       .open = inputs_.open,
       .pose_name = "T_robot_camera of " +
                    (inputs_.calibration.pose ? inputs_.calibration_name : "experiment.yaml"),
       .pose_error = {.translation_m = settings_.shape.pose_prior_m,
                      .rotation_rad = settings_.shape.pose_prior_rad}},
      plan);
}

void ForceReplay::FindMarkerOffsets(const std::vector<PlannedRecording>& plan) {
  const bool needed = HasPlanned(plan, [](const PlannedRecording& planned) {
    return planned.from == EstimateFrom::kMarkers && !planned.recording->reference;
  });
  if (!needed) return;
  tare_ = std::make_unique<MarkerTare>(inputs_.experiment, inputs_.model, inputs_.cable_input,
                                       settings_.forces);
  for (const std::string& note : tare_->Choose()) Say(note);
}

ReplayCount ForceReplay::Replay(const PlannedRecording& planned, const TakeEstimate& take) {
  if (planned.from == EstimateFrom::kShape) {
    if (!shape_) shape_ = MakeShapeReplay();
    shape_->TakeNotes();  // of the bias frames
    const ReplayCount count = shape_->Estimate(*planned.recording, take);
    for (const std::string& note : shape_->TakeNotes()) Say(note);
    return count;
  }
  const MarkerReplay::Inputs inputs{.experiment = inputs_.experiment,
                                    .model = inputs_.model,
                                    .cable_input = inputs_.cable_input,
                                    .limits = inputs_.limits,
                                    .tare = tare_.get()};
  return MarkerReplay(inputs, settings_.forces, inputs_.calibration)
      .Estimate(*planned.recording, take);
}

ForceReplay::Result ForceReplay::Estimate(const PlannedRecording& planned,
                                          const TakeEstimate& take) {
  const bool from_shape = planned.from == EstimateFrom::kShape;
  RestCheck rest(
      inputs_.experiment, *planned.recording,
      {.calibrated = !inputs_.calibration_name.empty(),
       .significance = from_shape ? settings_.shape.significance : settings_.forces.significance,
       .gravity_m_s2 = inputs_.model->gravity_m_s2()});
  Result result;
  result.count = Replay(planned, [&](const force_estimation::ForceEstimate& estimate) {
    rest.Add(estimate);
    take(estimate);
  });
  result.failure = rest.Failure();
  return result;
}

}  // namespace palpate::offline
