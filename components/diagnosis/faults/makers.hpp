// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"

/// One function for each cause, in the file of its name: adds it at every place where it can be.
namespace palpate::diagnosis {

void MakeYoungsModulus(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeRegionalStiffness(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakePoissonsRatio(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeStiffening(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDensity(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeViscoelasticCreep(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeMullins(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakePlasticSet(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeGeometryScale(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeTemperature(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeRestTwist(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeBaseCompliance(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeGravityDirection(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakePayload(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakePermanentForce(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeHiddenObstacle(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableFriction(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableElasticity(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableGainCause(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableOffsetCause(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeBacklash(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableRouting(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeSwappedCables(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDriveCoupling(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeLag(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCameraMoved(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDepthScale(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDepthIncidenceBias(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeIntrinsics(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeLensDistortion(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeWarmUpDrift(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeMarkerMisplacement(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDiscretisation(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeExtrinsics(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeCableEnds(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeDepthBias(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeStereoRipple(const CauseWorld& world, std::vector<FaultModelPtr>* causes);
void MakeSkinOffset(const CauseWorld& world, std::vector<FaultModelPtr>* causes);

}  // namespace palpate::diagnosis
