// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/shape_replay.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/calibration/recording_phase.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/palpate/images/open_images.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/perception/predicted_surface.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::command {

namespace {

using experiment::Recording;
using force_estimation::ForceEstimate;

constexpr double kNsPerSecond = 1e9;

/// The numbers of the frames to estimate, in their order.
std::vector<std::size_t> ChosenFrames(const experiment::RgbdSequence& images, double rate_Hz) {
  std::vector<double> t_s;
  for (const experiment::FrameFiles& frame : images.frames) {
    t_s.push_back(static_cast<double>(frame.t_ns) / kNsPerSecond);
  }
  const std::vector<bool> kept = KeptFrames(t_s, rate_Hz);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) chosen.push_back(i);
  }
  return chosen;
}

ReplayCount RefuseEach(const experiment::RgbdSequence& images, const std::string& reason,
                       const TakeEstimate& take) {
  ForceEstimate refused;
  refused.status = Status(StatusCode::kNoCalibration, reason);
  for (const experiment::FrameFiles& frame : images.frames) {
    refused.t_s = static_cast<double>(frame.t_ns) / kNsPerSecond;
    take(refused);
  }
  const int count = static_cast<int>(images.frames.size());
  return {.done = count, .total = count};
}

}  // namespace

/// A recording and its camera's pose.
struct ShapeReplay::Scene {
  const Recording& recording;
  experiment::RgbdSequence images;
  Eigen::Isometry3d T_robot_camera;
};

ShapeReplay::ShapeReplay(const Inputs& inputs, ReplayPerception perception,
                         std::unique_ptr<force_estimation::ShapePipeline> pipeline)
    : inputs_(inputs),
      perception_(std::move(perception)),
      pipeline_(std::move(pipeline)),
      triangles_(inputs.model->body().boundary.DrawnTriangles()),
      gravity_m_s2_(inputs.model->gravity_m_s2()) {}

int ShapeReplay::EstimateDepthBias(const Recording& recording) {
  return EstimateDepthBias(recording, Frames{.contact_free = true}).frames;
}

ShapeReplay::FirstFrames ShapeReplay::EstimateDepthBiasFromStart(const Recording& recording,
                                                                 int most) {
  return EstimateDepthBias(recording, {.contact_free = true, .until_contact = true, .most = most});
}

ShapeReplay::FirstFrames ShapeReplay::EstimateDepthBias(const Recording& recording,
                                                        const Frames& frames) {
  const auto pose = experiment::RobotFromCamera(inputs_.experiment, recording);
  if (!std::holds_alternative<Eigen::Isometry3d>(pose)) return {};
  const ReplayCount count =
      Run({recording, OpenImages(recording), std::get<Eigen::Isometry3d>(pose)}, frames,
          [](const ForceEstimate&) {});
  bias_recordings_[epoch_] = &recording;
  return {.frames = count.done, .ends_with_contact = count.ends_with_contact};
}

std::vector<ShapeReplay::BiasRecording> ShapeReplay::JudgeBiasRecordings() const {
  std::vector<BiasRecording> recordings;
  for (const force_estimation::BiasSequence& verdict : pipeline_->JudgeBiasFrames()) {
    recordings.push_back({bias_recordings_.at(verdict.epoch), verdict});
  }
  return recordings;
}

ReplayCount ShapeReplay::Estimate(const Recording& recording, const TakeEstimate& take) {
  auto images = OpenImages(recording);
  const auto pose = experiment::RobotFromCamera(inputs_.experiment, recording);
  if (const auto* missing = std::get_if<experiment::NeedsCalibration>(&pose)) {
    return RefuseEach(images, missing->reason, take);
  }
  return Run({recording, std::move(images), std::get<Eigen::Isometry3d>(pose)}, {}, take);
}

