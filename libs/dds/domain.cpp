// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/domain.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

namespace palpate::dds {

namespace {

bool UserHasSettings() {
  const char* uri = std::getenv("CYCLONEDDS_URI");
  return uri != nullptr && *uri != '\0';
}

}  // namespace

std::shared_ptr<Entity> ApplyDomainSettings(uint32_t domain_id) {
  static std::mutex mutex;
  // Deleting a domain deletes its participants, so all of them share it.
  static std::map<uint32_t, std::weak_ptr<Entity>> domains;
  if (UserHasSettings()) return nullptr;
  const std::lock_guard lock(mutex);
  if (auto known = domains[domain_id].lock()) return known;
  const std::string settings(BuiltInDomainSettings());
  const dds_entity_t handle = dds_create_domain(domain_id, settings.c_str());
  if (handle == DDS_RETCODE_PRECONDITION_NOT_MET) return nullptr;
  auto domain = std::make_shared<Entity>(handle, "domain " + std::to_string(domain_id));
  domains[domain_id] = domain;
  return domain;
}

}  // namespace palpate::dds
