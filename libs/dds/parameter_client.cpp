// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/parameter_client.hpp"

#include "libs/core/error.hpp"
#include "libs/dds/parameter_messages.hpp"
#include "libs/dds/service.hpp"
#include "rcl_interfaces/srv/DescribeParameters.hpp"
#include "rcl_interfaces/srv/GetParameters.hpp"
#include "rcl_interfaces/srv/ListParameters.hpp"
#include "rcl_interfaces/srv/SetParameters.hpp"

namespace palpate::dds {

namespace {

namespace ros = idl::rcl_interfaces;

/// A value of that type, a number of ParameterType.
ParameterValue ValueOfType(std::uint8_t type) {
  ros::ParameterValue message{};
  message.type = type;
  return ParameterValueOf(message);
}

Parameter ParameterOf(const ros::ParameterDescriptor& descriptor) {
  Parameter parameter{std::string(Text(descriptor.name)), ValueOfType(descriptor.type)};
  parameter.description = Text(descriptor.description);
  parameter.constraints = Text(descriptor.additional_constraints);
  if (descriptor.read_only) parameter.fixed_because = "read only";
  for (const auto& range : Elements(descriptor.floating_point_range)) {
    parameter.range = {range.from_value, range.to_value};
  }
  for (const auto& range : Elements(descriptor.integer_range)) {
    parameter.range = {static_cast<double>(range.from_value), static_cast<double>(range.to_value)};
  }
  return parameter;
}

}  // namespace

template <typename Service, typename Fill, typename Take>
void ParameterClient::Ask(const char* service, const Fill& fill, const Take& take) const {
  ServiceClient<Service> client(participant_, node_ + "/" + service);
  Message<typename Service::Request> request;
  fill(&*request);
  const bool answered = client.Call(&request, take, std::chrono::steady_clock::now() + patience_);
  if (answered) return;
  throw RunError("node '" + node_ + "' does not answer on its service " + service);
}

std::vector<std::string> ParameterClient::List() const {
  std::vector<std::string> names;
  Ask<ros::ListParameters>(
      "list_parameters", [](auto*) {},
      [&](const auto& response) { names = TextsOf(response.result.names); });
  return names;
}

std::vector<ParameterValue> ParameterClient::Get(const std::vector<std::string>& names) const {
  std::vector<ParameterValue> values;
  Ask<ros::GetParameters>(
      "get_parameters", [&](auto* request) { SetTexts(request->names, names); },
      [&](const auto& response) {
        for (const auto& value : Elements(response.values)) {
          values.push_back(ParameterValueOf(value));
        }
      });
  // rclcpp answers nothing at all where one of them is unknown.
  values.resize(names.size());
  return values;
}

std::vector<Parameter> ParameterClient::Describe(const std::vector<std::string>& names) const {
  std::vector<Parameter> parameters;
  Ask<ros::DescribeParameters>(
      "describe_parameters", [&](auto* request) { SetTexts(request->names, names); },
      [&](const auto& response) {
        for (const auto& descriptor : Elements(response.descriptors)) {
          parameters.push_back(ParameterOf(descriptor));
        }
      });
  return parameters;
}

std::string ParameterClient::Set(const std::string& name, const ParameterValue& value) const {
  std::string refusal = "the node answered nothing";
  Ask<ros::SetParameters>(
      "set_parameters",
      [&](auto* request) {
        Resize(request->parameters, 1);
        SetText(request->parameters._buffer[0].name, name);
        SetParameterValue(value, &request->parameters._buffer[0].value);
      },
      [&](const auto& response) {
        for (const auto& result : Elements(response.results)) {
          refusal = result.successful ? "" : Text(result.reason);
          if (!result.successful && refusal.empty()) refusal = "the node gives no reason";
        }
      });
  return refusal;
}

}  // namespace palpate::dds
