// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/system/system_file_keys.hpp"

#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

namespace {

constexpr NumberRule kWait{.min = 0.0, .max = 3600.0};
constexpr NumberRule kPositiveWait{.min = 0.0, .max = 3600.0, .min_open = true};
// Above 232 the ports that DDS derives from the domain do not exist (RTPS 2.3, section 9.6.1.1).
constexpr int kMaxDomain = 232;
constexpr int kMostRestarts = 1000;
constexpr int kLeastNice = -20;
constexpr int kMostNice = 19;

ValueType Word() { return value::Either({value::Text(), value::Real(), value::Boolean()}); }

const KeyTable& VariableKeys() {
  static const KeyTable keys{
      .title = "variables",
      .about =
          "`$(name)` stands for the value in every text of the file. "
          "`palpate launch FILE name:=value` gives another one. `$(dirname)` is the folder "
          "of the file.",
      .open_keys = {{"<variable>", Word(), kOptional, "Value of the variable."}}};
  return keys;
}

const KeyTable& SetKeys() {
  static const KeyTable keys{
      .title = "set",
      .about =
          "Settings of the component, as in its settings file: "
          "`camera.source: driver`. They override the settings file.",
      .open_keys = {{"<setting>", value::Either({Word(), value::List(Word())}), kOptional,
                     "Value of the setting."}}};
  return keys;
}

const KeyTable& EnvironmentKeys() {
  static const KeyTable keys{
      .title = "environment",
      .about = "Environment variables, added to those of `palpate launch`.",
      .open_keys = {{"<variable>", Word(), kOptional, "Value of the environment variable."}}};
  return keys;
}

}  // namespace

const std::vector<std::string>& ComponentNames() {
  static const std::vector<std::string> names{
      "calibration", "capture", "force_estimation", "motion_capture", "perception", "player",
      "recorder",    "view",    "virtual_camera",   "virtual_robot"};
  return names;
}

const std::vector<std::string>& TransportNames() {
  static const std::vector<std::string> names{"one_host", "lan", "jumbo_lan", "lossy_link"};
  return names;
}

const KeyTable& RespawnKeys() {
  const RespawnPlan defaults;
  static const KeyTable keys{
      .title = "respawn",
      .about =
          "The process is started again when it fails. The wait doubles with each restart in "
          "a row. A component that ends with exit code 2 (wrong settings) is not started "
          "again.",
      .keys = {{"when", value::Choice({"failure", "always"}), Default("failure"),
                "`always`: also after exit code 0."},
               {"limit", value::WholeNumber(1, kMostRestarts), Default(defaults.limit),
                "Restarts in a row; then the process has failed."},
               {"backoff_s", value::Real(kPositiveWait), Default(defaults.backoff_s),
                "Wait before the first restart."},
               {"longest_backoff_s", value::Real(kPositiveWait),
                Default(defaults.longest_backoff_s), "The wait grows no further."},
               {"reset_after_s", value::Real(kPositiveWait), Default(defaults.reset_after_s),
                "A run that was ready this long ends the row: wait and limit begin again."}}};
  return keys;
}

const KeyTable& StopKeys() {
  const StopPlan defaults;
  static const KeyTable keys{
      .title = "stop",
      .about =
          "A process is stopped by SIGINT, then SIGTERM, then SIGKILL. A second Ctrl-C sends "
          "the next signal at once.",
      .keys = {
          {"interrupt_s", value::Real(kWait), Default(defaults.interrupt_s), "Wait after SIGINT."},
          {"terminate_s", value::Real(kWait), Default(defaults.terminate_s),
           "Wait after SIGTERM."}}};
  return keys;
}

