// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/model_residual_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

using GapState = GapReport::State;

/// Quantile of the mean of some windows by the reference: bootstrap, smoothed by its own scatter,
/// as few windows do not contain the rare ones.
double BootstrapThreshold(const std::vector<double>& ratios,
                          const ModelResidualMonitorTuning& tuning) {
  double mean = 0.0;
  double square = 0.0;
  for (const double ratio : ratios) mean += ratio / static_cast<double>(ratios.size());
  for (const double ratio : ratios) square += (ratio - mean) * (ratio - mean);
  const double scatter = std::sqrt(square / static_cast<double>(ratios.size() - 1));
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, ratios.size() - 1);
  std::normal_distribution<double> normal(0.0, scatter);
  std::vector<double> means;
  for (int d = 0; d < tuning.draws; ++d) {
    double sum = 0.0;
    for (std::size_t k = 0; k < tuning.windows_together; ++k) {
      sum += ratios[pick(random)] + normal(random);
    }
    means.push_back(sum / static_cast<double>(tuning.windows_together));
  }
  std::sort(means.begin(), means.end());
  return means[static_cast<std::size_t>((1.0 - tuning.false_alarms) * (tuning.draws - 1))];
}

std::string InMillimetres(double length_m) {
  return FormatNumber(std::round(1e5 * length_m) / 1e2) + " mm";
}

}  // namespace

std::string ToString(GapState state) {
  switch (state) {
    case GapState::kLearning: return "learning";
    case GapState::kHolds: return "holds";
    case GapState::kGrown: return "grown";
    case GapState::kNotSeen: return "not_seen";
  }
  return {};
}

void AppendGap(const GapReport& report, std::vector<std::pair<std::string, std::string>>* values) {
  values->emplace_back("model_gap", ToString(report.state));
  values->emplace_back("model_gap_rms_m", FormatNumber(report.residual_rms_m));
  values->emplace_back("model_gap_noise_m", FormatNumber(report.noise_rms_m));
  values->emplace_back("model_gap_advice", report.advice);
}

void ModelResidualMonitor::AddPart(const ModelGapPart& one, Part* sum) {
  sum->points += one.sample_count;
  sum->squares_m2 += one.sample_count * one.residual_rms_m * one.residual_rms_m;
  sum->variances_m2 += one.sample_count * one.noise_rms_m * one.noise_rms_m;
}

void ModelResidualMonitor::AddParts(const std::vector<ModelGapPart>& some,
                                    std::vector<Part>* sums) {
  sums->resize(some.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    (*sums)[k].name = some[k].name;
    AddPart(some[k], &(*sums)[k]);
  }
}

void ModelResidualMonitor::Add(double t_s, const ModelGapReport& gap) {
  if (t_s < last_s_) *this = ModelResidualMonitor(tuning_);
  last_s_ = t_s;
  if (window_.frames == 0) window_.begin_s = t_s;
  if (t_s - window_.begin_s >= tuning_.window_s) {
    Close();
    window_ = {};
    window_.begin_s = t_s;
  }
  ++window_.frames;
  const bool known = gap.whole.sample_count > 0 && std::isfinite(gap.whole.residual_rms_m) &&
                     gap.whole.noise_rms_m > 0.0;
  if (!known) return;
  ++window_.seen;
  AddPart(gap.whole, &window_.whole);
  AddParts(gap.regions, &window_.regions);
  AddParts(gap.cables, &window_.cables);
}

double ModelResidualMonitor::MeanRatio(const std::deque<Window>& windows) {
  double sum = 0.0;
  for (const Window& one : windows) sum += one.whole.Ratio();
  return sum / static_cast<double>(windows.size());
}

