// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/repair_verb.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "components/palpate/check_output.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/repair.hpp"

namespace palpate::command {

int Repair(const RepairOptions& options) {
  std::filesystem::path out = options.out;
  if (out.empty()) {
    out = options.file;
    out.replace_filename(options.file.stem().string() + "_repaired.mcap");
  }
  if (std::filesystem::exists(out)) {
    throw InputError({out.string()}, "exists; choose another file with --out");
  }
  CheckOutputFile(out);
  const recording::RepairResult result = recording::Repair(options.file, out);
  if (options.json) {
    const nlohmann::ordered_json json = {
        {"file", out.string()}, {"messages", result.messages}, {"problems", result.problems}};
    fmt::print("{}\n", json.dump(2));
    return app::kExitDone;
  }
  for (const std::string& problem : result.problems) fmt::print("{}\n", problem);
  fmt::print("{}: {} messages, with index and statistics\n", out.string(), result.messages);
  return app::kExitDone;
}

app::Verb RepairVerb() {
  return {"repair", "Restore index and statistics of a cut or damaged MCAP file",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<RepairOptions>();
            arguments.Positional("FILE", &options->file,
                                 "MCAP file, for instance of a recorder that was killed");
            arguments.Option("--out FILE", &options->out,
                             "New MCAP file; without it FILE_repaired.mcap");
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            return [options] { return Repair(*options); };
          }};
}

}  // namespace palpate::command
