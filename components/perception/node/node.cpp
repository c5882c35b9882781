// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "components/perception/node/capture_streams.hpp"
#include "components/perception/node/driver_streams.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::perception {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);

dds::NodeSettings NamesOf(const NodeConfig& config) {
  dds::NodeSettings settings = config.dds;
  settings.remap = WithTransports(settings.remap);
  return settings;
}

}  // namespace

PerceptionNode::PerceptionNode(const NodeConfig& config,
                               std::optional<Eigen::Isometry3d> T_robot_camera,
                               FramePerceptionMaker maker, int domain_id, dds::TopicTable table,
                               dds::NodeLog::ProcessLog process_log)
    : config_{config},
      pose_{std::move(T_robot_camera)},
      participant_{dds::ParticipantOf(NamesOf(config), "palpate_perception", domain_id),
                   std::move(table)},
      loop_{participant_},
      overdue_{loop_.AddAlarm([this] { Advance(); })},
      log_{participant_, std::move(process_log)},
      health_{participant_, "perception", Clock::now()},
      meshes_{participant_.CreateReader(dds::kMeshTopic)},
      mesh_states_{participant_.CreateReader(dds::kMeshStateTopic)},
      calibrations_{participant_.CreateReader(dds::kCalibrationTopic)},
      outputs_{participant_, !config.markers.color_rgb.empty()},
      transforms_{participant_},
      streams_{MakeStreams()},
      worker_{
          {.run = MakePerceive(config, std::move(maker)), .on_result = [this] { loop_.Wake(); }}},
      lateness_{config.late_s},
      inputs_{participant_, loop_, log_} {
  AttachReaders();
  ExpectInputs();
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  SendPose();
  if (pose_.T_robot_camera()) return;
  log_.Write(Severity::kWarning, "no camera_pose: frames are segmented without the model's help");
}

std::unique_ptr<CameraStreams> PerceptionNode::MakeStreams() {
  const StreamEvents events{[this] { Advance(); },
                            [this](std::int64_t stamp_ns) { outputs_.Repeat(stamp_ns); }};
  if (config_.camera.source == "capture") {
    return std::make_unique<CaptureStreams>(participant_, loop_, config_.pairing_wait_s, events);
  }
  return std::make_unique<DriverStreams>(participant_, loop_, config_.camera,
                                         config_.pairing_wait_s, config_.max_z_m, events);
}

