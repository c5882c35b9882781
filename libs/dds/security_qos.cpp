// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/security_qos.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string_view>
#include <system_error>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/dds_reports.hpp"
#include "libs/dds/qos.hpp"
#include "libs/security/material.hpp"
#include "libs/security/permissions.hpp"

namespace palpate::dds {

namespace {

/// Debian keeps the plugins in a folder beside the library, where the loader does not look.
std::string PluginPath(const std::string& name) {
  const std::string file = "lib" + name + ".so";
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_participant), &info) != 0 &&
      info.dli_fname != nullptr) {
    const auto folder = std::filesystem::path(info.dli_fname).parent_path();
    for (const auto& place : {folder / "libddsc0debian" / file, folder / file}) {
      std::error_code error;
      if (std::filesystem::exists(place, error)) return place.string();
    }
  }
  return name;
}

void SetPlugin(dds_qos_t* qos, const std::string& kind, const std::string& library,
               const std::string& suffix) {
  const std::string prefix = "dds.sec." + kind + ".library.";
  dds_qset_prop(qos, (prefix + "path").c_str(), PluginPath(library).c_str());
  dds_qset_prop(qos, (prefix + "init").c_str(), ("init_" + suffix).c_str());
  dds_qset_prop(qos, (prefix + "finalize").c_str(), ("finalize_" + suffix).c_str());
}

void SetFile(dds_qos_t* qos, const char* name, const std::filesystem::path& file) {
  dds_qset_prop(qos, name, ("file:" + file.string()).c_str());
}

/// The settings that CYCLONEDDS_URI names, a list of XML texts and files; what cannot be read is
/// for Cyclone DDS to refuse.
bool EnvironmentWantsSharedMemory() {
  const char* uri = std::getenv("CYCLONEDDS_URI");
  std::string_view rest = uri == nullptr ? "" : uri;
  while (!rest.empty()) {
    const std::size_t comma = rest.front() == '<' ? rest.npos : rest.find(',');
    std::string_view item = rest.substr(0, comma);
    rest = comma == rest.npos ? std::string_view() : rest.substr(comma + 1);
    if (item.starts_with('<')) {
      if (WantsSharedMemory(std::string(item))) return true;
      continue;
    }
    constexpr std::string_view kFile = "file://";
    if (item.starts_with(kFile)) item.remove_prefix(kFile.size());
    std::error_code error;
    const std::filesystem::path file(item);
    if (std::filesystem::is_regular_file(file, error) && WantsSharedMemory(ReadFile(file))) {
      return true;
    }
  }
  return false;
}

std::string WithoutComments(std::string xml) {
  std::size_t begin = 0;
  while ((begin = xml.find("<!--")) != xml.npos) {
    const std::size_t end = xml.find("-->", begin);
    xml.erase(begin, end == xml.npos ? xml.npos : end + 3 - begin);
  }
  return xml;
}

}  // namespace

bool WantsSharedMemory(const std::string& xml) {
  const std::string section = security::TagText(WithoutComments(xml), "SharedMemory");
  const std::string value = security::TagText(section, "Enable");
  return value.find("true") != value.npos || value.find('1') != value.npos;
}

void SetSecurity(const SecuritySettings& settings, dds_qos_t* qos) {
  if (!settings.enabled()) return;
  if (EnvironmentWantsSharedMemory()) {
    throw InputError(
        "CYCLONEDDS_URI turns shared memory on, which sends messages past the encryption: set "
        "SharedMemory/Enable to false, or start without security");
  }
  const security::Material material =
      security::LoadMaterial(settings.keystore, settings.identity, WallNow_ns() / 1'000'000'000);
  SetPlugin(qos, "auth", "dds_security_auth", "authentication");
  SetPlugin(qos, "crypto", "dds_security_crypto", "crypto");
  SetPlugin(qos, "access", "dds_security_ac", "access_control");
  SetFile(qos, "dds.sec.auth.identity_ca", material.identity_authority);
  SetFile(qos, "dds.sec.auth.identity_certificate", material.certificate);
  SetFile(qos, "dds.sec.auth.private_key", material.private_key);
  if (!material.revocation_list.empty()) {
    SetFile(qos, "org.eclipse.cyclonedds.sec.auth.crl", material.revocation_list);
  }
  SetFile(qos, "dds.sec.access.permissions_ca", material.permissions_authority);
  SetFile(qos, "dds.sec.access.governance", material.governance);
  SetFile(qos, "dds.sec.access.permissions", material.permissions);
}

Entity CreateParticipant(std::uint32_t domain_id, const SecuritySettings& settings) {
  if (settings.enabled() && domain_id > security::kLastSecuredDomain) {
    throw InputError("domain " + std::to_string(domain_id) + " cannot be secured: take one up to " +
                     std::to_string(security::kLastSecuredDomain));
  }
  const Qos qos = ParticipantQos("/" + (settings.enabled() ? settings.identity : ""));
  SetSecurity(settings, qos.get());
  if (settings.enabled()) CountRepeatedDdsReports();
  return Entity(dds_create_participant(domain_id, qos.get(), nullptr),
                "a participant in domain " + std::to_string(domain_id) +
                    (settings.enabled() ? " as '" + settings.identity + "'" : "") +
                    " (is a network interface up, and CYCLONEDDS_URI right? `lo` needs multicast "
                    "or unicast peers)");
}

}  // namespace palpate::dds
