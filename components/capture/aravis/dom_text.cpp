// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/dom_text.hpp"

namespace palpate::capture {

std::string TextOf(ArvDomNode* element) {
  std::string text;
  for (ArvDomNode* child = arv_dom_node_get_first_child(element); child != nullptr;
       child = arv_dom_node_get_next_sibling(child)) {
    if (!ARV_IS_DOM_CHARACTER_DATA(child)) continue;
    const char* data = arv_dom_character_data_get_data(ARV_DOM_CHARACTER_DATA(child));
    if (data != nullptr) text += data;
  }
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

}  // namespace palpate::capture
