// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/vtu_bytes.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <optional>

#include "libs/core/large_pages.hpp"
#include "libs/fem/mesh_io/base64.hpp"
#include "libs/fem/mesh_io/scalar_type.hpp"
#include "libs/fem/mesh_io/vtu_text.hpp"

namespace palpate::fem::mesh_io {

namespace {

using tinyxml2::XMLElement;

/// The encoded bytes of one array, read from front to back.
class ArrayStream {
 public:
  ArrayStream(const XMLElement& array, const VtuStorage& storage)
      : array_(array), storage_(storage) {
    const std::string_view format = array.Attribute("format");
    if (format == "binary") {
      base64_.emplace(TextOfArray(array, storage).text);
      inline_ = true;
    } else if (format == "appended") {
      raw_ = AppendedFromOffset();
      if (storage.appended_base64) base64_.emplace(raw_);
    } else {
      Fail("unknown format '" + std::string(format) + "'");
    }
  }

  /// The next bytes: in the file itself, or decoded into the empty `buffer`.
  std::string_view Read(uint64_t count, const char* what, std::string* buffer) {
    if (base64_) {
      if (!base64_->Read(count, buffer)) Fail(std::string("base64 ends or is damaged in ") + what);
      return *buffer;
    }
    if (count > raw_.size()) Fail(std::string("the data end within ") + what);
    const std::string_view bytes = raw_.substr(0, count);
    raw_.remove_prefix(count);
    return bytes;
  }

  /// The most bytes that can still come.
  uint64_t UpperBound() const { return base64_ ? base64_->UpperBound() : raw_.size(); }

  uint64_t ReadHeader(const char* what) {
    const ScalarType type = storage_.wide_header ? ScalarType::kUInt64 : ScalarType::kUInt32;
    std::string buffer;
    const auto value = DecodeInteger(type, Read(SizeInBytes(type), what, &buffer), storage_.swap);
    if (!value) Fail(std::string(what) + " is above 2^63");
    return static_cast<uint64_t>(*value);
  }

  /// Data behind the last number belong to the next array where they are appended; inline they
  /// have no business there.
  void Finish() const {
    if (inline_ && !base64_->AtEnd()) Fail("holds more bytes than its header says");
  }

  Packing packing() const { return storage_.packing; }

  [[noreturn]] void Fail(const std::string& message) const {
    FailAtArray(array_, storage_, message);
  }

 private:
  std::string_view AppendedFromOffset() const {
    int64_t offset = -1;
    if (array_.QueryInt64Attribute("offset", &offset) != tinyxml2::XML_SUCCESS || offset < 0 ||
        static_cast<uint64_t>(offset) > storage_.appended.size()) {
      Fail("needs an attribute 'offset' within the AppendedData (" +
           std::to_string(storage_.appended.size()) + " bytes)");
    }
    return storage_.appended.substr(static_cast<size_t>(offset));
  }

  const XMLElement& array_;
  const VtuStorage& storage_;
  std::optional<Base64Decoder> base64_;
  std::string_view raw_;
  bool inline_ = false;
};

std::string_view ReadPlain(ArrayStream* stream, uint64_t expected_bytes, std::string* decoded) {
  const uint64_t size = stream->ReadHeader("the size");
  if (size != expected_bytes) {
    stream->Fail("holds " + std::to_string(size) + " bytes instead of " +
                 std::to_string(expected_bytes));
  }
  return stream->Read(size, "the numbers", decoded);
}

struct BlockSizes {
  std::vector<uint64_t> packed;
  uint64_t full = 0;  ///< of every block but the last, inflated
  uint64_t last = 0;
};

BlockSizes ReadBlockSizes(ArrayStream* stream, uint64_t expected_bytes) {
  BlockSizes sizes;
  const uint64_t block_count = stream->ReadHeader("the number of blocks");
  sizes.full = block_count == 0 ? 0 : stream->ReadHeader("the block size");
  sizes.last = block_count == 0 ? 0 : stream->ReadHeader("the size of the last block");
  if (sizes.last == 0) sizes.last = sizes.full;
  const bool too_many =
      block_count > 1 && (sizes.full == 0 || block_count - 1 > expected_bytes / sizes.full);
  if (too_many ||
      (block_count == 0 ? 0 : (block_count - 1) * sizes.full + sizes.last) != expected_bytes) {
    stream->Fail("its " + std::to_string(block_count) + " blocks do not add up to " +
                 std::to_string(expected_bytes) + " bytes");
  }
  for (uint64_t block = 0; block < block_count; ++block) {
    sizes.packed.push_back(stream->ReadHeader("the packed size of a block"));
  }
  return sizes;
}

void ReadCompressed(ArrayStream* stream, uint64_t expected_bytes, std::string* bytes) {
  constexpr uint64_t kUsualRatio = 64;  // room for more is made as it comes
  const BlockSizes sizes = ReadBlockSizes(stream, expected_bytes);
  bytes->reserve(std::min(expected_bytes, kUsualRatio * stream->UpperBound()) + 1);
  AdviseLargePages(*bytes);
  std::string buffer;
  for (size_t block = 0; block < sizes.packed.size(); ++block) {
    const uint64_t size = block + 1 == sizes.packed.size() ? sizes.last : sizes.full;
    buffer.clear();
    const auto packed = stream->Read(sizes.packed[block], "a packed block", &buffer);
    if (!Unpack(stream->packing(), packed, size, bytes)) {
      stream->Fail("block " + std::to_string(block) + " is damaged or of another size");
    }
  }
}

}  // namespace

ArrayBytes::ArrayBytes(const XMLElement& array, const VtuStorage& storage, uint64_t count,
                       size_t item_size) {
  ArrayStream stream(array, storage);
  const uint64_t expected_bytes = count * item_size;
  if (storage.packing == Packing::kNone) {
    view_ = ReadPlain(&stream, expected_bytes, &decoded_);
  } else {
    ReadCompressed(&stream, expected_bytes, &decoded_);
    view_ = decoded_;
  }
  stream.Finish();
}

}  // namespace palpate::fem::mesh_io
