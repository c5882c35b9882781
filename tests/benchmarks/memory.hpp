// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::benchmarks {

/// Memory of this process that is in RAM now, and the most that ever was.
double ResidentBytes();
double PeakResidentBytes();

}  // namespace palpate::benchmarks
