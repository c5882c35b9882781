// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>

namespace palpate::python {

/// Looks for Ctrl-C during a long call that has released the GIL. One for each call.
class Interrupts {
 public:
  /// Whether the call must end, asked as often as one likes: Python is asked after 50 ms each, as
  /// taking the GIL from another thread may take as long as that thread wants.
  bool Requested();
  /// Raises what Python's handler of the signal has raised. With the GIL.
  void Raise() const;

 private:
  std::chrono::steady_clock::time_point next_ =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  bool requested_ = false;
};

}  // namespace palpate::python
