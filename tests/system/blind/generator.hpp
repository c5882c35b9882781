// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "libs/scenario/effect.hpp"
#include "tests/system/blind/blind_case.hpp"

namespace palpate::blind {

/// A scenario without the recordings that are of other names.
std::string WithRecordings(const std::string& scenario, const std::set<std::string>& names);

/// Makes experiments of config/scenarios/diagnose.yaml with `palpate simulate`, each a process; of
/// the robot file rod.yaml, those of diagnose_rod.yaml on the body of MeshesOfRod; of robots with
/// chambers CoarseScenario of theirs.
/// Where pictures are asked for, a small depth camera takes them in the place of markers.
class Generator {
 public:
  /// Works in `folder`, which is there.
  Generator(std::filesystem::path robot_file, std::filesystem::path folder,
            Measured measured = Measured::kMarkers);

  /// From now on only recordings of these names are made.
  void Keep(const std::set<std::string>& recordings);

  /// `experiment` and `answer`: files that are not there yet. Throws RunError with what the program
  /// said. `further`: items of the scenario's `recordings` that are made behind its own.
  void Make(const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed,
            const std::filesystem::path& experiment, const std::filesystem::path& answer,
            const std::string& further = {}) const;

  /// How far each effect moves the markers in the recording where it moves them most, beside the
  /// others: RMS over all coordinates of all markers of a recording, m, whatever `experiment`
  /// shows, which was made with all of them by Make; for each, another without it but with the same
  /// seed, so that noise and clutter are the same and drop out.
  std::vector<double> EffectSizes_m(const std::vector<scenario::ActiveEffect>& effects,
                                    std::uint64_t seed,
                                    const std::filesystem::path& experiment) const;

 private:
  void MakeFrom(const std::string& scenario_text,
                const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed,
                const std::filesystem::path& experiment, const std::filesystem::path& answer) const;

  std::filesystem::path robot_file_;
  std::filesystem::path folder_;
  std::string scenario_text_;  ///< with markers
  Measured measured_;
};

/// All effects but one, which is not just left out: it would get clutter in its place, so that it
/// is set to its nominal value where its kind has clutter.
std::vector<scenario::ActiveEffect> WithoutEffect(std::vector<scenario::ActiveEffect> effects,
                                                  std::size_t index);

/// Coordinates of the markers by recording, in the order of the rows, m.
std::map<std::string, Eigen::VectorXd> MarkerCoordinates_m(const std::filesystem::path& experiment);

}  // namespace palpate::blind
