// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/message_data.hpp"

#include <dds/ddsi/ddsi_cdrstream.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::dds {

namespace {

constexpr std::uint32_t kXcdr1 = 1;  // version of the encoding

/// One instruction of a type's description, and where its value is (dds_opcodes.h).
struct Member {
  const std::uint32_t* op;
  std::byte* value;

  dds_stream_typecode type() const { return DDS_OP_TYPE(*op); }
  dds_stream_typecode subtype() const { return DDS_OP_SUBTYPE(*op); }
  bool is_floating() const { return (DDS_OP_FLAGS(*op) & DDS_OP_FLAG_FP) != 0; }
};

/// Garbles numbers that lie one after the other.
class Garbler {
 public:
  explicit Garbler(std::mt19937_64* random) : random_(*random) {}

  void Struct(const std::uint32_t* op, std::byte* value);

 private:
  // These return how many words the instruction has.
  std::size_t Value(const Member& member);
  std::size_t Sequence(const Member& member);
  std::size_t Array(const Member& member);

  void Numbers(dds_stream_typecode type, std::byte* values, std::uint32_t count);
  double Number();

  std::mt19937_64& random_;
};

/// Of any magnitude from 1e-6 to 1e6 and either sign; one of 16 is not finite.
double Garbler::Number() {
  constexpr std::uint64_t kKinds = 32;
  switch (random_() % kKinds) {
    case 0: return std::numeric_limits<double>::quiet_NaN();
    case 1: return std::numeric_limits<double>::infinity();
    default: break;
  }
  const double exponent = std::uniform_real_distribution<>(-6.0, 6.0)(random_);
  return (random_() % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent);
}

void Garbler::Numbers(dds_stream_typecode type, std::byte* values, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (type == DDS_OP_VAL_8BY) {
      const double number = Number();
      std::memcpy(values + i * sizeof(number), &number, sizeof(number));
    } else if (type == DDS_OP_VAL_4BY) {
      const auto number = static_cast<float>(Number());
      std::memcpy(values + i * sizeof(number), &number, sizeof(number));
    }
  }
}

std::size_t Garbler::Sequence(const Member& member) {
  auto& sequence = *reinterpret_cast<dds_sequence_t*>(member.value);
  auto* elements = reinterpret_cast<std::byte*>(sequence._buffer);
  switch (member.subtype()) {
    case DDS_OP_VAL_1BY:
      for (std::uint32_t i = 0; i < sequence._length; ++i) {
        elements[i] = static_cast<std::byte>(random_() & 0xFF);
      }
      return 2;
    case DDS_OP_VAL_STU:
      for (std::uint32_t i = 0; i < sequence._length; ++i) {
        Struct(member.op + static_cast<std::int16_t>(member.op[3] & 0xFFFF),
               elements + std::size_t{i} * member.op[2]);
      }
      return DDS_OP_ADR_JMP(member.op[3]);
    default:
      if (member.is_floating()) Numbers(member.subtype(), elements, sequence._length);
      return 2;
  }
}

std::size_t Garbler::Array(const Member& member) {
  if (member.subtype() == DDS_OP_VAL_STU) {
    for (std::uint32_t i = 0; i < member.op[2]; ++i) {
      Struct(member.op + static_cast<std::int16_t>(member.op[3] & 0xFFFF),
             member.value + std::size_t{i} * member.op[4]);
    }
    return DDS_OP_ADR_JMP(member.op[3]);
  }
  if (member.is_floating()) Numbers(member.subtype(), member.value, member.op[2]);
  return 3;
}

std::size_t Garbler::Value(const Member& member) {
  switch (member.type()) {
    case DDS_OP_VAL_4BY:
    case DDS_OP_VAL_8BY:
      if (member.is_floating()) Numbers(member.type(), member.value, 1);
      return 2;
    case DDS_OP_VAL_1BY:
    case DDS_OP_VAL_2BY:
    case DDS_OP_VAL_BLN:
    case DDS_OP_VAL_STR: return 2;
    case DDS_OP_VAL_SEQ: return Sequence(member);
    case DDS_OP_VAL_ARR: return Array(member);
    case DDS_OP_VAL_EXT:
      Struct(member.op + static_cast<std::int16_t>(member.op[2] & 0xFFFF), member.value);
      return DDS_OP_ADR_JMP(member.op[2]);
    default: break;
  }
  // Unions, enumerations and bounded members are in no message of idl/.
  PALPATE_CHECK(false, static_cast<int>(member.type()));
  return 0;
}

void Garbler::Struct(const std::uint32_t* op, std::byte* value) {
  while (DDS_OP(*op) == DDS_OP_ADR) op += Value({op, value + op[1]});
  PALPATE_CHECK(DDS_OP(*op) == DDS_OP_RTS, *op);
}

}  // namespace

std::size_t CopyMessage(const dds_topic_descriptor_t& type, const void* from, void* to) {
  constexpr std::uint32_t kFirstSize = 4096;
  dds_ostream_t out;
  dds_ostream_init(&out, kFirstSize, kXcdr1);
  dds_stream_write(&out, static_cast<const char*>(from), type.m_ops);
  dds_istream_t in;
  dds_istream_init(&in, out.m_index, out.m_buffer, kXcdr1);
  dds_stream_read(&in, static_cast<char*>(to), type.m_ops);
  const std::size_t size = out.m_index;
  dds_istream_fini(&in);
  dds_ostream_fini(&out);
  return size;
}

void GarbleMessage(const dds_topic_descriptor_t& type, std::mt19937_64* random, void* message) {
  Garbler(random).Struct(type.m_ops, static_cast<std::byte*>(message));
}

}  // namespace palpate::dds
