// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/diagnosis/diagnose.hpp"

namespace palpate::diagnosis {

/// A diagnosis of a robot file, in which the mesh is named last, and one of the robot on the finer
/// mesh, in the place of all but the mesh: what the file gets wrong, and by which causes. Residual
/// forces are of the finer mesh. Where that could not be diagnosed, or was interrupted, the first
/// is left, which says so.
Diagnosis Joined(Diagnosis of_file, Diagnosis of_finer);

}  // namespace palpate::diagnosis
