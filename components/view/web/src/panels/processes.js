// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

import { byId, element, replaceIfChanged } from '../ui/dom.js';
import { duration, isNumber, milliseconds, number } from '../ui/format.js';

/** Health of each process with its last reason, of topics, and of this page's connection. */
export class ProcessesPanel {
  #health = null;
  #client = null;
  #topics_open = false;
  #nobody = '';
  #paused = false;  // a recording that is held says nothing, and nothing is wrong

  constructor(feed) {
    this.feed = feed;
    this.body = byId('processes-body');
    // toggle does not bubble
    this.body.addEventListener('toggle', ({ target }) => (this.#topics_open = target.open), true);
    feed.on('hello', ({ source }) => (this.#nobody = source === 'experiment'
      ? 'An experiment is shown; no process runs.' : 'No process has reported yet.'));
    feed.on('player', ({ paused }) => (this.#paused = paused));
    feed.on('health', (message) => {
      this.#health = message;
      this.#show();
    });
    feed.on('client', (message) => {
      this.#client = message;
      this.#show();
    });
    this.#show();
  }

  #show() {
    if (!this.#health) {
      return replaceIfChanged(this.body,
        element('p', { class: 'empty' }, 'Waiting for reports of the processes.'));
    }
    const { processes, topics } = this.#health;
    const head = element('tr', {}, ...[['process', ''], ['in → out', 'Hz'], ['latency', 'ms'],
      ['lost', '']].map(([title, unit]) =>
      element('th', { scope: 'col' }, title,
        unit && element('span', { class: 'unit' }, ` ${unit}`))));
    const rows = processes.flatMap((process) => this.#process(process));
    rows.push(...this.#page());
    const table = element('table', { 'data-testid': 'process-table' },
      element('thead', {}, head), element('tbody', {}, ...rows));
    const empty = processes.length === 0
      ? element('p', { class: 'empty' }, this.#nobody) : null;
    replaceIfChanged(this.body, empty, table, this.#topics(topics ?? []), this.#clocks());
  }

  #process(it) {
    const state = it.silent && !this.#paused ? 'silent' : it.status === 'ok' ? 'ok' : 'trouble';
    const lost = (it.dropped ?? 0) + (it.refused ?? 0);
    const row = element('tr', { 'data-state': state, 'data-testid': 'process' },
      element('th', { scope: 'row', title: `up ${duration(it.uptime_s)}` },
        element('i', { class: 'lamp' }), it.name.replaceAll('_', ' ')),
      element('td', {}, `${rate(it.input_rate_hz)} → ${rate(it.output_rate_hz)}`),
      element('td', { title: `at most ${milliseconds(it.latency_max_s)}` },
        it.latency_mean_s > 0 ? number(1000 * it.latency_mean_s) : '–'),
      element('td', {
        class: lost ? 'bad' : '', title: `${it.dropped} dropped, ${it.refused} refused`,
      }, String(lost)));
    const why = this.#reason(it, state);
    return why ? [row, element('tr', { class: 'reason', 'data-state': state },
      element('td', { colspan: 4 }, why))] : [row];
  }

  #reason(it, state) {
    const parts = [];
    if (state === 'silent') parts.push(`silent for ${duration(it.silence_s)}`);
    if (it.status !== 'ok') parts.push(it.status.replaceAll('_', ' '));
    if (it.reason) parts.push(it.reason);
    if (it.waiting_for) parts.push(`waits for ${it.waiting_for}`);
    if (it.restarts > 0) parts.push(`${it.restarts} restarts`);
    return parts.join(' · ');
  }

  /** What the server could not send to this page in time. */
  #page() {
    if (!this.#client) return [];
    const dropped = Object.entries(this.#client.dropped ?? {}).filter(([, count]) => count > 0);
    const total = dropped.reduce((sum, [, count]) => sum + count, 0);
    const rows = [element('tr', { 'data-state': 'ok', 'data-testid': 'page-row' },
      element('th', { scope: 'row' }, element('i', { class: 'lamp' }), 'this page'),
      element('td', {}, `${rate(this.#client.rate_hz)} →`),
      element('td', {}, '–'),
      element('td', { class: total ? 'bad' : '', 'data-testid': 'drops' }, String(total)))];
    if (total) {
      const each = dropped.map(([kind, count]) => `${count} ${kind.replaceAll('_', ' ')}`);
      rows.push(element('tr', { class: 'reason' },
        element('td', { colspan: 4 }, `dropped: ${each.join(', ')}`)));
    }
    return rows;
  }

  #topics(topics) {
    if (topics.length === 0) return null;
    const lost = topics.reduce((sum, topic) => sum + (topic.lost ?? 0), 0);
    return element('details', { open: this.#topics_open },
      element('summary', {}, `${topics.length} topics`, lost ? `, ${lost} messages lost` : ''),
      element('table', {}, element('tbody', {}, ...topics.map((topic) => element('tr', {},
        element('th', { scope: 'row' }, topic.name),
        element('td', {}, `${rate(topic.rate_hz)} Hz`),
        element('td', { class: topic.lost ? 'bad' : '' }, `${topic.lost ?? 0} lost`))))));
  }

  #clocks() {
    const clocks = (this.#health.clocks ?? []).filter((clock) => isNumber(clock.offset_s));
    if (clocks.length === 0) return null;
    return element('p', { class: 'clocks' }, ...clocks.map(({ other_host, offset_s, bound_s }) =>
      `Clock of ${other_host}: ${milliseconds(offset_s)} ± ${milliseconds(bound_s)}. `));
  }
}

/** One decimal is enough to see 29.9 of 30. */
function rate(hz) {
  return isNumber(hz) && hz > 0 ? hz.toFixed(1) : '–';
}
