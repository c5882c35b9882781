// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Since when these loads act: others act since another time.
std::optional<double> StampOf(const std::vector<experiment::KnownLoad>& loads) {
  return loads.empty() ? std::nullopt : std::optional(loads.front().t_s);
}

}  // namespace

HistoryOperator::HistoryOperator(const ObservedExperiment& observed) : observed_(observed) {
  const std::vector<Sample>& samples = observed.samples;
  const Timeline& timeline = observed.timeline;
  largest_command_ = Eigen::VectorXd::Zero(std::ssize(timeline.actuators));
  for (const Eigen::VectorXd& command : timeline.command) {
    largest_command_ = command.array().isNaN().select(
        largest_command_, command.cwiseAbs().cwiseMax(largest_command_));
  }
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
      const double middle_s = 0.5 * (timeline.end_s[recording] + timeline.begin_s[next]);
      Add({middle_s, (observed.recordings[next].held_until_s ? 0.0 : 1.0) * Zero()});
    }
    first = last + 1;
  }
}

Eigen::RowVectorXd HistoryOperator::Only(std::size_t column) const {
  Eigen::RowVectorXd share = Eigen::RowVectorXd::Zero(ColumnCount());
  share[ToIndex(column)] = 1.0;
  return share;
}

Eigen::RowVectorXd HistoryOperator::BeginOf(std::size_t first) const {
  return Only(observed_.samples.size() + 1 + 2 * first);
}

Eigen::RowVectorXd HistoryOperator::EndOf(std::size_t last) const {
  return Only(observed_.samples.size() + 2 + 2 * last);
}

/// Whether the robot is at a time of a sample's recording as it is in the rests, near enough.
bool HistoryOperator::IsAtZero(std::size_t sample, double t_s) const {
  constexpr double kNearlyNothing = 0.1;  // of the largest command
  const Sample& seen = observed_.samples[sample];
  const ObservedRecording& recording = observed_.recordings[At(seen.recording)];
  const bool as_built = recording.base_rotation.isIdentity() && !recording.held_until_s;
  if (largest_command_.isZero() || !seen.loads.empty() || !as_built) return false;
  const Eigen::ArrayXd command = observed_.timeline.CommandAt(t_s).array();
  return (command.isNaN() || command.abs() <= kNearlyNothing * largest_command_.array()).all();
}

/// Where two pieces meet, what is sure of the one, or the mean of what both carry there.
void HistoryOperator::Add(Node node) {
  constexpr double kSame_s = 1e-9;
  if (nodes_.empty() || node.t_s > nodes_.back().t_s + kSame_s) {
    nodes_.push_back(std::move(node));
    return;
  }
  Node& there = nodes_.back();
  if (there.sure == node.sure) there.share = 0.5 * (there.share + node.share);
  if (node.sure && !there.sure) there.share = std::move(node.share);
  there.sure = there.sure || node.sure;
}

/// Of a piece: where it begins, its samples, where it ends.
std::vector<HistoryOperator::Node> HistoryOperator::NodesOf(std::size_t first,
                                                            std::size_t last) const {
  const std::vector<Sample>& samples = observed_.samples;
  const double begin_s = samples[first].piece_begin_s;
  const double end_s = samples[last].piece_end_s;
  const bool still = samples[first].still;
  const auto at_end = [&](std::size_t sample, double t_s,
                          const Eigen::RowVectorXd& moving) -> Node {
    if (still) return {t_s, Only(sample)};
    if (IsAtZero(sample, t_s)) return {t_s, Zero()};
    return {t_s, moving, /*sure=*/false};
  };
  std::vector<Node> nodes{at_end(first, begin_s, BeginOf(first))};
  for (std::size_t s = first; s <= last; ++s) {
    if (samples[s].t_s > nodes.back().t_s) nodes.push_back({samples[s].t_s, Only(s)});
  }
  if (end_s > nodes.back().t_s) nodes.push_back(at_end(last, end_s, EndOf(last)));
  return nodes;
}

void HistoryOperator::AddPiece(std::size_t first, std::size_t last) {
  const std::vector<Sample>& samples = observed_.samples;
  std::vector<Node> nodes = NodesOf(first, last);
  const double begin_s = nodes.front().t_s;
  const auto recording = static_cast<std::size_t>(samples[first].recording);
  const std::optional<double> held_until_s = observed_.recordings[recording].held_until_s;
  const bool released = held_until_s && *held_until_s < begin_s &&
                        (first == 0 || samples[first - 1].recording != samples[first].recording);
  if (released) {
    Add({*held_until_s, 0.0 * Zero()});
    nodes_.push_back({*held_until_s, nodes.front().share});
  }
  const bool jumps = first > 0 && samples[first - 1].recording == samples[first].recording &&
                     StampOf(samples[first - 1].loads) != StampOf(samples[first].loads);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (k == 0 && jumps) {
      nodes.front().t_s = std::max(begin_s, nodes_.back().t_s);
      nodes_.push_back(std::move(nodes.front()));
    } else {
      Add(std::move(nodes[k]));
    }
  }
}

