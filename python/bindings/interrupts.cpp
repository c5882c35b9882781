// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/interrupts.hpp"

#include <pybind11/pybind11.h>

namespace py = pybind11;

namespace palpate::python {

bool Interrupts::Requested() {
  if (requested_) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + std::chrono::milliseconds(50);
  const py::gil_scoped_acquire acquired;
  requested_ = PyErr_CheckSignals() != 0;
  return requested_;
}

void Interrupts::Raise() const {
  if (requested_) throw py::error_already_set();
}

}  // namespace palpate::python
