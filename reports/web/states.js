// The states of the page and their history: the one that is changed, and one that was kept to
// compare with. A link restores all of it: it is in the fragment of the address, as JSON.
//
// A state is {scenario, sets: {pointer: value}, pipelines: [names], first_seed}. What the page
// shows besides is {pipeline, seeds, figures, budget}.

const kOneChangeMs = 800;  // changes of one parameter within this time are one to undo

function emptyState(scenario) {
  return {scenario, sets: {}, pipelines: [], first_seed: 1};
}

function isState(value) {
  return typeof value === 'object' && value !== null && typeof value.scenario === 'string' &&
      typeof value.sets === 'object' && value.sets !== null && Array.isArray(value.pipelines);
}

class States {
  // `changed()` is called after every change.
  constructor(scenario, changed) {
    this.now = emptyState(scenario);
    this.kept = null;
    this.view = {pipeline: '', seeds: 128, figures: ['frame_errors', 'host_clocks', 'pulse'], budget: true};
    this.past = [];
    this.future = [];
    this.changed = changed;
    this.last = {what: '', at: -Infinity};
  }

  snapshot() {
    return JSON.stringify({now: this.now, kept: this.kept});
  }

  // `what`: changes of the same thing soon after each other are undone together.
  change(what, action) {
    const before = this.snapshot();
    action(this);
    if (this.snapshot() === before) return;
    const at = performance.now();
    if (what !== this.last.what || at - this.last.at > kOneChangeMs) this.past.push(before);
    this.last = {what, at};
    this.future = [];
    this.changed();
  }

  travel(from, to) {
    if (from.length === 0) return;
    to.push(this.snapshot());
    Object.assign(this, JSON.parse(from.pop()));
    this.last = {what: '', at: -Infinity};
    this.changed();
  }

  undo() { this.travel(this.past, this.future); }
  redo() { this.travel(this.future, this.past); }

  set(pointer, value, initial) {
    this.change(pointer, ({now}) => {
      if (JSON.stringify(value) === JSON.stringify(initial)) delete now.sets[pointer];
      else now.sets[pointer] = value;
    });
  }

  fragment() {
    return `#${encodeURIComponent(JSON.stringify({now: this.now, kept: this.kept, view: this.view}))}`;
  }

  // Whether the fragment held states.
  restore(fragment) {
    let given = null;
    try {
      given = JSON.parse(decodeURIComponent(fragment.slice(1)));
    } catch {
      return false;
    }
    if (!isState(given?.now)) return false;
    this.now = {...emptyState(''), ...given.now};
    this.kept = isState(given.kept) ? {...emptyState(''), ...given.kept} : null;
    Object.assign(this.view, given.view);
    return true;
  }
}
