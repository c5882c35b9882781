// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace palpate::recording {

enum class Compression { kNone, kZstd, kLz4 };

/// The name that MCAP has for it: "", "zstd", "lz4".
std::string_view McapName(Compression compression);

/// Packs the records of chunks, one after the other, with buffers that are used again.
class Compressor {
 public:
  /// `level`: of zstd, 1 (fast) to 19; lz4 has none.
  Compressor(Compression compression, int level);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  struct Packed {
    Compression compression = Compression::kNone;  ///< kNone where packing would not make it less
    std::string_view bytes;                        ///< until the next call
  };
  Packed Pack(std::string_view bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Unpacks to exactly `size` bytes. False, with the cause, where that is not what the bytes hold.
[[nodiscard]] bool Unpack(std::string_view mcap_name, std::string_view packed, std::uint64_t size,
                          std::string* bytes, std::string* cause);

/// Unpacks one zstd frame that tells its size. False, with the cause, where it does not or is
/// damaged.
[[nodiscard]] bool UnpackZstdFrame(std::string_view packed, std::string* bytes, std::string* cause);

}  // namespace palpate::recording
