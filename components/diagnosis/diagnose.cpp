// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/diagnosis/causes/catalogue.hpp"
#include "components/diagnosis/data/fitness.hpp"
#include "components/diagnosis/data/timebase.hpp"
#include "components/diagnosis/exchanged_cables.hpp"
#include "components/diagnosis/finer_mesh.hpp"
#include "components/diagnosis/gap.hpp"
#include "components/diagnosis/identities.hpp"
#include "components/diagnosis/inference/confusability_of_faults.hpp"
#include "components/diagnosis/inference/further_causes.hpp"
#include "components/diagnosis/inference/other_places.hpp"
#include "components/diagnosis/inference/residual_forces.hpp"
#include "components/diagnosis/joined_diagnosis.hpp"
#include "components/diagnosis/plan/next_experiment.hpp"
#include "components/diagnosis/report/verdict_words.hpp"
#include "components/diagnosis/skin/first_look.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::diagnosis {

namespace {

/// What is left for something that the catalogue does not hold: nobody is surer of a cause.
constexpr double kOtherAtLeast = 0.01;
constexpr double kOtherWhereNoneIsNamed = 0.5;

double Tolerance(const experiment::Experiment& experiment, const std::string& key) {
  const auto told = experiment.tolerances.find(key);
  return told == experiment.tolerances.end() ? 0.0 : told->second;
}

/// What is told of each marker's coordinates is of the length of its offset, too.
std::map<std::string, double> CauseTolerances(const experiment::Experiment& experiment) {
  std::map<std::string, double> tolerances = experiment.tolerances;
  const auto marker = tolerances.find("marker_bias_m");
  if (marker != tolerances.end()) {
    tolerances["marker_misplacement"] = std::sqrt(3.0) * marker->second;
  }
  return tolerances;
}

/// Poses that nobody knows, from where the robot file's markers would be. Why that cannot be;
/// empty: it could.
std::string RegisterUnknownPoses(const robot::RobotBody& body, int threads,
                                 ObservedExperiment* observed) {
  const bool known = std::all_of(observed->recordings.begin(), observed->recordings.end(),
                                 [](const auto& recording) { return recording.knows_pose; });
  if (known) return {};
  const Simulation simulation = Simulator(*observed, threads).Run(DraftOf(body, *observed));
  for (std::size_t r = 0; r < observed->recordings.size(); ++r) {
    ObservedRecording& recording = observed->recordings[r];
    if (recording.knows_pose) continue;
    const auto shares = [&](const Sample& sample) {
      const auto& other = observed->recordings[static_cast<std::size_t>(sample.recording)];
      const bool own = recording.kind == "camera_moved" || other.kind == "camera_moved";
      return own ? static_cast<std::size_t>(sample.recording) == r : !other.knows_pose;
    };
    std::vector<Eigen::Vector3d> robot_m;
    std::vector<Eigen::Vector3d> measured_m;
    for (std::size_t s = 0; s < observed->samples.size(); ++s) {
      const Sample& sample = observed->samples[s];
      if (!simulation.samples[s].status.ok() || !shares(sample)) continue;
      for (Eigen::Index m = 0; m < sample.count.size(); ++m) {
        if (sample.count[m] == 0) continue;
        robot_m.emplace_back(simulation.samples[s].markers_m().col(m));
        measured_m.emplace_back(sample.position_m.col(m));
      }
    }
    const auto columns = [](const std::vector<Eigen::Vector3d>& points) {
      return Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3, std::ssize(points));
    };
    if (robot_m.empty()) continue;  // nothing was seen that a pose would be needed for
    const geometry::Registration found =
        geometry::RegisterRigid(columns(robot_m), columns(measured_m));
    if (!found.status.ok()) {
      return "nobody says from where recording " + recording.name +
             " was measured, and its markers do not tell: " + found.status.message();
    }
    recording.T_measurement_robot = Eigen::Isometry3d::Identity();
    recording.T_measurement_robot.linear() = found.T_target_source.rotation().toRotationMatrix();
    recording.T_measurement_robot.translation() = found.T_target_source.translation_m();
  }
  return {};
}