void ModelResidualMonitor::Close() {
  if (window_.seen < tuning_.least_frames) {
    if (report_.state == GapState::kHolds) report_.state = GapState::kNotSeen;
    return;
  }
  report_.residual_rms_m = std::sqrt(window_.whole.squares_m2 / window_.whole.points);
  report_.noise_rms_m = std::sqrt(window_.whole.variances_m2 / window_.whole.points);
  if (reference_.size() < tuning_.reference_windows) {
    reference_.push_back(window_);
    if (reference_.size() == tuning_.reference_windows) SetReference();
    return;
  }
  ratios_.push_back(window_.whole.Ratio());
  latest_.push_back(window_);
  if (latest_.size() > tuning_.windows_together) latest_.pop_front();
  if (latest_.size() == tuning_.windows_together) Judge();
}

void ModelResidualMonitor::SetReference() {
  std::vector<double> ratios;
  for (const Window& one : reference_) ratios.push_back(one.whole.Ratio());
  usual_ = MeanRatio(reference_);
  threshold_ =
      std::max(BootstrapThreshold(ratios, tuning_), tuning_.least_growth * std::max(1.0, usual_));
  report_.state = GapState::kHolds;
  if (usual_ < tuning_.wrong_ratio) return;
  report_.state = GapState::kGrown;
  report_.advice = "what the model leaves unexplained is " + InMillimetres(report_.residual_rms_m) +
                   " from the start (noise " + InMillimetres(report_.noise_rms_m) +
                   "): calibrate, or record and run palpate diagnose on the recording";
}

void ModelResidualMonitor::Judge() {
  const bool grown = MeanRatio(latest_) > threshold_ || usual_ >= tuning_.wrong_ratio;
  if (report_.state == GapState::kNotSeen) report_.state = GapState::kHolds;
  const bool said = report_.state == GapState::kGrown;
  in_a_row_ = grown == said ? 0 : in_a_row_ + 1;
  if (grown && usual_ < tuning_.wrong_ratio && (said || in_a_row_ >= tuning_.windows_in_a_row))
    report_.advice = Advice();
  if (in_a_row_ < tuning_.windows_in_a_row) return;
  in_a_row_ = 0;
  report_.state = grown ? GapState::kGrown : GapState::kHolds;
  if (!grown) report_.advice.clear();
}

std::string ModelResidualMonitor::Advice() const {
  const double before_m = report_.noise_rms_m * std::sqrt(usual_);
  return "what the model leaves unexplained has grown from " + InMillimetres(before_m) + " to " +
         InMillimetres(report_.residual_rms_m) + " (noise " + InMillimetres(report_.noise_rms_m) +
         "); likely " + LikelyFamily() +
         ": record what the robot does and run palpate diagnose on the recording";
}

std::string ModelResidualMonitor::LikelyFamily() const {
  if (const Part* cable = PartThatGrew(&Window::cables)) {
    return "cable " + cable->name + " or its actuator";
  }
  const Part* region = PartThatGrew(&Window::regions);
  if (region != nullptr && region->name != "body") {
    return "the material of " + region->name + ", or what touches it";
  }
  return CameSlowly() ? "something slow (creep, temperature, a camera that gets warm)"
                      : "something sudden (the camera, the base, a load)";
}

/// The one with most of the growth, unless all points are its own; nullptr: none.
const ModelResidualMonitor::Part* ModelResidualMonitor::PartThatGrew(
    std::vector<Part> Window::*parts) const {
  const std::vector<Part>& now = latest_.back().*parts;
  const double growth_m2 =
      latest_.back().whole.squares_m2 - usual_ * latest_.back().whole.variances_m2;
  for (const Part& one : now) {
    const bool alone = one.points == latest_.back().whole.points;
    if (!alone && one.squares_m2 - usual_ * one.variances_m2 > tuning_.most_of_growth * growth_m2)
      return &one;
  }
  return nullptr;
}

/// Whether the growth from a quarter to three quarters of its present value took long.
bool ModelResidualMonitor::CameSlowly() const {
  const double growth = MeanRatio(latest_) - usual_;
  const auto last_below = [&](double share) {
    for (std::size_t k = ratios_.size(); k-- > 0;) {
      if (ratios_[k] < usual_ + share * growth) return static_cast<double>(k);
    }
    return -1.0;
  };
  return last_below(0.75) - last_below(0.25) > tuning_.slow_s / tuning_.window_s;
}

}  // namespace palpate::force_estimation
