// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/machine_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace palpate::command {

namespace {

constexpr double kDay_s = 86400.0;
constexpr double kGB = 1e9;
/// Depth and colour of 848 x 480 pixels, 30 times a second.
constexpr double kRawImages_B_s = 61e6;

}  // namespace

Check CheckProcessor(const ProcessorFacts& facts) {
  Check check{.name = "processor",
              .grade = Grade::kOk,
              .finding = fmt::format("{} kernels, {} threads", ToString(facts.best), facts.threads),
              .remedy = {}};
  if (!facts.blas_core.empty()) check.finding += ", OPENBLAS_CORETYPE=" + facts.blas_core;
  const auto warn = [&](const std::string& finding, const std::string& remedy) {
    check.grade = Grade::kWarning;
    check.finding += ", " + finding;
    check.remedy = remedy;
  };
  if (facts.best == InstructionSet::kPortable) {
    warn("no AVX2: the solver runs at a third of its speed or less", "take a processor with AVX2");
  } else if (facts.threads < 2) {
    warn("images and forces share one core", "give the machine two cores or more");
  } else if (facts.thread_limit == "1") {
    warn("OMP_NUM_THREADS=1", "unset OMP_NUM_THREADS");
  } else if (facts.governor == "powersave" || facts.governor == "conservative") {
    warn("clock governor " + facts.governor, "sudo cpupower frequency-set -g performance");
  }
  return check;
}

Check CheckDisk(const DiskFacts& facts) {
  Check check{.name = "disk", .grade = Grade::kOk, .finding = {}, .remedy = {}};
  if (!facts.free_B) {
    check.grade = Grade::kWarning;
    check.finding = facts.folder.string() + ": the free space cannot be read";
    return check;
  }
  const auto free_B = static_cast<double>(*facts.free_B);
  check.finding = fmt::format("{:.1f} GB free in {}: {:.0f} min of raw images", free_B / kGB,
                              facts.folder.string(), free_B / kRawImages_B_s / 60.0);
  if (free_B < kGB) {
    check.grade = Grade::kFailure;
  } else if (free_B < 10 * kGB) {
    check.grade = Grade::kWarning;
  }
  if (check.grade != Grade::kOk) {
    check.remedy = "record elsewhere: palpate record --out FOLDER/run.mcap";
  }
  return check;
}

Check CheckSecurity(const SecurityFacts& facts) {
  Check check{.name = "security", .grade = Grade::kOk, .finding = {}, .remedy = {}};
  const auto result = [&](Grade grade, const std::string& finding, const std::string& remedy) {
    check.grade = grade;
    check.finding = finding;
    check.remedy = remedy;
    return check;
  };
  if (facts.folder.empty()) {
    return facts.is_on
               ? result(Grade::kWarning, "on, its files were not checked",
                        "palpate doctor --security FOLDER")
               : result(Grade::kOk, "off: any process of the network may read and write", {});
  }
  const std::string folder = facts.folder.string();
  if (!facts.trouble.empty()) {
    return result(Grade::kFailure, facts.trouble, "palpate security init --help");
  }
  std::vector<security::Finding> findings = facts.state.findings;
  const IdentityState* first = nullptr;
  for (const IdentityState& identity : facts.state.identities) {
    findings.insert(findings.end(), identity.findings.begin(), identity.findings.end());
    if (first == nullptr || identity.end_s < first->end_s) first = &identity;
  }
  std::stable_sort(findings.begin(), findings.end(), [](const auto& a, const auto& b) {
    return a.severity == Severity::kError && b.severity != Severity::kError;
  });
  if (!findings.empty()) {
    const security::Finding& worst = findings.front();
    return result(worst.severity == Severity::kError ? Grade::kFailure : Grade::kWarning,
                  worst.file.string() + " " + worst.problem, worst.remedy);
  }
  const double days = static_cast<double>(first->end_s - facts.now_s) / kDay_s;
  return result(Grade::kOk,
                fmt::format("{} identities in {}, the first one, {}, ends in {:.0f} days",
                            facts.state.identities.size(), folder, first->name, days),
                {});
}

Check CheckCameras(const std::vector<CameraFacts>& cameras, bool needed) {
  Check check{.name = "camera", .grade = Grade::kOk, .finding = {}, .remedy = {}};
  if (cameras.empty()) {
    check.grade = needed ? Grade::kFailure : Grade::kOk;
    check.finding = "no GenICam camera answers";
    if (needed) {
      check.remedy =
          "check cable and power, then palpate capture --list ADDRESS for one outside "
          "this network";
    }
    return check;
  }
  constexpr int kJumbo_B = 8000;
  for (const CameraFacts& camera : cameras) {
    if (!check.finding.empty()) check.finding += ", ";
    check.finding += camera.model + " at " + camera.address;
    if (!camera.trouble.empty()) {
      check.finding += " (" + camera.trouble + ")";
      check.grade = Grade::kWarning;
    }
    if (camera.mtu_B == 0) continue;
    check.finding += fmt::format(", packets up to {} B on {}", camera.mtu_B, camera.interface);
    if (camera.mtu_B < kJumbo_B) {
      check.grade = Grade::kWarning;
      check.remedy = "sudo ip link set dev " + camera.interface +
                     " mtu 9000, where camera and switch pass such packets";
    }
  }
  return check;
}

Check CheckRobotFiles(const std::string& robot, const std::string& calibration, const Status& fit) {
  Check check{.name = "robot files", .grade = Grade::kOk, .finding = {}, .remedy = {}};
  if (fit.ok()) {
    check.finding = robot + (calibration.empty() ? " can be read" : " and " + calibration + " fit");
    return check;
  }
  check.grade = Grade::kFailure;
  check.finding = fit.message();
  if (!calibration.empty()) check.remedy = "palpate calibrate " + robot + " --data EXPERIMENT";
  return check;
}

}  // namespace palpate::command
