// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "components/perception/registered_frame.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

constexpr int kNowhere = -1;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar_m = std::numeric_limits<float>::max();

std::string SizeText(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

template <typename Image>
Status CheckSize(const std::string& name, const Image& image, const rgbd::CameraModel& camera) {
  if (image.empty()) return Status(StatusCode::kInvalidInput, "the " + name + " image is empty");
  const bool fits = image.width_px == camera.width_px && image.height_px == camera.height_px;
  if (fits) return Status::Ok();
  return Status(StatusCode::kInvalidInput,
                "the " + name + " image has " + SizeText(image.width_px, image.height_px) +
                    " pixels, the camera " + SizeText(camera.width_px, camera.height_px));
}

std::size_t PixelCount(const rgbd::CameraModel& camera) {
  return static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
}

/// rgbd::Project's lens in single precision, for a whole row: x and y of the normalised image.
struct Lens {
  explicit Lens(const rgbd::CameraModel& camera) {
    for (std::size_t i = 0; i < k.size(); ++i) k[i] = static_cast<float>(camera.distortion[i]);
  }
  /// Without a denominator it is 1 to the last bit.
  void Bend(float* x, float* y) const {
    const float a = *x, b = *y;
    const float s = a * a + b * b;
    const float radial =
        (1.0f + s * (k[0] + s * (k[1] + s * k[4]))) / (1.0f + s * (k[5] + s * (k[6] + s * k[7])));
    *x = a * radial + 2.0f * k[2] * a * b + k[3] * (s + 2.0f * a * a);
    *y = b * radial + k[2] * (s + 2.0f * b * b) + 2.0f * k[3] * a * b;
  }
  std::array<float, std::tuple_size_v<rgbd::Distortion>> k;
};

/// Depth in metres of a step of the depth image; NaN where it is none.
class StepLaw {
 public:
  explicit StepLaw(const rgbd::RgbdCamera& camera)
      : unit_m_(static_cast<float>(camera.depth_unit_m)),
        invalid_m_(static_cast<float>(camera.invalid_value) * unit_m_) {}

  float Z_m(std::uint16_t step) const {
    const float here_m = static_cast<float>(step) * unit_m_;
    const float valid_m = here_m == invalid_m_ ? kNan : here_m;
    return valid_m > 0.0f ? valid_m : kNan;
  }

 private:
  float unit_m_;
  float invalid_m_;
};

}  // namespace

Registration::Registration(const rgbd::RgbdCamera& camera, const RegistrationTuning& tuning)
    : camera_(camera), tuning_(tuning) {
  const rgbd::CameraModel& depth = camera.depth;
  rays_.resize(3, ToIndex(PixelCount(depth)));
  for (int v = 0; v < depth.height_px; ++v) {
    for (int u = 0; u < depth.width_px; ++u) {
      rays_.col(ToIndex(v) * depth.width_px + u) =
          rgbd::Unproject(depth, Eigen::Vector2d(u, v)).cast<float>();
    }
  }
  for (Eigen::Index i = 0; i < rays_.cols(); ++i) {
    if (!rays_.col(i).allFinite()) blind_.push_back(static_cast<std::size_t>(i));
  }
  if (camera.color.width_px > 0 && !camera.color_registered) LayColorRays();
}

void Registration::LayColorRays() {
  T_color_depth_ = camera_.T_depth_color.inverse();
  color_rays_ = (T_color_depth_.linear().cast<float>() * rays_).transpose().array();
  const double step_px = std::max(camera_.color.fx_px / camera_.depth.fx_px,
                                  camera_.color.fy_px / camera_.depth.fy_px);
  cell_px_ = std::max(1, static_cast<int>(std::ceil(tuning_.cell_steps * step_px)));
  cell_columns_ = (camera_.color.width_px + cell_px_ - 1) / cell_px_;
  const int cell_rows = (camera_.color.height_px + cell_px_ - 1) / cell_px_;
  nearest_z_m_.resize(static_cast<std::size_t>(cell_columns_) *
                      static_cast<std::size_t>(cell_rows));
  const std::size_t pixels = PixelCount(camera_.depth);
  color_pixel_.resize(pixels);
  cell_.resize(pixels);
  color_z_m_.resize(pixels);
}

