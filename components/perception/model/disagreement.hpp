// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "components/perception/config.hpp"
#include "components/perception/model/prediction_view.hpp"
#include "components/perception/observation.hpp"
#include "components/perception/registered_frame.hpp"

namespace palpate::perception {

/// Pixels with depth in range where the robot is predicted.
struct PixelCounts {
  std::int64_t agree = 0;
  std::int64_t seen = 0;    ///< agree, or are not hidden
  std::int64_t hidden = 0;  ///< something is much nearer there
};

/// Measured over predicted depth, median of the pixels where the robot is predicted, whatever their
/// range; NaN: none has a depth.
double MedianDepthRatio(const rgbd::RgbdFrame& frame, const Registration& registration,
                        const PredictionView& prediction);

/// Why a frame does not show the predicted robot: the value, the rule, what may be wrong. `ratio`
/// is MedianDepthRatio.
std::string Disagreement(const PixelCounts& pixels, double ratio, const Config& config);

/// Of an image without any depth in range; `ratio` NaN where no robot is predicted.
std::string NothingInRange(const Rejections& rejected, double ratio, const Config& config);

}  // namespace palpate::perception
