// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/recording_source.hpp"

#include <algorithm>

#include "components/view/frames/binary_frame.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/decode_cdr.hpp"
#include "libs/dds/driver_topics.hpp"

namespace palpate::view {

namespace {

/// In one go; where more are due, the recording is shown more slowly.
constexpr int kMostAtOnce = 500;

}  // namespace

RecordingSource::RecordingSource(const std::vector<std::filesystem::path>& files, PageFeed* feed)
    : feed_(feed), recorded_(files) {
  Know(dds::kMeshTopic, &PageFeed::Take);
  Know(dds::kMeshStateTopic, &PageFeed::Take);
  Know(dds::kForcesTopic, &PageFeed::Take);
  Know(dds::kModelGapTopic, &PageFeed::Take);
  Know(dds::kPerceptionReportTopic, &PageFeed::Take);
  Know(dds::kFrameInfoTopic, &PageFeed::Take);
  Know(dds::kCalibrationTopic, &PageFeed::Take);
  Know(dds::kCalibrationStatusTopic, &PageFeed::Take);
  Know(dds::kCameraSetupTopic, &PageFeed::Take);
  Know(dds::kComponentStatusTopic, &PageFeed::Take);
  Know(dds::kDiagnosticsTopic, &PageFeed::Take);
  Know(dds::kJointStatesTopic, &PageFeed::Take);
  Know(dds::kTfStaticTopic, &PageFeed::Take);
  Know(dds::kMarkersTopic, &PageFeed::Take);
  Know(dds::kPackedColorTopic, &PageFeed::TakePackedColor);
  Know(dds::kPackedDepthTopic, &PageFeed::TakePackedDepth);
  Know(dds::kColorCameraInfoTopic, &PageFeed::TakeColorInfo);
  Know(dds::kRobotCloudTopic, &PageFeed::TakeRobotCloud);
  Know(dds::kObjectCloudTopic, &PageFeed::TakeObjectCloud);
  Know(dds::kTrueMeshTopic, &PageFeed::TakeTruth);
  Know(dds::kTrueMeshStateTopic, &PageFeed::TakeTruth);
  Know(dds::kTrueForcesTopic, &PageFeed::TakeTruth);
  Know(dds::kColorImageTopic, &PageFeed::TakeColorImage);
  Know(dds::kDepthImageTopic, &PageFeed::TakeDepthImage);
  const auto& channels = recorded_.contents().channels;
  const bool shows_any = std::any_of(channels.begin(), channels.end(),
                                     [this](const auto& one) { return IsShown(one.second); });
  if (!shows_any) {
    throw InputError(files.front().string() +
                     ": no topic that the page shows, such as /robot/mesh_state or /forces");
  }
  StartAt(0.0);
}

template <typename T>
void RecordingSource::Know(const dds::Topic<T>& topic, void (PageFeed::*take)(const T&)) {
  takes_[std::string(topic.name)] = [this, take](std::string_view cdr) {
    dds::Message<T> message;
    Status read = dds::DecodeCdr(cdr, &message);
    if (read.ok()) (feed_->*take)(*message);
    return read;
  };
}

/// Messages of the other channels between the newest and now have been given.
void RecordingSource::WantedHasGrown(std::uint16_t channel) {
  const auto is_it = [channel](const recording::Channel& one) { return one.id == channel; };
  for (const auto& stored : recorded_.NewestBefore(TimeAt(position_s_), is_it)) {
    further_.take(stored.message, stored.data);
  }
  Open();
}

bool RecordingSource::IsWanted(const recording::Channel& channel) const {
  return IsShown(channel) || (further_.wanted && further_.wanted(channel));
}

bool RecordingSource::IsShown(const recording::Channel& channel) const {
  return channel.message_encoding == "cdr" && takes_.contains(channel.topic);
}

void RecordingSource::Give(const recording::Message& message, std::string_view data) {
  const auto channel = recorded_.contents().channels.find(message.channel_id);
  if (channel == recorded_.contents().channels.end()) return;
  const auto take = takes_.find(channel->second.topic);
  if (take != takes_.end() && !take->second(data).ok()) ++unread_;
  if (further_.take) further_.take(message, data);
}

double RecordingSource::duration_s() const {
  const recording::Statistics& statistics = recorded_.contents().statistics;
  return NsToSeconds(statistics.end_time_ns - statistics.start_time_ns);
}

std::int64_t RecordingSource::TimeAt(double position_s) const {
  constexpr double kNsPerSecond = 1e9;
  return recorded_.contents().statistics.start_time_ns +
         static_cast<std::int64_t>(kNsPerSecond * position_s);
}

void RecordingSource::StartAt(double position_s) {
  position_s_ = std::clamp(position_s, 0.0, duration_s());
  const std::int64_t start_ns = TimeAt(position_s_);
  const auto wanted = [this](const recording::Channel& channel) { return IsWanted(channel); };
  feed_->Forget();
  std::vector<recording::StoredMessage> before = recorded_.NewestBefore(start_ns, wanted);
  std::sort(before.begin(), before.end(), [](const auto& a, const auto& b) {
    return a.message.log_time_ns < b.message.log_time_ns;
  });
  for (const recording::StoredMessage& stored : before) Give(stored.message, stored.data);
  Open();
}

/// At what comes after the present place.
void RecordingSource::Open() {
  const auto wanted = [this](const recording::Channel& channel) { return IsWanted(channel); };
  stream_.emplace(recorded_.Messages({.start_time_ns = TimeAt(position_s_) + 1, .wanted = wanted}));
  next_ = stream_->Next();
}

void RecordingSource::Advance(std::int64_t now_ns) {
  const double elapsed_s = last_ns_ ? NsToSeconds(now_ns - *last_ns_) : 0.0;
  last_ns_ = now_ns;
  if (paused_) return;
  position_s_ = std::min(position_s_ + rate_ * elapsed_s, duration_s());
  for (int given = 0; next_ != nullptr && next_->log_time_ns <= TimeAt(position_s_); ++given) {
    if (given == kMostAtOnce) {
      position_s_ = NsToSeconds(next_->log_time_ns - TimeAt(0.0));
      return;
    }
    Give(*next_, next_->data);
    next_ = stream_->Next();
  }
  if (next_ == nullptr) paused_ = true;
}

void RecordingSource::Play(const PlayRequest& request) {
  paused_ = request.paused;
  rate_ = request.rate;
  if (!paused_ && next_ == nullptr) StartAt(0.0);
}

void RecordingSource::Seek(const SeekRequest& request) { StartAt(request.position_s); }

OutMessage RecordingSource::State() const {
  return TextMessage("player", JsonText({{"kind", "player"},
                                         {"duration_s", duration_s()},
                                         {"position_s", position_s_},
                                         {"rate", rate_},
                                         {"paused", paused_},
                                         {"unread", unread_}}));
}

}  // namespace palpate::view
