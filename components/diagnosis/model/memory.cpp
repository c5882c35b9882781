// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/memory.hpp"

#include <cmath>
#include <optional>

namespace palpate::diagnosis {

namespace {

/// Since when these loads act: others act since another time.
std::optional<double> StampOf(const std::vector<experiment::KnownLoad>& loads) {
  return loads.empty() ? std::nullopt : std::optional(loads.front().t_s);
}

}  // namespace

Memory::Memory(const ObservedExperiment& observed) : observed_(observed) {
  const std::vector<Sample>& samples = observed.samples;
  const Timeline& timeline = observed.timeline;
  std::size_t first = 0;
  while (first < samples.size()) {
    std::size_t last = first;
    while (last + 1 < samples.size() && samples[last + 1].recording == samples[first].recording &&
           samples[last + 1].piece_begin_s == samples[first].piece_begin_s) {
      ++last;
    }
    AddPiece(first, last);
    const bool ends =
        last + 1 == samples.size() || samples[last + 1].recording != samples[first].recording;
    if (ends && last + 1 < samples.size()) {
      const auto next = static_cast<std::size_t>(samples[last + 1].recording);
      const auto recording = static_cast<std::size_t>(samples[first].recording);
      Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(std::ssize(samples) + 1);
      if (!observed.recordings[next].held_until_s) zero[zero.size() - 1] = 1.0;
      Add(0.5 * (timeline.end_s[recording] + timeline.begin_s[next]), std::move(zero));
    }
    first = last + 1;
  }
}

Eigen::RowVectorXd Memory::Only(std::size_t sample) const {
  Eigen::RowVectorXd share = Eigen::RowVectorXd::Zero(std::ssize(observed_.samples) + 1);
  share[static_cast<Eigen::Index>(sample)] = 1.0;
  return share;
}

Eigen::RowVectorXd Memory::CarriedOn(std::size_t from, std::size_t over, double to_s) const {
  const double from_s = observed_.samples[from].t_s;
  const double over_s = observed_.samples[over].t_s;
  if (from == over || observed_.samples[from].still) return Only(over);
  const double beyond = (to_s - from_s) / (over_s - from_s);
  return (1.0 - beyond) * Only(from) + beyond * Only(over);
}

/// Where two pieces meet, the mean of what both carry there.
void Memory::Add(double t_s, Eigen::RowVectorXd share) {
  constexpr double kSame_s = 1e-9;
  if (!nodes_.empty() && t_s <= nodes_.back().t_s + kSame_s) {
    nodes_.back().share = 0.5 * (nodes_.back().share + share);
    return;
  }
  nodes_.push_back({t_s, std::move(share)});
}

void Memory::AddPiece(std::size_t first, std::size_t last) {
  const std::vector<Sample>& samples = observed_.samples;
  const std::size_t second = std::min(first + 1, last);
  const double begin_s = samples[first].piece_begin_s;
  Eigen::RowVectorXd at_begin = CarriedOn(second, first, begin_s);
  const auto recording = static_cast<std::size_t>(samples[first].recording);
  const std::optional<double> held_until_s = observed_.recordings[recording].held_until_s;
  const bool released = held_until_s && *held_until_s < begin_s &&
                        (first == 0 || samples[first - 1].recording != samples[first].recording);
  if (released) {
    Add(*held_until_s, Eigen::RowVectorXd::Zero(at_begin.size()));
    nodes_.push_back({*held_until_s, at_begin});
  }
  const bool jumps = first > 0 && samples[first - 1].recording == samples[first].recording &&
                     StampOf(samples[first - 1].loads) != StampOf(samples[first].loads);
  if (jumps) {
    nodes_.push_back({std::max(begin_s, nodes_.back().t_s), std::move(at_begin)});
  } else {
    Add(begin_s, std::move(at_begin));
  }
  for (std::size_t s = first; s <= last; ++s) Add(samples[s].t_s, Only(s));
  const std::size_t before = last > first ? last - 1 : last;
  Add(samples[last].piece_end_s, CarriedOn(before, last, samples[last].piece_end_s));
}

const Eigen::MatrixXd& Memory::Fading(double tau_s) const {
  const std::scoped_lock lock(mutex_);
  const auto known = fading_.find(tau_s);
  if (known != fading_.end()) return known->second;
  return fading_.emplace(tau_s, WorkOutFading(tau_s)).first->second;
}

Eigen::MatrixXd Memory::WorkOutFading(double tau_s) const {
  const auto samples = std::ssize(observed_.samples);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(samples, samples + 1);
  Eigen::RowVectorXd now = Eigen::RowVectorXd::Zero(samples + 1);
  const auto later = [&](const Node& from, const Eigen::RowVectorXd& to, double h_s) {
    const double kept = std::exp(-h_s / tau_s);
    const double taken = h_s > 0.0 ? (1.0 - kept) * tau_s / h_s : 1.0;
    return Eigen::RowVectorXd(kept * now + taken * (to - from.share));
  };
  std::size_t sample = 0;
  std::size_t frame = 0;
  for (std::size_t k = 1; k < nodes_.size(); ++k) {
    const Node& from = nodes_[k - 1];
    const Node& to = nodes_[k];
    while (sample < observed_.samples.size()) {
      const Sample& seen = observed_.samples[sample];
      const double t_s = seen.frame_t_s[frame];
      if (t_s > to.t_s) break;
      const double share = std::max(0.0, t_s - from.t_s) / (to.t_s - from.t_s);
      const Eigen::RowVectorXd there = from.share + share * (to.share - from.share);
      weights.row(static_cast<Eigen::Index>(sample)) +=
          later(from, there, std::max(0.0, t_s - from.t_s)) /
          static_cast<double>(seen.frame_t_s.size());
      if (++frame < seen.frame_t_s.size()) continue;
      frame = 0;
      ++sample;
    }
    now = later(from, to.share, to.t_s - from.t_s);
  }
  return weights;
}

Eigen::MatrixXf Memory::Largest(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf largest = values.leftCols(std::ssize(observed_.samples));
  Eigen::VectorXf until_now = Eigen::VectorXf::Zero(values.rows());
  std::size_t node = 0;
  for (Eigen::Index s = 0; s < largest.cols(); ++s) {
    const double t_s = observed_.samples[static_cast<std::size_t>(s)].t_s;
    for (; node < nodes_.size() && nodes_[node].t_s <= t_s; ++node) {
      Eigen::VectorXf there = Eigen::VectorXf::Zero(values.rows());
      for (Eigen::Index k = 0; k < values.cols(); ++k) {
        const auto share = static_cast<float>(nodes_[node].share[k]);
        if (share != 0.0F) there += share * values.col(k);
      }
      until_now = until_now.cwiseMax(there);
    }
    until_now = until_now.cwiseMax(largest.col(s));
    largest.col(s) = until_now;
  }
  return largest;
}

}  // namespace palpate::diagnosis
