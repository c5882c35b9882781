// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/natnet_packet.hpp"

#include <charconv>
#include <cstring>

#include "libs/core/error.hpp"

namespace palpate::motion_capture {

namespace {

constexpr std::uint16_t kFrameOfData = 7;
constexpr std::size_t kHeaderBytes = 4;
constexpr std::size_t kPositionBytes = 3 * sizeof(float);

/// Reads a datagram from its beginning. After the first read beyond its end all reads fail.
class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool ok() const { return ok_; }

  template <typename T>
  T Number() {
    T value{};
    if (Has(sizeof(T))) {
      std::memcpy(&value, data_, sizeof(T));  // NatNet is little-endian, as our hosts are
      Advance(sizeof(T));
    }
    return value;
  }
  std::string Text() {
    const void* end = ok_ ? std::memchr(data_, 0, left_) : nullptr;
    if (end == nullptr) {
      ok_ = false;
      return {};
    }
    std::string text(reinterpret_cast<const char*>(data_));
    Advance(text.size() + 1);
    return text;
  }
  /// A count of things of at least `bytes` each; one that cannot fit fails.
  std::size_t Count(std::size_t bytes) {
    const auto count = Number<std::int32_t>();
    ok_ = ok_ && count >= 0 && static_cast<std::size_t>(count) <= left_ / bytes;
    return ok_ ? static_cast<std::size_t>(count) : 0;
  }
  std::vector<Eigen::Vector3f> Positions(std::size_t count) {
    std::vector<Eigen::Vector3f> positions(count);
    for (Eigen::Vector3f& position : positions) {
      for (Eigen::Index i = 0; i < 3; ++i) position[i] = Number<float>();
    }
    return positions;
  }

 private:
  bool Has(std::size_t bytes) { return ok_ = ok_ && bytes <= left_; }
  void Advance(std::size_t bytes) {
    data_ += bytes;
    left_ -= bytes;
  }

  const std::uint8_t* data_;
  std::size_t left_;
  bool ok_ = true;
};

Status Invalid(const std::string& reason) { return {StatusCode::kInvalidInput, reason}; }

/// Since 4.1 each section says after its count how many bytes it has.
void SkipSectionSize(const NatNetVersion& version, Reader* reader) {
  const bool has_size = version.major > 4 || (version.major == 4 && version.minor > 0);
  if (has_size) (void)reader->Number<std::int32_t>();
}

bool ParsePart(const std::string& text, int* number) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), *number);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

}  // namespace

NatNetVersion ParseNatNetVersion(const std::string& text) {
  NatNetVersion version;
  const std::size_t dot = text.find('.');
  const bool read = dot != text.npos && ParsePart(text.substr(0, dot), &version.major) &&
                    ParsePart(text.substr(dot + 1), &version.minor);
  if (read && (version.major == 3 || version.major == 4) && version.minor >= 0) return version;
  throw InputError("natnet_version: must be a version such as 4.1 (3 or 4), not '" + text + "'");
}

bool IsNatNetFrame(const std::uint8_t* data, std::size_t size) {
  return Reader(data, size).Number<std::uint16_t>() == kFrameOfData && size >= kHeaderBytes;
}

Status ParseNatNetFrame(const std::uint8_t* data, std::size_t size, const NatNetVersion& version,
                        NatNetFrame* frame) {
  if (!IsNatNetFrame(data, size)) return Invalid("a datagram that is no NatNet frame");
  Reader reader(data, size);
  (void)reader.Number<std::uint16_t>();
  const std::size_t payload = reader.Number<std::uint16_t>();
  if (payload > size - kHeaderBytes) {
    return Invalid("a NatNet frame of " + std::to_string(payload) + " bytes in a datagram of " +
                   std::to_string(size));
  }
  NatNetFrame read;
  read.number = reader.Number<std::int32_t>();
  const std::size_t sets = reader.Count(1 + sizeof(std::int32_t));
  SkipSectionSize(version, &reader);
  for (std::size_t i = 0; i < sets && reader.ok(); ++i) {
    NatNetMarkerSet set;
    set.name = reader.Text();
    set.positions_m = reader.Positions(reader.Count(kPositionBytes));
    read.sets.push_back(std::move(set));
  }
  const std::size_t unlabelled = reader.Count(kPositionBytes);
  SkipSectionSize(version, &reader);
  read.unlabelled_m = reader.Positions(unlabelled);
  if (!reader.ok()) return Invalid("a NatNet frame that ends too early: is natnet_version right?");
  *frame = std::move(read);
  return Status::Ok();
}

}  // namespace palpate::motion_capture
