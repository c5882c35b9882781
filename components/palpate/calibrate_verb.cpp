// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/calibration/material_calibration.hpp"
#include "components/calibration/recording_observation.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

using calibration::MaterialCalibration;

// Indices into RobotBody::materials.
std::vector<int> MaterialsOf(const std::vector<std::string>& parts, const robot::RobotBody& body) {
  std::vector<std::string> known = {"body"};
  known.insert(known.end(), body.region_names.begin(), body.region_names.end());
  std::vector<int> materials;
  for (const std::string& part : parts.empty() ? std::vector<std::string>{"body"} : parts) {
    const auto found = std::find(known.begin(), known.end(), part);
    if (found == known.end()) {
      throw InputError("--part " + part + ": the robot has no such region" +
                       DidYouMean(part, known));
    }
    const int material = static_cast<int>(found - known.begin());
    if (std::find(materials.begin(), materials.end(), material) != materials.end()) {
      throw InputError("--part " + part + " is given twice");
    }
    materials.push_back(material);
  }
  return materials;
}

std::string UtcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

robot::CalibrationFile ToFile(const MaterialCalibration& fit, const robot::RobotModel& model,
                              const std::vector<const experiment::Recording*>& recordings,
                              const std::filesystem::path& data) {
  robot::CalibrationFile file = robot::DescribeForCalibration(model);
  file.date_utc = UtcNow();
  file.data = data.filename().empty() ? data.parent_path().filename() : data.filename();
  for (const experiment::Recording* recording : recordings) {
    file.data += (recording == recordings.front() ? ": " : ", ") + recording->name;
  }
  file.data_hash = HashRecordings(recordings);
  for (const calibration::FittedModulus& modulus : fit.moduli) {
    const auto region = static_cast<std::size_t>(modulus.material);
    file.moduli.push_back({region == 0 ? "body" : model.body().region_names[region - 1],
                           modulus.youngs_modulus_Pa, modulus.standard_error_Pa});
  }
  file.residual_rms_m = fit.residual_rms_m;
  file.chi_squared = fit.chi_squared;
  file.degrees_of_freedom = fit.degrees_of_freedom;
  return file;
}

void Print(const MaterialCalibration& fit, const robot::CalibrationFile& file,
           const std::vector<calibration::StaticObservation>& observations) {
  for (const robot::CalibratedModulus& modulus : file.moduli) {
    fmt::print("E of {}: {:.2f} kPa, standard error {:.2f} kPa ({:.2g} %)\n", modulus.part,
               1e-3 * modulus.youngs_modulus_Pa, 1e-3 * modulus.standard_error_Pa,
               100.0 * modulus.standard_error_Pa / modulus.youngs_modulus_Pa);
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    fmt::print("{}: markers off by {:.3f} mm RMS\n", observations[i].name,
               1e3 * fit.residual_rms_of_observation_m[i]);
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} iterations\n", fit.chi_squared,
             fit.degrees_of_freedom, fit.iterations);
  fmt::print("holds for mesh {} with {} and {} only\n", file.mesh_hash, file.element, file.model);
}

nlohmann::ordered_json ToJson(const robot::CalibrationFile& file) {
  nlohmann::ordered_json moduli = nlohmann::ordered_json::array();
  for (const robot::CalibratedModulus& modulus : file.moduli) {
    moduli.push_back({{"part", modulus.part},
                      {"youngs_modulus_Pa", modulus.youngs_modulus_Pa},
                      {"standard_error_Pa", modulus.standard_error_Pa}});
  }
  return {{"robot", file.robot},
          {"mesh_hash", file.mesh_hash},
          {"element", file.element},
          {"model", file.model},
          {"data", file.data},
          {"data_hash", file.data_hash},
          {"moduli", moduli},
          {"residual_rms_m", file.residual_rms_m},
          {"chi_squared", file.chi_squared},
          {"degrees_of_freedom", file.degrees_of_freedom}};
}

}  // namespace

int Calibrate(const CalibrateOptions& options) {
  const std::unique_ptr<robot::RobotModel> model = LoadRobot(options.robot, options.solver);
  const calibration::MaterialCalibrationSettings settings{
      .materials = MaterialsOf(options.parts, model->body())};
  const auto experiment = experiment::ReadExperiment(options.data, app::LoadYaml);
  const auto chosen = options.recordings.empty() ? RecordingsWithKnownLoads(experiment)
                                                 : ChooseRecordings(experiment, options.recordings);
  std::vector<calibration::StaticObservation> observations;
  for (const experiment::Recording* recording : chosen) {
    observations.push_back(calibration::ObserveRecording(experiment, *recording, *model,
                                                         ParseCableInput(options.cable_input),
                                                         options.marker_bias_m));
  }
  const MaterialCalibration fit = calibration::CalibrateMaterial(*model, observations, settings);
  if (!fit.status.ok()) {
    throw RunError("the fit failed (" + std::string(ToString(fit.status.code())) +
                   "): " + fit.status.message());
  }
  const robot::CalibrationFile file = ToFile(fit, *model, chosen, options.data);
  robot::WriteCalibrationFile(file, options.out);
  if (options.json) {
    fmt::print("{}\n", ToJson(file).dump(2));
  } else {
    Print(fit, file, observations);
    fmt::print("written to {}\n", options.out.string());
  }
  return app::kExitDone;
}

app::Verb CalibrateVerb() {
  return {
      "calibrate", "Fit the material to measured static phases with known loads or self weight",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<CalibrateOptions>();
        arguments.Positional("ROBOT", &options->robot,
                             "robot file, or the name of a robot that comes with palpate");
        arguments.Option("--data", &options->data, "experiment or recording folder",
                         app::Need::kRequired);
        arguments.Option("--out", &options->out, "calibration file to write", app::Need::kRequired);
        arguments.Choice("--what", &options->what, {"material"}, "what is fitted");
        arguments.Repeated("--recording", &options->recordings,
                           "use this recording (repeatable); else all but those of kind 'free'");
        arguments.Repeated("--part", &options->parts,
                           "fit the modulus of 'body' or of a region (repeatable); else the body");
        DeclareSolverOptions(arguments, &options->solver);
        arguments.Choice("--cable-input", &options->cable_input, {"displacement", "tension"},
                         "what is imposed on a cable where both were measured");
        arguments.Option(
            "--marker-bias-m", &options->marker_bias_m,
            "constant error of each marker, one sigma, that averaging does not remove");
        arguments.Flag("--json", &options->json, "print JSON");
        return [options] { return Calibrate(*options); };
      }};
}

}  // namespace palpate::command
