// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/node/convert.hpp"
#include "components/force_estimation/node/frame_gate.hpp"
#include "components/force_estimation/node/make_pipeline.hpp"
#include "components/force_estimation/node/marker_source.hpp"
#include "components/force_estimation/node/shape_source.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/joint_states.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::force_estimation {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);
/// Of postures before the first frame; perception takes predictions that are up to a second old.
constexpr auto kPosturePeriod = std::chrono::milliseconds(200);
constexpr double kLongestWait_s = 1e6;
constexpr size_t kMostPending = 1024;

robot::CableInput PreferredInput(const NodeConfig& config) {
  return config.cable_input == "displacement" ? robot::CableInput::kDisplacement
                                              : robot::CableInput::kTension;
}

std::optional<Eigen::Isometry3d> CameraPose(const NodeConfig& config) {
  if (config.camera_pose.empty() && config.follow_calibration) return std::nullopt;
  if (config.camera_pose.empty()) {
    throw InputError("camera_pose is required for source=shape: where is the camera?");
  }
  return geometry::ReadPose(app::ParseYaml(config.camera_pose, "camera_pose"));
}

std::vector<dds::FurtherCamera> CheckedCameras(const NodeConfig& config,
                                               const std::vector<dds::FurtherCamera>& cameras) {
  if (cameras.empty()) return cameras;
  if (!IsFromShape(config)) throw InputError("cameras: further cameras need source shape");
  if (config.camera_pose.empty()) {
    throw InputError(
        "cameras: camera_pose, or --calibration with source shape, is required beside further "
        "cameras");
  }
  for (const dds::FurtherCamera& camera : cameras) {
    if (camera.T_robot_camera) continue;
    throw InputError("cameras: where is '" + camera.name +
                     "'? Its pose belongs behind its name, or in the file of --calibration");
  }
  return cameras;
}

std::vector<std::string> GivenContacts(const NodeConfig& config) {
  std::vector<std::string> names;
  for (const ContactSite& site : ParseContactSites(config.contacts)) names.push_back(site.name);
  return names;
}

double SecondsNow() { return NsToSeconds(MonotonicNow_ns()); }

}  // namespace

ForceEstimationNode::ForceEstimationNode(const NodeConfig& config,
                                         std::unique_ptr<robot::RobotModel> model,
                                         const robot::CalibrationFile& calibration, int domain_id,
                                         dds::TopicTable table,
                                         dds::NodeLog::ProcessLog process_log, PipelineMaker maker,
                                         const std::vector<dds::FurtherCamera>& cameras)
    : config_(config),
      cameras_(CheckedCameras(config, cameras)),
      participant_(dds::ParticipantOf(config.dds, "palpate_force_estimation", domain_id),
                   std::move(table)),
      loop_(participant_),
      cables_overdue_(loop_.AddAlarm([this] { MatchWithCables(); })),
      log_(participant_, std::move(process_log)),
      health_(participant_, "force_estimation", Clock::now()),
      worker_(std::move(model),
              maker ? maker : PipelineMakerOf(config, calibration, dds::NamesOf(cameras)),
              [this] { loop_.Wake(); }),
      cable_names_(worker_.model().ActuatorNames()),
      cables_(cable_names_.size(), PreferredInput(config)),
      outputs_(participant_, worker_.model().body(), IsFromShape(config), GivenContacts(config)),
      joint_states_(participant_.CreateReader(dds::kJointStatesTopic)),
      calibration_(participant_, worker_.model()),
      in_use_(calibration),
      lateness_(config.late_s),
      force_lines_(SecondsNow()),
      source_(MakeSource()),
      inputs_(participant_, loop_, log_) {
  last_status_ = {StatusCode::kNotRun, "no " + source_->name() + " on /perception/" +
                                           (IsFromShape(config) ? "robot_cloud" : "markers") +
                                           " yet"};
  maker_is_given_ = static_cast<bool>(maker);
  if (!calibration.date_utc.empty()) calibration_.SetInUse(calibration);
  source_->SetCalibration(calibration);
  drives_ = worker_.model().drives();
  cables_.SetDrives(drives_);
  forces_.resize(cable_names_.size());
  CorrectForces(calibration.pressure_sensors);
  loop_.Attach(joint_states_, [this] { TakeJointStates(); });
  if (config_.follow_calibration) {
    loop_.Attach(calibration_.reader(), [this] { TakeCalibration(); });
  }
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  ExpectInputs();
}

