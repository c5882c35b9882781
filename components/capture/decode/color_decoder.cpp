// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/decode/color_decoder.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace palpate::capture {

namespace {

using Byte = std::uint8_t;

/// Where red, green and blue stand in a pixel of a format that holds them, bytes.
struct ChannelPlaces {
  int red, green, blue;
};

ChannelPlaces PlacesOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBgr8:
    case PixelFormat::kBgra8: return {2, 1, 0};
    case PixelFormat::kMono16: return {1, 1, 1};
    case PixelFormat::kCoord3dAbcy16: return {7, 7, 7};
    case PixelFormat::kMono8: return {0, 0, 0};
    default: return {0, 1, 2};
  }
}

void CopyRow(const ImagePart& part, const Byte* pixel, Byte* target) {
  const std::size_t bytes = BytesPerPixel(part.format);
  if (part.format == PixelFormat::kRgb8) {
    std::memcpy(target, pixel, bytes * static_cast<std::size_t>(part.width_px));
    return;
  }
  const ChannelPlaces places = PlacesOf(part.format);
  for (int u = 0; u < part.width_px; ++u, pixel += bytes, target += 3) {
    target[0] = pixel[places.red];
    target[1] = pixel[places.green];
    target[2] = pixel[places.blue];
  }
}

bool IsBayer(PixelFormat format) {
  return format == PixelFormat::kBayerRg8 || format == PixelFormat::kBayerGr8 ||
         format == PixelFormat::kBayerGb8 || format == PixelFormat::kBayerBg8;
}

/// A Bayer mosaic with its neighbours; the border is mirrored, which keeps the colours in place.
class Mosaic {
 public:
  Mosaic(const ImagePart& part, std::size_t step) : part_(part), step_(step) {
    red_u_ = part.format == PixelFormat::kBayerGr8 || part.format == PixelFormat::kBayerBg8 ? 1 : 0;
    red_v_ = part.format == PixelFormat::kBayerGb8 || part.format == PixelFormat::kBayerBg8 ? 1 : 0;
  }

  void Write(int u, int v, Byte* target) const {
    const bool red_column = (u & 1) == red_u_;
    const bool red_row = (v & 1) == red_v_;
    const int here = At(u, v);
    const int sides = At(u - 1, v) + At(u + 1, v);
    const int above_below = At(u, v - 1) + At(u, v + 1);
    if (red_column != red_row) {  // a green pixel
      const int across = (sides + 1) / 2;
      const int along = (above_below + 1) / 2;
      Set(target, red_row ? across : along, here, red_row ? along : across);
      return;
    }
    const int cross = (sides + above_below + 2) / 4;
    const int corners =
        (At(u - 1, v - 1) + At(u + 1, v - 1) + At(u - 1, v + 1) + At(u + 1, v + 1) + 2) / 4;
    Set(target, red_row ? here : corners, cross, red_row ? corners : here);
  }

 private:
  int At(int u, int v) const {
    const auto column = static_cast<std::size_t>(Mirror(u, part_.width_px));
    const auto row = static_cast<std::size_t>(Mirror(v, part_.height_px));
    return part_.data[row * step_ + column];
  }
  static int Mirror(int i, int size) {
    if (i < 0) return std::min(-i, size - 1);
    return i < size ? i : std::max(0, 2 * size - 2 - i);
  }
  static void Set(Byte* target, int red, int green, int blue) {
    target[0] = static_cast<Byte>(red);
    target[1] = static_cast<Byte>(green);
    target[2] = static_cast<Byte>(blue);
  }

  const ImagePart& part_;
  std::size_t step_;
  int red_u_;  ///< 1: the red pixels stand in the odd columns
  int red_v_;
};

}  // namespace

Status DecodeColor(const ImagePart& part, rgbd::ColorImage* image) {
  if (!CarriesColor(part.format)) {
    return {StatusCode::kInvalidInput, std::string(NameOf(part.format)) + " carries no intensity"};
  }
  const std::size_t step = RowStep(part);
  if (step == 0) return {StatusCode::kInvalidInput, "the colour image has fewer bytes than pixels"};
  image->width_px = part.width_px;
  image->height_px = part.height_px;
  image->values.resize(3 * static_cast<std::size_t>(part.width_px) *
                       static_cast<std::size_t>(part.height_px));
  const Mosaic mosaic(part, step);
  for (int v = 0; v < part.height_px; ++v) {
    Byte* target = image->Pixel(0, v);
    if (IsBayer(part.format)) {
      for (int u = 0; u < part.width_px; ++u) mosaic.Write(u, v, target + 3 * u);
    } else {
      CopyRow(part, part.data + step * static_cast<std::size_t>(v), target);
    }
  }
  return Status::Ok();
}

}  // namespace palpate::capture
