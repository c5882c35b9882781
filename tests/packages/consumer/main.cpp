// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Reads a robot file with the installed libraries, and prints what it describes.
#include <iostream>

#include "libs/app/yaml.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "palpate_msgs/msg/ForceArray.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const palpate::robot::RobotBody body = palpate::robot::BuildRobotBody(
      palpate::robot::ReadRobotFile(argv[1], palpate::app::LoadYaml));
  const palpate::idl::palpate_msgs::ForceArray message{};
  std::cout << body.name << ": " << body.cables.size() << " cables, " << message.counter
            << " forces\n";
  return 0;
}
