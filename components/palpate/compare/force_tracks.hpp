// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/palpate/compare/force_comparison.hpp"
#include "components/view/plot/force_plot.hpp"

namespace palpate::command {

/// Collects compared frames as curves over time: one track for each true force, and one for
/// estimates without a true force. Without truth one for each contact's name.
class ForceTracks {
 public:
  explicit ForceTracks(bool with_truth = true) : with_truth_(with_truth) {}

  /// A frame at `t_s`; without a result or a truth, `compared` is empty and the curves have a gap.
  void Add(double t_s, bool has_result, const std::vector<ComparedForce>& compared);

  /// In the order in which the forces first acted.
  std::vector<view::ForceTrack> Tracks() const;

 private:
  struct Frame {
    double t_s = 0.0;
    bool has_result = false;
    std::map<std::string, ComparedForce> forces;  ///< by track
  };
  std::string NameOf(const force_estimation::ContactForce& estimate) const;

  bool with_truth_;
  std::vector<Frame> frames_;
  std::vector<std::string> names_;
};

}  // namespace palpate::command