const KeyTable& ProcessKeys() {
  const ProcessPlan defaults;
  static const KeyTable keys{
      .title = "process",
      .about = "One process of a host.",
      .keys = {{"name", value::Text(), kRequired,
                "Unique in the file; the prefix of its lines, and what `after` and `--set` name."},
               {"component", value::Choice(ComponentNames()), kOptional,
                "The component: `force_estimation` runs palpate-force-estimation."},
               {"program", value::Text(), kOptional,
                "Another program: a path, or a name in PATH. `settings`, `set` and `remap` do not "
                "hold for it."},
               {"settings", value::File(), kOptional,
                "Settings file of the component. Absent: its defaults."},
               {"set", value::Map(SetKeys()), kOptional, "Single settings. Absent: none."},
               {"remap", value::List(value::Text()), kOptional,
                "Other names of topics, `\"/from:=/to\"`, as ROS 2 has it. Absent: none."},
               {"arguments", value::List(Word()), kOptional,
                "Further words of the command line, such as the robot. Absent: none."},
               {"environment", value::Map(EnvironmentKeys()), kOptional,
                "Environment variables. Absent: none."},
               {"after", value::List(value::Text()), kOptional,
                "Processes of this host that must be ready, or have ended with 0, before this one "
                "starts. At the end it stops before them. Absent: starts at once."},
               {"required", value::Boolean(), Default(defaults.required),
                "Where it ends, or fails for good, all processes of the host are stopped. Where it "
                "failed, `palpate launch` exits with 1."},
               {"respawn", value::Map(RespawnKeys()), kOptional,
                "Restarts, `{}` with the defaults. Absent: not started again."},
               {"ready", value::Choice({"notify", "start"}), kOptional,
                "`notify`: when the process says so (READY=1 to NOTIFY_SOCKET, as systemd has it). "
                "`start`: at once. Absent: `notify` for a component, `start` for a program."},
               {"ready_timeout_s", value::Real(kPositiveWait), Default(defaults.ready_timeout_s),
                "A process that is not ready in this time is stopped and has failed."},
               {"nice", value::WholeNumber(kLeastNice, kMostNice), Default(defaults.nice),
                "Added to the niceness: processes with less run first where cores are scarce. "
                "Below 0 needs privileges."}},
      .exactly_one = {{"component", "program"}}};
  return keys;
}

const KeyTable& HostKeys() {
  static const KeyTable keys{
      .title = "host",
      .about = "One computer. `palpate launch` starts the processes of the host on which it runs.",
      .keys = {{"name", value::Text(), kRequired,
                "Unique. Without `--host` it is the host whose name is that of the computer, or "
                "whose address the computer has."},
               {"address", value::Text(), kOptional,
                "IPv4 address in the network of the system; required for `transport: lossy_link`."},
               {"interface", value::Text(), kOptional,
                "Network interface of the system's network, `eth0`. Absent: the one with "
                "`address`, else the middleware chooses."},
               {"processes", value::ListOfMaps(ProcessKeys(), 1), kRequired, "Its processes."}}};
  return keys;
}

const KeyTable& SystemFileKeys() {
  static const KeyTable keys{
      .title = "system file",
      .about = "Processes, their settings and their hosts, for `palpate launch`.",
      .keys = {{"name", value::Text(), kRequired, "Name of the system."},
               {"domain", value::WholeNumber(0, kMaxDomain), kOptional,
                "DDS domain. Absent: ROS_DOMAIN_ID, else 0."},
               {"namespace", value::Text(), kOptional,
                "Namespace of all components and their topics, `/left`. Absent: none."},
               {"transport", value::Choice(TransportNames()), kOptional,
                "Configuration of Cyclone DDS, `config/cyclonedds/NAME.xml`. Absent: "
                "CYCLONEDDS_URI of the environment, else `default`."},
               {"peers", value::List(value::Text()), kOptional,
                "Addresses of hosts outside this file, for `transport: lossy_link`. Absent: none."},
               {"security", value::File(), kOptional,
                "Folder with the identities and permissions of the processes. Absent: no "
                "security."},
               {"allow_faults", value::Boolean(), Default(false),
                "`palpate fail` may make the data of the components faulty, to test the system."},
               {"stop", value::Map(StopKeys()), kOptional, "How processes are stopped."},
               {"variables", value::Map(VariableKeys()), kOptional,
                "Values for the command line to change. Absent: none."},
               {"hosts", value::ListOfMaps(HostKeys(), 1), kRequired, "The hosts."}}};
  return keys;
}

}  // namespace palpate::command
