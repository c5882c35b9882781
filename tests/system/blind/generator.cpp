// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/generator.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"
#include "tests/system/blind/coarse_robot.hpp"
#include "tests/system/blind/picture_camera.hpp"
#include "tests/system/blind/rod_meshes.hpp"
#include "tests/system/process.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;
using scenario::ActiveEffect;

const std::string kNoEffects = "effects: []";
const std::string kRodsBody = "mesh_file: rod_coarse.msh";
const std::string kRodsRate = "rate_hz: 5";

/// `from` is there.
std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  PALPATE_CHECK(begin != std::string::npos, from);
  return text.replace(begin, from.size(), to);
}

std::string ListOf(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + Quoted(word);
  return words.size() == 1 ? text : "[" + text + "]";
}

std::string EffectText(const ActiveEffect& effect) {
  std::string text = "{id: " + effect.id + ", where: " + ListOf(effect.where);
  for (const auto& [name, value] : effect.parameters) {
    text += ", " + name + ": " + FormatNumber(value);
  }
  return text + "}";
}

std::string WithPictures(std::string scenario) {
  const std::size_t begin = scenario.find("markers:");
  PALPATE_CHECK(begin != std::string::npos);
  const std::size_t end = scenario.find('\n', begin) + 1;
  return scenario.replace(begin, end - begin, kPictureCamera + "  rate_hz: 2.5\n");
}

double LargestRms(const std::map<std::string, Eigen::VectorXd>& with,
                  const std::map<std::string, Eigen::VectorXd>& without) {
  double largest_m = 0.0;
  for (const auto& [recording, coordinates_m] : with) {
    const Eigen::VectorXd difference_m = coordinates_m - without.at(recording);
    const double mean_m2 = difference_m.squaredNorm() / static_cast<double>(difference_m.size());
    largest_m = std::max(largest_m, std::sqrt(mean_m2));
  }
  return largest_m;
}

}  // namespace

std::string WithRecordings(const std::string& scenario, const std::set<std::string>& names) {
  const std::string item = "  - name: ";
  std::size_t begin = scenario.find(item);
  std::string kept = scenario.substr(0, begin);
  while (begin != std::string::npos) {
    const std::size_t end = scenario.find(item, begin + 1);
    const std::size_t name = begin + item.size();
    if (names.contains(scenario.substr(name, scenario.find('\n', name) - name)))
      kept += scenario.substr(begin, end - begin);
    begin = end;
  }
  return kept;
}

Generator::Generator(fs::path robot_file, fs::path folder, Measured measured)
    : robot_file_{std::move(robot_file)}, folder_{std::move(folder)}, measured_{measured} {
  const fs::path scenarios = fs::path(PALPATE_SOURCE_DIR) / "config/scenarios";
  const std::string robot = robot_file_.stem().string();
  const std::string scenario = robot == "four_leg" ? "diagnose" : "diagnose_" + robot;
  const fs::path file = scenarios / (scenario + ".yaml");
  scenario_text_ = ReadFile(fs::exists(file) ? file : scenarios / "diagnose.yaml");
  PALPATE_CHECK(scenario_text_.find(kNoEffects) != std::string::npos);
  // A finer rod takes long, and of five rows a second not a half are compared.
  if (robot == "rod") scenario_text_ = Replaced(scenario_text_, kRodsRate, "rate_hz: 2");
  if (IsCoarse(robot)) scenario_text_ = CoarseScenario(scenario_text_);
  for (const fs::path& mesh :
       {scenarios / "four_leg_coarse.msh", scenarios / "rod_coarse.msh",
        scenarios / "pneumatic_finger_coarse.msh", scenarios / "pneumatic_arm_coarse.msh",
        fs::path(PALPATE_SOURCE_DIR) / "config/robots/rod.msh"}) {
    fs::copy_file(mesh, folder_ / mesh.filename(), fs::copy_options::overwrite_existing);
  }
}

void Generator::Keep(const std::set<std::string>& recordings) {
  scenario_text_ = WithRecordings(scenario_text_, recordings);
}

