// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/shape_replay.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/calibration/recording_phase.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::offline {

namespace {

using experiment::Recording;
using force_estimation::ForceEstimate;

}  // namespace

/// One camera in a recording.
struct ShapeReplay::SceneCamera {
  experiment::RgbdSequence images;  ///< without frames: it has none there
  std::variant<Eigen::Isometry3d, experiment::NeedsCalibration> pose;

  static SceneCamera Open(const experiment::Experiment& experiment, const Recording& recording,
                          const ImageOpener& open) {
    SceneCamera camera{.images = {}, .pose = experiment::RobotFromCamera(experiment, recording)};
    const bool has_images = !recording.depth_images.empty() || !recording.clouds.empty();
    if (has_images) camera.images = open(recording);
    return camera;
  }
  bool IsUsed() const { return !images.frames.empty() && HasPose(); }
  bool HasPose() const { return std::holds_alternative<Eigen::Isometry3d>(pose); }
};

namespace {

std::vector<std::int64_t> TimesOf(const experiment::RgbdSequence& images) {
  std::vector<std::int64_t> t_ns;
  for (const experiment::FrameFiles& frame : images.frames) t_ns.push_back(frame.t_ns);
  return t_ns;
}

/// The numbers of the frames to estimate, in their order.
std::vector<std::size_t> ChosenFrames(const std::vector<experiment::JointFrame>& frames,
                                      double rate_Hz) {
  std::vector<double> t_s;
  for (const experiment::JointFrame& frame : frames) {
    t_s.push_back(FrameTime_s(frame.t_ns));
  }
  const std::vector<bool> kept = KeptFrames(t_s, rate_Hz);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

/// A recording and its cameras.
struct ShapeReplay::Scene {
  const Recording& recording;
  std::vector<SceneCamera> cameras = {};            ///< by number
  std::vector<experiment::JointFrame> frames = {};  ///< of the cameras that are used
  force_estimation::CameraPoses poses = {};
  std::string why_blind = {};  ///< where none is used: the reason
};

ShapeReplay::ShapeReplay(const Inputs& inputs, ShapeStream stream)
    : inputs_(inputs),
      names_(experiment::FurtherCameras(inputs.experiment)),
      stream_(std::move(stream)),
      gravity_m_s2_(inputs.model->gravity_m_s2()),
      frames_(names_.size() + 1) {
  for (const std::string& name : names_) {
    of_names_.push_back(experiment::OfCamera(inputs.experiment, name));
  }
}

ShapeReplay::Scene ShapeReplay::Open(const Recording& recording) {
  Scene scene{.recording = recording};
  scene.cameras.push_back(SceneCamera::Open(inputs_.experiment, recording, inputs_.open));
  for (std::size_t k = 0; k < names_.size(); ++k) {
    scene.cameras.push_back(SceneCamera::Open(
        of_names_[k], experiment::OfCamera(inputs_.experiment, recording, names_[k]),
        inputs_.open));
  }
  std::vector<std::vector<std::int64_t>> all_ns, used_ns;
  for (const SceneCamera& camera : scene.cameras) {
    all_ns.push_back(TimesOf(camera.images));
    used_ns.push_back(camera.IsUsed() ? all_ns.back() : std::vector<std::int64_t>());
    scene.poses.push_back(camera.HasPose() ? std::get<Eigen::Isometry3d>(camera.pose)
                                           : Eigen::Isometry3d::Identity());
    if (camera.images.frames.empty() || camera.HasPose()) continue;
    const auto& reason = std::get<experiment::NeedsCalibration>(camera.pose).reason;
    if (scene.why_blind.empty()) scene.why_blind = reason;
  }
  scene.frames = experiment::JoinFrames(used_ns);
  if (scene.frames.empty()) {
    scene.frames = experiment::JoinFrames(all_ns);
  } else {
    scene.why_blind.clear();
  }
  if (scene.frames.empty()) inputs_.open(recording);  // throws what is wrong with it
  return scene;
}

int ShapeReplay::EstimateDepthBias(const Recording& recording) {
  return EstimateDepthBias(recording, Frames{.contact_free = true}).frames;
}

ShapeReplay::FirstFrames ShapeReplay::EstimateDepthBiasFromStart(const Recording& recording,
                                                                 int most) {
  return EstimateDepthBias(recording, {.contact_free = true, .until_contact = true, .most = most});
}

ShapeReplay::FirstFrames ShapeReplay::EstimateDepthBias(const Recording& recording,
                                                        const Frames& frames) {
  const Scene scene = Open(recording);
  if (!scene.why_blind.empty()) return {};
  const ReplayCount count = Run(scene, frames, [](const ForceEstimate&) {});
  bias_recordings_[stream_.epoch()] = &recording;
  return {.frames = count.done, .ends_with_contact = count.ends_with_contact};
}

std::vector<ShapeReplay::BiasRecording> ShapeReplay::JudgeBiasRecordings() const {
  std::vector<BiasRecording> recordings;
  for (const force_estimation::BiasSequence& verdict : stream_.JudgeBiasFrames()) {
    recordings.push_back({bias_recordings_.at(verdict.epoch), verdict});
  }
  return recordings;
}

ReplayCount ShapeReplay::Estimate(const Recording& recording, const TakeEstimate& take) {
  const Scene scene = Open(recording);
  if (scene.why_blind.empty()) return Run(scene, {}, take);
  ForceEstimate refused;
  refused.status = Status(StatusCode::kNoCalibration, scene.why_blind);
  for (const experiment::JointFrame& frame : scene.frames) {
    refused.t_s = FrameTime_s(frame.t_ns);
    take(refused);
  }
  const int count = static_cast<int>(scene.frames.size());
  return {.done = count, .total = count};
}

ReplayCount ShapeReplay::Run(const Scene& scene, const Frames& frames, const TakeEstimate& take) {
  experiment::CheckActuators(scene.recording, inputs_.model->CableNames(),
                             inputs_.model->ChamberNames());
  const Eigen::Matrix3d R_base = experiment::BaseRotation(scene.recording);
  inputs_.model->SetGravity(R_base.transpose() * gravity_m_s2_);
  std::vector<std::optional<rgbd::RgbdCamera>> cameras;
  for (const SceneCamera& camera : scene.cameras) {
    cameras.push_back(camera.IsUsed() ? std::optional(camera.images.camera) : std::nullopt);
  }
  stream_.Open(cameras, scene.poses);
  if (inputs_.expect_posture) ExpectPosture(scene);
  std::vector<std::size_t> chosen =
      ChosenFrames(scene.frames, frames.contact_free ? 0.0 : inputs_.limits.rate_Hz);
  chosen.resize(std::min(chosen.size(), At(frames.most)));
  ReplayCount count{.done = 0, .total = static_cast<int>(chosen.size())};
  inputs_.limits.Report(0, count.total);
  for (const std::size_t i : chosen) {
    if (inputs_.limits.StopRequested()) break;
    const perception::JointObservation& observation = Perceive(scene, scene.frames[i]);
    count.ends_with_contact = frames.until_contact && !observation.contacts.empty();
    if (count.ends_with_contact) break;
    take(stream_.Estimate(InputsAt(scene, observation.stamp_ns, frames.contact_free)));
    inputs_.limits.Report(++count.done, count.total);
  }
  inputs_.model->SetGravity(gravity_m_s2_);
  chosen.resize(At(count.done));
  NoteMissing(scene, chosen);
  return count;
}

/// Of an experiment with several cameras.
void ShapeReplay::NoteMissing(const Scene& scene, const std::vector<std::size_t>& frames) {
  for (std::size_t k = 0; k < scene.cameras.size() && scene.cameras.size() > 1; ++k) {
    const std::string camera = scene.recording.name + ": " +
                               (k == 0 ? "the first camera" : "camera '" + names_[k - 1] + "'");
    if (!scene.cameras[k].images.frames.empty() && !scene.cameras[k].HasPose()) {
      notes_.push_back(camera + " is not used: its pose is not known");
      continue;
    }
    const auto missing = std::count_if(frames.begin(), frames.end(), [&](std::size_t i) {
      return !scene.frames[i].frames[k].has_value();
    });
    if (missing == 0) continue;
    notes_.push_back(camera + " has no image in " + std::to_string(missing) + " of " +
                     std::to_string(frames.size()) + " frames: the other cameras were used");
  }
}

/// The equilibrium under the commands and known loads of the first frame. Where none is found, the
/// shape of the frame before stays.
void ShapeReplay::ExpectPosture(const Scene& scene) {
  robot::RobotModel& model = *inputs_.model;
  const double t_s = FrameTime_s(scene.frames.front().t_ns);
  const auto cables = force_estimation::CablesAt(scene.recording, model, inputs_.cable_input, t_s);
  fem::StaticState state = model.RestState();
  const Status status =
      model.Solve(cables, calibration::LoadsAt(scene.recording, model, t_s), &state).status;
  if (status.ok()) stream_.Expect(state.x_m);
}

FrameInputs ShapeReplay::InputsAt(const Scene& scene, std::int64_t t_ns, bool contact_free) const {
  const double t_s = FrameTime_s(t_ns);
  return {.cables =
              force_estimation::CablesAt(scene.recording, *inputs_.model, inputs_.cable_input, t_s),
          .loads = force_estimation::SitesOfLoads(scene.recording.loads, t_s),
          .contact_free = contact_free};
}

const perception::JointObservation& ShapeReplay::Perceive(const Scene& scene,
                                                          const experiment::JointFrame& joint) {
  std::vector<const rgbd::RgbdFrame*> images(scene.cameras.size());
  for (std::size_t k = 0; k < images.size(); ++k) {
    if (!joint.frames[k]) continue;
    scene.cameras[k].images.Read(*joint.frames[k], &frames_[k]);
    frames_[k].stamp_ns = joint.t_ns;
    images[k] = &frames_[k];
  }
  return stream_.Perceive(joint.t_ns, images);
}

}  // namespace palpate::offline
