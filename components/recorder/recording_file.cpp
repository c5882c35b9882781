// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recording_file.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/seconds.hpp"

namespace palpate::recorder {

RecordingFile::RecordingFile(const std::filesystem::path& file, const FileExtras& extras)
    : writer_(std::make_unique<recording::OutputFile>(file), extras.options) {
  for (const recording::Metadata& metadata : extras.metadata) writer_.Write(metadata);
  for (const recording::Attachment& attachment : extras.attachments) writer_.Write(attachment);
}

std::uint16_t RecordingFile::ChannelOf(const RecordedMessage& message) {
  Channel& channel = channels_[message.topic];
  if (channel.id != 0) return channel.id;
  const TopicDescription& topic = *message.topic;
  const std::uint16_t schema = writer_.AddSchema(topic.type, topic.schema_encoding, topic.schema);
  std::map<std::string, std::string> metadata{{"offered_qos_profiles", topic.qos}};
  // A writer that is to send them again must have it as the readers of the type.
  if (topic.has_key) metadata["has_key"] = "true";
  channel.id = writer_.AddChannel({.id = 0,
                                   .schema_id = schema,
                                   .topic = topic.topic,
                                   .message_encoding = "cdr",
                                   .metadata = std::move(metadata)});
  return channel.id;
}

void RecordingFile::Write(const RecordedMessage& message) {
  const std::uint16_t id = ChannelOf(message);
  writer_.Write(recording::Message{id, channels_[message.topic].sequence++, message.log_time_ns,
                                   message.publish_time_ns, message.data});
}

RecordingFiles::RecordingFiles(std::filesystem::path file, FileExtras extras,
                               const Splitting& splitting)
    : file_(std::move(file)), extras_(std::move(extras)), splitting_(splitting) {
  Begin();
}

void RecordingFiles::Begin() {
  std::filesystem::path file = file_;
  if (splitting_.any()) {
    constexpr std::size_t kDigits = 4;
    std::string number = std::to_string(files_.size());
    number.insert(0, kDigits - std::min(kDigits, number.size()), '0');
    file.replace_filename(file_.stem().string() + "_" + number + file_.extension().string());
  }
  current_ = std::make_unique<RecordingFile>(file, extras_);
  files_.push_back(file);
  first_received_ns_.reset();
}

bool RecordingFiles::IsFull(const RecordedMessage& next) const {
  if (!first_received_ns_) return false;
  if (splitting_.bytes > 0 && current_->size() + next.data.size() > splitting_.bytes) return true;
  return splitting_.duration_s > 0.0 &&
         NsToSeconds(next.received_ns - *first_received_ns_) >= splitting_.duration_s;
}

void RecordingFiles::Write(const RecordedMessage& message) {
  if (IsFull(message)) {
    current_->Close();
    closed_bytes_ += current_->size();
    Begin();
    for (auto& [topic, latched] : latched_) {
      RecordedMessage again = latched;
      again.log_time_ns = message.log_time_ns;
      current_->Write(again);
    }
  }
  if (!first_received_ns_) first_received_ns_ = message.received_ns;
  current_->Write(message);
  if (message.topic->latched && splitting_.any()) latched_[message.topic->topic] = message;
}

}  // namespace palpate::recorder
