// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/simulator.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <thread>

#include "components/diagnosis/model/damage.hpp"
#include "components/diagnosis/model/sample_differentiator.hpp"
#include "components/diagnosis/model/sample_solver.hpp"

namespace palpate::diagnosis {

namespace {

/// Samples of the same recording follow each other and start from each other. [threads]
std::vector<std::vector<std::size_t>> Shares(const ObservedExperiment& observed, int threads) {
  std::vector<std::vector<std::size_t>> of_recording(observed.recordings.size());
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    of_recording[static_cast<std::size_t>(observed.samples[s].recording)].push_back(s);
  }
  std::sort(of_recording.begin(), of_recording.end(),
            [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<std::vector<std::size_t>> shares(static_cast<std::size_t>(threads));
  for (const auto& samples : of_recording) {
    auto& least = *std::min_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
      return a.size() < b.size();
    });
    least.insert(least.end(), samples.begin(), samples.end());
  }
  return shares;
}

void OnThreads(const std::vector<std::vector<std::size_t>>& shares,
               const std::function<void(const std::vector<std::size_t>&)>& work) {
  std::vector<std::jthread> threads;
  for (std::size_t k = 1; k < shares.size(); ++k) {
    threads.emplace_back([&work, &share = shares[k]] { work(share); });
  }
  work(shares.front());
}

/// What the past leaves of creep for each sample, after a first look at all of them.
void Creep(const std::vector<CreepTerm>& terms, const Memory& memory, const Simulation& simulation,
           std::vector<Hereditary>* past) {
  const auto samples = std::ssize(simulation.samples);
  for (Hereditary& left : *past) {
    left.scale = 0.0;
    left.stress_Pa.setZero(6, simulation.rest_elastic_Pa.cols());
  }
  for (const CreepTerm& term : terms) {
    const Eigen::MatrixXd& fading = memory.Fading(term.tau_s);
    for (Eigen::Index s = 0; s < samples; ++s) {
      Hereditary& left = (*past)[static_cast<std::size_t>(s)];
      Eigen::VectorXd weights = fading.row(s).transpose();
      left.scale += term.g * weights[s];
      weights[s] = 0.0;
      AddRemembered(simulation, term.g * weights, &left.stress_Pa);
    }
  }
}

/// Sweeps through all samples until what they remember of each other is settled.
int SweepsFor(const ModelDraft& draft) {
  constexpr double kLittle = 0.05;
  double g = draft.mullins ? draft.mullins->inverse_r : 0.0;
  for (const CreepTerm& term : draft.creep) g += std::abs(term.g);
  return g == 0.0 ? 1 : g < kLittle ? 2 : 4;
}

/// Which cables pull, and whether the body is at a wall.
std::vector<bool> WhatHolds(const HeldShape& shape) {
  constexpr double kNothing_N = 1e-6;
  const auto cables = std::ssize(shape.commands);
  std::vector<bool> holds{shape.AtWall()};
  for (const double tension_N : shape.state.multipliers_N.head(cables)) {
    holds.push_back(tension_N > kNothing_N);
  }
  return holds;
}

/// Beside the middle: shapes that are held by something else.
void KeepOthers(const std::map<std::vector<bool>, std::vector<HeldShape>>& by_what_holds,
                SimulatedSample* simulated) {
  const std::vector<bool> in_the_middle = WhatHolds(simulated->middle);
  simulated->middle.share = 1.0;
  for (const auto& [what, shapes] : by_what_holds) {
    if (what == in_the_middle) continue;
    HeldShape& one = simulated->beside.emplace_back(shapes[shapes.size() / 2]);
    one.share = 0.0;
    for (const HeldShape& shape : shapes) one.share += shape.share;
    simulated->middle.share -= one.share;
  }
}

/// The middle of a sample, about which the markers' mean lies as it did in `simulated`, which it
/// replaces.
void KeepTheBend(SimulatedSample part, SimulatedSample* simulated) {
  part.bend_m = std::move(simulated->bend_m);
  if (part.status.ok()) part.markers_m += part.bend_m;
  *simulated = std::move(part);
}

/// The middle of a sample, the mean of where its markers are seen, and the shapes beside; begins
/// from what `simulated` was.
void SolveInParts(const Sample& sample, const std::vector<SamplePart>& parts,
                  const Hereditary& past, Detail detail, SampleSolver* solver,
                  SimulatedSample* simulated) {
  const std::size_t middle = parts.size() / 2;
  SimulatedSample part;
  part.middle = simulated->middle;
  // Where one set of cables was taut throughout, of a robot that was a little different, and still
  // is in the middle, the middle and how the sample bent stand for all parts.
  const bool is_known = simulated->bend_m.size() > 0;
  const bool only_the_middle = is_known && detail == Detail::kMiddles;
  const bool may_keep = is_known && simulated->bend_is_own && simulated->beside.empty();
  if (only_the_middle || (may_keep && !solver->IsNearWall(simulated->middle.state))) {
    solver->Solve(sample, parts[middle].taken_in, past, &part);
    const bool alike = part.status.ok() && WhatHolds(part.middle) == WhatHolds(simulated->middle);
    if (only_the_middle || alike) {
      solver->Remember(past, &part);
      part.middle.share = 1.0;
      part.bend_is_own = !only_the_middle;
      KeepTheBend(std::move(part), simulated);
      return;
    }
    part = {};
    part.middle = simulated->middle;
  }
  Eigen::Matrix3Xd mean_m;
  std::map<std::vector<bool>, std::vector<HeldShape>> by_what_holds;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    solver->Solve(sample, parts[k].taken_in, past, &part);
    if (k == middle || !part.status.ok()) {
      solver->Remember(past, &part);
      *simulated = part;
    }
    if (!part.status.ok()) return;
    const Eigen::Matrix3Xd shared_m = parts[k].share * part.markers_m;
    mean_m = k == 0 ? shared_m : Eigen::Matrix3Xd(mean_m + shared_m);
    by_what_holds[WhatHolds(part.middle)].emplace_back(part.middle).share = parts[k].share;
  }
  simulated->bend_m = mean_m - simulated->markers_m;
  simulated->bend_is_own = true;
  simulated->markers_m = std::move(mean_m);
  KeepOthers(by_what_holds, simulated);
}

}  // namespace

