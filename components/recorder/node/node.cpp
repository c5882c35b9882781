// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/node.hpp"

#include <utility>

#include "components/recorder/node/describe_topic.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::recorder {

namespace {

using Clock = dds::WaitSet::Clock;

constexpr auto kReportPeriod = std::chrono::seconds(1);
/// A key or signal is seen within this time.
constexpr auto kLookPeriod = std::chrono::milliseconds(50);

/// "2026-01-31T12-00-00.250Z": for names of files.
std::string TimeForName() {
  std::string text = UtcTextOfNs(WallNow_ns());
  for (char& c : text) c = c == ':' ? '-' : c;
  return text;
}

}  // namespace

RecorderNode::RecorderNode(const NodeConfig& config, RecordPlan plan, int domain_id,
                           dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : config_(config),
      plan_(std::move(plan)),
      participant_(dds::ParticipantOf(config.dds, "palpate_recorder", domain_id), std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "recorder", Clock::now()),
      diagnostics_(participant_.CreateReader(dds::kDiagnosticsTopic)),
      publications_(
          participant_.handle(),
          [](const std::string& type) { return !FindRos2msg(recording::RosTypeName(type)); }),
      thread_(config, plan_.only_recent ? std::nullopt : std::optional(plan_.file), plan_.extras,
              [this] { loop_.Wake(); }),
      start_(Clock::now()) {
  loop_.Attach(publications_.reader(), [this] { UpdateTopics(); });
  loop_.Attach(diagnostics_, [this] { TakeDiagnostics(); });
  loop_.Every(kLookPeriod, [this] { LookAfter(); });
  loop_.Every(kReportPeriod, [this] { Report(); });
}

void RecorderNode::Run() {
  const auto failed = [this] { return !thread_.state().error.empty(); };
  const auto end =
      plan_.duration_s > 0.0 ? start_ + FromSeconds(plan_.duration_s) : Clock::time_point::max();
  loop_.DispatchUntil(failed, end);
  const std::string error = thread_.state().error;
  if (!error.empty()) log_.Write(Severity::kError, "the recording ends: " + error);
  RecorderStatus last = Status();
  topics_.clear();
  thread_.Stop();
  last.written_bytes = thread_.state().written_bytes;
  last.waiting_bytes = 0;
  last.ended = true;
  if (plan_.show) plan_.show(last);
}

bool RecorderNode::IsChosen(const dds::Publication& publication) const {
  if (recording::IsRosInternal(publication.dds_topic)) return false;
  const std::string name = recording::RosTopicName(publication.dds_topic);
  for (const dds::TopicSettings& topic : participant_.table().topics()) {
    const bool named = !plan_.choice.wanted.empty();
    if (topic.name == name && !topic.recorded && !named) return false;
  }
  return plan_.choice.Includes(name);
}

void RecorderNode::UpdateTopics() {
  if (!publications_.Update()) return;
  for (const auto& [guid, publication] : publications_.all()) {
    if (IsChosen(publication)) Follow(publication);
  }
}

void RecorderNode::Follow(const dds::Publication& publication) {
  auto& topic = topics_[{publication.dds_topic, publication.dds_type}];
  if (!topic) {
    const TopicDescription description = Describe(publication);
    topic = std::make_unique<RecordedTopic>(
        participant_.handle(), dds::RawTopicOf(publication), description,
        [this](RecordedMessage message) { return thread_.Push(std::move(message)); });
    log_.Write(Severity::kInfo, "records " + description.topic + " (" + description.type + ")");
    if (description.schema.empty()) {
      log_.Write(Severity::kWarning,
                 description.topic + ": nobody told the definition of " + description.type +
                     ": recorded, but other programs cannot decode it (is its package in "
                     "AMENT_PREFIX_PATH?)");
    }
    return;
  }
  // A reader that asks for more than a writer offers gets nothing of that writer.
  dds::RawTopic asked = topic->topic();
  const bool was_reliable = asked.reliability == dds::Reliability::kReliable;
  if (!dds::AskLess(publication, &asked)) return;
  const bool too_reliable = was_reliable && asked.reliability == dds::Reliability::kBestEffort;
  topic->Read(participant_.handle(), asked, Describe(publication));
  log_.Write(Severity::kWarning,
             topic->description().topic + ": a writer offers less than another one: read as " +
                 std::string(too_reliable ? "best effort" : "volatile") + " from now on");
}

void RecorderNode::TakeDiagnostics() {
  constexpr auto kError = diagnostic_msgs_msg_DiagnosticStatus_Constants_ERROR;
  for (const idl::diagnostic_msgs::DiagnosticArray& array : diagnostics_.Take()) {
    for (const auto& status : dds::Elements(array.status)) {
      const std::string name(dds::Text(status.name));
      if (status.level != kError) {
        in_error_.erase(name);
        continue;
      }
      const bool is_new = in_error_.insert(name).second;
      const bool paused =
          last_error_saved_ && SecondsSince(*last_error_saved_) < config_.error_pause_s;
      if (!is_new || paused || !config_.save_on_error || config_.recent_s <= 0.0) continue;
      last_error_saved_ = Clock::now();
      Save("error", name + ": " + std::string(dds::Text(status.message)));
    }
  }
}

void RecorderNode::Save(const std::string& kind, const std::string& reason) {
  std::filesystem::path file = plan_.file;
  file.replace_filename(plan_.file.stem().string() + "_" + kind + "_" + TimeForName() + ".mcap");
  log_.Write(Severity::kInfo, "saves the last seconds in " + file.string() +
                                  (reason.empty() ? "" : " (" + reason + ")"));
  thread_.SaveRecent(file, reason);
}

void RecorderNode::LookAfter() {
  if (snapshot_requested_.exchange(false)) {
    if (config_.recent_s > 0.0) {
      Save("snapshot", "");
    } else {
      log_.Write(Severity::kWarning, "no snapshot: recent_s is 0, nothing is kept in memory");
    }
  }
  const RecordingThread::State state = thread_.state();
  for (; snapshots_told_ < state.snapshots.size(); ++snapshots_told_) {
    log_.Write(Severity::kInfo, "saved " + state.snapshots[snapshots_told_].string());
  }
}

RecorderStatus RecorderNode::Status() const {
  RecorderStatus status = Totals();
  for (const auto& [name, topic] : topics_) {
    status.topics.push_back(topic->MeanRow(MonotonicNow_ns()));
  }
  return status;
}

RecorderStatus RecorderNode::Totals() const {
  RecorderStatus status;
  const RecordingThread::State state = thread_.state();
  status.duration_s = SecondsSince(start_);
  status.written_bytes = state.written_bytes;
  status.waiting_bytes = state.waiting_bytes;
  status.recent_s = config_.recent_s > 0.0 ? state.recent_s : 0.0;
  status.recent_slot_s = state.recent_slot_s;
  if (!state.files.empty()) status.file = state.files.back().string();
  return status;
}

void RecorderNode::Report() {
  RecorderStatus status = Totals();
  for (auto& [name, topic] : topics_) {
    status.topics.push_back(topic->NextRow(MonotonicNow_ns()));
  }
  dds::HealthCounts counts;
  for (const TopicRow& row : status.topics) {
    counts.received += row.messages;
    counts.dropped += row.lost;
  }
  health_.Report(palpate::Status::Ok(), counts,
                 {{"file", status.file}, {"topics", std::to_string(status.topics.size())}},
                 Clock::now());
  log_.WriteCounted();
  if (plan_.show) plan_.show(status);
}

}  // namespace palpate::recorder
