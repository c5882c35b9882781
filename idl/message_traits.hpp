// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::idl {

/// Ties a message struct to its DDS type. Each generated <package>/msg/<Name>.hpp specialises it:
/// `static const dds_topic_descriptor_t& Descriptor()`.
template <typename Message>
struct MessageTraits;

}  // namespace palpate::idl
