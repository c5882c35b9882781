// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "components/perception/node/capture_streams.hpp"
#include "components/perception/node/driver_streams.hpp"
#include "libs/core/error.hpp"
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

const std::vector<dds::FurtherCamera>& WithPoses(const std::vector<dds::FurtherCamera>& cameras) {
  for (const dds::FurtherCamera& camera : cameras) {
    if (camera.T_robot_camera) continue;
    throw InputError("cameras: where is '" + camera.name +
                     "'? Its pose belongs behind its name, or in the file of --calibration");
  }
  return cameras;
}

void CheckSettings(bool has_pose, bool has_further_cameras) {
  if (has_further_cameras && !has_pose) {
    throw InputError("cameras: camera_pose or --calibration is required beside further cameras");
  }
}

}  // namespace

PerceptionNode::PerceptionNode(const NodeConfig& config,
                               std::optional<Eigen::Isometry3d> T_robot_camera,
                               FramePerceptionMaker maker, int domain_id, dds::TopicTable table,
                               dds::NodeLog::ProcessLog process_log,
                               const std::vector<dds::FurtherCamera>& cameras,
                               const PoseOrigin& origin)
    : config_{config},
      pose_{std::move(T_robot_camera), WithPoses(cameras), origin},
      participant_{dds::ParticipantOf(NamesOf(config), "palpate_perception", domain_id),
                   std::move(table)},
      loop_{participant_},
      overdue_{loop_.AddAlarm([this] { Advance(); })},
      log_{participant_, std::move(process_log)},
      health_{participant_, "perception", Clock::now()},
      meshes_{participant_.CreateReader(dds::kMeshTopic)},
      mesh_states_{participant_.CreateReader(dds::kMeshStateTopic)},
      calibrations_{participant_.CreateReader(dds::kCalibrationTopic)},
      outputs_{participant_, !config.markers.color_rgb.empty(), dds::NamesOf(cameras)},
      transforms_{participant_},
      feeds_{MakeFeeds(cameras)},
      clocks_{feeds_.size()},
      joining_{feeds_.size(), FromSeconds(config.camera_wait_s)},
      worker_{
          {.run = MakePerceive(config, std::move(maker)), .on_result = [this] { loop_.Wake(); }}},
      lateness_{config.late_s},
      inputs_{participant_, loop_, log_} {
  CheckSettings(pose_.T_robot_camera().has_value(), !cameras.empty());
  AttachReaders();
  ExpectInputs();
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  SendPose();
  if (pose_.T_robot_camera()) return;
  log_.Write(Severity::kWarning, "no camera_pose: frames are segmented without the model's help");
}

std::vector<CameraFeed> PerceptionNode::MakeFeeds(const std::vector<dds::FurtherCamera>& cameras) {
  const StreamEvents events{[this] { Advance(); },
                            [this](std::int64_t stamp_ns) { outputs_.Repeat(stamp_ns); }};
  const auto streams_of = [&](const std::string& name) -> std::unique_ptr<CameraStreams> {
    if (config_.camera.source == "driver") {
      return std::make_unique<DriverStreams>(participant_, loop_, config_.camera,
                                             config_.pairing_wait_s, config_.max_z_m, events, name);
    }
    return std::make_unique<CaptureStreams>(participant_, loop_, config_.pairing_wait_s, events,
                                            name);
  };
  std::vector<std::string> names = dds::NamesOf(cameras);
  names.insert(names.begin(), "");
  std::vector<CameraFeed> feeds;
  for (const std::string& name : names) feeds.emplace_back(config_, name, streams_of(name));
  return feeds;
}

