// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/peers.hpp"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "libs/core/clock.hpp"
#include "libs/core/sha256.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::dds {

namespace {

constexpr std::string_view kKey = "palpate=";

/// "pid:[4026531836]"
std::string ProcessNamespace() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string();
}

std::string ProgramName() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).filename().string();
}

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

bool ParseInteger(const std::string& text, std::int64_t* value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string HashOfAllMessages() {
  std::string bytes;
  for (const TopicNameAndType& topic : AllTopics()) {
    bytes += topic.dds_type;
    bytes += topic.type_information;
  }
  constexpr std::size_t kDigits = 8;
  return Sha256Hex(bytes).substr(0, kDigits);
}

std::string UserDataOf(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

}  // namespace

Guid ToArray(const dds_guid_t& guid) {
  Guid array{};
  std::memcpy(array.data(), guid.v, array.size());
  return array;
}

const std::string& MessagesHash() {
  static const std::string hash = HashOfAllMessages();
  return hash;
}

ProcessIdentity ThisProcess() {
  static const std::int64_t start_ns = WallNow_ns();
  return {.host = ThisHost(),
          .program = ProgramName(),
          .process_id = getpid(),
          .process_namespace = ProcessNamespace(),
          .start_ns = start_ns,
          .messages = MessagesHash()};
}

std::string ToUserData(const ProcessIdentity& process) {
  std::string text(kKey);
  for (const std::string& part :
       {process.host.id, process.host.name, process.program, std::to_string(process.process_id),
        process.process_namespace, std::to_string(process.start_ns), process.messages}) {
    text += part + ",";
  }
  text.back() = ';';
  return text;
}

std::optional<ProcessIdentity> FromUserData(std::string_view user_data) {
  for (const std::string& entry : Split(user_data, ';')) {
    if (!entry.starts_with(kKey)) continue;
    const std::vector<std::string> parts = Split(entry.substr(kKey.size()), ',');
    constexpr std::size_t kParts = 7;
    if (parts.size() < kParts) return std::nullopt;
    ProcessIdentity process{.host = {parts[0], parts[1]},
                            .program = parts[2],
                            .process_namespace = parts[4],
                            .messages = parts[6]};
    if (!ParseInteger(parts[3], &process.process_id)) return std::nullopt;
    if (!ParseInteger(parts[5], &process.start_ns)) return std::nullopt;
    return process;
  }
  return std::nullopt;
}

bool MayRun(const ProcessIdentity& process) {
  const bool numbered_as_here = process.host.id == ThisHost().id &&
                                process.process_namespace == ProcessNamespace() &&
                                process.process_id > 0;
  if (!numbered_as_here) return true;
  return kill(static_cast<pid_t>(process.process_id), 0) == 0 || errno != ESRCH;
}

Peers::Peers(dds_entity_t participant)
    : reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
              "reader of the participants of the domain") {}

void Peers::Update() {
  std::array<void*, 16> samples{};
  std::array<dds_sample_info_t, 16> infos{};
  dds_return_t count = 0;
  while ((count = dds_take(reader_.handle(), samples.data(), infos.data(), samples.size(),
                           samples.size())) > 0) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const auto& peer = *static_cast<const dds_builtintopic_participant_t*>(samples[i]);
      if (infos[i].instance_state == DDS_IST_ALIVE && infos[i].valid_data) {
        all_.insert_or_assign(ToArray(peer.key), FromUserData(UserDataOf(peer.qos)));
      } else {
        all_.erase(ToArray(peer.key));
      }
    }
    dds_return_loan(reader_.handle(), samples.data(), count);
    samples.fill(nullptr);
  }
}

}  // namespace palpate::dds
