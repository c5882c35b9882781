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

const std::vector<std::string> kMaterialModels = {
    "linear", "corotational", "neo_hookean", "st_venant_kirchhoff", "yeoh", "stable_neo_hookean"};
constexpr NumberRule kPoissonRule{.min = 0.0, .max = 0.4999};
constexpr NumberRule kRateRule{.min = 0.0, .max = 1000.0, .min_open = true};
constexpr NumberRule kTimeStepRule{.min = 0.0, .max = 1.0, .min_open = true};

void ReadMaterial(const ConfigNode& node, BodyTruth* body) {
  MapReader reader(node);
  if (const ConfigNode* model = reader.Optional("model")) {
    body->material_model = ReadChoice(*model, kMaterialModels);
  }
  if (const ConfigNode* modulus = reader.Optional("youngs_modulus_Pa")) {
    body->youngs_modulus_Pa = ReadNumber(*modulus, kPositive);
  }
  if (const ConfigNode* ratio = reader.Optional("poissons_ratio")) {
    body->poissons_ratio = ReadNumber(*ratio, kPoissonRule);
  }
  if (body->material_model == "yeoh") {
    body->c20_over_c10 = reader.Number("c20_over_c10", 0.0);
    body->c30_over_c10 = reader.Number("c30_over_c10", 0.0);
  } else if (node.Find("c20_over_c10") != nullptr || node.Find("c30_over_c10") != nullptr) {
    Refuse(node, "c20_over_c10 and c30_over_c10 go with 'model: yeoh'");
  }
  reader.Finish();
}

std::vector<PronyTerm> ReadProny(const ConfigNode& node) {
  std::vector<PronyTerm> terms;
  for (const ConfigNode& item : ReadList(node, "{g, tau_s}")) {
    MapReader reader(item);
    PronyTerm term;
    term.g = ReadNumber(reader.Require("g"), kPositive);
    term.tau_s = ReadNumber(reader.Require("tau_s"), kPositive);
    reader.Finish();
    terms.push_back(term);
  }
  return terms;
}

BodyTruth ReadBody(const ConfigNode& node, const fs::path& folder) {
  MapReader reader(node);
  BodyTruth body;
  if (const ConfigNode* file = reader.Optional("mesh_file")) {
    body.mesh_file = (folder / ReadText(*file)).lexically_normal();
    if (!fs::is_regular_file(body.mesh_file)) {
      Refuse(*file, "there is no file " + body.mesh_file.string());
    }
  }
  if (const ConfigNode* refine = reader.Optional("refine"))
    body.refine = ReadInteger(*refine, 0, 2);
  if (const ConfigNode* element = reader.Optional("element")) {
    body.element = ReadChoice(*element, {"tet4", "tet10"});
  }
  if (const ConfigNode* material = reader.Optional("material")) ReadMaterial(*material, &body);
  if (const ConfigNode* prony = reader.Optional("prony")) body.prony = ReadProny(*prony);
  reader.Finish();
  return body;
}

Motion ReadMotion(const ConfigNode& node) {
  MapReader reader(node);
  Motion motion;
  if (const ConfigNode* mode = reader.Optional("mode")) {
    motion.mode = ReadChoice(*mode, {"quasi_static", "dynamic"}) == "dynamic"
                      ? MotionMode::kDynamic
                      : MotionMode::kQuasiStatic;
  }
  motion.time_step_s = reader.Number("time_step_s", motion.time_step_s, kTimeStepRule);
  motion.rayleigh_mass_1_s =
      reader.Number("rayleigh_mass_1_s", motion.rayleigh_mass_1_s, kNonNegative);
  motion.rayleigh_stiffness_s =
      reader.Number("rayleigh_stiffness_s", motion.rayleigh_stiffness_s, kNonNegative);
  reader.Finish();
  return motion;
}

/// `camera`: whether the scenario has one.
MarkerSpec ReadMarkers(const ConfigNode& node, bool camera) {
  MapReader reader(node);
  MarkerSpec markers;
  if (const ConfigNode* frame = reader.Optional("frame")) {
    markers.by_depth_camera = ReadChoice(*frame, {"camera"}) == "camera";
    if (!camera) Refuse(*frame, "the scenario has no camera that could measure them");
  }
  if (const ConfigNode* sigma = reader.Optional("sigma_m")) {
    markers.sigma_m = sigma->kind == ConfigNode::Kind::kList
                          ? ReadVector3(*sigma, kPositive)
                          : Eigen::Vector3d::Constant(ReadNumber(*sigma, kPositive));
  }
  markers.rate_hz = reader.Number("rate_hz", markers.rate_hz, kRateRule);
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

Eigen::Vector3d ReadColor(const ConfigNode& node) {
  return ReadVector3(node, {.min = 0.0, .max = 1.0});
}

Scenario ReadScenario(const fs::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  const fs::path folder = file.parent_path();
  MapReader reader(root);
  Scenario scenario;
  scenario.file = file;
  scenario.name = ReadText(reader.Require("name"));
  if (const ConfigNode* node = reader.Optional("body")) scenario.body = ReadBody(*node, folder);
  if (const ConfigNode* node = reader.Optional("motion")) scenario.motion = ReadMotion(*node);
  if (const ConfigNode* node = reader.Optional("effects")) scenario.effects = ReadEffects(*node);
  scenario.clutter = reader.Number("clutter", 0.0, {.min = 0.0, .max = 10.0});
  if (const ConfigNode* node = reader.Optional("tools")) scenario.tools = ReadTools(*node);
  if (const ConfigNode* node = reader.Optional("camera")) {
    scenario.camera = ReadCameraSpec(*node, folder, load);
  }
  if (const ConfigNode* node = reader.Optional("stage")) scenario.stage = ReadStage(*node);
  if (const ConfigNode* node = reader.Optional("markers")) {
    scenario.markers = ReadMarkers(*node, scenario.camera.has_value());
  }
  scenario.rest_between_s = reader.Number("rest_between_s", scenario.rest_between_s, kNonNegative);
  scenario.recordings = ReadRecordings(reader.Require("recordings"), scenario);
  reader.Finish();
  CheckEffectsFit(scenario);
  return scenario;
}

}  // namespace palpate::scenario
