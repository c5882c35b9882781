// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/node.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "components/calibration/joint/found_calibration.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/joint_states.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::calibration {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);
constexpr auto kTickPeriod = std::chrono::milliseconds(200);
constexpr int kLeastMarkers = 3;

CollectorSettings CollectorOf(const NodeConfig& config) {
  return {.rest = {.still_s = config.still_s, .still_m = config.still_m, .still_N = config.still_N},
          .cable_input = config.cable_input == "displacement" ? robot::CableInput::kDisplacement
                                                              : robot::CableInput::kTension,
          .new_setting_m = config.new_setting_m,
          .new_setting_N = config.new_setting_N,
          .marker_pictures = config.marker_pictures,
          .marker_bias_m = config.marker_bias_m};
}

geometry::RigidTransform ToTransform(const Eigen::Isometry3d& T) {
  return {Eigen::Quaterniond(T.linear()), T.translation()};
}

/// Of a file, which has no correlations.
Eigen::Matrix<double, 6, 6> CovarianceOf(const robot::CalibrationFile& file) {
  Eigen::Matrix<double, 6, 1> errors = Eigen::Matrix<double, 6, 1>::Zero();
  if (file.pose) errors << file.pose->rotation_error_rad, file.pose->translation_error_m;
  return errors.cwiseAbs2().asDiagonal();
}

Status NotOk(StatusCode code, std::string reason) { return {code, std::move(reason)}; }

/// "without frame 2: ..."; empty where all frames are used.
std::string RemarksOn(const LiveResult& result) {
  std::string text = result.decided_by_last_pose
                         ? "the pose of the last calibration decides which marker is which"
                         : "";
  for (const std::string& frame : result.left_out) {
    text += (text.empty() ? "without " : ", without ") + frame;
  }
  return text;
}

}  // namespace