NamedCause Describe(const ObservedExperiment& observed, const Fitter& fitter, const Fit& fit,
                    const std::vector<FurtherCause>& further, double other_probability,
                    const Choice& choice) {
  constexpr double kSeen = 1.0;  // of ln p
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const FaultModel& cause = hypotheses.cause(choice.cause);
  const Eigen::VectorXd z =
      fit.posterior.mean.segment(hypotheses.first(choice.cause), hypotheses.count(choice.cause));
  const Eigen::MatrixXd covariance = CovarianceBeside(
      hypotheses, fit, choice.cause, further, CovarianceOverPlaces(fitter, fit, choice.cause));
  const Eigen::VectorXd undeformed_m = fitter.DraftAt(fit).body.mesh.nodes_m.reshaped();
  NamedCause named{.name = cause.name(),
                   .words = cause.words(),
                   .parameters = cause.Report(z, covariance, undeformed_m),
                   .probability = (1.0 - other_probability) * choice.probability,
                   .ln_bayes_factor = choice.ln_bayes_factor,
                   .cross_validated = choice.held_out.clear,
                   .seen_in = {}};
  for (std::size_t r = 0; r < choice.ln_gain_of_recording.size(); ++r) {
    if (choice.ln_gain_of_recording[r] > kSeen) {
      named.seen_in.push_back(observed.recordings[r].name);
    }
  }
  return named;
}

void DescribeVerdict(const Selection& selection, DiagnosisResult* result) {
  const GoodnessOfFit& goodness_of_fit = selection.goodness_of_fit;
  const std::string left = "what is left is not noise (" + goodness_of_fit.worst + ")";
  if (selection.named.empty()) {
    result->verdict = goodness_of_fit.passed ? Verdict::kNoFault : Verdict::kUnexplained;
    result->reason = goodness_of_fit.passed
                         ? "What the simulation gets wrong is within noise and building tolerances."
                         : "No cause of the catalogue explains the gap: " + left + ".";
  } else if (!goodness_of_fit.passed) {
    result->verdict = Verdict::kPartlyExplained;
    result->reason = "The cause explains a part; " + left + ".";
  } else if (!selection.alike.empty()) {
    result->verdict = Verdict::kIndistinguishable;
    result->reason = "Other causes fit these data as well.";
  } else {
    result->verdict = Verdict::kCause;
    result->reason = "The causes that are named explain the gap.";
  }
  result->leftover = {goodness_of_fit.passed, goodness_of_fit.worst, goodness_of_fit.surprise,
                      goodness_of_fit.surprise_limit, goodness_of_fit.excess};
  result->search_complete = selection.complete;
  if (!selection.complete) {
    result->reason += " The time was over: fits ended early, and not all causes were tried.";
  }
}

/// Of something that the catalogue does not hold, in the place of what is named or where nothing
/// is.
double OtherProbability(const HypothesisSet& hypotheses, const Selection& selection) {
  const bool passed = selection.goodness_of_fit.passed;
  if (selection.named.empty()) return passed ? kOtherAtLeast : kOtherWhereNoneIsNamed;
  return std::max(kOtherAtLeast,
                  ProbabilityOfConfusion(hypotheses, selection.healthy, selection.best, passed));
}

/// Probabilities of the hypotheses for the first place; causes that were named have theirs.
void DescribeRivals(const HypothesisSet& hypotheses, const Selection& selection,
                    DiagnosisResult* result) {
  const auto& candidates = selection.candidates;
  const double ln_share =
      -std::log(static_cast<double>(std::max<std::size_t>(1, candidates.size())));
  std::vector<double> ln_weights{0.0};  // of no fault, then of the candidates
  for (const Candidate& one : candidates) {
    ln_weights.push_back(one.ruled_out ? -std::numeric_limits<double>::infinity()
                                       : one.ln_bayes_factor + ln_share);
  }
  const double ln_most = *std::max_element(ln_weights.begin(), ln_weights.end());
  double all = 0.0;
  for (const double ln_weight : ln_weights) all += std::exp(ln_weight - ln_most);
  const double other = result->other_probability;
  result->no_fault_probability = (1.0 - other) * std::exp(-ln_most) / all;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Candidate& one = candidates[k];
    const bool named = std::any_of(selection.named.begin(), selection.named.end(),
                                   [&](const Choice& choice) { return choice.cause == one.cause; });
    if (named) continue;
    result->rivals.push_back(
        {.name = hypotheses.cause(one.cause).name(),
         .words = hypotheses.cause(one.cause).words(),
         .probability = (1.0 - other) * std::exp(ln_weights[k + 1] - ln_most) / all,
         .ln_bayes_factor = one.ln_bayes_factor,
         .canonical_correlation = one.canonical_correlation,
         .why_not = one.why_not});
  }
  for (const int cause : selection.compared) {
    result->correlation_names.push_back(hypotheses.cause(cause).words());
  }
  result->correlation = selection.canonical_correlation;
  for (const Candidate& one : selection.alike) {
    result->indistinguishable_from.push_back(hypotheses.cause(one.cause).name());
  }
}

