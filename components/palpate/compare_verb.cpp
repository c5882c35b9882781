// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare_verb.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "components/palpate/compare/comparison_output.hpp"
#include "components/palpate/compare/file_comparison.hpp"
#include "components/palpate/estimate/known_truth.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

void RequireAtLeast0(const char* option, double value) {
  if (value >= 0.0) return;
  throw InputError(std::string(option) + ": must be 0 or more, not " + FormatNumber(value));
}

FileComparisonRules RulesOf(const CompareOptions& options) {
  RequireAtLeast0("--same-place", options.same_place_m);
  RequireAtLeast0("--smallest", options.smallest_N);
  RequireAtLeast0("--same-time", options.same_time_s);
  RequireAtLeast0("--longest-gap", options.longest_gap_s);
  FileComparisonRules rules{
      .recordings = options.recordings,
      .time_offset_s = options.time_offset_s,
      .timing = {.same_time_s = options.same_time_s, .longest_gap_s = options.longest_gap_s},
      .silence_is_no_contact = options.silence_is_no_contact,
      .same_place_m = options.same_place_m,
      .smallest_N = std::nullopt};
  if (options.smallest_N > 0.0) rules.smallest_N = options.smallest_N;
  if (!options.robot.empty()) {
    rules.same_place_m = SamePlace_m(BodyDiagonal_m(LoadRobot(options.robot)->body()));
  }
  return rules;
}

std::string FramesText(const RecordingScore& score) {
  std::string text = fmt::format("{} frames", score.frames);
  if (score.without_result > 0) text += fmt::format(", {} without a result", score.without_result);
  if (score.without_truth > 0) text += fmt::format(", {} without a truth", score.without_truth);
  return text;
}

std::string ToText(const FileComparison& comparison) {
  std::string text = fmt::format("forces of {:.3g} N or more, within {:.3g} mm\n",
                                 comparison.rules.smallest_N, 1e3 * comparison.rules.same_place_m);
  for (const RecordingScore& score : comparison.recordings) {
    const std::string name = score.name.empty() ? "forces" : score.name;
    text += fmt::format("{}: {}; {}\n", name, FramesText(score), ToLine(score.summary));
  }
  return text + "all:\n" + ToTable(comparison.all);
}

nlohmann::ordered_json ToJson(const FileComparison& comparison, const CompareOptions& options) {
  nlohmann::ordered_json recordings = nlohmann::ordered_json::array();
  for (const RecordingScore& score : comparison.recordings) {
    recordings.push_back({{"recording", score.name},
                          {"estimated_frames", score.frames},
                          {"without_result", score.without_result},
                          {"without_truth", score.without_truth},
                          {"comparison", ToJson(score.summary)}});
  }
  return {{"estimated", options.estimated.string()},
          {"truth", options.truth.string()},
          {"same_place_m", comparison.rules.same_place_m},
          {"smallest_N", comparison.rules.smallest_N},
          {"steady_window_s", comparison.rules.steady_window_s},
          {"recordings", recordings},
          {"all", ToJson(comparison.all)},
          {"notes", comparison.notes}};
}

void DeclareTimes(app::Arguments& arguments, CompareOptions* options) {
  arguments.Option("--time-offset S", &options->time_offset_s,
                   "Seconds to add to the times of ESTIMATED, where the clocks differ");
  arguments.Option("--same-time S", &options->same_time_s,
                   "A row of TRUTH this near is of the same time; else it is interpolated");
  arguments.Option("--longest-gap S", &options->longest_gap_s,
                   "Longest time between two rows of TRUTH between which it is interpolated");
  arguments.Flag("--silence-is-no-contact", &options->silence_is_no_contact,
                 "Times of TRUTH without a row of ESTIMATED within --longest-gap are frames in "
                 "which it found nothing");
}

}  // namespace

int Compare(const CompareOptions& options) {
  const FileComparisonRules rules = RulesOf(options);
  const FileComparison comparison =
      CompareForces(ReadForceFile(options.estimated), ReadForceFile(options.truth), rules);
  if (options.json) {
    fmt::print("{}\n", ToJson(comparison, options).dump(2));
    return app::kExitDone;
  }
  for (const std::string& note : comparison.notes) {
    fmt::print(stderr, "palpate compare: {}\n", note);
  }
  fmt::print("{}", ToText(comparison));
  return app::kExitDone;
}

app::Verb CompareVerb() {
  return {"compare", "Compare estimated forces with true ones",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<CompareOptions>();
            arguments.Positional("ESTIMATED", &options->estimated,
                                 "forces.csv of palpate estimate, or any CSV file with its columns "
                                 "t_s, x_m, y_m, z_m, fx_N, fy_N, fz_N");
            arguments.Positional("TRUTH", &options->truth,
                                 "The same, loads.csv, or EXP.answer.json of palpate simulate");
            arguments.Option("--robot", &options->robot,
                             "Robot file: contacts pair within a tenth of its diagonal, as "
                             "palpate estimate --answer has it");
            arguments.Option("--same-place M", &options->same_place_m,
                             "Largest distance of an estimate from its true force, m");
            arguments.Option("--smallest N", &options->smallest_N,
                             "True forces below may be missed, N; 0: a tenth of the largest one");
            arguments.Repeated("--recording NAME", &options->recordings,
                               "Compare this recording; without it all that both files have");
            DeclareTimes(arguments, options.get());
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            return [options] { return Compare(*options); };
          }};
}

}  // namespace palpate::command
