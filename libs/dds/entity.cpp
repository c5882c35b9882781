// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/entity.hpp"

namespace palpate::dds {

dds_entity_t Created(dds_entity_t handle, const std::string& what) {
  if (handle == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY) {
    throw NotAllowed("cannot create " + what + ": " + dds_strretcode(-handle));
  }
  if (handle < 0) {
    throw RunError("cannot create " + what + ": " + dds_strretcode(-handle));
  }
  return handle;
}

}  // namespace palpate::dds
