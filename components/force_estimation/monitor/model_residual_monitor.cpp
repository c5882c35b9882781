// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/model_residual_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

using GapState = GapReport::State;

constexpr double kGapSecond_s = 1.0;
constexpr int kLeastGapFrames = 3;
constexpr std::size_t kGapReferenceSeconds = 10;
constexpr std::size_t kGapsTogether = 3;
constexpr int kGapsInARow = 2;
constexpr int kDraws = 2000;
constexpr double kFalseAlarms = 1e-3;
/// What a robot that moves may have of it more than at the start: its mesh errs elsewhere.
constexpr double kLeastGrowth = 1.5;
/// Of the noise's squares: so far beyond it, the model is wrong from the start.
constexpr double kWrong = 9.0;
/// Share of the growth that points at one part.
constexpr double kMost = 0.7;
constexpr double kSlow_s = 10.0;

/// Largest mean of some seconds that a reference leaves to chance: bootstrap, smoothed by its own
/// scatter, as so few seconds do not hold the rare ones.
double BootstrapThreshold(const std::vector<double>& ratios) {
  double mean = 0.0;
  double square = 0.0;
  for (const double ratio : ratios) mean += ratio / static_cast<double>(ratios.size());
  for (const double ratio : ratios) square += (ratio - mean) * (ratio - mean);
  const double scatter = std::sqrt(square / static_cast<double>(ratios.size() - 1));
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, ratios.size() - 1);
  std::normal_distribution<double> normal(0.0, scatter);
  std::vector<double> means;
  for (int d = 0; d < kDraws; ++d) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kGapsTogether; ++k) sum += ratios[pick(random)] + normal(random);
    means.push_back(sum / kGapsTogether);
  }
  std::sort(means.begin(), means.end());
  return means[static_cast<std::size_t>((1.0 - kFalseAlarms) * (kDraws - 1))];
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
  if (t_s < last_s_) *this = ModelResidualMonitor();
  last_s_ = t_s;
  if (second_.frames == 0) second_.begin_s = t_s;
  if (t_s - second_.begin_s >= kGapSecond_s) {
    Close();
    second_ = {};
    second_.begin_s = t_s;
  }
  ++second_.frames;
  const bool known = gap.whole.sample_count > 0 && std::isfinite(gap.whole.residual_rms_m) &&
                     gap.whole.noise_rms_m > 0.0;
  if (!known) return;
  ++second_.seen;
  AddPart(gap.whole, &second_.whole);
  AddParts(gap.regions, &second_.regions);
  AddParts(gap.cables, &second_.cables);
}

double ModelResidualMonitor::MeanRatio(const std::deque<Second>& seconds) {
  double sum = 0.0;
  for (const Second& one : seconds) sum += one.whole.Ratio();
  return sum / static_cast<double>(seconds.size());
}

void ModelResidualMonitor::Close() {
  if (second_.seen < kLeastGapFrames) {
    if (report_.state == GapState::kHolds) report_.state = GapState::kNotSeen;
    return;
  }
  report_.residual_rms_m = std::sqrt(second_.whole.squares_m2 / second_.whole.points);
  report_.noise_rms_m = std::sqrt(second_.whole.variances_m2 / second_.whole.points);
  if (reference_.size() < kGapReferenceSeconds) {
    reference_.push_back(second_);
    if (reference_.size() == kGapReferenceSeconds) Learn();
    return;
  }
  ratios_.push_back(second_.whole.Ratio());
  latest_.push_back(second_);
  if (latest_.size() > kGapsTogether) latest_.pop_front();
  if (latest_.size() == kGapsTogether) Judge();
}

void ModelResidualMonitor::Learn() {
  std::vector<double> ratios;
  for (const Second& one : reference_) ratios.push_back(one.whole.Ratio());
  usual_ = MeanRatio(reference_);
  threshold_ = std::max(BootstrapThreshold(ratios), kLeastGrowth * std::max(1.0, usual_));
  report_.state = GapState::kHolds;
  if (usual_ < kWrong) return;
  report_.state = GapState::kGrown;
  report_.advice = "what the model leaves unexplained is " + InMillimetres(report_.residual_rms_m) +
                   " from the start (noise " + InMillimetres(report_.noise_rms_m) +
                   "): calibrate, or record and run palpate diagnose on the recording";
}

void ModelResidualMonitor::Judge() {
  const bool grown = MeanRatio(latest_) > threshold_ || usual_ >= kWrong;
  if (report_.state == GapState::kNotSeen) report_.state = GapState::kHolds;
  const bool said = report_.state == GapState::kGrown;
  in_a_row_ = grown == said ? 0 : in_a_row_ + 1;
  if (grown && usual_ < kWrong && (said || in_a_row_ >= kGapsInARow)) report_.advice = Advice();
  if (in_a_row_ < kGapsInARow) return;
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
  if (const Part* cable = PartThatGrew(&Second::cables)) {
    return "cable " + cable->name + " or its actuator";
  }
  const Part* region = PartThatGrew(&Second::regions);
  if (region != nullptr && region->name != "body") {
    return "the material of " + region->name + ", or what touches it";
  }
  return CameSlowly() ? "something slow (creep, temperature, a camera that gets warm)"
                      : "something sudden (the camera, the base, a load)";
}

/// The one that holds most of the growth, where not all points are its own; nullptr: none does.
const ModelResidualMonitor::Part* ModelResidualMonitor::PartThatGrew(
    std::vector<Part> Second::*parts) const {
  const std::vector<Part>& now = latest_.back().*parts;
  const double growth_m2 =
      latest_.back().whole.squares_m2 - usual_ * latest_.back().whole.variances_m2;
  for (const Part& one : now) {
    const bool alone = one.points == latest_.back().whole.points;
    if (!alone && one.squares_m2 - usual_ * one.variances_m2 > kMost * growth_m2) return &one;
  }
  return nullptr;
}

/// Whether it took long from a quarter to three quarters of what it is now.
bool ModelResidualMonitor::CameSlowly() const {
  const double growth = MeanRatio(latest_) - usual_;
  const auto last_below = [&](double share) {
    for (std::size_t k = ratios_.size(); k-- > 0;) {
      if (ratios_[k] < usual_ + share * growth) return static_cast<double>(k);
    }
    return -1.0;
  };
  return last_below(0.75) - last_below(0.25) > kSlow_s / kGapSecond_s;
}

}  // namespace palpate::force_estimation