void ForceEstimationNode::ExpectInputs() {
  source_->ExpectInputs(inputs_);
  inputs_.Expect(joint_states_, "the driver of the actuators or palpate-virtual-robot");
  if (!config_.follow_calibration) return;
  inputs_.Expect(calibration_.reader(), "palpate-calibration", dds::InputKind::kLatched,
                 [this] { return !source_->knows_camera_pose(); });
}

std::unique_ptr<FrameSource> ForceEstimationNode::MakeSource() {
  const auto take = [this](FrameArrival arrival) { Take(std::move(arrival)); };
  if (IsFromShape(config_)) {
    return std::make_unique<ShapeSource>(participant_, loop_, CameraPose(config_), take, cameras_);
  }
  const std::string hint =
      config_.source == "auto"
          ? "source auto takes markers, because no --camera-pose is given: give it for images, or "
            "--set source=shape where a calibration says it"
          : "";
  return std::make_unique<MarkerSource>(participant_, loop_, worker_.model().MarkerNames(), hint,
                                        take);
}

void ForceEstimationNode::Take(FrameArrival arrival) {
  if (arrival.counts) {
    ++counts_.received;
    last_frame_ = Clock::now();
  }
  if (arrival.delay_s) lateness_.Add(*arrival.delay_s);
  if (arrival.sequence) BeginSequence(*arrival.sequence);
  if (auto* input = std::get_if<FrameInput>(&arrival.frame)) {
    Accept(std::move(*input));
  } else if (const auto* refused = std::get_if<RefusedFrame>(&arrival.frame)) {
    Refuse(refused->head, refused->status);
  } else {
    outputs_.Repeat(std::get<RepeatedFrame>(arrival.frame).head);
  }
}

void ForceEstimationNode::BeginSequence(const SequenceStart& start) {
  cables_.BeginSequence(start.time_went_back);
  sequence_pending_ = sequence_pending_ || start.unrelated;
}

void ForceEstimationNode::TakeJointStates() {
  std::optional<std::int64_t> stamp_ns;
  for (const auto& message : joint_states_.Take()) {
    CableReading reading;
    const Status status = dds::FromJointState(message, cable_names_, &reading);
    if (status.ok()) {
      robot::ToPistons(worker_.model().traits(), &reading);
      reading.stamp_ns = participant_.clock()->CableStampOfFrames_ns(reading.stamp_ns);
      stamp_ns = reading.stamp_ns;
      cables_.Add(std::move(reading));
    } else {
      ++counts_.refused;
      last_status_ = status;
    }
  }
  MatchWithCables();
  if (stamp_ns) ExpectPosture(*stamp_ns);
}

/// Before the first image the cable inputs alone say where the robot is. Its state is stamped just
/// before them: one of a frame's own stamp would be the answer to that frame.
void ForceEstimationNode::ExpectPosture(std::int64_t stamp_ns) {
  const auto now = Clock::now();
  if (!IsFromShape(config_) || !config_.expect_posture || has_frame_ ||
      now - last_posture_ < kPosturePeriod)
    return;
  FrameInput input{.head = {.stamp_ns = stamp_ns - 1, .counter = 0, .recording = {}, .taken = now},
                   .frame = PerceivedShape(),
                   .posture_only = true};
  if (!cables_.LastBefore(stamp_ns, kLongestWait_s, &input.cables()).ok()) return;
  last_posture_ = now;
  input.calibration = std::exchange(calibration_pending_, nullptr);
  worker_.Push(std::move(input));
}

void ForceEstimationNode::TakeCalibration() {
  for (const CalibrationInput::Verdict& verdict : calibration_.Take()) {
    if (verdict.status.ok()) {
      robot::CalibrationFile calibration = verdict.calibration;
      KeepPosesOfAll(&calibration);
      Adopt(calibration);
    } else {
      ++counts_.refused;
      log_.WarnRepeatedly("/calibration refused: " + verdict.status.message());
    }
  }
}

/// Without the camera poses and depth biases where they are not of all cameras.
void ForceEstimationNode::KeepPosesOfAll(robot::CalibrationFile* calibration) {
  if (!calibration->pose) return calibration->cameras.clear();
  std::vector<std::string> names;
  for (const robot::CalibratedCamera& camera : calibration->cameras) names.push_back(camera.name);
  const dds::CameraMatch match = dds::MatchCameras(dds::NamesOf(cameras_), names);
  if (const std::string text = Describe(match); !text.empty()) {
    log_.WarnRepeatedly("/calibration: " + text);
  }
  if (match.missing.empty()) return;
  calibration->pose.reset();
  calibration->depth_bias.reset();
  calibration->cameras.clear();
}

