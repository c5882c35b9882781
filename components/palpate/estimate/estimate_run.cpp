// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/pipeline/shape_pipeline.hpp"
#include "components/palpate/compare/comparison_output.hpp"
#include "components/palpate/estimate/bias_frames.hpp"
#include "components/palpate/estimate/image_check.hpp"
#include "components/palpate/estimate/marker_replay.hpp"
#include "components/palpate/estimate/replay_perception.hpp"
#include "components/palpate/estimate/rest_check.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

geometry::PoseStandardError ErrorOf(const robot::CalibratedPose& pose) {
  return {.translation_m = pose.translation_error_m.maxCoeff(),
          .rotation_rad = pose.rotation_error_rad.maxCoeff()};
}

/// Applies the calibration to the model and the experiment, and returns it.
robot::CalibrationFile ApplyCalibration(const std::filesystem::path& file, robot::RobotModel* model,
                                        experiment::Experiment* experiment) {
  if (file.empty()) {
    fmt::print(stderr, "palpate estimate: no --calibration: the moduli of the robot file hold\n");
    return {};
  }
  auto calibration = robot::ReadCalibrationFile(file, app::LoadYaml);
  robot::ApplyCalibration(calibration, model);
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
  return calibration;
}

/// The pose's priors of the settings, or the largest error that is stated where that is larger.
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

bool IsResult(const Status& status) {
  return status.ok() || status.code() == StatusCode::kNoContact;
}

/// forces.svg -> forces_NAME.svg
std::filesystem::path PlotOf(const std::filesystem::path& plot, const std::string& recording) {
  std::filesystem::path file = plot;
  return file.replace_filename(plot.stem().string() + "_" + recording + plot.extension().string());
}

}  // namespace

EstimateRun::EstimateRun(const EstimateOptions& options, const EstimateSettings& settings,
                         experiment::Experiment* experiment, robot::RobotModel* model,
                         std::function<bool()> stop_requested)
    : options_(options),
      settings_(settings),
      experiment_(*experiment),
      model_(*model),
      calibration_(ApplyCalibration(options.calibration, model, experiment)),
      stop_requested_(std::move(stop_requested)),
      json_(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::array())) {
  if (options.answer.empty()) return;
  truth_ = ReadKnownTruth(options.answer, *experiment, BodyDiagonal_m(model->body()));
  if (options.json) return;
  fmt::print("compared with {}: forces of {:.3g} N or more, within {:.3g} mm\n",
             options.answer.string(), truth_->rules.smallest_N, 1e3 * truth_->rules.same_place_m);
}

EstimateRun::~EstimateRun() = default;

void EstimateRun::Say(const std::string& note) {
  fmt::print(stderr, "palpate estimate: {}\n", note);
}

ShapeReplay& EstimateRun::Shape() {
  if (!shape_) shape_ = MakeShapeReplay();
  return *shape_;
}

std::unique_ptr<ShapeReplay> EstimateRun::MakeShapeReplay() const {
  const std::vector<std::string> cameras = experiment::FurtherCameras(experiment_);
  ReplayPerception perception =
      MakeReplayPerception(settings_.perception, DepthBiasesOf(calibration_, cameras));
  force_estimation::ShapeConfig shape = settings_.shape;
  WidenPosePriors(experiment_, &shape);
  if (options_.bias_frames != "first" || calibration_.depth_bias) shape.untouched_frames = 0;
  auto pipeline = std::make_unique<force_estimation::ShapePipeline>(model_, settings_.forces, shape,
                                                                    calibration_, cameras);
  const ShapeReplay::Inputs inputs{.experiment = experiment_,
                                   .model = &model_,
                                   .cable_input = ParseCableInput(options_.cable_input),
                                   .limits = Limits(),
                                   .expect_posture = options_.bias_frames != "first"};
  return std::make_unique<ShapeReplay>(inputs, std::move(perception), std::move(pipeline));
}

void EstimateRun::EstimateDepthBias(const std::vector<PlannedRecording>& plan) {
  const bool from_shape = std::any_of(
      plan.begin(), plan.end(),
      [](const PlannedRecording& planned) { return planned.from == EstimateFrom::kShape; });
  if (!from_shape) return;
  for (const auto& site : force_estimation::ParseContactSites(settings_.forces.contacts)) {
    if (site.direction.isZero(0.0)) continue;
    Say("the direction of contact '" + site.name + "' is used with markers only");
  }
  CheckImages(plan);
  if (options_.bias_frames != "recordings") return;
  BiasFrames found = FindBiasFrames({.experiment = experiment_,
                                     .plan = plan,
                                     .is_calibrated = calibration_.depth_bias.has_value(),
                                     .most_first_frames = settings_.shape.untouched_frames},
                                    [this] { return MakeShapeReplay(); });
  shape_ = std::move(found.replay);
  for (const std::string& note : found.notes) Say(note);
}

