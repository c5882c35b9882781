// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/png.hpp"

#include <png.h>

#include <csetjmp>
#include <string>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::view {

namespace {

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

// Nothing with a destructor lives in this frame, so that libpng's longjmp is well defined.
bool EncodeRows(png_structp png, png_infop info, const Image& image) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  const auto width = static_cast<png_uint_32>(image.width_px);
  const auto height = static_cast<png_uint_32>(image.height_px);
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int y = 0; y < image.height_px; ++y) {
    png_write_row(png, image.Pixel(0, y));
  }
  png_write_end(png, nullptr);
  return true;
}

std::string Encode(const Image& image) {
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
  const bool encoded = EncodeRows(png, info, image);
  png_destroy_write_struct(&png, &info);
  if (!encoded) {
    throw RunError("cannot encode the picture as PNG: " + error);
  }
  return bytes;
}

}  // namespace

void WritePng(const std::filesystem::path& path, const Image& image) {
  PALPATE_CHECK(image.width_px > 0 && image.height_px > 0, image.width_px, image.height_px);
  WriteFile(path, Encode(image));
}

}  // namespace palpate::view
