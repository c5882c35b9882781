// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::benchmarks {

/// The most memory of this process that ever was in RAM at once.
double PeakResidentBytes();

}  // namespace palpate::benchmarks
