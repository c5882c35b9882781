// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string_view>
#include <utility>

#include "idl/message_traits.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"

namespace palpate::dds {

/// Reads CDR with its header of 4 bytes (XCDR1, either byte order) into a sample of all zeros, by
/// the code that reads it off the wire. kInvalidInput for bytes that are no message of this type;
/// the sample may then be filled in part.
Status DecodeCdr(std::string_view cdr, const dds_topic_descriptor_t& descriptor, void* sample);

template <typename T>
Status DecodeCdr(std::string_view cdr, Message<T>* message) {
  Message<T> read;
  Status status = DecodeCdr(cdr, idl::MessageTraits<T>::Descriptor(), &*read);
  if (status.ok()) *message = std::move(read);
  return status;
}

}  // namespace palpate::dds
