// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <ostream>
#include <string>

#include "tests/benchmarks/block.hpp"
#include "tests/benchmarks/results.hpp"

namespace palpate::benchmarks {

/// The results for people, printed block after block.
class Table {
 public:
  Table(std::ostream& out, const Results& results) : out_(out), results_(results) {}

  /// Those of the block's benchmarks that have run or failed; before the first, the table's head.
  void Print(const Block& block);

 private:
  void PrintHead();
  void PrintLine(const std::string& name, const Result& result);

  std::ostream& out_;
  const Results& results_;
  std::string heading_;
  bool has_head_ = false;
};

/// `value` with that many digits after the point, or "-" where it is 0: not known.
std::string FixedOrDash(double value, int digits);

}  // namespace palpate::benchmarks
