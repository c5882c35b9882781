// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/node.hpp"

#include "components/view/access_settings.hpp"
#include "libs/core/check.hpp"
#include "libs/core/clock.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/monitor/snapshot_json.hpp"

namespace palpate::view {

namespace {

using WallClock = dds::WaitSet::Clock;

constexpr auto kReportPeriod = std::chrono::seconds(1);
/// Clients that come and go are seen within this time.
constexpr auto kLookPeriod = std::chrono::milliseconds(100);
/// Of a recording: half of what a frame lasts.
constexpr auto kPlayPeriod = std::chrono::milliseconds(15);
/// Foxglove sends lists of what it subscribes to.
constexpr std::size_t kMostFoxgloveBytes = 256 * 1024;

std::string UrlHost(const std::string& address) {
  return address.find(':') == address.npos ? address : "[" + address + "]";
}

PortSettings PortOf(const HttpConfig& config, int port, AccessRules rules) {
  PortSettings settings;
  settings.address = config.address;
  settings.port = port;
  settings.further = config.further_ports;
  settings.rules = std::move(rules);
  settings.max_clients = config.max_clients;
  return settings;
}

/// What the page calls the source of what it shows.
std::string SourceWord(const ViewPlan& plan, bool is_experiment) {
  if (is_experiment) return "experiment";
  if (plan.robot_alone) return "robot";
  return plan.recording.empty() ? "live" : "recording";
}

PageGreeting GreetingOf(const NodeConfig& config, const ViewPlan& plan, bool is_experiment,
                        int domain_id) {
  const std::string source = SourceWord(plan, is_experiment);
  return {
      .version = plan.version,
      .source = source,
      .source_name = source == "live" ? "domain " + std::to_string(domain_id) : plan.source_name,
      .read_only = !config.allow_control};
}

}  // namespace

ViewNode::ViewNode(const NodeConfig& config, ViewPlan plan, int domain_id, dds::TopicTable table,
                   dds::NodeLog::ProcessLog process_log)
    : config_(config),
      participant_(dds::ParticipantOf(config.dds, "palpate_view", domain_id), std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "view", WallClock::now()),
      robot_(std::move(plan.robot)),
      experiment_(std::move(plan.experiment)),
      feed_(config, domain_id, robot_.get(), Outputs()),
      recorder_(plan.recorder) {
  page_ = std::make_unique<PageHub>(GreetingOf(config, plan, experiment_ != nullptr, domain_id),
                                    &server_, [this](ClientId client, PageRequest request) {
                                      Ask(PageWish{client, std::move(request)});
                                    });
  foxglove_ = std::make_unique<FoxgloveHub>("palpate", plan.version, &server_,
                                            [this](foxglove::ChannelId channel, bool wanted) {
                                              Ask(ChannelWish{channel, wanted});
                                            });
  Listen(plan);
  ChooseSource(plan);
  page_->SetSnapshot(monitor::SnapshotJson(feed_.TellHealth(dds::WallClockNs())));
  loop_.OnWake([this] { Serve(); });
  loop_.Every(kLookPeriod, [this] { Serve(); });
  loop_.Every(kReportPeriod, [this] { Report(); });
  server_.Start();
}

FeedOutputs ViewNode::Outputs() {
  return {.publish =
              [this](OutMessage message) {
                ++published_;
                page_->Publish(std::move(message));
              },
          .wants_clouds = [this] { return page_->WantsClouds(); },
          .wants_images = [this] { return page_->WantsImages(); },
          .publish_scene =
              [this](std::string json, std::int64_t stamp_ns) {
                const auto bytes = std::make_shared<const std::string>(std::move(json));
                foxglove_->Publish(FoxgloveHub::kSceneChannel, stamp_ns, {bytes, *bytes});
              },
          .wants_scene = [this] { return foxglove_->IsWanted(FoxgloveHub::kSceneChannel); },
          .warn = [this](const std::string& text) { log_.WarnRepeatedly(text); }};
}

void ViewNode::Listen(const ViewPlan& plan) {
  PortSettings page = PortOf(config_.http, config_.http.port, PageRules(config_.http, plan.token));
  page_port_ = server_.Listen(page, page_.get());
  page_->TellCounts();
  log_.Write(Severity::kInfo,
             "page: " + page_url() + (plan.token.empty() ? "" : " (with ?token=...)"));
  if (!config_.foxglove.enabled) return;
  PortSettings foxglove = PortOf(config_.http, config_.foxglove.port,
                                 FoxgloveRules(config_.http, config_.foxglove, plan.token));
  foxglove.max_message_bytes = kMostFoxgloveBytes;
  foxglove_port_ = server_.Listen(foxglove, foxglove_.get());
  foxglove_->AddChannel({.id = FoxgloveHub::kSceneChannel,
                         .topic = "/view/robot_scene",
                         .encoding = "json",
                         .schema_name = std::string(foxglove::kSceneSchemaName),
                         .schema = foxglove::SceneSchema(),
                         .schema_encoding = "jsonschema"},
                        1);
  log_.Write(Severity::kInfo, "Foxglove: ws://" + UrlHost(config_.http.address) + ":" +
                                  std::to_string(foxglove_port_));
}

std::string ViewNode::page_url() const {
  return "http://" + UrlHost(config_.http.address) + ":" + std::to_string(page_port_) + "/";
}

void ViewNode::ChooseSource(const ViewPlan& plan) {
  if (experiment_) {
    played_ = std::make_unique<ExperimentSource>(*experiment_, *robot_, &feed_);
  } else if (plan.robot_alone) {
    PALPATE_CHECK(robot_ != nullptr);
    robot_source_ = std::make_unique<RobotSource>(*robot_, &feed_);
    robot_source_->Show(dds::WallClockNs());
    return;
  } else if (!plan.recording.empty()) {
    PlayRecording(plan);
  } else {
    live_ = std::make_unique<LiveSource>(config_, participant_, loop_, &feed_);
    if (!config_.foxglove.enabled) return;
    foxglove_topics_ = std::make_unique<FoxgloveTopics>(participant_, loop_, log_, foxglove_.get());
    return;
  }
  loop_.Every(kPlayPeriod, [this] { PlayOn(); });
}

void ViewNode::PlayOn() {
  watched_ = watched_ || page_->clients() > 0 || foxglove_->clients() > 0;
  if (watched_) played_->Advance(MonotonicNow_ns());
}

void ViewNode::PlayRecording(const ViewPlan& plan) {
  auto recording = std::make_unique<RecordingSource>(plan.recording, &feed_);
  if (config_.foxglove.enabled) {
    foxglove_recording_ = std::make_unique<FoxgloveRecording>(recording.get(), foxglove_.get());
  }
  played_ = std::move(recording);
}

void ViewNode::Ask(Wish wish) {
  {
    const std::lock_guard lock(mutex_);
    wishes_.push_back(std::move(wish));
  }
  loop_.Wake();
}

void ViewNode::Serve() {
  std::vector<Wish> wishes;
  {
    const std::lock_guard lock(mutex_);
    wishes.swap(wishes_);
  }
  for (const Wish& wish : wishes) {
    if (const auto* page = std::get_if<PageWish>(&wish)) {
      Answer(*page);
    } else {
      const auto& channel = std::get<ChannelWish>(wish);
      if (foxglove_topics_) foxglove_topics_->SetWanted(channel.channel, channel.wanted);
      if (foxglove_recording_) foxglove_recording_->SetWanted(channel.channel, channel.wanted);
    }
  }
  if (live_) live_->TakeImages(page_->WantsImages());
}

void ViewNode::Answer(const PageWish& wish) {
  if (const auto* probe = std::get_if<ProbeRequest>(&wish.request)) {
    page_->Reply(wish.client, feed_.Probe(*probe));
  } else if (const auto* record = std::get_if<RecordRequest>(&wish.request)) {
    const std::string reason = live_ ? recorder_.Set(record->on) : "no running system is shown";
    if (!reason.empty()) page_->Refuse(wish.client, "record", reason);
    page_->Publish(recorder_.State());
  } else if (!played_) {
    const bool is_play = std::holds_alternative<PlayRequest>(wish.request);
    page_->Refuse(wish.client, is_play ? "play" : "seek", "nothing is played");
  } else {
    if (const auto* play = std::get_if<PlayRequest>(&wish.request)) played_->Play(*play);
    if (const auto* seek = std::get_if<SeekRequest>(&wish.request)) played_->Seek(*seek);
    page_->Publish(played_->State());
  }
}

void ViewNode::Report() {
  page_->SetSnapshot(monitor::SnapshotJson(feed_.TellHealth(dds::WallClockNs())));
  page_->Publish(recorder_.State());
  if (played_) page_->Publish(played_->State());
  if (robot_source_) robot_source_->Show(dds::WallClockNs());
  dds::HealthCounts counts;
  counts.received = feed_.received();
  counts.published = published_;
  counts.refused = feed_.refused();
  health_.Report(Status::Ok(), counts,
                 {{"clients", std::to_string(page_->clients())},
                  {"page_port", std::to_string(page_port_)},
                  {"foxglove_port", std::to_string(foxglove_port_)}},
                 WallClock::now());
  log_.WriteCounted();
}

}  // namespace palpate::view
