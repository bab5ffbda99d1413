// The parameters of a world: a control for each, in groups, with unit, meaning and source; a search
// over all of them; what was changed stands first.

const kGroups = {
  '/timeline': 'Timeline', '/hosts': 'Hosts and their clocks', '/network': 'Network',
  '/trigger': 'Trigger', '/cameras': 'Cameras', '/usb': 'USB and delivery', '/faults': 'Faults',
  '/algorithms': 'Algorithms', '/evaluation': 'Evaluation',
};

// What most people try first; these stand first, open.
const kOften = [
  '/cameras/count', '/hosts/count', '/trigger/rate_hz', '/cameras/exposure_ms',
  '/usb/delivery_jitter_transfers', '/usb/bandwidth_mb_per_s', '/network/latency_exponential_ms',
  '/network/asymmetry_sigma_ms', '/network/loss_probability', '/hosts/load_log_sigma',
  '/hosts/clock/oscillator/skew_sigma_ppm', '/cameras/drop_probability',
];

function idOf(pointer) {
  return `p${pointer.replaceAll(/[^A-Za-z0-9]/g, '_')}`;
}

// "/hosts/clock/tick_ms" without the unit, which stands behind the value: "hosts clock tick".
function shortName({pointer, unit}) {
  const words = pointer.slice(1).replaceAll(/[/_]/g, ' ');
  const last = ` ${unit.toLowerCase()}`;
  return unit && words.endsWith(last) ? words.slice(0, -last.length) : words;
}

function valueText(value) {
  return value === null ? 'null' : typeof value === 'string' ? value : JSON.stringify(value);
}

// One parameter. `changed(pointer, value)`.
class ParameterRow {
  constructor(parameter, changed) {
    this.parameter = parameter;
    this.changed = changed;
    this.root = element('div', 'parameter');
    this.root.dataset.pointer = parameter.pointer;
    const name = element('label', 'name', shortName(parameter));
    name.htmlFor = idOf(parameter.pointer);
    this.controls = element('div', 'controls');
    this.reset = button('↺', `Reset ${parameter.pointer}`, () => this.changed(parameter.pointer, parameter.value));
    this.error = element('p', 'refusal');
    this.error.id = `${idOf(parameter.pointer)}_refusal`;
    this.error.setAttribute('role', 'alert');
    this.root.append(name, this.controls, this.about(), this.error);
    this.build();
    this.controls.append(this.reset);
    this.show(parameter.value);
  }

  about() {
    const {pointer, meaning, source, low, high, unit} = this.parameter;
    const details = element('details', 'about');
    const limits = low === undefined ? '' : ` From ${low} to ${high ?? 'any'}${unit ? ` ${unit}` : ''}.`;
    const summary = element('summary', '', '?');
    summary.setAttribute('aria-label', `About ${pointer}`);
    details.append(summary, element('p', '', `${meaning}.${limits}`),
                   element('p', 'source', `${pointer} — ${source || 'no source stated'}`));
    return details;
  }

  build() {
    const {type, steps} = this.parameter;
    if (steps || type === 'number' || type === 'integer') return this.buildNumber();
    if (type === 'boolean') return this.buildSwitch();
    if (type === 'word') return this.buildWords();
    return this.buildText();
  }

  prepare(control) {
    control.id = idOf(this.parameter.pointer);
    control.setAttribute('aria-describedby', this.error.id);
    this.controls.append(control);
    return control;
  }

  buildNumber() {
    const {parameter} = this;
    const {steps} = parameter;
    this.scale = steps ? new StepScale(steps) :
        new SliderScale({...parameter, integer: parameter.type === 'integer'});
    this.slider = element('input');
    Object.assign(this.slider, {type: 'range', min: 0, max: steps ? steps.length - 1 : kSliderSteps, step: 1});
    this.slider.setAttribute('aria-label', `${parameter.pointer}, slider`);
    this.slider.addEventListener('input', () => this.moved());
    this.controls.append(this.slider);
    this.field = this.prepare(element('input'));
    Object.assign(this.field, {type: 'text', inputMode: 'decimal', autocomplete: 'off', readOnly: Boolean(steps)});
    this.field.addEventListener('change', () => this.typed());
    this.controls.append(element('span', 'unit', parameter.unit));
    this.read = () => this.field.value;
    this.write = (value) => {
      this.field.value = valueText(value);
      const place = value === null ? 0 : this.scale.placeOf(value);
      this.slider.value = place;
      this.slider.setAttribute('aria-valuetext', `${valueText(value)} ${parameter.unit}`);
    };
  }

  moved() {
    const value = this.scale.valueAt(Number(this.slider.value));
    this.field.value = valueText(value);
    this.slider.setAttribute('aria-valuetext', `${valueText(value)} ${this.parameter.unit}`);
    this.changed(this.parameter.pointer, value);
  }

  typed() {
    const text = this.field.value.trim().replace(',', '.');
    const isNull = text === '' || text === 'null';
    const value = isNull && this.parameter.or_null ? null : Number(text);
    if (isNull ? value === null : Number.isFinite(value) && text !== '') {
      return this.changed(this.parameter.pointer, value);
    }
    this.refuse(`found '${this.field.value}', allowed a number`);
  }

