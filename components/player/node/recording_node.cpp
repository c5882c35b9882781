// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/recording_node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "components/player/node/periods.hpp"
#include "libs/app/process_tuning.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::player {

namespace {

using RealClock = dds::WaitSet::Clock;

constexpr double kRateFactor = 1.25;
constexpr double kLeastRate = 0.01;
constexpr double kMostRate = 100.0;
/// Which topic's messages are steps, the first that is played.
constexpr std::array<std::string_view, 3> kStepTopics{"/perception/markers", "/perception/contacts",
                                                      "/camera/depth/image_raw"};

RecordingSource Checked(RecordingSource source, const RecordingPlan& plan) {
  const double duration_s = NsToSeconds(source.end_ns() - source.start_ns());
  if (plan.start_s > duration_s) {
    throw InputError("--start: " + FormatNumber(plan.start_s) +
                     " s is behind the end of the "
                     "recording, which has " +
                     FormatNumber(duration_s) + " s");
  }
  return source;
}

}  // namespace

dds::TopicTable TableOf(const dds::TopicTable& table, const std::vector<PlayedTopic>& topics) {
  std::vector<dds::TopicSettings> rows = table.topics();
  std::set<std::string> names;
  for (const dds::TopicSettings& row : rows) names.insert(row.name);
  for (const PlayedTopic& topic : topics) {
    if (!dds::IsRosTopicName(topic.name) || !names.insert(topic.name).second) continue;
    dds::TopicSettings row;
    row.name = topic.name;
    row.type = topic.type;
    row.depth = 10;
    rows.push_back(std::move(row));
  }
  return dds::TopicTable(std::move(rows));
}

RecordingNode::RecordingNode(const dds::WithNodeSettings<Config>& config, RecordingPlan plan,
                             RecordingSource source, int domain_id, dds::TopicTable table,
                             dds::NodeLog::ProcessLog process_log)
    : config_(config),
      plan_(std::move(plan)),
      source_(Checked(std::move(source), plan_)),
      participant_(dds::ParticipantOf(config.dds, "palpate_player", domain_id),
                   TableOf(table, source_.topics())),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "player", RealClock::now()),
      writers_(participant_, log_, source_.topics(), [this] { loop_.Wake(); }),
      clock_(plan_.step ? std::numeric_limits<double>::infinity() : plan_.rate, MonotonicNow_ns) {
  ChooseStepTopic();
  if (plan_.step) answers_.emplace(participant_, loop_);
  if (config.publish_clock) {
    clock_writer_.emplace(participant_.CreateWriter(dds::kClockTopic));
    if (!plan_.step) {
      loop_.Every(kClockPeriod, [this] {
        if (is_playing_) PublishClock();
      });
    }
  }
  if (plan_.paused) clock_.Pause();
  position_ns_ = Begin_ns();
  loop_.Every(kReportPeriod, [this] { Report(); });
  for (const std::string& problem : source_.problems()) log_.Write(Severity::kWarning, problem);
}

std::int64_t RecordingNode::Begin_ns() const {
  return source_.start_ns() + std::llround(1e9 * plan_.start_s);
}

std::int64_t RecordingNode::End_ns() const {
  if (!plan_.end_s) return source_.end_ns();
  return std::min<std::int64_t>(source_.end_ns(),
                                source_.start_ns() + std::llround(1e9 * *plan_.end_s));
}

void RecordingNode::ChooseStepTopic() {
  const auto& topics = source_.topics();
  std::vector<std::string> names;
  for (const PlayedTopic& topic : topics) names.push_back(topic.name);
  const auto choose = [&](std::string_view name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) step_topic_ = static_cast<std::size_t>(found - names.begin());
    return found != names.end();
  };
  if (!plan_.step_topic.empty() && !choose(plan_.step_topic)) {
    throw InputError("--step-topic: '" + plan_.step_topic + "' is not among the played topics" +
                     DidYouMean(plan_.step_topic, names));
  }
  if (!plan_.step) return;
  if (!step_topic_ && std::none_of(kStepTopics.begin(), kStepTopics.end(), choose)) {
    throw InputError(
        "--step: the recording has neither markers nor contacts nor depth images; "
        "name the topic whose messages /forces answers (--step-topic)");
  }
  if (!topics[*step_topic_].has_header) {
    throw InputError("--step: messages of " + topics[*step_topic_].name +
                     " have no header whose stamp /forces could answer");
  }
}

void RecordingNode::Ask(Request request) {
  {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
  }
  loop_.Wake();
}

void RecordingNode::Run() {
  Settle();
  RefuseLiveTopics();
  if (config_.wait_for_readers) WaitForReaders();
  if (loop_.stopped()) return;
  RefuseLiveTopics();
  loop_.Attach(writers_.live_writers(), [this] {
    if (writers_.Update() && !plan_.beside_writers) writers_.SilenceNewLiveTopics();
  });
  do {
    lateness_s_.clear();
    PlayOnce();
  } while (plan_.loop && !loop_.stopped());
  if (!loop_.stopped() && !writers_.WaitUntilReceived(kLastMessagesWait)) {
    log_.Write(Severity::kWarning, "a reader has not confirmed the last messages");
  }
  PlaybackState state = State();
  state.ended = true;
  if (plan_.show) plan_.show(state);
  log_.Write(Severity::kInfo, "played " + PlaybackLine(state));
}