/// Holds from the next frame on. Frames that wait are refused: they were measured, and their cable
/// inputs would be read, with the old calibration.
void ForceEstimationNode::Adopt(const robot::CalibrationFile& calibration) {
  for (; !pending_.empty(); pending_.pop_front()) {
    PassOnStart(pending_.front());
    Refuse(pending_.front().head, {StatusCode::kStale, "a new calibration came after the frame"});
  }
  for (const robot::CalibratedDrive& drive : calibration.drives) {
    const auto cable = std::find(cable_names_.begin(), cable_names_.end(), drive.cable);
    drives_.at(At(cable - cable_names_.begin())) = drive.drive;
  }
  cables_.SetDrives(drives_);
  CorrectForces(calibration.pressure_sensors);
  source_->SetCalibration(calibration);
  if (calibration.pose) {
    in_use_.pose = calibration.pose;
    in_use_.depth_bias = calibration.depth_bias;
    in_use_.cameras = calibration.cameras;
  }
  if (!calibration.moduli.empty()) in_use_.moduli = calibration.moduli;
  calibration_pending_ = std::make_shared<NewCalibration>(
      calibration, maker_is_given_ ? PipelineMaker()
                                   : PipelineMakerOf(config_, in_use_, dds::NamesOf(cameras_)));
  sequence_pending_ = true;
  log_.Write(Severity::kInfo, "takes the calibration of " + calibration.date_utc + " (" +
                                  calibration.data + ") from the next frame on");
}

void ForceEstimationNode::CorrectForces(
    const std::vector<robot::CalibratedPressureSensor>& sensors) {
  for (const robot::CalibratedPressureSensor& sensor : sensors) {
    const auto chamber = std::find(cable_names_.begin(), cable_names_.end(), sensor.chamber);
    const auto actuator = static_cast<int>(chamber - cable_names_.begin());
    const robot::CalibratedNumber none;
    const robot::ActuatorTraits& piston = worker_.model().traits(actuator);
    forces_.at(At(actuator)) = {.gain = sensor.gain.value_or(none).value,
                                .offset_N = piston.Force_N(sensor.zero_Pa.value_or(none).value)};
  }
  cables_.SetForceCorrections(forces_);
}

void ForceEstimationNode::Accept(FrameInput input) {
  const Status status =
      FrameGate::CheckAge(input.head, participant_.clock()->NowOfFrames_ns(), config_.max_age_s);
  if (!status.ok()) return Refuse(input.head, status);
  has_frame_ = true;
  input.new_sequence = std::exchange(sequence_pending_, false);
  input.calibration = std::exchange(calibration_pending_, nullptr);
  if (pending_.size() == kMostPending) {
    pending_.pop_front();
    ++counts_.dropped;
  }
  pending_.push_back(std::move(input));
  MatchWithCables();
}

void ForceEstimationNode::Refuse(const FrameHead& head, const Status& status) {
  ++counts_.refused;
  last_status_ = status;
  log_.WarnRepeatedly(source_->name() + " refused: " + status.message(),
                      dds::StampText(head.stamp_ns));
  outputs_.PublishRefusal(head, status);
}

void ForceEstimationNode::MatchWithCables() {
  cables_overdue_.Clear();
  while (!pending_.empty()) {
    Status status = Status::Ok();
    if (!FindCables(pending_.front(), &status)) {
      return cables_overdue_.Set(CablesOverdue(pending_.front()));
    }
    FrameInput input = std::move(pending_.front());
    pending_.pop_front();
    if (status.ok()) {
      if (!working_since_) working_since_ = Clock::now();
      worker_.Push(std::move(input));
    } else {
      PassOnStart(input);
      Refuse(input.head, status);
    }
  }
}

/// The frame after a refused one that began a sequence begins it, with its calibration.
void ForceEstimationNode::PassOnStart(const FrameInput& refused) {
  if (!refused.new_sequence) return;
  const bool last = pending_.empty();
  (last ? sequence_pending_ : pending_.front().new_sequence) = true;
  auto& calibration = last ? calibration_pending_ : pending_.front().calibration;
  if (!calibration) calibration = refused.calibration;
}

ForceEstimationNode::Clock::time_point ForceEstimationNode::CablesOverdue(
    const FrameInput& input) const {
  const std::chrono::duration<double> wait(std::min(config_.cable_wait_s, kLongestWait_s));
  return input.head.taken + std::chrono::duration_cast<Clock::duration>(wait);
}

/// False: they may still come. True: found, or `status` says why there are none.
bool ForceEstimationNode::FindCables(FrameInput& input, Status* status) const {
  if (auto commands = cables_.At(input.head.stamp_ns)) {
    input.cables() = std::move(*commands);
    return true;
  }
  if (Clock::now() < CablesOverdue(input)) return false;
  *status = cables_.LastBefore(input.head.stamp_ns, config_.max_cable_age_s, &input.cables());
  return true;
}

