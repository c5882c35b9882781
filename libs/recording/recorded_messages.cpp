// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/recorded_messages.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/compression.hpp"

namespace palpate::recording {

namespace {

namespace fs = std::filesystem;

bool IsExperiment(const fs::path& folder) {
  return fs::exists(folder / "experiment.yaml") || fs::exists(folder / "recording.yaml");
}

/// Whether rosbag2 compressed the message. CDR begins with a zero.
bool IsPacked(std::string_view data) {
  constexpr std::string_view kZstdFrame("\x28\xb5\x2f\xfd", 4);
  return data.starts_with(kZstdFrame);
}

void RefuseMixed(const fs::path& folder, const std::vector<fs::path>& mcap,
                 const std::vector<fs::path>& sqlite, const std::vector<fs::path>& packed) {
  if (!mcap.empty() && !sqlite.empty()) {
    throw InputError({folder.string()}, "holds MCAP files and .db3 files; give one of them");
  }
  if (mcap.empty() && sqlite.empty() && !packed.empty()) {
    throw InputError(
        {packed.front().string()},
        "was compressed as a whole by rosbag2; unpack all of them with `unzstd --keep " +
            (folder / "*.zstd").string() + "` and try again");
  }
}

}  // namespace

std::vector<fs::path> MessageFilesOf(const fs::path& target) {
  std::error_code error;
  if (!fs::is_directory(target, error)) {
    const bool packed = target.extension() == ".zstd" && fs::exists(target, error);
    const bool known = packed || IsMcap(target) || IsSqlite(target);
    return known ? std::vector<fs::path>{target} : std::vector<fs::path>{};
  }
  if (IsExperiment(target)) return {};
  std::vector<fs::path> mcap;
  std::vector<fs::path> sqlite;
  std::vector<fs::path> packed;
  for (const fs::directory_entry& entry : fs::directory_iterator(target)) {
    const std::string name = entry.path().filename().string();
    if (IsMcap(entry.path())) mcap.push_back(entry.path());
    if (IsSqlite(entry.path())) sqlite.push_back(entry.path());
    if (name.ends_with(".mcap.zstd") || name.ends_with(".db3.zstd")) packed.push_back(entry.path());
  }
  std::sort(packed.begin(), packed.end());
  RefuseMixed(target, mcap, sqlite, packed);
  std::vector<fs::path> files = mcap.empty() ? sqlite : mcap;
  std::sort(files.begin(), files.end());
  return files;
}

RecordedMessages::RecordedMessages(const std::vector<fs::path>& files) {
  if (files.empty()) throw InputError("there is no file of recorded messages");
  contents_.indexed = true;
  for (const fs::path& file : files) {
    files_.push_back(OpenMessageFile(file));
    Add(files_.back()->contents());
  }
}

void RecordedMessages::Add(const Contents& contents) {
  contents_.header = contents.header;
  contents_.indexed = contents_.indexed && contents.indexed;
  std::map<std::uint16_t, std::uint16_t>& ids = ids_.emplace_back();
  for (const auto& [id, channel] : contents.channels) {
    const auto schema = contents.schemas.find(channel.schema_id);
    const Schema& theirs = schema == contents.schemas.end() ? Schema{} : schema->second;
    const auto same = [&](const auto& entry) {
      const Schema& ours = SchemaOf(entry.second);
      return entry.second.topic == channel.topic && entry.second.metadata == channel.metadata &&
             ours.name == theirs.name && ours.data == theirs.data;
    };
    const auto found = std::find_if(contents_.channels.begin(), contents_.channels.end(), same);
    if (found != contents_.channels.end()) {
      ids[id] = found->first;
      continue;
    }
    const auto ours = static_cast<std::uint16_t>(contents_.channels.size() + 1);
    PALPATE_CHECK(ours > 0, "more than 65535 channels");
    Channel copy = channel;
    copy.id = copy.schema_id = ids[id] = ours;
    contents_.channels[ours] = copy;
    contents_.schemas[ours] = theirs;
    contents_.schemas[ours].id = ours;
  }
  const Statistics& from = contents.statistics;
  Statistics& to = contents_.statistics;
  if (from.message_count > 0) {
    const bool first = to.message_count == 0;
    to.start_time_ns = first ? from.start_time_ns : std::min(to.start_time_ns, from.start_time_ns);
    to.end_time_ns = first ? from.end_time_ns : std::max(to.end_time_ns, from.end_time_ns);
  }
  to.message_count += from.message_count;
  for (const auto& [id, count] : from.channel_message_counts) {
    if (ids.contains(id)) to.channel_message_counts[ids[id]] += count;
  }
}

const Schema& RecordedMessages::SchemaOf(const Channel& channel) const {
  return contents_.schemas.at(channel.id);
}

std::function<bool(const Channel&)> RecordedMessages::OfFile(
    std::size_t file, const std::function<bool(const Channel&)>& wanted) const {
  return [this, file, wanted](const Channel& channel) {
    return wanted(contents_.channels.at(ids_[file].at(channel.id)));
  };
}

std::vector<StoredMessage> RecordedMessages::NewestBefore(
    std::int64_t time_ns, const std::function<bool(const Channel&)>& wanted) const {
  std::map<std::uint16_t, StoredMessage> newest;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    for (StoredMessage& found : files_[i]->NewestBefore(time_ns, OfFile(i, wanted))) {
      std::string unpacked;
      std::string cause;
      if (IsPacked(found.data)) {
        if (!UnpackZstdFrame(found.data, &unpacked, &cause)) continue;
        found.data = std::move(unpacked);
      }
      const std::uint16_t id = ids_[i].at(found.message.channel_id);
      found.message.channel_id = id;
      const auto known = newest.find(id);
      const bool is_newest =
          known == newest.end() || known->second.message.log_time_ns <= found.message.log_time_ns;
      if (is_newest) newest[id] = std::move(found);
    }
  }
  std::vector<StoredMessage> messages;
  for (auto& [id, message] : newest) messages.push_back(std::move(message));
  return messages;
}