void RecordingNode::RefuseLiveTopics() {
  if (plan_.beside_writers) return;
  writers_.RefuseLiveTopics(answers_ ? dds::DdsTopicName(answers_->topic()) : "");
}

/// Those that start together with the player are found one after the other.
void RecordingNode::Settle() {
  bool is_new = true;
  while (is_new && !loop_.stopped()) {
    const std::uint64_t readers = writers_.readers_ever();
    const auto changed = [&] { return writers_.Update() || writers_.readers_ever() != readers; };
    is_new = loop_.DispatchUntil(changed, RealClock::now() + FromSeconds(config_.settle_s));
  }
}

void RecordingNode::WaitForReaders() {
  const auto read = [this] {
    if (!answers_) return writers_.readers() > 0;
    return writers_.readers(*step_topic_) > 0 && answers_->is_connected();
  };
  if (read()) return;
  const std::string what =
      answers_ ? source_.topics()[*step_topic_].name + " that answers on " + answers_->topic()
               : "any topic of the recording";
  log_.Write(Severity::kInfo, "waiting for a reader of " + what);
  const auto deadline = RealClock::now() + FromSeconds(config_.reader_deadline_s);
  if (loop_.DispatchUntil(read, deadline)) return Settle();
  if (loop_.stopped()) return;
  throw RunError(
      "no reader of " + what + " within " + FormatNumber(config_.reader_deadline_s) +
      " s, in this domain (reader_deadline_s; wait_for_readers=false plays all the same)");
}

void RecordingNode::MoveTo(std::int64_t time_ns) {
  const std::int64_t to_ns = std::clamp(time_ns, Begin_ns(), End_ns());
  for (const RecordingSource::Latched& latched : source_.LatchedBefore(to_ns)) {
    if (!writers_.Write(latched.topic, latched.data)) ++dropped_;
  }
  if (answers_) answers_->Forget();
  source_.Seek(to_ns);
  clock_.Set(to_ns);
  position_ns_ = to_ns;
}

void RecordingNode::PlayOnce() {
  MoveTo(Begin_ns());
  ChooseScheduling();
  is_playing_ = true;
  const std::uint32_t known_estimators = answers_ ? answers_->estimators_ever() : 0;
  const PlayedMessage* message = source_.Next();
  clock_.Set(position_ns_);  // time stood while the first messages were read
  while (message != nullptr && message->time_ns <= End_ns()) {
    const Due due = WaitUntilDue(*message);
    if (due == Due::kStopped) return;
    if (due == Due::kNow) Send(*message);
    const bool rewind = answers_ && config_.rewind_for_new_estimator &&
                        answers_->estimators_ever() > known_estimators;
    if (rewind) {
      log_.Write(Severity::kInfo, "a force estimator appeared: the recording begins again");
      if (config_.wait_for_readers) WaitForReaders();
      return PlayOnce();
    }
    message = source_.Next();
    if (due == Due::kMoved) clock_.Set(position_ns_);
  }
  WaitForAnswer();
}

RecordingNode::Due RecordingNode::WaitUntilDue(const PlayedMessage& message) {
  if (answers_ && IsStep(message.topic)) WaitForAnswer();
  while (!loop_.stopped()) {
    if (TakeRequest()) return Due::kMoved;
    if (steps_left_ > 0) return Due::kNow;
    const std::optional<std::int64_t> until_ns = clock_.Until_ns(message.time_ns);
    if (until_ns == 0) {
      DispatchInBetween();
      return loop_.stopped() ? Due::kStopped : Due::kNow;
    }
    const auto due = until_ns ? RealClock::now() + std::chrono::nanoseconds(*until_ns)
                              : RealClock::time_point::max();
    const auto asked = [this] {
      const std::lock_guard lock(mutex_);
      return !requests_.empty();
    };
    loop_.DispatchUntil(asked, due);
    next_dispatch_ = RealClock::now() + kClockPeriod;
  }
  return Due::kStopped;
}

/// Timers and events have their turn even where there is no time between messages.
void RecordingNode::DispatchInBetween() {
  const auto now = RealClock::now();
  if (now < next_dispatch_) return;
  next_dispatch_ = now + kClockPeriod;
  loop_.DispatchUntil([] { return false; }, now + std::chrono::microseconds(1));
}

