// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/file.hpp"
#include "libs/recording/reader.hpp"
#include "libs/recording/writer.hpp"

namespace palpate::recording {

/// A message as it went in, or came out.
struct Sample {
  std::string topic;
  std::int64_t log_time_ns = 0;
  std::int64_t publish_time_ns = 0;
  std::uint32_t sequence = 0;
  std::string data;

  bool operator==(const Sample&) const = default;
};

inline WriterOptions SmallChunks(Compression compression = Compression::kNone) {
  WriterOptions options;
  options.compression = compression;
  options.chunk_bytes = 2000;
  options.library = "test";
  return options;
}

/// Half repeated, half random bytes: they shrink, but not to nothing.
inline std::string RandomBytes(std::size_t size, std::mt19937* random) {
  std::string bytes(size, 'a');
  for (std::size_t i = 0; i < size / 2; ++i) bytes[i] = static_cast<char>((*random)());
  return bytes;
}

/// Three topics in turn, 10 ms apart.
inline std::vector<Sample> Samples(int count) {
  const std::vector<std::string> topics{"/a", "/b/c", "/d"};
  std::mt19937 random(7);
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    const std::int64_t time_ns = 1'000'000'000 + i * std::int64_t{10'000'000};
    samples.push_back({topics[static_cast<std::size_t>(i) % topics.size()], time_ns, time_ns - 500,
                       static_cast<std::uint32_t>(i),
                       RandomBytes(20 + static_cast<std::size_t>(i) % 400, &random)});
  }
  return samples;
}

inline std::uint16_t ChannelOf(const std::string& topic, Writer* writer) {
  const std::uint16_t schema = writer->AddSchema("test_msgs/msg/T", "ros2msg", "uint8[] data");
  return writer->AddChannel({.id = 0,
                             .schema_id = schema,
                             .topic = topic,
                             .message_encoding = "cdr",
                             .metadata = {{"of", topic}}});
}

inline void WriteSample(const Sample& sample, Writer* writer) {
  writer->Write(Message{ChannelOf(sample.topic, writer), sample.sequence, sample.log_time_ns,
                        sample.publish_time_ns, sample.data});
}

inline void WriteSamples(const std::filesystem::path& file, const std::vector<Sample>& samples,
                         const WriterOptions& options) {
  Writer writer(std::make_unique<OutputFile>(file), options);
  for (const Sample& sample : samples) WriteSample(sample, &writer);
  writer.Close();
}

inline std::vector<Sample> SamplesIn(MessageStream stream, const Reader& reader) {
  std::vector<Sample> samples;
  while (const Message* message = stream.Next()) {
    samples.push_back({reader.contents().channels.at(message->channel_id).topic,
                       message->log_time_ns, message->publish_time_ns, message->sequence,
                       std::string(message->data)});
  }
  return samples;
}

inline std::vector<Sample> SamplesIn(const std::filesystem::path& file) {
  const Reader reader(file);
  return SamplesIn(reader.Messages(), reader);
}

}  // namespace palpate::recording
