// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/convert_images.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "components/view/frames/binary_frame.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/camera_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "libs/rgbd/ros_compressed.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::view {

namespace {

using idl::sensor_msgs::CompressedImage;
using idl::sensor_msgs::Image;

/// Every so manieth pixel and row is sent.
std::uint32_t StrideFor(std::uint32_t width, const ImageConfig& config) {
  std::uint32_t stride = 1;
  while (width / stride > static_cast<std::uint32_t>(config.max_width_px)) stride *= 2;
  return stride;
}

/// The pixels of a smaller image: `set`(out column, out row, bytes of the pixel).
template <typename Set>
void ForEachPixel(const Image& message, std::uint32_t pixel_bytes, std::uint32_t stride,
                  const Set& set) {
  for (std::uint32_t v = 0; v < message.height / stride; ++v) {
    const std::uint8_t* row = message.data._buffer + std::size_t{v} * stride * message.step;
    for (std::uint32_t u = 0; u < message.width / stride; ++u) {
      set(static_cast<int>(u), static_cast<int>(v), row + std::size_t{u} * stride * pixel_bytes);
    }
  }
}

template <typename Target>
Target SmallerImage(const Image& message, std::uint32_t stride) {
  return {static_cast<int>(message.width / stride), static_cast<int>(message.height / stride)};
}

OutMessage JpegMessage(const std::string& kind, nlohmann::json fields, const Image& message,
                       const std::string& jpeg) {
  fields["stamp_ns"] = std::to_string(dds::StampNs(message.header.stamp));
  fields["width"] = message.width;
  fields["height"] = message.height;
  fields["encoding"] = "jpeg";
  BinaryFrame frame(kind, std::move(fields));
  frame.Add("data", std::span(reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()));
  return BinaryMessage(kind, frame.Bytes());
}

template <typename Pixels>
Status Encode(const Pixels& image, int quality, std::string* jpeg) {
  try {
    *jpeg = rgbd::EncodeJpeg(image, quality);
    return Status::Ok();
  } catch (const RunError& error) {
    return dds::Invalid(error.what());
  }
}

std::uint16_t DepthAt(const std::uint8_t* pixel) {
  std::uint16_t depth = 0;
  std::memcpy(&depth, pixel, sizeof(depth));
  return depth;
}

std::string_view DataOf(const CompressedImage& message) {
  return {reinterpret_cast<const char*>(message.data._buffer), message.data._length};
}

/// Depth in m is shown in steps of this, up to 6.5 m.
constexpr double kUnitOfMetres_m = 1e-4;

rgbd::DepthImage StepsOf(const rgbd::RosDepth& depth) {
  rgbd::DepthImage steps(depth.width_px, depth.height_px);
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  std::transform(depth.range_m.begin(), depth.range_m.end(), steps.values.begin(), [](float z_m) {
    const double step = std::round(double{z_m} / kUnitOfMetres_m);
    return step > 0.0 && step <= kMost ? static_cast<std::uint16_t>(step) : std::uint16_t{0};
  });
  return steps;
}

/// Depths between which nearly all pixels lie, in steps.
struct DepthSpan {
  double near = 0.0;
  double far = 1.0;
};

DepthSpan SpanOf(const Image& message, std::uint32_t stride) {
  std::vector<std::uint16_t> depths;
  ForEachPixel(message, sizeof(std::uint16_t), 4 * stride,
               [&](int, int, const std::uint8_t* pixel) {
                 if (const std::uint16_t depth = DepthAt(pixel); depth > 0) depths.push_back(depth);
               });
  if (depths.empty()) return {};
  const auto at = [&](double share) {
    const auto place = depths.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(depths.size() - 1));
    std::nth_element(depths.begin(), place, depths.end());
    return static_cast<double>(*place);
  };
  constexpr double kOutliers = 0.02;
  const double near = at(kOutliers);
  return {near, std::max(near + 1.0, at(1.0 - kOutliers))};
}

std::vector<float> PixelsOf(const rgbd::SensedCloud& cloud, const Eigen::Isometry3d& T_color_cloud,
                            const rgbd::CameraModel& color) {
  std::vector<float> pixels;
  pixels.reserve(2 * static_cast<std::size_t>(cloud.Count()));
  for (Eigen::Index i = 0; i < cloud.Count(); ++i) {
    const Eigen::Vector3d point_m = T_color_cloud * cloud.points_m.col(i).cast<double>();
    if (point_m.z() <= 0.0) continue;
    const Eigen::Vector2f at_px = rgbd::Project(color, point_m).cast<float>();
    const bool inside = at_px.x() >= -0.5F && at_px.y() >= -0.5F &&
                        at_px.x() < static_cast<float>(color.width_px) &&
                        at_px.y() < static_cast<float>(color.height_px);
    if (inside) pixels.insert(pixels.end(), {at_px.x(), at_px.y()});
  }
  return pixels;
}

}  // namespace

