// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"

/// One function for each fault, in the file of its name: adds it at every place where it can be.
namespace palpate::diagnosis {

void MakeYoungsModulus(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeRegionalStiffness(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePoissonsRatio(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeStiffening(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDensity(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeViscoelasticCreep(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeMullins(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePlasticSet(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeGeometryScale(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeTemperature(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeRestTwist(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeBaseCompliance(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeGravityDirection(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePayload(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePermanentForce(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeHiddenObstacle(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableFriction(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableElasticity(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableGain(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableOffset(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeBacklash(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableRouting(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCableGuides(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeSwappedCables(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDriveCoupling(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeLag(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeLeak(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeSlowValve(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeBlockedValve(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePressureGain(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakePressureZero(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeSwappedTubes(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeThinWall(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeCameraMoved(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDepthScale(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDepthIncidenceBias(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeIntrinsics(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeLensDistortion(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeWarmUpDrift(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeMarkerMisplacement(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDiscretisation(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeExtrinsics(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeAnchorCompliance(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeModelDiscrepancy(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeDepthBias(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeStereoRipple(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);
void MakeSurfaceOffset(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults);

}  // namespace palpate::diagnosis
