// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tests/benchmarks/results.hpp"

namespace palpate::benchmarks {

/// quantity = factor * rows^exponent, least squares of the logarithms.
struct ScalingLaw {
  std::string quantity;  ///< with its unit
  double factor = 0.0;
  double exponent = 0.0;
  std::vector<double> rows;  ///< of the meshes that it was fitted to
};

/// How time, operations, nonzeros and memory grow over the meshes of `family` (first parts of the
/// names of benchmarks), of what has run on two meshes or more.
std::vector<ScalingLaw> FitScalingLaws(const Results& results,
                                       const std::vector<std::string>& family);

void Print(std::ostream& out, const std::vector<ScalingLaw>& laws,
           const std::vector<std::string>& family);

/// One report each, "scaling_law/<quantity>", its figures as counters.
std::vector<benchmark::BenchmarkReporter::Run> ToRuns(const std::vector<ScalingLaw>& laws);

}  // namespace palpate::benchmarks
