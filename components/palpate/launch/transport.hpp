// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>

#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// The environment by which the processes of `host` join the DDS domain of the system:
/// ROS_DOMAIN_ID, CYCLONEDDS_URI (the configuration that `transport` names), PALPATE_INTERFACE,
/// PALPATE_PEERS (of a lossy link) and PALPATE_SECURITY_DIR, each where the file says so. Throws
/// InputError where the configuration is not there.
std::map<std::string, std::string> MiddlewareEnvironment(const SystemFile& system,
                                                         const HostPlan& host);

}  // namespace palpate::command
