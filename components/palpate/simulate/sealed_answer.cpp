// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/sealed_answer.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kFormat = "palpate-answer-1";

OrderedJson ToJson(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

OrderedJson ToJson(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  return {{"translation_m", ToJson(Eigen::Vector3d(pose.translation()))},
          {"rotation_xyzw", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}}};
}

OrderedJson ToJson(const scenario::ActiveEffect& effect) {
  OrderedJson parameters = OrderedJson::object();
  for (const auto& [name, value] : effect.parameters) parameters[name] = value;
  return {{"id", effect.id}, {"where", effect.where}, {"parameters", parameters}};
}

OrderedJson ToJson(const TrueForces& frame) {
  OrderedJson forces = OrderedJson::array();
  for (const virtual_robot::TrueForce& force : frame.forces) {
    forces.push_back({{"name", force.name},
                      {"position_m", ToJson(force.position_m)},
                      {"rest_position_m", ToJson(force.rest_position_m)},
                      {"force_N", ToJson(force.force_N)}});
  }
  return {{"t_s", frame.t_s}, {"forces", forces}};
}

OrderedJson ToJson(const RecordingTruth& recording, bool camera) {
  OrderedJson json = {{"name", recording.name}};
  if (camera) json["T_robot_camera"] = ToJson(recording.T_robot_camera);
  json["frames"] = OrderedJson::array();
  for (const TrueForces& frame : recording.frames) json["frames"].push_back(ToJson(frame));
  return json;
}

/// The effects of the scenario, or the manufacturing tolerances (`clutter`) of every robot.
OrderedJson EffectsOf(const Answer& answer, bool clutter) {
  OrderedJson effects = OrderedJson::array();
  for (const scenario::ActiveEffect& effect : answer.effects) {
    if (effect.clutter == clutter) effects.push_back(ToJson(effect));
  }
  return effects;
}

Eigen::Vector3d ToVector(const OrderedJson& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

TrueForces ToTrueForces(const OrderedJson& json) {
  TrueForces frame{json.at("t_s").get<double>(), {}};
  for (const OrderedJson& force : json.at("forces")) {
    virtual_robot::TrueForce& truth = frame.forces.emplace_back();
    truth.name = force.at("name").get<std::string>();
    truth.position_m = ToVector(force.at("position_m"));
    truth.rest_position_m = ToVector(force.at("rest_position_m"));
    truth.force_N = ToVector(force.at("force_N"));
  }
  return frame;
}

}  // namespace

std::string NewSalt() {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::random_device device;
  std::string salt;
  for (int i = 0; i < 64; ++i) salt += kHex[device() % 16];
  return salt;
}

std::string FormatAnswer(const Answer& answer) {
  OrderedJson json = {{"format", kFormat},
                      {"salt", answer.salt},
                      {"palpate", answer.version},
                      {"seed", answer.seed},
                      {"robot", {{"name", answer.robot}, {"sha256", answer.robot_sha256}}},
                      {"scenario", {{"name", answer.scenario}, {"sha256", answer.scenario_sha256}}},
                      {"data_sha256", answer.data_sha256},
                      {"mesh_hash", answer.mesh_hash},
                      {"effects", EffectsOf(answer, false)},
                      {"clutter", EffectsOf(answer, true)}};
  json["recordings"] = OrderedJson::array();
  for (const RecordingTruth& recording : answer.recordings) {
    json["recordings"].push_back(ToJson(recording, answer.camera));
  }
  return json.dump(1) + "\n";
}

std::vector<RecordingTruth> ReadRecordingTruths(const fs::path& answer) {
  std::vector<RecordingTruth> recordings;
  try {
    const OrderedJson json = OrderedJson::parse(ReadFile(answer));
    for (const OrderedJson& recording : json.at("recordings")) {
      RecordingTruth& truth = recordings.emplace_back();
      truth.name = recording.at("name").get<std::string>();
      for (const OrderedJson& frame : recording.at("frames")) {
        truth.frames.push_back(ToTrueForces(frame));
      }
    }
  } catch (const OrderedJson::exception& error) {
    throw InputError(
        SourceLocation{answer.string()},
        "is not a ground truth of palpate simulate (EXP.answer.json): " + Excerpt(error.what()));
  }
  return recordings;
}

std::string HashOfData(const fs::path& experiment) {
  std::vector<fs::path> files;
  const fs::path recordings = experiment / "recordings";
  std::error_code error;
  for (fs::recursive_directory_iterator entry(recordings, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_regular_file()) files.push_back(entry->path().lexically_relative(recordings));
  }
  if (error) {
    throw InputError(SourceLocation{recordings.string()}, "cannot be read: " + error.message());
  }
  std::sort(files.begin(), files.end());
  std::string digests;
  for (const fs::path& file : files) {
    digests += Sha256Hex(ReadFile(recordings / file)) + "  " + file.generic_string() + "\n";
  }
  return Sha256Hex(digests);
}

fs::path AnswerBeside(const fs::path& experiment) {
  fs::path whole = experiment.lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  whole += ".answer.json";
  return whole;
}

void CheckSeal(const fs::path& experiment, const fs::path& answer) {
  const fs::path settings = experiment / "experiment.yaml";
  const auto seal = experiment::ReadExperimentSettings(settings, app::LoadYaml).answer_sha256;
  if (!seal) {
    throw InputError(SourceLocation{settings.string()},
                     "has no key 'answer_sha256': no ground truth was stored with it");
  }
  const std::string bytes = ReadFile(answer);
  if (Sha256Hex(bytes) != *seal) {
    throw RunError(answer.string() + ": its hash differs from answer_sha256 in " +
                   settings.string());
  }
  const OrderedJson json = OrderedJson::parse(bytes, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("format", "") != kFormat) {
    throw RunError(answer.string() + ": is not a ground truth of palpate simulate (format " +
                   kFormat + ")");
  }
  if (json.value("data_sha256", "") != HashOfData(experiment)) {
    throw RunError(experiment.string() +
                   ": the recordings have changed since the ground truth was stored");
  }
}

}  // namespace palpate::command
