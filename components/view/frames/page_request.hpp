// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace palpate::view {

// What the page asks for. Texts of JSON with "kind".

struct ProbeRequest {
  std::uint32_t vertex = 0;  ///< number in PageSurface::nodes
};
struct RecordRequest {
  bool on = false;
};
struct PlayRequest {
  bool paused = false;
  double rate = 1.0;  ///< > 0
};
struct SeekRequest {
  double position_s = 0.0;  ///< from the start of the recording
};
struct SubscribeRequest {
  bool images = true;
  bool clouds = true;
};
/// One that may not be.
struct BadRequest {
  std::string kind;  ///< as far as it has one
  std::string reason;
};

using PageRequest = std::variant<BadRequest, ProbeRequest, RecordRequest, PlayRequest, SeekRequest,
                                 SubscribeRequest>;

/// Longer texts are no requests.
inline constexpr std::size_t kMostRequestBytes = 4096;
inline constexpr double kLeastRate = 0.01;
inline constexpr double kMostRate = 100.0;

PageRequest ParsePageRequest(std::string_view text);

}  // namespace palpate::view