const Eigen::MatrixXd& HistoryOperator::Fading(double tau_s) const {
  const std::scoped_lock lock(mutex_);
  const auto known = fading_.find(tau_s);
  if (known != fading_.end()) return known->second;
  return fading_.emplace(tau_s, ComputeFading(tau_s)).first->second;
}

Eigen::MatrixXd HistoryOperator::ComputeFading(double tau_s) const {
  const auto samples = std::ssize(observed_.samples);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(samples, ColumnCount());
  Eigen::RowVectorXd now = Eigen::RowVectorXd::Zero(ColumnCount());
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
      weights.row(ToIndex(sample)) += later(from, there, std::max(0.0, t_s - from.t_s)) /
                                      static_cast<double>(seen.frame_t_s.size());
      if (++frame < seen.frame_t_s.size()) continue;
      frame = 0;
      ++sample;
    }
    now = later(from, to.share, to.t_s - from.t_s);
  }
  return weights;
}

HistoryOperator::Course HistoryOperator::Follow(const Eigen::MatrixXf& values) const {
  const auto value_at = [&](const Node& node) {
    Eigen::VectorXf there = Eigen::VectorXf::Zero(values.rows());
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const auto share = static_cast<float>(node.share[k]);
      if (share != 0.0F) there += share * values.col(k);
    }
    return there;
  };
  const Eigen::Index looks = kTimesPerSample * std::ssize(observed_.samples);
  Course course{Eigen::MatrixXf(values.rows(), looks), Eigen::MatrixXf(values.rows(), looks)};
  if (looks == 0) return course;
  std::size_t node = 0;  // the next one
  Eigen::VectorXf before = value_at(nodes_.front());
  Eigen::VectorXf next = before;
  Eigen::VectorXf largest = Eigen::VectorXf::Zero(values.rows());
  for (Eigen::Index look = 0; look < looks; ++look) {
    const std::vector<double>& frames_s = observed_.samples[At(look / kTimesPerSample)].frame_t_s;
    const auto frame = static_cast<std::size_t>(2 * (look % kTimesPerSample) + 1) *
                       frames_s.size() / static_cast<std::size_t>(2 * kTimesPerSample);
    const double t_s = frames_s[frame];
    for (; node < nodes_.size() && nodes_[node].t_s <= t_s; ++node) {
      before = next;
      largest = largest.cwiseMax(before);
      if (node + 1 < nodes_.size()) next = value_at(nodes_[node + 1]);
    }
    const bool between = node > 0 && node < nodes_.size();
    const double whole_s = between ? nodes_[node].t_s - nodes_[node - 1].t_s : 0.0;
    const double share = between ? (t_s - nodes_[node - 1].t_s) / whole_s : 0.0;
    course.now.col(look) = before + static_cast<float>(share) * (next - before);
    largest = largest.cwiseMax(course.now.col(look));
    course.largest.col(look) = largest;
  }
  return course;
}

Eigen::MatrixXf BelowLargest_J_m3(const HistoryOperator& history, const Simulation& simulation) {
  Eigen::MatrixXf root(simulation.at_rest.energy_J_m3.size(), history.ColumnCount());
  for (Eigen::Index column = 0; column < root.cols(); ++column) {
    root.col(column) = HistoryInputOf(simulation, column).energy_J_m3.cwiseMax(0.0F).cwiseSqrt();
  }
  const HistoryOperator::Course course = history.Follow(root);
  return course.largest.cwiseAbs2() - course.now.cwiseAbs2();
}

void Soften(const MullinsSoftening& mullins, const HistoryOperator& history,
            const Simulation& simulation, std::vector<HistoryVariables>* history_variables) {
  const Eigen::MatrixXf below_J_m3 = BelowLargest_J_m3(history, simulation);
  history_variables->resize(simulation.samples.size());
  for (std::size_t s = 0; s < history_variables->size(); ++s) {
    Eigen::VectorXd& factor = (*history_variables)[s].cell_factor;
    if (factor.size() == 0) factor.setOnes(below_J_m3.rows());
    const Eigen::VectorXf& density_J_m3 = simulation.samples[s].in_the_middle.energy_J_m3;
    for (Eigen::Index cell = 0; cell < factor.size(); ++cell) {
      const Eigen::Array<double, HistoryOperator::kTimesPerSample, 1> below =
          below_J_m3.row(cell)
              .segment<HistoryOperator::kTimesPerSample>(HistoryOperator::kTimesPerSample *
                                                         ToIndex(s))
              .transpose()
              .cast<double>()
              .array() /
          mullins.m_J_m3;
      const double softened = below.unaryExpr([](double u) { return std::erf(u); }).mean();
      const double wanted = 1.0 - mullins.inverse_r * softened;
      const double answer = 4.0 * std::numbers::inv_sqrtpi * (-below.square()).exp().mean() *
                            double{density_J_m3[cell]} * mullins.inverse_r /
                            (mullins.m_J_m3 * factor[cell]);
      factor[cell] += (wanted - factor[cell]) / (1.0 + answer);
    }
  }
}

