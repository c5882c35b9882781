// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/diagnosis/report/example_result.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/not_a_number.hpp"
#include "tests/support/robots.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kNoise_m = 3e-4;

/// What was done in a recording: one cable up and down, or up and held.
struct Script {
  const char* name;
  const char* kind;
  int cable;  ///< -1: none
  int compared_samples;
};
constexpr Script kScripts[] = {{"01_rest", "rest", -1, 8},
                               {"02_ramp_north", "ramp", 0, 41},
                               {"03_ramp_west", "ramp", 1, 41},
                               {"04_ramp_south", "ramp", 2, 41},
                               {"05_ramp_east", "ramp", 3, 41},
                               {"06_hold_north", "hold", 0, 40},
                               {"07_hold_east", "hold", 3, 40},
                               {"08_repeat_north", "repeat", 0, 41},
                               {"09_second_speed_north", "ramp", 0, 41}};

double Command_m(const Script& script, int i) {
  const double share = static_cast<double>(i) / (script.compared_samples - 1);
  if (script.kind == std::string("hold")) return 6e-3 * std::min(1.0, 8.0 * share);
  return 8e-3 * (1.0 - std::abs(2.0 * share - 1.0));
}

double Time_s(const Script& script, int i) {
  const bool held = script.kind == std::string("hold") && i > 5;
  return held ? 5.0 + std::pow(10.0, 2.6 * (i - 6) / (script.compared_samples - 7.0)) : 1.0 * i;
}

/// How the residual of one marker goes on in a recording: a loop of friction for the cable north,
/// little for others, and a rise with log t in holds.
double Residual_m(const Script& script, int i) {
  if (script.cable < 0) return 0.0;
  const double command = Command_m(script, i) / 8e-3;
  const double size = script.cable == 0 ? 4.2e-3 : 0.9e-3;
  if (script.kind == std::string("hold")) {
    return -size * 0.6 * command + 4e-4 * std::log10(1.0 + Time_s(script, i));
  }
  const bool back = 2 * i > script.compared_samples - 1;
  const double turned = std::clamp((1.0 - command) / 0.25, 0.0, 1.0);
  return size * (back ? -command + 1.5 * turned * command : -command);
}

void AddMoments(int recording, const Script& script, std::mt19937* random,
                DiagnosisResult* result) {
  std::normal_distribution<double> noise(0.0, kNoise_m);
  const Eigen::Index markers = result->marker_rest_m.cols();
  for (int i = 0; i < script.compared_samples; ++i) {
    ComparedSample compared;
    compared.recording = recording;
    compared.t_s = Time_s(script, i);
    compared.command = Eigen::VectorXd::Zero(4);
    if (script.cable >= 0) compared.command[script.cable] = Command_m(script, i);
    compared.before_m.resize(3, markers);
    compared.after_m.resize(3, markers);
    for (Eigen::Index m = 0; m < markers; ++m) {
      const Eigen::Vector3d rest_m = result->marker_rest_m.col(m);
      const double near_north = std::exp(20.0 * (rest_m.y() - 0.06));
      const Eigen::Vector3d way =
          Eigen::Vector3d(0.0, 0.8, -0.6) * (0.25 + 0.75 * std::min(1.0, near_north));
      Eigen::Vector3d error;
      for (double& part : error) part = noise(*random);
      compared.before_m.col(m) = Residual_m(script, i) * way + error;
      compared.after_m.col(m) = 0.12 * Residual_m(script, i) * way + error;
    }
    if (i % 17 == 3) compared.before_m.col(2).setConstant(kNaN);
    if (i % 17 == 3) compared.after_m.col(2).setConstant(kNaN);
    result->compared_samples.push_back(compared);
  }
}

