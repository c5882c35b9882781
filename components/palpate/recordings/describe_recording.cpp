// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/describe_recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Topic {
  std::uint64_t count = 0;
  std::string serialization_format;
  bool has_definition = false;
};

/// What the files of one run hold.
struct Totals {
  std::vector<std::string> files;
  std::string storage_id;
  std::uint64_t size_bytes = 0;
  recording::Statistics statistics;
  std::set<std::string> profiles;
  std::map<std::pair<std::string, std::string>, Topic> topics;  ///< by name and type
  std::map<std::string, std::uint64_t> attachments;             ///< name, bytes
  std::vector<std::string> problems;
};

void AddChannels(const recording::RecordedMessages& recorded, Totals* totals) {
  const auto& counts = recorded.contents().statistics.channel_message_counts;
  for (const auto& [id, channel] : recorded.contents().channels) {
    const recording::Schema& schema = recorded.SchemaOf(channel);
    Topic& topic = totals->topics[{channel.topic, schema.name}];
    const auto count = counts.find(id);
    topic.count += count == counts.end() ? 0 : count->second;
    topic.serialization_format = channel.message_encoding;
    topic.has_definition = topic.has_definition || !schema.data.empty();
  }
}

void AddFile(const recording::MessageFile& file, Totals* totals) {
  const recording::Contents& contents = file.contents();
  totals->files.push_back(file.path().string());
  totals->size_bytes += file.size();
  totals->profiles.insert(contents.header.profile);
  for (const recording::AttachmentIndex& index : contents.attachments) {
    totals->attachments[index.name] = index.data_size;
  }
  for (const std::string& problem : contents.problems) {
    totals->problems.push_back(file.path().string() + ": " + problem);
  }
  if (!contents.indexed) {
    totals->problems.push_back(file.path().string() + ": has no sound index; `palpate repair " +
                               file.path().string() + "` restores it");
  }
}

std::string BagSize(std::uint64_t bytes) {
  constexpr double kStep = 1024.0;
  auto size = static_cast<double>(bytes);
  if (size < kStep) return fmt::format("{} B", bytes);
  for (const char* unit : {"KiB", "MiB"}) {
    size /= kStep;
    if (size < kStep) return fmt::format("{:.1f} {}", size, unit);
  }
  return fmt::format("{:.1f} GiB", size / kStep);
}

std::string TimeText(std::int64_t time_ns) {
  return fmt::format("{} ({:.9f})", UtcTextOfNs(time_ns), NsToSeconds(time_ns));
}

std::string ToText(const Totals& totals) {
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("{:<19}{}\n", name, value);
  };
  line("Files:", totals.files.front());
  for (std::size_t i = 1; i < totals.files.size(); ++i) line("", totals.files[i]);
  line("Bag size:", BagSize(totals.size_bytes));
  line("Storage id:", totals.storage_id);
  line("Duration:", fmt::format("{:.9f}s", NsToSeconds(totals.statistics.end_time_ns -
                                                       totals.statistics.start_time_ns)));
  line("Start:", TimeText(totals.statistics.start_time_ns));
  line("End:", TimeText(totals.statistics.end_time_ns));
  line("Messages:", std::to_string(totals.statistics.message_count));
  const char* heading = "Topic information:";
  for (const auto& [name, topic] : totals.topics) {
    line(heading, fmt::format("Topic: {} | Type: {} | Count: {} | Serialization Format: {}{}",
                              name.first, name.second, topic.count, topic.serialization_format,
                              topic.has_definition ? "" : " | no definition"));
    heading = "";
  }
  heading = "Attachments:";
  for (const auto& [name, bytes] : totals.attachments) {
    line(heading, fmt::format("{} ({})", name, BagSize(bytes)));
    heading = "";
  }
  line("Use:", "palpate play publishes it; estimate, calibrate, diagnose and export take --data");
  for (const std::string& problem : totals.problems) text += "warning: " + problem + "\n";
  return text;
}

Json ToJson(const Totals& totals) {
  Json json = {
      {"files", totals.files},
      {"bag_size_bytes", totals.size_bytes},
      {"storage_id", totals.storage_id},
      {"profiles", totals.profiles},
      {"duration_s", NsToSeconds(totals.statistics.end_time_ns - totals.statistics.start_time_ns)},
      {"start_ns", totals.statistics.start_time_ns},
      {"end_ns", totals.statistics.end_time_ns},
      {"messages", totals.statistics.message_count},
      {"topics", Json::array()},
      {"attachments", Json::array()},
      {"problems", totals.problems}};
  for (const auto& [name, topic] : totals.topics) {
    json["topics"].push_back({{"topic", name.first},
                              {"type", name.second},
                              {"count", topic.count},
                              {"serialization_format", topic.serialization_format},
                              {"has_definition", topic.has_definition}});
  }
  for (const auto& [name, bytes] : totals.attachments) {
    json["attachments"].push_back({{"name", name}, {"bytes", bytes}});
  }
  return json;
}

}  // namespace

RecordingDescription DescribeRecording(const std::vector<fs::path>& files) {
  const recording::RecordedMessages recorded(files);
  Totals totals;
  totals.storage_id = recorded.storage_id();
  totals.statistics = recorded.contents().statistics;
  for (const auto& file : recorded.files()) AddFile(*file, &totals);
  AddChannels(recorded, &totals);
  return {ToJson(totals), ToText(totals)};
}

}  // namespace palpate::command
