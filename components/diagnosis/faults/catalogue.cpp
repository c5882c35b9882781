// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/catalogue.hpp"

#include <iterator>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"

namespace palpate::diagnosis {

namespace {

struct Entry {
  const char* id;
  void (*make)(const CatalogueInputs&, std::vector<FaultModelPtr>*);
};

constexpr Entry kCatalogue[] = {
    {"youngs_modulus", MakeYoungsModulus},
    {"regional_stiffness", MakeRegionalStiffness},
    {"poissons_ratio", MakePoissonsRatio},
    {"stiffening", MakeStiffening},
    {"density", MakeDensity},
    {"viscoelastic_creep", MakeViscoelasticCreep},
    {"mullins", MakeMullins},
    {"plastic_set", MakePlasticSet},
    {"geometry_scale", MakeGeometryScale},
    {"temperature", MakeTemperature},
    {"rest_twist", MakeRestTwist},
    {"base_compliance", MakeBaseCompliance},
    {"gravity_direction", MakeGravityDirection},
    {"payload", MakePayload},
    {"permanent_force", MakePermanentForce},
    {"hidden_obstacle", MakeHiddenObstacle},
    {"cable_friction", MakeCableFriction},
    {"cable_elasticity", MakeCableElasticity},
    {"cable_gain", MakeCableGain},
    {"cable_offset", MakeCableOffset},
    {"backlash", MakeBacklash},
    {"cable_routing", MakeCableRouting},
    {"swapped_cables", MakeSwappedCables},
    {"drive_coupling", MakeDriveCoupling},
    {"lag", MakeLag},
    {"leak", MakeLeak},
    {"slow_valve", MakeSlowValve},
    {"blocked_valve", MakeBlockedValve},
    {"pressure_gain", MakePressureGain},
    {"pressure_zero", MakePressureZero},
    {"swapped_tubes", MakeSwappedTubes},
    {"thin_wall", MakeThinWall},
    {"camera_moved", MakeCameraMoved},
    {"depth_scale", MakeDepthScale},
    {"depth_incidence_bias", MakeDepthIncidenceBias},
    {"intrinsics", MakeIntrinsics},
    {"lens_distortion", MakeLensDistortion},
    {"warm_up_drift", MakeWarmUpDrift},
    {"marker_misplacement", MakeMarkerMisplacement},
    {"discretisation", MakeDiscretisation},
};

/// Of the catalogue as well, but not searched. Flying pixels lie along depth edges: a marker inside
/// a surface has none.
constexpr const char* kNotLookedFor[] = {
    "cable_cutting",
    "flying_pixels",
};

}  // namespace

std::vector<std::string> SearchedFaults() {
  std::vector<std::string> ids;
  for (const Entry& entry : kCatalogue) ids.emplace_back(entry.id);
  return ids;
}

std::vector<std::string> CatalogueIds() {
  std::vector<std::string> ids = SearchedFaults();
  ids.insert(ids.end(), std::begin(kNotLookedFor), std::end(kNotLookedFor));
  return ids;
}

std::vector<FaultModelPtr> MakeFaultModels(const CatalogueInputs& inputs,
                                           const std::vector<std::string>& without) {
  const std::vector<std::string> ids = CatalogueIds();
  for (const std::string& id : without) {
    if (!IndexOf(id, ids)) throw InputError(Unknown("cause", id, ids));
  }
  std::vector<FaultModelPtr> faults;
  for (const Entry& entry : kCatalogue) {
    if (!IndexOf(entry.id, without)) entry.make(inputs, &faults);
  }
  MakeModelDiscrepancy(inputs, &faults);
  MakeAnchorCompliance(inputs, &faults);
  MakeExtrinsics(inputs, &faults);
  MakeDepthBias(inputs, &faults);
  MakeStereoRipple(inputs, &faults);
  MakeSurfaceOffset(inputs, &faults);
  return faults;
}

}  // namespace palpate::diagnosis
