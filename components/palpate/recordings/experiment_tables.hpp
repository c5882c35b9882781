// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/recordings/collected_topics.hpp"
#include "components/palpate/recordings/phase_plan.hpp"

namespace palpate::command {

/// The frames in which markers may be.
struct MarkerFrames {
  std::string robot;
  std::vector<std::string> camera;  ///< of the depth camera's optical frame
};

/// The tables of one phase, on the clock of t_s. Each throws InputError for what such a table must
/// not hold, with the topic and the remedy.
void AddMarkers(const CollectedTopics& topics, const Phase& phase, const MarkerFrames& frames,
                experiment::Recording* recording, std::vector<std::string>* notes);
/// `cables`: joint -> cable; empty: joints have the names of cables.
void AddActuation(const CollectedTopics& topics, const Phase& phase,
                  const std::map<std::string, std::string>& cables, const TopicRoles& roles,
                  experiment::Recording* recording);
void AddLoads(const CollectedTopics& topics, const Phase& phase, const PhaseFile& file,
              const TopicRoles& roles, experiment::Recording* recording,
              std::vector<std::string>* notes);

/// The noise that the messages state; nullopt: none, or not one for all.
std::optional<Eigen::Vector3d> MarkerSigma(const std::vector<CollectedMarkers>& frames);

}  // namespace palpate::command
