// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fitter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// Evidence of fewer data than another has is none.
Status FewerData() {
  return {StatusCode::kNotConverged, "the effect of the faults is unknown at some sample"};
}

}  // namespace

Fitter::Fitter(const ObservedExperiment& observed, const robot::RobotBody& body,
               const HypothesisSet& hypotheses, const NoiseModel& noise, int threads,
               TimeLimit limit, const FitterTuning& tuning)
    : observed_(observed),
      hypotheses_(hypotheses),
      models_(hypotheses.All()),
      noise_(noise),
      nominal_(NominalHypothesis(body, observed)),
      simulator_(observed, threads),
      limit_(std::move(limit)),
      tuning_(tuning),
      marker_rest_m_(3, std::ssize(body.markers)),
      null_prior_(hypotheses.PriorWith({})) {
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    marker_rest_m_.col(ToIndex(m)) = body.markers[m].point.rest_m;
  }
}

/// At `z`, begun from `from`, of which the Jacobians stay.
Simulation Fitter::SimulateFrom(const Simulation& from, const Eigen::VectorXd& z,
                                Detail detail) const {
  Simulation simulation = simulator_.Run(HypothesisWith(nominal_, models_, z), &from, detail);
  for (std::size_t s = 0; s < simulation.samples.size(); ++s)
    simulation.samples[s].jacobian_m = from.samples[s].jacobian_m;
  return simulation;
}

/// What the `wanted` faults do at fit->z, of the rest what is known of them already.
void Fitter::Differentiate(const std::vector<bool>& wanted, Fit* fit) const {
  const ModelHypothesis hypothesis = HypothesisWith(nominal_, models_, fit->z);
  simulator_.Differentiate(hypothesis, models_, fit->z, wanted, nominal_, &fit->simulation);
}

void Fitter::Infer(Fit* fit) const {
  fit->model = LinearModelOf(*fit);
  fit->posterior = LinearPosterior(*fit, fit->faults);
}

/// Where the discrepancy is, what is simulated has nothing of it.
LinearModel Fitter::LinearModelOf(const Fit& fit) const {
  LinearModel model = Linearise(observed_, fit.simulation, hypotheses_.Simulated(fit.z),
                                marker_rest_m_, noise_, simulator_.threads());
  model.SetAbout(fit.z);
  return model;
}

Posterior Fitter::LinearPosterior(const Fit& about, const std::vector<int>& faults) const {
  return hypotheses_.InferWithin(about.model.All(), faults);
}

Fit Fitter::AsBuilt(const Simulation* simulated) const {
  Fit fit;
  fit.z = Eigen::VectorXd::Zero(hypotheses_.parameter_count());
  fit.simulation = simulated != nullptr ? *simulated : simulator_.Run(nominal_);
  fit.status = fit.simulation.status;
  return InAllDetail(std::move(fit));
}

/// Of what has no effect under the hypothesis of a fit, only the search for another one asks.
std::vector<bool> Fitter::Acting(const std::vector<int>& faults) const {
  const GaussianPrior prior = hypotheses_.PriorWith(faults);
  std::vector<bool> acting(models_.size());
  for (int k = 0; k < hypotheses_.size(); ++k) {
    const bool elsewhere = std::any_of(faults.begin(), faults.end(), [&](int fault) {
      return hypotheses_.model(fault).name() == hypotheses_.model(k).name();
    });
    const auto sigma = prior.sigma.segment(hypotheses_.first(k), hypotheses_.count(k));
    acting[At(k)] = elsewhere || !sigma.isZero(0.0);
  }
  return acting;
}

Fit Fitter::InAllDetail(Fit fit, const Fit* near) const {
  if (fit.complete || fit.simulation.samples.empty()) return fit;
  const Eigen::Index data = fit.model.y.size();
  fit.of_all_faults = fit.faults.empty();
  std::vector<bool> wanted =
      fit.of_all_faults ? std::vector<bool>(models_.size(), true) : Acting(fit.faults);
  for (int k = 0; k < hypotheses_.size() && near != nullptr; ++k) {
    if (IsKnownBySimulation(k, *near)) wanted[At(k)] = false;
  }
  Differentiate(wanted, &fit);
  if (near == nullptr) {
    simulator_.DifferentiateBySimulation(nominal_, models_, fit.z, &fit.simulation);
  }
  Infer(&fit);
  if (fit.model.y.size() < data) fit.status = FewerData();
  fit.complete = true;
  return fit;
}

Fit Fitter::WithAllFaults(Fit fit) const {
  if (fit.of_all_faults || !fit.complete) return fit;
  std::vector<bool> wanted = Acting(fit.faults);
  wanted.flip();
  Differentiate(wanted, &fit);
  Infer(&fit);
  fit.of_all_faults = true;
  return fit;
}

