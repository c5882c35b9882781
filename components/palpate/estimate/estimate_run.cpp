// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/compare/comparison_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/images/open_images.hpp"
#include "components/palpate/robot_scene.hpp"
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
  offline::TakePoses(calibration, experiment);
  offline::CorrectPressures(calibration, experiment);
  return calibration;
}

offline::BiasFrom BiasFromOf(const std::string& bias_frames) {
  if (bias_frames == "first") return offline::BiasFrom::kFirst;
  return bias_frames == "none" ? offline::BiasFrom::kNone : offline::BiasFrom::kRecordings;
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
      model_(*model),
      stop_requested_(std::move(stop_requested)),
      progress_(model->body()),
      replay_(
          {.experiment = *experiment,
           .model = model,
           .calibration = ApplyCalibration(options.calibration, model, experiment),
           .calibration_name = options.calibration.string(),
           .cable_input = ParseCableInput(options.cable_input),
           .bias = BiasFromOf(options.bias_frames),
           .limits = {.rate_Hz = options.rate_Hz,
                      .stop_requested = stop_requested_,
                      .progress = [this](int done, int total) { progress_.Update(done, total); }},
           .open = OpenImages,
           .note = [this](const std::string& note) { Say(note); }},
          settings),
      json_(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::array())) {
  if (options.answer.empty()) return;
  truth_ = ReadKnownTruth(options.answer, *experiment, BodyDiagonal_m(model->body()));
  if (options.json) return;
  fmt::print("compared with {}: forces of {:.3g} N or more, within {:.3g} mm\n",
             options.answer.string(), truth_->rules.smallest_N, 1e3 * truth_->rules.same_place_m);
}

EstimateRun::~EstimateRun() = default;

void EstimateRun::Say(const std::string& note) {
  progress_.End();
  fmt::print(stderr, "palpate estimate: {}\n", note);
}

void EstimateRun::Prepare(const std::vector<offline::PlannedRecording>& plan) {
  replay_.Prepare(plan);
  progress_.End();
}

void EstimateRun::Estimate(const offline::PlannedRecording& planned, bool is_only) {
  const experiment::Recording& recording = *planned.recording;
  ForceSummary summary(recording.name, recording.steady_window_s, recording.loads);
  RecordingComparison comparison(recording.name, truth_ ? &*truth_ : nullptr);
  const offline::TakeEstimate take = [&](const force_estimation::ForceEstimate& estimate) {
    table_.Add(recording.name, estimate);
    summary.Add(estimate);
    comparison.Add(estimate, &all_);
    with_result_ += force_estimation::IsUsable(estimate.status) ? 1 : 0;
  };
  const auto [count, failure] = replay_.Estimate(planned, take);
  progress_.End();
  count_ = {.done = count_.done + count.done, .total = count_.total + count.total};
  interrupted_ = interrupted_ || !count.complete();
  nlohmann::ordered_json json = summary.ToJson();
  json["from"] = offline::ToString(planned.from);
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
