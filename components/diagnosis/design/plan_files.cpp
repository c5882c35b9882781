// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/plan_files.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <system_error>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/experiment/recording_settings.hpp"
#include "libs/experiment/yaml_values.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::diagnosis {

namespace {

namespace fs = std::filesystem;
using experiment::ActuatorQuantity;
using experiment::Recording;

constexpr const char* kScenarioFile = "recording.scenario.yaml";
constexpr const char* kPlanFolder = "plan";
constexpr const char* kOthersFolder = "plan_others";

bool DrivesTensions(const Recording& recording) {
  if (!recording.actuation) return false;
  const auto& columns = recording.actuation->columns;
  return std::any_of(columns.begin(), columns.end(), [](const experiment::ActuatorColumn& column) {
    return column.quantity == ActuatorQuantity::kTension;
  });
}

std::string CommandRows(const experiment::Actuation& actuation) {
  std::string text = "    commands:\n";
  for (std::size_t row = 0; row < actuation.t_s.size(); ++row) {
    text += "      - {t_s: " + FormatNumber(actuation.t_s[row]);
    for (const experiment::ActuatorColumn& column : actuation.columns) {
      text += ", " + column.Header() + ": " + FormatNumber(column.samples[row].value());
    }
    text += "}\n";
  }
  return text;
}

/// libs/scenario/README.md, `recordings`.
std::string ScenarioText(const PlannedRecording& plan) {
  const Proposal& proposal = plan.ranked.proposal;
  const Recording& recording = proposal.recording;
  std::string text = "  - name: " + plan.name + "\n    kind: " + ToString(recording.kind) +
                     "\n    duration_s: " + FormatNumber(proposal.duration_s) + "\n";
  if (recording.actuation) text += CommandRows(*recording.actuation);
  if (proposal.weight) {
    const PlannedWeight& weight = *proposal.weight;
    text +=
        "    weights:\n      - {t_s: 0, position_m: " + geometry::FormatVector(weight.position_m) +
        ", mass_kg: " + FormatNumber(weight.mass_kg) +
        ", patch_radius_m: " + FormatNumber(weight.patch_radius_m) + "}\n";
  }
  if (recording.base_tilt_deg) {
    text += "    base_tilt_deg: " + geometry::FormatVector(*recording.base_tilt_deg) + "\n";
  }
  return text + "    notes: " + experiment::QuoteText(proposal.title) + "\n";
}

std::string Rounded(double value) { return FormatNumber(std::round(10.0 * value) / 10.0); }

std::string ByHandText(const PlannedRecording& plan) {
  const Proposal& proposal = plan.ranked.proposal;
  std::string text = "Next experiment: " + proposal.title + ".\n";
  text += "It separates " + plan.tells + ": expected ln Bayes factor " +
          Rounded(plan.ranked.expected_ln_bayes_factor) + " (3 is some, 10 clear evidence).\n\n";
  std::vector<std::string> steps = {"Leave camera, markers and actuators unchanged."};
  if (!proposal.by_hand.empty()) {
    std::string step = proposal.by_hand;
    step.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(step.front())));
    steps.push_back(step + ".");
  }
  steps.push_back("Let the robot rest with all commands at zero for " + Rounded(plan.rest_s) +
                  " s.");
  steps.push_back(
      proposal.recording.actuation
          ? "Actuate the cables as in actuation.csv (linear between rows; " +
                Rounded(proposal.duration_s) + " s) and record the same data as in the others."
          : "Record the same data as in the others for " + Rounded(proposal.duration_s) + " s.");
  steps.push_back(
      "Make the folder recordings/" + plan.name +
      " of the experiment from this one with markers.csv, or depth/ and camera.yaml, beside (and "
      "actuation.csv as the actuators report it, on the same clock), and run palpate diagnose "
      "again.");
  for (std::size_t k = 0; k < steps.size(); ++k) {
    text += std::to_string(k + 1) + ". " + steps[k] + "\n";
  }
  return text;
}

/// What somebody has put beside a plan stays, and its folder.
void RemoveOthers(const fs::path& folder) {
  std::error_code is_not_empty;
  std::error_code is_not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, is_not_there)) {
    if (!entry.is_directory()) continue;
    RemovePlan(entry);
    fs::remove(entry, is_not_empty);
  }
  fs::remove(folder, is_not_empty);
}

}  // namespace

std::string NextName(const experiment::Experiment& experiment, experiment::RecordingKind kind) {
  const std::string name = "next_" + ToString(kind);
  std::string last;
  for (const Recording& recording : experiment.recordings) last = std::max(last, recording.name);
  return name > last ? name : last + "_" + name;
}

void RemovePlan(const fs::path& folder) {
  std::error_code error;
  for (const char* name :
       {"recording.yaml", "actuation.csv", "loads.csv", "by_hand.txt", kScenarioFile}) {
    fs::remove(folder / name, error);
    if (error) throw RunError((folder / name).string() + ": cannot be removed: " + error.message());
  }
}

void WritePlans(const std::vector<PlannedRecording>& plans, const fs::path& folder) {
  RemovePlan(folder / kPlanFolder);
  RemoveOthers(folder / kOthersFolder);
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const std::string rank = (k < 9 ? "0" : "") + std::to_string(k + 1);
    WritePlan(plans[k], k == 0 ? folder / kPlanFolder : folder / kOthersFolder / rank);
  }
}

void WritePlan(const PlannedRecording& plan, const fs::path& folder) {
  experiment::CreateFolder(folder);
  RemovePlan(folder);
  Recording recording = plan.ranked.proposal.recording;
  recording.notes = plan.ranked.proposal.title;
  WriteFile(folder / "recording.yaml", experiment::FormatRecordingSettings(recording));
  if (recording.actuation) {
    experiment::WriteActuation(*recording.actuation, folder / "actuation.csv");
  }
  if (!recording.loads.empty()) experiment::WriteLoads(recording.loads, folder / "loads.csv");
  WriteFile(folder / "by_hand.txt", ByHandText(plan));
  if (!DrivesTensions(recording)) WriteFile(folder / kScenarioFile, ScenarioText(plan));
}

}  // namespace palpate::diagnosis