Fit Fitter::WithFaults(const std::vector<int>& faults, const Fit& start) const {
  Fit fit = MovedTo(FaultStart(faults, start), start);
  fit.faults = faults;
  return fit.status.ok() ? InAllDetail(std::move(fit)) : fit;
}

Fit Fitter::Resimulated(Fit fit) const {
  fit.simulation = SimulateFrom(fit.simulation, fit.z, Detail::kAllParts);
  fit.status = fit.simulation.status;
  return fit;
}

Fit Fitter::Remeasured(Fit fit) const {
  Fit anew = Resimulated(std::move(fit));
  if (!anew.status.ok()) return anew;
  anew.model = {};
  anew.complete = false;
  anew.arrived = false;
  return InAllDetail(std::move(anew));
}

Fit Fitter::MovedTo(const Eigen::VectorXd& z, const Fit& fit) const {
  Fit moved;
  moved.faults = fit.faults;
  moved.z = z;
  moved.simulation = SimulateFrom(fit.simulation, z, Detail::kParts);
  moved.status = moved.simulation.status;
  if (!moved.status.ok()) return moved;
  moved.model = LinearModelOf(moved);
  moved.posterior.scale = fit.posterior.scale;
  if (moved.model.y.size() < fit.model.y.size()) moved.status = FewerData();
  return moved;
}

Fit Fitter::Complete(Fit fit) const {
  if (fit.arrived) return fit;
  if (fit.status.ok() && !fit.complete) {
    fit = Resimulated(std::move(fit));
    fit.bends_known = true;
  }
  if (fit.status.ok()) fit = InAllDetail(std::move(fit));
  if (fit.status.ok()) fit = Continued(std::move(fit));
  // Parts of its samples stand for all as they did where the null model began, at the nominal
  // robot. Far from there faults, which are simulated with all parts, would gain by that alone:
  // much where pressures drive the body, whose shapes are far from linear in them.
  const bool by_pressure = !nominal_.body.chambers.empty();
  if (by_pressure && fit.status.ok() && fit.faults.empty() && IsStretched(fit)) {
    Fit anew = Remeasured(fit);
    if (anew.status.ok()) fit = Continued(std::move(anew));
  }
  fit.arrived = true;
  return fit;
}

/// Tolerances may matter more than faults let see: a cable that is about to get taut moves nothing
/// as long as its actuator's zero is where the file has it.
Fit Fitter::Continued(Fit fit) const {
  int failures = 0;
  Eigen::VectorXd to = PointFrom(fit, fit.faults, fit.posterior.scale);
  // Against a nominal robot that was not fitted to its end anything is evidence.
  const bool may_end = !fit.faults.empty();
  for (int step = 0;
       step < tuning_.most_continuations && failures < tuning_.most_failed_continuations; ++step) {
    if (may_end && IsOutOfTime()) return fit;
    const Eigen::VectorXd& scale = fit.posterior.scale;
    const double promised = MisfitAt(fit, to, scale);
    if (MisfitAt(fit, fit.z, scale) - promised < tuning_.continued_chi_squared) return fit;
    Fit next = MovedTo(to, fit);
    if (!next.status.ok()) return fit;
    const double found = MisfitAt(next, to, scale);
    if (std::abs(found - promised) < tuning_.continued_chi_squared) return fit;
    if (found > MisfitAt(fit, fit.z, scale)) {
      to = 0.5 * (fit.z + to);
      ++failures;
      continue;
    }
    next = InAllDetail(std::move(next), &fit);
    if (!next.status.ok()) return fit;
    fit = std::move(next);
    to = PointFrom(fit, fit.faults, fit.posterior.scale);
  }
  return fit;
}

/// Where to simulate next: what is most probable of robots with little of what has one sign only,
/// as far as it is no fault, with none of it. Damped, it is not far from there.
Eigen::VectorXd Fitter::PointFrom(const Fit& about, const std::vector<int>& faults,
                                  const Eigen::VectorXd& scale, double damping) const {
  Information data = about.model.All();
  if (damping > 0.0) {
    const Eigen::VectorXd hold = damping * data.H.diagonal();
    data.H.diagonal() += hold;
    data.b += hold.cwiseProduct(about.z);
  }
  const Posterior all = hypotheses_.InferWithin(data, faults, scale);
  std::vector<Eigen::Index> at_zero;
  for (int k = 0; k < hypotheses_.size(); ++k) {
    if (std::find(faults.begin(), faults.end(), k) != faults.end()) continue;
    for (Eigen::Index p = 0; p < hypotheses_.count(k); ++p) {
      const Eigen::Index column = hypotheses_.first(k) + p;
      const bool one_sided = hypotheses_.model(k).parameters()[At(p)].least == 0.0;
      // What is there already stays free: chi-squared would jump where its mean passes that limit.
      const bool little =
          about.z[column] == 0.0 &&
          all.mean[column] < tuning_.one_sided_tolerances * null_prior_.sigma[column];
      if (one_sided && little) at_zero.push_back(column);
    }
  }
  Eigen::VectorXd z = hypotheses_.InferWithin(data, faults, scale, at_zero).mean;
  for (const auto column : hypotheses_.Idle(faults)) z[column] = 0.0;
  return z;
}

