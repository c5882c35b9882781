// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace palpate::capture {

/// The pixel formats that are decoded (GenICam PFNC 2.4). All are little-endian.
enum class PixelFormat {
  kUnknown,
  kCoord3dC16,
  kCoord3dC32f,
  kCoord3dAbc16,
  kCoord3dAbc32f,
  kCoord3dAbcy16,  ///< XYZ and intensity in one image (Lucid)
  kDisparity16,
  kConfidence,  ///< any confidence format: known, never decoded
  kMono8,
  kMono16,
  kRgb8,
  kBgr8,
  kRgba8,
  kBgra8,
  kBayerRg8,
  kBayerGr8,
  kBayerGb8,
  kBayerBg8,
};

/// By GenICam's name ("Coord3D_C16"); kUnknown where it is not decoded.
PixelFormat FormatOfName(std::string_view name);
std::string_view NameOf(PixelFormat format);

/// 0 of kUnknown and kConfidence.
std::size_t BytesPerPixel(PixelFormat format);
/// Coordinates or disparities.
bool CarriesDepth(PixelFormat format);
/// Grey or colour; kCoord3dAbcy16 carries both.
bool CarriesColor(PixelFormat format);

/// Codes of the wire, with those that one device names itself beside the standard's.
class PixelFormatCodes {
 public:
  /// What the device's PixelFormat enumeration says: makers give formats of their own own codes.
  void Learn(std::string_view name, std::int64_t code);
  PixelFormat FormatOf(std::uint32_t code) const;

 private:
  std::map<std::uint32_t, PixelFormat> learned_;
};

}  // namespace palpate::capture