Status ColorImageMessage(const Image& message, const ImageConfig& config, OutMessage* out) {
  const std::string encoding(dds::Text(message.encoding));
  const rgbd::ColorLayout* layout = rgbd::ColorLayoutOf(encoding);
  if (layout == nullptr) return dds::Invalid("encoding '" + encoding + "' is not shown");
  if (Status size = dds::CheckImageSize(message, layout->pixel_bytes); !size.ok()) return size;
  const std::uint32_t stride = StrideFor(message.width, config);
  auto image = SmallerImage<rgbd::ColorImage>(message, stride);
  ForEachPixel(message, layout->pixel_bytes, stride, [&](int u, int v, const std::uint8_t* pixel) {
    std::uint8_t* target = image.Pixel(u, v);
    for (std::size_t c = 0; c < layout->rgb.size(); ++c) target[c] = pixel[layout->rgb[c]];
  });
  std::string jpeg;
  if (Status done = Encode(image, config.quality, &jpeg); !done.ok()) return done;
  *out = JpegMessage("color_image", {}, message, jpeg);
  return Status::Ok();
}

Status DepthImageMessage(const Image& message, double unit_m, const ImageConfig& config,
                         OutMessage* out) {
  const std::string encoding(dds::Text(message.encoding));
  if ((encoding != "16UC1" && encoding != "mono16") || message.is_bigendian != 0) {
    return dds::Invalid("encoding '" + encoding + "' is not shown");
  }
  if (Status size = dds::CheckImageSize(message, sizeof(std::uint16_t)); !size.ok()) return size;
  const std::uint32_t stride = StrideFor(message.width, config);
  const DepthSpan span = SpanOf(message, stride);
  auto image = SmallerImage<rgbd::GreyImage>(message, stride);
  constexpr double kDarkest = 40.0;  // of what has a depth
  constexpr double kLightest = 255.0;
  ForEachPixel(
      message, sizeof(std::uint16_t), stride, [&](int u, int v, const std::uint8_t* pixel) {
        const std::uint16_t depth = DepthAt(pixel);
        if (depth == 0) return;
        const double share = std::clamp((depth - span.near) / (span.far - span.near), 0.0, 1.0);
        *image.Pixel(u, v) = static_cast<std::uint8_t>(kLightest + share * (kDarkest - kLightest));
      });
  std::string jpeg;
  if (Status done = Encode(image, config.quality, &jpeg); !done.ok()) return done;
  *out = JpegMessage("depth_image", {{"near_m", span.near * unit_m}, {"far_m", span.far * unit_m}},
                     message, jpeg);
  return Status::Ok();
}

Status PackedColorMessage(const CompressedImage& message, const ImageConfig& config,
                          OutMessage* out) {
  rgbd::ColorImage image;
  const std::string cause = rgbd::DecodeCompressedColor(DataOf(message), &image);
  if (!cause.empty()) return dds::Invalid(cause);
  dds::ImageMessage unpacked("rgb8", 3);
  return ColorImageMessage(unpacked.Of(image, dds::StampNs(message.header.stamp), ""), config, out);
}

Status PackedDepthMessage(const CompressedImage& message, double unit_m, const ImageConfig& config,
                          OutMessage* out) {
  rgbd::RosDepth depth;
  const std::string cause =
      rgbd::DecodeCompressedDepth(dds::Text(message.format), DataOf(message), &depth);
  if (!cause.empty()) return dds::Invalid(cause);
  if (!depth.range_m.empty()) {
    unit_m = kUnitOfMetres_m;
    depth.steps = StepsOf(depth);
  }
  dds::ImageMessage unpacked("16UC1", sizeof(std::uint16_t));
  return DepthImageMessage(unpacked.Of(depth.steps, dds::StampNs(message.header.stamp), ""), unit_m,
                           config, out);
}

OutMessage SegmentationMessage(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                               const Eigen::Isometry3d& T_color_cloud,
                               const rgbd::CameraModel& color, std::int64_t stamp_ns) {
  BinaryFrame frame("segmentation", {{"stamp_ns", std::to_string(stamp_ns)},
                                     {"width", color.width_px},
                                     {"height", color.height_px}});
  frame.Add("robot_px", PixelsOf(robot, T_color_cloud, color));
  frame.Add("object_px", PixelsOf(object, T_color_cloud, color));
  return BinaryMessage("segmentation", frame.Bytes());
}

}  // namespace palpate::view