void Generator::Make(const std::vector<ActiveEffect>& effects, std::uint64_t seed,
                     const fs::path& experiment, const fs::path& answer,
                     const std::string& further) const {
  const std::string all = scenario_text_ + further;
  MakeFrom(measured_ == Measured::kPictures ? WithPictures(all) : all, effects, seed, experiment,
           answer);
}

void Generator::MakeFrom(const std::string& scenario_text, const std::vector<ActiveEffect>& effects,
                         std::uint64_t seed, const fs::path& experiment,
                         const fs::path& answer) const {
  std::string list;
  for (const ActiveEffect& effect : effects)
    list += (list.empty() ? "" : ", ") + EffectText(effect);
  std::string text = Replaced(scenario_text, kNoEffects, "effects: [" + list + "]");
  if (robot_file_.stem() == "rod")
    text = Replaced(text, kRodsBody, "mesh_file: " + MeshesOfRod(seed).body);
  const std::string name = experiment.filename().string();
  const fs::path scenario = folder_ / (name + ".scenario.yaml");
  const fs::path log = folder_ / (name + ".simulate.log");
  WriteFile(scenario, text);
  std::vector<std::string> arguments = {
      "simulate", robot_file_.string(), "--scenario", scenario.string(),
      "--seed",   std::to_string(seed), "--out",      experiment.string(),
      "--answer", answer.string()};
  const bool takes_pictures = scenario_text.find(kPictureCamera) != std::string::npos;
  if (takes_pictures) arguments.emplace_back("--tell-camera-pose");
  const auto done = system_test::RunProgram("palpate", arguments, log);
  if (done != 0) throw RunError("palpate simulate: " + ReadFile(log));
}

std::vector<double> Generator::EffectSizes_m(const std::vector<ActiveEffect>& effects,
                                             std::uint64_t seed, const fs::path& experiment) const {
  if (effects.empty()) return {};
  const std::string named = experiment.filename().string();
  fs::path with = experiment;
  if (measured_ == Measured::kPictures) {
    with = folder_ / (named + "_with_markers");
    MakeFrom(scenario_text_, effects, seed, with, folder_ / (named + "_with_markers.answer.json"));
  }
  const auto with_m = MarkerCoordinates_m(with);
  std::vector<double> sizes_m;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const std::string name = named + "_without_" + std::to_string(i);
    const fs::path other = folder_ / name;
    const fs::path answer = folder_ / (name + ".answer.json");
    MakeFrom(scenario_text_, WithoutEffect(effects, i), seed, other, answer);
    sizes_m.push_back(LargestRms(with_m, MarkerCoordinates_m(other)));
    fs::remove_all(other);
    fs::remove(answer);
  }
  return sizes_m;
}

std::vector<ActiveEffect> WithoutEffect(std::vector<ActiveEffect> effects, std::size_t index) {
  const auto* kind = scenario::FindEffect(effects.at(index).id);
  PALPATE_CHECK(kind != nullptr, effects[index].id);
  bool has_clutter = false;
  for (const scenario::EffectParameter& parameter : kind->parameters) {
    PALPATE_CHECK(std::isfinite(parameter.healthy), kind->id, "has no nominal value of its own");
    has_clutter = has_clutter || parameter.tolerance > 0.0;
    effects[index].parameters[std::string(parameter.name)] = parameter.healthy;
  }
  if (!has_clutter) effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(index));
  return effects;
}

std::map<std::string, Eigen::VectorXd> MarkerCoordinates_m(const fs::path& experiment) {
  std::map<std::string, Eigen::VectorXd> coordinates_m;
  for (const auto& recording : experiment::ReadExperiment(experiment, app::LoadYaml).recordings) {
    std::vector<double> values_m;
    for (const auto& frame : recording.markers.value().frames) {
      for (const auto& position_m : frame.positions_m) {
        values_m.insert(values_m.end(), position_m->begin(), position_m->end());
      }
    }
    coordinates_m[recording.name] = Eigen::Map<const Eigen::VectorXd>(
        values_m.data(), static_cast<Eigen::Index>(values_m.size()));
  }
  return coordinates_m;
}

}  // namespace palpate::blind
