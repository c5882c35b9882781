// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/raw_type.hpp"

// First: the layout of the structs below follows how the library was built.
#include <dds/features.h>

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "libs/dds/raw_message.hpp"

namespace palpate::dds {

namespace {

/// A message: the bytes follow the struct of DDS.
struct RawData : ddsi_serdata {
  std::uint32_t size;  ///< with the header of 4 bytes
  std::unique_ptr<char[]> bytes;
};

constexpr std::uint32_t RoundedUp(std::size_t size) {
  return static_cast<std::uint32_t>((size + 3) / 4 * 4);
}

RawData* NewData(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto data = std::make_unique<RawData>();
  ddsi_serdata_init(data.get(), type, kind);
  data->size = static_cast<std::uint32_t>(size);
  // DDS reads up to a multiple of 4.
  data->bytes = std::make_unique_for_overwrite<char[]>(RoundedUp(size));
  std::memset(data->bytes.get() + size, 0, RoundedUp(size) - size);
  return data.release();
}

const RawData& Raw(const ddsi_serdata* data) { return *static_cast<const RawData*>(data); }

bool EqualKey(const ddsi_serdata*, const ddsi_serdata*) { return true; }

std::uint32_t Size(const ddsi_serdata* data) { return Raw(data).size; }

ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                            const nn_rdata* fragment, size_t size) {
  RawData* data = NewData(type, kind, size);
  std::uint32_t done = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= done) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(data->bytes.get() + done, payload + done - fragment->min, fragment->maxp1 - done);
    done = fragment->maxp1;
  }
  return data;
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, size_t size) {
  RawData* data = NewData(type, kind, size);
  std::size_t done = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && done < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - done);
    std::memcpy(data->bytes.get() + done, pieces[i].iov_base, length);
    done += length;
  }
  return data;
}

ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return NewData(type, SDK_KEY, 0);
}

/// Nobody writes samples of a struct here: whoever writes has CDR.
ddsi_serdata* FromSample(const ddsi_sertype*, ddsi_serdata_kind, const void*) { return nullptr; }

void ToBytes(const ddsi_serdata* data, size_t offset, size_t size, void* out) {
  std::memcpy(out, Raw(data).bytes.get() + offset, size);
}

ddsi_serdata* ToBytesRef(const ddsi_serdata* data, size_t offset, size_t size,
                         ddsrt_iovec_t* piece) {
  piece->iov_base = Raw(data).bytes.get() + offset;
  piece->iov_len = size;
  return ddsi_serdata_ref(data);
}

void ToBytesUnref(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool ToSample(const ddsi_serdata*, void*, void**, void*) { return false; }

ddsi_serdata* ToUntyped(const ddsi_serdata* data) {
  RawData* untyped = NewData(data->type, SDK_KEY, 0);
  untyped->type = nullptr;
  return untyped;
}

bool UntypedToSample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return true;
}

void Free(ddsi_serdata* data) { delete static_cast<RawData*>(data); }

size_t Print(const ddsi_sertype*, const ddsi_serdata* data, char* text, size_t size) {
  return static_cast<size_t>(
      std::max(0, std::snprintf(text, size, "%u bytes of CDR", Raw(data).size)));
}

void KeyHash(const ddsi_serdata*, ddsi_keyhash* hash, bool) {
  std::memset(hash->value, 0, sizeof(hash->value));
}

const ddsi_serdata_ops kDataOps = {
    .eqkey = EqualKey,
    .get_size = Size,
    .from_ser = FromFragments,
    .from_ser_iov = FromPieces,
    .from_keyhash = FromKeyHash,
    .from_sample = FromSample,
    .to_ser = ToBytes,
    .to_ser_ref = ToBytesRef,
    .to_ser_unref = ToBytesUnref,
    .to_sample = ToSample,
    .to_untyped = ToUntyped,
    .untyped_to_sample = UntypedToSample,
    .free = Free,
    .print = Print,
    .get_keyhash = KeyHash,
#ifdef DDS_HAS_SHM
    .get_sample_size = Size,
    .from_iox_buffer = nullptr,
#endif
};

void FreeType(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}
void ZeroSamples(const ddsi_sertype*, void*, size_t) {}
void ReallocSamples(void**, const ddsi_sertype*, void*, size_t, size_t) {}
void FreeSamples(const ddsi_sertype*, void**, size_t, dds_free_op_t) {}
bool EqualType(const ddsi_sertype*, const ddsi_sertype*) { return true; }
std::uint32_t HashType(const ddsi_sertype*) { return 0; }

const ddsi_sertype_ops kTypeOps = {.version = ddsi_sertype_v0,
                                   .arg = nullptr,
                                   .free = FreeType,
                                   .zero_samples = ZeroSamples,
                                   .realloc_samples = ReallocSamples,
                                   .free_samples = FreeSamples,
                                   .equal = EqualType,
                                   .hash = HashType,
                                   .type_id = nullptr,
                                   .type_map = nullptr,
                                   .type_info = nullptr,
                                   .derive_sertype = nullptr,
                                   .get_serialized_size = nullptr,
                                   .serialize_into = nullptr};

}  // namespace

Entity CreateRawTopic(dds_entity_t participant, const std::string& dds_topic,
                      const std::string& dds_type, bool has_key, const ddsi_sertype** type_of) {
  auto type = std::make_unique<ddsi_sertype>();
  ddsi_sertype_init(type.get(), dds_type.c_str(), &kTypeOps, &kDataOps, !has_key);
  type->allowed_data_representation =
      DDS_DATA_REPRESENTATION_FLAG_XCDR1 | DDS_DATA_REPRESENTATION_FLAG_XCDR2;
  ddsi_sertype* raw = type.release();
  const dds_entity_t topic =
      dds_create_topic_sertype(participant, dds_topic.c_str(), &raw, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(raw);
  if (topic >= 0 && type_of != nullptr) *type_of = raw;
  return Entity(topic, "topic " + dds_topic + " of type " + dds_type);
}

bool WriteCdr(dds_entity_t writer, const ddsi_sertype* type, std::string_view cdr) {
  constexpr std::size_t kHeader = 4;
  if (cdr.size() < kHeader) return false;
  RawData* data = NewData(type, SDK_DATA, RoundedUp(cdr.size()));
  std::memcpy(data->bytes.get(), cdr.data(), cdr.size());
  // DDS sends a multiple of 4; the header then says how many bytes were added (DDS-XTypes 1.3,
  // 7.6.3.1.2).
  if (const std::size_t padding = data->size - cdr.size(); padding > 0) {
    std::memset(data->bytes.get() + cdr.size(), 0, padding);
    data->bytes[kHeader - 1] = static_cast<char>(padding);
  }
  return dds_writecdr(writer, data) == DDS_RETCODE_OK;
}

RawMessage::RawMessage(ddsi_serdata* data, std::int64_t source_time_ns, std::uint64_t writer)
    : data_(data, ddsi_serdata_unref),
      cdr_(Raw(data).bytes.get(), Raw(data).size),
      source_time_ns_(source_time_ns),
      writer_(writer) {}

}  // namespace palpate::dds
