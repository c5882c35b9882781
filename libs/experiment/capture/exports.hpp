// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/capture/capture_text.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

/// Text files of capture programs, one function for each. All throw InputError with
/// file:line:column.

/// OptiTrack Motive's CSV, versions 1.2x: positions of markers. Rigid bodies, bones and their
/// rotations are left out with a note.
CapturedMarkers ReadMotiveCsv(CaptureText& text);
/// Vicon Nexus' CSV: the section 'Trajectories'; time 0 is its first frame.
CapturedMarkers ReadNexusCsv(CaptureText& text);
/// Qualisys Track Manager's TSV: markers (3D), or the origins of rigid bodies (6D). 0, 0, 0 is a
/// gap, as that program has it.
CapturedMarkers ReadQualisysTsv(CaptureText& text);
/// Track Row Column, of Motion Analysis Cortex and OpenSim.
CapturedMarkers ReadTrc(CaptureText& text);

}  // namespace palpate::experiment
