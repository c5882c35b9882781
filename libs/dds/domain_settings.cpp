// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/domain_settings.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "libs/core/file.hpp"

namespace palpate::dds {

namespace {

/// Cyclone DDS's own default: larger datagrams are for networks that do not cut them.
constexpr std::int64_t kMostOffHost_B = 14720;

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

/// The parts between the commas outside of XML.
std::vector<std::string> SplitUri(const std::string& uri) {
  std::vector<std::string> parts(1);
  bool in_xml = false;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool separates = uri[i] == ',' && (!in_xml || Trimmed(parts.back()).ends_with('>'));
    if (separates) {
      parts.emplace_back();
      in_xml = false;
      continue;
    }
    in_xml = in_xml || uri[i] == '<';
    parts.back() += uri[i];
  }
  for (std::string& part : parts) part = Trimmed(part);
  std::erase(parts, std::string());
  return parts;
}

/// The end of the "${...}" that begins at `begin`, behind its brace; npos: it has none.
std::size_t EndOfVariable(std::string_view text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text.substr(i, 2) == "${") ++depth;
    if (text[i] == '}' && --depth == 0) return i + 1;
  }
  return text.npos;
}

std::string ValueOf(std::string_view inside, const Environment& environment) {
  const std::size_t colon = inside.find(':');
  const std::string value = environment(std::string(inside.substr(0, colon))).value_or("");
  if (colon == inside.npos || colon + 1 >= inside.size()) return value;
  const std::string_view other = inside.substr(colon + 2);
  if (inside[colon + 1] == '-') return value.empty() ? ExpandVariables(other, environment) : value;
  if (inside[colon + 1] == '+') return value.empty() ? "" : ExpandVariables(other, environment);
  return value;
}

std::optional<std::int64_t> ParseBytes(const std::string& text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  const std::string unit = Lower(Trimmed({end, text.data() + text.size()}));
  if (unit == "kb" || unit == "kib") return number * 1024;
  if (unit == "mb" || unit == "mib") return number * 1024 * 1024;
  return number;
}

/// Walks through one text of settings.
class SettingsReader {
 public:
  SettingsReader(std::string file, std::uint32_t domain_id, const Environment& environment,
                 DomainSettings* settings)
      : file_(std::move(file)),
        domain_(std::to_string(domain_id)),
        environment_(environment),
        settings_(*settings) {}

  void Read(const std::string& xml) {
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) return;
    Walk(document, "");
  }

 private:
  std::string Attribute(const tinyxml2::XMLElement& element, const char* name) const {
    const char* value = element.Attribute(name);
    return value == nullptr ? std::string() : ExpandVariables(value, environment_);
  }
  std::string Content(const tinyxml2::XMLElement& element) const {
    const char* text = element.GetText();
    return text == nullptr ? std::string() : ExpandVariables(Trimmed(text), environment_);
  }
  SourceLocation Where(const tinyxml2::XMLElement& element) const {
    return {.file = file_, .line = element.GetLineNum()};
  }

  bool IsOfAnotherDomain(const tinyxml2::XMLElement& element) const {
    const std::string id = Attribute(element, "Id");
    return !id.empty() && Lower(id) != "any" && id != domain_;
  }

  void Walk(const tinyxml2::XMLNode& node, const std::string& path) {
    for (const auto* element = node.FirstChildElement(); element != nullptr;
         element = element->NextSiblingElement()) {
      const std::string name = Lower(element->Name());
      if (name == "domain" && IsOfAnotherDomain(*element)) continue;
      const bool is_frame = name == "cyclonedds" || name == "domain";
      const std::string own = is_frame ? path : (path.empty() ? name : path + "/" + name);
      if (!is_frame) Take(own, *element);
      Walk(*element, own);
    }
  }

  void Take(const std::string& path, const tinyxml2::XMLElement& element) {
    if (path == "general/interfaces/networkinterface") TakeInterface(element);
    if (path == "general/networkinterfaceaddress") TakeOldInterface(element);
    if (path == "general/allowmulticast") settings_.allow_multicast = Lower(Content(element));
    if (path == "general/maxmessagesize") {
      settings_.max_message_B = ParseBytes(Content(element));
      settings_.max_message_where = Where(element);
    }
    if (path == "discovery/participantindex") settings_.participant_index = Content(element);
    if (path == "discovery/maxautoparticipantindex") {
      settings_.max_participant_index = std::atoi(Content(element).c_str());
    }
    if (path == "discovery/peers/peer") TakePeers(Attribute(element, "Address"), element);
    if (path == "sharedmemory/enable") {
      const std::string value = Lower(Content(element));
      settings_.shared_memory = value == "true" || value == "1";
      settings_.shared_memory_where = Where(element);
    }
    if (path == "security" || path == "omgsecurity" || path == "ddssecurity") {
      settings_.security = true;
      settings_.security_where = Where(element);
    }
  }

  void TakeInterface(const tinyxml2::XMLElement& element) {
    settings_.interfaces.push_back(
        {.name = Attribute(element, "name"),
         .address = Attribute(element, "address"),
         .automatic = Lower(Attribute(element, "autodetermine")) == "true",
         .where = Where(element)});
  }

  void TakeOldInterface(const tinyxml2::XMLElement& element) {
    const std::string value = Content(element);
    settings_.interfaces.push_back({.name = value == "auto" ? "" : value,
                                    .address = {},
                                    .automatic = value == "auto",
                                    .where = Where(element)});
  }

  void TakePeers(std::string list, const tinyxml2::XMLElement& element) {
    if (list.empty()) list = Attribute(element, "address");
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      const std::string peer = Trimmed(std::string_view(list).substr(begin, end - begin));
      if (!peer.empty()) settings_.peers.push_back(peer);
      begin = end + 1;
    }
  }

  std::string file_;
  std::string domain_;
  const Environment& environment_;
  DomainSettings& settings_;
};