/// Where a fault is most likely before the data, all else as `start` has it: steps that go too far
/// are halved towards there.
Eigen::VectorXd Fitter::FaultStart(const std::vector<int>& faults, const Fit& start) const {
  Eigen::VectorXd z = start.z;
  const GaussianPrior prior = hypotheses_.PriorWith(faults);
  for (const int k : faults) {
    if (std::find(start.faults.begin(), start.faults.end(), k) != start.faults.end()) continue;
    z.segment(hypotheses_.first(k), hypotheses_.count(k)) =
        prior.mean.segment(hypotheses_.first(k), hypotheses_.count(k));
  }
  return z;
}

bool Fitter::IsNear(const Fit& fit, const Eigen::VectorXd& scale) const {
  const GaussianPrior prior = hypotheses_.PriorWith(fit.faults);
  const Eigen::VectorXd step = PointFrom(fit, fit.faults, scale) - fit.z;
  const Eigen::VectorXd simulated = hypotheses_.Simulated(step);
  for (Eigen::Index p = 0; p < step.size(); ++p) {
    if (simulated[p] == 0.0) continue;
    const double known = std::sqrt(fit.posterior.covariance(p, p));
    const bool fault = prior.sigma[p] != null_prior_.sigma[p];
    const double reach =
        fault ? tuning_.near_fault * known : tuning_.near_tolerance * prior.sigma[p];
    if (std::abs(step[p]) > reach) return false;
  }
  return true;
}

bool Fitter::IsStretched(const Fit& fit) const {
  const Eigen::VectorXd z = hypotheses_.Simulated(fit.z);
  for (Eigen::Index p = 0; p < z.size(); ++p) {
    const double tolerance = null_prior_.sigma[p];
    if (tolerance > 0.0 && std::abs(z[p]) > tuning_.stretched_tolerances * tolerance) return true;
  }
  return false;
}

bool Fitter::IsKnownBySimulation(int k, const Fit& fit) const {
  return fit.complete && hypotheses_.model(k).NeedsSimulation(
                             fit.z.segment(hypotheses_.first(k), hypotheses_.count(k)));
}

double Fitter::MisfitAt(const Fit& about, const std::vector<int>& faults, const Eigen::VectorXd& z,
                        const Eigen::VectorXd& scale) const {
  const Information& data = about.model.All();
  const GaussianPrior prior = hypotheses_.PriorWith(faults, scale);
  double misfit = data.c + z.dot(data.H * z - 2.0 * data.b);
  for (Eigen::Index p = 0; p < z.size(); ++p) {
    if (prior.sigma[p] == 0.0) continue;
    misfit += std::pow((z[p] - prior.mean[p]) / prior.sigma[p], 2);
  }
  return misfit;
}

double Fitter::MisfitAt(const Fit& fit, const Eigen::VectorXd& z,
                        const Eigen::VectorXd& scale) const {
  return MisfitAt(fit, fit.faults, z, scale);
}

/// Where the discrepancies were when the fit was simulated was of another linear model.
double Fitter::MisfitOf(const Fit& fit, const Eigen::VectorXd& scale) const {
  const Information& data = fit.model.All();
  const GaussianPrior prior = hypotheses_.PriorWith(fit.faults, scale);
  Eigen::VectorXd z = hypotheses_.Simulated(fit.z);
  std::vector<Eigen::Index> added;
  for (int k = 0; k < hypotheses_.size(); ++k) {
    if (!hypotheses_.model(k).AddsToPrediction()) continue;
    for (Eigen::Index p = 0; p < hypotheses_.count(k); ++p)
      if (prior.sigma[hypotheses_.first(k) + p] > 0.0) added.push_back(hypotheses_.first(k) + p);
  }
  if (!added.empty()) {
    const Eigen::VectorXd weight = prior.sigma(added).cwiseAbs2().cwiseInverse();
    Eigen::MatrixXd H = data.H(added, added);
    H.diagonal() += weight;
    const Eigen::VectorXd pull = weight.cwiseProduct(prior.mean(added));
    const Eigen::VectorXd left = data.b - data.H * z;
    z(added) = linalg::SolveSymmetric(H, Eigen::VectorXd(left(added) + pull));
  }
  return MisfitAt(fit, z, scale);
}