  buildSwitch() {
    this.field = this.prepare(element('input'));
    this.field.type = 'checkbox';
    this.field.addEventListener('change', () => this.changed(this.parameter.pointer, this.field.checked));
    this.write = (value) => this.field.checked = value === true;
  }

  buildWords() {
    const {parameter} = this;
    this.field = this.prepare(element('select'));
    const words = [...parameter.or_null ? [null] : [], ...parameter.words];
    this.field.append(...words.map((word) => new Option(valueText(word), JSON.stringify(word))));
    this.field.addEventListener('change', () => this.changed(parameter.pointer, JSON.parse(this.field.value)));
    this.write = (value) => this.field.value = JSON.stringify(value);
  }

  // Lists and texts, as JSON or as they are.
  buildText() {
    this.field = this.prepare(element('input', 'wide'));
    Object.assign(this.field, {type: 'text', autocomplete: 'off'});
    this.field.addEventListener('change', () => {
      const isText = this.parameter.type === 'text';
      try {
        const text = this.field.value;
        const value = isText && !(this.parameter.or_null && text === 'null') ? text : JSON.parse(text);
        this.changed(this.parameter.pointer, value);
      } catch {
        this.refuse('found no JSON, such as [0, 1]');
      }
    });
    this.write = (value) => this.field.value = valueText(value);
  }

  show(value) {
    const isChanged = JSON.stringify(value) !== JSON.stringify(this.parameter.value);
    if (document.activeElement !== this.slider || !isChanged) this.write(value);
    this.root.classList.toggle('changed', isChanged);
    this.reset.disabled = !isChanged;
  }

  refuse(message) {
    this.error.textContent = message;
    this.root.classList.toggle('refused', message !== '');
    this.field.setAttribute('aria-invalid', String(message !== ''));
  }

  matches(words) {
    const {pointer, meaning, unit} = this.parameter;
    const text = `${pointer} ${meaning} ${unit}`.toLowerCase();
    return words.every((word) => text.includes(word));
  }
}

class ParameterPanel {
  // `changed(pointer, value, initial)`.
  constructor(root, search, changed) {
    this.root = root;
    this.search = search;
    this.changed = changed;
    this.rows = new Map();
    this.groups = [];
    search.addEventListener('input', () => this.filter());
  }

  // The parameters of a scenario.
  build(parameters) {
    this.rows.clear();
    this.shown = [];  // pointers that have other values than the scenario's
    this.groups = [];
    this.root.replaceChildren();
    const often = kOften.map((pointer) => parameters.find((each) => each.pointer === pointer)).filter(Boolean);
    if (parameters.every(({steps}) => steps)) return this.addGroup('Parameters', parameters, true);
    this.addGroup('Often changed', often, !matchMedia('(max-width: 900px)').matches);
    const others = parameters.filter((each) => !often.includes(each));
    for (const [group, members] of groupedBy(others, 'group')) {
      this.addGroup(`${kGroups[group] ?? group} (${members.length})`, members, false);
    }
    this.filter();
  }

  addGroup(heading, members, isOpen) {
    const details = element('details', 'group');
    details.open = isOpen;
    details.append(element('summary', '', heading));
    const rows = members.map((parameter) => {
      const row = new ParameterRow(
          parameter, (pointer, value) => this.changed(pointer, value, parameter.value));
      this.rows.set(parameter.pointer, row);
      return row;
    });
    details.append(...rows.map(({root}) => root));
    this.groups.push({details, rows});
    this.root.append(details);
  }

  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let found = 0;
    for (const {details, rows} of this.groups) {
      let any = 0;
      for (const row of rows) {
        row.root.hidden = !row.matches(words);
        any += row.root.hidden ? 0 : 1;
      }
      details.hidden = any === 0;
      if (words.length > 0) details.open = any > 0;
      found += any;
    }
    this.search.setCustomValidity(found === 0 ? 'no parameter has all of these words' : '');
    document.getElementById('found').textContent =
        words.length === 0 ? '' : `${found} of ${this.rows.size} parameters`;
  }

  // The values of a state: those that were changed, else the scenario's own.
  show(sets) {
    for (const pointer of new Set([...this.shown, ...Object.keys(sets)])) {
      const row = this.rows.get(pointer);
      row?.show(pointer in sets ? sets[pointer] : row.parameter.value);
    }
    this.shown = Object.keys(sets);
  }

  // A refusal beside its parameter; without one, none is refused any more. Whether it has a place.
  refuse(pointer, message) {
    for (const row of this.rows.values()) row.refuse('');
    const row = this.rows.get(pointer);
    if (!row) return false;
    row.refuse(message);
    row.root.closest('details.group').open = true;
    return true;
  }
}

function groupedBy(values, member) {
  const groups = new Map();
  for (const value of values) groups.set(value[member], [...groups.get(value[member]) ?? [], value]);
  return groups;
}
