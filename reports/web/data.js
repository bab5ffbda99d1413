// The data of the figures: columns of numbers as reports/page/html_page.h stores them, and the one
// table that uPlot wants of all series of a chart.

const kNoNumber = 0xffffff;

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}

function decodedSteps({n, from, step}) {
  return Float64Array.from({length: n}, (_, i) => from + i * step);
}

function decodedThreeBytes({min, unit, u24}) {
  const bytes = bytesOf(u24);
  return Float64Array.from({length: bytes.length / 3}, (_, i) => {
    const k = bytes[3 * i] | bytes[3 * i + 1] << 8 | bytes[3 * i + 2] << 16;
    return k === kNoNumber ? NaN : min + k * unit;
  });
}

function decodedDoubles({f64}) {
  const view = new DataView(bytesOf(f64).buffer);
  return Float64Array.from({length: view.byteLength / 8}, (_, i) => view.getFloat64(8 * i, true));
}

function decoded(column) {
  if ('step' in column) return decodedSteps(column);
  return 'u24' in column ? decodedThreeBytes(column) : decodedDoubles(column);
}

// Columns by number, decoded when they are first needed.
class Columns {
  constructor(encoded) {
    this.encoded = encoded;
    this.known = new Map();
  }

  get(number) {
    if (!this.known.has(number)) this.known.set(number, decoded(this.encoded[number]));
    return this.known.get(number);
  }
}

function isAscending(x) {
  for (let i = 1; i < x.length; ++i) if (!(x[i - 1] <= x[i])) return false;
  return true;
}

// Points in the order of x; NaN in y becomes null, which uPlot takes for a gap.
function sortedPoints(x, y, positiveOnly) {
  const value = (number) => Number.isFinite(number) && (number > 0 || !positiveOnly) ? number : null;
  if (isAscending(x)) return {x: Array.from(x), y: Array.from(y, value)};
  const order = Array.from(x.keys()).sort((a, b) => x[a] - x[b]);
  return {x: order.map((i) => x[i]), y: order.map((i) => value(y[i]))};
}

// Every x as often as the series that has it most often, in order.
function allX(series) {
  const times = new Map();
  for (const {x} of series) {
    for (let i = 0, run = 0; i < x.length; ++i) {
      run = i > 0 && x[i] === x[i - 1] ? run + 1 : 1;
      if (run > (times.get(x[i]) ?? 0)) times.set(x[i], run);
    }
  }
  const distinct = Array.from(times.keys()).sort((a, b) => a - b);
  return distinct.flatMap((x) => new Array(times.get(x)).fill(x));
}

// y of a series at every one of `all`; undefined, where it has no point, is no gap.
function yAt(all, {x, y}) {
  const out = new Array(all.length).fill(undefined);
  for (let i = 0, slot = 0; i < x.length; ++i, ++slot) {
    while (all[slot] !== x[i]) ++slot;
    out[slot] = y[i];
  }
  return out;
}

// [x, y of the first series, y of the second ...], as uPlot draws it.
function alignedData(panel, columns) {
  const series = panel.series.map(
      ({x, y}) => sortedPoints(columns.get(x), columns.get(y), panel.log_y));
  if (series.length === 0) return [[]];
  const shared = panel.series.every(({x}) => x === panel.series[0].x);
  if (shared && isAscending(columns.get(panel.series[0].x))) {
    return [series[0].x, ...series.map(({y}) => y)];
  }
  const all = allX(series);
  return [all, ...series.map((each) => yAt(all, each))];
}
