// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/severity.hpp"

namespace palpate::dds {

/// How messages come on an input.
enum class InputKind {
  kStream,   ///< all the time
  kLatched,  ///< once for each reader; the last one stays valid
};

/// One input that a process needs.
struct InputName {
  std::string topic = {};
  std::string publisher = {};  ///< the program that publishes it
  InputKind kind = InputKind::kStream;
  std::string qos_setting = "topics_file";  ///< that decides what QoS is asked for
  std::string hint = {};  ///< what else may be the reason where nothing comes, with the remedy
};

/// What a reader knows about its input at one time.
struct InputState {
  std::uint64_t taken = 0;               ///< messages since the start
  std::uint32_t publishers = 0;          ///< matched now
  std::uint32_t publishers_ever = 0;     ///< since the start, each reappearance too
  std::uint32_t incompatible_qos = 0;    ///< publishers that do not match because of their QoS
  std::string incompatible_policy = {};  ///< "reliability", "durability", ...; of the last of them
  bool needed = true;                    ///< at this time
};

/// Decides what a log says about inputs that do not come: "waiting for /perception/robot_cloud: no
/// publisher in domain 0; palpate-perception publishes it" after 2 s, again after 8 s, 16 s and so
/// on or when the reason changes, and a line when messages come. Inputs of one publisher and reason
/// share a line. Knows no DDS; time is an argument.
class InputLines {
 public:
  struct Line {
    Severity severity = Severity::kInfo;
    std::string text;
  };

  /// `domain_id`: for the messages. `now_s`: time of the start, of any clock.
  InputLines(std::uint32_t domain_id, double now_s) : domain_id_(domain_id), start_s_(now_s) {}

  void Add(InputName name);

  /// What is to be logged at `now_s`. `states`: of all inputs, in the order of Add().
  std::vector<Line> Advance(double now_s, const std::vector<InputState>& states);

  /// The inputs that are waited for, as the log has them; empty: none.
  std::string Waiting() const;

 private:
  enum class Lack { kNoPublisher, kWrongQos, kNoMessage, kSilent };
  enum class Event { kFirstMessage, kMessagesAgain, kPublisherRestarted };
  struct Input {
    InputName name;
    InputState last;
    double needed_since_s = 0.0;
    std::optional<double> message_s;  ///< when the last message was noticed
    std::optional<Lack> lack;         ///< that was logged
    double lack_since_s = 0.0;        ///< the last message, or the start
    double again_s = 0.0;             ///< when the lack is logged again
    double pause_s = 0.0;
  };

  std::optional<Event> NoteChanges(Input& input, const InputState& state, double now_s) const;
  std::optional<Lack> LackOf(const Input& input, double now_s) const;
  static bool IsDue(Input& input, std::optional<Lack> lack, double now_s);
  std::string TextOf(Lack lack, const std::vector<const Input*>& inputs, double now_s) const;
  static std::string TextOf(Event event, const std::vector<const Input*>& inputs);

  std::uint32_t domain_id_;
  double start_s_;
  double now_s_ = 0.0;
  std::vector<Input> inputs_;
};

}  // namespace palpate::dds
