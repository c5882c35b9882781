// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/security/permissions.hpp"

#include <algorithm>

#include "libs/core/utc_text.hpp"
#include "libs/security/material.hpp"

namespace palpate::security {

namespace {

// The plugin of Cyclone DDS takes no higher ones.
constexpr char kAllDomains[] =
    "<domains><id_range><min>0</min><max>230</max></id_range></domains>\n";

std::string Head(const std::string& schema) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/"
         "omg_shared_ca_" +
         schema + ".xsd\">\n";
}

std::string TopicList(const std::string& tag, const std::vector<std::string>& topics) {
  if (topics.empty()) return {};
  std::string xml = "        <" + tag + ">\n          <topics>\n";
  for (const std::string& topic : topics) {
    xml += "            <topic>" + topic + "</topic>\n";
  }
  return xml + "          </topics>\n        </" + tag + ">\n";
}

std::vector<std::string> TopicsOf(const std::string& xml, const std::string& tag) {
  std::string section = TagText(xml, tag);
  std::vector<std::string> topics;
  constexpr std::string_view kEnd = "</topic>";
  std::size_t end = 0;
  while ((end = section.find(kEnd)) != section.npos) {
    topics.push_back(TagText(section, "topic"));
    section.erase(0, end + kEnd.size());
  }
  std::sort(topics.begin(), topics.end());
  return topics;
}

}  // namespace

std::string GovernanceXml() {
  return Head("governance") +
         "  <domain_access_rules>\n"
         "    <domain_rule>\n"
         "      " +
         kAllDomains +
         "      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
         "      <enable_join_access_control>true</enable_join_access_control>\n"
         "      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
         "      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
         "      <rtps_protection_kind>SIGN</rtps_protection_kind>\n"
         "      <topic_access_rules>\n"
         "        <topic_rule>\n"
         "          <topic_expression>*</topic_expression>\n"
         "          <enable_discovery_protection>true</enable_discovery_protection>\n"
         "          <enable_liveliness_protection>true</enable_liveliness_protection>\n"
         "          <enable_read_access_control>true</enable_read_access_control>\n"
         "          <enable_write_access_control>true</enable_write_access_control>\n"
         "          <metadata_protection_kind>NONE</metadata_protection_kind>\n"
         "          <data_protection_kind>ENCRYPT</data_protection_kind>\n"
         "        </topic_rule>\n"
         "      </topic_access_rules>\n"
         "    </domain_rule>\n"
         "  </domain_access_rules>\n"
         "</dds>\n";
}

std::string PermissionsXml(const std::string& identity, const AccessRights& rights,
                           const Period& valid) {
  return Head("permissions") + "  <permissions>\n    <grant name=\"" + identity +
         "\">\n      <subject_name>CN=" + identity +
         "</subject_name>\n"
         "      <validity>\n        <not_before>" +
         UtcText(valid.begin_s) + "</not_before>\n        <not_after>" + UtcText(valid.end_s) +
         "</not_after>\n      </validity>\n      <allow_rule>\n        " + kAllDomains +
         TopicList("publish", rights.write) + TopicList("subscribe", rights.read) +
         "      </allow_rule>\n      <default>DENY</default>\n    </grant>\n  </permissions>\n"
         "</dds>\n";
}

AccessRights ReadRights(const std::string& permissions_xml) {
  return {TopicsOf(permissions_xml, "publish"), TopicsOf(permissions_xml, "subscribe")};
}

}  // namespace palpate::security
