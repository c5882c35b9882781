// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/view/frames/page_request.hpp"
#include "components/view/node/page_feed.hpp"
#include "components/view/serve/out_message.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::view {

/// Plays recorded messages into the page, without sending them anywhere else. Time is an argument,
/// ns of a clock that does not go back.
class RecordingSource {
 public:
  /// `files`: as MessageFilesOf() names them. Throws InputError where they cannot be read, or hold
  /// no topic that the page shows.
  RecordingSource(const std::vector<std::filesystem::path>& files, PageFeed* feed);

  /// To be called often: feeds what is due.
  void Advance(std::int64_t now_ns);

  void Play(const PlayRequest& request);
  /// Shows the newest messages before that place, then plays on.
  void Seek(const SeekRequest& request);

  OutMessage State() const;
  double position_s() const { return position_s_; }
  double duration_s() const;

 private:
  /// Gives a message to the feed; false where it cannot be read.
  using Take = std::function<Status(std::string_view cdr)>;

  template <typename T>
  void Know(const dds::Topic<T>& topic, void (PageFeed::*take)(const T&));
  bool IsWanted(const recording::Channel& channel) const;
  void Give(const recording::Message& message, std::string_view data);
  std::int64_t TimeAt(double position_s) const;
  void StartAt(double position_s);

  PageFeed* feed_;
  std::map<std::string, Take> takes_;  ///< by topic
  recording::RecordedMessages recorded_;
  std::optional<recording::RecordedStream> stream_;
  const recording::Message* next_ = nullptr;
  bool paused_ = false;
  double rate_ = 1.0;
  double position_s_ = 0.0;
  std::optional<std::int64_t> last_ns_;
  std::uint64_t unread_ = 0;
};

}  // namespace palpate::view
