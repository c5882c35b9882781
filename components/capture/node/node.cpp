// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/node.hpp"

#include <cmath>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::capture {

namespace {

constexpr auto kLookPeriod = std::chrono::milliseconds(100);
constexpr auto kReportPeriod = std::chrono::seconds(1);
constexpr auto kLastMessagesWait = std::chrono::seconds(2);
constexpr auto kFirstReminder = std::chrono::seconds(8);
constexpr double kFrameWait_s = 0.1;

Status StatusOf(const SourceHealth& health) {
  switch (health.state) {
    case SourceState::kStream: return Status::Ok();
    case SourceState::kEnded: return {StatusCode::kStale, health.reason};
    default:
      return {health.epoch == 0 ? StatusCode::kNotRun : StatusCode::kStale,
              health.reason.empty() ? std::string("no frames yet") : health.reason};
  }
}

/// `name` of the node or component, of a further camera with that camera's name behind it.
std::string WithCamera(const std::string& name, const NodeConfig& config) {
  return config.camera_name.empty() ? name : name + "_" + config.camera_name;
}

}  // namespace

CaptureNode::CaptureNode(const NodeConfig& config, std::unique_ptr<FrameSource> source,
                         int domain_id, dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : step_{config.source == "replay" && config.replay.clock == "step"},
      wait_for_reader_{config.wait_for_reader},
      participant_{dds::ParticipantOf(config.dds, WithCamera("palpate_capture", config), domain_id),
                   std::move(table)},
      loop_{participant_},
      log_{participant_, std::move(process_log)},
      health_{participant_, WithCamera("capture", config), Clock::now()},
      publisher_{participant_, [this] { loop_.Wake(); }, config.subpixel_sigma_px,
                 config.camera_name},
      source_{std::move(source)},
      next_report_{Clock::now()} {
  loop_.Every(kLookPeriod, [this] { WatchSource(); });
}

CaptureNode::~CaptureNode() {
  stop_ = true;
  if (writer_.joinable()) writer_.join();
}

void CaptureNode::Stop() {
  stop_ = true;
  loop_.Stop();
}

void CaptureNode::Run() {
  if (wait_for_reader_) {
    log_.Write(Severity::kInfo, "waiting for a reader of the frame info");
    loop_.DispatchUntil([this] { return publisher_.readers() > 0; }, Clock::time_point::max());
  }
  if (loop_.stopped()) return;
  writer_ = std::thread([this] { PublishFrames(); });
  loop_.Run();
  stop_ = true;
  writer_.join();
  WatchSource();
  const SourceHealth health = source_->Health();
  Report(health);
  if (!publisher_.WaitUntilReceived(kLastMessagesWait)) {
    log_.Write(Severity::kWarning, "a reader has not confirmed the last frames");
  }
  const bool nothing_read = health.frames == 0 && health.frames_failed > 0;
  if (health.state == SourceState::kEnded && nothing_read) throw RunError(health.reason);
}

void CaptureNode::PublishFrames() {
  while (!stop_) {
    const FramePtr frame = source_->Next(kFrameWait_s);
    if (frame) {
      PublishOne(*frame);
    } else if (source_->Health().state == SourceState::kEnded) {
      break;
    }
  }
  loop_.Stop();
}

void CaptureNode::PublishOne(const SourceFrame& frame) {
  const bool sent = publisher_.Publish(frame, source_->Health());
  // Step by step, so that no reader misses a frame.
  if (step_ && !publisher_.WaitUntilReceived(kLastMessagesWait)) {
    log_.WarnRepeatedly("a reader has not confirmed a frame");
  }
  const double latency_s = NsToSeconds(WallNow_ns() - frame.facts.stamp_host_ns);
  const std::lock_guard lock(mutex_);
  ++(sent ? counts_.published : counts_.dropped);
  if (frame.facts.clock_source != ClockSource::kReplay) counts_.latencies_s.push_back(latency_s);
}

void CaptureNode::WatchSource() {
  const SourceHealth health = source_->Health();
  const std::string words = std::string(NameOf(health.state)) + ": " + health.reason;
  const bool changed = words != last_words_ || health.notes != last_notes_;
  if (changed) LogChange(health);
  last_words_ = words;
  RemindOfCamera(health, changed);
  if (!changed && Clock::now() < next_report_) return;
  next_report_ = Clock::now() + kReportPeriod;
  Report(health);
}

/// While no frame comes, the log says so again, each time after twice the pause.
void CaptureNode::RemindOfCamera(const SourceHealth& health, bool changed) {
  const Clock::time_point now = Clock::now();
  if (changed || health.state == SourceState::kStream || health.state == SourceState::kEnded) {
    waits_since_ = now;
    next_reminder_ = now + kFirstReminder;
  } else if (now >= next_reminder_) {
    log_.Write(
        Severity::kWarning,
        "waiting for the camera for " + FormatNumber(std::round(ToSeconds(now - waits_since_))) +
            " s: " + (health.reason.empty() ? std::string(NameOf(health.state)) : health.reason));
    next_reminder_ = now + (now - waits_since_);
  }
}

void CaptureNode::LogChange(const SourceHealth& health) {
  if (health.state == SourceState::kStream) {
    log_.Write(Severity::kInfo,
               health.device + " streams (epoch " + std::to_string(health.epoch) + ")");
  } else if (!health.reason.empty() && last_words_.find(health.reason) == std::string::npos) {
    const bool all_well = health.state == SourceState::kEnded && health.frames_failed == 0;
    log_.Write(all_well ? Severity::kInfo : Severity::kWarning, health.reason);
  }
  if (health.notes == last_notes_) return;
  last_notes_ = health.notes;
  for (const std::string& note : health.notes) log_.Write(Severity::kWarning, note);
}

void CaptureNode::Report(const SourceHealth& health) {
  dds::HealthCounts counts;
  {
    const std::lock_guard lock(mutex_);
    counts = counts_;
    counts_.latencies_s.clear();
  }
  counts.received = health.frames;
  counts.refused = health.frames_failed;
  counts.dropped += health.frames_dropped;
  health_.Report(StatusOf(health), counts,
                 {{"state", std::string(NameOf(health.state))},
                  {"device", health.device},
                  {"model", health.model},
                  {"epoch", std::to_string(health.epoch)},
                  {"packets_resent", std::to_string(health.packets_resent)},
                  {"packets_lost", std::to_string(health.packets_lost)},
                  {"socket_drops", std::to_string(health.socket_drops)},
                  {"last_failure", health.last_failure}},
                 Clock::now());
  log_.WriteCounted();
}

}  // namespace palpate::capture
