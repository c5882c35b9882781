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
#include "libs/core/index.hpp"

namespace palpate::rgbd {

namespace {

/// More than this is no camera image, but a broken or hostile header.
constexpr std::uint64_t kLargestImage_px = 64'000'000;

/// An image as libpng has it: rows of bytes.
struct Rows {
  int width_px = 0;
  int height_px = 0;
  int bit_depth = 0;   ///< of a channel
  int color_type = 0;  ///< PNG_COLOR_TYPE_...
  std::vector<png_bytep> rows;

  template <typename Image>
  void PointInto(Image& image) {
    rows.resize(static_cast<std::size_t>(image.height_px));
    for (int v = 0; v < image.height_px; ++v) {
      const void* row = image.Pixel(0, v);
      rows[At(v)] = static_cast<png_bytep>(const_cast<void*>(row));
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

bool EncodeRows(png_structp png, png_infop info, Rows* image_rows, int level) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, level);
  // Depth and colour are smooth along a row; trying all filters costs half as much again.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image_rows->width_px),
               static_cast<png_uint_32>(image_rows->height_px), image_rows->bit_depth,
               image_rows->color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (image_rows->bit_depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, image_rows->rows.data());
  png_write_end(png, nullptr);
  return true;
}

bool DecodeHeader(png_structp png, png_infop info, Rows* image_rows, bool* transparent) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  image_rows->width_px = static_cast<int>(png_get_image_width(png, info));
  image_rows->height_px = static_cast<int>(png_get_image_height(png, info));
  image_rows->bit_depth = png_get_bit_depth(png, info);
  image_rows->color_type = png_get_color_type(png, info);
  *transparent = (image_rows->color_type & PNG_COLOR_MASK_ALPHA) != 0 ||
                 png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  return true;
}

/// Rows of four bytes a pixel: red, green, blue, alpha.
bool DecodeRowsWithAlpha(png_structp png, png_infop info, Rows* image_rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, image_rows->rows.data());
  png_read_end(png, nullptr);
  return true;
}

bool DecodeRows(png_structp png, png_infop info, Rows* image_rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  if (image_rows->bit_depth == 16) {
    if (std::endian::native == std::endian::little) png_set_swap(png);
  } else {
    png_set_expand(png);
    png_set_gray_to_rgb(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, image_rows->rows.data());
  png_read_end(png, nullptr);
  return true;
}

std::string Encode(Rows* image_rows, int level) {
  PALPATE_CHECK(image_rows->width_px > 0 && image_rows->height_px > 0, image_rows->width_px,
                image_rows->height_px);
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
  const bool encoded = EncodeRows(png, info, image_rows, level);
  png_destroy_write_struct(&png, &info);
  if (!encoded) throw RunError("cannot encode the image as PNG: " + error);
  return bytes;
}

template <typename Image>
std::string Encode(const Image& image, int level) {
  constexpr bool kDepth = Image::channels == 1;
  Rows image_rows{.width_px = image.width_px,
                  .height_px = image.height_px,
                  .bit_depth = kDepth ? 16 : 8,
                  .color_type = kDepth ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                  .rows = {}};
  image_rows.PointInto(image);
  return Encode(&image_rows, level);
}

/// Reads one PNG; the destructor gives libpng's memory back.
class Decoder {
 public:
  /// `png` must outlive this.
  Decoder(std::string_view png, const std::string& name) : file_{name}, rest_(png) {
    const auto* head = reinterpret_cast<png_const_bytep>(png.data());
    if (png.size() < 8 || png_sig_cmp(head, 0, 8) != 0) Refuse("is no PNG image");
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
    if (!DecodeHeader(png_, info_, &rows_, &transparent)) RefuseDamaged();
    const auto width = static_cast<std::uint64_t>(rows_.width_px);
    if (width * static_cast<std::uint64_t>(rows_.height_px) > kLargestImage_px) {
      Refuse("has " + std::to_string(rows_.width_px) + " x " + std::to_string(rows_.height_px) +
             " pixels; at most 64 million are read");
    }
    transparent_ = transparent;
    return rows_;
  }

  bool transparent() const { return transparent_; }

  /// Of an image that could have been transparent. Throws InputError where a pixel is.
  ColorImage OpaquePixels() {
    const auto pixels =
        static_cast<std::size_t>(rows_.width_px) * static_cast<std::size_t>(rows_.height_px);
    std::vector<png_byte> rgba(4 * pixels);
    rows_.rows.clear();
    for (std::size_t v = 0; v < static_cast<std::size_t>(rows_.height_px); ++v) {
      rows_.rows.push_back(rgba.data() + 4 * v * static_cast<std::size_t>(rows_.width_px));
    }
    if (!DecodeRowsWithAlpha(png_, info_, &rows_)) RefuseDamaged();
    ColorImage image(rows_.width_px, rows_.height_px);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (rgba[4 * i + 3] != 0xff) {
        Refuse("is transparent in places (alpha below 255); a colour image must be opaque");
      }
      std::copy_n(rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                  image.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return image;
  }

  template <typename Image>
  Image Pixels() {
    Image image(rows_.width_px, rows_.height_px);
    rows_.PointInto(image);
    if (!DecodeRows(png_, info_, &rows_)) RefuseDamaged();
    return image;
  }

 private:
  [[noreturn]] void RefuseDamaged() const { Refuse("is a damaged PNG image: " + error_); }

  SourceLocation file_;
  std::string_view rest_;  // not yet read
  std::string error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  Rows rows_;
  bool transparent_ = false;
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
  return DecodeDepthPng(ReadFile(file), file.string());
}

ColorImage ReadColorPng(const std::filesystem::path& file) {
  return DecodeColorPng(ReadFile(file), file.string());
}

DepthImage DecodeDepthPng(std::string_view png, const std::string& name) {
  Decoder decoder(png, name);
  const Rows& header = decoder.Header();
  if (header.color_type != PNG_COLOR_TYPE_GRAY || header.bit_depth != 16) {
    decoder.Refuse("a depth image is 16-bit grey, this one has " +
                   std::to_string(header.bit_depth) + " bits of " +
                   (header.color_type == PNG_COLOR_TYPE_GRAY ? "grey" : "colour"));
  }
  if (decoder.transparent()) decoder.Refuse("has a transparent value; a depth image has none");
  return decoder.Pixels<DepthImage>();
}

ColorImage DecodeColorPng(std::string_view png, const std::string& name) {
  Decoder decoder(png, name);
  if (decoder.Header().bit_depth == 16) {
    decoder.Refuse("a colour image has 8 bits a channel, this one has 16");
  }
  return decoder.transparent() ? decoder.OpaquePixels() : decoder.Pixels<ColorImage>();
}

}  // namespace palpate::rgbd
