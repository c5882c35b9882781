// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::perception {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);

template <typename Image>
bool HasSizeOf(const Image& image, const rgbd::CameraModel& camera) {
  return image.width_px == camera.width_px && image.height_px == camera.height_px;
}

template <typename Image>
Status WrongSize(const std::string& what, const Image& image, const rgbd::CameraModel& camera) {
  return {StatusCode::kInvalidInput,
          "a " + what + " image of " + std::to_string(image.width_px) + " x " +
              std::to_string(image.height_px) + " pixels from a camera of " +
              std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px)};
}

}  // namespace

PerceptionNode::PerceptionNode(const NodeConfig& config,
                               std::optional<Eigen::Isometry3d> T_robot_camera,
                               FramePerceptionMaker maker, int domain_id, dds::TopicTable table,
                               dds::NodeLog::ProcessLog process_log)
    : config_{config},
      pose_{std::move(T_robot_camera)},
      participant_{dds::ParticipantOf(config.dds, "palpate_perception", domain_id),
                   std::move(table)},
      loop_{participant_},
      overdue_{loop_.AddAlarm([this] { Advance(); })},
      log_{participant_, std::move(process_log)},
      health_{participant_, "perception", Clock::now()},
      setups_{participant_.CreateReader(dds::kCameraSetupTopic)},
      depth_lenses_{participant_.CreateReader(dds::kDepthCameraInfoTopic)},
      color_lenses_{participant_.CreateReader(dds::kColorCameraInfoTopic)},
      depths_{participant_.CreateReader(dds::kDepthImageTopic)},
      colors_{participant_.CreateReader(dds::kColorImageTopic)},
      infos_{participant_.CreateReader(dds::kFrameInfoTopic)},
      meshes_{participant_.CreateReader(dds::kMeshTopic)},
      mesh_states_{participant_.CreateReader(dds::kMeshStateTopic)},
      calibrations_{participant_.CreateReader(dds::kCalibrationTopic)},
      outputs_{participant_, !config.markers.color_rgb.empty()},
      transforms_{participant_},
      pairing_{FromSeconds(config.pairing_wait_s)},
      worker_{
          {.run = MakePerceive(config, std::move(maker)), .on_result = [this] { loop_.Wake(); }}},
      inputs_{participant_, loop_, log_} {
  AttachReaders();
  ExpectInputs();
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  SendPose();
  if (pose_.T_robot_camera()) return;
  log_.Write(Severity::kWarning, "no camera_pose: frames are segmented without the model's help");
}