void PerceptionNode::AttachReaders() {
  loop_.Attach(meshes_, [this] { TakeMesh(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  if (!config_.follow_calibration) return;
  loop_.Attach(calibrations_, [this] { TakeCalibration(); });
}

void PerceptionNode::ExpectInputs() {
  using Kind = dds::InputKind;
  for (CameraFeed& feed : feeds_) feed.streams().ExpectInputs(inputs_);
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
    if (!status.ok()) {
      ++counts_.refused;
      log_.WarnRepeatedly("/calibration refused: " + status.message());
      continue;
    }
    notes_.clear();
    const std::string unknown =
        Describe(dds::MatchCameras(dds::NamesOf(pose_.further()), FurtherCamerasOf(message)));
    if (message.has_camera && !unknown.empty()) notes_.push_back("/calibration: " + unknown);
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
  const std::string frame = feeds_[0].streams().depth_frame();
  if (config_.camera.source == "capture") {
    for (std::size_t k = 0; k < feeds_.size(); ++k) {
      (void)transforms_.Set(geometry::kRobotFrame, feeds_[k].streams().depth_frame(), *PoseOf(k),
                            now_ns);
    }
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
  const Clock::time_point now = Clock::now();
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    while (auto set = feeds_[k].streams().Take(now)) {
      if (MapToFirst(k, &*set)) joining_.Add(k, std::move(*set));
    }
  }
  while (auto set = joining_.Take(now)) {
    if (next_) ++counts_.dropped;
    next_ = std::move(set);
    WorkOnNext();
  }
  SetAlarm();
}

/// Maps the times of a set to the clock of the first camera. False where that is not known: the
/// camera is left out.
bool PerceptionNode::MapToFirst(std::size_t camera, FrameSet* set) {
  if (feeds_.size() == 1) return true;
  if (!clocks_.IsHeard(camera)) HearClock(camera);
  if (!clocks_.Check(camera).ok()) {
    ++counts_.dropped;
    return false;
  }
  const std::int64_t shift_ns = clocks_.ToFirst_ns(camera);
  set->stamp_ns += shift_ns;
  if (set->facts && set->facts->received_ns != 0) set->facts->received_ns += shift_ns;
  return true;
}

void PerceptionNode::HearClock(std::size_t camera) {
  const std::string& topic = feeds_[camera].streams().depths().ros_name();
  clocks_.Hear(camera, health_.ClockOf(topic), Clock::now());
}

void PerceptionNode::WorkOnNext() {
  if (!next_ || worker_.busy() || MustAwaitPrediction()) return;
  Work(*std::exchange(next_, std::nullopt));
}

void PerceptionNode::SetAlarm() {
  overdue_.Clear();
  std::optional<Clock::time_point> next = joining_.NextOverdue();
  const auto include = [&](std::optional<Clock::time_point> time) {
    if (time) next = next ? std::min(*next, *time) : *time;
  };
  for (const CameraFeed& feed : feeds_) include(feed.streams().NextOverdue());
  if (next_ && !worker_.busy()) include(PredictionOverdue());
  if (next) overdue_.Set(*next);
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
/// do with those before; those of one that was only reopened (its epoch rose) do. The first camera
/// decides, where it has a frame.
bool PerceptionNode::BeginsSequence(const JointSet& set) const {
  if (!last_stamp_ns_) return true;
  const bool back = set.stamp_ns <= *last_stamp_ns_;
  const std::optional<FrameSet>& first = set.sets[0];
  if (!first) return back;
  return feeds_[0].streams().device() != last_device_ ||
         (back && first->facts && first->facts->epoch <= last_epoch_);
}

void PerceptionNode::Work(JointSet set) {
  PerceptionJob job = MakeJob(set);
  const auto& cameras = job.outcome.cameras;
  const bool is_usable = std::any_of(cameras.begin(), cameras.end(),
                                     [](const CameraOrigin& one) { return one.status.ok(); });
  if (!is_usable) return Refuse(std::move(job));
  Finish(set, job);
  worker_.Start(std::move(job));
}

/// What each camera has of the frame, and why not where it has nothing.
PerceptionJob PerceptionNode::MakeJob(JointSet& set) {
  PerceptionJob job;
  job.outcome.stamp_ns = set.stamp_ns;
  job.taken = set.taken;
  job.begins = BeginsSequence(set);
  job.outcome.notes = notes_;
  // At the start alone: later, a camera that comes back must not stop the others.
  const Status wait = last_stamp_ns_ ? Status::Ok() : clocks_.CheckWait(Clock::now());
  std::vector<rgbd::RgbdCamera> known(feeds_.size());
  bool is_usable = false;
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    std::optional<FrameSet>& of_camera = set.sets[k];
    CameraOrigin& origin =
        job.outcome.cameras.emplace_back(feeds_[k].OriginOf(of_camera ? &*of_camera : nullptr));
    if (!wait.ok()) {
      origin.status = wait;
    } else if (of_camera) {
      origin.status = Examine(k, *of_camera, job.begins, &known[k]);
    } else {
      const Status clock = clocks_.Check(k);
      origin.status = clock.ok() ? Status(StatusCode::kStale, "no image of this time") : clock;
    }
    if (k > 0) origin.T_first_camera = PoseOf(0)->inverse() * *PoseOf(k);
    is_usable = is_usable || origin.status.ok();
  }
  if (!is_usable) return job;
  if (job.begins) Begin();
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    CameraOrigin& origin = job.outcome.cameras[k];
    CameraJob& camera = job.cameras.emplace_back();
    if (origin.status.ok()) {
      // Perception as a whole begins with the settings of the first camera.
      if (k == 0 && feeds_[0].Resets()) {
        for (CameraFeed& feed : feeds_) feed.Forget();
      }
      origin.picture = rgbd::PictureOf(known[k].depth);
      camera = feeds_[k].MakeJob(*set.sets[k], known[k], set.stamp_ns);
    }
    if (const auto pose = PoseOf(k)) camera.T_robot_camera = *pose;
  }
  Predict(set.stamp_ns, &job);
  return job;
}

/// Why a camera's set cannot be used; ok, and its camera, where it can.
Status PerceptionNode::Examine(std::size_t camera, FrameSet& set, bool begins,
                               rgbd::RgbdCamera* known) {
  CameraFeed& feed = feeds_[camera];
  Status status = feed.streams().Examine(set, known);
  if (status.ok()) {
    NoteLateness(set);
    if (begins) feed.BeginSequence();
    status = feed.CheckIsNew(set);
  }
  if (status.ok() && camera == 0) status = FollowFrames();
  if (status.ok()) return status;
  const std::string of_camera = feed.name().empty() ? "" : " of camera '" + feed.name() + "'";
  log_.WarnRepeatedly("frame" + of_camera + " refused: " + status.message(),
                      dds::StampText(set.stamp_ns));
  return status;
}

void PerceptionNode::NoteLateness(const FrameSet& set) {
  if (!set.facts || set.facts->received_ns == 0) return;
  lateness_.Add(NsToSeconds(participant_.clock()->NowOfFrames_ns() - set.facts->received_ns) -
                SecondsSince(set.taken));
}

Status PerceptionNode::FollowFrames() {
  const CameraStreams& streams = feeds_[0].streams();
  const auto T_robot_camera = streams.T_robot_depth();
  if (!T_robot_camera) return Status::Ok();
  const bool known = pose_.T_robot_camera().has_value();
  Status status = pose_.FollowFrames(*T_robot_camera, streams.depth_frame());
  if (!known) {
    log_.Write(Severity::kInfo, "camera pose of /tf and /tf_static, from 'robot' to '" +
                                    streams.depth_frame() +
                                    "': " + geometry::FormatPose(*T_robot_camera));
  }
  return status;
}

/// A frame that begins a sequence: what was known of earlier ones is void.
void PerceptionNode::Begin() {
  for (CameraFeed& feed : feeds_) feed.Forget();
  if (last_stamp_ns_) predictions_.Clear();
}

void PerceptionNode::Predict(std::int64_t stamp_ns, PerceptionJob* job) const {
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    const auto pose = PoseOf(k);
    if (!pose || !job->outcome.cameras[k].status.ok()) continue;
    std::optional<Prediction>& prediction = job->cameras[k].prediction;
    prediction = config_.await_prediction_s > 0.0
                     ? predictions_.Last(*pose)
                     : predictions_.Before(stamp_ns, config_.max_prediction_age_s, *pose);
    if (prediction) job->outcome.prediction_stamp_ns = prediction->stamp_ns;
  }
}

/// Remembers what the next frames are compared with.
void PerceptionNode::Finish(const JointSet& set, const PerceptionJob& job) {
  if (last_device_ != feeds_[0].streams().device()) {
    last_device_ = feeds_[0].streams().device();
    SendPose();
  }
  last_epoch_ = job.outcome.cameras[0].epoch;
  last_stamp_ns_ = set.stamp_ns;
}

void PerceptionNode::Refuse(PerceptionJob job) {
  ++counts_.refused;
  job.outcome.observation.stamp_ns = job.outcome.stamp_ns;
  for (const CameraOrigin& origin : job.outcome.cameras) {
    job.outcome.observation.views.emplace_back().frame.status = origin.status;
  }
  Publish(job.outcome, job.taken);
}

/// nullopt: it is not known, of the first camera.
std::optional<Eigen::Isometry3d> PerceptionNode::PoseOf(std::size_t camera) const {
  if (camera > 0) return pose_.further()[camera - 1].T_robot_camera;
  return pose_.T_robot_camera();
}

void PerceptionNode::PublishResults() {
  while (const std::optional<PerceptionResult> result = worker_.TakeResult()) {
    Publish(result->outcome, result->taken);
  }
  Advance();
}

void PerceptionNode::Publish(const FrameOutcome& outcome, Clock::time_point taken) {
  last_status_ = outcome.observation.status();
  outputs_.Publish(outcome, taken);
  published_at_ = Clock::now();
}

void PerceptionNode::ReportHealth() {
  dds::HealthCounts counts = counts_;
  counts.published = outputs_.published();
  for (const CameraFeed& feed : feeds_) {
    counts.received += feed.streams().received();
    counts.dropped += feed.streams().dropped();
  }
  counts.dropped += outputs_.failed() + joining_.dropped();
  counts.latencies_s = outputs_.TakeLatencies();
  const dds::Endpoint& depths = feeds_[0].streams().depths();
  dds::HealthReporter::KeysAndValues values = {
      {"device", feeds_[0].streams().device()},
      {"readers_of_contacts", std::to_string(outputs_.readers())},
      {"writers_of_depth", std::to_string(depths.matched())},
      {"incompatible_qos", std::to_string(depths.counters().incompatible_qos)}};
  AppendCameras(&values);
  values.emplace_back("waiting_for", inputs_.Waiting());
  health_.Report(CurrentStatus(), counts, values, Clock::now());
  log_.WriteCounted();
  for (std::size_t k = 0; k < feeds_.size() && feeds_.size() > 1; ++k) HearClock(k);
}

/// Of each camera beside the first whether it is used, and its clock where that is another one.
void PerceptionNode::AppendCameras(dds::HealthReporter::KeysAndValues* values) const {
  for (std::size_t k = 1; k < feeds_.size(); ++k) {
    const std::string& name = feeds_[k].name();
    const bool is_joined = clocks_.Check(k).ok();
    values->emplace_back("camera." + name, IsSilent(k) ? "missing" : is_joined ? "ok" : "left_out");
    const auto to_first = clocks_.ToFirst(k);
    if (!to_first) continue;
    // Its clock minus that of the first, as the offsets of hosts.
    values->emplace_back("camera_clock_offset_s." + name, FormatNumber(-to_first->offset_s));
    values->emplace_back("camera_clock_offset_bound_s." + name, FormatNumber(to_first->bound_s));
  }
}

/// No camera sends.
bool PerceptionNode::IsSilent() const {
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    if (!IsSilent(k)) return false;
  }
  return true;
}