CalibrationNode::CalibrationNode(const NodeConfig& config, std::unique_ptr<robot::RobotModel> model,
                                 int domain_id, dds::TopicTable table,
                                 dds::NodeLog::ProcessLog process_log, Worker::Fit fit,
                                 const std::vector<dds::FurtherCamera>& cameras)
    : config_{config},
      participant_{dds::ParticipantOf(config.dds, "palpate_calibration", domain_id),
                   std::move(table)},
      loop_{participant_},
      log_{participant_, std::move(process_log)},
      health_{participant_, "calibration", Clock::now()},
      worker_{std::move(model), std::move(fit), [this] { loop_.Wake(); }},
      marker_names_{worker_.model().MarkerNames()},
      cable_names_{worker_.model().ActuatorNames()},
      part_names_{PartNames(worker_.model().body())},
      collector_{worker_.model(), CollectorOf(config)},
      requests_{participant_.CreateReader(dds::kCalibrationRequestTopic)},
      joint_states_{participant_.CreateReader(dds::kJointStatesTopic)},
      markers_{participant_.CreateReader(dds::kMarkersTopic)},
      calibration_{participant_.CreateWriter(dds::kCalibrationTopic)},
      status_{participant_.CreateWriter(dds::kCalibrationStatusTopic)},
      cameras_{cameras},
      clouds_{participant_, loop_, config.allow_contacts, EventsOfClouds(), dds::NamesOf(cameras)},
      inputs_{participant_, loop_, log_} {
  ReadLastCalibration();
  ExpectInputs();
  loop_.Attach(requests_, [this] { TakeRequests(); });
  loop_.Attach(joint_states_, [this] { TakeJointStates(); });
  loop_.Attach(markers_, [this] { TakeMarkers(); });
  loop_.OnWake([this] { TakeResult(); });
  loop_.Every(kTickPeriod, [this] { Tick(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  SendProgress();
  if (!config_.at_start) {
    log_.Write(Severity::kInfo,
               "waiting for a request on /calibration/request (at_start: begin without one)");
    return;
  }
  const Request request = Defaults();
  const Status status = Check(request);
  if (!status.ok()) throw InputError("at_start: " + status.message());
  Begin(request);
}

void CalibrationNode::ReadLastCalibration() {
  const std::filesystem::path file = config_.calibration_file;
  if (!file.empty() && std::filesystem::exists(file)) {
    last_ = robot::ReadCalibrationFile(file, app::LoadYaml);
    const Status status = robot::CheckCalibration(*last_, worker_.model());
    if (!status.ok()) throw InputError(file.string() + ": " + status.message());
    Publish(*last_, CovarianceOf(*last_));
    const std::vector<dds::FurtherCamera> given = cameras_;
    TakePosesOf(*last_);
    for (std::size_t k = 0; k < given.size(); ++k) {
      if (given[k].T_robot_camera) cameras_[k] = given[k];
    }
  }
  if (config_.camera_pose.empty()) return;
  T_robot_camera_ =
      ToTransform(geometry::ReadPose(app::ParseYaml(config_.camera_pose, "camera_pose")));
}

/// As initial poses.
void CalibrationNode::TakePosesOf(const robot::CalibrationFile& file) {
  if (file.pose) T_robot_camera_ = ToTransform(file.pose->T_robot_camera);
  for (const robot::CalibratedCamera& known : file.cameras) {
    for (dds::FurtherCamera& camera : cameras_) {
      if (camera.name == known.name) camera.T_robot_camera = known.pose.T_robot_camera;
    }
  }
}

/// While frames are collected.
void CalibrationNode::ExpectInputs() {
  const auto collects_clouds = [this] { return Collects("clouds"); };
  const auto collects_markers = [this] { return Collects("markers"); };
  const std::string perception = "palpate-perception";
  inputs_.Expect(joint_states_, "the driver of the actuators or palpate-virtual-robot",
                 dds::InputKind::kStream, [this] { return progress_.state == "collecting"; });
  inputs_.Expect(clouds_.clouds(), perception, dds::InputKind::kStream, collects_clouds);
  inputs_.Expect(clouds_.reports(), perception, dds::InputKind::kStream, collects_clouds);
  for (const dds::Endpoint* reports : clouds_.further_reports()) {
    inputs_.Expect(*reports, perception, dds::InputKind::kStream, collects_clouds);
  }
  inputs_.Expect(markers_, perception, dds::InputKind::kStream, collects_markers);
}

CloudEvents CalibrationNode::EventsOfClouds() {
  return {.seen =
              [this](SeenCloud seen) {
                if (!Collects("clouds")) return;
                obstacle_.clear();
                collector_.Add(std::move(seen));
                Advance();
              },
          .refused =
              [this](const Status& status) {
                if (Collects("clouds")) Obstruct(status, &obstacle_);
              },
          .other_camera =
              [this](const std::string& device) {
                if (!Collects("clouds") || collector_.taken() == 0) return;
                End("failed", NotOk(StatusCode::kInvalidInput,
                                    "the camera changed to '" + device +
                                        "' while frames were taken: request again"));
              }};
}

void CalibrationNode::TakeRequests() {
  for (const auto& message : requests_.Take()) {
    Request request;
    Status status = FromRequest(message, Defaults(), &request);
    if (status.ok() && request.cancel) {
      Cancel(request);
      continue;
    }
    if (status.ok()) status = Check(request);
    if (status.ok()) {
      Begin(request);
    } else {
      Refuse(request, status);
    }
  }
}

void CalibrationNode::TakeJointStates() {
  for (const auto& message : joint_states_.Take()) {
    CableReading reading;
    const Status status = dds::FromJointState(message, cable_names_, &reading);
    if (status.ok()) {
      cable_obstacle_.clear();
      robot::ToPistons(worker_.model().traits(), &reading);
      collector_.Add(std::move(reading));
    } else {
      Obstruct(status, &cable_obstacle_);
    }
  }
  Advance();
}

void CalibrationNode::TakeMarkers() {
  for (const auto& message : markers_.Take()) {
    ++counts_.received;
    if (!Collects("markers")) continue;
    SeenMarkers seen;
    const Status status = FromMarkerArray(message, marker_names_, config_.marker_sigma_m, &seen);
    if (!status.ok()) {
      Obstruct(status, &obstacle_);
      continue;
    }
    obstacle_.clear();
    collector_.Add(std::move(seen));
    Advance();
  }
}

Request CalibrationNode::Defaults() const {
  Request request;
  request.source = config_.source;
  request.frames = config_.frames;
  return request;
}

/// Whether a request can start, or why not.
Status CalibrationNode::Check(const Request& request) const {
  if (IsGoing()) {
    return NotOk(StatusCode::kInvalidInput,
                 "request '" + request_.id + "' is in progress: cancel it, or wait for it");
  }
  if (worker_.busy()) {
    return NotOk(StatusCode::kInvalidInput, "the fit of a cancelled request has not ended yet");
  }
  for (const std::string& part : request.moduli) {
    if (std::find(part_names_.begin(), part_names_.end(), part) != part_names_.end()) continue;
    return NotOk(StatusCode::kInvalidInput,
                 "moduli: the robot has no part '" + part + "'" + DidYouMean(part, part_names_));
  }
  if (request.source == "clouds" && !T_robot_camera_) {
    return NotOk(StatusCode::kNoCalibration,
                 "clouds need an approximate camera pose: set camera_pose");
  }
  for (const dds::FurtherCamera& camera : cameras_) {
    if (request.source != "clouds" || camera.T_robot_camera) continue;
    return NotOk(StatusCode::kNoCalibration, "clouds need an approximate pose of camera '" +
                                                 camera.name +
                                                 "': write it behind its name in 'cameras'");
  }
  if (request.source == "markers" && std::ssize(marker_names_) < kLeastMarkers) {
    return NotOk(StatusCode::kUnobservable, "the robot file has " +
                                                std::to_string(marker_names_.size()) +
                                                " markers: a pose needs three");
  }
  return Status::Ok();
}

void CalibrationNode::Begin(const Request& request) {
  request_ = request;
  collector_.Begin(request.frames);
  obstacle_.clear();
  last_step_ = Clock::now();
  progress_ = {.request_id = request.id,
               .state = "collecting",
               .reason = collector_.waits_for(),
               .frames_wanted = request.frames};
  log_.Write(Severity::kInfo, "taking " + std::to_string(request.frames) + " frames of " +
                                  request.source + " for request '" + request.id + "'");
  SendProgress();
}

void CalibrationNode::Cancel(const Request& request) {
  if (!IsGoing() || (!request.id.empty() && request.id != request_.id)) {
    return Refuse(request, NotOk(StatusCode::kInvalidInput, "no such request is in progress"));
  }
  drop_result_ = progress_.state == "computing";
  if (drop_result_) worker_.StopFit();
  End("cancelled", Status::Ok(), "as requested");
}

/// Answers it; the status of a request in progress is sent last.
void CalibrationNode::Refuse(const Request& request, const Status& status) {
  ++counts_.refused;
  log_.Write(Severity::kWarning, "request '" + request.id + "' refused: " + status.message());
  Progress refused{.request_id = request.id,
                   .state = "refused",
                   .status = status,
                   .reason = {},
                   .frames_wanted = request.frames};
  if (IsGoing()) {
    counts_.dropped += status_.Write(ToStatus(refused, participant_.Now_ns())) ? 0 : 1;
  } else {
    progress_ = std::move(refused);
  }
  SendProgress();
}

/// A message that cannot be used.
void CalibrationNode::Obstruct(const Status& status, std::string* obstacle) {
  ++counts_.refused;
  *obstacle = status.message();
}

bool CalibrationNode::Collects(const char* source) const {
  return progress_.state == "collecting" && request_.source == source;
}

bool CalibrationNode::IsGoing() const {
  return progress_.state == "collecting" || progress_.state == "computing";
}

/// Continues after a frame was added.
void CalibrationNode::Advance() {
  if (progress_.state != "collecting" || collector_.taken() == progress_.frames_taken) return;
  progress_.frames_taken = collector_.taken();
  last_step_ = Clock::now();
  if (collector_.IsComplete()) progress_.state = "computing";
  progress_.reason.clear();
  SendProgress();
  if (collector_.IsComplete()) worker_.Start(MakeJob());
}

LiveJob CalibrationNode::MakeJob() const {
  LiveJob job;
  job.request = {.actuator_offset_sigma_m = config_.drive_offset_sigma_m,
                 .actuator_gains = request_.actuator_gains,
                 .actuator_gain_sigma = config_.drive_gain_sigma,
                 .moduli = {},
                 .modulus_relative_sigma = config_.modulus_relative_sigma};
  for (const std::string& part : request_.moduli) {
    const auto found = std::find(part_names_.begin(), part_names_.end(), part);
    job.request.moduli.push_back(static_cast<int>(found - part_names_.begin()));
  }
  job.clouds = collector_.clouds();
  job.further = FurtherJobs();
  job.markers = collector_.markers();
  job.points = collector_.points();
  if (request_.source == "markers") job.request.depth_bias_sigma = config_.marker_depth_bias;
  job.picture = collector_.picture();
  job.fit_depth_bias = config_.fit_depth_bias;
  const bool pose_is_given = !config_.camera_pose.empty() && !job.points.empty();
  if (!job.clouds.empty() || pose_is_given) job.T_robot_camera_start = T_robot_camera_;
  // The camera may have moved since.
  job.T_robot_camera_last = T_robot_camera_;
  job.before = last_;
  job.data = std::to_string(collector_.taken()) + " frames of " + request_.source + ", live";
  job.found_ns_since_1970 = dds::WallClockNs();
  return job;
}

/// Of the cameras beside the first that saw the robot.
std::vector<FurtherCameraJob> CalibrationNode::FurtherJobs() const {
  std::vector<FurtherCameraJob> jobs;
  for (std::size_t k = 0; k < collector_.further().size(); ++k) {
    const FrameCollector::OfCamera& seen = collector_.further()[k];
    jobs.push_back({.name = cameras_[k].name,
                    .clouds = seen.clouds,
                    .picture = seen.picture(),
                    .T_robot_camera_start = ToTransform(*cameras_[k].T_robot_camera)});
  }
  return jobs;
}

void CalibrationNode::TakeResult() {
  const std::optional<LiveResult> result = worker_.TakeResult();
  if (!result) return;
  if (std::exchange(drop_result_, false)) return;
  if (result->status.ok()) return Adopt(*result);
  End("failed", result->status);
}

void CalibrationNode::Adopt(const LiveResult& result) {
  last_ = result.file;
  TakePosesOf(*last_);
  Publish(*last_, result.pose_covariance);
  std::string reason = RemarksOn(result);
  if (!config_.calibration_file.empty()) {
    try {
      robot::WriteCalibrationFile(*last_, config_.calibration_file);
    } catch (const RunError& error) {
      const std::string trouble = std::string("published, but not written: ") + error.what();
      log_.Write(Severity::kError, trouble);
      reason = trouble + (reason.empty() ? "" : "; ") + reason;
    }
  }
  End("done", Status::Ok(), reason);
}

void CalibrationNode::Publish(const robot::CalibrationFile& file,
                              const Eigen::Matrix<double, 6, 6>& covariance) {
  const bool sent = calibration_.Write(ToCalibration(file, covariance, participant_.Now_ns()));
  counts_.dropped += sent ? 0 : 1;
}

void CalibrationNode::End(const std::string& state, const Status& status,
                          const std::string& reason) {
  progress_.state = state;
  progress_.status = status;
  progress_.reason = reason;
  log_.Write(status.ok() ? Severity::kInfo : Severity::kWarning,
             "request '" + request_.id + "' " + state +
                 (status.ok() ? std::string() : ": " + status.message()));
  SendProgress();
}

/// Reports what is missing, and fails after patience_s.
void CalibrationNode::Tick() {
  if (progress_.state != "collecting") return;
  const std::string& obstacle = cable_obstacle_.empty() ? obstacle_ : cable_obstacle_;
  progress_.reason = obstacle.empty() ? collector_.waits_for() : obstacle;
  const double waited_s = SecondsSince(last_step_);
  if (waited_s > config_.patience_s) {
    return End("failed", NotOk(StatusCode::kStale, "no further frame within " +
                                                       FormatNumber(config_.patience_s) +
                                                       " s: " + progress_.reason));
  }
  if (progress_.reason != sent_reason_) SendProgress();
}

void CalibrationNode::SendProgress() {
  sent_reason_ = progress_.reason;
  counts_.dropped += status_.Write(ToStatus(progress_, participant_.Now_ns())) ? 0 : 1;
}

void CalibrationNode::ReportHealth() {
  dds::HealthCounts counts = counts_;
  counts.received += clouds_.received();
  counts.published = calibration_.sent_count();
  health_.Report(progress_.status, counts,
                 {{"state", progress_.state},
                  {"calibration", last_ ? last_->date_utc : "none"},
                  {"readers_of_calibration", std::to_string(calibration_.matched())},
                  {"writers_of_clouds", std::to_string(clouds_.writers())},
                  {"waiting_for", inputs_.Waiting()}},
                 Clock::now());
  log_.WriteCounted();
}

}  // namespace palpate::calibration
