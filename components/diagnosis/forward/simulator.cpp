// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/simulator.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <thread>

#include "components/diagnosis/forward/drive_distance.hpp"
#include "components/diagnosis/forward/history.hpp"
#include "components/diagnosis/forward/sample_differentiator.hpp"
#include "components/diagnosis/forward/sample_in_parts.hpp"
#include "components/diagnosis/forward/start_shapes.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Samples of the same recording follow each other, so that one is near the next. [threads]
std::vector<std::vector<std::size_t>> Shares(const ObservedExperiment& observed,
                                             const std::vector<bool>& is_to_do, int threads) {
  std::vector<std::vector<std::size_t>> of_recording(observed.recordings.size());
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    if (!is_to_do[s]) continue;
    of_recording[At(observed.samples[s].recording)].push_back(s);
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

/// The samples, each after one that has its shape.
std::vector<std::size_t> SameShapesTogether(const std::vector<std::size_t>& samples,
                                            const Simulation& simulation) {
  const auto shape = [&](std::size_t s) -> const Eigen::VectorXd& {
    return simulation.samples[s].middle.state.x_m;
  };
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t s : samples) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return shape(group.front()).size() == shape(s).size() && shape(group.front()) == shape(s);
    });
    if (same == groups.end()) {
      groups.push_back({s});
    } else {
      same->push_back(s);
    }
  }
  std::vector<std::size_t> together;
  for (const auto& group : groups) together.insert(together.end(), group.begin(), group.end());
  return together;
}

/// Puts back the columns of faults that are not `wanted`.
void KeepUnwanted(const FaultModelList& models, const std::vector<bool>& wanted,
                  const Eigen::MatrixXd& before_m, Eigen::MatrixXd* jacobian_m) {
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const auto count = std::ssize(models[k]->parameters());
    if (!wanted[k]) jacobian_m->middleCols(first, count) = before_m.middleCols(first, count);
    first += count;
  }
}

void OnThreads(const std::vector<std::vector<std::size_t>>& shares,
               const std::function<void(const std::vector<std::size_t>&)>& work) {
  std::vector<std::jthread> threads;
  for (std::size_t k = 1; k < shares.size(); ++k) {
    if (shares[k].empty()) continue;
    threads.emplace_back([&work, &share = shares[k]] { work(share); });
  }
  work(shares.front());
}

}  // namespace

Eigen::Index ParameterCount(const FaultModelList& models) {
  return std::accumulate(models.begin(), models.end(), Eigen::Index{0},
                         [](Eigen::Index sum, const FaultModel* fault) {
                           return sum + std::ssize(fault->parameters());
                         });
}

ModelHypothesis HypothesisWith(const ModelHypothesis& nominal, const FaultModelList& models,
                               const Eigen::VectorXd& z) {
  ModelHypothesis hypothesis = nominal;
  Eigen::Index first = 0;
  for (const FaultModel* fault : models) {
    const auto count = std::ssize(fault->parameters());
    const Eigen::VectorXd own = z.segment(first, count);
    if (!own.isZero()) fault->Apply(own, &hypothesis);
    first += count;
  }
  return hypothesis;
}

Simulator::Simulator(const ObservedExperiment& observed, int threads)
    : observed_(observed),
      threads_(threads),
      actuators_(observed),
      sticking_(actuators_),
      history_(observed) {}

std::vector<std::vector<SamplePart>> Simulator::PartsOf(const ModelHypothesis& hypothesis,
                                                        const Simulation& simulated) const {
  std::vector<std::vector<SamplePart>> parts = actuators_.PartsAt(hypothesis.actuators);
  sticking_.Follow(hypothesis, simulated.samples, &parts);
  return parts;
}

