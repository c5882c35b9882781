// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/entity.hpp"

namespace palpate::dds {

namespace {

std::string RemedyOf(dds_return_t result) {
  return result == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY
             ? " (the permissions of this identity lack it: `palpate security check` says which "
               "it has)"
             : "";
}

}  // namespace

dds_entity_t Created(dds_entity_t handle, const std::string& what) {
  if (handle == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY) {
    throw NotAllowed("cannot create " + what + ": " + dds_strretcode(-handle));
  }
  if (handle < 0) {
    throw RunError("cannot create " + what + ": " + dds_strretcode(-handle) + RemedyOf(handle));
  }
  return handle;
}

}  // namespace palpate::dds
