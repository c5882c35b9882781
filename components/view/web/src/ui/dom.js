// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

/** @returns {HTMLElement} */
export const byId = (id) => document.getElementById(id);

/** An element with attributes (null and false: absent) and children. Texts are never HTML. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== false) made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

/** Writes a text only where it differs: the browser then has nothing to lay out. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Replaces the children only where their HTML differs, so that focus and selection stay. */
export function replaceIfChanged(parent, ...children) {
  const holder = document.createElement(parent.tagName);
  holder.append(...children.filter((child) => child !== null));
  if (holder.innerHTML !== parent.innerHTML) parent.replaceChildren(...holder.childNodes);
}
