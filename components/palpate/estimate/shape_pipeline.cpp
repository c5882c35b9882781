// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/shape_pipeline.hpp"

#include <optional>
#include <utility>
#include <variant>

#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/perception/predicted_surface.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::command {

namespace {

using experiment::Recording;
using force_estimation::ForceEstimate;

constexpr double kNsPerSecond = 1e9;

void RefuseEach(const experiment::RgbdSequence& images, const std::string& reason,
                const TakeEstimate& take) {
  ForceEstimate refused;
  refused.status = Status(StatusCode::kNoCalibration, reason);
  for (const experiment::FrameFiles& frame : images.frames) {
    refused.t_s = static_cast<double>(frame.t_ns) / kNsPerSecond;
    take(refused);
  }
}

}  // namespace

/// A recording and how its camera stands.
struct ShapePipeline::Scene {
  const Recording& recording;
  experiment::RgbdSequence images;
  Eigen::Isometry3d T_robot_camera;
};

ShapePipeline::ShapePipeline(const Inputs& inputs, ShapeSenses senses)
    : inputs_(inputs),
      senses_(std::move(senses)),
      known_contacts_(inputs.model->body()),
      triangles_(inputs.model->body().boundary.DrawnTriangles()),
      gravity_m_s2_(inputs.model->gravity_m_s2()) {}

int ShapePipeline::Teach(const Recording& recording) {
  const auto pose = experiment::RobotFromCamera(inputs_.experiment, recording);
  if (!std::holds_alternative<Eigen::Isometry3d>(pose)) return 0;
  const int before = frames_;
  Run({recording, experiment::OpenRecordingImages(recording, app::LoadYaml),
       std::get<Eigen::Isometry3d>(pose)},
      true, [](const ForceEstimate&) {});
  return frames_ - before;
}

void ShapePipeline::Estimate(const Recording& recording, const TakeEstimate& take) {
  auto images = experiment::OpenRecordingImages(recording, app::LoadYaml);
  const auto pose = experiment::RobotFromCamera(inputs_.experiment, recording);
  if (const auto* missing = std::get_if<experiment::NeedsCalibration>(&pose)) {
    RefuseEach(images, missing->reason, take);
    return;
  }
  Run({recording, std::move(images), std::get<Eigen::Isometry3d>(pose)}, false, take);
}

void ShapePipeline::Run(const Scene& scene, bool untouched, const TakeEstimate& take) {
  experiment::CheckCables(scene.recording, inputs_.model->CableNames());
  const Eigen::Matrix3d R_base = experiment::BaseRotation(scene.recording);
  inputs_.model->SetGravity(R_base.transpose() * gravity_m_s2_);
  senses_.open_camera(scene.images.camera);
  ++epoch_;
  ProgressLine progress("frames", static_cast<int>(scene.images.frames.size()));
  rgbd::RgbdFrame frame;
  for (std::size_t i = 0; i < scene.images.frames.size(); ++i) {
    scene.images.Read(i, &frame);
    frame.stamp_ns = scene.images.frames[i].t_ns;
    take(Step(scene, frame, untouched));
    ++frames_;
    progress.Update(static_cast<int>(i) + 1);
  }
  inputs_.model->SetGravity(gravity_m_s2_);
}

const ForceEstimate& ShapePipeline::Step(const Scene& scene, const rgbd::RgbdFrame& frame,
                                         bool untouched) {
  std::optional<perception::PredictedSurface> predicted;
  if (nodes_m_.cols() > 0) {
    predicted = perception::MakePredictedSurface(nodes_m_, triangles_, scene.T_robot_camera);
  }
  const perception::Observation& seen = senses_.look(frame, predicted ? &*predicted : nullptr);
  force_estimation::ShapeFrame shape = MakeShapeFrame(seen, scene.T_robot_camera);
  shape.t_s = static_cast<double>(frame.stamp_ns) / kNsPerSecond;
  shape.cables = CablesAt(scene.recording, shape.t_s);
  shape.contacts = force_estimation::KnownBeforeSeen(KnownContactsAt(scene.recording, shape.t_s),
                                                     shape.contacts);
  const Status looked = seen.frame.status;
  shape.epoch = epoch_;
  shape.untouched = untouched || frames_seen_ < inputs_.first_untouched;
  frames_seen_ += looked.ok() ? 1 : 0;
  const ForceEstimate& estimate = senses_.feel(shape);
  if (force_estimation::PredictsShape(estimate)) {
    nodes_m_ = Eigen::Map<const Eigen::Matrix3Xd>(estimate.x_m.data(), 3, estimate.x_m.size() / 3)
                   .cast<float>();
  }
  if (looked.ok() || estimate.status.code() != StatusCode::kNoRobotSeen) return estimate;
  unseen_ = estimate;
  unseen_.status = looked;
  return unseen_;
}

std::vector<robot::CableCommand> ShapePipeline::CablesAt(const Recording& recording,
                                                         double t_s) const {
  using Quantity = experiment::CableQuantity;
  std::vector<robot::CableCommand> commands;
  for (int c = 0; c < inputs_.model->CableCount(); ++c) {
    const std::string& cable = inputs_.model->body().cables[static_cast<std::size_t>(c)].name;
    commands.push_back(inputs_.model->CommandFor(
        c, experiment::CableInputAt(recording, cable, Quantity::kDisplacement, t_s),
        experiment::CableInputAt(recording, cable, Quantity::kTension, t_s), inputs_.cable_input));
  }
  return commands;
}

std::vector<force_estimation::SeenContact> ShapePipeline::KnownContactsAt(
    const Recording& recording, double t_s) const {
  const Eigen::Matrix3Xd nodes_m = nodes_m_.cast<double>();
  const Eigen::Map<const Eigen::VectorXd> x_m(nodes_m.data(), nodes_m.size());
  return known_contacts_.At(
      inputs_.sites.empty() ? force_estimation::SitesOfLoads(recording.loads, t_s) : inputs_.sites,
      x_m);
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