Status Registration::Register(const rgbd::RgbdFrame& frame, RegisteredFrame* registered) {
  Status status = RegisterDepth(frame, registered);
  if (!status.ok()) return status;
  const Window all{.u_end = camera_.depth.width_px, .v_end = camera_.depth.height_px};
  RegisterColor(frame, all, registered);
  return status;
}

Status Registration::RegisterDepth(const rgbd::RgbdFrame& frame,
                                   RegisteredFrame* registered) const {
  const rgbd::CameraModel& depth = camera_.depth;
  Status status = CheckSize("depth", frame.depth, depth);
  if (!status.ok()) return status;
  if (camera_.color.width_px > 0) {
    status = CheckSize("color", frame.color, camera_.color_registered ? depth : camera_.color);
    if (!status.ok()) return status;
  }
  const std::size_t pixels = PixelCount(depth);
  if (registered->z_m.values.size() != pixels) {
    registered->z_m = rgbd::RangeImage(depth.width_px, depth.height_px);
    registered->color = rgbd::ColorImage(depth.width_px, depth.height_px);
    registered->color_known.assign(pixels, 0);
  }
  const StepLaw law(camera_);
  const std::uint16_t* steps = frame.depth.values.data();
  float* z_m = registered->z_m.values.data();
  for (std::size_t i = 0; i < pixels; ++i) z_m[i] = law.Z_m(steps[i]);
  for (const std::size_t pixel : blind_) z_m[pixel] = kNan;
  return status;
}

float Registration::Depth_m(const rgbd::RgbdFrame& frame, int u_px, int v_px) const {
  return Ray(u_px, v_px).allFinite() ? StepLaw(camera_).Z_m(*frame.depth.Pixel(u_px, v_px)) : kNan;
}

void Registration::RegisterColor(const rgbd::RgbdFrame& frame, const Window& window,
                                 RegisteredFrame* registered) {
  if (camera_.color.width_px > 0 && !camera_.color_registered) {
    MapColor(frame.color, window, registered);
    return;
  }
  const char known = camera_.color.width_px > 0 ? 1 : 0;
  const auto values = 3 * static_cast<std::size_t>(window.u_end - window.u_begin);
  for (int v = window.v_begin; v < window.v_end; ++v) {
    std::uint8_t* to = registered->color.Pixel(window.u_begin, v);
    if (known != 0) {
      std::copy_n(frame.color.Pixel(window.u_begin, v), values, to);
    } else {
      std::fill_n(to, values, std::uint8_t{0});
    }
    const auto first = ToIndex(v) * camera_.depth.width_px;
    std::fill(registered->color_known.begin() + first + window.u_begin,
              registered->color_known.begin() + first + window.u_end, known);
  }
}

void Registration::MapColor(const rgbd::ColorImage& color, const Window& window,
                            RegisteredFrame* registered) {
  std::fill(nearest_z_m_.begin(), nearest_z_m_.end(), kFar_m);
  const Window wide{.u_begin = std::max(0, window.u_begin - tuning_.reach_px),
                    .v_begin = std::max(0, window.v_begin - tuning_.reach_px),
                    .u_end = std::min(camera_.depth.width_px, window.u_end + tuning_.reach_px),
                    .v_end = std::min(camera_.depth.height_px, window.v_end + tuning_.reach_px)};
  for (int v = wide.v_begin; v < wide.v_end; ++v) {
    const float* z_m = registered->z_m.Pixel(0, v);
    if (camera_.color.distorted()) {
      ProjectRow<true>(v, wide, z_m);
    } else {
      ProjectRow<false>(v, wide, z_m);
    }
    Splat(v, wide);
  }
  for (int v = window.v_begin; v < window.v_end; ++v) TakeColors(color, v, window, registered);
}

