// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_nodes.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace palpate::dds {

namespace {

constexpr std::size_t kHeader = 4;
constexpr std::size_t kHumbleGid = 24;
constexpr std::size_t kIronGid = 16;
/// DDS sends a multiple of 4 bytes.
constexpr std::size_t kMostPadding = 3;

/// Reads the CDR of one layout. Once the bytes do not suffice, ok() is false for good.
class InfoReader {
 public:
  InfoReader(std::string_view cdr, std::size_t gid_size)
      : bytes_(cdr.substr(std::min(cdr.size(), kHeader))),
        swap_(cdr.size() > kHeader && cdr[1] % 2 == 0),
        gid_size_(gid_size) {}

  std::optional<AnnouncedNodes> Run() && {
    AnnouncedNodes info;
    info.participant = Gid();
    const std::uint32_t count = Length();
    for (std::uint32_t i = 0; i < count && ok_; ++i) {
      RosNode node;
      node.node_namespace = Text();
      node.name = Text();
      node.participant = info.participant;
      node.readers = Gids();
      node.writers = Gids();
      info.nodes.push_back(std::move(node));
    }
    if (!ok_ || bytes_.size() - at_ > kMostPadding) return std::nullopt;
    return info;
  }

 private:
  std::string_view Take(std::size_t size) {
    ok_ = ok_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
    if (!ok_) return {};
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  std::uint32_t Length() {
    at_ = (at_ + 3) / 4 * 4;
    const std::string_view bytes = Take(4);
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      length |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * (swap_ ? 3 - i : i));
    }
    return length;
  }

  std::string Text() {
    std::string_view text = Take(Length());
    // The end of a text is part of it in CDR.
    ok_ = ok_ && text.ends_with('\0');
    if (ok_) text.remove_suffix(1);
    return std::string(text);
  }

  Guid Gid() {
    Guid guid{};
    const std::string_view bytes = Take(gid_size_);
    for (std::size_t i = 0; i < std::min(guid.size(), bytes.size()); ++i) {
      guid[i] = static_cast<std::uint8_t>(bytes[i]);
    }
    return guid;
  }

  std::vector<Guid> Gids() {
    std::vector<Guid> gids;
    const std::uint32_t count = Length();
    for (std::uint32_t i = 0; i < count && ok_; ++i) gids.push_back(Gid());
    return gids;
  }

  std::string_view bytes_;
  bool swap_;
  std::size_t gid_size_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace

std::optional<AnnouncedNodes> ParseDiscoveryInfo(std::string_view cdr) {
  if (cdr.size() < kHeader) return std::nullopt;
  if (auto info = InfoReader(cdr, kHumbleGid).Run()) return info;
  return InfoReader(cdr, kIronGid).Run();
}

}  // namespace palpate::dds
