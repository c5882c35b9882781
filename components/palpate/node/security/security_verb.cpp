// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/security/security_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "components/palpate/launch/launch_plan.hpp"
#include "components/palpate/security/keystore.hpp"
#include "components/palpate/security/keystore_check.hpp"
#include "components/palpate/security/security_report.hpp"
#include "components/palpate/security/wanted_identities.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/access_rights.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/topic_names.hpp"

namespace palpate::command {

namespace {

constexpr int kMostDays = 7300;

std::int64_t Now_s() { return WallNow_ns() / 1'000'000'000; }

dds::TopicTable Table() { return dds::LoadTopicTable({}, app::LoadYaml, app::ParseYaml); }

RightsOfIdentity Rights() {
  const auto table = std::make_shared<dds::TopicTable>(Table());
  return [table](const Identity& identity) {
    const dds::TopicNames names("palpate_" + identity.role, identity.node_namespace, identity.remap,
                                *table);
    return dds::RightsOf(*table, identity.role, names);
  };
}

std::vector<Identity> OfRoles(const std::vector<std::string>& roles) {
  std::vector<Identity> identities;
  for (const std::string& role : roles) {
    identities.push_back({.name = role, .role = role, .host = {}, .remap = {}});
  }
  return identities;
}

/// The identities that the command line names; nothing named: none.
std::vector<Identity> Named(const SecurityOptions& options) {
  std::vector<Identity> identities;
  for (const std::string& text : options.names) {
    Identity identity = ParseIdentity(text);
    if (!options.node_namespace.empty()) identity.node_namespace = options.node_namespace;
    identity.remap = options.remap;
    identities.push_back(std::move(identity));
  }
  return identities;
}

std::vector<Identity> OfSystem(const SecurityOptions& options) {
  if (options.system.empty()) return {};
  std::vector<Identity> identities =
      IdentitiesOfSystem(ReadSystemFile(FindSystemFile(options.system), app::LoadYaml));
  // For the commands; where they are typed is not in the file.
  for (const Identity& command : OfRoles({dds::kObserver, dds::kOperator})) {
    identities.push_back(command);
  }
  return identities;
}

std::vector<Identity> Wanted(const SecurityOptions& options) {
  std::vector<Identity> identities = OfSystem(options);
  const std::vector<Identity> named = Named(options);
  std::copy(named.begin(), named.end(), std::back_inserter(identities));
  return identities;
}

void Print(const Keystore& keystore, const SecurityOptions& options, const std::string& text) {
  fmt::print("{}", options.json ? KeystoreJson(keystore) : text);
}

int Init(const SecurityOptions& options) {
  std::vector<Identity> identities = Wanted(options);
  if (identities.empty()) identities = OfRoles(dds::OwnRolesOf(Table()));
  const RightsOfIdentity rights = Rights();
  for (const Identity& identity : identities) (void)rights(identity);  // before anything is made
  Keystore keystore = Keystore::Create(options.keystore, Now_s());
  keystore.Enroll(identities, rights, options.days, Now_s());
  const std::string folder = options.keystore.string();
  Print(keystore, options,
        fmt::format("{}: two authorities and {} identities, valid for {} days\n"
                    "keep {}/private on this host alone\n{}"
                    "start every process with --security {} or PALPATE_SECURITY_DIR={}\n",
                    folder, identities.size(), options.days, folder, CopyText(keystore), folder,
                    std::filesystem::absolute(options.keystore).string()));
  return app::kExitDone;
}

int Enroll(const SecurityOptions& options) {
  Keystore keystore(options.keystore);
  std::vector<Identity> identities = Wanted(options);
  if (identities.empty()) throw InputError("enroll needs NAME or --system FILE");
  // A name alone renews what is there.
  for (Identity& identity : identities) {
    const auto known = keystore.manifest().identities.find(identity.name);
    const bool is_bare =
        std::find(options.names.begin(), options.names.end(), identity.name) != options.names.end();
    if (is_bare && known != keystore.manifest().identities.end() &&
        options.node_namespace.empty() && options.remap.empty()) {
      identity = known->second.identity;
    }
  }
  keystore.Enroll(identities, Rights(), options.days, Now_s());
  std::vector<std::string> names;
  for (const Identity& identity : identities) names.push_back(identity.name);
  Print(keystore, options,
        fmt::format("enrolled {}, valid for {} days\n{}", Listed(names), options.days,
                    OutdatedText(keystore)));
  return app::kExitDone;
}

int Revoke(const SecurityOptions& options) {
  if (options.names.empty()) throw InputError("revoke needs NAME");
  Keystore keystore(options.keystore);
  keystore.Revoke(options.names, Now_s());
  Print(keystore, options,
        fmt::format("revoked {}\n{}", Listed(options.names), OutdatedText(keystore)));
  return app::kExitDone;
}

std::pair<std::string, std::filesystem::path> HostAndPath(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0 || equals + 1 == text.size()) {
    throw InputError("--host " + Excerpt(text) + ": must be HOST=PATH, PATH with enclaves/ in it");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void Append(const std::vector<security::Finding>& more, KeystoreState* state) {
  state->findings.insert(state->findings.end(), more.begin(), more.end());
}

KeystoreState CheckWhole(const SecurityOptions& options) {
  Keystore keystore(options.keystore);
  std::vector<security::Finding> of_hosts;
  for (const std::string& text : options.hosts) {
    const auto [host, path] = HostAndPath(text);
    const auto findings = CompareWithHost(keystore, host, path);
    if (findings.empty()) keystore.NoteHost(host);
    of_hosts.insert(of_hosts.end(), findings.begin(), findings.end());
  }
  KeystoreState state = CheckKeystore(keystore, options.names, Rights(), Now_s());
  Append(CompareWithSystem(keystore, OfSystem(options)), &state);
  Append(of_hosts, &state);
  return state;
}

int CheckKeystore(const SecurityOptions& options) {
  const bool is_keystore = std::filesystem::exists(options.keystore / "manifest.json");
  if (!is_keystore && (!options.hosts.empty() || !options.system.empty())) {
    throw InputError({options.keystore.string()},
                     "is no keystore (no manifest.json): --host and --system need one");
  }
  const KeystoreState state =
      is_keystore ? CheckWhole(options) : CheckHostFiles(options.keystore, options.names, Now_s());
  fmt::print("{}", options.json ? CheckJson(state) : CheckText(state));
  return state.IsSound() ? app::kExitDone : app::kExitFailed;
}

/// Refuses options that the action does not take.
void CheckOptions(const SecurityOptions& options) {
  const bool issues = options.action == "init" || options.action == "enroll";
  if (!issues && (!options.node_namespace.empty() || !options.remap.empty())) {
    throw InputError("--namespace and --remap are for init and enroll");
  }
  if (options.action == "revoke" && !options.system.empty()) {
    throw InputError("--system is for init, enroll and check");
  }
  if (options.action != "check" && !options.hosts.empty()) {
    throw InputError("--host is for check");
  }
}

}  // namespace

int Security(const SecurityOptions& options) {
  const std::vector<std::string> actions{"init", "enroll", "revoke", "check"};
  if (std::find(actions.begin(), actions.end(), options.action) == actions.end()) {
    throw InputError("ACTION must be init, enroll, revoke or check, not '" +
                     Excerpt(options.action) + "'" + DidYouMean(options.action, actions));
  }
  CheckOptions(options);
  if (options.action == "init") return Init(options);
  if (options.action == "enroll") return Enroll(options);
  if (options.action == "revoke") return Revoke(options);
  return CheckKeystore(options);
}

app::Verb SecurityVerb() {
  return {"security", "Make, extend, change or check the keystore of a secured system",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<SecurityOptions>();
            arguments.Positional("ACTION", &options->action, "init, enroll, revoke or check");
            arguments.Suggest("ACTION", {"init", "enroll", "revoke", "check"});
            arguments.Positional("KEYSTORE", &options->keystore,
                                 "Folder of the keystore; for check also that of a host");
            arguments.Positionals("NAME", &options->names,
                                  "Identities: NAME, or NAME=ROLE@HOST for init and enroll, where "
                                  "ROLE is a component, observer or operator; init without it: "
                                  "all components and commands",
                                  app::Need::kOptional);
            arguments.Option("--system FILE", &options->system,
                             "System file of palpate launch whose processes are meant");
            arguments.Option("--days", &options->days, 1, kMostDays,
                             "Days for which the identities hold");
            arguments.Option("--namespace", &options->node_namespace,
                             "Namespace of the nodes of NAME, like /left; without it /");
            arguments.Repeated("--remap FROM:=TO", &options->remap,
                               "Another name for a topic of NAME, as ros2 run has it");
            arguments.Repeated("--host HOST=PATH", &options->hosts,
                               "Compare with the files of a host, which are at PATH");
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            return [options] { return Security(*options); };
          }};
}

}  // namespace palpate::command
