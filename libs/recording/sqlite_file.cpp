// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <sqlite3.h>

#include <limits>
#include <map>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/message_file.hpp"

namespace palpate::recording {

namespace {

namespace fs = std::filesystem;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinishStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A query of a database.
class Query {
 public:
  Query(sqlite3* database, const std::string& sql) : database_(database) {
    sqlite3_stmt* raw = nullptr;
    sqlite3_prepare_v2(database, sql.c_str(), -1, &raw, nullptr);
    statement_.reset(raw);
  }
  /// False at the end, and where the database is damaged: see error().
  bool Step() {
    const int result = statement_ ? sqlite3_step(statement_.get()) : SQLITE_ERROR;
    if (result != SQLITE_ROW && result != SQLITE_DONE) error_ = sqlite3_errmsg(database_);
    return result == SQLITE_ROW;
  }
  std::int64_t Integer(int column) { return sqlite3_column_int64(statement_.get(), column); }
  std::string_view Bytes(int column) {
    const void* bytes = sqlite3_column_blob(statement_.get(), column);
    const int size = sqlite3_column_bytes(statement_.get(), column);
    if (bytes == nullptr) return {};
    return {static_cast<const char*>(bytes), static_cast<std::size_t>(size)};
  }
  std::string Text(int column) { return std::string(Bytes(column)); }
  const std::string& error() const { return error_; }

 private:
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, FinishStatement> statement_;
  std::string error_;
};

/// The topics' ids and the channels' are not the same: ours begin at 1 and have 16 bits.
using ChannelIds = std::map<std::int64_t, std::uint16_t>;

class SqliteMessages : public FileMessages {
 public:
  SqliteMessages(sqlite3* database, const fs::path& file, ChannelIds ids, const std::string& sql)
      : query_(database, sql), file_(file), ids_(std::move(ids)) {}

  const Message* Next() override {
    if (!query_.Step()) return nullptr;
    message_.channel_id = ids_.at(query_.Integer(0));
    message_.log_time_ns = message_.publish_time_ns = query_.Integer(1);
    message_.data = query_.Bytes(2);
    return &message_;
  }
  std::vector<std::string> Problems() const override {
    if (query_.error().empty()) return {};
    return {file_.string() + ": the rest of its messages cannot be read: " + query_.error()};
  }

 private:
  Query query_;
  fs::path file_;
  ChannelIds ids_;
  Message message_;
};

class SqliteFile : public MessageFile {
 public:
  explicit SqliteFile(const fs::path& file) : file_(file) {
    sqlite3* raw = nullptr;
    const int result =
        sqlite3_open_v2(file.c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(raw);
    if (result != SQLITE_OK) Refuse(sqlite3_errmsg(raw));
    contents_.header.profile = "ros2";
    contents_.indexed = true;
    ReadTopics(ReadDefinitions());
    CountMessages();
  }

  const fs::path& path() const override { return file_; }
  std::uint64_t size() const override { return fs::file_size(file_); }
  std::string storage_id() const override { return "sqlite3"; }
  const Contents& contents() const override { return contents_; }
  std::vector<Attachment> Attachments() const override { return {}; }

  std::unique_ptr<FileMessages> Messages(const MessageFilter& filter) const override {
    std::string topics;
    for (const auto& [topic, id] : ids_) {
      if (filter.wanted && !filter.wanted(contents_.channels.at(id))) continue;
      topics += (topics.empty() ? "" : ", ") + std::to_string(topic);
    }
    const std::string sql = "SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN (" +
                            topics + ") AND timestamp BETWEEN " +
                            std::to_string(filter.start_time_ns) + " AND " +
                            std::to_string(filter.end_time_ns) + " ORDER BY timestamp, id";
    return std::make_unique<SqliteMessages>(database_.get(), file_, ids_, sql);
  }

  std::vector<StoredMessage> NewestBefore(
      std::int64_t time_ns, const std::function<bool(const Channel&)>& wanted) const override {
    std::vector<StoredMessage> newest;
    for (const auto& [topic, id] : ids_) {
      if (!wanted(contents_.channels.at(id))) continue;
      SqliteMessages messages(database_.get(), file_, ids_,
                              "SELECT topic_id, timestamp, data FROM messages WHERE topic_id = " +
                                  std::to_string(topic) +
                                  " AND timestamp <= " + std::to_string(time_ns) +
                                  " ORDER BY timestamp DESC, id DESC LIMIT 1");
      const Message* message = messages.Next();
      if (message == nullptr) continue;
      newest.push_back({*message, std::string(message->data)});
      newest.back().message.data = {};
    }
    return newest;
  }

 private:
  [[noreturn]] void Refuse(const std::string& cause) const {
    throw InputError({file_.string()},
                     "is no recording of rosbag2 (storage sqlite3) that can be read: " + cause);
  }

  /// By type; only files since ROS 2 Iron have them.
  std::map<std::string, std::pair<std::string, std::string>> ReadDefinitions() {
    std::map<std::string, std::pair<std::string, std::string>> definitions;
    Query query(database_.get(),
                "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
    while (query.Step()) definitions[query.Text(0)] = {query.Text(1), query.Text(2)};
    return definitions;
  }

  void ReadTopics(const std::map<std::string, std::pair<std::string, std::string>>& definitions) {
    Query query(database_.get(),
                "SELECT id, name, type, serialization_format, offered_qos_profiles FROM topics "
                "ORDER BY id");
    while (query.Step()) {
      const auto id = static_cast<std::uint16_t>(contents_.channels.size() + 1);
      if (id == std::numeric_limits<std::uint16_t>::max()) Refuse("it has more than 65534 topics");
      Schema schema{.id = id, .name = query.Text(2), .encoding = "ros2msg", .data = {}};
      if (const auto found = definitions.find(schema.name); found != definitions.end()) {
        schema.encoding = found->second.first;
        schema.data = found->second.second;
      }
      contents_.schemas[id] = schema;
      contents_.channels[id] = {.id = id,
                                .schema_id = id,
                                .topic = query.Text(1),
                                .message_encoding = query.Text(3),
                                .metadata = {{"offered_qos_profiles", query.Text(4)}}};
      ids_[query.Integer(0)] = id;
    }
    if (!query.error().empty()) Refuse(query.error());
  }

  void CountMessages() {
    Query query(database_.get(),
                "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp) FROM messages "
                "GROUP BY topic_id");
    Statistics& statistics = contents_.statistics;
    statistics.schema_count = static_cast<std::uint16_t>(contents_.schemas.size());
    statistics.channel_count = static_cast<std::uint32_t>(contents_.channels.size());
    while (query.Step()) {
      const auto id = ids_.find(query.Integer(0));
      if (id == ids_.end()) Refuse("a message has a topic that is not listed");
      const bool first = statistics.message_count == 0;
      const auto count = static_cast<std::uint64_t>(query.Integer(1));
      statistics.channel_message_counts[id->second] = count;
      statistics.message_count += count;
      statistics.start_time_ns =
          first ? query.Integer(2) : std::min(statistics.start_time_ns, query.Integer(2));
      statistics.end_time_ns = std::max(statistics.end_time_ns, query.Integer(3));
    }
    if (!query.error().empty()) Refuse(query.error());
  }

  fs::path file_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  Contents contents_;
  ChannelIds ids_;
};

}  // namespace

std::unique_ptr<MessageFile> OpenSqliteFile(const fs::path& file) {
  return std::make_unique<SqliteFile>(file);
}

}  // namespace palpate::recording