void PerceptionNode::AttachReaders() {
  loop_.Attach(meshes_, [this] { TakeMesh(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  if (!config_.follow_calibration) return;
  loop_.Attach(calibrations_, [this] { TakeCalibration(); });
}

void PerceptionNode::ExpectInputs() {
  using Kind = dds::InputKind;
  streams_->ExpectInputs(inputs_);
  // The model answers frames, and without a pose its surface is of no use.
  const auto needs_model = [this] { return pose_.T_robot_camera() && !IsSilent(); };
  const std::string model = "palpate-force-estimation";
  inputs_.Expect(meshes_, model, Kind::kLatched, needs_model);
  inputs_.Expect(mesh_states_, model, Kind::kStream, needs_model);
}

void PerceptionNode::TakeMesh() {
  for (const auto& message : meshes_.Take()) {
    const Status status = predictions_.SetMesh(message);
    if (!status.ok()) log_.WarnRepeatedly("/robot/mesh: " + status.message());
  }
  AdoptCalibration();
}

void PerceptionNode::TakeCalibration() {
  for (const auto& message : calibrations_.Take()) {
    const Status status = pose_.Take(message);
    if (status.ok()) continue;
    ++counts_.refused;
    log_.WarnRepeatedly("/calibration refused: " + status.message());
  }
  AdoptCalibration();
}

void PerceptionNode::AdoptCalibration() {
  const Status status = pose_.Adopt(predictions_.mesh_hash());
  if (status.ok()) return SendPose();
  ++counts_.refused;
  log_.WarnRepeatedly("/calibration refused: " + status.message());
}

/// For the tools of ROS 2. One that is not taken is sent again with the next calibration. The
/// frames of a driver have a parent already, so that the robot's is below them.
void PerceptionNode::SendPose() {
  if (!pose_.T_robot_camera()) return;
  const std::int64_t now_ns = participant_.Now_ns();
  const std::string frame = streams_->depth_frame();
  if (config_.camera.source == "capture") {
    (void)transforms_.Set(geometry::kRobotFrame, frame, *pose_.T_robot_camera(), now_ns);
  } else if (!frame.empty()) {
    if (!pose_.is_of_frames()) {
      (void)transforms_.Set(frame, geometry::kRobotFrame, pose_.T_robot_camera()->inverse(),
                            now_ns);
    }
    if (frame == geometry::kCameraDepthOpticalFrame) return;
    (void)transforms_.Set(frame, geometry::kCameraDepthOpticalFrame, Eigen::Isometry3d::Identity(),
                          now_ns);
  }
}

void PerceptionNode::TakeMeshStates() {
  TakeMesh();
  for (const auto& message : mesh_states_.Take()) {
    last_state_ = predictions_.Add(message);
    if (last_state_.ok()) continue;
    ++counts_.refused;
    log_.WarnRepeatedly("/robot/mesh_state refused: " + last_state_.message(),
                        dds::StampText(dds::StampNs(message.header.stamp)));
  }
  Advance();
}

void PerceptionNode::Advance() {
  WorkOnNext();
  while (auto set = streams_->Take(Clock::now())) {
    if (next_) ++counts_.dropped;
    next_ = std::move(set);
    WorkOnNext();
  }
  SetAlarm();
}

void PerceptionNode::WorkOnNext() {
  if (!next_ || worker_.busy() || MustAwaitPrediction()) return;
  Work(*std::exchange(next_, std::nullopt));
}

void PerceptionNode::SetAlarm() {
  overdue_.Clear();
  const auto set = streams_->NextOverdue();
  if (set) overdue_.Set(*set);
  if (!next_ || worker_.busy()) return;
  overdue_.Set(set ? std::min(*set, PredictionOverdue()) : PredictionOverdue());
}

PerceptionNode::Clock::time_point PerceptionNode::PredictionOverdue() const {
  return published_at_ + FromSeconds(config_.await_prediction_s);
}

bool PerceptionNode::MustAwaitPrediction() const {
  if (config_.await_prediction_s == 0.0 || !pose_.T_robot_camera() || !outputs_.last_stamp_ns() ||
      BeginsSequence(*next_)) {
    return false;
  }
  const bool is_there =
      predictions_.has_mesh() && predictions_.IsAnswered(*outputs_.last_stamp_ns());
  return !is_there && Clock::now() < PredictionOverdue();
}

/// Frames of another device, or of one that was started again from the beginning, have nothing to
/// do with those before; those of one that was only reopened (its epoch rose) do.
bool PerceptionNode::BeginsSequence(const FrameSet& set) const {
  if (!last_stamp_ns_) return true;
  const bool back = set.stamp_ns <= *last_stamp_ns_;
  return streams_->device() != last_device_ ||
         (back && set.facts && set.facts->epoch <= last_epoch_);
}

void PerceptionNode::Work(FrameSet set) {
  rgbd::RgbdCamera camera;
  Status status = streams_->Examine(set, &camera);
  if (status.ok()) status = CheckIsNew(set);
  if (status.ok()) status = FollowFrames();
  if (status.ok()) {
    worker_.Start(MakeJob(set, camera));
    return;
  }
  ++counts_.refused;
  log_.WarnRepeatedly("frame refused: " + status.message(), dds::StampText(set.stamp_ns));
  PerceptionJob refused = HeadOf(set);
  refused.outcome.observation.stamp_ns = set.stamp_ns;
  refused.outcome.observation.frame.status = status;
  Publish(refused.outcome, set.taken);
}

/// An image that comes again under a new stamp is no measurement: forces of it would be those of
/// the past.
Status PerceptionNode::CheckIsNew(const FrameSet& set) {
  if (set.facts && set.facts->received_ns != 0) {
    lateness_.Add(NsToSeconds(participant_.clock()->NowOfFrames_ns() - set.facts->received_ns) -
                  SecondsSince(set.taken));
  }
  if (BeginsSequence(set)) repetition_.Forget();
  const std::vector<std::uint16_t>& depths = set.depth->values;
  const std::string_view bytes(reinterpret_cast<const char*>(depths.data()),
                               depths.size() * sizeof(std::uint16_t));
  const auto sum = std::accumulate(depths.begin(), depths.end(), std::uint64_t{0});
  if (!repetition_.IsRepeated(bytes, static_cast<double>(sum))) return Status::Ok();
  return {StatusCode::kStale, streams_->depths().ros_name() +
                                  ": the image is the one before, pixel for pixel, under a new "
                                  "stamp: the camera or its process is stuck"};
}

Status PerceptionNode::FollowFrames() {
  const auto T_robot_camera = streams_->T_robot_depth();
  if (!T_robot_camera) return Status::Ok();
  const bool known = pose_.T_robot_camera().has_value();
  Status status = pose_.FollowFrames(*T_robot_camera, streams_->depth_frame());
  if (!known) {
    log_.Write(Severity::kInfo, "camera pose of /tf and /tf_static, from 'robot' to '" +
                                    streams_->depth_frame() +
                                    "': " + geometry::FormatPose(*T_robot_camera));
  }
  return status;
}

PerceptionJob PerceptionNode::HeadOf(const FrameSet& set) const {
  PerceptionJob job;
  job.outcome.stamp_ns = set.stamp_ns;
  job.outcome.device = streams_->device();
  job.taken = set.taken;
  if (!set.facts) return job;
  job.outcome.frame_counter = set.facts->counter;
  job.outcome.epoch = set.facts->epoch;
  return job;
}

PerceptionJob PerceptionNode::MakeJob(FrameSet& set, const rgbd::RgbdCamera& camera) {
  PerceptionJob job = HeadOf(set);
  job.outcome.picture = rgbd::PictureOf(camera.depth);
  job.images.stamp_ns = set.stamp_ns;
  job.images.depth = std::move(*set.depth);
  if (set.color) job.images.color = std::move(*set.color);
  const bool begins = BeginsSequence(set);
  if (begins || streams_->subpixel_sigma_px() != sigma_px_) {
    job.reset = config_;
    sigma_px_ = streams_->subpixel_sigma_px();
    job.reset->depth_subpixel_px = sigma_px_.value_or(config_.depth_subpixel_px);
  }
  if (begins && last_stamp_ns_) predictions_.Clear();
  if (job.reset || set_setups_ != streams_->setups() || !IsSameCamera(*set_, camera)) {
    job.camera = set_ = camera;
    set_setups_ = streams_->setups();
  }
  if (last_device_ != streams_->device()) {
    last_device_ = streams_->device();
    SendPose();
  }
  last_epoch_ = job.outcome.epoch;
  last_stamp_ns_ = set.stamp_ns;
  const std::optional<Eigen::Isometry3d>& T_robot_camera = pose_.T_robot_camera();
  if (!T_robot_camera) return job;
  job.prediction =
      config_.await_prediction_s > 0.0
          ? predictions_.Last(*T_robot_camera)
          : predictions_.Before(set.stamp_ns, config_.max_prediction_age_s, *T_robot_camera);
  if (job.prediction) job.outcome.prediction_stamp_ns = job.prediction->stamp_ns;
  return job;
}

void PerceptionNode::PublishResults() {
  while (const std::optional<PerceptionResult> result = worker_.TakeResult()) {
    Publish(result->outcome, result->taken);
  }
  Advance();
}

void PerceptionNode::Publish(const FrameOutcome& outcome, Clock::time_point taken) {
  last_status_ = outcome.observation.frame.status;
  outputs_.Publish(outcome, taken);
  published_at_ = Clock::now();
}

void PerceptionNode::ReportHealth() {
  dds::HealthCounts counts = counts_;
  counts.published = outputs_.published();
  counts.received = streams_->received();
  counts.dropped += streams_->dropped() + outputs_.failed();
  counts.latencies_s = outputs_.TakeLatencies();
  health_.Report(
      CurrentStatus(), counts,
      {{"device", streams_->device()},
       {"readers_of_contacts", std::to_string(outputs_.readers())},
       {"writers_of_depth", std::to_string(streams_->depths().matched())},
       {"incompatible_qos", std::to_string(streams_->depths().counters().incompatible_qos)},
       {"waiting_for", inputs_.Waiting()}},
      Clock::now());
  log_.WriteCounted();
}

bool PerceptionNode::IsSilent() const {
  return streams_->received() == 0 || SecondsSince(streams_->last_depth()) > config_.silence_s;
}

Status PerceptionNode::CurrentStatus() {
  const Status& late = lateness_.Judge("frames");
  if (streams_->received() > 0 && IsSilent()) {
    return {StatusCode::kStale, "no depth images for " +
                                    FormatNumber(std::round(SecondsSince(streams_->last_depth()))) +
                                    " s"};
  }
  if (!last_status_.ok()) return last_status_;
  if (!last_state_.ok()) {
    return {last_state_.code(), "/robot/mesh_state refused: " + last_state_.message()};
  }
  return late;
}

}  // namespace palpate::perception
