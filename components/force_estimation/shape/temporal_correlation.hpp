// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::force_estimation {

/// Correlation of a surface point's depth error with that of the next frame, as of stereo cameras;
/// DepthBias estimates it from contact-free frames.
inline constexpr double kFrameCorrelation = 0.3;
/// Variance of a mean over many frames times their number, over that of a single frame: (1 + r) /
/// (1 - r) of a first-order process (Bartlett, J. R. Stat. Soc. Suppl. 8 (1946) 27).
inline constexpr double kTemporalCorrelation =
    (1.0 + kFrameCorrelation) / (1.0 - kFrameCorrelation);

}  // namespace palpate::force_estimation
