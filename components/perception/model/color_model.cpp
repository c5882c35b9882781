// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/color_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::perception {

namespace {

constexpr int kLevels = 32;  // of a channel in the table

constexpr int kChroma = ColorModel::kChromaBins;
constexpr int kBrightness = ColorModel::kBrightnessBins;

int BinAt(int red, int green, int brightness) {
  return (brightness * kChroma + green) * kChroma + red;
}

std::uint16_t BinOfLevels(int red, int green, int blue, const ColorModelTuning& tuning) {
  const int strongest = std::max({red, green, blue});
  const int weakest = std::min({red, green, blue});
  if (strongest < tuning.darkest || weakest >= tuning.brightest) return ColorModel::kNoColor;
  const double sum = red + green + blue;
  const auto bin = [sum](int channel) {
    return std::min(kChroma - 1, static_cast<int>(kChroma * channel / sum));
  };
  const int octave_halves = static_cast<int>(2.0 * std::log2(strongest / 8.0));
  return static_cast<std::uint16_t>(
      BinAt(bin(red), bin(green), std::clamp(octave_halves, 0, kBrightness - 1)));
}

std::vector<std::uint16_t> MakeTable(const ColorModelTuning& tuning) {
  std::vector<std::uint16_t> table;
  table.reserve(kLevels * kLevels * kLevels);
  const auto value = [](int level) { return level * 8 + 4; };
  for (int red = 0; red < kLevels; ++red) {
    for (int green = 0; green < kLevels; ++green) {
      for (int blue = 0; blue < kLevels; ++blue) {
        table.push_back(BinOfLevels(value(red), value(green), value(blue), tuning));
      }
    }
  }
  return table;
}

/// Spreads counts over neighbouring bins, 1-2-1 along one axis.
void SpreadAlong(int stride, int length, ColorModel::Histogram* counts) {
  const ColorModel::Histogram old = *counts;
  const int bins = ColorModel::kBins - 1;
  for (int i = 0; i < bins; ++i) {
    const int place = i / stride % length;
    const auto at = static_cast<std::size_t>(i);
    const auto step = static_cast<std::size_t>(stride);
    const float before = place > 0 ? old[at - step] : old[at];
    const float after = place + 1 < length ? old[at + step] : old[at];
    (*counts)[at] = 0.25f * before + 0.5f * old[at] + 0.25f * after;
  }
}

/// Counts to probabilities, smoothed over neighbouring bins. False: all counts are zero.
bool Normalise(ColorModel::Histogram* counts) {
  (*counts)[ColorModel::kNoColor] = 0.0f;
  SpreadAlong(1, kChroma, counts);
  SpreadAlong(kChroma, kChroma, counts);
  SpreadAlong(kChroma * kChroma, kBrightness, counts);
  float sum = 0.0f;
  for (const float count : *counts) sum += count;
  if (sum <= 0.0f) return false;
  for (float& count : *counts) count /= sum;
  return true;
}

}  // namespace

ColorModel::ColorModel(const ColorModelTuning& tuning)
    : tuning_(tuning), table_(MakeTable(tuning)) {
  Forget();
}

void ColorModel::Forget() {
  initialised_ = false;
  robot_.assign(kBins, 0.0f);
  other_.assign(kBins, 0.0f);
  log_ratio_.assign(kBins, 0.0f);
}

void ColorModel::Assume(const std::array<double, 3>& rgb) {
  Forget();
  const double sum = std::max(1e-3, rgb[0] + rgb[1] + rgb[2]);
  const auto far = [this](int bin, double chroma) {
    const double off = ((bin + 0.5) / kChroma - chroma) / tuning_.assumed_chroma_sigma;
    return off * off;
  };
  for (int brightness = 0; brightness < kBrightness; ++brightness) {
    for (int green = 0; green < kChroma; ++green) {
      for (int red = 0; red < kChroma; ++red) {
        if (red + green > kChroma) continue;
        const auto at = static_cast<std::size_t>(BinAt(red, green, brightness));
        robot_[at] = static_cast<float>(
            std::exp(-0.5 * (far(red, rgb[0] / sum) + far(green, rgb[1] / sum))));
        other_[at] = 1.0f;
      }
    }
  }
  initialised_ = Normalise(&robot_) && Normalise(&other_);
  UpdateRatios();
}

void ColorModel::Update(Histogram robot, Histogram other, double share) {
  const auto mix = [this, share](Histogram* initialised, Histogram* counts) {
    if (!Normalise(counts)) return;
    const auto part = static_cast<float>(initialised_ ? share : 1.0);
    for (std::size_t i = 0; i < initialised->size(); ++i) {
      (*initialised)[i] += part * ((*counts)[i] - (*initialised)[i]);
    }
  };
  mix(&robot_, &robot);
  mix(&other_, &other);
  initialised_ = true;
  UpdateRatios();
}

double ColorModel::Similarity(Histogram robot) const {
  if (!Normalise(&robot)) return 1.0;
  double likeness = 0.0;  // Bhattacharyya's coefficient
  for (std::size_t i = 0; i < robot.size(); ++i) {
    likeness += static_cast<double>(std::sqrt(robot[i] * robot_[i]));
  }
  return likeness;
}

void ColorModel::UpdateRatios() {
  for (std::size_t i = 0; i + 1 < log_ratio_.size(); ++i) {
    const float ratio = std::log((robot_[i] + tuning_.unseen_probability) /
                                 (other_[i] + tuning_.unseen_probability));
    log_ratio_[i] = std::clamp(ratio, -tuning_.largest_log_ratio, tuning_.largest_log_ratio);
  }
  log_ratio_[kNoColor] = 0.0f;
}

}  // namespace palpate::perception
