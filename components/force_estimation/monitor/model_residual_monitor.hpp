// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/monitor/model_gap.hpp"

namespace palpate::force_estimation {

/// Result of the test for a sequence so far.
struct GapReport {
  enum class State {
    kLearning,  ///< the reference from the start of the sequence is not complete
    kHolds,     ///< the residual is that of the reference, up to chance
    kGrown,     ///< larger, or far beyond the noise from the start
    kNotSeen,   ///< too few frames with an estimate lately
  };
  State state = State::kLearning;
  double residual_rms_m = 0.0;  ///< per coordinate, of the last second
  double noise_rms_m = 0.0;
  /// For the user, where the state is kGrown: by how much, where, the likely family of causes, and
  /// what to do.
  std::string advice;
};

std::string ToString(GapReport::State state);

/// As key-value pairs of /diagnostics.
void AppendGap(const GapReport& report, std::vector<std::pair<std::string, std::string>>* values);

struct ModelResidualMonitorTuning {
  double window_s = 1.0;  ///< whose frames are averaged; longer: less noise, later alarms
  int least_frames = 3;   ///< of a window that is evaluated; fewer: noisier windows
  /// Windows of the reference. More: a more exact threshold, a later start.
  std::size_t reference_windows = 10;
  std::size_t windows_together = 3;  ///< tested by their mean; more: less noise, later alarms
  int windows_in_a_row = 2;          ///< until the state changes; more: later alarms, fewer false
  int draws = 2000;                  ///< of the bootstrap; more: a more exact threshold, slower
  double false_alarms = 1e-3;        ///< probability of a mean beyond the threshold by chance
  /// Growth over the reference that the motion of a robot may cause: its mesh errs elsewhere.
  /// Smaller: alarms from motion alone.
  double least_growth = 1.5;
  /// Mean square residual over the noise from which the model is wrong from the start. Larger: a
  /// worse calibration passes.
  double wrong_ratio = 9.0;
  /// Share of the growth that names one part. Smaller: parts are named on weaker evidence.
  double most_of_growth = 0.7;
  double slow_s = 10.0;  ///< duration of a growth that counts as slow
};

/// Tests whether the residual of a sequence grows: mean squares of windows, over the noise, some of
/// them together against a bootstrap of the first ones. The part of the robot with most of the
/// growth and its duration give the likely family of causes; the cause itself needs a diagnosis.
class ModelResidualMonitor {
 public:
  explicit ModelResidualMonitor(const ModelResidualMonitorTuning& tuning = {}) : tuning_(tuning) {}

  /// `t_s` of the frames' clock; a time before the last one resets the monitor.
  void Add(double t_s, const ModelGapReport& gap);
  const GapReport& report() const { return report_; }

 private:
  /// Sums of squares, and their expectation from noise.
  struct Part {
    std::string name;
    int points = 0;
    double squares_m2 = 0.0;
    double variances_m2 = 0.0;

    double Ratio() const { return squares_m2 / variances_m2; }
  };
  /// Of the frames of one window.
  struct Window {
    double begin_s = 0.0;
    int frames = 0;
    int seen = 0;
    Part whole;
    std::vector<Part> regions;
    std::vector<Part> cables;
  };

  static void AddPart(const ModelGapPart& one, Part* sum);
  static void AddParts(const std::vector<ModelGapPart>& some, std::vector<Part>* sums);
  static double MeanRatio(const std::deque<Window>& windows);
  void Close();
  void SetReference();
  void Judge();
  std::string Advice() const;
  std::string LikelyFamily() const;
  const Part* PartThatGrew(std::vector<Part> Window::*parts) const;
  bool CameSlowly() const;

  ModelResidualMonitorTuning tuning_;
  double last_s_ = 0.0;
  Window window_;
  std::deque<Window> reference_;
  std::deque<Window> latest_;
  std::vector<double> ratios_;  ///< of all windows since the reference
  double usual_ = 0.0;          ///< ratio of the reference
  double threshold_ = 0.0;      ///< of MeanRatio()
  int in_a_row_ = 0;            ///< windows that contradict the state
  GapReport report_;
};

}  // namespace palpate::force_estimation
