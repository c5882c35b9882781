// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/force_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <utility>

#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/palpate/compare/force_comparison.hpp"
#include "components/palpate/compare/status_word.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/force_table.hpp"
#include "libs/experiment/loads.hpp"

namespace palpate::command {

namespace {

using force_estimation::ContactForce;
using force_estimation::ForceEstimate;

constexpr double kNotInFile = std::numeric_limits<double>::quiet_NaN();

ContactForce Contact(const std::string& name, const Eigen::Vector3d& position_m,
                     const Eigen::Vector3d& force_N) {
  ContactForce contact;
  contact.status = Status::Ok();
  contact.name = name;
  contact.position_m = position_m;
  contact.force_N = force_N;
  contact.covariance_N2.setConstant(kNotInFile);
  contact.location_covariance_m2.setConstant(kNotInFile);
  contact.ci95_N = contact.location_ci95_m = kNotInFile;
  return contact;
}

ForceEstimate Frame(double t_s, std::vector<ContactForce> contacts) {
  ForceEstimate frame;
  frame.t_s = t_s;
  frame.status = contacts.empty() ? Status(StatusCode::kNoContact, {}) : Status::Ok();
  frame.contacts = std::move(contacts);
  return frame;
}

StatusCode CodeOf(const experiment::TabledForce& row) {
  const auto code = StatusOfWord(row.status);
  if (code) return *code;
  throw InputError(row.where, "status '" + row.status + "' is none of " + StatusWords());
}

/// Without an interval it follows from the covariance.
ContactForce ContactOf(const experiment::TabledForce& row) {
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(kNotInFile);
  ContactForce contact =
      Contact(row.contact, row.position_m.value_or(unknown), row.force_N.value_or(unknown));
  const StatusCode code = CodeOf(row);
  contact.status = Status(row.force_N ? code : StatusCode::kUnobservable, {});
  contact.location_ci95_m = row.location_ci95_m.value_or(kNotInFile);
  if (row.covariance_N2) contact.covariance_N2 = *row.covariance_N2;
  if (row.location_covariance_m2) contact.location_covariance_m2 = *row.location_covariance_m2;
  if (row.ci95_N) {
    contact.ci95_N = *row.ci95_N;
  } else if (row.covariance_N2 && row.force_N) {
    contact.ci95_N = force_estimation::HalfWidth95_N(contact.force_N, contact.covariance_N2);
  }
  return contact;
}

ForceFile ReadTable(const std::filesystem::path& file) {
  experiment::ForceTable table = experiment::ReadForceTable(file);
  ForceFile forces;
  forces.unused_columns = std::move(table.unused);
  for (const experiment::TabledForce& row : table.rows) {
    auto& frames = forces.of_recording[row.recording];
    if (frames.empty() || row.t_s > frames.back().t_s) frames.push_back(Frame(row.t_s, {}));
    ForceEstimate& frame = frames.back();
    if (row.contact.empty()) {
      frame.status = Status(CodeOf(row), {});
      forces.has_frames_without_contact = true;
    } else {
      frame.status = Status::Ok();
      frame.contacts.push_back(ContactOf(row));
    }
  }
  return forces;
}

ForceFile ReadLoadFrames(const std::filesystem::path& file) {
  const std::vector<experiment::KnownLoad> loads = experiment::ReadLoads(file);
  ForceFile forces;
  forces.kind = ForceFile::Kind::kLoads;
  std::vector<ForceEstimate>& frames = forces.of_recording[""];
  for (const experiment::KnownLoad& load : loads) {
    if (!frames.empty() && frames.back().t_s == load.t_s) continue;
    frames.push_back(Frame(load.t_s, {}));
    std::vector<ContactForce> contacts;
    const auto acting = experiment::LoadsAt(loads, load.t_s);
    for (const auto& site : force_estimation::SitesOfLoads(loads, load.t_s)) {
      for (const experiment::KnownLoad& other : acting) {
        if (other.position_m != site.position_m) continue;
        contacts.push_back(Contact(site.name, site.position_m, other.force_N));
      }
    }
    forces.has_frames_without_contact = forces.has_frames_without_contact || contacts.empty();
    frames.back() = Frame(load.t_s, std::move(contacts));
  }
  return forces;
}

bool BeginsAsJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return (stream >> std::ws).peek() == '{';
}

/// Whether the columns are those of loads.csv, and no others.
bool HasLoads(const std::filesystem::path& file) {
  static const std::set<std::string> kColumns = {"t_s",  "x_m",  "y_m",  "z_m",
                                                 "fx_N", "fy_N", "fz_N", "patch_radius_m"};
  const std::vector<std::string> header = experiment::CsvTable::Read(file).header();
  return std::all_of(header.begin(), header.end(),
                     [](const std::string& name) { return kColumns.contains(name); });
}

}  // namespace

ForceFile ReadAnswerForces(const std::filesystem::path& answer) {
  ForceFile forces;
  forces.kind = ForceFile::Kind::kAnswer;
  forces.has_frames_without_contact = true;
  for (const RecordingTruth& recording : ReadRecordingTruths(answer)) {
    std::vector<ForceEstimate>& frames = forces.of_recording[recording.name];
    for (const TrueForces& frame : recording.frames) {
      std::vector<ContactForce> contacts;
      for (const virtual_robot::TrueForce& force : frame.forces) {
        contacts.push_back(Contact(force.name, force.position_m, force.force_N));
      }
      frames.push_back(Frame(frame.t_s, std::move(contacts)));
    }
  }
  return forces;
}

ForceFile ReadForceFile(const std::filesystem::path& file) {
  ForceFile forces;
  if (BeginsAsJson(file)) {
    forces = ReadAnswerForces(file);
  } else {
    forces = HasLoads(file) ? ReadLoadFrames(file) : ReadTable(file);
  }
  const bool empty = std::all_of(forces.of_recording.begin(), forces.of_recording.end(),
                                 [](const auto& named) { return named.second.empty(); });
  if (empty) throw InputError(SourceLocation{file.string()}, "has no row");
  return forces;
}

TruthTimeline TruthOf(const ForceFile& file, const std::string& recording, TruthTiming timing) {
  const auto found = file.of_recording.find(recording);
  if (found == file.of_recording.end()) return TruthTimeline(timing);
  timing.holds = file.kind == ForceFile::Kind::kLoads || found->second.size() == 1;
  TruthTimeline truth(timing);
  for (const ForceEstimate& frame : found->second) {
    if (!HasResult(frame.status)) continue;
    std::vector<TrueContact> contacts;
    for (const ContactForce& contact : frame.contacts) {
      if (HasForce(contact))
        contacts.push_back({contact.name, contact.position_m, contact.force_N});
    }
    truth.Add(frame.t_s, std::move(contacts));
  }
  return truth;
}

}  // namespace palpate::command
