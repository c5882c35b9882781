// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/pose/frame_assignment.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::calibration {

/// What an earlier calibration says of a frame: gravity, and displacements read as its drives ask
/// for. `cable_names`: in the order of the frames' cables.
void ReadAsBefore(const robot::CalibrationFile& before, const std::vector<std::string>& cable_names,
                  std::vector<CloudFrame>* frames);
void ReadAsBefore(const robot::CalibrationFile& before, const std::vector<std::string>& cable_names,
                  std::vector<CalibrationFrame>* frames);
void ReadAsBefore(const robot::CalibrationFile& before, const std::vector<std::string>& cable_names,
                  std::vector<UnlabelledFrame>* frames);

/// Puts into `file`, found from frames that were read so, what holds on: moduli, Poisson's ratios,
/// gravity, size, guides and pose that it did not find anew. Its drives, which say how the earlier
/// reading is off, become those of the displacement as it was measured.
void KeepFromBefore(const robot::CalibrationFile& before, robot::CalibrationFile* file);

}  // namespace palpate::calibration