ReplayCount ShapeReplay::Run(const Scene& scene, const Frames& frames, const TakeEstimate& take) {
  experiment::CheckActuators(scene.recording, inputs_.model->CableNames(),
                             inputs_.model->ChamberNames());
  const Eigen::Matrix3d R_base = experiment::BaseRotation(scene.recording);
  inputs_.model->SetGravity(R_base.transpose() * gravity_m_s2_);
  perception_.set_camera(scene.images.camera);
  ++epoch_;
  if (inputs_.expect_posture) ExpectPosture(scene);
  std::vector<std::size_t> chosen =
      ChosenFrames(scene.images, frames.contact_free ? 0.0 : inputs_.limits.rate_Hz);
  chosen.resize(std::min(chosen.size(), At(frames.most)));
  ReplayCount count{.done = 0, .total = static_cast<int>(chosen.size())};
  ProgressLine progress("frames", count.total);
  progress.SetAdvice(AdviceWhereSlow(inputs_.model->body()));
  rgbd::RgbdFrame frame;
  for (const std::size_t i : chosen) {
    if (inputs_.limits.StopRequested()) break;
    scene.images.Read(i, &frame);
    frame.stamp_ns = scene.images.frames[i].t_ns;
    const perception::Observation& observation = Perceive(scene, frame);
    count.ends_with_contact = frames.until_contact && !observation.contacts.empty();
    if (count.ends_with_contact) break;
    take(Step(scene, observation, frames.contact_free));
    progress.Update(++count.done);
  }
  inputs_.model->SetGravity(gravity_m_s2_);
  return count;
}

/// The equilibrium under the commands and known loads of the first frame. Where none is found, the
/// shape of the frame before stays.
void ShapeReplay::ExpectPosture(const Scene& scene) {
  robot::RobotModel& model = *inputs_.model;
  const double t_s = static_cast<double>(scene.images.frames.front().t_ns) / kNsPerSecond;
  const auto cables = force_estimation::CablesAt(scene.recording, model, inputs_.cable_input, t_s);
  fem::StaticState state = model.RestState();
  const Status status =
      model.Solve(cables, calibration::LoadsAt(scene.recording, model, t_s), &state).status;
  if (status.ok()) pipeline_->Expect(state.x_m);
}

const ForceEstimate& ShapeReplay::Step(const Scene& scene,
                                       const perception::Observation& observation,
                                       bool contact_free) {
  const double t_s = static_cast<double>(observation.stamp_ns) / kNsPerSecond;
  force_estimation::PerceivedShape shape;
  shape.frame = MakeShapeFrame(observation, scene.T_robot_camera);
  shape.frame.t_s = t_s;
  shape.frame.cables =
      force_estimation::CablesAt(scene.recording, *inputs_.model, inputs_.cable_input, t_s);
  shape.frame.epoch = epoch_;
  shape.frame.untouched = contact_free;
  shape.perception = observation.frame.status;
  shape.loads = force_estimation::SitesOfLoads(scene.recording.loads, t_s);
  const ForceEstimate& estimate = pipeline_->Update(std::move(shape)).estimate;
  pipeline_->PrepareNext();
  return estimate;
}

const perception::Observation& ShapeReplay::Perceive(const Scene& scene,
                                                     const rgbd::RgbdFrame& frame) {
  const Eigen::Matrix3Xf nodes_m = pipeline_->PredictedNodes_m();
  std::optional<perception::PredictedSurface> predicted;
  if (nodes_m.cols() > 0) {
    predicted = perception::MakePredictedSurface(nodes_m, triangles_, scene.T_robot_camera);
  }
  return perception_.update(frame, predicted ? &*predicted : nullptr);
}

force_estimation::ShapeFrame MakeShapeFrame(const perception::Observation& observation,
                                            const Eigen::Isometry3d& T_robot_camera) {
  force_estimation::ShapeFrame frame;
  frame.cloud = observation.frame.robot;
  frame.T_robot_camera = T_robot_camera;
  for (const perception::DetectedContact& contact : observation.contacts) {
    frame.contacts.push_back(
        force_estimation::InRobotFrame({contact.name, contact.position_m, contact.covariance_m2,
                                        contact.extent_m, contact.point_count},
                                       T_robot_camera));
  }
  return frame;
}

}  // namespace palpate::command