double Rms_m(const DiagnosisResult& result, int recording,
             Eigen::Matrix3Xd ComparedSample::*field) {
  double squares_m2 = 0.0;
  int count = 0;
  for (const ComparedSample& compared : result.compared_samples) {
    if (recording >= 0 && compared.recording != recording) continue;
    for (const double value : (compared.*field).reshaped()) {
      if (!std::isfinite(value)) continue;
      squares_m2 += value * value;
      ++count;
    }
  }
  return std::sqrt(squares_m2 / std::max(count, 1));
}

/// The leg in the north is held back, the others hardly.
void AddForces(const robot::RobotBody& body, DiagnosisResult* result) {
  ResidualForces& forces = result->residual_forces;
  const auto count = static_cast<Eigen::Index>(body.feature_points.size());
  forces = {"02_ramp_north", Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count),
            Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Vector3d rest_m = body.feature_points[static_cast<std::size_t>(k)].rest_m;
    const double near_north = std::min(1.0, std::exp(40.0 * (rest_m.y() - 0.06)));
    forces.place_m.col(k) = rest_m;
    forces.before_N.col(k) = 0.06 * (0.05 + near_north) * Eigen::Vector3d(0.1, -0.8, 0.6);
    forces.after_N.col(k) = 0.1 * forces.before_N.col(k);
  }
}

void AddBody(DiagnosisResult* result) {
  const robot::RobotBody body = robot::BuildRobotBody(test_support::FourLegRobot());
  result->robot = body.name;
  result->surface_m = body.mesh.nodes_m;
  const Eigen::Matrix3Xi triangles = body.boundary.CornerTriangles();
  for (const auto& corners : triangles.colwise()) {
    result->triangles.push_back({corners[0], corners[1], corners[2]});
  }
  result->marker_rest_m.resize(3, static_cast<Eigen::Index>(body.markers.size()));
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    result->markers.push_back(body.markers[m].name);
    result->marker_rest_m.col(static_cast<Eigen::Index>(m)) = body.markers[m].point.rest_m;
  }
  for (const auto& cable : body.cables) {
    result->cables.push_back("cable " + cable.name);
    result->cable_units.emplace_back("m");
  }
  AddForces(body, result);
}

void AddRecordings(DiagnosisResult* result) {
  std::mt19937 random(7);
  int index = 0;
  for (const Script& script : kScripts) {
    AddMoments(index, script, &random, result);
    const double before_m = Rms_m(*result, index, &ComparedSample::before_m);
    const double after_m = Rms_m(*result, index, &ComparedSample::after_m);
    result->recordings.push_back({.name = script.name,
                                  .kind = script.kind,
                                  .samples = script.compared_samples,
                                  .before_m = before_m,
                                  .null_model_m = 0.4 * kNoise_m + 0.72 * before_m,
                                  .after_m = after_m,
                                  .heldout_before_m = 1.04 * before_m,
                                  .heldout_after_m = 1.08 * after_m,
                                  .noise_m = kNoise_m});
    ++index;
  }
  const double before_m = Rms_m(*result, -1, &ComparedSample::before_m);
  const double after_m = Rms_m(*result, -1, &ComparedSample::after_m);
  result->model_error = {.before_m = before_m,
                         .null_model_m = 0.8 * before_m,
                         .after_m = after_m,
                         .heldout_before_m = 1.04 * before_m,
                         .heldout_after_m = 1.08 * after_m,
                         .noise_m = kNoise_m,
                         .heldout_gain_low_m = 0.8 * (before_m - after_m),
                         .heldout_gain_high_m = 1.1 * (before_m - after_m)};
  result->force_error = {.recordings = 2, .forces = 140, .before_N = 0.12, .after_N = 0.031};
}

