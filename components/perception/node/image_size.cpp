// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/image_size.hpp"

#include <string>

namespace palpate::perception {

namespace {

template <typename Image>
Status CheckSize(const std::string& what, const Image& image, const rgbd::CameraModel& camera) {
  if (image.width_px == camera.width_px && image.height_px == camera.height_px) return Status::Ok();
  return {StatusCode::kInvalidInput,
          "a " + what + " image of " + std::to_string(image.width_px) + " x " +
              std::to_string(image.height_px) + " pixels from a camera of " +
              std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px)};
}

}  // namespace

Status CheckDepthSize(const rgbd::DepthImage& image, const rgbd::CameraModel& camera) {
  return CheckSize("depth", image, camera);
}

Status CheckColorSize(const rgbd::ColorImage& image, const rgbd::CameraModel& camera) {
  return CheckSize("colour", image, camera);
}

}  // namespace palpate::perception
