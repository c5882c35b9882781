// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/parameter_services.hpp"

#include <set>
#include <utility>

#include "libs/core/parameter_table.hpp"
#include "libs/dds/parameter_messages.hpp"
#include "libs/dds/service.hpp"
#include "rcl_interfaces/msg/SetParametersResult.hpp"
#include "rcl_interfaces/srv/DescribeParameters.hpp"
#include "rcl_interfaces/srv/GetParameterTypes.hpp"
#include "rcl_interfaces/srv/GetParameters.hpp"
#include "rcl_interfaces/srv/ListParameters.hpp"
#include "rcl_interfaces/srv/SetParameters.hpp"
#include "rcl_interfaces/srv/SetParametersAtomically.hpp"

namespace palpate::dds {

namespace {

namespace ros = idl::rcl_interfaces;

constexpr char kSeparator = '.';

template <typename Sequence>
ParameterTable::Changes ChangesOf(const Sequence& sequence) {
  ParameterTable::Changes changes;
  for (const auto& change : Elements(sequence)) {
    changes.emplace_back(Text(change.name), ParameterValueOf(change.value));
  }
  return changes;
}

void SetResult(const std::string& refusal, ros::SetParametersResult* result) {
  result->successful = refusal.empty();
  SetText(result->reason, refusal);
}

}  // namespace

struct ParameterServices::Services {
  Services(dds_entity_t participant, const std::string& node, std::vector<Parameter> parameters)
      : table(std::move(parameters)),
        list(participant, node + "/list_parameters",
             [this](const auto& request, auto* response) { List(request, response); }),
        get(participant, node + "/get_parameters",
            [this](const auto& request, auto* response) { Get(request, response); }),
        types(participant, node + "/get_parameter_types",
              [this](const auto& request, auto* response) { Types(request, response); }),
        describe(participant, node + "/describe_parameters",
                 [this](const auto& request, auto* response) { Describe(request, response); }),
        set(participant, node + "/set_parameters",
            [this](const auto& request, auto* response) { Set(request, response); }),
        set_atomically(
            participant, node + "/set_parameters_atomically",
            [this](const auto& request, auto* response) { SetAtomically(request, response); }) {}

  void List(const ros::ListParameters::Request& request,
            ros::ListParameters::Response* response) const {
    const std::vector<std::string> asked = TextsOf(request.prefixes);
    const std::vector<std::string> names = table.Names(asked, request.depth);
    std::set<std::string> prefixes;
    for (const std::string& name : names) {
      const std::size_t dot = name.rfind(kSeparator);
      if (dot != name.npos) prefixes.insert(name.substr(0, dot));
    }
    SetTexts(response->result.names, names);
    SetTexts(response->result.prefixes, {prefixes.begin(), prefixes.end()});
  }

  void Get(const ros::GetParameters::Request& request,
           ros::GetParameters::Response* response) const {
    const std::vector<std::string> names = TextsOf(request.names);
    Resize(response->values, names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Parameter* parameter = table.Find(names[i]);
      SetParameterValue(parameter == nullptr ? ParameterValue() : parameter->value,
                        &response->values._buffer[i]);
    }
  }

  void Types(const ros::GetParameterTypes::Request& request,
             ros::GetParameterTypes::Response* response) const {
    std::vector<std::size_t> numbers;
    for (const std::string& name : TextsOf(request.names)) {
      const Parameter* parameter = table.Find(name);
      numbers.push_back(parameter == nullptr ? 0 : parameter->value.index());
    }
    SetNumbers(response->types, numbers.data(), numbers.size());
  }

  void Describe(const ros::DescribeParameters::Request& request,
                ros::DescribeParameters::Response* response) const {
    const std::vector<std::string> names = TextsOf(request.names);
    Resize(response->descriptors, names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Parameter* parameter = table.Find(names[i]);
      SetParameterDescriptor(parameter == nullptr ? Parameter{names[i], {}} : *parameter,
                             &response->descriptors._buffer[i]);
    }
  }

  void Set(const ros::SetParameters::Request& request, ros::SetParameters::Response* response) {
    const ParameterTable::Changes changes = ChangesOf(request.parameters);
    Resize(response->results, changes.size());
    for (std::size_t i = 0; i < changes.size(); ++i) {
      SetResult(table.Change(changes[i].first, changes[i].second), &response->results._buffer[i]);
    }
  }

  void SetAtomically(const ros::SetParametersAtomically::Request& request,
                     ros::SetParametersAtomically::Response* response) {
    SetResult(table.ChangeTogether(ChangesOf(request.parameters)), &response->result);
  }

  template <typename Call>
  void ForEach(const Call& call) {
    call(list);
    call(get);
    call(types);
    call(describe);
    call(set);
    call(set_atomically);
  }

  ParameterTable table;
  ServiceServer<ros::ListParameters> list;
  ServiceServer<ros::GetParameters> get;
  ServiceServer<ros::GetParameterTypes> types;
  ServiceServer<ros::DescribeParameters> describe;
  ServiceServer<ros::SetParameters> set;
  ServiceServer<ros::SetParametersAtomically> set_atomically;
};

ParameterServices::ParameterServices(dds_entity_t participant, const std::string& node,
                                     std::vector<Parameter> parameters)
    : services_(std::make_unique<Services>(participant, node, std::move(parameters))) {}

ParameterServices::~ParameterServices() = default;

std::vector<dds_entity_t> ParameterServices::readers() const {
  std::vector<dds_entity_t> readers;
  services_->ForEach([&](auto& server) { readers.push_back(server.endpoints().reader()); });
  return readers;
}

std::vector<dds_entity_t> ParameterServices::writers() const {
  std::vector<dds_entity_t> writers;
  services_->ForEach([&](auto& server) { writers.push_back(server.endpoints().writer()); });
  return writers;
}

void ParameterServices::Serve(dds_entity_t reader) {
  const std::lock_guard lock(mutex_);
  services_->ForEach([&](auto& server) {
    if (server.endpoints().reader() == reader) server.Serve();
  });
}

}  // namespace palpate::dds
