// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "components/motion_capture/natnet_packet.hpp"

namespace palpate::motion_capture {

using Bytes = std::vector<std::uint8_t>;

/// Writes a frame as a NatNet server does: 4.1 with the sizes of its sections, and behind what is
/// read the rigid bodies and the rest, here empty.
class NatNetWriter {
 public:
  explicit NatNetWriter(NatNetVersion version) : version_(version) {}

  Bytes Frame(const NatNetFrame& frame) {
    payload_.clear();
    Add(frame.number);
    AddSection(static_cast<std::int32_t>(frame.sets.size()), [&] {
      for (const NatNetMarkerSet& set : frame.sets) {
        payload_.insert(payload_.end(), set.name.begin(), set.name.end());
        payload_.push_back(0);
        Add(static_cast<std::int32_t>(set.positions_m.size()));
        for (const Eigen::Vector3f& position_m : set.positions_m) Add(position_m);
      }
    });
    AddSection(static_cast<std::int32_t>(frame.unlabelled_m.size()), [&] {
      for (const Eigen::Vector3f& position_m : frame.unlabelled_m) Add(position_m);
    });
    for (int section = 0; section < 6; ++section) AddSection(0, [] {});
    return WithHeader(7);
  }
  /// Any other message of a server.
  Bytes Message(std::uint16_t id) {
    payload_ = {1, 2, 3};
    return WithHeader(id);
  }

 private:
  template <typename T>
  void Add(const T& value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    payload_.insert(payload_.end(), bytes, bytes + sizeof(value));
  }
  template <typename Content>
  void AddSection(std::int32_t count, const Content& content) {
    Add(count);
    const std::size_t size_at = payload_.size();
    const bool has_size = version_.major == 4 && version_.minor > 0;
    if (has_size) Add(std::int32_t{0});
    content();
    if (!has_size) return;
    const auto size = static_cast<std::int32_t>(payload_.size() - size_at - sizeof(std::int32_t));
    std::memcpy(payload_.data() + size_at, &size, sizeof(size));
  }
  Bytes WithHeader(std::uint16_t id) const {
    const auto size = static_cast<std::uint16_t>(payload_.size());
    Bytes bytes(4);
    std::memcpy(bytes.data(), &id, 2);
    std::memcpy(bytes.data() + 2, &size, 2);
    bytes.insert(bytes.end(), payload_.begin(), payload_.end());
    return bytes;
  }

  NatNetVersion version_;
  Bytes payload_;
};

/// Two sets and the one that repeats them; the second marker of "Tip" is not seen.
inline NatNetFrame SampleFrame(std::int32_t number) {
  NatNetFrame frame;
  frame.number = number;
  const Eigen::Vector3f seen(0.1f, 0.2f, 0.3f), unseen = Eigen::Vector3f::Zero();
  frame.sets = {{"Tip", {seen, unseen}}, {"Base", {2.0f * seen}}, {"all", {seen, unseen}}};
  frame.unlabelled_m = {3.0f * seen};
  return frame;
}

}  // namespace palpate::motion_capture
