// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace palpate::perception {

/// What colours the robot has and what colours everything else, as histograms of chromaticity and
/// brightness. Starts uninitialised.
class ColorModel {
 public:
  static constexpr int kChromaBins = 20;      ///< of R / (R + G + B), and of G / (R + G + B)
  static constexpr int kBrightnessBins = 11;  ///< half octaves of the strongest channel
  static constexpr int kBins = kChromaBins * kChromaBins * kBrightnessBins + 1;
  /// Too dark or too bright to have a colour.
  static constexpr std::uint16_t kNoColor = kBins - 1;
  /// No colour alone says more than this.
  static constexpr float kMostSaid = 2.5f;

  using Histogram = std::vector<float>;  ///< [kBins]

  std::uint16_t BinOf(const std::uint8_t* rgb) const {
    const unsigned index = (static_cast<unsigned>(rgb[0] >> 3) << 10) |
                           (static_cast<unsigned>(rgb[1] >> 3) << 5) |
                           static_cast<unsigned>(rgb[2] >> 3);
    return table_[index];
  }

  ColorModel();

  bool initialised() const { return initialised_; }
  void Forget();
  /// The robot is of the colour `rgb` [0, 1], more or less; everything else of any.
  void Assume(const std::array<double, 3>& rgb);
  /// Counts of one frame; `share` of it comes in, all of it while uninitialised.
  void Update(Histogram robot, Histogram other, double share);
  /// Similarity of the robot's colours to the model: 1 equal, 0 disjoint.
  double Similarity(Histogram robot) const;

  /// log(p(colour | robot) / p(colour | other)) in [-kMostSaid, kMostSaid]; 0: says nothing.
  float LogRatio(std::uint16_t bin) const { return log_ratio_[bin]; }

 private:
  void UpdateRatios();

  const std::uint16_t* table_;  ///< bins of all colours, 32 levels of each channel
  bool initialised_ = false;
  Histogram robot_;
  Histogram other_;
  std::vector<float> log_ratio_;
};

}  // namespace palpate::perception
