// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/node_options.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"

namespace palpate::app {

namespace {

// Above 232 the ports that DDS derives from the domain do not exist (RTPS 2.3, section 9.6.1.1).
constexpr int kMaxDomain = 232;
constexpr int kDomainNotGiven = -1;

int DomainOfEnvironment() {
  const char* variable = std::getenv("ROS_DOMAIN_ID");
  const std::string text = variable == nullptr ? "" : variable;
  if (text.empty()) return 0;
  int domain = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), domain);
  const bool whole = result.ec == std::errc() && result.ptr == text.data() + text.size();
  if (!whole || domain < 0 || domain > kMaxDomain) {
    throw InputError("environment variable ROS_DOMAIN_ID: must be 0 to " +
                     std::to_string(kMaxDomain) + ", not '" + text + "'");
  }
  return domain;
}

void ReplaceKeystore(const std::filesystem::path& keystore, const std::vector<Setting>& settings) {
  if (keystore.empty()) return;
  for (const Setting& setting : settings) {
    if (setting.key == "dds.security") {
      *std::get<std::filesystem::path*>(setting.value) = keystore;
    }
  }
}

void AddRules(const std::vector<std::string>& rules, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) {
    if (setting.key != "dds.remap") continue;
    auto& list = *std::get<std::vector<std::string>*>(setting.value);
    list.insert(list.end(), rules.begin(), rules.end());
  }
}

}  // namespace

void DeclareDomain(Arguments& arguments, int* domain_id) {
  *domain_id = kDomainNotGiven;
  arguments.Option("--domain", domain_id, 0, kMaxDomain,
                   "DDS domain; without it the value of ROS_DOMAIN_ID, else 0");
}

void SettleDomain(int* domain_id) {
  if (*domain_id == kDomainNotGiven) *domain_id = DomainOfEnvironment();
}

void DeclareSecurity(Arguments& arguments, std::filesystem::path* keystore) {
  arguments.Option("--security KEYSTORE", keystore,
                   "Keystore of a secured domain (palpate security init); without it the value of "
                   "PALPATE_SECURITY_DIR, else the domain is not secured");
}

void SettleSecurity(const std::filesystem::path& keystore) {
  if (keystore.empty()) return;
  setenv("PALPATE_SECURITY_DIR", std::filesystem::absolute(keystore).c_str(), 1);
}

void DeclareNodeOptions(Arguments& arguments, NodeOptions* options) {
  arguments.Option("--config", &options->config_file,
                   "Settings file (YAML); settings that it lacks keep their defaults");
  arguments.Repeated("--set KEY=VALUE", &options->overrides,
                     "Change one setting; overrides the settings file");
  arguments.Repeated("--remap FROM:=TO", &options->remap,
                     "Another name for a topic, __node or __ns, as ros2 run has it");
  DeclareDomain(arguments, &options->domain_id);
  DeclareSecurity(arguments, &options->security);
  arguments.Choice("--log-level LEVEL", &options->log_level, {"debug", "info", "warning", "error"},
                   "Lowest severity that is logged: debug, info, warning or error");
  arguments.Flag("--print-config", &options->print_config,
                 "Print all settings with their values as a settings file and exit");
  arguments.Flag("--markdown", &options->markdown,
                 "With --print-config: print a Markdown table instead");
}

bool SettleNodeOptions(const std::vector<Setting>& settings, NodeOptions* options) {
  if (options->markdown && !options->print_config) {
    throw InputError("--markdown needs --print-config: give both");
  }
  SettleDomain(&options->domain_id);
  if (!options->config_file.empty()) {
    const std::string bytes = ReadFile(options->config_file);
    options->config_sha256 = Sha256Hex(bytes);
    LoadSettings(ParseYaml(bytes, options->config_file.string()), settings);
  }
  for (const std::string& assignment : options->overrides) ApplyOverride(assignment, settings);
  AddRules(options->remap, settings);
  ReplaceKeystore(options->security, settings);
  if (!options->print_config) return true;
  std::fputs((options->markdown ? PrintMarkdown(settings) : PrintYaml(settings)).c_str(), stdout);
  return false;
}

}  // namespace palpate::app