std::vector<Attachment> RecordedMessages::Attachments() const {
  std::vector<Attachment> all;
  std::set<std::string> names;
  for (const auto& file : files_) {
    for (Attachment& attachment : file->Attachments()) {
      if (names.insert(attachment.name).second) all.push_back(std::move(attachment));
    }
  }
  return all;
}

RecordedStream::RecordedStream(const RecordedMessages& recorded, MessageFilter filter)
    : recorded_(&recorded), filter_(std::move(filter)) {
  for (std::size_t i = 0; i < recorded.files_.size(); ++i) {
    if (recorded.files_[i]->contents().statistics.message_count > 0) waiting_.push_back(i);
  }
  const auto start_ns = [&](std::size_t i) {
    return recorded.files_[i]->contents().statistics.start_time_ns;
  };
  std::stable_sort(waiting_.begin(), waiting_.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(start_ns(a), a) > std::pair(start_ns(b), b);
  });
  parts_.reserve(waiting_.size());
}

/// Opens the files that may hold messages of this time or before, and at least one that has any.
void RecordedStream::OpenUntil(std::int64_t time_ns) {
  const auto any = [&] {
    return std::any_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return part.next != nullptr; });
  };
  while (!waiting_.empty()) {
    const std::size_t index = waiting_.back();
    const MessageFile& file = *recorded_->files_[index];
    if (any() && file.contents().statistics.start_time_ns > time_ns) return;
    waiting_.pop_back();
    MessageFilter of_file = filter_;
    if (filter_.wanted) of_file.wanted = recorded_->OfFile(index, filter_.wanted);
    Part part{.file = index, .messages = file.Messages(of_file), .next = nullptr};
    part.next = part.messages->Next();
    parts_.push_back(std::move(part));
  }
}

const Message* RecordedStream::Next() {
  const auto earlier = [](const Part& a, const Part& b) {
    if (a.next == nullptr || b.next == nullptr) return a.next != nullptr;
    return std::pair(a.next->log_time_ns, a.file) < std::pair(b.next->log_time_ns, b.file);
  };
  for (;;) {
    if (current_ != nullptr) current_->next = current_->messages->Next();
    current_ = nullptr;
    std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
    for (const Part& part : parts_) {
      if (part.next != nullptr) first_ns = std::min(first_ns, part.next->log_time_ns);
    }
    OpenUntil(first_ns);
    const auto first = std::min_element(parts_.begin(), parts_.end(), earlier);
    if (first == parts_.end() || first->next == nullptr) return nullptr;
    current_ = &*first;
    message_ = *current_->next;
    message_.channel_id = recorded_->ids_[current_->file].at(message_.channel_id);
    if (!IsPacked(message_.data)) return &message_;
    std::string cause;
    if (UnpackZstdFrame(message_.data, &unpacked_, &cause)) {
      message_.data = unpacked_;
      return &message_;
    }
    if (problems_.empty()) {
      problems_.push_back(recorded_->files_[current_->file]->path().string() +
                          ": compressed messages are left out: " + cause);
    }
  }
}

std::vector<std::string> RecordedStream::Problems() const {
  std::vector<std::string> problems = problems_;
  for (const Part& part : parts_) {
    const std::vector<std::string> own = part.messages->Problems();
    problems.insert(problems.end(), own.begin(), own.end());
  }
  return problems;
}

}  // namespace palpate::recording