void Extend(const HypothesisSet& hypotheses, const Selection& selection, Diagnosis* diagnosis) {
  std::vector<robot::CalibratedDrive> drives;
  for (const Choice& choice : selection.named) {
    const FaultModel& cause = hypotheses.cause(choice.cause);
    const Eigen::VectorXd z = selection.best.posterior.mean.segment(hypotheses.first(choice.cause),
                                                                    hypotheses.count(choice.cause));
    if (!cause.Extend(z, &diagnosis->extended, &drives)) {
      diagnosis->not_in_files.push_back(cause.words());
    }
  }
  if (drives.empty()) return;
  const robot::RobotModel model(robot::BuildRobotBody(diagnosis->extended));
  diagnosis->calibration = DescribeForCalibration(model);
  diagnosis->calibration->drives = drives;
}

/// What tells the causes apart that are left: the report's ranking, and how each of it is made.
void PlanNext(const experiment::Experiment& experiment, const ObservedExperiment& observed,
              const robot::RobotBody& body, const Fitter& fitter, const Selection& selection,
              const Question& question, int threads, Diagnosis* diagnosis) {
  std::vector<RankedProposal> ranked =
      RankProposals(experiment, observed, body, fitter, selection, question, threads);
  DiagnosisResult& result = diagnosis->result;
  result.experiments = Describe(question, ranked);
  for (RankedProposal& one : ranked) {
    PlannedRecording& next = diagnosis->next.emplace_back();
    next.name = NextName(experiment, one.proposal.recording.kind);
    next.tells =
        WordsFor(question.best.name, result) + " from " + WordsFor(one.worst_rival, result);
    next.rest_s = experiment.rest_between_s.value_or(next.rest_s);
    next.ranked = std::move(one);
  }
}

/// Of anything that was measured.
double FirstFrame_s(const experiment::Recording& recording) {
  if (recording.markers) return recording.markers->frames.front().t_s;
  return recording.depth_images.empty() ? recording.clouds.front().t_s()
                                        : recording.depth_images.front().t_s();
}

bool HasPictures(const ObservedExperiment& observed) {
  return std::any_of(observed.samples.begin(), observed.samples.end(),
                     [](const Sample& sample) { return !sample.pictures.empty(); });
}

bool IsAmong(const HypothesisSet& hypotheses, const std::optional<CauseName>& name) {
  const FaultModelList causes = hypotheses.All();
  return name && std::any_of(causes.begin(), causes.end(),
                             [&](const FaultModel* cause) { return cause->name() == *name; });
}

experiment::Experiment WithoutPictures(experiment::Experiment experiment) {
  for (experiment::Recording& recording : experiment.recordings) {
    recording.depth_images.clear();
    recording.color_images.clear();
    recording.clouds.clear();
  }
  return experiment;
}

}  // namespace

