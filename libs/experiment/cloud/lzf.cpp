// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/lzf.hpp"

namespace palpate::experiment {

namespace {

/// A three-byte copy gives at most so many bytes: nothing that short unpacks to more.
constexpr std::size_t kLongestCopy = 264;

class Unpacker {
 public:
  Unpacker(std::string_view packed, std::size_t size, std::string* unpacked)
      : packed_(packed), size_(size), unpacked_(*unpacked) {}

  bool Run() {
    while (next_ < packed_.size()) {
      const unsigned control = Take();
      if (!(control < 32 ? CopyLiterals(control + 1) : CopyBack(control))) return false;
    }
    return unpacked_.size() == size_;
  }

 private:
  unsigned Take() { return static_cast<unsigned char>(packed_[next_++]); }

  bool CopyLiterals(std::size_t count) {
    if (packed_.size() - next_ < count || size_ - unpacked_.size() < count) return false;
    unpacked_.append(packed_.substr(next_, count));
    next_ += count;
    return true;
  }

  bool CopyBack(unsigned control) {
    std::size_t count = control >> 5;
    if (packed_.size() - next_ < (count == 7 ? 2U : 1U)) return false;
    if (count == 7) count += Take();
    count += 2;
    const std::size_t distance = ((control & 0x1fU) << 8 | Take()) + 1;
    if (distance > unpacked_.size() || size_ - unpacked_.size() < count) return false;
    // Byte by byte: the copy may run into what it has just written.
    for (std::size_t i = 0; i < count; ++i) {
      unpacked_.push_back(unpacked_[unpacked_.size() - distance]);
    }
    return true;
  }

  std::string_view packed_;
  std::size_t next_ = 0;
  std::size_t size_;
  std::string& unpacked_;
};

}  // namespace

bool UnpackLzf(std::string_view packed, std::size_t size, std::string* unpacked) {
  unpacked->clear();
  if (size / kLongestCopy > packed.size()) return false;
  unpacked->reserve(size);
  return Unpacker(packed, size, unpacked).Run();
}

}  // namespace palpate::experiment
