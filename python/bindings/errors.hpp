// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "libs/core/error.hpp"
#include "libs/core/status.hpp"

namespace palpate::python {

/// A computation that ended without a result that may be used. In Python SolveError, a RunError
/// with `status`, the word of the status, and `load_fraction`.
class SolveFailure : public RunError {
 public:
  /// `load_fraction`: of the way to the new loads that was reached.
  explicit SolveFailure(const Status& status, double load_fraction = 0.0)
      : RunError(status.message()), status_(status.code()), load_fraction_(load_fraction) {}

  StatusCode status() const { return status_; }
  double load_fraction() const { return load_fraction_; }

 private:
  StatusCode status_;
  double load_fraction_;
};

/// Defines palpate.InputError (a ValueError), RunError (a RuntimeError) and SolveError. What C++
/// throws reaches Python as these, with the same words.
void BindErrors(pybind11::module_& module);

}  // namespace palpate::python
