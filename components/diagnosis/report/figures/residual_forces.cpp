// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "components/diagnosis/report/figures/body_arrows.hpp"
#include "components/diagnosis/report/figures/figures.hpp"

namespace palpate::diagnosis {

Figure DrawResidualForces(const DiagnosisResult& result) {
  const ResidualForces& forces = result.residual_forces;
  Figure figure{.id = "residual-forces",
                .title = "Which forces would do it",
                .caption = "The smallest forces on the body that would do, in recording " +
                           forces.recording +
                           " throughout, what the simulation leaves there: where and which way "
                           "something pushes that is not in the model, or looks as if it did.",
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
    figure.absent = "No forces were looked for.";
    return figure;
  }
  figure.svg = DrawBodyArrows(result, arrows, figure.id);
  return figure;
}

}  // namespace palpate::diagnosis
