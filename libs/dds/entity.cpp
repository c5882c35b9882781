// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/entity.hpp"

namespace palpate::dds {

dds_entity_t Created(dds_entity_t handle, const std::string& what) {
  if (handle >= 0) return handle;
  const std::string refused = "cannot create " + what + ": " + dds_strretcode(-handle);
  if (handle == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY) {
    throw NotAllowed(refused +
                     " (the permissions of this identity lack it: `palpate security check` says "
                     "which it has)");
  }
  throw RunError(refused);
}

}  // namespace palpate::dds