namespace {

/// What of creep is left for each sample.
void Creep(const std::vector<CreepTerm>& terms, const HistoryOperator& history,
           const Simulation& simulation, std::vector<HistoryVariables>* history_variables) {
  const auto samples = std::ssize(simulation.samples);
  for (HistoryVariables& left : *history_variables) {
    left.scale = 0.0;
    left.stress_Pa.setZero(6, simulation.at_rest.elastic_Pa.cols());
  }
  for (const CreepTerm& term : terms) {
    const Eigen::MatrixXd& fading = history.Fading(term.tau_s);
    for (Eigen::Index s = 0; s < samples; ++s) {
      HistoryVariables& left = (*history_variables)[At(s)];
      Eigen::VectorXd weights = fading.row(s).transpose();
      left.scale += term.g * weights[s];
      weights[s] = 0.0;
      AddHistoryStress(simulation, term.g * weights, &left.stress_Pa);
    }
  }
}

/// How much of what it holds a body remembers at most.
double StrengthOf(const ModelHypothesis& hypothesis) {
  double strength = hypothesis.mullins ? hypothesis.mullins->inverse_r : 0.0;
  for (const CreepTerm& term : hypothesis.creep) strength += std::abs(term.g);
  return strength;
}

/// The norm of all stresses that two pasts differ by, of a body that holds `elastic_Pa`, Pa.
double Difference_Pa(const HistoryVariables& a, const HistoryVariables& b, double elastic_Pa) {
  const double of_scale_Pa = std::abs(a.scale - b.scale) * elastic_Pa;
  if (a.stress_Pa.size() == 0 || b.stress_Pa.size() == 0) {
    return of_scale_Pa + double{a.stress_Pa.norm()} + double{b.stress_Pa.norm()};
  }
  return of_scale_Pa + double{(a.stress_Pa - b.stress_Pa).norm()};
}

/// The sum of all energy densities that two pasts differ by, J/m^3.
double Difference_J_m3(const HistoryVariables& a, const HistoryVariables& b,
                       const Eigen::VectorXf& energy_J_m3) {
  const auto factor = [&](const HistoryVariables& one, Eigen::Index cell) {
    return one.cell_factor.size() == 0 ? 1.0 : one.cell_factor[cell];
  };
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < energy_J_m3.size(); ++cell) {
    sum += std::abs(factor(a, cell) - factor(b, cell)) * double{energy_J_m3[cell]};
  }
  return sum;
}

}  // namespace

bool HasHistory(const ModelHypothesis& hypothesis) {
  return !hypothesis.creep.empty() || hypothesis.mullins;
}

std::vector<bool> UpdateHistory(const ModelHypothesis& hypothesis, const HistoryOperator& history,
                                const Simulation& simulation,
                                std::vector<HistoryVariables>* history_variables) {
  constexpr double kLittle = 1e-4;
  const std::vector<HistoryVariables> before = *history_variables;
  if (!hypothesis.creep.empty()) Creep(hypothesis.creep, history, simulation, history_variables);
  if (hypothesis.mullins) Soften(*hypothesis.mullins, history, simulation, history_variables);
  double most_Pa = 0.0;
  double most_J_m3 = 0.0;
  for (const SimulatedSample& sample : simulation.samples) {
    most_Pa = std::max(most_Pa, double{sample.in_the_middle.elastic_Pa.norm()});
    most_J_m3 = std::max(most_J_m3, double{sample.in_the_middle.energy_J_m3.sum()});
  }
  const double little = kLittle * StrengthOf(hypothesis);
  std::vector<bool> is_other(history_variables->size());
  for (std::size_t s = 0; s < history_variables->size(); ++s) {
    const HistoryInput& now = simulation.samples[s].in_the_middle;
    const double stress_Pa =
        Difference_Pa((*history_variables)[s], before[s], double{now.elastic_Pa.norm()});
    const double energy_J_m3 = Difference_J_m3((*history_variables)[s], before[s], now.energy_J_m3);
    is_other[s] = stress_Pa > little * most_Pa || energy_J_m3 > little * most_J_m3;
  }
  return is_other;
}

}  // namespace palpate::diagnosis
