// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/capture/genicam/color_calibration.hpp"
#include "components/capture/genicam/features.hpp"
#include "components/capture/genicam/pixel_format.hpp"
#include "components/capture/genicam/scan3d_description.hpp"

namespace palpate::capture {

enum class DeviceRole {
  kDepthAndColor,  ///< everything comes from this device; colour may be missing
  kDepthOnly,
  kColorOnly,
};

/// Settings written to a device at the start. Unset: left as it is.
struct DeviceWishes {
  DeviceRole role = DeviceRole::kDepthAndColor;
  std::string depth_format;  ///< empty: the device's, or the first that is decoded
  std::string color_format;
  std::optional<double> exposure_s;
  std::optional<double> gain_dB;
  std::optional<double> frame_rate_Hz;
  std::optional<int> packet_delay_ns;
  std::string trigger_source;  ///< empty: free-running
  Scan3dOverrides scan3d;
};

struct ComponentFacts {
  std::string name;
  std::int64_t id = 0;
  bool enabled = false;
  std::string pixel_format;
};

/// What is known of a device after configuring.
struct DeviceSetup {
  Status status;  ///< not ok: what is missing, and the setting that fixes it
  Scan3dDescription scan3d;
  PixelFormat depth_format = PixelFormat::kUnknown;  ///< expected; kUnknown: no depth
  PixelFormatCodes codes;
  std::vector<ComponentFacts> components;  ///< those that there are; empty: one unnamed image
  rgbd::CameraModel color;                 ///< width 0: no colour; focal length 0: not reported
  ColorCalibration color_calibration;      ///< what the camera itself reports of it
  double period_s = 0.0;                   ///< 0: unknown
  double exposure_s;                       ///< NaN: not reported
  double gain_dB;
  std::vector<std::string> notes;
};

/// Configures a device that does not stream: components, pixel formats, multi-part, exposure, gain,
/// rate, trigger. Then reads what it is now, for whoever decodes its images. Wishes that the device
/// refuses end in a note, unless nothing can be decoded without them.
DeviceSetup ConfigureDevice(Features& features, const DeviceWishes& wishes);

/// Components with their ids and formats, without changing any. Leaves the first enabled one
/// selected.
std::vector<ComponentFacts> ListComponents(Features& features);

}  // namespace palpate::capture