Eigen::Index ParameterCount(const CauseList& causes) {
  return std::accumulate(
      causes.begin(), causes.end(), Eigen::Index{0},
      [](Eigen::Index sum, const Cause* cause) { return sum + std::ssize(cause->parameters()); });
}

ModelDraft DraftWith(const ModelDraft& nominal, const CauseList& causes, const Eigen::VectorXd& z) {
  ModelDraft draft = nominal;
  Eigen::Index first = 0;
  for (const Cause* cause : causes) {
    const auto count = std::ssize(cause->parameters());
    const Eigen::VectorXd own = z.segment(first, count);
    if (!own.isZero()) cause->Apply(own, &draft);
    first += count;
  }
  return draft;
}

Simulator::Simulator(const ObservedExperiment& observed, int threads)
    : observed_(observed), threads_(threads), drives_(observed), memory_(observed) {}

Simulation Simulator::Run(const ModelDraft& draft, const Simulation* start, Detail detail) const {
  Simulation simulation;
  if (start != nullptr) {
    simulation.samples = start->samples;
  } else {
    simulation.samples.resize(observed_.samples.size());
  }
  simulation.past.resize(observed_.samples.size());
  if (draft.mullins && start != nullptr && start->past.size() == simulation.past.size()) {
    simulation.past = start->past;
  }
  const int sweeps = SweepsFor(draft);
  const auto shares = Shares(observed_, threads_);
  const std::vector<std::vector<SamplePart>> parts = drives_.PartsAt(draft.drives);
  const Eigen::MatrixXi sliding = drives_.Sliding(draft.drives);
  std::atomic<bool> failed = false;
  for (int sweep = 0; sweep < sweeps && !failed; ++sweep) {
    OnThreads(shares, [&](const std::vector<std::size_t>& share) {
      SampleSolver solver(draft, observed_);
      if (&share == &shares.front()) {
        SimulatedSample rest = solver.Rest();
        simulation.rest_elastic_Pa = std::move(rest.elastic_Pa);
        simulation.rest_energy_J_m3 = std::move(rest.energy_J_m3);
      }
      const HeldShape* before = nullptr;
      for (const std::size_t s : share) {
        SimulatedSample& sample = simulation.samples[s];
        solver.SetSliding(sliding.col(static_cast<Eigen::Index>(s)));
        if (sample.middle.state.x_m.size() == 0 && before != nullptr) {
          sample.middle.state = before->state;
          sample.middle.wall_force_N = before->wall_force_N;
        }
        if (failed && start != nullptr) {
          sample.status = {StatusCode::kNotConverged, "another moment could not be simulated"};
          sample.markers_m.setConstant(std::numeric_limits<double>::quiet_NaN());
          continue;
        }
        SolveInParts(observed_.samples[s], parts[s], simulation.past[s], detail, &solver, &sample);
        if (sample.status.ok()) {
          before = &sample.middle;
        } else {
          failed = true;
        }
      }
    });
    if (sweep + 1 == sweeps) break;
    if (!draft.creep.empty()) Creep(draft.creep, memory_, simulation, &simulation.past);
    if (draft.mullins) Soften(*draft.mullins, memory_, simulation, &simulation.past);
  }
  simulation.below_largest_J_m3 = BelowLargest_J_m3(memory_, simulation);
  simulation.status = Status::Ok();
  for (const SimulatedSample& sample : simulation.samples) {
    if (simulation.status.ok() && !sample.status.ok()) simulation.status = sample.status;
  }
  return simulation;
}

void Simulator::Differentiate(const ModelDraft& draft, const CauseList& causes,
                              const Eigen::VectorXd& z, const std::vector<bool>& wanted,
                              const ModelDraft& nominal, Simulation* simulation) const {
  const std::vector<Eigen::MatrixXd> drive_change =
      DriveChanges(drives_, nominal, causes, z, wanted, draft.drives);
  const Eigen::MatrixXi sliding = drives_.Sliding(draft.drives);
  OnThreads(Shares(observed_, threads_), [&](const std::vector<std::size_t>& share) {
    SampleSolver solver(draft, observed_);
    SampleDifferentiator differentiator(draft, causes, z, wanted, drive_change, &solver);
    for (const std::size_t s : share) {
      SimulatedSample& sample = simulation->samples[s];
      const auto column = static_cast<Eigen::Index>(s);
      solver.Prepare(observed_.samples[s], simulation->past[s]);
      solver.SetSliding(sliding.col(column));
      const auto jacobian_m = [&](const HeldShape& shape) -> Eigen::MatrixXd {
        const CauseMoment at{.observed = observed_,
                             .draft = draft,
                             .simulation = *simulation,
                             .memory = memory_,
                             .sample = static_cast<int>(s),
                             .shape = shape,
                             .model = solver.model(),
                             .points = solver.points()};
        return shape.share * differentiator.At(at);
      };
      Eigen::MatrixXd mean_m = jacobian_m(sample.middle);
      for (const HeldShape& shape : sample.beside) mean_m += jacobian_m(shape);
      sample.jacobian_m = std::move(mean_m);
    }
  });
}

}  // namespace palpate::diagnosis