bool IsChosen(const NetworkInterface& interface, const std::vector<ChosenInterface>& chosen) {
  return std::any_of(chosen.begin(), chosen.end(), [&](const ChosenInterface& one) {
    const auto& addresses = interface.addresses;
    const auto has = [&](const std::string& address) {
      return std::find(addresses.begin(), addresses.end(), address) != addresses.end();
    };
    return (!one.name.empty() && one.name == interface.name) ||
           (!one.address.empty() && has(one.address)) || has(one.name);
  });
}

}  // namespace

std::optional<std::string> ProcessEnvironment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::string ExpandVariables(std::string_view text, const Environment& environment) {
  std::string expanded;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = text.substr(i, 2) == "${" ? EndOfVariable(text, i) : text.npos;
    if (end == text.npos) {
      expanded += text[i++];
    } else {
      expanded += ValueOf(text.substr(i + 2, end - i - 3), environment);
      i = end;
    }
  }
  return expanded;
}

DomainSettings ReadDomainSettings(const std::string& uri, std::uint32_t domain_id,
                                  const Environment& environment) {
  DomainSettings settings;
  for (const std::string& part : SplitUri(uri)) {
    if (part.starts_with('<')) {
      SettingsReader("CYCLONEDDS_URI", domain_id, environment, &settings).Read(part);
      continue;
    }
    constexpr std::string_view kScheme = "file://";
    const std::string file = part.starts_with(kScheme) ? part.substr(kScheme.size()) : part;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      settings.missing_files.push_back(file);
      continue;
    }
    SettingsReader(file, domain_id, environment, &settings).Read(ReadFile(file));
  }
  if (environment("ROS_SECURITY_ENABLE") == "true") {
    settings.security = true;
    settings.security_where.file = "ROS_SECURITY_ENABLE";
  }
  return settings;
}

bool LeavesHost(const DomainSettings& settings, const std::vector<NetworkInterface>& interfaces) {
  const bool chooses =
      settings.interfaces.empty() ||
      std::any_of(settings.interfaces.begin(), settings.interfaces.end(),
                  [](const ChosenInterface& interface) { return interface.automatic; });
  return std::any_of(interfaces.begin(), interfaces.end(), [&](const NetworkInterface& interface) {
    return interface.is_up && !interface.is_loopback && !interface.addresses.empty() &&
           (chooses || IsChosen(interface, settings.interfaces));
  });
}

std::string RefusalOf(const DomainSettings& settings,
                      const std::vector<NetworkInterface>& interfaces) {
  if (settings.shared_memory && settings.security) {
    return settings.shared_memory_where.ToString() + ": shared memory passes by DDS Security (" +
           settings.security_where.ToString() +
           "): every process of this host could read what is to be encrypted; set "
           "SharedMemory/Enable to false";
  }
  if (settings.max_message_B.value_or(0) > kMostOffHost_B && LeavesHost(settings, interfaces)) {
    return settings.max_message_where.ToString() + ": MaxMessageSize " +
           std::to_string(*settings.max_message_B) +
           " B is for loopback alone: a network cuts such datagrams into IP fragments, and one "
           "lost fragment loses all; name the interface lo, or give 1400B (lan.xml), 8900B "
           "(jumbo_lan.xml)";
  }
  return {};
}

}  // namespace palpate::dds
