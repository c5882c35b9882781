// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libs/recording/ros2msg/message_definition.hpp"
#include "libs/recording/writer.hpp"
#include "tests/components/palpate/recordings/cdr_writer.hpp"

namespace palpate::command {

/// Stamp of the first message of a recording, and the time between its images.
inline constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kStep_ns = 100'000'000;

/// Messages that can be written as an MCAP file, or as rosbag2's storage sqlite3 has them.
struct TopicRecording {
  struct Entry {
    std::string topic;
    std::string type;
    std::int64_t log_ns = 0;
    std::string data;
  };
  std::vector<Entry> entries;
  std::vector<recording::Attachment> attachments;  ///< of an MCAP file

  void Add(const std::string& topic, const std::string& type, std::int64_t log_ns, const Cdr& cdr) {
    entries.push_back({topic, type, log_ns, cdr.bytes()});
  }

  void WriteMcap(const std::filesystem::path& file) const {
    recording::Writer writer(std::make_unique<recording::OutputFile>(file), {});
    for (const Entry& entry : entries) {
      const std::uint16_t schema =
          writer.AddSchema(entry.type, "ros2msg",
                           FormatRos2msg(entry.type, recording::BuiltInDefinitions()).value());
      const std::uint16_t channel = writer.AddChannel({.id = 0,
                                                       .schema_id = schema,
                                                       .topic = entry.topic,
                                                       .message_encoding = "cdr",
                                                       .metadata = {}});
      writer.Write(recording::Message{channel, 0, entry.log_ns, entry.log_ns, entry.data});
    }
    for (const recording::Attachment& attachment : attachments) writer.Write(attachment);
    writer.Close();
  }

  void WriteSqlite(const std::filesystem::path& file) const {
    sqlite3* database = nullptr;
    sqlite3_open(file.c_str(), &database);
    const auto run = [&](const std::string& sql) {
      sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr);
    };
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
    run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
    std::map<std::string, int> ids;
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                       -1, &insert, nullptr);
    for (const Entry& entry : entries) {
      const auto [id, is_new] = ids.emplace(entry.topic, static_cast<int>(ids.size()) + 1);
      if (is_new) {
        run("INSERT INTO topics VALUES (" + std::to_string(id->second) + ", '" + entry.topic +
            "', '" + entry.type + "', 'cdr', '')");
      }
      sqlite3_bind_int(insert, 1, id->second);
      sqlite3_bind_int64(insert, 2, entry.log_ns);
      sqlite3_bind_blob(insert, 3, entry.data.data(), static_cast<int>(entry.data.size()), nullptr);
      sqlite3_step(insert);
      sqlite3_reset(insert);
    }
    sqlite3_finalize(insert);
    sqlite3_close(database);
  }
};

/// An image of sensor_msgs, its rows `step` bytes long.
inline Cdr ImageMessage(std::int64_t t_ns, const std::string& frame_id, std::uint32_t width,
                        std::uint32_t height, const std::string& encoding, std::uint32_t step,
                        const std::vector<std::uint8_t>& data, bool big_endian = false) {
  Cdr cdr;
  cdr.Stamp(t_ns, frame_id).Put(height).Put(width).Text(encoding);
  return cdr.Put(std::uint8_t{big_endian}).Put(step).List(data);
}

inline Cdr CameraInfoMessage(const std::string& frame_id, std::uint32_t width, std::uint32_t height,
                             const std::string& lens = "plumb_bob",
                             const std::vector<double>& distortion = {0, 0, 0, 0, 0},
                             double focal_px = 10.0) {
  Cdr cdr;
  cdr.Stamp(0, frame_id).Put(height).Put(width).Text(lens).List(distortion);
  cdr.Array<double>({focal_px, 0, 1.5, 0, focal_px, 0.5, 0, 0, 1});
  cdr.Array<double>({1, 0, 0, 0, 1, 0, 0, 0, 1});
  cdr.Array<double>({focal_px, 0, 1.5, 0, 0, focal_px, 0.5, 0, 0, 0, 1, 0});
  return cdr.Array<std::uint32_t>({0, 0, 0, 0, 0, 0}).Put(std::uint8_t{0});
}

inline Cdr TransformMessage(const std::string& parent, const std::string& child, double x_m) {
  Cdr cdr;
  cdr.Put(std::uint32_t{1}).Stamp(0, parent).Text(child);
  return cdr.Array<double>({x_m, 0, 0, 0, 0, 0, 1});
}

}  // namespace palpate::command
