// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "components/view/node/rate_limit.hpp"
#include "libs/dds/decode_cdr.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/raw_reader.hpp"

namespace palpate::view {

/// Takes some images of a fast topic: of the others, not even the bytes are read. Asks for best
/// effort, so that it holds up no camera and reads every camera's driver.
class ImageTap {
 public:
  /// `on_image` is called from DDS's threads. `participant` must outlive this.
  ImageTap(const dds::Participant& participant, std::string_view topic, double max_rate_hz,
           std::function<void()> on_image);

  /// Begins or ends to read, and returns what has come since; nullopt: nothing, or no T.
  template <typename T>
  std::optional<dds::Message<T>> Take(bool wanted) {
    const std::optional<dds::RawMessage> raw = TakeRaw(wanted);
    dds::Message<T> image;
    if (!raw || !dds::DecodeCdr(raw->cdr(), &image).ok()) return std::nullopt;
    return image;
  }

 private:
  std::optional<dds::RawMessage> TakeRaw(bool wanted);
  void Keep(dds::RawMessage message);

  const dds::Participant& participant_;
  dds::RawTopic topic_;
  RateLimit limit_;  ///< of DDS's thread
  std::function<void()> on_image_;
  bool refused_ = false;  ///< by DDS
  std::mutex mutex_;
  std::optional<dds::RawMessage> kept_;
  std::unique_ptr<dds::RawReader> reader_;  ///< goes first: its thread uses the above
};

}  // namespace palpate::view
