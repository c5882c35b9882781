// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <set>

#include "libs/core/config_reader.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/scenario.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

namespace fs = std::filesystem;

void ReadMaterial(const ConfigNode& node, BodyTruth* body) {
  MapReader reader(node, BodyMaterialKeys());
  reader.Read("model", &body->material_model);
  reader.Read("youngs_modulus_Pa", &body->youngs_modulus_Pa);
  reader.Read("poissons_ratio", &body->poissons_ratio);
  if (body->material_model == "yeoh") {
    reader.Read("c20_over_c10", &body->c20_over_c10);
    reader.Read("c30_over_c10", &body->c30_over_c10);
  } else if (node.Find("c20_over_c10") != nullptr || node.Find("c30_over_c10") != nullptr) {
    Refuse(node, "c20_over_c10 and c30_over_c10 go with 'model: yeoh'");
  }
  reader.Finish();
}

std::vector<PronyTerm> ReadProny(const ConfigNode& node) {
  std::vector<PronyTerm> terms;
  for (const ConfigNode& item : ReadList(node, "{g, tau_s}")) {
    MapReader reader(item, PronyKeys());
    PronyTerm term;
    reader.Read("g", &term.g);
    reader.Read("tau_s", &term.tau_s);
    reader.Finish();
    terms.push_back(term);
  }
  return terms;
}

BodyTruth ReadBody(const ConfigNode& node) {
  MapReader reader(node, BodyKeys());
  BodyTruth body;
  if (const ConfigNode* file = reader.Optional("mesh_file")) {
    reader.Read("mesh_file", &body.mesh_file);
    if (!fs::is_regular_file(body.mesh_file)) {
      Refuse(*file, "there is no file " + body.mesh_file.string());
    }
  }
  reader.Read("refine", &body.refine);
  reader.Read("element", &body.element);
  if (const ConfigNode* material = reader.Optional("material")) ReadMaterial(*material, &body);
  if (const ConfigNode* prony = reader.Optional("prony")) body.prony = ReadProny(*prony);
  reader.Finish();
  return body;
}

Motion ReadMotion(const ConfigNode& node) {
  MapReader reader(node, MotionKeys());
  Motion motion;
  std::string mode;
  reader.Read("mode", &mode);
  if (mode == "dynamic") motion.mode = MotionMode::kDynamic;
  reader.Read("time_step_s", &motion.time_step_s);
  reader.Read("rayleigh_mass_1_s", &motion.rayleigh_mass_1_s);
  reader.Read("rayleigh_stiffness_s", &motion.rayleigh_stiffness_s);
  reader.Finish();
  return motion;
}

std::vector<ChamberSupply> ReadSupplies(const ConfigNode& node) {
  std::vector<ChamberSupply> supplies;
  for (const ConfigNode& item : ReadList(node, "{chamber, ...}")) {
    MapReader reader(item, SupplyKeys());
    ChamberSupply supply;
    supply.location = item.where;
    reader.Read("chamber", &supply.chamber);
    reader.Read("valve_time_constant_s", &supply.valve_time_constant_s);
    reader.Read("leak_ratio", &supply.leak_ratio);
    reader.Read("sensor_gain", &supply.sensor_gain);
    reader.Read("sensor_zero_Pa", &supply.sensor_zero_Pa);
    reader.Read("sensor_noise_Pa", &supply.sensor_noise_Pa);
    reader.Finish();
    for (const ChamberSupply& other : supplies) {
      if (other.chamber == supply.chamber)
        Refuse(item, "a second supply of the chamber '" + supply.chamber + "'");
    }
    supplies.push_back(std::move(supply));
  }
  return supplies;
}

/// `camera`: whether the scenario has one.
MarkerSpec ReadMarkers(const ConfigNode& node, bool camera) {
  MapReader reader(node, MarkerSpecKeys());
  MarkerSpec markers;
  std::string frame_word;
  reader.Read("frame", &frame_word);
  markers.by_depth_camera = frame_word == "camera";
  if (const ConfigNode* frame = reader.Optional("frame")) {
    if (!camera) Refuse(*frame, "the scenario has no camera that could measure them");
  }
  if (const ConfigNode* sigma = reader.Optional("sigma_m")) {
    markers.sigma_m = sigma->kind == ConfigNode::Kind::kList
                          ? ReadVector3(*sigma, kPositive)
                          : Eigen::Vector3d::Constant(ReadNumber(*sigma, kPositive));
  }
  reader.Read("rate_hz", &markers.rate_hz);
  reader.Read("missing_share", &markers.missing_share);
  reader.Finish();
  return markers;
}

/// An effect on what the scenario has not would never be seen, and never be missed.
void CheckEffectsFit(const Scenario& scenario) {
  for (const Effect& effect : scenario.effects) {
    const EffectKind& kind = *FindEffect(effect.id);
    const auto refuse = [&](const std::string& message) {
      throw InputError(effect.location, "effect '" + effect.id + "': " + message);
    };
    if (kind.side == Side::kCamera && !scenario.camera) refuse("the scenario has no camera");
    if (kind.place == Place::kMarker && !scenario.markers) refuse("the scenario has no markers");
    const auto from = effect.ranges.find("from_recording");
    if (from != effect.ranges.end() &&
        from->second[1] >= static_cast<double>(scenario.recordings.size())) {
      refuse("from_recording: the first recording is 0, the last " +
             std::to_string(scenario.recordings.size() - 1));
    }
  }
}

}  // namespace

const std::vector<ConfigNode>& ReadList(const ConfigNode& node, const std::string& of_what) {
  if (node.kind != ConfigNode::Kind::kList) Refuse(node, "must be a list of " + of_what);
  return node.items;
}

Scenario ReadScenario(const fs::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  MapReader reader(root, ScenarioKeys());
  Scenario scenario;
  scenario.file = file;
  reader.Read("name", &scenario.name);
  if (const ConfigNode* node = reader.Optional("body")) scenario.body = ReadBody(*node);
  if (const ConfigNode* node = reader.Optional("motion")) scenario.motion = ReadMotion(*node);
  if (const ConfigNode* node = reader.Optional("supply")) scenario.supply = ReadSupplies(*node);
  if (const ConfigNode* node = reader.Optional("effects")) scenario.effects = ReadEffects(*node);
  reader.Read("clutter", &scenario.clutter);
  if (const ConfigNode* node = reader.Optional("tools")) scenario.tools = ReadTools(*node);
  if (const ConfigNode* node = reader.Optional("camera")) {
    scenario.camera = ReadCameraSpec(*node, load);
  }
  if (const ConfigNode* node = reader.Optional("cameras")) {
    if (!scenario.camera) Refuse(*node, "goes with 'camera', the first one");
    scenario.further_cameras = ReadFurtherCameras(*node, load);
  }
  if (const ConfigNode* node = reader.Optional("stage")) scenario.stage = ReadStage(*node);
  if (const ConfigNode* node = reader.Optional("markers")) {
    scenario.markers = ReadMarkers(*node, scenario.camera.has_value());
  }
  reader.Read("rest_between_s", &scenario.rest_between_s);
  scenario.recordings = ReadRecordings(reader.Require("recordings"), scenario);
  reader.Finish();
  CheckEffectsFit(scenario);
  return scenario;
}

}  // namespace palpate::scenario
