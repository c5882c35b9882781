// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_verb.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/load_cases.hpp"
#include "components/palpate/progress_line.hpp"
#include "components/palpate/solve_output.hpp"
#include "components/palpate/solve_rows.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"

namespace palpate::command {

namespace {

LoadCases ReadCases(const SolveOptions& options, const robot::RobotModel& model) {
  std::optional<experiment::ActuationWithGas> actuation;
  if (!options.actuation.empty()) {
    actuation = ReadActuationRows(options.actuation);
    CheckAir(*actuation, model.body().chambers);
  }
  std::vector<experiment::KnownLoad> loads;
  if (!options.loads.empty()) {
    loads = experiment::ReadLoads(options.loads);
  }
  return MakeLoadCases(actuation, loads, model.traits(), ParseCableInput(options.cable_input));
}

std::vector<std::string> AllNotes(const LoadCases& cases, const robot::RobotModel& model) {
  std::vector<std::string> notes = model.body().notes;
  notes.insert(notes.end(), cases.notes.begin(), cases.notes.end());
  const std::vector<std::string> on_loads = NotesOnLoads(cases.rows, model);
  notes.insert(notes.end(), on_loads.begin(), on_loads.end());
  return notes;
}

void PrintRow(const RowResult& result, const std::vector<robot::ActuatorTraits>& actuators) {
  if (!result.converged()) {
    fmt::print("row {} (t = {:g} s) failed: {}: {}; {:.0f} % of the load was reached\n", result.row,
               result.t_s, ToString(result.solver.status.code()), result.solver.status.message(),
               100.0 * result.solver.load_fraction);
    return;
  }
  fmt::print("row {} (t = {:g} s)  {} iterations, residual {:.1e} N, {:.0f} ms", result.row,
             result.t_s, result.solver.iterations, result.solver.residual_N, 1e3 * result.time_s);
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    fmt::print("  {}", ActuatorText(actuators[a], result.actuators[a]));
  }
  fmt::print("\n");
  for (const std::string& note : result.notes) {
    fmt::print("  note: {}\n", note);
  }
}

std::string WordsOfRow(int row, const fem::StaticResult& so_far) {
  return fmt::format("row {}: {:.0f} % of its load in {} load steps, {} Newton iterations", row,
                     100.0 * so_far.load_fraction, so_far.load_steps, so_far.iterations);
}

void PrintResult(const SolveOptions& options, const robot::RobotModel& model,
                 const RowResult& result) {
  if (!options.json) {
    PrintRow(result, model.traits());
  } else if (!result.converged()) {
    fmt::print(stderr, "palpate solve: row {}: {}\n", result.row, result.solver.status.message());
  }
  std::fflush(stdout);
}

}  // namespace

int Solve(const SolveOptions& options) {
  CheckOutputFolder(options.out);
  const std::unique_ptr<robot::RobotModel> model = LoadRobot(options.robot, options.solver);
  const LoadCases cases = ReadCases(options, *model);
  const std::vector<std::string> notes = AllNotes(cases, *model);
  const int total = static_cast<int>(cases.rows.size());
  SolveOutput output(options.out, *model, {.vtu = options.vtu, .png = options.png}, total);
  if (!options.json) {
    for (const std::string& note : notes) {
      fmt::print("note: {}\n", note);
    }
  }
  const app::StopSignal stop;
  int done = 0;
  int converged = 0;
  ProgressLine progress("rows", total);
  const auto take = [&](const RowResult& result) {
    output.Add(result);
    converged += result.converged() ? 1 : 0;
    progress.Clear();
    PrintResult(options, *model, result);
    progress.Update(++done);
  };
  const auto watch = [&](int row, const fem::StaticResult& so_far) {
    progress.Update(row, so_far.load_fraction, [&] { return WordsOfRow(row, so_far); });
    return !stop.Requested();
  };
  const bool all = SolveRows(cases.rows, model.get(), take, watch);
  progress.Clear();
  const std::string json = output.Finish(notes, !all);
  if (options.json) fmt::print("{}", json);
  if (!all) {
    throw app::Interrupted(
        fmt::format("after {} of {} rows: they are in {}", done, total, options.out.string()));
  }
  if (!options.json) {
    fmt::print("{} of {} rows in equilibrium; written to {}\n", converged, total,
               options.out.string());
  }
  return converged == total ? app::kExitDone : app::kExitFailed;
}

app::Verb SolveVerb() {
  return {"solve", "Compute static equilibria of a robot under cables, chambers, loads and gravity",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<SolveOptions>();
            DeclareRobot(arguments, &options->robot);
            arguments.Option(
                "--actuation", &options->actuation,
                "CSV file with the columns t_s and CABLE.displacement_m or "
                "CABLE.tension_N, CHAMBER.pressure_Pa, CHAMBER.volume_m3 or, of a closed "
                "chamber, CHAMBER.air_m3 (pumped in, at ambient pressure); each row "
                "is one static state; without it nothing is actuated");
            arguments.Option("--loads", &options->loads,
                             "CSV file with the columns t_s, x_m, y_m, z_m, fx_N, fy_N, fz_N and "
                             "optionally patch_radius_m; a row holds until the next one; without "
                             "it there is no load but gravity");
            arguments.Option("--out FOLDER", &options->out, "Folder of the results",
                             app::Need::kRequired);
            DeclareSolverOptions(arguments, &options->solver);
            DeclareCableInput(arguments, &options->cable_input);
            arguments.Flag("--vtu", &options->vtu,
                           "Also write the body of each row for ParaView: body_0000.vtu "
                           "(undeformed points, displacement_m, load_N, stress, strain), "
                           "cables_0000.vtu (tension_N), and body.pvd, which lists them by time");
            arguments.Flag("--png", &options->png,
                           "Also draw the deformed body and the loads of each row: "
                           "scene_0000.png");
            arguments.Flag("--json", &options->json, "Print result.json instead of text");
            return [options] { return Solve(*options); };
          }};
}

}  // namespace palpate::command
