// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "components/view/frames/page_request.hpp"
#include "components/view/serve/out_message.hpp"

namespace palpate::view {

/// What is played into the page instead of a running system. Time is an argument, ns of a clock
/// that does not go back.
class PlayedSource {
 public:
  virtual ~PlayedSource() = default;

  /// To be called often: feeds what is due.
  virtual void Advance(std::int64_t now_ns) = 0;
  virtual void Play(const PlayRequest& request) = 0;
  /// Shows what was newest at that place, then plays on.
  virtual void Seek(const SeekRequest& request) = 0;
  /// The player's message of the page.
  virtual OutMessage State() const = 0;
};

}  // namespace palpate::view