bool PerceptionNode::IsSilent(std::size_t camera) const {
  const CameraStreams& streams = feeds_[camera].streams();
  return streams.received() == 0 || SecondsSince(streams.last_depth()) > config_.silence_s;
}

/// Beside others that send: the estimate goes on, with less accuracy. Empty: none is missing.
std::string PerceptionNode::MissingCameras() const {
  std::string missing;
  for (std::size_t k = 0; k < feeds_.size(); ++k) {
    if (!IsSilent(k)) continue;
    const std::string& name = feeds_[k].name();
    missing += (missing.empty() ? "" : ", ") +
               (name.empty() ? std::string("the first camera") : "camera '" + name + "'");
  }
  return missing;
}

/// When the last depth image of any camera came.
PerceptionNode::Clock::time_point PerceptionNode::LastDepth() const {
  Clock::time_point last;
  for (const CameraFeed& feed : feeds_) last = std::max(last, feed.streams().last_depth());
  return last;
}

Status PerceptionNode::CurrentStatus() {
  const Status& late = lateness_.Judge("frames");
  const bool was_there = std::any_of(feeds_.begin(), feeds_.end(), [](const CameraFeed& feed) {
    return feed.streams().received() > 0;
  });
  if (was_there && IsSilent()) {
    return {StatusCode::kStale,
            "no depth images for " + FormatNumber(std::round(SecondsSince(LastDepth()))) + " s"};
  }
  if (const std::string missing = MissingCameras(); was_there && !missing.empty()) {
    return {StatusCode::kStale, "no depth images of " + missing + ": the others go on"};
  }
  for (std::size_t k = 1; k < feeds_.size(); ++k) {
    const Status clock = clocks_.Check(k);
    if (clock.ok()) continue;
    return {clock.code(), "camera '" + feeds_[k].name() + "' is left out: " + clock.message()};
  }
  if (!last_status_.ok()) return last_status_;
  if (!last_state_.ok()) {
    return {last_state_.code(), "/robot/mesh_state refused: " + last_state_.message()};
  }
  return late;
}

}  // namespace palpate::perception
