// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "libs/fem/sparse/sparse_solver.hpp"

namespace palpate::benchmarks {

/// Eigen::SimplicialLDLT to compare with: the pattern in the order that its own AMD finds for the
/// single rows, analysed here, once.
std::unique_ptr<fem::SparseSolver> MakeEigenLdlt(const fem::BlockPattern& pattern);

}  // namespace palpate::benchmarks
