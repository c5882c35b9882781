// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "components/diagnosis/report/figures/body_arrows.hpp"
#include "components/diagnosis/report/figures/figures.hpp"

namespace palpate::diagnosis {

Figure DrawResidualForces(const DiagnosisResult& result) {
  const ResidualForces& forces = result.residual_forces;
  Figure figure{
      .id = "residual-forces",
      .title = "Residual forces",
      .caption = "The smallest forces on the body that would cause, in recording " +
                 forces.recording +
                 " throughout, the residuals: place and direction of an unmodelled load, or "
                 "of what has its effect.",
      .svg = {},
      .absent = {}};
  BodyArrows arrows{.foot_m = forces.place_m,
                    .names = {},
                    .before = forces.before_N,
                    .after = forces.after_N,
                    .unit = "N"};
  if (result.causes.empty()) {
    arrows.after.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (!(Longest(arrows.before) > 0.0) && !(Longest(arrows.after) > 0.0)) {
    figure.absent = "No residual forces were computed.";
    return figure;
  }
  figure.svg = DrawBodyArrows(result, arrows, figure.id);
  return figure;
}

}  // namespace palpate::diagnosis