void AddRivals(DiagnosisResult* result) {
  const std::string weaker = "explains less, and does not lower the held-out error";
  result->rivals = {
      {{"backlash", {"cable:north"}},
       "backlash of cable north",
       0.017,
       96.4,
       0.91,
       "its loop is as wide at low pull as at high pull; the measured one grows with the pull"},
      {{"viscoelastic_creep", {"body"}}, "creep of the body", 0.006, 41.0, 0.44, weaker},
      {{"cable_gain", {"cable:north"}},
       "gain of cable north",
       0.0008,
       38.2,
       0.52,
       "cannot open a loop between pulling and letting go"},
      {{"lag", {"body"}},
       "lag of the actuators",
       0.0004,
       22.9,
       0.63,
       "the loop does not widen at the second speed"},
      {{"regional_stiffness", {"region:leg_north"}},
       "stiffness of region leg_north",
       2e-5,
       12.1,
       0.31,
       weaker},
      {{"drive_coupling", {"cable:north", "cable:west"}},
       "coupling of cable north into west",
       1e-7,
       3.3,
       0.12,
       "the value is within the tolerance (|g| < 3 tau)"},
      {{"density", {"body"}}, "density of the body", 3e-9, 0.2, 0.05, weaker}};
}

void AddCorrelation(DiagnosisResult* result) {
  result->correlation_names = {"friction of cable north", "backlash of cable north",
                               "creep of the body",       "gain of cable north",
                               "lag of the actuators",    "stiffness of region leg_north"};
  result->correlation = Eigen::MatrixXd::Identity(6, 6);
  const auto set = [&](int i, int k, double value) {
    result->correlation(i, k) = value;
    result->correlation(k, i) = value;
  };
  set(0, 1, 0.91), set(0, 2, 0.44), set(0, 3, 0.52), set(0, 4, 0.63), set(0, 5, -0.31);
  set(1, 2, 0.38), set(1, 3, 0.22), set(1, 4, 0.71), set(1, 5, -0.27), set(2, 3, 0.05);
  set(2, 4, 0.49), set(2, 5, -0.08), set(3, 4, 0.11), set(3, 5, -0.66), set(4, 5, -0.02);
}

void AddOrigin(DiagnosisResult* result) {
  result->identities = {
      "With displacement-controlled cables and no known weight only the density over the modulus "
      "and the force over the modulus can be found.",
      "A negative offset of a cable equals slack.",
      "A constant error of the camera's pose equals a rigid displacement of the base."};
  result->data = "experiments/four_leg_2026_05";
  result->data_hash = "sha256-9f2c4a7be01d5c3386a1f0d2b7e94c5560d8a37be91f4402c6d5e8a9b3f10c27";
  result->version = "0.1.0";
  result->command =
      "palpate diagnose config/robots/four_leg.yaml --data experiments/four_leg_2026_05 --out out";
  result->duration_s = 143.2;
}

}  // namespace

DiagnosisResult FrictionExample() {
  DiagnosisResult result;
  AddBody(&result);
  AddRecordings(&result);
  AddRivals(&result);
  AddCorrelation(&result);
  AddOrigin(&result);
  result.verdict = Verdict::kCause;
  result.causes = {
      {.name = {"cable_friction", {"cable:north"}},
       .words = "friction of cable north",
       .parameters = {{"mu", 0.2134, 0.1951, 0.2322}},
       .probability = 0.97,
       .ln_bayes_factor = 104.7,
       .explained_share = 0.83,
       .cross_validated = true,
       .seen_in = {"02_ramp_north", "06_hold_north", "08_repeat_north", "09_second_speed_north"}}};
  result.causes.front().in_file = {{"friction of cable `north`", "", 0.0, 0.2134, 0.1951, 0.2322}};
  result.findable = {
      {{"cable_friction", {"cable:north"}}, "friction of cable north", "mu", 0.061},
      {{"cable_routing", {"cable:north"}}, "place of a fixed eyelet", "dx_m", 0.0011},
      {{"rest_twist", {"body"}}, "a twist of the body", "rate_rad_m", kNaN}};
  result.simulated_healthy = {.drawn = 200, .accused = 4, .ln_bayes_factor_98 = 3.1};
  result.clear_evidence = 10.0;
  result.no_fault_probability = 1e-6;
  result.other_probability = 0.006;
  result.experiments = {{"ramp of cable north to 12 mm, twice as slowly",
                         "",
                         {"cable_friction", {"cable:north"}},
                         {"backlash", {"cable:north"}},
                         23.5},
                        {"hold of cable north at 8 mm for 300 s",
                         "hang 30 g on the tip",
                         {"cable_friction", {"cable:north"}},
                         {"viscoelastic_creep", {"body"}},
                         9.1}};
  return result;
}

