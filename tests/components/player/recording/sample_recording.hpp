// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libs/recording/writer.hpp"

namespace palpate::player {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kSampleStart_ns = 1000 * kSecond_ns;

inline const std::string kVolatileQos =
    "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n";
inline const std::string kLatchedQos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n";

/// CDR of a std_msgs/String.
inline std::string CdrText(const std::string& text) {
  std::string cdr("\0\1\0\0", 4);
  const auto size = static_cast<std::uint32_t>(text.size() + 1);
  for (int i = 0; i < 4; ++i) cdr += static_cast<char>(size >> (8 * i));
  return cdr + text + std::string(1, '\0');
}

inline std::string TextOfCdr(std::string_view cdr) {
  return std::string(cdr.substr(8, static_cast<unsigned char>(cdr[4]) - std::size_t{1}));
}

/// Writes texts to an MCAP file.
class SampleFile {
 public:
  explicit SampleFile(const std::filesystem::path& file)
      : writer_(std::make_unique<recording::OutputFile>(file), {}) {}
  ~SampleFile() { writer_.Close(); }

  std::uint16_t Channel(const std::string& topic, const std::string& qos,
                        const std::string& encoding = "cdr") {
    recording::Channel channel;
    channel.schema_id = writer_.AddSchema("std_msgs/msg/String", "ros2msg", "string data\n");
    channel.topic = topic;
    channel.message_encoding = encoding;
    if (!qos.empty()) channel.metadata = {{"offered_qos_profiles", qos}};
    return writer_.AddChannel(channel);
  }
  /// `time_s` from kSampleStart_ns.
  void Write(std::uint16_t channel, double time_s, const std::string& text) {
    const std::string cdr = CdrText(text);
    const std::int64_t time_ns = kSampleStart_ns + static_cast<std::int64_t>(1e9 * time_s);
    writer_.Write(recording::Message{channel, 0, time_ns, time_ns, cdr});
  }
  recording::Writer& writer() { return writer_; }

 private:
  recording::Writer writer_;
};

}  // namespace palpate::player