void PerceptionNode::AttachReaders() {
  loop_.Attach(setups_, [this] { TakeCamera(); });
  loop_.Attach(depth_lenses_, [this] { TakeCamera(); });
  loop_.Attach(color_lenses_, [this] { TakeCamera(); });
  loop_.Attach(depths_, [this] { TakeDepth(); });
  loop_.Attach(colors_, [this] { TakeColor(); });
  loop_.Attach(infos_, [this] { TakeFacts(); });
  loop_.Attach(meshes_, [this] { TakeMesh(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  if (!config_.follow_calibration) return;
  loop_.Attach(calibrations_, [this] { TakeCalibration(); });
}

/// Colour is no needed input: a camera may have none.
void PerceptionNode::ExpectInputs() {
  using Kind = dds::InputKind;
  const std::string capture = "palpate-capture";
  inputs_.Expect(setups_, capture, Kind::kLatched);
  inputs_.Expect(depth_lenses_, capture, Kind::kLatched);
  inputs_.Expect(depths_, capture);
  inputs_.Expect(infos_, capture);
  // The model answers frames, and without a pose its surface is of no use.
  const auto needs_model = [this] { return pose_.T_robot_camera() && !IsSilent(); };
  const std::string model = "palpate-force-estimation";
  inputs_.Expect(meshes_, model, Kind::kLatched, needs_model);
  inputs_.Expect(mesh_states_, model, Kind::kStream, needs_model);
}

/// Comes before the frames that are taken with it: who takes frames asks for it first.
void PerceptionNode::TakeCamera() {
  for (const auto& message : setups_.Take()) {
    camera_.SetSetup(message);
    pairing_.Restart(dds::StampNs(message.header.stamp), message.epoch);
  }
  for (const auto& message : depth_lenses_.Take()) camera_.SetDepthLens(message);
  for (const auto& message : color_lenses_.Take()) camera_.SetColorLens(message);
}

/// Where the part belongs; nullptr, and counted, where it is too late.
template <typename Message>
FrameSet* PerceptionNode::PartOf(const Message& message) {
  FrameSet* set = pairing_.At(dds::StampNs(message.header.stamp), Clock::now());
  if (!set) ++counts_.dropped;
  return set;
}

void PerceptionNode::TakeDepth() {
  TakeCamera();
  for (const auto& message : depths_.Take()) {
    ++counts_.received;
    last_depth_ = Clock::now();
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    if (stamp_ns == pairing_.last_stamp_ns()) {
      outputs_.Repeat(stamp_ns);
      continue;
    }
    FrameSet* set = PartOf(message);
    if (!set) continue;
    const Status status = FromDepthImage(message, &set->depth.emplace());
    if (!status.ok()) set->status = {status.code(), "/camera/depth/image_raw: " + status.message()};
  }
  Advance();
}

void PerceptionNode::TakeColor() {
  TakeCamera();
  for (const auto& message : colors_.Take()) {
    if (dds::StampNs(message.header.stamp) == pairing_.last_stamp_ns()) continue;
    FrameSet* set = PartOf(message);
    if (!set) continue;
    const Status status = FromColorImage(message, &set->color.emplace());
    if (!status.ok()) set->status = {status.code(), "/camera/color/image_raw: " + status.message()};
  }
  Advance();
}

void PerceptionNode::TakeFacts() {
  TakeCamera();
  for (const auto& message : infos_.Take()) {
    if (dds::StampNs(message.header.stamp) == pairing_.last_stamp_ns()) continue;
    if (FrameSet* set = PartOf(message)) set->facts = {message.counter, message.epoch};
  }
  Advance();
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

/// For the tools of ROS 2. One that is not taken is sent again with the next calibration.
void PerceptionNode::SendPose() {
  if (!pose_.T_robot_camera()) return;
  (void)transforms_.Set(geometry::kRobotFrame, geometry::kCameraDepthOpticalFrame,
                        *pose_.T_robot_camera(), participant_.Now_ns());
}

void PerceptionNode::TakeMeshStates() {
  TakeMesh();
  for (const auto& message : mesh_states_.Take()) {
    if (!predictions_.Add(message).ok()) ++counts_.refused;
  }
  Advance();
}

bool PerceptionNode::IsWhole(const FrameSet& set) const {
  if (!set.status.ok()) return true;
  if (!set.depth || !set.facts) return false;
  rgbd::RgbdCamera camera;
  const Status known = camera_.CameraOf(set.facts->epoch, &camera);
  if (!known.ok()) return known.code() == StatusCode::kInvalidInput;
  if (camera_.has_color_lens()) return set.color.has_value();
  // A camera without colour: so it was found to be when the first frame of the epoch was overdue.
  return set_ && set_setups_ == camera_.setups() && set_->color.width_px == 0 && !set.color;
}

/// Why a set cannot be used; ok, and its camera, where it can.
Status PerceptionNode::Examine(const FrameSet& set, rgbd::RgbdCamera* camera) const {
  if (!set.status.ok()) return set.status;
  const auto late = [&](const std::string& topic) {
    return Status(StatusCode::kStale, "nothing of this stamp on " + topic + " within " +
                                          FormatNumber(config_.pairing_wait_s) + " s");
  };
  if (!set.facts) return late("/camera/frame_info");
  if (Status known = camera_.CameraOf(set.facts->epoch, camera); !known.ok()) return known;
  if (!HasSizeOf(*set.depth, camera->depth)) {
    return WrongSize("depth", *set.depth, camera->depth);
  }
  if (!camera_.has_color_lens()) {
    if (!set.color) return Status::Ok();
    return {StatusCode::kNoCalibration, "no /camera/color/camera_info of this epoch has come"};
  }
  if (!set.color) return late("/camera/color/image_raw");
  if (HasSizeOf(*set.color, camera->color)) return Status::Ok();
  return WrongSize("colour", *set.color, camera->color);
}

void PerceptionNode::Advance() {
  const auto whole = [this](const FrameSet& set) { return IsWhole(set); };
  while (auto set = pairing_.Take(whole, Clock::now())) {
    if (next_) ++counts_.dropped;
    next_ = std::move(set);
  }
  if (next_ && !worker_.busy() && !MustAwaitPrediction()) {
    Work(*std::exchange(next_, std::nullopt));
  }
  SetAlarm();
}

void PerceptionNode::SetAlarm() {
  overdue_.Clear();
  const auto set = pairing_.NextOverdue();
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
  return camera_.device() != last_device_ || (back && set.facts && set.facts->epoch <= last_epoch_);
}

void PerceptionNode::Work(FrameSet set) {
  rgbd::RgbdCamera camera;
  const Status status = Examine(set, &camera);
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

PerceptionJob PerceptionNode::HeadOf(const FrameSet& set) const {
  PerceptionJob job;
  job.outcome.stamp_ns = set.stamp_ns;
  job.outcome.device = camera_.device();
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
  if (begins || camera_.subpixel_sigma_px() != sigma_px_) {
    job.reset = config_;
    sigma_px_ = camera_.subpixel_sigma_px();
    job.reset->depth_subpixel_px = sigma_px_.value_or(config_.depth_subpixel_px);
  }
  if (begins && last_stamp_ns_) predictions_.Clear();
  if (job.reset || set_setups_ != camera_.setups() || !IsSameCamera(*set_, camera)) {
    job.camera = set_ = camera;
    set_setups_ = camera_.setups();
  }
  last_device_ = camera_.device();
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
  counts.dropped += pairing_.dropped() + outputs_.failed();
  counts.latencies_s = outputs_.TakeLatencies();
  health_.Report(CurrentStatus(), counts,
                 {{"device", camera_.device()},
                  {"readers_of_contacts", std::to_string(outputs_.readers())},
                  {"writers_of_depth", std::to_string(depths_.matched())},
                  {"incompatible_qos", std::to_string(depths_.counters().incompatible_qos)},
                  {"waiting_for", inputs_.Waiting()}},
                 Clock::now());
  log_.WriteCounted();
}

bool PerceptionNode::IsSilent() const {
  return counts_.received == 0 || SecondsSince(last_depth_) > config_.silence_s;
}

Status PerceptionNode::CurrentStatus() const {
  if (counts_.received > 0 && IsSilent()) {
    return {StatusCode::kStale,
            "no depth images for " + FormatNumber(std::round(SecondsSince(last_depth_))) + " s"};
  }
  return last_status_;
}

}  // namespace palpate::perception
