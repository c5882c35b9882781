// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/security_qos.hpp"

#include <dlfcn.h>

#include <system_error>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
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

}  // namespace

void SetSecurity(const SecuritySettings& settings, dds_qos_t* qos) {
  if (!settings.enabled()) return;
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
