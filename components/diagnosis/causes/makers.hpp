// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <vector>

#include "components/diagnosis/causes/catalogue.hpp"

/// One function for each cause, in the file of its name: adds it at every place where it can be.
namespace palpate::diagnosis {

void MakeYoungsModulus(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeRegionalStiffness(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakePoissonsRatio(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeStiffening(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDensity(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeViscoelasticCreep(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeMullins(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakePlasticSet(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeGeometryScale(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeTemperature(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeRestTwist(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeBaseCompliance(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeGravityDirection(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakePayload(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakePermanentForce(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeHiddenObstacle(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableFriction(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableElasticity(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableGainCause(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableOffsetCause(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeBacklash(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableRouting(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeSwappedCables(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDriveCoupling(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeLag(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCameraMoved(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDepthScale(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDepthIncidenceBias(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeIntrinsics(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeLensDistortion(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeWarmUpDrift(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeMarkerMisplacement(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDiscretisation(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeExtrinsics(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeCableEnds(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeDepthBias(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeStereoRipple(const CauseWorld& world, std::vector<CausePtr>* causes);
void MakeSkinOffset(const CauseWorld& world, std::vector<CausePtr>* causes);

}  // namespace palpate::diagnosis