DiagnosisResult TwoCausesExample() {
  DiagnosisResult result = FrictionExample();
  result.causes.push_back({.name = {"viscoelastic_creep", {"body"}},
                           .words = "creep of the body",
                           .parameters = {{"g", 0.118, 0.097, 0.142}, {"tau_s", 31.0, 17.0, 58.0}},
                           .probability = 0.91,
                           .ln_bayes_factor = 14.2,
                           .explained_share = 0.09,
                           .cross_validated = false,
                           .seen_in = {"06_hold_north"}});
  std::erase_if(result.rivals, [](const Rival& rival) { return rival.name.id != "backlash"; });
  return result;
}

DiagnosisResult IndistinguishableExample() {
  DiagnosisResult result = FrictionExample();
  result.verdict = Verdict::kIndistinguishable;
  result.reason = "friction and backlash differ at several pulls only, and there is one";
  result.indistinguishable_from = {result.rivals[0].name};
  result.causes[0].probability = 0.56;
  result.rivals[0].probability = 0.43;
  result.rivals[0].canonical_correlation = 0.98;
  result.rivals[0].why_not = "fits alike (ln BF 1.1 less)";
  return result;
}

DiagnosisResult PartlyExplainedExample() {
  DiagnosisResult result = FrictionExample();
  result.verdict = Verdict::kPartlyExplained;
  result.reason =
      "the residual of leg_west still follows the commanded speed (runs test, p = 1e-5)";
  result.other_probability = 0.62;
  return result;
}

DiagnosisResult UnexplainedExample() {
  DiagnosisResult result = FrictionExample();
  result.verdict = Verdict::kUnexplained;
  result.reason = "the best cause lowers the held-out error by 2 % only, less than chance may";
  result.causes.clear();
  for (RecordingError& recording : result.recordings) recording.heldout_after_m = kNaN;
  result.model_error.heldout_after_m = kNaN;
  result.other_probability = 0.93;
  return result;
}

DiagnosisResult HealthyExample() {
  DiagnosisResult result = FrictionExample();
  result.verdict = Verdict::kNoFault;
  result.reason = "no cause reaches ln BF 10 against the healthy robot (the best: 1.3)";
  result.causes.clear();
  result.experiments.clear();
  result.no_fault_probability = 0.96;
  for (ComparedSample& compared : result.compared_samples) compared.before_m = compared.after_m;
  for (RecordingError& recording : result.recordings) {
    recording.before_m = recording.after_m;
    recording.null_model_m = 0.97 * recording.after_m;
    recording.heldout_before_m = 1.03 * recording.after_m;
    recording.heldout_after_m = kNaN;
  }
  result.model_error.before_m = result.model_error.after_m;
  result.model_error.heldout_before_m = 1.03 * result.model_error.after_m;
  result.model_error.heldout_after_m = kNaN;
  return result;
}

DiagnosisResult DataUnfitExample() {
  DiagnosisResult result;
  AddOrigin(&result);
  result.robot = "four_leg";
  result.verdict = Verdict::kDataUnfit;
  result.reason = "the markers of recording 04_ramp_south stand still while its cable moves 8 mm";
  result.identities.clear();
  result.model_error = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  return result;
}

std::vector<DiagnosisResult> AllExamples() {
  return {FrictionExample(),    IndistinguishableExample(), PartlyExplainedExample(),
          UnexplainedExample(), HealthyExample(),           DataUnfitExample()};
}

}  // namespace palpate::diagnosis
