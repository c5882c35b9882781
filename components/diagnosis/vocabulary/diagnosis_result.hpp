// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace palpate::diagnosis {

/// A parameter of a cause with its 95 % interval; name and unit as in docs/diagnosis.md.
struct FittedParameter {
  std::string name;
  double value = 0.0;
  double ci95_low = 0.0;
  double ci95_high = 0.0;
};

/// What is said of a robot's simulation (docs/theory/model_selection.md).
enum class Verdict {
  kNoFault,            ///< what it gets wrong is within noise and manufacturing tolerances
  kCause,              ///< the causes named explain the model error
  kIndistinguishable,  ///< there is a fault, and two causes or more are not identifiable
  kPartlyExplained,    ///< a cause is named, and a model error beyond the noise remains
  kUnexplained,        ///< there is a model error that no cause of the catalogue explains
  kDataUnfit,          ///< the data cannot be used; `reason` says why
};

/// As verdict.json spells them: no_fault, cause, indistinguishable, ...
std::string ToString(Verdict verdict);

/// A cause of the catalogue at one place of the robot.
struct CauseName {
  std::string id;                  ///< of docs/diagnosis.md
  std::vector<std::string> where;  ///< "cable:north", "region:leg_north", "body", "base", "camera"

  bool operator==(const CauseName&) const = default;
};

/// A value of a robot file or calibration that a cause changes.
struct ChangedValue {
  std::string words;  ///< "E of `middle`"
  std::string unit;   ///< "kPa"; empty: a plain number
  double before = 0.0;
  double after = 0.0;
  double ci95_low = 0.0;  ///< of `after`; both equal to it: not known
  double ci95_high = 0.0;
};

/// A cause that was named.
struct NamedCause {
  CauseName name;
  std::string words;  ///< for people: "friction of cable north"
  std::vector<FittedParameter> parameters;
  double probability = 0.0;      ///< in (0, 0.99]
  double ln_bayes_factor = 0.0;  ///< against the same model without it
  double explained_share =
      0.0;  ///< of what tolerances leave beyond noise (explain/model_error.hpp)
  bool cross_validated = false;      ///< it lowers the error in recordings it was not fitted to
  std::vector<std::string> seen_in;  ///< recordings that speak for it
  std::vector<ChangedValue> in_file = {};  ///< what it changes in files; empty: nothing there
};

/// A cause that was not named, and why.
struct Rival {
  CauseName name;
  std::string words;
  double probability = 0.0;
  double ln_bayes_factor = 0.0;  ///< against the nominal robot
  double canonical_correlation =
      0.0;  ///< canonical correlation with the first named cause, in [0, 1]
  std::string why_not;
};

/// RMS over the coordinates of all markers in one recording, m. NaN where it is not known.
struct RecordingError {
  std::string name;
  std::string kind;
  int samples = 0;                ///< samples that were compared
  double before_m = 0.0;          ///< the simulation as the robot file has it
  double null_model_m = 0.0;      ///< fitted within the manufacturing tolerances
  double after_m = 0.0;           ///< with the causes that were named
  double heldout_before_m = 0.0;  ///< the null model, fitted to the other recordings
  double heldout_after_m = 0.0;   ///< extended model, fitted to the other recordings
  double noise_m = 0.0;           ///< what measuring alone leaves
};

/// RMS over all recordings, m; each as in RecordingError.
struct ErrorSummary {
  double before_m = 0.0;
  double null_model_m = 0.0;
  double after_m = 0.0;
  double heldout_before_m = 0.0;
  double heldout_after_m = 0.0;
  double noise_m = 0.0;
  /// 95 % of heldout_before_m - heldout_after_m over recordings drawn again (bootstrap).
  double heldout_gain_low_m = std::numeric_limits<double>::quiet_NaN();
  double heldout_gain_high_m = std::numeric_limits<double>::quiet_NaN();
};

/// RMS error of the sizes of known loads that were estimated, N.
struct ForceError {
  int recordings = 0;
  int forces = 0;                                              ///< 0: none were compared
  double before_N = std::numeric_limits<double>::quiet_NaN();  ///< as the robot file has it
  double after_N = std::numeric_limits<double>::quiet_NaN();   ///< with the extended files
  std::string why_not = {};  ///< empty: there was nothing to compare, or it was compared
};

/// One sample that simulation and robot were compared at.
struct ComparedSample {
  int recording = 0;  ///< index into DiagnosisResult::recordings
  double t_s = 0.0;
  Eigen::VectorXd command;    ///< [actuators] as commanded, in cable_units; NaN: not driven
  Eigen::Matrix3Xd before_m;  ///< [3 x markers] measured - simulated, robot frame; NaN: not seen
  Eigen::Matrix3Xd after_m;   ///< the same of the extended model (or the nominal robot's fit)
};

