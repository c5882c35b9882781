// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/describe_mcap.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/recording/reader.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Topic {
  std::uint64_t count = 0;
  std::string serialization_format;
  bool has_definition = false;
};

/// All files of a recording, added up.
struct Totals {
  std::vector<std::string> files;
  std::uint64_t size_bytes = 0;
  std::uint64_t messages = 0;
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::set<std::string> profiles;
  std::map<std::pair<std::string, std::string>, Topic> topics;  ///< by name and type
  std::map<std::string, std::uint64_t> attachments;             ///< name, bytes
  std::vector<std::string> problems;
};

void AddChannels(const recording::Reader& reader, Totals* totals) {
  const recording::Contents& contents = reader.contents();
  const auto& counts = contents.statistics.channel_message_counts;
  for (const auto& [id, channel] : contents.channels) {
    const recording::Schema& schema = reader.SchemaOf(channel);
    Topic& topic = totals->topics[{channel.topic, schema.name}];
    const auto count = counts.find(id);
    topic.count += count == counts.end() ? 0 : count->second;
    topic.serialization_format = channel.message_encoding;
    topic.has_definition = topic.has_definition || !schema.data.empty();
  }
}

void AddFile(const fs::path& file, Totals* totals) {
  const recording::Reader reader(file);
  const recording::Contents& contents = reader.contents();
  const recording::Statistics& statistics = contents.statistics;
  totals->files.push_back(file.string());
  totals->size_bytes += reader.size();
  totals->profiles.insert(contents.header.profile);
  if (statistics.message_count > 0) {
    const bool first = totals->messages == 0;
    totals->start_ns =
        first ? statistics.start_time_ns : std::min(totals->start_ns, statistics.start_time_ns);
    totals->end_ns =
        first ? statistics.end_time_ns : std::max(totals->end_ns, statistics.end_time_ns);
  }
  totals->messages += statistics.message_count;
  AddChannels(reader, totals);
  for (const recording::AttachmentIndex& index : contents.attachments) {
    totals->attachments[index.name] = index.data_size;
  }
  for (const std::string& problem : contents.problems) {
    totals->problems.push_back(file.string() + ": " + problem);
  }
  if (!contents.indexed) {
    totals->problems.push_back(file.string() + ": has no sound index; `palpate repair " +
                               file.string() + "` restores it");
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
  line("Storage id:", "mcap");
  line("Duration:", fmt::format("{:.9f}s", NsToSeconds(totals.end_ns - totals.start_ns)));
  line("Start:", TimeText(totals.start_ns));
  line("End:", TimeText(totals.end_ns));
  line("Messages:", std::to_string(totals.messages));
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
  for (const std::string& problem : totals.problems) text += "warning: " + problem + "\n";
  return text;
}

Json ToJson(const Totals& totals) {
  Json json = {{"files", totals.files},
               {"bag_size_bytes", totals.size_bytes},
               {"storage_id", "mcap"},
               {"profiles", totals.profiles},
               {"duration_s", NsToSeconds(totals.end_ns - totals.start_ns)},
               {"start_ns", totals.start_ns},
               {"end_ns", totals.end_ns},
               {"messages", totals.messages},
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

McapDescription DescribeMcap(const std::vector<fs::path>& files) {
  Totals totals;
  for (const fs::path& file : files) AddFile(file, &totals);
  return {ToJson(totals), ToText(totals)};
}

}  // namespace palpate::command