bool Fitter::HasKinks(const std::vector<int>& faults) const {
  return std::any_of(faults.begin(), faults.end(),
                     [&](int k) { return hypotheses_.model(k).Start().has_value(); });
}

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start) const {
  if (!HasKinks(faults)) return Refine(faults, start, tuning_.most_rounds, Detail::kParts);
  const Fit near = Refine(faults, start, tuning_.most_rounds_over_kinks, Detail::kMiddles);
  if (near.bends_known || !near.status.ok()) return near;
  return Refine(faults, near, tuning_.most_rounds, Detail::kParts);
}

/// With what the `wanted` faults do there, and of the rest what they do in `from`.
Fit Fitter::Simulated(const Eigen::VectorXd& z, const std::vector<int>& faults,
                      const Simulation& from, Detail detail,
                      const std::vector<bool>& wanted) const {
  Fit fit;
  fit.faults = faults;
  fit.z = z;
  fit.simulation = SimulateFrom(from, z, detail);
  fit.status = fit.simulation.status;
  if (!fit.status.ok()) return fit;
  Differentiate(wanted, &fit);
  Infer(&fit);
  return fit;
}

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start, int most_rounds,
                   Detail detail) const {
  // Over kinks chi-squared goes up and down by some hundredths from place to place.
  const bool has_kinks = HasKinks(faults);
  const int most_failures = has_kinks ? tuning_.most_failures_over_kinks : most_rounds;
  std::vector<bool> wanted(models_.size(), false);
  for (const int k : faults) wanted[At(k)] = !IsKnownBySimulation(k, start);
  Fit fit;
  fit.z = FaultStart(faults, start);
  fit.posterior = LinearPosterior(start, faults);
  // One prior for all steps, else their misfits do not compare: discrepancies that grow on the way
  // would take what the faults are to explain.
  const Eigen::VectorXd scale = fit.posterior.scale;
  const Simulation* from = &start.simulation;
  Eigen::VectorXd to = PointFrom(start, faults, scale);
  double misfit = std::numeric_limits<double>::infinity();
  double damping = 0.0;
  double ln_surprise = 0.0;
  int failures = 0;
  for (int round = 0; round < most_rounds && failures < most_failures; ++round) {
    const double before = fit.posterior.ln_evidence;
    Fit next = Simulated(to, faults, *from, detail, wanted);
    next.bends_known = detail == Detail::kParts || (start.bends_known && HasKinks(start.faults));
    if (next.model.y.size() < start.model.y.size() && next.status.ok()) next.status = FewerData();
    const double now = next.status.ok() ? MisfitOf(next, scale) : misfit;
    if (round == 0 && next.status.ok())
      ln_surprise = 0.5 * std::max(0.0, now - MisfitAt(start, faults, to, scale));
    const bool placed = fit.status.ok();
    if (next.status.ok() && now > misfit && now < (1.0 + tuning_.settled_misfit) * misfit) break;
    if (!next.status.ok() || now > misfit) {
      damping = std::max(tuning_.least_damping, tuning_.damp_more * damping);
      to = placed ? PointFrom(fit, faults, scale, damping) : 0.5 * (fit.z + to);
      failures += placed;
      if (placed && IsOutOfTime()) break;
      continue;
    }
    failures = 0;
    damping = damping < tuning_.least_damping ? 0.0 : damping / tuning_.damp_less;
    const bool little = has_kinks && placed && now > (1.0 - tuning_.settled_over_kinks) * misfit;
    misfit = now;
    fit = std::move(next);
    from = &fit.simulation;
    to = PointFrom(fit, faults, scale, damping);
    const bool there = misfit < (1.0 + tuning_.still_to_go) * MisfitAt(fit, to, scale);
    const bool settled =
        there && std::abs(fit.posterior.ln_evidence - before) < tuning_.settled_ln_evidence;
    // As much as this round gained would not bring the next one there.
    const double gained = std::max(0.0, fit.posterior.ln_evidence - before);
    const bool hopeless = round + 1 >= tuning_.rounds_to_hope &&
                          faults.size() > start.faults.size() &&
                          fit.posterior.ln_evidence + gained < start.posterior.ln_evidence;
    if (little || settled || hopeless || IsNear(fit, scale) || IsOutOfTime()) break;
  }
  fit.ln_surprise = ln_surprise;
  return fit;
}

}  // namespace palpate::diagnosis
