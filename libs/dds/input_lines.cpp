// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/input_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/text.hpp"

namespace palpate::dds {

namespace {

constexpr double kSilence_s = 2.0;
constexpr double kFirstPause_s = 8.0;
constexpr double kLongestPause_s = 600.0;

std::string TenthsOf(double seconds) { return FormatNumber(std::round(10.0 * seconds) / 10.0); }

std::string Misfit(const std::string& policy) {
  if (policy == "reliability") return "it is best_effort, reliable is asked for";
  if (policy == "durability") return "it is volatile, transient_local is asked for";
  return policy + " is weaker than asked for";
}

}  // namespace

void InputLines::Add(InputName name) {
  Input input;
  input.name = std::move(name);
  input.needed_since_s = input.lack_since_s = start_s_;
  inputs_.push_back(std::move(input));
}

std::vector<InputLines::Line> InputLines::Advance(double now_s,
                                                  const std::vector<InputState>& states) {
  PALPATE_CHECK(states.size() == inputs_.size(), states.size(), inputs_.size());
  using Publisher = std::string;
  std::map<std::pair<Event, Publisher>, std::vector<const Input*>> events;
  std::map<std::pair<Lack, Publisher>, std::vector<const Input*>> lacks;
  now_s_ = now_s;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    Input& input = inputs_[i];
    if (const auto event = NoteChanges(input, states[i], now_s)) {
      events[{*event, input.name.publisher}].push_back(&input);
    }
    const std::optional<Lack> lack = LackOf(input, now_s);
    if (IsDue(input, lack, now_s)) lacks[{*lack, input.name.publisher}].push_back(&input);
  }
  std::vector<Line> lines;
  for (const auto& [event, inputs] : events) {
    lines.push_back({Severity::kInfo, TextOf(event.first, inputs)});
  }
  for (const auto& [lack, inputs] : lacks) {
    lines.push_back({Severity::kWarning, TextOf(lack.first, inputs, now_s)});
  }
  return lines;
}

std::string InputLines::Waiting() const {
  std::map<std::pair<Lack, std::string>, std::vector<const Input*>> lacks;
  for (const Input& input : inputs_) {
    if (input.lack) lacks[{*input.lack, input.name.publisher}].push_back(&input);
  }
  std::vector<std::string> texts;
  for (const auto& [lack, inputs] : lacks) texts.push_back(TextOf(lack.first, inputs, now_s_));
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

/// Takes over the state; what is to be said about its change.
std::optional<InputLines::Event> InputLines::NoteChanges(Input& input, const InputState& state,
                                                         double now_s) const {
  const InputState before = std::exchange(input.last, state);
  const bool restarted =
      before.publishers_ever > 0 && state.publishers_ever > before.publishers_ever;
  if (state.needed && !before.needed) input.needed_since_s = now_s;
  const bool first = !input.message_s;
  if (state.taken > before.taken) {
    input.message_s = now_s;
    if (input.lack) return first ? Event::kFirstMessage : Event::kMessagesAgain;
  }
  return restarted ? std::optional(Event::kPublisherRestarted) : std::nullopt;
}

std::optional<InputLines::Lack> InputLines::LackOf(const Input& input, double now_s) const {
  if (!input.last.needed) return std::nullopt;
  if (input.name.kind == InputKind::kLatched && input.message_s) return std::nullopt;
  const double since_s = std::max(input.message_s.value_or(start_s_), input.needed_since_s);
  if (now_s - since_s < kSilence_s) return std::nullopt;
  if (input.last.publishers == 0) {
    return input.last.incompatible_qos > 0 ? Lack::kWrongQos : Lack::kNoPublisher;
  }
  return input.message_s ? Lack::kSilent : Lack::kNoMessage;
}

/// Whether the lack is to be logged now.
bool InputLines::IsDue(Input& input, std::optional<Lack> lack, double now_s) {
  if (!lack) {
    input.lack.reset();
    return false;
  }
  input.lack_since_s = input.message_s.value_or(input.needed_since_s);
  if (std::exchange(input.lack, lack) != lack) {
    input.pause_s = kFirstPause_s;
  } else if (now_s >= input.again_s) {
    input.pause_s = std::min(2.0 * input.pause_s, kLongestPause_s);
  } else {
    return false;
  }
  input.again_s = now_s + input.pause_s;
  return true;
}

std::string InputLines::TextOf(Lack lack, const std::vector<const Input*>& inputs,
                               double now_s) const {
  std::vector<std::string> topics;
  double silent_s = 0.0;
  for (const Input* input : inputs) {
    topics.push_back(input->name.topic);
    silent_s = std::max(silent_s, now_s - input->lack_since_s);
  }
  const std::string text = "waiting for " + Listed(topics) + ": ";
  const std::string& publisher = inputs.front()->name.publisher;
  const std::string& hint = inputs.front()->name.hint;
  const std::string end = hint.empty() ? "" : "; " + hint;
  switch (lack) {
    case Lack::kNoPublisher:
      return text + "no publisher in domain " + std::to_string(domain_id_) + "; " + publisher +
             (inputs.size() == 1 ? " publishes it" : " publishes them") + end;
    case Lack::kWrongQos:
      return text + "the publisher's QoS does not match: " +
             Misfit(inputs.front()->last.incompatible_policy) + " (" +
             inputs.front()->name.qos_setting + ")";
    case Lack::kNoMessage:
      return text + "no message within " + TenthsOf(silent_s) + " s; publisher present" + end;
    case Lack::kSilent:
      return text + "no message for " + TenthsOf(silent_s) + " s; publisher present";
  }
  PALPATE_CHECK(false, static_cast<int>(lack));
  return {};
}

std::string InputLines::TextOf(Event event, const std::vector<const Input*>& inputs) {
  std::vector<std::string> topics;
  for (const Input* input : inputs) topics.push_back(input->name.topic);
  const std::string text = Listed(topics) + ": ";
  switch (event) {
    case Event::kFirstMessage: return text + "first message";
    case Event::kMessagesAgain: return text + "messages again";
    case Event::kPublisherRestarted:
      return text + "another publisher appeared: " + inputs.front()->name.publisher +
             " was restarted, or runs twice";
  }
  PALPATE_CHECK(false, static_cast<int>(event));
  return {};
}

}  // namespace palpate::dds
