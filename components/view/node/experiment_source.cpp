// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/experiment_source.hpp"

#include <algorithm>
#include <cmath>

#include "components/view/experiment/near_points.hpp"
#include "components/view/frames/binary_frame.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/camera_messages.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::view {

namespace {

constexpr double kNsPerSecond = 1e9;

std::int64_t StampOf(const ExperimentInstant& instant) {
  return std::llround(kNsPerSecond * instant.t_s);
}

dds::Message<idl::palpate_msgs::ForceArray> ForcesOf(const std::vector<ShownForce>& forces,
                                                     std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::Resize(message->forces, forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const ShownForce& from = forces[i];
    auto& to = message->forces._buffer[i];
    dds::SetText(to.name, from.name);
    dds::SetVector(to.position_m, from.position_m);
    dds::SetVector(to.force_n, from.force_N.value_or(Eigen::Vector3d::Constant(std::nan(""))));
    Eigen::Matrix3d::Map(to.covariance_n2) = from.covariance_N2;
    to.ci95_n = from.ci95_N;
    to.location_ci95_m = from.location_ci95_m;
    Eigen::Matrix3d::Map(to.location_covariance_m2) = from.location_covariance_m2;
    dds::SetText(to.status, from.status);
    dds::SetText(to.reason, from.reason);
  }
  return message;
}

dds::Message<idl::sensor_msgs::JointState> CablesOf(
    const std::vector<robot::ActuatorTraits>& actuators, const ExperimentFrame& frame,
    std::int64_t stamp_ns) {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::Resize(message->name, actuators.size());
  dds::Resize(message->position, actuators.size());
  dds::Resize(message->effort, actuators.size());
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    const robot::ActuatorState& state = frame.cables[a];
    const robot::ActuatorTraits& traits = actuators[a];
    dds::SetText(message->name._buffer[a], traits.name);
    message->position._buffer[a] = traits.ReportedDisplacement(state.displacement_m);
    message->effort._buffer[a] =
        frame.measured_tension_N[a].value_or(traits.ReportedForce(state.tension_N));
  }
  return message;
}

std::size_t NewestNotAfter(const experiment::RgbdSequence& sequence, std::int64_t t_ns) {
  const auto next = std::upper_bound(
      sequence.frames.begin(), sequence.frames.end(), t_ns,
      [](std::int64_t t, const experiment::FrameFiles& frame) { return t < frame.t_ns; });
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - sequence.frames.begin(), 1) - 1);
}

}  // namespace

ExperimentSource::ExperimentSource(const ShownExperiment& shown, KnownRobot& robot, PageFeed* feed)
    : shown_(shown),
      robot_(robot),
      feed_(feed),
      frames_(shown.experiment, robot, shown.forces ? &*shown.forces : nullptr) {
  Start();
}

void ExperimentSource::Start() {
  const robot::RobotBody& body = robot_.body();
  feed_->Take(*dds::ToMesh({body.name, body.mesh_hash, body.mesh.nodes_m, body.mesh.cells,
                            body.boundary.DrawnTriangles()},
                           StampOf(frames_.instants().front())));
  Show(frames_.instants().front());
  shown_instant_ = 0;
}

/// Of the samples that are due only the newest is shown: the model is solved for each.
void ExperimentSource::Advance(std::int64_t now_ns) {
  const double elapsed_s = last_ns_ ? NsToSeconds(now_ns - *last_ns_) : 0.0;
  last_ns_ = now_ns;
  if (!paused_) position_s_ = std::min(position_s_ + rate_ * elapsed_s, duration_s());
  const auto& instants = frames_.instants();
  const auto next = std::upper_bound(
      instants.begin(), instants.end(), position_s_,
      [](double s, const ExperimentInstant& instant) { return s < instant.position_s; });
  const auto due = static_cast<std::size_t>(next - instants.begin()) - 1;
  if (shown_instant_ != due) {
    Show(instants[due]);
    shown_instant_ = due;
  }
  if (position_s_ >= duration_s()) paused_ = true;
}

void ExperimentSource::Play(const PlayRequest& request) {
  paused_ = request.paused;
  rate_ = request.rate;
  if (!paused_ && position_s_ >= duration_s()) position_s_ = 0.0;
}

void ExperimentSource::Seek(const SeekRequest& request) {
  position_s_ = std::clamp(request.position_s, 0.0, duration_s());
  feed_->Forget();
}

