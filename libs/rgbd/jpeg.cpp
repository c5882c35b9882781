// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/jpeg.hpp"

#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

// It needs the types of <cstdio>.
#include <jpeglib.h>

#include "libs/core/error.hpp"

namespace palpate::rgbd {

namespace {

/// More than this is no camera image, but a broken or hostile header.
constexpr std::uint64_t kLargestJpeg_px = 64'000'000;

/// libjpeg's errors, which must not return.
struct JpegErrors {
  jpeg_error_mgr manager;  // first: libjpeg hands out its address
  std::jmp_buf place;
  std::array<char, JMSG_LENGTH_MAX> message{};
};

void LeaveByJump(j_common_ptr jpeg) {
  auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
  (*jpeg->err->format_message)(jpeg, errors->message.data());
  std::longjmp(errors->place, 1);
}

void IgnoreMessage(j_common_ptr) {}

// In the next functions nothing with a destructor lives, so that the jump is well defined.

bool ReadJpegHeader(jpeg_decompress_struct* jpeg, JpegErrors* errors, std::string_view bytes) {
  if (setjmp(errors->place) != 0) return false;
  jpeg_mem_src(jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(jpeg, TRUE);
  if (jpeg->jpeg_color_space != JCS_CMYK && jpeg->jpeg_color_space != JCS_YCCK) {
    jpeg->out_color_space = JCS_RGB;
  }
  jpeg_calc_output_dimensions(jpeg);
  return true;
}

bool ReadJpegRows(jpeg_decompress_struct* jpeg, JpegErrors* errors, ColorImage* image) {
  if (setjmp(errors->place) != 0) return false;
  jpeg_start_decompress(jpeg);
  while (jpeg->output_scanline < jpeg->output_height) {
    JSAMPROW row = image->Pixel(0, static_cast<int>(jpeg->output_scanline));
    jpeg_read_scanlines(jpeg, &row, 1);
  }
  jpeg_finish_decompress(jpeg);
  return true;
}

/// Gives libjpeg's memory back.
struct JpegDecoder {
  JpegErrors errors{};
  jpeg_decompress_struct jpeg{};

  JpegDecoder() {
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = LeaveByJump;
    errors.manager.output_message = IgnoreMessage;
    jpeg_create_decompress(&jpeg);
  }
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg); }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
};

/// What libjpeg has written; its memory comes from malloc().
struct JpegEncoder {
  JpegErrors errors{};
  jpeg_compress_struct jpeg{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libjpeg's type

  JpegEncoder() {
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = LeaveByJump;
    errors.manager.output_message = IgnoreMessage;
    jpeg_create_compress(&jpeg);
  }
  ~JpegEncoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
};

bool WriteJpeg(JpegEncoder* encoder, const std::uint8_t* pixels, std::size_t row_bytes,
               int quality) {
  if (setjmp(encoder->errors.place) != 0) return false;
  jpeg_compress_struct& jpeg = encoder->jpeg;
  jpeg_mem_dest(&jpeg, &encoder->bytes, &encoder->size);
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    // libjpeg reads rows, and does not say so in its type.
    auto* row = const_cast<JSAMPROW>(pixels + jpeg.next_scanline * row_bytes);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

template <int kChannels>
std::string Encode(const Image<std::uint8_t, kChannels>& image, J_COLOR_SPACE colors, int quality) {
  const auto pixels =
      static_cast<std::uint64_t>(image.width_px) * static_cast<std::uint64_t>(image.height_px);
  if (pixels == 0 || pixels > kLargestJpeg_px) {
    throw RunError("no JPEG can be made of " + std::to_string(image.width_px) + " x " +
                   std::to_string(image.height_px) + " pixels");
  }
  JpegEncoder encoder;
  encoder.jpeg.image_width = static_cast<JDIMENSION>(image.width_px);
  encoder.jpeg.image_height = static_cast<JDIMENSION>(image.height_px);
  encoder.jpeg.input_components = kChannels;
  encoder.jpeg.in_color_space = colors;
  const std::size_t row_bytes = static_cast<std::size_t>(image.width_px) * kChannels;
  if (!WriteJpeg(&encoder, image.values.data(), row_bytes, quality)) {
    throw RunError(std::string("libjpeg: ") + encoder.errors.message.data());
  }
  return {reinterpret_cast<const char*>(encoder.bytes), encoder.size};
}

}  // namespace

ColorImage DecodeJpeg(std::string_view jpeg, const std::string& name) {
  const SourceLocation where{name};
  JpegDecoder decoder;
  const auto refuse_damaged = [&] {
    throw InputError(where,
                     std::string("is a damaged JPEG image: ") + decoder.errors.message.data());
  };
  if (!jpeg.starts_with("\xff\xd8\xff")) throw InputError(where, "is no JPEG image");
  if (!ReadJpegHeader(&decoder.jpeg, &decoder.errors, jpeg)) refuse_damaged();
  const std::uint64_t pixels =
      std::uint64_t{decoder.jpeg.output_width} * decoder.jpeg.output_height;
  if (pixels > kLargestJpeg_px) {
    throw InputError(where,
                     "has " + std::to_string(pixels) + " pixels; at most 64 million are read");
  }
  if (decoder.jpeg.out_color_space != JCS_RGB) {
    throw InputError(where, "has four colours (CMYK); take grey or RGB");
  }
  ColorImage image(static_cast<int>(decoder.jpeg.output_width),
                   static_cast<int>(decoder.jpeg.output_height));
  if (!ReadJpegRows(&decoder.jpeg, &decoder.errors, &image)) refuse_damaged();
  if (decoder.errors.manager.num_warnings > 0) {
    throw InputError(where, "is a damaged JPEG image: it is cut short, or holds other bytes");
  }
  return image;
}

std::string EncodeJpeg(const ColorImage& image, int quality) {
  return Encode(image, JCS_RGB, quality);
}

std::string EncodeJpeg(const GreyImage& image, int quality) {
  return Encode(image, JCS_GRAYSCALE, quality);
}

}  // namespace palpate::rgbd