void EstimateRun::CheckImages(const std::vector<PlannedRecording>& plan) const {
  force_estimation::ShapeConfig shape = settings_.shape;
  WidenPosePriors(experiment_, &shape);
  RequireImagesFit(
      {.experiment = experiment_,
       .model = &model_,
       .cable_input = ParseCableInput(options_.cable_input),
       .noise = perception::NoiseOf(settings_.perception),
       .pose_name = "T_robot_camera of " +
                    (calibration_.pose ? options_.calibration.string() : "experiment.yaml"),
       .pose_error = {.translation_m = shape.pose_prior_m, .rotation_rad = shape.pose_prior_rad}},
      plan);
}

void EstimateRun::CalibrateMarkerOffsets(const std::vector<PlannedRecording>& plan) {
  const bool needed = std::any_of(plan.begin(), plan.end(), [](const PlannedRecording& planned) {
    return planned.from == EstimateFrom::kMarkers && !planned.recording->reference;
  });
  if (!needed) return;
  tare_ = std::make_unique<MarkerTare>(experiment_, &model_, ParseCableInput(options_.cable_input),
                                       settings_.forces);
  for (const std::string& note : tare_->Choose()) Say(note);
}

ReplayCount EstimateRun::Replay(const PlannedRecording& planned, const TakeEstimate& take) {
  if (planned.from == EstimateFrom::kShape) {
    Shape().TakeNotes();  // of the bias frames
    const ReplayCount count = Shape().Estimate(*planned.recording, take);
    for (const std::string& note : Shape().TakeNotes()) Say(note);
    return count;
  }
  const MarkerReplay::Inputs inputs{.experiment = experiment_,
                                    .model = &model_,
                                    .cable_input = ParseCableInput(options_.cable_input),
                                    .limits = Limits(),
                                    .tare = tare_.get()};
  return MarkerReplay(inputs, settings_.forces, calibration_).Estimate(*planned.recording, take);
}

RestCheck::Known EstimateRun::RestCheckOf(const PlannedRecording& planned) const {
  const bool from_shape = planned.from == EstimateFrom::kShape;
  return {.calibrated = !options_.calibration.empty(),
          .significance = from_shape ? settings_.shape.significance : settings_.forces.significance,
          .gravity_m_s2 = model_.gravity_m_s2()};
}

void EstimateRun::Estimate(const PlannedRecording& planned, bool is_only) {
  const experiment::Recording& recording = *planned.recording;
  ForceSummary summary(recording.name, recording.steady_window_s, recording.loads);
  RecordingComparison comparison(recording.name, truth_ ? &*truth_ : nullptr);
  RestCheck rest(experiment_, recording, RestCheckOf(planned));
  const TakeEstimate take = [&](const force_estimation::ForceEstimate& estimate) {
    table_.Add(recording.name, estimate);
    summary.Add(estimate);
    comparison.Add(estimate, &all_);
    rest.Add(estimate);
    with_result_ += IsResult(estimate.status) ? 1 : 0;
  };
  const ReplayCount count = Replay(planned, take);
  count_ = {.done = count_.done + count.done, .total = count_.total + count.total};
  interrupted_ = interrupted_ || !count.complete();
  nlohmann::ordered_json json = summary.ToJson();
  json["from"] = ToString(planned.from);
  const auto failure = rest.Failure();
  if (failure) json["error"] = *failure;
  if (comparison.has_truth()) json["comparison"] = ToJson(comparison.summary());
  json_->push_back(std::move(json));
  if (!options_.json) {
    fmt::print("{}", summary.ToText());
    if (truth_) PrintComparison(comparison);
    std::fflush(stdout);
  }
  if (failure) Say(*failure);
  rest_has_forces_ = rest_has_forces_ || failure;
  if (options_.plot.empty()) return;
  comparison.Draw(model_.body().name,
                  is_only ? options_.plot : PlotOf(options_.plot, recording.name));
}

void EstimateRun::PrintComparison(const RecordingComparison& comparison) {
  compared_recordings_ += comparison.has_truth() ? 1 : 0;
  fmt::print("  truth: {}\n", comparison.has_truth() ? ToLine(comparison.summary())
                                                     : "the file has none of this recording");
}

int EstimateRun::Finish() {
  interrupted_ = interrupted_ || (stop_requested_ && stop_requested_());
  if (interrupted_ && table_.empty())
    throw app::Interrupted("before the first frame: nothing was written");
  table_.Write(options_.out);
  if (options_.json) fmt::print("{}\n", json_->dump(2));
  if (!options_.json && compared_recordings_ > 1) {
    fmt::print("all recordings: {}\n", ToLine(all_));
  }
  if (interrupted_) {
    throw app::Interrupted(fmt::format("after {} of {} frames: their forces are in {}", count_.done,
                                       count_.total, options_.out.string()));
  }
  if (!options_.json) fmt::print("written to {}\n", options_.out.string());
  return with_result_ > 0 && !rest_has_forces_ ? app::kExitDone : app::kExitFailed;
}

}  // namespace palpate::command
