// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/demo_data.hpp"

#include <cstdlib>
#include <sstream>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/import_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::command {

namespace {

constexpr char kSelfWeightFile[] = "beam_gravity_V2_a.c3d";
constexpr char kHungWeightFile[] = "beam_load52_V2_a.c3d";

// On the top edge of the tip; a weight pulls straight down.
constexpr char kContact[] = "tip: 0, 0.015, 0.03, 0.005 along 0, 0, -1";

// The beam was held straight until it was released, rang, and came to rest some 2.5 s later. Both
// static phases are taken equally long after the release, because silicone creeps.
struct Capture {
  const char* file;
  const char* recording;
  const char* kind;
  const char* rest_window;
  const char* steady_window;
  const char* notes;
};

constexpr Capture kSelfWeight{
    kSelfWeightFile, "gravity_a", "rest",
    "0:0.6",         "3.3:4.9",   "held straight, released at 0.72 s, hangs under its own weight"};
constexpr Capture kHungWeight{
    kHungWeightFile, "load52g_a", "free",
    "0:0.35",        "3.03:4.63", "held straight, released at 0.45 s with 52 g hung at the tip"};

void Import(const Capture& capture, const std::filesystem::path& beam,
            const std::filesystem::path& experiment, std::ostream& report) {
  ImportOptions options;
  options.file = beam / capture.file;
  options.out = experiment;
  options.recording = capture.recording;
  options.robot = FindRobotFile("beam");
  options.kind = capture.kind;
  options.notes = capture.notes;
  options.markers = "Tip-1,Tip-2,Tip-3";
  options.rest_window = capture.rest_window;
  options.rest_shape = "undeformed";
  options.steady_window = capture.steady_window;
  options.register_to_robot = true;
  options.rate_Hz = 10.0;
  if (!std::filesystem::exists(experiment)) {
    options.markers_sigma_m = 1e-5;  // kept in experiment.yaml, which the first import makes
  }
  RunImport(options, report);
}

bool HoldsBeam(const std::filesystem::path& data) {
  std::error_code none;
  return !data.empty() && std::filesystem::exists(data / "silicone_beam" / kSelfWeightFile, none) &&
         std::filesystem::exists(data / "silicone_beam" / kHungWeightFile, none);
}

}  // namespace

std::optional<std::filesystem::path> FindMeasuredData(const std::filesystem::path& given) {
  if (!given.empty()) {
    if (!HoldsBeam(given)) {
      throw InputError("--data " + given.string() + ": no silicone_beam/" + kSelfWeightFile +
                       " and " + kHungWeightFile + " in this folder");
    }
    return given;
  }
  const char* named = std::getenv("PALPATE_DATA_DIR");
  for (const std::filesystem::path& data :
       {std::filesystem::path(named == nullptr ? "" : named),
        std::filesystem::path("../shared/data"), FindProjectFile("../shared/data")}) {
    if (HoldsBeam(data)) {
      return data.lexically_normal();
    }
  }
  return std::nullopt;
}

DemoData ImportMeasuredBeam(const std::filesystem::path& data,
                            const std::filesystem::path& folder) {
  DemoData demo;
  demo.description = "motion capture of a clamped silicone beam, 52 g hung at its tip (measured)";
  demo.experiment = folder / "experiment";
  demo.self_weight = kSelfWeight.recording;
  demo.hung_weight = kHungWeight.recording;
  demo.contact = kContact;
  demo.marker_bias_m = 5e-4;  // the hand-held reference is accurate to about a millimetre
  demo.true_force_N = {0.0, 0.0, -0.510};
  demo.true_force_uncertainty = 0.02;
  std::filesystem::remove_all(demo.experiment);
  std::ostringstream report;
  for (const Capture& capture : {kSelfWeight, kHungWeight}) {
    Import(capture, data / "silicone_beam", demo.experiment, report);
  }
  WriteFile(folder / "import.log", report.str());
  return demo;
}

DemoData ComputedBeam() {
  DemoData demo;
  demo.description =
      "deflections of a silicone beam computed by CalculiX, with noise, 52 g hung at its tip";
  demo.experiment = FindProjectFile("tests/data/beam_calculix");
  if (demo.experiment.empty()) {
    throw InputError(
        "neither the measured beam nor tests/data/beam_calculix is there; set PALPATE_DATA_DIR "
        "or give --data");
  }
  demo.self_weight = "self_weight";
  demo.hung_weight = "hung_weight";
  demo.contact = kContact;
  demo.marker_bias_m = 2e-4;  // the two solvers' meshes differ by 1 % of 20 mm
  const ConfigNode truth = app::LoadYaml(demo.experiment / "truth.yaml");
  const ConfigNode* weight = truth.Find("hung_weight");
  const ConfigNode* force = weight == nullptr ? nullptr : weight->Find("force_N");
  if (force == nullptr) {
    throw InputError({truth.where.file}, "key 'hung_weight: {force_N: [x, y, z]}' is missing");
  }
  demo.true_force_N = ReadVector3(*force);
  return demo;
}

}  // namespace palpate::command
