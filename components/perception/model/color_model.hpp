// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace palpate::perception {

struct ColorModelTuning {
  /// Strongest channel below which, and weakest from which, a pixel has no colour, of 255. Wider
  /// bounds: more pixels count, with noisier chromaticity.
  int darkest = 12;
  int brightest = 250;
  /// Probability of an unseen bin, in both histograms: a bin that is in neither has no evidence.
  /// Larger: rare colours have less evidence.
  float unseen_probability = 3e-4f;
  double assumed_chroma_sigma = 0.05;  ///< of a given robot colour; larger: more tolerant
  /// Bound of |LogRatio|: no colour alone has more evidence. Larger: colour overrules depth.
  float largest_log_ratio = 2.5f;
};

/// Colours of the robot and of everything else, as histograms of chromaticity and brightness.
/// Starts uninitialised.
class ColorModel {
 public:
  static constexpr int kChromaBins = 20;      ///< of R / (R + G + B), and of G / (R + G + B)
  static constexpr int kBrightnessBins = 11;  ///< half octaves of the strongest channel
  static constexpr int kBins = kChromaBins * kChromaBins * kBrightnessBins + 1;
  /// Too dark or too bright to have a colour.
  static constexpr std::uint16_t kNoColor = kBins - 1;

  using Histogram = std::vector<float>;  ///< [kBins]

  std::uint16_t BinOf(const std::uint8_t* rgb) const {
    const unsigned index = (static_cast<unsigned>(rgb[0] >> 3) << 10) |
                           (static_cast<unsigned>(rgb[1] >> 3) << 5) |
                           static_cast<unsigned>(rgb[2] >> 3);
    return table_[index];
  }

  explicit ColorModel(const ColorModelTuning& tuning = {});

  bool initialised() const { return initialised_; }
  void Forget();
  /// Initialises: the robot has about the colour `rgb` [0, 1], everything else any.
  void Assume(const std::array<double, 3>& rgb);
  /// Counts of one frame, with the weight `share`; 1 while uninitialised.
  void Update(Histogram robot, Histogram other, double share);
  /// Similarity of the robot's colours to the model: 1 equal, 0 disjoint.
  double Similarity(Histogram robot) const;

  /// log(p(colour | robot) / p(colour | other)) within largest_log_ratio; 0: no evidence.
  float LogRatio(std::uint16_t bin) const { return log_ratio_[bin]; }

 private:
  void UpdateRatios();

  ColorModelTuning tuning_;
  std::vector<std::uint16_t> table_;  ///< bins of all colours, 32 levels of each channel
  bool initialised_ = false;
  Histogram robot_;
  Histogram other_;
  std::vector<float> log_ratio_;
};

}  // namespace palpate::perception
