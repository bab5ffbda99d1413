// What the cells of a table say, as something that can be put in order: numbers by value, whatever
// their unit, in front of words, and last what has no value.
//
//   "1.34 [1.15, 1.56]"  1.34           "< 0.1 %"  below "0.1 %"
//   "980 us"             0.00098        "inf"      behind every number
//   "[0.35, 1.2] ms"     0.00035        "-"        last, in either direction

const kUnits = {
  ps: 1e-12, ns: 1e-9, us: 1e-6, 'µs': 1e-6, 'μs': 1e-6, ms: 1e-3, s: 1, min: 60, h: 3600, d: 86400,
  ppb: 1e-9, ppm: 1e-6, '%': 0.01, k: 1e3, M: 1e6, G: 1e9,
  mHz: 1e-3, Hz: 1, kHz: 1e3, MHz: 1e6, GHz: 1e9, um: 1e-6, mm: 1e-3, cm: 1e-2, m: 1,
  B: 1, kB: 1e3, MB: 1e6, GB: 1e9, KiB: 2 ** 10, MiB: 2 ** 20, GiB: 2 ** 30,
};
const kAbsent = /^(|-|–|—|no values?|none|n\/a|nan|null)$/i;
// A sign of comparison or an opening bracket, then the number. A day or a time of day is none.
const kLeading = new RegExp(
    '^(?:from )?([<>≤≥~]?)=?\\s*[[(]?\\s*([+−-]?)' +
    '(inf(?:inity)?\\b|∞|(?:\\d{1,3}(?: \\d{3})+|\\d+)(?:\\.\\d+)?(?:[eE][+-]?\\d+)?)' +
    '(?![\\d.:/_]|-\\d+-)', 'i');
// The unit behind the number, or behind the range that it begins.
const kUnit = /^(?:[\s\d.,;+−\]()-]|e[+-]?\d|inf|to )*?(?!to )(%|[A-Za-zµμ]+)(?![A-Za-z_\d])/;

// Returns {rank, value, nudge, text}: rank 0 for numbers, 1 for words, 2 for what is absent.
function sortKey(text) {
  const words = text.trim();
  if (kAbsent.test(words)) return {rank: 2, value: 0, nudge: 0, text: words};
  const found = kLeading.exec(words);
  if (!found) return {rank: 1, value: 0, nudge: 0, text: words};
  const [all, relation, sign, digits] = found;
  const rest = words.slice(all.length);
  const unit = kUnit.exec(rest)?.[1];
  // Letters that touch a number and are no unit make it a name: 6host_star.
  if (/^[A-Za-z_]/.test(rest) && !(unit in kUnits)) return {rank: 1, value: 0, nudge: 0, text: words};
  const size = /^\d/.test(digits) ? Number(digits.replaceAll(' ', '')) : Infinity;
  return {
    rank: 0,
    value: (sign === '-' || sign === '−' ? -size : size) * (kUnits[unit] ?? 1),
    nudge: {'<': -1, '>': 1}[relation] ?? 0,
    text: words,
  };
}

function compared(a, b) {
  if (a.rank === 1) return a.text.localeCompare(b.text, 'en', {numeric: true});
  return a.value < b.value ? -1 : a.value > b.value ? 1 : a.nudge - b.nudge;
}

// The order of the keys as numbers of their places; equal ones stay as they are. `direction`: 1 or -1.
function sortedPlaces(keys, direction) {
  return Array.from(keys.keys()).sort((i, j) => {
    const [a, b] = [keys[i], keys[j]];
    return a.rank !== b.rank ? a.rank - b.rank : a.rank === 2 ? 0 : direction * compared(a, b);
  });
}

// A line of RFC 4180.
function csvLine(cells) {
  return cells.map((text) => /[",\r\n]|^\s|\s$/.test(text) ? `"${text.replaceAll('"', '""')}"` : text)
      .join(',') + '\r\n';
}
