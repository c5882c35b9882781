// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam/pixel_format.hpp"

namespace palpate::capture {

namespace {

struct FormatRow {
  PixelFormat format;
  std::string_view name;
  std::uint32_t code;  ///< of PFNC; 0: none
  std::size_t bytes;
  bool depth;
  bool color;
};

constexpr FormatRow kFormats[] = {
    {PixelFormat::kCoord3dC16, "Coord3D_C16", 0x011000B8, 2, true, false},
    {PixelFormat::kCoord3dC32f, "Coord3D_C32f", 0x012000BF, 4, true, false},
    {PixelFormat::kCoord3dAbc16, "Coord3D_ABC16", 0x023000B9, 6, true, false},
    {PixelFormat::kCoord3dAbc32f, "Coord3D_ABC32f", 0x026000C0, 12, true, false},
    {PixelFormat::kCoord3dAbcy16, "Coord3D_ABCY16", 0, 8, true, true},
    {PixelFormat::kDisparity16, "Disparity16", 0, 2, true, false},
    {PixelFormat::kConfidence, "Confidence16", 0x011000C7, 0, false, false},
    {PixelFormat::kConfidence, "Confidence8", 0x010800C6, 0, false, false},
    {PixelFormat::kConfidence, "Confidence1", 0x010800C4, 0, false, false},
    {PixelFormat::kConfidence, "Confidence1p", 0x010100C5, 0, false, false},
    {PixelFormat::kConfidence, "Confidence32f", 0x012000C8, 0, false, false},
    {PixelFormat::kMono8, "Mono8", 0x01080001, 1, false, true},
    {PixelFormat::kMono16, "Mono16", 0x01100007, 2, false, true},
    {PixelFormat::kRgb8, "RGB8", 0x02180014, 3, false, true},
    {PixelFormat::kRgb8, "RGB8Packed", 0, 3, false, true},
    {PixelFormat::kBgr8, "BGR8", 0x02180015, 3, false, true},
    {PixelFormat::kBgr8, "BGR8Packed", 0, 3, false, true},
    {PixelFormat::kRgba8, "RGBa8", 0x02200016, 4, false, true},
    {PixelFormat::kBgra8, "BGRa8", 0x02200017, 4, false, true},
    {PixelFormat::kBayerGr8, "BayerGR8", 0x01080008, 1, false, true},
    {PixelFormat::kBayerRg8, "BayerRG8", 0x01080009, 1, false, true},
    {PixelFormat::kBayerGb8, "BayerGB8", 0x0108000A, 1, false, true},
    {PixelFormat::kBayerBg8, "BayerBG8", 0x0108000B, 1, false, true},
};

constexpr FormatRow kNoFormat = {PixelFormat::kUnknown, "unknown", 0, 0, false, false};

const FormatRow& RowOf(PixelFormat format) {
  for (const FormatRow& row : kFormats) {
    if (row.format == format) return row;
  }
  return kNoFormat;
}

}  // namespace

PixelFormat FormatOfName(std::string_view name) {
  for (const FormatRow& row : kFormats) {
    if (row.name == name) return row.format;
  }
  return PixelFormat::kUnknown;
}

std::string_view NameOf(PixelFormat format) { return RowOf(format).name; }
std::size_t BytesPerPixel(PixelFormat format) { return RowOf(format).bytes; }
bool CarriesDepth(PixelFormat format) { return RowOf(format).depth; }
bool CarriesColor(PixelFormat format) { return RowOf(format).color; }

void PixelFormatCodes::Learn(std::string_view name, std::int64_t code) {
  const PixelFormat format = FormatOfName(name);
  if (format == PixelFormat::kUnknown || code <= 0 || code > std::int64_t{UINT32_MAX}) return;
  const auto key = static_cast<std::uint32_t>(code);
  // A device may name formats of its own, not rename the standard's.
  if (PixelFormatCodes().FormatOf(key) == PixelFormat::kUnknown) learned_.emplace(key, format);
}

PixelFormat PixelFormatCodes::FormatOf(std::uint32_t code) const {
  for (const FormatRow& row : kFormats) {
    if (row.code != 0 && row.code == code) return row.format;
  }
  const auto learned = learned_.find(code);
  return learned == learned_.end() ? PixelFormat::kUnknown : learned->second;
}

}  // namespace palpate::capture
