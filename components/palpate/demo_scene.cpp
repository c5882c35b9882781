// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/demo_scene.hpp"

#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "components/calibration/recording_observation.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/estimate/force_summary.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

std::string CompareWithTruth(const DemoData& data, const ForceSummary::Contact& force) {
  const double truth_N = data.true_force_N.norm();
  const double error_N = force.magnitude_N - truth_N;
  const bool inside = std::abs(error_N) <= force.ci95_N + data.true_force_uncertainty * truth_N;
  std::string text = fmt::format(
      "  estimated  {:.3f} N +- {:.3f} N (95 %), ({:.3f}, {:.3f}, {:.3f}) N; median of {} frames,\n"
      "             with its location and direction given\n",
      force.magnitude_N, force.ci95_N, force.force_N.x(), force.force_N.y(), force.force_N.z(),
      force.count);
  text += fmt::format("  truth      {:.3f} N{}\n", truth_N,
                      data.true_force_uncertainty > 0.0
                          ? fmt::format(" +- {:.0f} %", 100.0 * data.true_force_uncertainty)
                          : std::string());
  text += fmt::format("  difference {:+.3f} N ({:+.1f} %), {} the interval\n", error_N,
                      100.0 * error_N / truth_N, inside ? "inside" : "OUTSIDE");
  return text;
}

// Mean marker positions in the static phase, drawn where the undeformed body's markers have moved.
Eigen::Matrix3Xd ObservedMarkers(const DemoData& data, const robot::RobotModel& model) {
  const auto experiment = experiment::ReadExperiment(data.experiment, app::LoadYaml);
  const experiment::Recording& recording =
      *ChooseRecordings(experiment, {data.hung_weight}).front();
  const auto observation = calibration::ObserveRecording(experiment, recording, model,
                                                         robot::CableInput::kDisplacement, 0.0);
  const auto count = ToIndex(model.body().markers.size());
  PALPATE_CHECK(observation.reference_position_m.size() == 3 * count, data.hung_weight);
  Eigen::Matrix3Xd markers_m(3, count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const Eigen::Vector3d rest_m = model.body().markers[At(m)].point.rest_m;
    markers_m.col(m) = rest_m + observation.position_m.segment<3>(3 * m) -
                       observation.reference_position_m.segment<3>(3 * m);
  }
  return markers_m;
}

Eigen::Matrix3Xd ModelMarkers(const robot::RobotModel& model, const Eigen::VectorXd& x_m) {
  Eigen::Matrix3Xd markers_m(3, ToIndex(model.body().markers.size()));
  for (Eigen::Index m = 0; m < markers_m.cols(); ++m) {
    markers_m.col(m) = model.body().markers[At(m)].point.weights.Position(x_m);
  }
  return markers_m;
}

void AddHeading(const DemoData& data, const robot::CalibrationFile& calibration,
                double marker_rms_m, view::Scene* scene) {
  scene->title = "A weight on a soft beam, estimated from its markers";
  scene->caption = {
      data.description,
      fmt::format("E = {:.0f} ± {:.0f} kPa from self weight, markers and model "
                  "differ by {:.2f} mm RMS",
                  1e-3 * calibration.moduli.front().youngs_modulus_Pa,
                  1e-3 * calibration.moduli.front().standard_error_Pa, 1e3 * marker_rms_m)};
}

view::Scene MakeScene(const DemoData& data, const robot::RobotModel& model,
                      const robot::CalibrationFile& calibration, const ForceSummary::Contact& force,
                      const Eigen::Vector3d& contact_m, const Eigen::VectorXd& x_m) {
  view::Scene scene = MakeRobotScene(model, x_m);
  const Eigen::Matrix3Xd observed_m = ObservedMarkers(data, model);
  const Eigen::Matrix3Xd model_m = ModelMarkers(model, x_m);
  AddMarkers(observed_m, model_m, &scene);
  const double metres_per_newton = 0.42 * BodyDiagonal_m(model.body()) / data.true_force_N.norm();
  AddForce(contact_m, force.force_N, metres_per_newton, view::palette::kEstimate,
           fmt::format("{:.2f} ± {:.2f} N estimated", force.magnitude_N, force.ci95_N), &scene);
  // Beside the estimate, so that equal arrows do not hide each other.
  const Eigen::Vector3d aside_m(0.0, 0.06 * BodyDiagonal_m(model.body()), 0.0);
  AddForce(contact_m + aside_m, data.true_force_N, metres_per_newton, view::palette::kTruth,
           fmt::format("{:.2f} N true", data.true_force_N.norm()), &scene);
  const double rms_m =
      (observed_m - model_m).norm() / std::sqrt(static_cast<double>(observed_m.size()));
  AddHeading(data, calibration, rms_m, &scene);
  return scene;
}

}  // namespace

DemoResult EvaluateDemo(const DemoData& data, const std::filesystem::path& calibration_file,
                        const std::map<std::int64_t, force_estimation::ForceEstimate>& estimates,
                        const std::optional<Eigen::VectorXd>& mesh_state_m) {
  const std::unique_ptr<robot::RobotModel> model = LoadRobot("beam");
  const auto experiment = experiment::ReadExperiment(data.experiment, app::LoadYaml);
  const experiment::Recording& recording =
      *ChooseRecordings(experiment, {data.hung_weight}).front();
  ForceSummary summary(recording.name, recording.steady_window_s);
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();
  for (const auto& [stamp_ns, estimate] : estimates) {
    summary.Add(estimate);
    if (!estimate.contacts.empty()) {
      contact_m = estimate.contacts.front().position_m;
    }
  }
  DemoResult result;
  const std::vector<std::string> contacts = summary.Contacts();
  const ForceSummary::Contact force =
      contacts.empty() ? ForceSummary::Contact{} : summary.MedianOf(contacts.front());
  if (force.count == 0 || !mesh_state_m ||
      mesh_state_m->size() != 3 * model->body().mesh.nodes_m.cols()) {
    result.text = "  no force was found in the static phase:\n  " + summary.ToText();
    return result;
  }
  result.found = true;
  result.text = CompareWithTruth(data, force);
  result.scene =
      MakeScene(data, *model, robot::ReadCalibrationFile(calibration_file, app::LoadYaml), force,
                contact_m, *mesh_state_m);
  return result;
}

}  // namespace palpate::command
