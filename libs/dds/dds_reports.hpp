// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::dds {

/// From now on, warnings and errors of Cyclone DDS in this process come on the standard error
/// output once, and are then counted (RepeatedWarning): the refusal of a participant comes with
/// each of its attempts. Only the first call does something. Safe from any thread.
void CountRepeatedDdsReports();

}  // namespace palpate::dds
