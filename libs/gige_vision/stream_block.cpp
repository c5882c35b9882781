// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/stream_block.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "libs/core/check.hpp"

namespace palpate::gige_vision {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels go out little-endian");

constexpr std::size_t kStandardHeader = 8;
constexpr std::size_t kExtendedHeader = 20;
constexpr std::size_t kPartHeader = 8;  // of a multi-part payload packet
constexpr std::uint16_t kResentFlag = 0x0001;
constexpr std::uint32_t kExtendedIds = 0x8000'0000;
constexpr std::uint8_t kTrusted = 255;  // confidence of a pixel that has depth

/// Goes on in a head's fixed space.
class HeadWriter {
 public:
  explicit HeadWriter(StreamPacket* packet) : packet_{packet} {}
  void Put(std::uint64_t value, int count) {
    PALPATE_CHECK(packet_->head_size + static_cast<std::size_t>(count) <= StreamPacket::kMaxHead);
    for (int i = count - 1; i >= 0; --i) {
      packet_->head[packet_->head_size++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }

 private:
  StreamPacket* packet_;
};

struct HeaderFields {
  ErrorCode status = ErrorCode::kSuccess;
  PacketFormat format = PacketFormat::kLeader;
  std::uint64_t block_id = 0;
  std::uint32_t packet_id = 0;
  std::uint32_t part_count = 0;  ///< in leaders and trailers of parts
  bool extended_ids = true;
  bool resent = false;
};

void PutHeader(const HeaderFields& fields, StreamPacket* packet) {
  HeadWriter writer{packet};
  const std::uint32_t format = static_cast<std::uint32_t>(fields.format) << 24;
  writer.Put(static_cast<std::uint16_t>(fields.status), 2);
  if (fields.extended_ids) {
    writer.Put(fields.resent ? kResentFlag : 0, 2);
    writer.Put(kExtendedIds | format | fields.part_count, 4);
    writer.Put(fields.block_id, 8);
    writer.Put(fields.packet_id, 4);
  } else {
    writer.Put(fields.block_id, 2);
    writer.Put(format | (fields.packet_id & 0xff'ffff), 4);
  }
}

PartType TypeOf(ComponentId id) {
  switch (id) {
    case ComponentId::kRange: return PartType::kImage3d;
    case ComponentId::kConfidence: return PartType::kConfidence;
    case ComponentId::kIntensity: break;
  }
  return PartType::kImage2d;
}

void PutRegion(const Region& region, HeadWriter* writer) {
  for (const std::uint32_t value :
       {region.width, region.height, region.offset_x, region.offset_y}) {
    writer->Put(value, 4);
  }
  writer->Put(0, 4);  // paddings in x and y
}

template <typename Pixel>
void CopyRegion(const Pixel* from, std::size_t row_length, std::size_t channels,
                const Region& region, std::uint8_t* to) {
  const std::size_t row_B = region.width * channels * sizeof(Pixel);
  for (std::uint32_t v = 0; v < region.height; ++v) {
    const Pixel* row = from + ((region.offset_y + v) * row_length + region.offset_x) * channels;
    std::memcpy(to + v * row_B, row, row_B);
  }
}

void CopyConfidence(const rgbd::DepthImage& depth, std::uint16_t invalid, const Region& region,
                    std::uint8_t* to) {
  for (std::uint32_t v = 0; v < region.height; ++v) {
    const std::uint16_t* row =
        depth.Pixel(static_cast<int>(region.offset_x), static_cast<int>(region.offset_y + v));
    to = std::transform(row, row + region.width, to,
                        [=](std::uint16_t z) { return z == invalid ? std::uint8_t{0} : kTrusted; });
  }
}

}  // namespace

std::size_t StreamBlock::PacketPayload() const {
  const std::size_t header =
      (plan_.extended_ids ? kExtendedHeader : kStandardHeader) + (multipart() ? kPartHeader : 0);
  return plan_.packet_size - kUdpOverhead - header;
}

void StreamBlock::Fill(const StreamPlan& plan, const rgbd::RgbdFrame& frame, std::uint64_t id,
                       std::uint64_t timestamp_ns) {
  plan_ = plan;
  id_ = id;
  timestamp_ns_ = timestamp_ns;
  parts_.clear();
  std::size_t offset = 0;
  for (const StreamPlan::Component& component : plan.components) {
    const Region& region = component.region;
    const std::size_t size =
        std::size_t{region.width} * region.height * BytesPerPixel(component.id);
    parts_.push_back({component, offset, size, 0});
    offset += size;
  }
  pixels_.resize(offset);
  packet_count_ = 1;
  for (Part& part : parts_) {
    part.first_packet = packet_count_;
    packet_count_ +=
        static_cast<std::uint32_t>((part.size + PacketPayload() - 1) / PacketPayload());
    CopyPixels(frame, part.component, pixels_.data() + part.offset);
  }
  ++packet_count_;
}

void StreamBlock::CopyPixels(const rgbd::RgbdFrame& frame, const StreamPlan::Component& component,
                             std::uint8_t* to) const {
  const Region& region = component.region;
  const rgbd::DepthImage& depth = frame.depth;
  switch (component.id) {
    case ComponentId::kRange:
      CopyRegion(depth.values.data(), static_cast<std::size_t>(depth.width_px), 1, region, to);
      break;
    case ComponentId::kConfidence: CopyConfidence(depth, plan_.invalid_depth, region, to); break;
    case ComponentId::kIntensity:
      if (frame.color.empty()) {
        std::fill_n(to, std::size_t{region.width} * region.height * 3, std::uint8_t{0});
      } else {
        CopyRegion(frame.color.values.data(), static_cast<std::size_t>(frame.color.width_px), 3,
                   region, to);
      }
      break;
  }
}

void StreamBlock::PutLeader(StreamPacket* packet) const {
  HeadWriter writer{packet};
  writer.Put(0, 2);
  writer.Put(
      static_cast<std::uint16_t>(multipart() ? PayloadType::kMultipart : PayloadType::kImage), 2);
  writer.Put(timestamp_ns_, 8);
  for (const Part& part : parts_) {
    const ComponentId id = part.component.id;
    if (multipart()) {
      writer.Put(static_cast<std::uint16_t>(TypeOf(id)), 2);
      writer.Put(part.size, 6);
      writer.Put(PixelFormatOf(id), 4);
      writer.Put(0, 2 + 1 + 1);  // reserved, source, further zones
      writer.Put(0, 4);          // zone directions
      writer.Put(static_cast<std::uint16_t>(id), 2);
      writer.Put(0, 2);  // region
    } else {
      writer.Put(PixelFormatOf(id), 4);
    }
    PutRegion(part.component.region, &writer);
    if (multipart()) writer.Put(0, 4);
  }
}

void StreamBlock::PutTrailer(StreamPacket* packet) const {
  HeadWriter writer{packet};
  writer.Put(0, 2);
  writer.Put(
      static_cast<std::uint16_t>(multipart() ? PayloadType::kMultipart : PayloadType::kImage), 2);
  writer.Put(parts_.front().component.region.height, 4);
}

void StreamBlock::MakePacket(std::uint32_t packet_id, bool resent, StreamPacket* packet) const {
  PALPATE_CHECK(packet_id < packet_count_, packet_id, packet_count_);
  packet->head_size = 0;
  packet->pixels = {};
  HeaderFields fields{.block_id = id_, .packet_id = packet_id};
  fields.extended_ids = plan_.extended_ids;
  fields.resent = resent;
  if (packet_id == 0 || packet_id + 1 == packet_count_) {
    const bool leader = packet_id == 0;
    fields.format = leader ? PacketFormat::kLeader : PacketFormat::kTrailer;
    fields.part_count = multipart() ? static_cast<std::uint32_t>(parts_.size()) : 0;
    PutHeader(fields, packet);
    leader ? PutLeader(packet) : PutTrailer(packet);
    return;
  }
  fields.format = multipart() ? PacketFormat::kMultipartPayload : PacketFormat::kImagePayload;
  PutHeader(fields, packet);
  PutPixels(packet_id, packet);
}

void StreamBlock::PutPixels(std::uint32_t packet_id, StreamPacket* packet) const {
  std::size_t index = parts_.size() - 1;
  while (parts_[index].first_packet > packet_id) --index;
  const Part& part = parts_[index];
  const std::size_t skipped = (packet_id - part.first_packet) * PacketPayload();
  if (multipart()) {
    HeadWriter writer{packet};
    writer.Put(index, 1);
    writer.Put(0, 1);  // zone
    writer.Put(part.offset + skipped, 6);
  }
  packet->pixels = ByteView(pixels_).subspan(part.offset + skipped,
                                             std::min(PacketPayload(), part.size - skipped));
}

void StreamBlock::MakeRefusal(std::uint64_t block_id, std::uint32_t packet_id, bool extended_ids,
                              StreamPacket* packet) {
  packet->head_size = 0;
  packet->pixels = {};
  HeaderFields fields{.status = ErrorCode::kPacketUnavailable, .block_id = block_id};
  fields.format = PacketFormat::kImagePayload;
  fields.packet_id = packet_id;
  fields.extended_ids = extended_ids;
  PutHeader(fields, packet);
}

}  // namespace palpate::gige_vision
