// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kTolerance = 0.01;  ///< of commands, as a share of the largest

/// The largest distance of a command from the straight way between two times, in `span`, NaN left
/// out.
double CommandDistance(const Timeline& timeline, const Eigen::VectorXd& span, std::size_t first,
                       std::size_t last, std::size_t k) {
  const double share =
      (timeline.t_s[k] - timeline.t_s[first]) / (timeline.t_s[last] - timeline.t_s[first]);
  const Eigen::VectorXd straight =
      timeline.command[first] + share * (timeline.command[last] - timeline.command[first]);
  double distance = 0.0;
  for (Eigen::Index c = 0; c < straight.size(); ++c) {
    const double off = std::abs(timeline.command[k][c] - straight[c]) / span[c];
    if (!std::isnan(off)) distance = std::max(distance, off);
  }
  return distance;
}

void KeepKnots(const Timeline& timeline, const Eigen::VectorXd& span, std::size_t first,
               std::size_t last, std::set<double>* knots_s) {
  std::size_t farthest = first;
  double distance = kTolerance;
  for (std::size_t k = first + 1; k < last; ++k) {
    const double off = CommandDistance(timeline, span, first, last, k);
    if (off > distance) {
      distance = off;
      farthest = k;
    }
  }
  if (farthest == first) return;
  knots_s->insert(timeline.t_s[farthest]);
  KeepKnots(timeline, span, first, farthest, knots_s);
  KeepKnots(timeline, span, farthest, last, knots_s);
}

/// [actuators] the largest command of all that are in the same unit: m or N.
Eigen::VectorXd Spans(const Timeline& timeline) {
  double largest_m = 0.0;
  double largest_N = 0.0;
  for (const Eigen::VectorXd& command : timeline.command) {
    for (Eigen::Index c = 0; c < command.size(); ++c) {
      double& largest = timeline.by_tension[At(c)] ? largest_N : largest_m;
      if (!std::isnan(command[c])) largest = std::max(largest, std::abs(command[c]));
    }
  }
  Eigen::VectorXd span(std::ssize(timeline.by_tension));
  for (Eigen::Index c = 0; c < span.size(); ++c) {
    span[c] = timeline.by_tension[At(c)] ? largest_N : largest_m;
  }
  return (span.array() > 0.0).select(span, 1.0);
}

}  // namespace

std::vector<Piece> PiecesOf(const experiment::Recording& recording, const Timeline& timeline,
                            double begin_s, double end_s) {
  const Eigen::VectorXd span = Spans(timeline);
  std::set<double> knots_s{begin_s, end_s};
  // From the last stamp before to the first after: commands may turn at any between.
  const std::vector<double>& t_s = timeline.t_s;
  const auto after = std::upper_bound(t_s.begin(), t_s.end(), begin_s) - t_s.begin();
  const auto until = std::lower_bound(t_s.begin(), t_s.end(), end_s) - t_s.begin();
  const auto first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - 1, 0));
  const std::size_t last = std::min(static_cast<std::size_t>(until), t_s.size() - 1);
  if (first < last) KeepKnots(timeline, span, first, last, &knots_s);
  for (const experiment::KnownLoad& load : recording.loads) {
    if (load.t_s > begin_s && load.t_s < end_s) knots_s.insert(load.t_s);
  }
  std::vector<Piece> pieces;
  for (auto knot = knots_s.begin(); std::next(knot) != knots_s.end(); ++knot) {
    Piece piece{.begin_s = *knot, .end_s = *std::next(knot)};
    const Eigen::VectorXd moved =
        (timeline.CommandAt(piece.end_s) - timeline.CommandAt(piece.begin_s)).cwiseQuotient(span);
    for (const double change : moved) {
      if (std::abs(change) > kTolerance) piece.still = false;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<experiment::TimeWindow> WindowsOf(const Piece& piece, int most) {
  std::vector<experiment::TimeWindow> windows;
  const double length_s = piece.end_s - piece.begin_s;
  const auto edge_s = [&](int k) {
    const double share = piece.still ? (std::exp2(k) - 1.0) / (std::exp2(most) - 1.0)
                                     : static_cast<double>(k) / most;
    return piece.begin_s + share * length_s;
  };
  for (int k = 0; k < most; ++k) windows.push_back({edge_s(k), edge_s(k + 1)});
  return windows;
}

}  // namespace palpate::diagnosis