/// True where the position in the recording has changed.
bool RecordingNode::TakeRequest() {
  std::vector<Request> requests;
  {
    const std::lock_guard lock(mutex_);
    requests.swap(requests_);
  }
  bool moved = false;
  for (const Request request : requests) {
    const auto seek_ns = std::llround(1e9 * config_.seek_s);
    const bool can_change_rate = !std::isinf(clock_.rate());
    switch (request) {
      case Request::kPauseOrResume: clock_.paused() ? clock_.Resume() : clock_.Pause(); break;
      case Request::kStep:
        clock_.Pause();
        steps_left_ += plan_.step_count;
        break;
      case Request::kForward:
      case Request::kBack:
        MoveTo(clock_.Now_ns() + (request == Request::kForward ? seek_ns : -seek_ns));
        moved = true;
        break;
      case Request::kFaster:
        if (can_change_rate) clock_.SetRate(std::min(kMostRate, clock_.rate() * kRateFactor));
        ChooseScheduling();
        break;
      case Request::kSlower:
        if (can_change_rate) clock_.SetRate(std::max(kLeastRate, clock_.rate() / kRateFactor));
        ChooseScheduling();
        break;
    }
  }
  return moved;
}

void RecordingNode::Send(const PlayedMessage& message) {
  const bool is_timed = !clock_.paused() && !std::isinf(clock_.rate());
  if (is_timed) {
    const double late_s = NsToSeconds(clock_.Now_ns() - message.time_ns) / clock_.rate();
    lateness_s_.push_back(late_s);
    recent_lateness_s_.push_back(late_s);
  } else {
    clock_.Set(message.time_ns);
  }
  if (!is_timed && clock_writer_) PublishClock();
  if (!writers_.Write(message.topic, message.data)) ++dropped_;
  if (is_timed) ConfirmFirst(message);
  if (answers_) answers_->NoteSent(message.topic, message.data, IsStep(message.topic));
  ++messages_;
  position_ns_ = message.time_ns;
  if (steps_left_ > 0 && IsStep(message.topic)) --steps_left_;
}

/// The player may know a reader that does not know it yet. Time stands until the reader confirms
/// the first message of its topic, so that later ones do not push it out of the writer's history.
void RecordingNode::ConfirmFirst(const PlayedMessage& message) {
  if (first_sent_ == RealClock::time_point()) first_sent_ = RealClock::now();
  if (RealClock::now() > first_sent_ + kDiscoveryTime) return;
  if (writers_.ConfirmFirst(message.topic, kFirstMessagesWait)) clock_.Set(message.time_ns);
}

/// Faster than it was recorded, it may need a whole core, which is not to be taken from others.
void RecordingNode::ChooseScheduling() {
  clock_.rate() <= 1.0 ? app::PreferPromptWakeUps() : app::EndPromptWakeUps();
}

void RecordingNode::WaitForAnswer() {
  if (!answers_ || !answers_->is_waiting()) return;
  const std::uint32_t known = answers_->estimators_ever();
  const auto done = [&] { return answers_->is_answered() || answers_->estimators_ever() > known; };
  const auto deadline = RealClock::now() + FromSeconds(config_.step_deadline_s);
  while (RealClock::now() < deadline) {
    const auto resend = std::min(deadline, RealClock::now() + FromSeconds(config_.resend_s));
    if (loop_.DispatchUntil(done, resend) || loop_.stopped()) return;
    for (const auto& [topic, cdr] : answers_->sent()) {
      if (!writers_.Write(topic, cdr)) ++dropped_;
    }
  }
  throw RunError("no answer on " + answers_->topic() + " to the frame with " +
                 dds::StampText(answers_->awaited_ns()) + " within " +
                 FormatNumber(config_.step_deadline_s) + " s (step_deadline_s)");
}

void RecordingNode::PublishClock() {
  dds::Message<idl::rosgraph_msgs::Clock> message;
  message->clock = dds::TimeFromNs(std::min(clock_.Now_ns(), End_ns()));
  if (!clock_writer_->Write(message)) ++dropped_;
}

PlaybackState RecordingNode::State() const {
  PlaybackState state;
  state.position_s = NsToSeconds(position_ns_ - source_.start_ns());
  state.duration_s = NsToSeconds(source_.end_ns() - source_.start_ns());
  state.rate = clock_.rate();
  state.paused = clock_.paused();
  state.messages = messages_;
  state.dropped = dropped_;
  state.lateness_p50_s = Quantile(lateness_s_, 0.5);
  state.lateness_p99_s = Quantile(lateness_s_, 0.99);
  return state;
}

void RecordingNode::Report() {
  dds::HealthCounts counts;
  counts.published = messages_;
  counts.dropped = dropped_;
  counts.latencies_s.swap(recent_lateness_s_);
  const PlaybackState state = State();
  health_.Report(
      dropped_ == 0 ? Status::Ok() : Status(StatusCode::kStale, "DDS did not take all messages"),
      counts,
      {{"position_s", FormatNumber(state.position_s)},
       {"paused", state.paused ? "true" : "false"},
       {"readers", std::to_string(writers_.readers())}},
      RealClock::now());
  log_.WriteCounted();
  if (plan_.show) plan_.show(state);
}

}  // namespace palpate::player
