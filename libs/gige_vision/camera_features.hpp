// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/gige_vision/device.hpp"
#include "libs/gige_vision/feature.hpp"
#include "libs/gige_vision/protocol.hpp"

namespace palpate::gige_vision {

/// The images that this camera takes, in the order of ComponentSelector's entries and of the
/// parts in a frame.
std::vector<ComponentId> Components(const DeviceSettings& settings, const rgbd::RgbdCamera& camera);

/// The features of a 3-D camera: DeviceControl, ImageFormatControl, Scan3dControl,
/// AcquisitionControl, and what SFNC has no name for (PalpateCalibration).
FeatureTable CameraFeatures(const DeviceSettings& settings, const rgbd::RgbdCamera& camera);

/// TransportLayerControl: mostly views of bootstrap registers.
FeatureTable TransportFeatures();

}  // namespace palpate::gige_vision
