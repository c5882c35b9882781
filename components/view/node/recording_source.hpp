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
#include <utility>
#include <vector>

#include "components/view/frames/page_request.hpp"
#include "components/view/node/page_feed.hpp"
#include "components/view/node/played_source.hpp"
#include "components/view/serve/out_message.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::view {

/// Plays recorded messages into the page, without sending them to any domain.
class RecordingSource : public PlayedSource {
 public:
  /// `files`: as MessageFilesOf() names them. Throws InputError where they cannot be read, or hold
  /// no topic that the page shows.
  RecordingSource(const std::vector<std::filesystem::path>& files, PageFeed* feed);

  /// What else the messages go to, as their bytes.
  struct Further {
    std::function<bool(const recording::Channel&)> wanted;
    std::function<void(const recording::Message&, std::string_view data)> take;
  };
  void PassOn(Further further) { further_ = std::move(further); }
  /// `Further::wanted` now names this channel, too: its newest message is passed on, then those to
  /// come.
  void WantedHasGrown(std::uint16_t channel);
  const recording::RecordedMessages& recorded() const { return recorded_; }

  void Advance(std::int64_t now_ns) override;
  void Play(const PlayRequest& request) override;
  void Seek(const SeekRequest& request) override;
  OutMessage State() const override;
  double position_s() const { return position_s_; }
  double duration_s() const;

 private:
  /// Gives a message to the feed; false where it cannot be read.
  using Take = std::function<Status(std::string_view cdr)>;

  template <typename T>
  void Know(const dds::Topic<T>& topic, void (PageFeed::*take)(const T&));
  bool IsWanted(const recording::Channel& channel) const;
  bool IsShown(const recording::Channel& channel) const;
  void Give(const recording::Message& message, std::string_view data);
  std::int64_t TimeAt(double position_s) const;
  void StartAt(double position_s);
  void Open();

  PageFeed* feed_;
  std::map<std::string, Take> takes_;  ///< by topic
  Further further_;
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