DiagnosisResult Unfit(const std::string& reason) {
  DiagnosisResult result;
  result.verdict = Verdict::kDataUnfit;
  result.reason = reason;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  result.gap = {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  return result;
}

Diagnosis Diagnose(const robot::RobotDescription& robot, const experiment::Experiment& as_recorded,
                   const DiagnosisSettings& settings, const ReportStep& report) {
  const TimeLimit limit(settings.longest_s);
  Diagnosis diagnosis;
  const experiment::Experiment experiment =
      OnOneClock(settings.pictures != nullptr ? as_recorded : WithoutPictures(as_recorded));
  diagnosis.result = Unfit(WhyUnfit(experiment));
  diagnosis.extended = robot;
  DiagnosisResult& result = diagnosis.result;
  if (!result.reason.empty()) return diagnosis;
  const robot::RobotBody body = robot::BuildRobotBody(robot);
  ObservedExperiment observed = Observe(experiment, body,
                                        {.most_samples = settings.most_samples,
                                         .depth_cameras = settings.depth_cameras,
                                         .with_pictures = settings.pictures != nullptr});
  result = Unfit(RegisterUnknownPoses(body, settings.threads, &observed));
  if (!result.reason.empty()) return diagnosis;
  report(0, settings.most_causes + 3, "trying exchanged cables");
  const NearestRobot nearest = FindExchangedCables(
      body, observed, settings.threads, HasPictures(observed) ? settings.pictures : nullptr);
  std::optional<SkinMatcher> matcher;
  if (HasPictures(observed)) {
    report(0, settings.most_causes + 3, "looking at the pictures");
    matcher.emplace(body);
    result = Unfit(LookAtPictures(nearest.hypothesis, settings.threads, settings.pictures,
                                  &*matcher, &observed));
    if (!result.reason.empty()) return diagnosis;
  }
  report(0, settings.most_causes + 3, "simulating the robot as its file has it");
  const Simulation simulation = Simulator(observed, settings.threads).Run(DraftOf(body, observed));
  const HypothesisSet hypotheses(
      MakeCauses(
          {.body = body,
           .observed = observed,
           .extrinsics_m = Tolerance(experiment, "extrinsics_m"),
           .extrinsics_rad = Tolerance(experiment, "extrinsics_rad"),
           .as_built = &simulation,
           .mesh_error = CompareWithFinerMesh(robot, body, observed, simulation, settings.threads)},
          settings.without),
      CauseTolerances(experiment));
  const Fitter fitter(observed, body, hypotheses, settings.noise, settings.threads, limit);
  Fit as_built = fitter.AsBuilt(&simulation);
  result = Unfit(WhyUnfit(observed, as_built.simulation));
  if (!result.reason.empty()) return diagnosis;
  LookAgain look_again;
  if (matcher) {
    look_again = [&](const Fit& fit) {
      matcher->Match(fitter.DraftAt(fit), fitter.Shapes(fit), &observed);
    };
  }
  const Selection selection =
      SelectCauses(observed, fitter, as_built, settings.most_causes, report, look_again,
                   IsAmong(hypotheses, nearest.exchanged) ? nearest.exchanged : std::nullopt);
  if (matcher) as_built = fitter.Resimulated(std::move(as_built));
  DescribeGap(observed, body, hypotheses, as_built, selection, &result);
  for (ComparedMoment& moment : result.moments) {
    const auto r = static_cast<std::size_t>(moment.recording);
    moment.t_s -= FirstFrame_s(experiment.recordings[r]) - FirstFrame_s(as_recorded.recordings[r]);
  }
  DescribeVerdict(selection, &result);
  result.other_probability = OtherProbability(hypotheses, selection);
  std::vector<FurtherCause> further;
  if (!selection.named.empty()) further = FurtherCauses(fitter, selection.best);
  for (const Choice& choice : selection.named) {
    result.causes.push_back(
        Describe(observed, fitter, selection.best, further, result.other_probability, choice));
    result.causes.back().explained_share =
        ExplainedShare(observed, hypotheses, selection, choice.cause);
  }
  DescribeRivals(hypotheses, selection, &result);
  result.residual_forces = FindResidualForces(observed, hypotheses, selection);
  result.identities = Identities(observed);
  Extend(hypotheses, selection, &diagnosis);
  if (!selection.named.empty() && hypotheses.cause(selection.named.back().cause).BeginsAnew()) {
    DiagnosisSettings rest = settings;
    rest.longest_s = limit.left_s();
    rest.most_causes = settings.most_causes - 1;
    return Joined(std::move(diagnosis), Diagnose(OnFinerMesh(robot), as_recorded, rest, report));
  }
  const Question question = QuestionOf(fitter, selection);
  if (question.rivals.empty()) return diagnosis;
  report(settings.most_causes + 2, settings.most_causes + 3, "ranking what to do next");
  PlanNext(experiment, observed, body, fitter, selection, question, settings.threads, &diagnosis);
  return diagnosis;
}

}  // namespace palpate::diagnosis
