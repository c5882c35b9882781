// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "components/diagnosis/forward/fault_model.hpp"

namespace palpate::diagnosis {

/// Inputs of the fault models of a robot.
struct CatalogueInputs {
  const robot::RobotBody& body;
  const ObservedExperiment& observed;
  double extrinsics_m = 0.0;  ///< sigma of given poses, where it is known (experiment.yaml)
  double extrinsics_rad = 0.0;
  /// How the robot moves as its file has it; none: no faults that ask for it.
  const Simulation* as_built = nullptr;
  std::shared_ptr<const MeshError> mesh_error = nullptr;  ///< where it is known
};

/// Every fault of the catalogue at every place of this robot where it can show in these data, and
/// `model_discrepancy`, `cable_ends`, `extrinsics`, `depth_bias`, `stereo_ripple` and
/// `skin_offset`, which are never faults. `without`: ids that are left out. Throws InputError for
/// one that is not of the catalogue.
std::vector<FaultModelPtr> MakeFaultModels(const CatalogueInputs& inputs,
                                           const std::vector<std::string>& without);

/// Ids of the catalogue that are searched.
std::vector<std::string> SearchedFaults();
/// All ids of the catalogue, those without a fault model, too.
std::vector<std::string> CatalogueIds();

}  // namespace palpate::diagnosis
