// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/png.hpp"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <string_view>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::rgbd {

namespace {

/// More than this is no camera's picture, but a broken or hostile header.
constexpr std::uint64_t kLargestPicture_px = 64'000'000;

/// A picture as libpng has it: rows of bytes.
struct Rows {
  int width_px = 0;
  int height_px = 0;
  int bit_depth = 0;   ///< of a channel
  int color_type = 0;  ///< PNG_COLOR_TYPE_...
  std::vector<png_bytep> rows;

  template <typename Picture>
  void PointInto(Picture& picture) {
    rows.resize(static_cast<std::size_t>(picture.height_px));
    for (int v = 0; v < picture.height_px; ++v) {
      const void* row = picture.Pixel(0, v);
      rows[static_cast<std::size_t>(v)] = static_cast<png_bytep>(const_cast<void*>(row));
    }
  }
};

void CollectError(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

void IgnoreWarning(png_structp, png_const_charp) {}

void AppendBytes(png_structp png, png_bytep data, png_size_t size) {
  auto* bytes = static_cast<std::string*>(png_get_io_ptr(png));
  bytes->append(data, data + size);
}

void FlushNothing(png_structp) {}

void TakeBytes(png_structp png, png_bytep data, png_size_t size) {
  auto* rest = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (rest->size() < size) png_error(png, "the file ends too early");
  std::memcpy(data, rest->data(), size);
  rest->remove_prefix(size);
}

// In each of the next functions nothing with a destructor lives, so that libpng's longjmp is well
// defined.

bool EncodeRows(png_structp png, png_infop info, Rows* picture, int level) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, level);
  // Depth and colour are smooth along a row; trying all filters costs half as much again.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture->width_px),
               static_cast<png_uint_32>(picture->height_px), picture->bit_depth,
               picture->color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (picture->bit_depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, picture->rows.data());
  png_write_end(png, nullptr);
  return true;
}

bool DecodeHeader(png_structp png, png_infop info, Rows* picture, bool* transparent) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  picture->width_px = static_cast<int>(png_get_image_width(png, info));
  picture->height_px = static_cast<int>(png_get_image_height(png, info));
  picture->bit_depth = png_get_bit_depth(png, info);
  picture->color_type = png_get_color_type(png, info);
  *transparent = (picture->color_type & PNG_COLOR_MASK_ALPHA) != 0 ||
                 png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  return true;
}

bool DecodeRows(png_structp png, png_infop info, Rows* picture) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  if (picture->bit_depth == 16) {
    if (std::endian::native == std::endian::little) png_set_swap(png);
  } else {
    png_set_expand(png);
    png_set_gray_to_rgb(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, picture->rows.data());
  png_read_end(png, nullptr);
  return true;
}

std::string Encode(Rows* picture, int level) {
  PALPATE_CHECK(picture->width_px > 0 && picture->height_px > 0, picture->width_px,
                picture->height_px);
  PALPATE_CHECK(level >= 0 && level <= 9, level);
  std::string error;
  std::string bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, CollectError, IgnoreWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr) {
    png_destroy_write_struct(&png, nullptr);
    throw RunError("libpng could not be started (out of memory)");
  }
  png_set_write_fn(png, &bytes, AppendBytes, FlushNothing);
  const bool encoded = EncodeRows(png, info, picture, level);
  png_destroy_write_struct(&png, &info);
  if (!encoded) throw RunError("cannot encode the picture as PNG: " + error);
  return bytes;
}

template <typename Picture>
std::string Encode(const Picture& image, int level) {
  constexpr bool kDepth = Picture::channels == 1;
  Rows picture{.width_px = image.width_px,
               .height_px = image.height_px,
               .bit_depth = kDepth ? 16 : 8,
               .color_type = kDepth ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
               .rows = {}};
  picture.PointInto(image);
  return Encode(&picture, level);
}

/// Reads one file; the destructor gives libpng's memory back.
class Decoder {
 public:
  explicit Decoder(const std::filesystem::path& file)
      : file_{file.string()}, bytes_(ReadFile(file)), rest_(bytes_) {
    const auto* head = reinterpret_cast<png_const_bytep>(bytes_.data());
    if (bytes_.size() < 8 || png_sig_cmp(head, 0, 8) != 0) Refuse("is no PNG picture");
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error_, CollectError, IgnoreWarning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw RunError("libpng could not be started (out of memory)");
    }
    png_set_read_fn(png_, &rest_, TakeBytes);
  }
  ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  [[noreturn]] void Refuse(const std::string& message) const { throw InputError(file_, message); }

  const Rows& Header() {
    bool transparent = false;
    if (!DecodeHeader(png_, info_, &picture_, &transparent)) RefuseDamaged();
    const auto width = static_cast<std::uint64_t>(picture_.width_px);
    if (width * static_cast<std::uint64_t>(picture_.height_px) > kLargestPicture_px) {
      Refuse("has " + std::to_string(picture_.width_px) + " x " +
             std::to_string(picture_.height_px) + " pixels; at most 64 million are read");
    }
    if (transparent) Refuse("has an alpha channel or transparent colour; a picture has none");
    return picture_;
  }

  template <typename Picture>
  Picture Pixels() {
    Picture image(picture_.width_px, picture_.height_px);
    picture_.PointInto(image);
    if (!DecodeRows(png_, info_, &picture_)) RefuseDamaged();
    return image;
  }

 private:
  [[noreturn]] void RefuseDamaged() const { Refuse("is a damaged PNG picture: " + error_); }

  SourceLocation file_;
  std::string bytes_;
  std::string_view rest_;  // of the bytes, not yet read
  std::string error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  Rows picture_;
};

}  // namespace

std::string EncodeColorPng(const ColorImage& image, int level) { return Encode(image, level); }

void WriteDepthPng(const std::filesystem::path& file, const DepthImage& image, int level) {
  WriteFile(file, Encode(image, level));
}

void WriteColorPng(const std::filesystem::path& file, const ColorImage& image, int level) {
  WriteFile(file, Encode(image, level));
}

DepthImage ReadDepthPng(const std::filesystem::path& file) {
  Decoder decoder(file);
  const Rows& header = decoder.Header();
  if (header.color_type != PNG_COLOR_TYPE_GRAY || header.bit_depth != 16) {
    decoder.Refuse("a depth image is 16-bit grey, this one has " +
                   std::to_string(header.bit_depth) + " bits of " +
                   (header.color_type == PNG_COLOR_TYPE_GRAY ? "grey" : "colour"));
  }
  return decoder.Pixels<DepthImage>();
}

ColorImage ReadColorPng(const std::filesystem::path& file) {
  Decoder decoder(file);
  if (decoder.Header().bit_depth == 16) {
    decoder.Refuse("a colour image has 8 bits a channel, this one has 16");
  }
  return decoder.Pixels<ColorImage>();
}

}  // namespace palpate::rgbd
