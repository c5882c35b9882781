// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "components/diagnosis/data/timebase.hpp"
#include "components/diagnosis/design/next_experiment.hpp"
#include "components/diagnosis/explain/identities.hpp"
#include "components/diagnosis/explain/limits.hpp"
#include "components/diagnosis/explain/model_error.hpp"
#include "components/diagnosis/explain/verdict.hpp"
#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/forward/mesh_error.hpp"
#include "components/diagnosis/inference/residual_forces.hpp"
#include "components/diagnosis/joined_diagnosis.hpp"
#include "components/diagnosis/prepare/data_checks.hpp"
#include "components/diagnosis/prepare/nearest_robot.hpp"
#include "components/diagnosis/prepare/pose_registration.hpp"
#include "components/diagnosis/prepare/surface_observation.hpp"
#include "components/diagnosis/vocabulary/verdict_words.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

double Tolerance(const experiment::Experiment& experiment, const std::string& key) {
  const auto given = experiment.tolerances.find(key);
  return given == experiment.tolerances.end() ? 0.0 : given->second;
}

/// A tolerance per coordinate of a marker gives that of its offset's length.
std::map<std::string, double> FaultTolerances(const experiment::Experiment& experiment) {
  std::map<std::string, double> tolerances = experiment.tolerances;
  const auto marker = tolerances.find("marker_bias_m");
  if (marker != tolerances.end()) {
    tolerances["marker_misplacement"] = std::sqrt(3.0) * marker->second;
  }
  return tolerances;
}

/// Of anything that was measured.
double FirstFrame_s(const experiment::Recording& recording) {
  if (recording.markers) return recording.markers->frames.front().t_s;
  return recording.depth_images.empty() ? recording.clouds.front().t_s()
                                        : recording.depth_images.front().t_s();
}

bool HasDepthFrames(const ObservedExperiment& observed) {
  return std::any_of(observed.samples.begin(), observed.samples.end(),
                     [](const Sample& sample) { return !sample.depth_frames.empty(); });
}

bool IsAmong(const HypothesisSet& hypotheses, const std::optional<LikelyFault>& fault) {
  const FaultModelList causes = hypotheses.All();
  return fault && std::any_of(causes.begin(), causes.end(),
                              [&](const FaultModel* cause) { return fault->Is(*cause); });
}

experiment::Experiment WithoutDepthFrames(experiment::Experiment experiment) {
  for (experiment::Recording& recording : experiment.recordings) {
    recording.depth_images.clear();
    recording.color_images.clear();
    recording.clouds.clear();
  }
  return experiment;
}

/// One diagnosis. Run() calls the five stages in their order; each uses what those before it left.
class DiagnosisRun {
 public:
  /// All must outlive it.
  DiagnosisRun(const robot::RobotDescription& robot, const experiment::Experiment& as_recorded,
               const DiagnosisSettings& settings, const ReportStep& report)
      : robot_(robot),
        as_recorded_(as_recorded),
        settings_(settings),
        report_(report),
        limit_(settings.longest_s, settings.stop_requested) {}

  Diagnosis Run() {
    Status status = Prepare();
    if (status.ok()) status = RegisterAndSwap();
    if (status.ok()) status = BuildHypotheses();
    if (!status.ok()) return Refused(status);
    Select();
    return Explain();
  }

 private:
  /// The experiment on one time base, checked, and cut into samples.
  Status Prepare();
  /// Poses that are not given, exchanged cables, and the surface that depth frames show.
  Status RegisterAndSwap();
  /// Leaves samples out where the null model would take too much of the time limit.
  void KeepToTheLimit();
  /// The nominal robot's simulation, and the catalogue's faults that can show in these data.
  Status BuildHypotheses();
  /// Forward selection with backward elimination.
  void Select();
  /// What the selection says, as result, extended files and the next experiment.
  Diagnosis Explain();

  /// The verdict on data that cannot be used.
  Diagnosis Refused(const Status& status) const;
  int steps() const { return settings_.most_causes + 3; }  ///< of the progress report
  void DescribeResult(DiagnosisResult* result);
  void Extend(Diagnosis* diagnosis) const;
  bool NamedTheMesh() const;
  Diagnosis OnTheFinerMesh() const;
  void PlanNext(Diagnosis* diagnosis) const;
  /// Reports steps; of the null model's, how long it may take.
  void ReportSelection(int done, int of, const std::string& what) const;

  const robot::RobotDescription& robot_;
  const experiment::Experiment& as_recorded_;
  const DiagnosisSettings& settings_;
  const ReportStep& report_;
  TimeLimit limit_;

