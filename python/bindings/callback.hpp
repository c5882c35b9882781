// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <utility>

namespace palpate::python {

/// A Python function that a long call without the GIL calls; the first exception of it is kept, and
/// ends the calls.
class Callback {
 public:
  /// None: nobody is called. With the GIL.
  explicit Callback(pybind11::object function) : function_(std::move(function)) {}
  Callback(const Callback&) = delete;
  Callback& operator=(const Callback&) = delete;

  /// Without the GIL.
  template <typename... Arguments>
  void operator()(const Arguments&... arguments) {
    if (failed() || function_.is_none()) return;
    const pybind11::gil_scoped_acquire acquired;
    try {
      function_(arguments...);
    } catch (const pybind11::error_already_set&) {
      error_ = std::current_exception();
    }
  }
  bool failed() const { return error_ != nullptr; }
  /// Raises what the function has raised. With the GIL.
  void Raise() const {
    if (failed()) std::rethrow_exception(error_);
  }

 private:
  pybind11::object function_;
  std::exception_ptr error_;
};

}  // namespace palpate::python
