// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/player/node/convert.hpp"
#include "components/player/node/periods.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::player {

namespace {

using Clock = dds::WaitSet::Clock;

}  // namespace

PlayerNode::PlayerNode(const NodeConfig& config, const Playback& playback, ExperimentPlayer player,
                       int domain_id, dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : config_(config),
      playback_(playback),
      player_(std::move(player)),
      participant_(dds::ParticipantOf(config.dds, "palpate_player", domain_id), std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "player", Clock::now()),
      markers_(participant_.CreateWriter(dds::kMarkersTopic, [this] { loop_.Wake(); })),
      joint_states_(participant_.CreateWriter(dds::kJointStatesTopic, [this] { loop_.Wake(); })),
      forces_(participant_.CreateReader(dds::kForcesTopic, [this] { loop_.Wake(); })),
      pacer_(playback.rate, [] { return Clock::now().time_since_epoch(); }) {
  if (player_.plays_images()) {
    images_.emplace(participant_, player_.experiment(), [this] { loop_.Wake(); });
    for (const std::string& camera : player_.further_cameras()) {
      further_.try_emplace(
          camera, participant_, player_.experiment(), [this] { loop_.Wake(); }, camera);
    }
  }
  if (config.publish_clock) {
    clock_.emplace(participant_.CreateWriter(dds::kClockTopic));
    if (!playback.step && std::isfinite(playback.rate)) {
      loop_.Every(kClockPeriod, [this] { AdvanceClock(); });
    }
  }
  loop_.Attach(forces_, [this] { TakeForces(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
}

void PlayerNode::Run() {
  if (config_.wait_for_readers) WaitForReaders();
  known_estimators_ = forces_.counters().matched_ever;
  do {
    PlayAll();
    player_.RewindAll();
  } while (playback_.loop && !loop_.stopped());
  ReportHealth();
  if (loop_.stopped()) return;
  if (!WaitUntilReceived(kLastMessagesWait))
    log_.Write(Severity::kWarning, "a reader has not confirmed the last frames");
}

/// Readers that start together, a recorder among them, are found one after the other.
void PlayerNode::Settle() {
  const auto readers = [this] {
    std::uint32_t count = joint_states_.counters().matched_ever + markers_.counters().matched_ever +
                          (images_ ? images_->readers() : 0);
    for (const auto& [camera, images] : further_) count += images.readers();
    return count;
  };
  for (std::uint32_t known = readers() + 1; known != readers();) {
    known = readers();
    const auto changed = [&] { return readers() != known; };
    loop_.DispatchUntil(changed, Clock::now() + FromSeconds(config_.settle_s));
    if (loop_.stopped()) return;
  }
}

void PlayerNode::WaitForReaders() {
  is_confirmed_ = false;
  const std::string topic = images_ ? images_->depth_topic() : markers_.ros_name();
  log_.Write(Severity::kInfo, "waiting for readers of " + topic);
  const Clock::time_point deadline = Clock::now() + FromSeconds(config_.reader_deadline_s);
  if (loop_.DispatchUntil([this] { return ReadersAreThere(); }, deadline)) return Settle();
  if (loop_.stopped()) return;
  throw RunError("no reader of " + topic +
                 std::string(playback_.step ? " and answers on " + forces_.ros_name() : "") +
                 " within " + FormatNumber(config_.reader_deadline_s) +
                 " s: is the force estimation running, in this domain? (reader_deadline_s, "
                 "wait_for_readers)");
}

bool PlayerNode::ReadersAreThere() const {
  const bool frames_are_read = images_ ? images_->is_read() : markers_.matched() > 0;
  return frames_are_read && (!player_.has_cables() || joint_states_.matched() > 0) &&
         (!playback_.step || forces_.matched() > 0);
}

void PlayerNode::PlayAll() {
  pacer_.Restart();
  while (const std::optional<Event> event = player_.Next()) {
    Play(*event);
    if (loop_.stopped()) return;
    if (NewEstimator()) Rewind();
  }
}

void PlayerNode::Play(const Event& event) {
  if (playback_.step) {
    Publish(event);
    WaitForAnswer(event);
    return;
  }
  const Clock::time_point due = Clock::now() + pacer_.TimeUntil(event.recording, event.t_s);
  if (event.recording == event_recording_) next_event_ns_ = StampOf(event, config_.start_time_s);
  loop_.DispatchUntil([this] { return NewEstimator(); }, due);
  if (loop_.stopped() || NewEstimator()) return;
  Publish(event);
  if (!is_confirmed_ && event.has_frame()) ConfirmFirst(event);
}

/// The player may know a reader that does not know it yet. Time stands until the readers confirm
/// the first frame, so that later ones do not push it out of the writer's history.
void PlayerNode::ConfirmFirst(const Event& event) {
  is_confirmed_ = true;
  if (!WaitUntilReceived(kFirstMessagesWait)) {
    log_.Write(Severity::kWarning, "a reader has not confirmed the first frame");
  }
  pacer_.Restart();
  pacer_.TimeUntil(event.recording, event.t_s);
}

bool PlayerNode::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  bool frames = images_ ? images_->WaitUntilReceived(at_most) : markers_.WaitUntilReceived(at_most);
  for (auto& [camera, images] : further_) frames = images.WaitUntilReceived(at_most) && frames;
  return joint_states_.WaitUntilReceived(at_most) && frames;
}

void PlayerNode::WaitForAnswer(const Event& event) {
  if (!event.has_frame()) return;
  const Clock::time_point deadline = Clock::now() + FromSeconds(config_.step_deadline_s);
  const auto done = [&] { return Answered(event) || NewEstimator(); };
  while (Clock::now() < deadline) {
    const auto resend = std::min(deadline, Clock::now() + FromSeconds(config_.resend_s));
    if (loop_.DispatchUntil(done, resend) || loop_.stopped()) return;
    Publish(event);
  }
  throw RunError("no answer on " + forces_.ros_name() + " to the frame at " +
                 FormatNumber(event.t_s) + " s of recording '" + event.recording + "' within " +
                 FormatNumber(config_.step_deadline_s) + " s (step_deadline_s)");
}

bool PlayerNode::Answered(const Event& event) const {
  // Before the first image of the first camera, perception does not know which one it is.
  const bool is_unnamed = event.t_ns && !event.images && answered_recording_.empty();
  return answered_stamp_ns_ == StampOf(event, config_.start_time_s) &&
         (is_unnamed || answered_recording_ == (images_ ? images_->device() : event.recording));
}

void PlayerNode::Publish(const Event& event) {
  const int64_t stamp_ns = StampOf(event, config_.start_time_s);
  event_ns_ = stamp_ns;
  event_time_ = Clock::now();
  event_recording_ = event.recording;
  next_event_ns_.reset();
  PublishClock(stamp_ns);
  // Commands first: whoever takes the frame shall find those of the same stamp.
  bool sent = joint_states_.Write(ToJointState(event, stamp_ns));
  if (event.markers) {
    sent = markers_.Write(ToMarkerArray(event, stamp_ns)) && sent;
    ++counts_.published;
  }
  if (event.t_ns) {
    sent = PublishImages(event, stamp_ns) && sent;
    ++counts_.published;
  }
  if (!sent) ++counts_.dropped;
}

/// Each camera's images have their own stamps. Those of the first come last: who takes them finds
/// the others of the frame.
bool PlayerNode::PublishImages(const Event& event, std::int64_t stamp_ns) {
  bool sent = true;
  for (const FurtherImages& further : event.further) {
    const std::int64_t later_ns = further.images.t_ns - *event.t_ns;
    sent = further_.at(further.camera).Publish(further.images, stamp_ns + later_ns) && sent;
  }
  return (!event.images || images_->Publish(*event.images, stamp_ns)) && sent;
}

void PlayerNode::PublishClock(int64_t now_ns) {
  if (!clock_) return;
  dds::Message<idl::rosgraph_msgs::Clock> message;
  message->clock = dds::TimeFromNs(now_ns);
  if (!clock_->Write(message)) ++counts_.dropped;
}

/// Between two events time passes as they are paced.
void PlayerNode::AdvanceClock() {
  if (!next_event_ns_) return;
  const double passed_s = playback_.rate * SecondsSince(event_time_);
  const auto passed_ns = static_cast<int64_t>(1e9 * passed_s);
  PublishClock(std::min(*next_event_ns_, event_ns_ + passed_ns));
}

void PlayerNode::TakeForces() {
  for (const idl::palpate_msgs::ForceArray& forces : forces_.Take()) {
    ++counts_.received;
    answered_stamp_ns_ = dds::StampNs(forces.header.stamp);
    answered_recording_ = dds::Text(forces.recording);
  }
}

bool PlayerNode::NewEstimator() const {
  return config_.rewind_for_new_estimator && forces_.counters().matched_ever > known_estimators_;
}

void PlayerNode::Rewind() {
  log_.Write(Severity::kInfo, "a force estimator appeared: the recording begins again");
  if (config_.wait_for_readers) WaitForReaders();
  known_estimators_ = forces_.counters().matched_ever;
  answered_stamp_ns_.reset();
  player_.RewindRecording();
  pacer_.Restart();
}

void PlayerNode::ReportHealth() {
  const Status status = counts_.dropped == 0
                            ? Status::Ok()
                            : Status(StatusCode::kStale, "DDS did not take all frames");
  health_.Report(status, counts_, {{"readers", std::to_string(markers_.matched())}}, Clock::now());
}

}  // namespace palpate::player