  experiment::Experiment experiment_;  ///< on one time base
  robot::RobotBody body_;
  ObservedExperiment observed_;
  std::optional<NearestRobot> nearest_;
  std::optional<SurfaceMatcher> matcher_;  ///< where depth frames show the surface
  std::optional<HypothesisSet> hypotheses_;
  std::optional<Fitter> fitter_;
  Fit as_built_;
  std::string fewer_samples_;  ///< how many are used of how many; empty: all
  double linearised_s_ = 0.0;  ///< time that simulating and linearising the nominal robot took
  Selection selection_;
};

Diagnosis DiagnosisRun::Refused(const Status& status) const {
  Diagnosis diagnosis;
  diagnosis.result = Unfit(status.message());
  diagnosis.extended = robot_;
  return diagnosis;
}

Status DiagnosisRun::Prepare() {
  const bool with_depth_frames = settings_.surface_source != nullptr;
  experiment_ = OnOneTimebase(with_depth_frames ? as_recorded_ : WithoutDepthFrames(as_recorded_));
  Status status = CheckTables(experiment_);
  if (!status.ok()) return status;
  body_ = robot::BuildRobotBody(robot_);
  observed_ = Observe(experiment_, body_,
                      {.most_samples = settings_.most_samples,
                       .depth_cameras = settings_.depth_cameras,
                       .with_depth_frames = with_depth_frames});
  return status;
}

Status DiagnosisRun::RegisterAndSwap() {
  const int threads = settings_.threads;
  Status status = RegisterUnknownPoses(body_, threads, &observed_);
  if (!status.ok()) return status;
  SurfaceSource* source = HasDepthFrames(observed_) ? settings_.surface_source : nullptr;
  report_(0, steps(), "testing exchanged cables and tubes, and blocked valves");
  nearest_ = FindNearestRobot(body_, observed_, threads, source);
  KeepToTheLimit();
  if (source == nullptr) return status;
  report_(0, steps(), "matching depth frames with the body");
  matcher_.emplace(body_);
  return ObserveSurface(nearest_->hypothesis, threads, source, &*matcher_, &observed_);
}

void DiagnosisRun::KeepToTheLimit() {
  // From the shapes of other samples, and of the fit before, an equilibrium and its derivatives
  // take a quarter of what an equilibrium takes from rest (0.28 of it on four_leg, 0.11 on a
  // trunk).
  constexpr double kShareOfFromRest = 0.25;
  constexpr double kShareOfLimit = 0.5;
  const double passes = 1.0 + FitterTuning().most_continuations;  // simulated, then fitted
  const double each_s = passes * kShareOfFromRest * nearest_->sample_s / settings_.threads;
  const std::size_t all = observed_.samples.size();
  const std::size_t most = SamplesWithin(kShareOfLimit * settings_.longest_s, each_s, all);
  if (most == all) return;
  std::vector<Sample> kept;
  for (const std::size_t s : SpreadOver(all, most)) kept.push_back(std::move(observed_.samples[s]));
  observed_.samples = std::move(kept);
  fewer_samples_ = std::to_string(most) + " of " + std::to_string(all) +
                   " samples are used, as the time limit leaves time for no more.";
  report_(0, steps(), fewer_samples_);
}

Status DiagnosisRun::BuildHypotheses() {
  const int threads = settings_.threads;
  report_(0, steps(), "simulating the nominal robot");
  const auto begin = std::chrono::steady_clock::now();
  const Simulation simulation =
      Simulator(observed_, threads).Run(NominalHypothesis(body_, observed_));
  const CatalogueInputs inputs = {
      .body = body_,
      .observed = observed_,
      .extrinsics_m = Tolerance(experiment_, "extrinsics_m"),
      .extrinsics_rad = Tolerance(experiment_, "extrinsics_rad"),
      .as_built = &simulation,
      .mesh_error = CompareWithFinerMesh(robot_, body_, observed_, simulation, threads)};
  hypotheses_.emplace(MakeFaultModels(inputs, settings_.excluded), FaultTolerances(experiment_));
  fitter_.emplace(observed_, body_, *hypotheses_, settings_.noise, threads, limit_);
  as_built_ = fitter_->AsBuilt(&simulation);
  linearised_s_ = SecondsSince(begin);
  return CheckAgainstNominal(observed_, as_built_.simulation);
}

void DiagnosisRun::Select() {
  Rematch rematch;
  if (matcher_) {
    rematch = [this](const Fit& fit) {
      matcher_->Match(fitter_->HypothesisAt(fit), fitter_->Shapes(fit), &observed_);
    };
  }
  selection_ = SelectFaults(
      observed_, *fitter_, as_built_, settings_.most_causes,
      [this](int done, int of, const std::string& what) { ReportSelection(done, of, what); },
      rematch, IsAmong(*hypotheses_, nearest_->fault) ? nearest_->fault : std::nullopt);
  if (matcher_) as_built_ = fitter_->Resimulated(std::move(as_built_));
}

