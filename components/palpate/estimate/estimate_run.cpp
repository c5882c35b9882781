// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/pipeline/shape_pipeline.hpp"
#include "components/palpate/estimate/marker_replay.hpp"
#include "components/palpate/estimate/replay_perception.hpp"
#include "components/palpate/estimate/rest_check.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

/// Applies the calibration to the model and the experiment, and returns it.
robot::CalibrationFile ApplyCalibration(const std::filesystem::path& file, robot::RobotModel* model,
                                        experiment::Experiment* experiment) {
  if (file.empty()) {
    fmt::print(stderr, "palpate estimate: no --calibration: the moduli of the robot file hold\n");
    return {};
  }
  auto calibration = robot::ReadCalibrationFile(file, app::LoadYaml);
  robot::ApplyCalibration(calibration, model);
  if (calibration.pose) experiment->T_robot_camera = calibration.pose->T_robot_camera;
  return calibration;
}

bool IsResult(const Status& status) {
  return status.ok() || status.code() == StatusCode::kNoContact;
}

}  // namespace

EstimateRun::EstimateRun(const EstimateOptions& options, const EstimateSettings& settings,
                         experiment::Experiment* experiment, robot::RobotModel* model)
    : options_(options),
      settings_(settings),
      experiment_(*experiment),
      model_(*model),
      calibration_(ApplyCalibration(options.calibration, model, experiment)),
      json_(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::array())) {}

EstimateRun::~EstimateRun() = default;

void EstimateRun::Say(const std::string& note) {
  fmt::print(stderr, "palpate estimate: {}\n", note);
}

ShapeReplay& EstimateRun::Shape() {
  if (shape_) return *shape_;
  for (const auto& site : force_estimation::ParseContactSites(settings_.forces.contacts)) {
    if (site.direction.isZero(0.0)) continue;
    Say("the direction of contact '" + site.name + "' is used with markers only");
  }
  ReplayPerception perception = MakeReplayPerception(settings_.perception, calibration_.depth_bias);
  force_estimation::ShapeConfig shape = settings_.shape;
  if (options_.bias_frames != "first") shape.untouched_frames = 0;
  auto pipeline = std::make_unique<force_estimation::ShapePipeline>(model_, settings_.forces, shape,
                                                                    calibration_);
  const ShapeReplay::Inputs inputs{.experiment = experiment_,
                                   .model = &model_,
                                   .cable_input = ParseCableInput(options_.cable_input)};
  shape_ = std::make_unique<ShapeReplay>(inputs, std::move(perception), std::move(pipeline));
  return *shape_;
}

void EstimateRun::EstimateDepthBias(const std::vector<PlannedRecording>& plan) {
  const bool from_shape = std::any_of(
      plan.begin(), plan.end(),
      [](const PlannedRecording& planned) { return planned.from == EstimateFrom::kShape; });
  if (!from_shape || options_.bias_frames != "recordings") return;
  int frames = 0;
  for (const experiment::Recording* recording : BiasRecordings(experiment_)) {
    frames += Shape().EstimateDepthBias(*recording);
  }
  Say(frames > 0 ? fmt::format("depth bias estimated from {} contact-free frames", frames)
                 : "no contact-free recording (kind rest, ramp, hold, ...) has images and a camera "
                   "pose: the depth bias stays unknown");
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

void EstimateRun::Estimate(const PlannedRecording& planned) {
  const experiment::Recording& recording = *planned.recording;
  ForceSummary summary(recording.name, recording.steady_window_s);
  const bool from_shape = planned.from == EstimateFrom::kShape;
  RestCheck rest(
      experiment_, recording,
      {.calibrated = !options_.calibration.empty(),
       .significance = from_shape ? settings_.shape.significance : settings_.forces.significance,
       .gravity_m_s2 = model_.gravity_m_s2()});
  const TakeEstimate take = [&](const force_estimation::ForceEstimate& estimate) {
    table_.Add(recording.name, estimate);
    summary.Add(estimate);
    rest.Add(estimate);
    with_result_ += IsResult(estimate.status) ? 1 : 0;
  };
  if (from_shape) {
    Shape().Estimate(recording, take);
  } else {
    const MarkerReplay::Inputs inputs{.experiment = experiment_,
                                      .model = &model_,
                                      .cable_input = ParseCableInput(options_.cable_input),
                                      .tare = tare_.get()};
    MarkerReplay(inputs, settings_.forces, calibration_).Estimate(recording, take);
  }
  nlohmann::ordered_json json = summary.ToJson();
  json["from"] = ToString(planned.from);
  const auto failure = rest.Failure();
  if (failure) json["error"] = *failure;
  json_->push_back(std::move(json));
  if (!options_.json) {
    fmt::print("{}", summary.ToText());
    std::fflush(stdout);
  }
  if (failure) Say(*failure);
  rest_has_forces_ = rest_has_forces_ || failure;
}

int EstimateRun::Finish() {
  table_.Write(options_.out);
  if (options_.json) {
    fmt::print("{}\n", json_->dump(2));
  } else {
    fmt::print("written to {}\n", options_.out.string());
  }
  return with_result_ > 0 && !rest_has_forces_ ? app::kExitDone : app::kExitFailed;
}

}  // namespace palpate::command
