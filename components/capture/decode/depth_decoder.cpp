// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/decode/depth_decoder.hpp"

#include <cmath>
#include <cstring>
#include <string>

#include "libs/core/check.hpp"

namespace palpate::capture {

namespace {

constexpr double kUsualDepthUnit_m = 1e-4;
constexpr double kLeastDepthUnit_m = 1e-6;
constexpr double kGreatestDepthUnit_m = 0.01;

/// Coordinates of one pixel in the buffer: A, B, C (and Y), or C alone.
int ScalarsPerPixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kCoord3dAbc16:
    case PixelFormat::kCoord3dAbc32f: return 3;
    case PixelFormat::kCoord3dAbcy16: return 4;
    default: return 1;
  }
}

bool IsFloat(PixelFormat format) {
  return format == PixelFormat::kCoord3dC32f || format == PixelFormat::kCoord3dAbc32f;
}

}  // namespace

double ChooseDepthUnit(const Scan3dDescription& description, PixelFormat format,
                       const std::optional<double>& wanted_m) {
  if (wanted_m) return *wanted_m;
  const CoordinateRule& c = description.coordinates[2];
  const double step_m = c.scale * description.distance_unit_m;
  const bool exact = !IsFloat(format) && format != PixelFormat::kDisparity16 &&
                     description.mode != OutputMode::kDisparityC && c.offset == 0.0;
  return exact && step_m >= kLeastDepthUnit_m && step_m <= kGreatestDepthUnit_m ? step_m
                                                                                : kUsualDepthUnit_m;
}

DepthDecoder::DepthDecoder(const Scan3dDescription& description, double depth_unit_m)
    : description_(description), depth_unit_m_(depth_unit_m), steps_of_raw_(65536) {
  PALPATE_CHECK(depth_unit_m > 0.0 && std::isfinite(depth_unit_m), depth_unit_m);
  for (std::size_t raw = 0; raw < steps_of_raw_.size(); ++raw) {
    steps_of_raw_[raw] = Steps(static_cast<double>(raw));
  }
}

bool DepthDecoder::Invalid(std::size_t axis, double raw) const {
  const CoordinateRule& rule = description_.coordinates[axis];
  return std::isnan(raw) || (rule.marks_invalid && raw == rule.invalid_raw);
}

std::uint16_t DepthDecoder::Steps(double raw) const {
  if (Invalid(2, raw)) return 0;
  const CoordinateRule& rule = description_.coordinates[2];
  double z_m = raw * rule.scale + rule.offset;
  if (description_.mode == OutputMode::kDisparityC) {
    z_m = description_.camera.fx_px * description_.baseline_m / z_m;
  } else {
    z_m *= description_.distance_unit_m;
  }
  const double steps = std::round(z_m / depth_unit_m_);
  return steps >= 1.0 && steps <= 65535.0 ? static_cast<std::uint16_t>(steps) : std::uint16_t{0};
}

template <typename Scalar>
std::uint16_t DepthDecoder::PixelOf(const std::uint8_t* pixel, int scalars) const {
  std::array<Scalar, 4> raw;
  std::memcpy(raw.data(), pixel, sizeof(Scalar) * static_cast<std::size_t>(scalars));
  const std::size_t c = scalars == 1 ? 0 : 2;
  if (scalars > 1 &&
      (Invalid(0, static_cast<double>(raw[0])) || Invalid(1, static_cast<double>(raw[1])))) {
    return 0;
  }
  if constexpr (std::is_same_v<Scalar, std::uint16_t>) {
    return steps_of_raw_[raw[c]];
  } else {
    return Steps(static_cast<double>(raw[c]));
  }
}

template <typename Scalar>
void DepthDecoder::DecodeRows(const ImagePart& part, int scalars, std::size_t step,
                              rgbd::DepthImage* image, std::size_t* valid_pixels) const {
  const std::size_t pixel_bytes = BytesPerPixel(part.format);
  std::size_t valid = 0;
  for (int v = 0; v < part.height_px; ++v) {
    const std::uint8_t* pixel = part.data + step * static_cast<std::size_t>(v);
    std::uint16_t* target = image->Pixel(0, v);
    for (int u = 0; u < part.width_px; ++u, pixel += pixel_bytes) {
      target[u] = PixelOf<Scalar>(pixel, scalars);
      valid += target[u] != 0 ? 1 : 0;
    }
  }
  *valid_pixels = valid;
}

Status DepthDecoder::Decode(const ImagePart& part, rgbd::DepthImage* image,
                            std::size_t* valid_pixels) const {
  if (!CarriesDepth(part.format)) {
    return {StatusCode::kInvalidInput, std::string(NameOf(part.format)) + " carries no depth"};
  }
  const std::size_t step = RowStep(part);
  if (step == 0) return {StatusCode::kInvalidInput, "the depth image has fewer bytes than pixels"};
  image->width_px = part.width_px;
  image->height_px = part.height_px;
  image->values.resize(static_cast<std::size_t>(part.width_px) *
                       static_cast<std::size_t>(part.height_px));
  const int scalars = ScalarsPerPixel(part.format);
  if (IsFloat(part.format)) {
    DecodeRows<float>(part, scalars, step, image, valid_pixels);
  } else {
    DecodeRows<std::uint16_t>(part, scalars, step, image, valid_pixels);
  }
  return Status::Ok();
}

}  // namespace palpate::capture
