// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/offline/messages/collected_topics.hpp"
#include "components/offline/messages/phase_plan.hpp"

namespace palpate::offline {

/// The frames in which markers may be.
struct MarkerFrames {
  std::string robot;
  std::vector<std::string> camera;  ///< of the depth camera's optical frame
};

/// The tables of one phase, on the clock of t_s. Each throws InputError for what such a table must
/// not hold, with the topic and the remedy.
void AddMarkers(const CollectedTopics& topics, const Phase& phase, const MarkerFrames& frames,
                experiment::Recording* recording, std::vector<std::string>* notes);
void AddLoads(const CollectedTopics& topics, const Phase& phase, const PhaseFile& file,
              const TopicRoles& roles, experiment::Recording* recording,
              std::vector<std::string>* notes);

/// The inputs of all phases, put into rows once.
class ActuationRows {
 public:
  /// `cables`: joint -> actuator; empty: joints have the names of actuators. Those named in
  /// `chambers` are chambers, all others cables. Throws InputError as AddMarkers.
  ActuationRows(const CollectedTopics& topics, const std::map<std::string, std::string>& cables,
                const std::vector<std::string>& chambers, const TopicRoles& roles);

  void AddTo(const Phase& phase, experiment::Recording* recording);

 private:
  using Time = std::pair<int, std::int64_t>;  ///< segment, t_ns
  /// Rows of several publishers at one time are one.
  using Rows = std::map<Time, std::map<std::string, CollectedJoint>>;
  struct Part {
    std::vector<Time> times;
    experiment::Actuation table;
  };

  static Part PartOf(const Rows& rows, const std::vector<std::string>& chambers, int segment);
  static experiment::Actuation RowsWithin(const Part& all, const Phase& phase);

  std::vector<std::string> chambers_;
  Rows rows_;
  std::map<int, Part> parts_;  ///< by segment, made where it is first needed
};

/// The noise that the messages state; nullopt: none, or not one for all.
std::optional<Eigen::Vector3d> MarkerSigma(const std::vector<CollectedMarkers>& frames);

}  // namespace palpate::offline