/// Brings samples that are `to_do` to balance, and where it is not known, what rests. False: one
/// failed, and of such as begin from a robot that was not far from there the others were left.
bool Simulator::Sweep(const ModelHypothesis& hypothesis, bool is_near, Detail detail,
                      const std::vector<std::vector<SamplePart>>& parts,
                      const std::vector<bool>& is_to_do, Solvers* solvers,
                      Simulation* simulation) const {
  const auto shares = Shares(observed_, is_to_do, threads_);
  const DriveDistance distance(observed_, parts);
  std::atomic<bool> failed = false;
  OnThreads(shares, [&](const std::vector<std::size_t>& share) {
    std::unique_ptr<SampleSolver>& kept = (*solvers)[At(&share - shares.data())];
    if (!kept) kept = std::make_unique<SampleSolver>(hypothesis, observed_);
    SampleSolver& solver = *kept;
    if (&share == &shares.front() && simulation->at_rest.elastic_Pa.size() == 0) {
      simulation->at_rest = solver.Rest(&simulation->resting);
    }
    StartShapes starts(distance);
    for (const std::size_t s : is_near ? share : distance.FromNearToFar(share)) {
      SimulatedSample& sample = simulation->samples[s];
      if (failed && is_near) {
        sample.status = {StatusCode::kNotConverged, "another sample could not be simulated"};
        sample.seen_m.setConstant(std::numeric_limits<double>::quiet_NaN());
        if (sample.in_the_middle.elastic_Pa.size() == 0)
          sample.in_the_middle = solver.HistoryInputAt({}, sample);
        continue;
      }
      const SimulatedSample was = sample;
      const bool moved = starts.Begin(s, simulation->samples, &sample.middle);
      const auto solve = [&] {
        SolveInParts(observed_.samples[s], parts[s], simulation->history_variables[s], detail,
                     &solver, &sample);
      };
      solve();
      if (moved && !sample.status.ok()) {
        sample = was;
        solve();
      }
      if (sample.status.ok()) {
        starts.Learn(s, was.middle, sample.middle);
      } else {
        failed = true;
      }
    }
  });
  return !failed;
}

Simulation Simulator::Run(const ModelHypothesis& hypothesis, const Simulation* start,
                          Detail detail) const {
  constexpr int kMostSweeps = 8;  // through what the samples remember of each other
  Simulation simulation;
  std::vector<bool> is_to_do(observed_.samples.size(), true);
  if (start != nullptr) simulation = *start;
  simulation.samples.resize(observed_.samples.size());
  simulation.history_variables.resize(observed_.samples.size());
  for (HistoryVariables& history_variables : simulation.history_variables) {
    if (hypothesis.creep.empty())
      history_variables = {0.0, {}, std::move(history_variables.cell_factor)};
    if (!hypothesis.mullins) history_variables.cell_factor.resize(0);
  }
  if (start != nullptr && HasHistory(hypothesis))
    UpdateHistory(hypothesis, history_, simulation, &simulation.history_variables);
  std::vector<std::vector<SamplePart>> parts = PartsOf(hypothesis, simulation);
  simulation.at_rest.elastic_Pa.resize(6, 0);  // it is of the robot that `start` was
  Solvers solvers(static_cast<std::size_t>(threads_));
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const bool known =
        Sweep(hypothesis, start != nullptr, detail, parts, is_to_do, &solvers, &simulation);
    if (detail == Detail::kAllParts) detail = Detail::kParts;
    if (!known || sweep + 1 == kMostSweeps) break;
    is_to_do = sticking_.Follow(hypothesis, simulation.samples, &parts);
    if (HasHistory(hypothesis)) {
      const std::vector<bool> is_other =
          UpdateHistory(hypothesis, history_, simulation, &simulation.history_variables);
      for (std::size_t s = 0; s < is_to_do.size(); ++s) is_to_do[s] = is_to_do[s] || is_other[s];
    }
    if (std::none_of(is_to_do.begin(), is_to_do.end(), [](bool one) { return one; })) break;
  }
  simulation.below_largest_J_m3 = BelowLargest_J_m3(history_, simulation);
  simulation.status = Status::Ok();
  for (const SimulatedSample& sample : simulation.samples) {
    if (simulation.status.ok() && !sample.status.ok()) simulation.status = sample.status;
  }
  return simulation;
}

