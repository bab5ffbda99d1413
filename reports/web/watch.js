// The page of `simbench watch`: the verdict with since when, cameras, clocks, events, and how phases
// and errors went since the page was opened.

const kAskEveryMs = 1000;
const kDrawEveryMs = 2000;

const $ = (id) => document.getElementById(id);
const phases = new History(), errors = new History();
let charts = [], drawnAt = 0, lostSince = null;

function longTime(seconds) {
  if (seconds < 120) return `${Math.round(seconds)} s`;
  return seconds < 7200 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

function timeText(ms) {
  if (ms == null) return '-';
  const size = Math.abs(ms);
  const [value, unit] = size >= 1000 ? [ms / 1000, 's'] : size >= 1 || size === 0 ? [ms, 'ms'] : [ms * 1000, 'us'];
  return `${Number(value.toPrecision(3))} ${unit}`;
}

function rowOf(cells, state) {
  const row = element('tr');
  row.dataset.state = state;
  cells.forEach((cell, i) => row.append(element(i === 0 ? 'th' : 'td', i < 2 ? 'text' : '', String(cell ?? '-'))));
  row.firstChild.scope = 'row';
  return row;
}

function showCameras(cameras) {
  $('cameras').hidden = cameras.length === 0;
  $('cameras').querySelector('tbody').replaceChildren(...cameras.map((camera) => rowOf([
    camera.camera, camera.state, camera.stream, camera.rate_hz?.toFixed(2), timeText(camera.phase_ms),
    timeText(camera.moved_ms), camera.frames, camera.lost, `${(100 * camera.lost_share).toFixed(2)} %`, camera.slips,
  ], camera.state)));
}

function showClocks(clocks) {
  $('clocks').hidden = clocks.length === 0;
  $('clocks').querySelector('tbody').replaceChildren(...clocks.map((clock) => rowOf([
    clock.subject, clock.file, timeText(clock.error_ms), timeText(clock.max_te_ms), timeText(clock.rms_te_ms),
    clock.steps, clock.samples,
  ], '')));
}

function showAlarms({status, text, alarms, since_s, now_s}) {
  document.body.dataset.status = status;
  $('status').textContent = `${status}, for ${longTime(now_s - since_s)}`;
  $('text').textContent = text === status ? '' : text;
  $('alarms').replaceChildren(...alarms.map((alarm) =>
      element('li', '', `${alarm.text} (since ${longTime(now_s - alarm.since_s)})`)));
  document.title = `${status === 'alarm' ? '(!) ' : ''}simbench watch`;
}

function showEvents(events) {
  $('events').replaceChildren(...events.toReversed().map((event) => element('li', event.alarm ? 'bad' : '', event.text)));
  $('event_part').hidden = events.length === 0;
}

function drawHistory(root, history, title, label) {
  root.hidden = history.values.size === 0;
  if (root.hidden) return;
  const {panel, columns} = history.panel(title, label);
  const host = root.querySelector('.chart');
  host.setAttribute('aria-label', `${title}: ${label} over time`);
  const hidden = new Set(host.uplot ? host.uplot.series.filter(({show}) => !show).map(({label: name}) => name) : []);
  host.uplot?.destroy();
  host.uplot = makeChart(host, panel, columns, () => null);
  host.uplot.series.forEach((series, i) => hidden.has(series.label) && host.uplot.setSeries(i, {show: false}));
  charts.push(host.uplot);
}

function draw() {
  charts = [];
  drawHistory($('phase_figure'), phases, 'Phases of the cameras', 'against the reference camera (ms)');
  drawHistory($('error_figure'), errors, 'Errors of the clocks', 'error (ms)');
  drawnAt = performance.now();
}

function show(snapshot) {
  showAlarms(snapshot);
  showCameras(snapshot.cameras);
  showClocks(snapshot.clocks);
  showEvents(snapshot.events);
  $('diagnosis').textContent = snapshot.diagnosis ? snapshot.diagnosis.lead : '';
  phases.add(snapshot.now_s, new Map(snapshot.cameras.map(({camera, stream, phase_ms}) => [`${camera} ${stream}`, phase_ms])));
  errors.add(snapshot.now_s, new Map(snapshot.clocks.map(({subject, error_ms}) => [subject, error_ms])));
  if (performance.now() - drawnAt > kDrawEveryMs && !document.hidden) draw();
}

async function ask() {
  try {
    show(await (await fetch('snapshot')).json());
    lostSince = null;
    $('banner').hidden = true;
  } catch {
    lostSince ??= Date.now();
    document.body.dataset.status = 'lost';
    $('banner').hidden = false;
    $('banner').textContent = `simbench watch does not answer since ${new Date(lostSince).toLocaleTimeString()}: nothing here is of now.`;
  }
  setTimeout(ask, kAskEveryMs);
}

function showTheme(theme) {
  document.documentElement.dataset.theme = theme;
  $('theme').setAttribute('aria-pressed', String(theme === 'dark'));
  for (const chart of charts) chart.redraw();
}

const dark = matchMedia('(prefers-color-scheme: dark)');
showTheme(dark.matches ? 'dark' : 'light');
dark.addEventListener('change', () => showTheme(dark.matches ? 'dark' : 'light'));
$('theme').addEventListener('click', () => showTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
document.addEventListener('visibilitychange', () => drawnAt = 0);
addEventListener('resize', () => drawnAt > 0 && draw());
ask();