/// Expected ln BF from which on a recording is expected to separate two hypotheses.
inline constexpr double kClearAnswer_lnBF = 3.0;

/// A recording that would separate the hypotheses.
struct ExperimentProposal {
  std::string title;        ///< "ramp of cable north to 8 mm"
  std::string by_hand;      ///< what a person does, empty: nothing: "hang 30 g on the tip"
  CauseName first, second;  ///< the pair that it separates least well of those it is to separate
  double expected_ln_bayes_factor = 0.0;
};

/// Forces on the body, in one recording throughout, that would do what the simulation leaves there.
/// Without columns where none were computed.
struct ResidualForces {
  std::string recording;
  Eigen::Matrix3Xd place_m;   ///< [3 x places] of the undeformed body, robot frame
  Eigen::Matrix3Xd before_N;  ///< for what the robot file leaves, robot frame
  Eigen::Matrix3Xd after_N;   ///< for what the named causes leave
};

/// The test of the residual that is least like noise (GoodnessOfFit).
struct ResidualTest {
  bool is_noise = false;
  std::string test;
  double surprise = 0.0;
  double surprise_limit = 0.0;
  double excess = 0.0;
};

/// The smallest size of a fault that these data would name, by the linear model of the null model.
struct FindableSize {
  CauseName name;
  std::string words;
  std::string parameter;  ///< of verdict.json
  double value = 0.0;     ///< of the parameter; NaN: no size that is plausible
};

/// Healthy robots of this kind in this experiment, simulated by the null model (parametric
/// bootstrap).
struct SimulatedHealthy {
  int drawn = 0;
  int accused = 0;  ///< that a fault would be named of
  /// 98 % quantile of their most probable fault's ln BF.
  double ln_bayes_factor_98 = std::numeric_limits<double>::quiet_NaN();
};

/// Everything that a report says. Lists are sorted, the most important first.
struct DiagnosisResult {
  Verdict verdict = Verdict::kDataUnfit;
  std::string reason;           ///< a sentence or two
  bool search_complete = true;  ///< else it ended at its time limit, or was interrupted
  bool interrupted = false;     ///< by a signal: partial, without an extended robot file
  std::vector<NamedCause> causes;
  std::vector<Rival> rivals;
  std::vector<CauseName> indistinguishable_from;  ///< of the first cause
  double no_fault_probability = 0.0;
  double other_probability = 0.0;  ///< of something that the catalogue does not hold
  ResidualTest residual_test;
  std::vector<FindableSize> findable;
  SimulatedHealthy simulated_healthy;
  /// ln BF that a fault must have to be named here; NaN: none was looked for.
  double clear_evidence = std::numeric_limits<double>::quiet_NaN();
  /// Inferred size of the model discrepancy, as a share of the largest command, and of the modulus;
  /// NaN: it has none.
  double cable_discrepancy = std::numeric_limits<double>::quiet_NaN();
  double stiffness_discrepancy = std::numeric_limits<double>::quiet_NaN();
  ErrorSummary model_error;
  ForceError force_error;
  std::vector<RecordingError> recordings;
  ResidualForces residual_forces;
  std::vector<std::string>
      identities;  ///< what is not identifiable from data of this kind, in words
  std::vector<ExperimentProposal> experiments;

  // What the figures are drawn from.
  std::vector<std::string> cables;  ///< actuators: "cable north", "chamber tip"
  /// [cables] of ComparedSample::command: "m" or "N", of a chamber "m3" or "Pa"
  std::vector<std::string> cable_units;
  std::vector<std::string> markers;
  Eigen::Matrix3Xd marker_rest_m;                ///< [3 x markers], robot frame
  Eigen::Matrix3Xd surface_m;                    ///< [3 x nodes] of the undeformed body
  std::vector<std::array<int, 3>> triangles;     ///< of the surface
  std::vector<ComparedSample> compared_samples;  ///< by recording and time
  std::vector<std::string> correlation_names;    ///< causes of `correlation`
  Eigen::MatrixXd correlation;                   ///< between the effects of the causes, in [-1, 1]

  // How to repeat it.
  std::string robot;      ///< name in the robot file
  std::string data;       ///< as it was given
  std::string data_hash;  ///< "sha256-..."
  std::string version;
  std::string command;
  double duration_s = 0.0;
};

}  // namespace palpate::diagnosis