/// Position of each pixel of a row in the colour image.
template <bool kDistorted>
void Registration::ProjectRow(int v, const Window& window, const float* z_m) {
  const rgbd::CameraModel& color = camera_.color;
  const Eigen::Index first = ToIndex(v) * camera_.depth.width_px;
  const Eigen::Vector3f t = T_color_depth_.translation().cast<float>();
  const float* __restrict ray_x = color_rays_.col(0).data() + first;
  const float* __restrict ray_y = color_rays_.col(1).data() + first;
  const float* __restrict ray_z = color_rays_.col(2).data() + first;
  const auto fx = static_cast<float>(color.fx_px), fy = static_cast<float>(color.fy_px);
  const auto cx = static_cast<float>(color.cx_px) + 0.5f;
  const auto cy = static_cast<float>(color.cy_px) + 0.5f;
  const float u_last = std::nextafter(static_cast<float>(color.width_px), 0.0f);
  const float v_last = std::nextafter(static_cast<float>(color.height_px), 0.0f);
  const float cells_px = 1.0f / static_cast<float>(cell_px_);
  const int width_px = color.width_px, cell_columns = cell_columns_;
  const Lens lens(color);
  int* __restrict pixel = color_pixel_.data() + first;
  int* __restrict cell = cell_.data() + first;
  float* __restrict color_z_m = color_z_m_.data() + first;
  const int u_begin = window.u_begin, u_end = window.u_end;
  for (int u = u_begin; u < u_end; ++u) {
    const float depth_z_m = z_m[u];
    const float z = depth_z_m * ray_z[u] + t.z();
    const float inverse = 1.0f / z;
    float x = (depth_z_m * ray_x[u] + t.x()) * inverse;
    float y = (depth_z_m * ray_y[u] + t.y()) * inverse;
    if constexpr (kDistorted) lens.Bend(&x, &y);
    const float u_color = fx * x + cx;
    const float v_color = fy * y + cy;
    // Distance outside the image; NaN without depth. Without branches, so that the compiler
    // vectorises the loop.
    const float u_inside = std::min(std::max(0.0f, u_color), u_last);
    const float v_inside = std::min(std::max(0.0f, v_color), v_last);
    const float missed =
        std::abs(u_inside - u_color) + std::abs(v_inside - v_color) + std::max(0.0f, -z);
    const int at = static_cast<int>(v_inside) * width_px + static_cast<int>(u_inside);
    pixel[u] = missed == 0.0f ? at : kNowhere;
    cell[u] = static_cast<int>(v_inside * cells_px) * cell_columns +
              static_cast<int>(u_inside * cells_px);
    color_z_m[u] = missed == 0.0f ? z : kFar_m;
  }
}

void Registration::Splat(int v, const Window& window) {
  const std::size_t first =
      static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.depth.width_px);
  for (auto u = static_cast<std::size_t>(window.u_begin);
       u < static_cast<std::size_t>(window.u_end); ++u) {
    float& nearest_m = nearest_z_m_[At(cell_[first + u])];
    nearest_m = std::min(nearest_m, color_z_m_[first + u]);
  }
}

void Registration::TakeColors(const rgbd::ColorImage& color, int v, const Window& window,
                              RegisteredFrame* registered) const {
  const auto first = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.depth.width_px);
  const auto parallax_m_px =
      static_cast<float>(camera_.color.fx_px * camera_.T_depth_color.translation().norm());
  const float occluded_px = tuning_.occluded_parallax_px;
  for (auto i = first + static_cast<std::size_t>(window.u_begin);
       i < first + static_cast<std::size_t>(window.u_end); ++i) {
    std::uint8_t* rgb = registered->color.values.data() + 3 * i;
    const int pixel = color_pixel_[i];
    const float z_m = color_z_m_[i];
    const float in_front_m = z_m - nearest_z_m_[At(cell_[i])];
    const bool known = pixel != kNowhere && in_front_m * parallax_m_px <= occluded_px * z_m * z_m;
    const std::uint8_t* from =
        color.values.data() + 3 * static_cast<std::size_t>(known ? pixel : 0);
    for (int k = 0; k < 3; ++k) rgb[k] = known ? from[k] : std::uint8_t{0};
    registered->color_known[i] = known ? 1 : 0;
  }
}

}  // namespace palpate::perception
