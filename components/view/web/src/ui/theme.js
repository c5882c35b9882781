// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { element } from './dom.js';

const KEY = 'palpate.theme';
const system = matchMedia('(prefers-color-scheme: dark)');
const listeners = [];
let probe = null;

/** "light" or "dark": chosen here before, else as the system has it. */
export function theme() {
  return document.documentElement.dataset.theme ?? (system.matches ? 'dark' : 'light');
}

function read() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;  // storage is forbidden: the choice lasts as long as the page
  }
}

export function startTheme() {
  const chosen = read();
  if (chosen === 'light' || chosen === 'dark') document.documentElement.dataset.theme = chosen;
  system.addEventListener('change', tell);
}

export function switchTheme() {
  const next = theme() === 'dark' ? 'light' : 'dark';
  document.documentElement.dataset.theme = next;
  try {
    localStorage.setItem(KEY, next);
  } catch {
    // as above
  }
  tell();
}

function tell() {
  colors.clear();
  for (const listener of listeners) listener(theme());
}

export function onTheme(listener) {
  listeners.push(listener);
}

const colors = new Map();

/** What the style sheet has for a colour now, "rgb(...)". Canvases need it in words. */
export function color(name) {
  if (!colors.has(name)) {
    probe ??= document.body.appendChild(element('i', { hidden: true }));
    probe.style.color = `var(--${name})`;
    colors.set(name, getComputedStyle(probe).color);
  }
  return colors.get(name);
}
