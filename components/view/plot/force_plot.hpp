// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/view/plot/time_plot.hpp"

namespace palpate::view {

/// The force on one place over time, as estimated and in truth; not finite: not known, or none.
struct ForceTrack {
  std::string contact;
  std::vector<double> t_s;  ///< of all lists below
  std::vector<double> estimated_N;
  std::vector<double> ci95_N;    ///< half-width of the 95 % interval
  std::vector<double> hidden_N;  ///< as estimated_N, where the camera does not see the contact
  std::vector<double> hidden_ci95_N;
  std::vector<double> true_N;  ///< empty: unknown
};

/// Estimated forces with their 95 % intervals against the true ones, one panel for each contact;
/// as high as they need, 900 x 500 px at least.
TimePlot MakeForcePlot(const std::string& title, const std::vector<ForceTrack>& tracks);

}  // namespace palpate::view
