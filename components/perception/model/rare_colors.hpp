// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "components/perception/model/color_model.hpp"

namespace palpate::perception {

struct RareColorsTuning {
  /// Share of all pixels of a chromaticity in a group: between two groups are those of pixels on
  /// the border of their surfaces. Larger: groups separate more; smaller: they merge.
  float least_share = 0.005f;
  /// Share of the largest group below which a group is rare. Larger: a second colour of the robot
  /// is foreign.
  float rare_share = 0.25f;
};

/// The colours that few of some pixels have. Colours of neighbouring chromaticities make a group;
/// rare are those that are in no group, or in one much smaller than the largest.
class RareColors {
 public:
  /// None are rare.
  RareColors() = default;
  /// `counts`: pixels of each bin of ColorModel.
  explicit RareColors(const ColorModel::Histogram& counts, const RareColorsTuning& tuning = {});

  bool Hold(std::uint16_t bin) const {
    return bin != ColorModel::kNoColor && !rare_.empty() && rare_[bin % kChromaticities] != 0;
  }

 private:
  static constexpr int kChromaticities = ColorModel::kChromaBins * ColorModel::kChromaBins;

  std::vector<char> rare_;  ///< [kChromaticities]
};

}  // namespace palpate::perception
