// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

#include "libs/core/check.hpp"

namespace palpate::recording {

namespace {

/// No chunk that anybody writes is larger; a damaged length shall not ask for more memory.
constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{4} << 30;

LZ4F_preferences_t Lz4Preferences(std::size_t size) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.contentSize = size;
  return preferences;
}

bool UnpackZstd(std::string_view packed, std::string* bytes) {
  return ZSTD_decompress(bytes->data(), bytes->size(), packed.data(), packed.size()) ==
         bytes->size();
}

bool UnpackLz4(std::string_view packed, std::string* bytes) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t done = 0;
  std::size_t wanted = 1;
  while (wanted != 0 && !packed.empty()) {
    std::size_t room = bytes->size() - done;
    std::size_t taken = packed.size();
    wanted = LZ4F_decompress(raw, bytes->data() + done, &room, packed.data(), &taken, nullptr);
    if (LZ4F_isError(wanted) || (taken == 0 && room == 0)) return false;
    done += room;
    packed.remove_prefix(taken);
  }
  return wanted == 0 && done == bytes->size();
}

}  // namespace

std::string_view McapName(Compression compression) {
  switch (compression) {
    case Compression::kNone: return "";
    case Compression::kZstd: return "zstd";
    case Compression::kLz4: return "lz4";
  }
  PALPATE_CHECK(false, static_cast<int>(compression));
  return "";
}

struct Compressor::Impl {
  Compression compression;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd{nullptr, &ZSTD_freeCCtx};
  std::string buffer;

  std::size_t PackZstd(std::string_view bytes) {
    buffer.resize(std::max(buffer.size(), ZSTD_compressBound(bytes.size())));
    const std::size_t size =
        ZSTD_compress2(zstd.get(), buffer.data(), buffer.size(), bytes.data(), bytes.size());
    return ZSTD_isError(size) != 0 ? bytes.size() : size;
  }

  std::size_t PackLz4(std::string_view bytes) {
    const LZ4F_preferences_t preferences = Lz4Preferences(bytes.size());
    buffer.resize(std::max(buffer.size(), LZ4F_compressFrameBound(bytes.size(), &preferences)));
    const std::size_t size =
        LZ4F_compressFrame(buffer.data(), buffer.size(), bytes.data(), bytes.size(), &preferences);
    return LZ4F_isError(size) != 0 ? bytes.size() : size;
  }
};

Compressor::Compressor(Compression compression, int level) : impl_(std::make_unique<Impl>()) {
  impl_->compression = compression;
  if (compression != Compression::kZstd) return;
  impl_->zstd.reset(ZSTD_createCCtx());
  PALPATE_CHECK(impl_->zstd != nullptr);
  ZSTD_CCtx_setParameter(impl_->zstd.get(), ZSTD_c_compressionLevel, level);
}

Compressor::~Compressor() = default;

Compressor::Packed Compressor::Pack(std::string_view bytes) {
  std::size_t size = bytes.size();
  if (impl_->compression == Compression::kZstd) size = impl_->PackZstd(bytes);
  if (impl_->compression == Compression::kLz4) size = impl_->PackLz4(bytes);
  if (size >= bytes.size()) return {Compression::kNone, bytes};
  return {impl_->compression, std::string_view(impl_->buffer).substr(0, size)};
}

bool Unpack(std::string_view mcap_name, std::string_view packed, std::uint64_t size,
            std::string* bytes, std::string* cause) {
  if (size > kMaxChunkBytes) {
    *cause = "claims " + std::to_string(size) + " bytes, more than the limit of 4 GiB";
    return false;
  }
  if (mcap_name.empty()) {
    bytes->assign(packed);
  } else if (mcap_name == "zstd" || mcap_name == "lz4") {
    bytes->resize(size);
    const bool unpacked =
        mcap_name == "zstd" ? UnpackZstd(packed, bytes) : UnpackLz4(packed, bytes);
    if (!unpacked) {
      *cause = std::string(mcap_name) + " data are damaged";
      return false;
    }
  } else {
    *cause = "compression '" + std::string(mcap_name) + "' is not known (zstd, lz4 and none are)";
    return false;
  }
  if (bytes->size() == size) return true;
  *cause = "holds " + std::to_string(bytes->size()) + " bytes instead of " + std::to_string(size);
  return false;
}

bool UnpackZstdFrame(std::string_view packed, std::string* bytes, std::string* cause) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) {
    *cause = "a zstd frame does not tell its size";
    return false;
  }
  return Unpack("zstd", packed, size, bytes, cause);
}

}  // namespace palpate::recording
