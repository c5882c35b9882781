// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/dds/topic_names.hpp"
#include "libs/dds/topic_table.hpp"
#include "libs/security/permissions.hpp"

namespace palpate::dds {

/// Identities of commands: an observer reads all topics and writes none; an operator may also give
/// commands.
inline constexpr char kObserver[] = "observer";
inline constexpr char kOperator[] = "operator";

/// The roles that a table gives rights to: the components and commands of palpate, and those of its
/// neighbours ("camera_driver"), sorted.
std::vector<std::string> RolesOf(const TopicTable& table);

/// The same without neighbours.
std::vector<std::string> OwnRolesOf(const TopicTable& table);

/// What `role` writes and reads by the columns `writers` and `readers` of the table, under the
/// names that `names` resolves. A recorder, the view, an observer and an operator read all
/// topics; a player writes all that are recorded. Throws InputError, with "did you mean", for a
/// role that the table does not know.
security::AccessRights RightsOf(const TopicTable& table, const std::string& role,
                                const TopicNames& names);

}  // namespace palpate::dds
