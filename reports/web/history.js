// What was seen of a watched rig so far, for its figures: values by name over time, the last of them.

const kKeptSeconds = 600;

class History {
  constructor() {
    this.times = [];
    this.values = new Map();  // by series: as many as times, null where there was none
  }

  add(at, values) {
    this.times.push(at);
    for (const name of values.keys()) {
      if (!this.values.has(name)) this.values.set(name, new Array(this.times.length - 1).fill(null));
    }
    for (const [name, all] of this.values) all.push(values.get(name) ?? null);
    const old = this.times.findIndex((time) => time >= at - kKeptSeconds);
    if (old <= 0) return;
    this.times.splice(0, old);
    for (const all of this.values.values()) all.splice(0, old);
  }

  // A panel as chart.js draws it, and its columns.
  panel(title, label) {
    const names = Array.from(this.values.keys());
    const columns = [Float64Array.from(this.times), ...names.map(
        (name) => Float64Array.from(this.values.get(name), (value) => value ?? NaN))];
    const series = names.map((name, i) => ({label: name, mark: 'line', x: 0, y: i + 1, colour: i}));
    return {
      panel: {title, x_label: 'time since the watch began (s)', y_label: label, series, lines: [],
              spans: [], categories: [], log_x: false, log_y: false, x_is_pulse: false},
      columns: {get: (number) => columns[number]},
    };
  }
}
