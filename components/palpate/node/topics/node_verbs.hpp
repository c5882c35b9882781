// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/palpate/node/topics/graph_options.hpp"
#include "libs/app/verbs.hpp"
#include "libs/dds/domain_graph.hpp"

namespace palpate::command {

/// `palpate node`: list and info, in the lines of `ros2 node`.
app::Verb NodeVerb();

/// Waits for a node of that name, as long as the options say. Throws RunError with "did you mean"
/// where there is none.
dds::RosNode WaitForNode(dds::DomainGraph& graph, const GraphNames& names,
                         const GraphOptions& options, const std::string& name);

}  // namespace palpate::command