void ExperimentSource::Show(const ExperimentInstant& instant) {
  const ExperimentFrame frame = frames_.FrameAt(instant);
  ++counter_;
  ShowShape(instant, frame);
  ShowForces(instant, frame);
  ShowImages(instant);
}

void ExperimentSource::ShowShape(const ExperimentInstant& instant, const ExperimentFrame& frame) {
  const std::int64_t stamp_ns = StampOf(instant);
  feed_->Take(*CablesOf(robot_.model().traits(), frame, stamp_ns));
  ShownMarkers markers{.stamp_ns = stamp_ns,
                       .names = robot_.model().MarkerNames(),
                       .measured_m = frame.measured_m,
                       .model_m = frame.model_m};
  markers.sigma_m = frames_.sigma_m(instant)
                        .value_or(Eigen::Vector3d::Zero())
                        .replicate(1, frame.measured_m.cols());
  if (frame.measured_m.cols() > 0) feed_->TakeMarkers(std::move(markers));
  auto state = dds::ToMeshState(frame.x_m, robot_.body().mesh_hash, stamp_ns);
  state->counter = counter_;
  dds::SetText(state->status, ToString(frame.status.code()));
  feed_->Take(*state);
  if (frame.seen == 0 || !frame.status.ok()) return;
  dds::Message<idl::palpate_msgs::ModelGap> gap;
  dds::SetHeader(gap->header, stamp_ns, geometry::kRobotFrame);
  gap->counter = counter_;
  gap->residual_rms_m = frame.residual_rms_m;
  gap->noise_rms_m = frame.noise_rms_m;
  gap->sample_count = static_cast<std::uint32_t>(frame.seen);
  feed_->Take(*gap);
}

void ExperimentSource::ShowForces(const ExperimentInstant& instant, const ExperimentFrame& frame) {
  const std::int64_t stamp_ns = StampOf(instant);
  feed_->TakeTruth(*ForcesOf(frame.known, stamp_ns));
  if (frame.estimated == nullptr) return;
  auto message = ForcesOf(frame.estimated->forces, stamp_ns);
  message->counter = counter_;
  dds::SetText(message->status, frame.estimated->status);
  feed_->Take(*message);
}

void ExperimentSource::ShowImages(const ExperimentInstant& instant) {
  const auto found = shown_.sequences.find(instant.recording);
  if (found == shown_.sequences.end()) return;
  const experiment::RgbdSequence& sequence = found->second;
  const std::size_t image = NewestNotAfter(sequence, StampOf(instant));
  if (shown_sequence_ == &sequence && shown_image_ == image) return;
  try {
    sequence.Read(image, &image_);
  } catch (const InputError& error) {
    ++unread_;
    return feed_->Warn("image", {StatusCode::kInvalidInput, error.what()});
  }
  ShowImage(instant, sequence, image);
  shown_sequence_ = &sequence;
  shown_image_ = image;
}

void ExperimentSource::ShowImage(const ExperimentInstant& instant,
                                 const experiment::RgbdSequence& sequence, std::size_t image) {
  const std::int64_t stamp_ns = sequence.frames[image].t_ns;
  const std::string depth_frame(geometry::kCameraDepthOpticalFrame);
  if (image_.color.width_px > 0) {
    dds::ImageMessage color("rgb8", 3);
    feed_->TakeColorImage(color.Of(image_.color, stamp_ns, dds::ColorFrameId(sequence.camera)));
  }
  if (image_.depth.width_px == 0) return;
  feed_->Take(*dds::ToCameraSetup(sequence.camera, {}, stamp_ns));
  dds::ImageMessage depth("16UC1", 2);
  feed_->TakeDepthImage(depth.Of(image_.depth, stamp_ns, depth_frame));
  const auto pose = experiment::RobotFromCamera(shown_.experiment, frames_.RecordingOf(instant));
  if (const auto* T_robot_camera = std::get_if<Eigen::Isometry3d>(&pose)) {
    feed_->TakePoints(
        NearPoints(image_.depth, sequence.camera, *T_robot_camera, robot_.body().mesh.nodes_m),
        stamp_ns);
  }
}

OutMessage ExperimentSource::State() const {
  const ExperimentInstant& instant = frames_.instants()[shown_instant_.value_or(0)];
  return TextMessage("player", JsonText({{"kind", "player"},
                                         {"duration_s", duration_s()},
                                         {"position_s", position_s_},
                                         {"rate", rate_},
                                         {"paused", paused_},
                                         {"unread", unread_},
                                         {"part", frames_.RecordingOf(instant).name}}));
}

}  // namespace palpate::view