std::vector<ShapesInTime> Simulator::Shapes(const ModelHypothesis& hypothesis,
                                            const Simulation& simulation) const {
  const std::vector<std::vector<SamplePart>> parts = PartsOf(hypothesis, simulation);
  std::vector<bool> wanted;
  for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
    wanted.push_back(!observed_.samples[s].depth_frames.empty() &&
                     simulation.samples[s].status.ok());
  }
  std::vector<ShapesInTime> shapes(observed_.samples.size());
  OnThreads(Shares(observed_, wanted, threads_), [&](const std::vector<std::size_t>& share) {
    SampleSolver solver(hypothesis, observed_);
    for (const std::size_t s : share) {
      SimulatedSample solved;
      solved.middle = simulation.samples[s].middle;
      for (const SamplePart& part : parts[s]) {
        if (parts[s].size() > 1) {
          solver.SetSliding(part.sliding);
          solver.Solve(observed_.samples[s], part.taken_in, simulation.history_variables[s],
                       &solved);
          if (!solved.status.ok()) break;
        }
        const Eigen::VectorXd x_m = solver.OnFinerMesh(solved.middle.state.x_m);
        shapes[s].t_s.push_back(part.t_s);
        shapes[s].nodes_m.emplace_back(x_m.reshaped(3, x_m.size() / 3).cast<float>());
      }
    }
  });
  return shapes;
}

void Simulator::Differentiate(const ModelHypothesis& hypothesis, const FaultModelList& models,
                              const Eigen::VectorXd& z, const std::vector<bool>& wanted,
                              const ModelHypothesis& nominal, Simulation* simulation) const {
  const std::vector<Eigen::MatrixXd> actuator_change =
      ActuatorChanges(actuators_, nominal, models, z, wanted, hypothesis.actuators);
  const std::vector<std::vector<SamplePart>> parts = PartsOf(hypothesis, *simulation);
  const auto shares =
      Shares(observed_, std::vector<bool>(observed_.samples.size(), true), threads_);
  OnThreads(shares, [&](const std::vector<std::size_t>& share) {
    SampleSolver solver(hypothesis, observed_);
    SampleDifferentiator differentiator(hypothesis, models, z, wanted, actuator_change, observed_,
                                        &solver);
    for (const std::size_t s : SameShapesTogether(share, *simulation)) {
      SimulatedSample& sample = simulation->samples[s];
      solver.Prepare(observed_.samples[s], simulation->history_variables[s]);
      const auto jacobian_m = [&](const HeldShape& shape) -> Eigen::MatrixXd {
        const FaultContext at{.observed = observed_,
                              .hypothesis = hypothesis,
                              .simulation = *simulation,
                              .history = history_,
                              .sample = static_cast<int>(s),
                              .shape = shape,
                              .model = solver.model(),
                              .points = solver.points()};
        solver.SetSliding(parts[s][shape.part].sliding);
        return shape.share * differentiator.At(at);
      };
      Eigen::MatrixXd mean_m = jacobian_m(sample.middle);
      for (const HeldShape& shape : sample.beside) mean_m += jacobian_m(shape);
      if (sample.jacobian_m.size() > 0) KeepUnwanted(models, wanted, sample.jacobian_m, &mean_m);
      sample.jacobian_m = std::move(mean_m);
    }
  });
}

void Simulator::DifferentiateBySimulation(const ModelHypothesis& nominal,
                                          const FaultModelList& models, const Eigen::VectorXd& z,
                                          Simulation* simulation) const {
  constexpr double kStep = 0.1;  // of the parameter's fault sigma: pasts are settled to 1e-4
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const auto count = std::ssize(models[k]->parameters());
    const bool by_simulation = models[k]->NeedsSimulation(z.segment(first, count));
    for (Eigen::Index p = 0; p < count && by_simulation; ++p) {
      const double step = kStep * models[k]->parameters()[At(p)].fault;
      Eigen::VectorXd beside_z = z;
      beside_z[first + p] += step;
      const Simulation beside = Run(HypothesisWith(nominal, models, beside_z), simulation);
      if (!beside.status.ok()) continue;
      for (std::size_t s = 0; s < beside.samples.size(); ++s) {
        SimulatedSample& sample = simulation->samples[s];
        // Of other shapes the mean would differ by more than what the step does.
        if (beside.samples[s].choices != sample.choices) continue;
        sample.jacobian_m.col(first + p) = (beside.samples[s].seen_m - sample.seen_m) / step;
      }
    }
    first += count;
  }
}

}  // namespace palpate::diagnosis
