// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libs/fem/bounded_qp.hpp"

namespace palpate::fem::qp {

/// What makes a problem hard. Half of the problems of a family have multiples of 1/2 only, so that
/// bounds touch and multipliers vanish by themselves.
enum class Family {
  kFullRank,
  kRankDeficient,     ///< any rank from 1, bounds finite
  kDuplicateColumns,  ///< some variables act alike or against one another
  kNearDuplicates,    ///< the same but for 0.1 to 1e-5
  kEmptyColumns,      ///< nothing in H acts on some variables
  kEqualBounds,       ///< on a third of the variables
  kConditioned,       ///< eigenvalues from 1 to 1e-8
  kVertex,          ///< the optimum is at bounds, some of their multipliers zero; bounds half open
  kSingularVertex,  ///< kVertex with a rank-deficient H
};

std::string Name(Family family);
std::vector<Family> AllFamilies();

/// The same problem in two sets of units.
struct RandomProblem {
  BoundedQp plain;   ///< numbers about one: what the other solver gets
  BoundedQp scaled;  ///< variable i counted in units of unit[i]
  QpVector unit;     ///< 1e-8 to 1e8; one for half of the problems
  QpVector start;    ///< of `scaled`; partly on bounds, partly outside
};

/// Problem `number`, of 1 to 16 variables: the same on every machine, whichever were made before.
RandomProblem MakeProblem(Family family, std::uint32_t seed, int number);

}  // namespace palpate::fem::qp
