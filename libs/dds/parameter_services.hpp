// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "libs/core/parameter.hpp"

namespace palpate::dds {

/// The services by which ROS 2 lists, reads, describes and changes the parameters of a node.
class ParameterServices {
 public:
  /// `node`: its name with its namespace, "/left/palpate_view". Throws NotAllowed where DDS
  /// Security does not allow them, RunError where DDS refuses.
  ParameterServices(dds_entity_t participant, const std::string& node,
                    std::vector<Parameter> parameters);
  ~ParameterServices();

  /// Readers of requests, and writers of replies.
  std::vector<dds_entity_t> readers() const;
  std::vector<dds_entity_t> writers() const;

  /// Answers what waits in one of the readers. Safe from any thread.
  void Serve(dds_entity_t reader);

 private:
  struct Services;

  std::mutex mutex_;
  std::unique_ptr<Services> services_;
};

}  // namespace palpate::dds
