// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/rare_colors.hpp"

#include <algorithm>
#include <numeric>

#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

constexpr int kBins = ColorModel::kChromaBins;

/// Sum of the group that contains `seed`; marks its bins with the number.
float NumberGroup(const std::vector<float>& counts, float least, int seed, int number,
                  std::vector<int>* group) {
  float sum = 0.0f;
  std::vector<int> open = {seed};
  (*group)[At(seed)] = number;
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    sum += counts[At(at)];
    for (int green = std::max(0, at / kBins - 1); green <= std::min(kBins - 1, at / kBins + 1);
         ++green) {
      for (int red = std::max(0, at % kBins - 1); red <= std::min(kBins - 1, at % kBins + 1);
           ++red) {
        const auto next = static_cast<std::size_t>(green * kBins + red);
        if ((*group)[next] >= 0 || counts[next] < least) continue;
        (*group)[next] = number;
        open.push_back(static_cast<int>(next));
      }
    }
  }
  return sum;
}

}  // namespace

RareColors::RareColors(const ColorModel::Histogram& counts, const RareColorsTuning& tuning) {
  std::vector<float> of_chromaticity(kChromaticities, 0.0f);
  for (std::size_t bin = 0; bin < ColorModel::kNoColor; ++bin) {
    of_chromaticity[bin % kChromaticities] += counts[bin];
  }
  const float least =
      std::max(1.0f, tuning.least_share *
                         std::accumulate(of_chromaticity.begin(), of_chromaticity.end(), 0.0f));
  std::vector<int> group(kChromaticities, -1);
  std::vector<float> sizes;
  for (int seed = 0; seed < kChromaticities; ++seed) {
    const auto at = static_cast<std::size_t>(seed);
    if (group[at] >= 0 || of_chromaticity[at] < least) continue;
    const int number = static_cast<int>(sizes.size());
    sizes.push_back(NumberGroup(of_chromaticity, least, seed, number, &group));
  }
  if (sizes.empty()) return;
  const float fewest = tuning.rare_share * *std::max_element(sizes.begin(), sizes.end());
  rare_.resize(kChromaticities);
  for (std::size_t at = 0; at < rare_.size(); ++at) {
    const bool common = group[at] >= 0 && sizes[At(group[at])] >= fewest;
    rare_[at] = common ? 0 : 1;
  }
}

}  // namespace palpate::perception
