// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/phase_plan.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/recording_settings.hpp"

namespace palpate::offline {

namespace {

namespace fs = std::filesystem;

/// The keys of recording.yaml, the name and the stretch.
const KeyTable& PhaseKeys() {
  static const KeyTable keys = [] {
    KeyTable table{.title = "phase",
                   .about =
                       "A stretch that becomes one recording: the keys of recording.yaml, and "
                       "these.",
                   .keys = experiment::RecordingKeys().keys};
    table.keys.push_back({"name", value::Text(), kRequired, "Name of the recording."});
    table.keys.push_back({"window_s", value::Numbers({}, 2, 2), kOptional,
                          "`[begin, end]` on the clock of `t_s`, begin < end. Absent: all, or the "
                          "played recording of that name."});
    return table;
  }();
  return keys;
}

const KeyTable& CableKeys() {
  static const KeyTable keys{
      .title = "cables of joints",
      .about = "Which cable each joint of the joint states pulls.",
      .open_keys = {{"<joint>", value::Text(), kOptional, "Name of the cable."}}};
  return keys;
}

/// The rest of a map, without some of its keys, as a file of its own.
ConfigNode Without(const ConfigNode& node, const std::vector<std::string>& names) {
  ConfigNode rest = node;
  std::erase_if(rest.entries, [&](const ConfigEntry& entry) {
    return std::find(names.begin(), names.end(), entry.key) != names.end();
  });
  return rest;
}

Phase ReadPhase(const ConfigNode& node, const fs::path& file) {
  MapReader reader(node, PhaseKeys());
  for (const Key& key : PhaseKeys().keys) reader.Optional(key.name);
  reader.Finish();
  Phase phase;
  const ConfigNode rest = Without(node, {"name", "window_s"});
  experiment::ReadRecordingSettings(
      file, [&](const fs::path&) { return rest; }, phase.recording);
  phase.recording.name = ReadText(reader.Require("name"));
  const bool plain = !phase.recording.name.empty() && phase.recording.name.front() != '.' &&
                     phase.recording.name.find_first_of("/\\") == std::string::npos;
  if (!plain) Refuse(reader.Require("name"), "must be the name of a folder");
  const ConfigNode* window = reader.Optional("window_s");
  if (window == nullptr) return phase;
  const std::vector<double> limits_s = ReadNumbers(*window);
  if (limits_s.size() != 2 || limits_s[0] >= limits_s[1]) {
    Refuse(*window, "must be [begin, end] with begin < end");
  }
  phase.begin_ns = std::llround(limits_s[0] * 1e9);
  phase.end_ns = std::llround(limits_s[1] * 1e9);
  return phase;
}

std::vector<Phase> ReadPhases(const ConfigNode& node, const fs::path& file) {
  std::vector<Phase> phases;
  for (const ConfigNode& item : node.items) {
    phases.push_back(ReadPhase(item, file));
    if (phases.size() < 2) continue;
    const Phase& before = phases[phases.size() - 2];
    const bool have_windows =
        phases.back().begin_ns != Phase{}.begin_ns && before.end_ns != Phase{}.end_ns;
    if (have_windows && phases.back().begin_ns < before.end_ns) {
      Refuse(item, "begins before the one above ends");
    }
    if (phases.back().recording.name <= before.recording.name) {
      Refuse(item, "name '" + phases.back().recording.name + "' must come after '" +
                       before.recording.name +
                       "' in the alphabet: recordings were made in the order of their names");
    }
  }
  return phases;
}

}  // namespace

const KeyTable& PhaseFileKeys() {
  static const KeyTable keys{
      .title = "file of phases",
      .about = "What the topics of a recording do not say.",
      .keys = {{"experiment", value::Map(experiment::ExperimentKeys()), kOptional,
                "Keys of experiment.yaml. They win over what the topics say."},
               {"robot_frame", value::Text(), kOptional,
                "Frame in /tf that is fixed to the robot's base. Absent: `robot`."},
               {"load_point_m", value::Vector3(), kOptional,
                "Point of the undeformed body on which the wrenches act, robot frame."},
               {"cables", value::Map(CableKeys()), kOptional,
                "The cables that joints pull. Other joints are left out. Absent: joints have the "
                "names of cables."},
               {"phases", value::ListOfMaps(PhaseKeys()), kOptional,
                "Recordings, in the order of time. Absent: those of the topics."}}};
  return keys;
}

fs::path PhaseFileOf(const fs::path& target) {
  std::error_code error;
  if (fs::is_directory(target, error)) return target / "phases.yaml";
  fs::path file = target;
  return file.replace_extension(".phases.yaml");
}

std::optional<PhaseFile> ReadPhaseFile(const fs::path& target, const ConfigLoader& load) {
  PhaseFile phases;
  phases.file = PhaseFileOf(target);
  if (!fs::exists(phases.file)) return std::nullopt;
  const ConfigNode root = load(phases.file);
  MapReader reader(root, PhaseFileKeys());
  if (const ConfigNode* node = reader.Optional("experiment")) {
    phases.experiment =
        experiment::ReadExperimentSettings(phases.file, [&](const fs::path&) { return *node; });
  }
  if (const ConfigNode* node = reader.Optional("robot_frame")) {
    phases.robot_frame = ReadText(*node);
  }
  if (const ConfigNode* node = reader.Optional("load_point_m")) {
    phases.load_point_m = ReadVector3(*node);
  }
  if (const ConfigNode* node = reader.Optional("cables")) {
    if (node->kind != ConfigNode::Kind::kMap) Refuse(*node, "must be a map {JOINT: CABLE}");
    for (const ConfigEntry& entry : node->entries) phases.cables[entry.key] = ReadText(entry.value);
  }
  if (const ConfigNode* node = reader.Optional("phases")) {
    phases.phases = ReadPhases(*node, phases.file);
  }
  reader.Finish();
  return phases;
}

std::optional<experiment::Recording> ParsePhase(const std::string& text) {
  std::istringstream words(text);
  std::string kind;
  experiment::Recording recording;
  words >> kind >> recording.name;
  if (kind.empty() || kind == "end") return std::nullopt;
  recording.kind = experiment::ParseRecordingKind(kind, SourceLocation{"/experiment/phase"});
  return recording;
}

}  // namespace palpate::offline
