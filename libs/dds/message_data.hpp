// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <random>

#include "idl/message_traits.hpp"
#include "libs/dds/message.hpp"

namespace palpate::dds {

/// Copies a message of any type, with all texts and sequences; `to` is all zeros before. Returns
/// the size of its CDR in bytes.
std::size_t CopyMessage(const dds_topic_descriptor_t& type, const void* from, void* to);

template <typename T>
Message<T> CopyOf(const T& message, std::size_t* size = nullptr) {
  Message<T> copy;
  const std::size_t bytes = CopyMessage(idl::MessageTraits<T>::Descriptor(), &message, &*copy);
  if (size != nullptr) *size = bytes;
  return copy;
}

/// Replaces the data of a message of any type: every floating-point number by a random one, finite
/// or not, and the bytes of pictures and clouds by random ones. Stamps, counters, names, sizes and
/// flags stay.
void GarbleMessage(const dds_topic_descriptor_t& type, std::mt19937_64* random, void* message);

template <typename T>
void Garble(std::mt19937_64* random, T* message) {
  GarbleMessage(idl::MessageTraits<T>::Descriptor(), random, message);
}

}  // namespace palpate::dds
