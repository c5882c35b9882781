// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/status.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/image.hpp"

namespace palpate::perception {

/// kInvalidInput, with both sizes, for an image of another size than its camera's.
Status CheckDepthSize(const rgbd::DepthImage& image, const rgbd::CameraModel& camera);
Status CheckColorSize(const rgbd::ColorImage& image, const rgbd::CameraModel& camera);

}  // namespace palpate::perception
