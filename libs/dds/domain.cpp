// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/domain.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include "libs/core/error.hpp"
#include "libs/core/network_interfaces.hpp"
#include "libs/dds/domain_settings.hpp"

namespace palpate::dds {

namespace {

bool UserHasSettings() {
  const char* uri = std::getenv("CYCLONEDDS_URI");
  return uri != nullptr && *uri != '\0';
}

/// The settings of CYCLONEDDS_URI, else those that are built in.
std::string Settings() {
  return UserHasSettings() ? std::getenv("CYCLONEDDS_URI") : std::string(BuiltInDomainSettings());
}

/// The element that names an interface or its address.
std::string InterfaceElement(const std::string& name) {
  const bool is_address = name.find_first_not_of("0123456789.") == name.npos;
  return "<Domain Id=\"any\"><General><Interfaces><NetworkInterface " +
         std::string(is_address ? "address" : "name") + "=\"" + name +
         "\"/></Interfaces></General></Domain>";
}

}  // namespace

std::string EffectiveSettings() {
  const std::string settings = Settings();
  const std::string name = ProcessEnvironment("PALPATE_INTERFACE").value_or("");
  if (name.empty() || !ReadDomainSettings(settings, 0).interfaces.empty()) return settings;
  return settings + "," + InterfaceElement(name);
}

std::shared_ptr<Entity> ApplyDomainSettings(uint32_t domain_id, bool is_secured) {
  const std::string settings = EffectiveSettings();
  DomainSettings read = ReadDomainSettings(settings, domain_id);
  if (is_secured && !read.security) {
    read.security = true;
    read.security_where.file = "dds.security";
  }
  const std::string refusal = RefusalOf(read, NetworkInterfaces());
  if (!refusal.empty()) throw InputError(refusal);
  static std::mutex mutex;
  // Deleting a domain deletes its participants, so all of them share it.
  static std::map<uint32_t, std::weak_ptr<Entity>> domains;
  if (UserHasSettings()) {
    setenv("CYCLONEDDS_URI", settings.c_str(), 1);
    return nullptr;
  }
  const std::lock_guard lock(mutex);
  if (auto known = domains[domain_id].lock()) return known;
  const dds_entity_t handle = dds_create_domain(domain_id, settings.c_str());
  if (handle == DDS_RETCODE_PRECONDITION_NOT_MET) return nullptr;
  auto domain = std::make_shared<Entity>(handle, "domain " + std::to_string(domain_id));
  domains[domain_id] = domain;
  return domain;
}

}  // namespace palpate::dds