/// Against a nominal robot that was not fitted to its end anything would be evidence: the time
/// limit does not shorten that fit, whose every step linearises once.
void DiagnosisRun::ReportSelection(int done, int of, const std::string& what) const {
  if (what != kFittingTheNullModel) return report_(done, of, what);
  const double most_s = FitterTuning().most_continuations * linearised_s_;
  report_(done, of,
          what + ", which may take " + FormatNumber(std::ceil(most_s)) + " s for these " +
              std::to_string(observed_.samples.size()) + " samples; no time limit shortens it");
}

Diagnosis DiagnosisRun::Explain() {
  Diagnosis diagnosis;
  diagnosis.extended = robot_;
  DescribeResult(&diagnosis.result);
  Extend(&diagnosis);
  if (diagnosis.result.interrupted) return diagnosis;
  if (NamedTheMesh()) return Joined(std::move(diagnosis), OnTheFinerMesh());
  PlanNext(&diagnosis);
  return diagnosis;
}

void DiagnosisRun::DescribeResult(DiagnosisResult* result) {
  DescribeModelError(observed_, body_, *hypotheses_, as_built_, selection_, result);
  for (ComparedSample& compared : result->compared_samples) {
    const auto r = static_cast<std::size_t>(compared.recording);
    compared.t_s -=
        FirstFrame_s(experiment_.recordings[r]) - FirstFrame_s(as_recorded_.recordings[r]);
  }
  DescribeVerdict(selection_, result);
  result->interrupted = limit_.IsStopped();
  if (result->interrupted) result->reason = "Interrupted, a partial report. " + result->reason;
  if (!fewer_samples_.empty()) result->reason += " Only " + fewer_samples_;
  DescribeCauses(observed_, *fitter_, robot_, selection_, result);
  DescribeRivals(*hypotheses_, selection_, result);
  if (!result->interrupted) DescribeLimits(*hypotheses_, selection_, result);
  result->residual_forces = FindResidualForces(observed_, *hypotheses_, selection_);
  result->identities = Identities(observed_);
}

void DiagnosisRun::Extend(Diagnosis* diagnosis) const {
  robot::CalibrationFile changes;
  for (const Choice& choice : selection_.named) {
    const FaultModel& cause = hypotheses_->model(choice.fault);
    const Eigen::VectorXd z = selection_.best.posterior.mean.segment(
        hypotheses_->first(choice.fault), hypotheses_->count(choice.fault));
    if (!cause.Extend(z, &diagnosis->extended, &changes)) {
      diagnosis->not_in_files.push_back(cause.words());
    }
  }
  if (changes.drives.empty() && changes.pressure_sensors.empty()) return;
  const robot::RobotModel model(robot::BuildRobotBody(diagnosis->extended));
  diagnosis->calibration = DescribeForCalibration(model);
  diagnosis->calibration->drives = std::move(changes.drives);
  diagnosis->calibration->pressure_sensors = std::move(changes.pressure_sensors);
}

bool DiagnosisRun::NamedTheMesh() const {
  return !selection_.named.empty() &&
         hypotheses_->model(selection_.named.back().fault).RestartsSearch();
}

Diagnosis DiagnosisRun::OnTheFinerMesh() const {
  DiagnosisSettings rest = settings_;
  rest.longest_s = limit_.left_s();
  rest.most_causes = settings_.most_causes - 1;
  return Diagnose(OnFinerMesh(robot_), as_recorded_, rest, report_);
}

void DiagnosisRun::PlanNext(Diagnosis* diagnosis) const {
  const Question question = QuestionOf(*fitter_, selection_);
  if (question.rivals.empty()) return;
  report_(steps() - 1, steps(), "ranking the next experiments");
  std::vector<RankedProposal> ranked = RankProposals(experiment_, observed_, body_, *fitter_,
                                                     selection_, question, settings_.threads);
  DiagnosisResult& result = diagnosis->result;
  result.experiments = Describe(question, ranked);
  for (RankedProposal& one : ranked) {
    PlannedRecording& next = diagnosis->next.emplace_back();
    next.name = NextName(experiment_, one.proposal.recording.kind);
    next.tells =
        WordsFor(question.best.name, result) + " from " + WordsFor(one.worst_rival, result);
    next.rest_s = experiment_.rest_between_s.value_or(next.rest_s);
    next.ranked = std::move(one);
  }
}

}  // namespace

DiagnosisResult Unfit(const std::string& reason) {
  DiagnosisResult result;
  result.verdict = Verdict::kDataUnfit;
  result.reason = reason;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  result.model_error = {kUnknown, kUnknown, kUnknown, kUnknown,
                        kUnknown, kUnknown, kUnknown, kUnknown};
  return result;
}

Diagnosis Diagnose(const robot::RobotDescription& robot, const experiment::Experiment& experiment,
                   const DiagnosisSettings& settings, const ReportStep& report) {
  return DiagnosisRun(robot, experiment, settings, report).Run();
}

}  // namespace palpate::diagnosis
