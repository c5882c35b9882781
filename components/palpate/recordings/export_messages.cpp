// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/export_messages.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "components/offline/messages/ros_image.hpp"
#include "components/palpate/recordings/topic_export.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"

namespace palpate::command {

namespace {

/// "/camera/depth/image_raw" -> "camera_depth_image_raw"
std::string FileNameOf(const std::string& topic) {
  std::string name = topic.substr(topic.starts_with('/') ? 1 : 0);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

struct Channel {
  ExportedTopic told;
  std::unique_ptr<TopicExport> files;  ///< nullptr: its type is not known
};

class Exporter {
 public:
  Exporter(const recording::RecordedMessages& reader, const ExportOptions& options)
      : reader_(reader), options_(options) {
    std::set<std::string> known;
    for (const auto& [id, channel] : reader.contents().channels) known.insert(channel.topic);
    for (const std::string& topic : options.topics) {
      if (!known.contains(topic)) {
        throw InputError(Unknown("topic", topic, {known.begin(), known.end()}));
      }
    }
  }

  std::vector<ExportedTopic> Run() {
    for (const auto& [id, channel] : reader_.contents().channels) {
      if (IsWanted(channel)) Open(channel);
    }
    recording::MessageFilter filter;
    filter.wanted = [this](const recording::Channel& channel) { return IsWanted(channel); };
    recording::RecordedStream stream = reader_.Messages(filter);
    while (const recording::Message* message = stream.Next()) Take(*message);
    std::vector<ExportedTopic> told;
    for (auto& [id, channel] : channels_) {
      if (channel.files && channel.told.messages > 0) channel.files->Finish();
      told.push_back(channel.told);
    }
    return told;
  }

 private:
  bool IsWanted(const recording::Channel& channel) const {
    return options_.topics.empty() || IndexOf(channel.topic, options_.topics).has_value();
  }

  void Open(const recording::Channel& channel) {
    Channel& opened = channels_[channel.id];
    opened.told.topic = channel.topic;
    const std::unique_ptr<offline::MessageType> type = offline::TypeOf(reader_.SchemaOf(channel));
    if (!type) {
      opened.told.reason = "no definition of " + reader_.SchemaOf(channel).name + " is known";
      return;
    }
    // A topic whose type or QoS changed has more than one channel.
    std::string name = FileNameOf(channel.topic);
    if (!names_.insert(name).second) name += "_" + std::to_string(channel.id);
    const std::int64_t start_ns = reader_.contents().statistics.start_time_ns;
    opened.told.target = options_.out / name;
    if (type->name == offline::kImageType || type->name == offline::kCompressedImageType) {
      opened.files = MakeImageExport(*type, opened.told.target);
    } else if (type->name == "sensor_msgs/msg/PointCloud2") {
      opened.files = MakeCloudExport(*type, opened.told.target, options_.clouds);
    } else if (type->name == "palpate_msgs/msg/MeshState") {
      opened.files = MakeMeshExport(*type, opened.told.target, reader_, start_ns);
    } else {
      opened.told.target += ".csv";
      opened.files = MakeCsvExport(*type, opened.told.target, start_ns);
    }
  }

  void Take(const recording::Message& message) {
    Channel& channel = channels_.at(message.channel_id);
    const std::string reason = channel.files ? channel.files->Take(message) : channel.told.reason;
    ++(reason.empty() ? channel.told.messages : channel.told.left_out);
    if (!reason.empty()) channel.told.reason = reason;
  }

  const recording::RecordedMessages& reader_;
  const ExportOptions& options_;
  std::map<std::uint16_t, Channel> channels_;
  std::set<std::string> names_;
};

}  // namespace

std::vector<ExportedTopic> ExportMessages(const recording::RecordedMessages& reader,
                                          const ExportOptions& options) {
  return Exporter(reader, options).Run();
}

}  // namespace palpate::command
