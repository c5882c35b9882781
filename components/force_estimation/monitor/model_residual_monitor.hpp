// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/monitor/model_gap.hpp"

namespace palpate::force_estimation {

/// What a sequence says of the model so far.
struct GapReport {
  enum class State {
    kLearning,  ///< how large the gap is at the start is not known yet
    kHolds,     ///< as large as at the start, as far as chance goes
    kGrown,     ///< larger, or far beyond the noise from the start
    kNotSeen,   ///< too few frames lately from which anything was estimated
  };
  State state = State::kLearning;
  double residual_rms_m = 0.0;  ///< per coordinate, of the last second
  double noise_rms_m = 0.0;
  /// For a person, where the state is kGrown: by how much, where, what it looks like, and what to
  /// do.
  std::string advice;
};

std::string ToString(GapReport::State state);

/// As /diagnostics says it.
void AppendGap(const GapReport& report, std::vector<std::pair<std::string, std::string>>* values);

/// Watches whether the model gap of a sequence grows: mean squares of seconds, over the noise,
/// three of them together against what a bootstrap draws from the first ten. Where it grew, the
/// part of the robot that holds most of the growth and how fast it came tell which family of causes
/// is likely; which cause, only a diagnosis can.
class ModelResidualMonitor {
 public:
  /// `t_s` of the frames' clock; a time before the last one begins anew.
  void Add(double t_s, const ModelGapReport& gap);
  const GapReport& report() const { return report_; }

 private:
  /// Sums of squares, and of what noise makes of them.
  struct Part {
    std::string name;
    int points = 0;
    double squares_m2 = 0.0;
    double variances_m2 = 0.0;

    double Ratio() const { return squares_m2 / variances_m2; }
  };
  /// Of the frames of one second.
  struct Second {
    double begin_s = 0.0;
    int frames = 0;
    int seen = 0;
    Part whole;
    std::vector<Part> regions;
    std::vector<Part> cables;
  };

  static void AddPart(const ModelGapPart& one, Part* sum);
  static void AddParts(const std::vector<ModelGapPart>& some, std::vector<Part>* sums);
  static double MeanRatio(const std::deque<Second>& seconds);
  void Close();
  void Learn();
  void Judge();
  std::string Advice() const;
  std::string LikelyFamily() const;
  const Part* PartThatGrew(std::vector<Part> Second::*parts) const;
  bool CameSlowly() const;

  double last_s_ = 0.0;
  Second second_;
  std::deque<Second> reference_;
  std::deque<Second> latest_;
  std::vector<double> ratios_;  ///< of all seconds since the reference
  double usual_ = 0.0;          ///< ratio of the reference
  double threshold_ = 0.0;      ///< of MeanRatio()
  int in_a_row_ = 0;            ///< seconds that speak against what is said
  GapReport report_;
};

}  // namespace palpate::force_estimation