void ForceEstimationNode::PublishResults() {
  while (const std::optional<FrameResult> result = worker_.TakeResult()) {
    if (result->posture_only) {
      if (result->state_is_known) outputs_.PublishPosture(*result);
      continue;
    }
    working_since_.reset();
    last_status_ = result->estimate.status;
    LogBiasFrames(result->bias_frames_to_come);
    if (ToString(result->drift.state) != ToString(drift_.state)) LogDrift(result->drift);
    drift_ = result->drift;
    if (result->gap_so_far.state != gap_.state) LogGap(result->gap_so_far);
    gap_ = result->gap_so_far;
    force_lines_.Add(result->estimate);
    outputs_.Publish(*result);
  }
}

void ForceEstimationNode::ReportHealth() {
  dds::HealthCounts counts = counts_;
  counts.published = outputs_.published();
  counts.dropped += source_->dropped() + worker_.dropped() + outputs_.failed();
  counts.latencies_s = outputs_.TakeLatencies();
  const Status status = CurrentStatus();
  if (IsFromShape(config_) && (IsSilent() || IsOverdue())) outputs_.PublishSilence(status);
  std::vector<std::pair<std::string, std::string>> values = {
      {"readers_of_forces", std::to_string(outputs_.readers())},
      {"writers_of_" + source_->name(), std::to_string(source_->writers())},
      {"incompatible_qos", std::to_string(source_->incompatible_qos())}};
  AppendDrift(drift_, &values);
  AppendGap(gap_, &values);
  values.emplace_back("waiting_for", inputs_.Waiting());
  health_.Report(status, counts, values, Clock::now());
  LogForces();
  log_.WriteCounted();
}

void ForceEstimationNode::LogForces() {
  for (const std::string& line : force_lines_.Take(SecondsNow())) {
    log_.Write(Severity::kInfo, line);
  }
}

std::string ForceEstimationNode::NameOfCamera(int camera) const {
  return camera > 0 ? "camera '" + cameras_[At(camera - 1)].name + "'" : "the camera";
}

void ForceEstimationNode::LogDrift(const DriftReport& drift) {
  const bool moved = drift.state == DriftReport::State::kMoved;
  log_.Write(moved ? Severity::kWarning : Severity::kInfo,
             "calibration of " + NameOfCamera(drift.camera) + ": " + ToString(drift.state) +
                 (moved ? ": " + drift.advice : std::string()));
}

/// When the depth bias begins to be estimated, be it at the start or because a sequence begins
/// while the robot is at work, and when it is known.
void ForceEstimationNode::LogBiasFrames(int to_come) {
  const int before = std::exchange(bias_frames_to_come_, to_come);
  if (to_come > before) {
    log_.Write(Severity::kWarning, "learning the depth bias from " + std::to_string(to_come) +
                                       " frames: do not touch the robot");
  } else if (to_come == 0 && before > 0) {
    log_.Write(Severity::kInfo, "the depth bias is known: forces from now on");
  }
}

void ForceEstimationNode::LogGap(const GapReport& gap) {
  const bool grown = gap.state == GapReport::State::kGrown;
  log_.Write(grown ? Severity::kWarning : Severity::kInfo,
             "model gap: " + ToString(gap.state) + (grown ? ": " + gap.advice : std::string()));
}

bool ForceEstimationNode::IsSilent() const {
  return counts_.received > 0 && SecondsSince(last_frame_) > config_.silence_s;
}

/// A frame may take long: the first ones of a sequence have no limit of work.
bool ForceEstimationNode::IsOverdue() const {
  return working_since_ && SecondsSince(*working_since_) > config_.silence_s;
}

Status ForceEstimationNode::CurrentStatus() {
  const Status& late = lateness_.Judge(source_->name());
  if (IsSilent()) {
    return {StatusCode::kStale, "no " + source_->name() + " for " +
                                    FormatNumber(std::round(SecondsSince(last_frame_))) + " s"};
  }
  if (IsOverdue()) {
    return {StatusCode::kStale, "no estimate for " +
                                    FormatNumber(std::round(SecondsSince(*working_since_))) +
                                    " s: a frame is still being computed"};
  }
  // A moved camera also explains the status of the estimates.
  if (drift_.state == DriftReport::State::kMoved) {
    return {StatusCode::kNoCalibration, drift_.advice};
  }
  const bool usable = IsUsable(last_status_) || last_status_.code() == StatusCode::kNoCalibration;
  return usable ? late : last_status_;
}

}  // namespace palpate::force_estimation
