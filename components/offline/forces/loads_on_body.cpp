// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/loads_on_body.hpp"

#include "libs/experiment/loads.hpp"
#include "libs/fem/surface_patch.hpp"

namespace palpate::offline {

void RequireLoadsOnBody(const experiment::Recording& recording, const fem::PointLocator& places) {
  for (const experiment::KnownLoad& load : recording.loads) {
    experiment::RequireOnBody(
        load, fem::MakeSurfacePatch(places, load.position_m, load.patch_radius_m).distance_m);
  }
}

}  // namespace palpate::offline
