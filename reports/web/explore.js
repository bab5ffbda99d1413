// The page of `simbench explore`: a state is changed, its world is computed, what follows is shown.
//
// Each change ends what was computed for the state before and asks for the new one. What is shown
// stays until the first picture of the new state comes, greyed meanwhile.

const kPatienceMs = 15000;  // without an event of a look that goes on, the server is asked again
const kRetryMs = 2000;
const kAddressMs = 250;  // without a change, until the address has the state

const $ = (id) => document.getElementById(id);
const stored = $('stored');
const server = stored ? new Stored(stored.textContent) : new Server();
const parameters = new ParameterPanel($('groups'), $('search'),
                                      (pointer, value, initial) => states.set(pointer, value, initial));
let subject = null, states = null, choices = null;
let shownScenario = '';
let views = [];
let measuredViews = [], comparisonViews = [];
let look = null;  // {abort, lastEvent}

function say(text) {
  $('progress').textContent = text;
}

function showBanner(text) {
  $('banner').textContent = text;
  $('banner').hidden = text === '';
}

function fillSelect(select, options, chosen) {
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
  select.value = chosen;
}

// The states that are looked at: the kept one first, which the other is compared with.
function shownStates() {
  return states.kept ? [states.kept, states.now] : [states.now];
}

function makeViews() {
  const names = states.kept ? ['A, kept', 'B, now'] : ['Now'];
  if (views.length === names.length) return;
  views = names.map((name) => new WorldView(name));
  $('views').replaceChildren(...views.map(({root}) => root));
  $('views').classList.toggle('two', views.length === 2);
  $('comparison').hidden = views.length < 2 || stored !== null;
}

function nameOf(index) {
  const {scenario} = shownStates()[index];
  return views.length < 2 ? scenario : `${index === 0 ? 'A, kept' : 'B, now'}: ${scenario}`;
}

const handlers = {
  worlds({worlds, state = 0}) {
    parameters.refuse('', '');
    showRefusal('');
    say('The first seeds are computed …');
    worlds.forEach((world, i) => views[state + i].showWorld(nameOf(state + i), world));
  },
  refused({pointer, message, state}) {
    const isKept = views.length === 2 && state === 0;
    if (isKept || !parameters.refuse(pointer, message)) {
      showRefusal(pointer ? `${pointer}: ${message}` : message);
    }
    say('This world cannot be; what is shown is of the state before.');
  },
  picture({seeds, elapsed_ms, views: shown, comparison, state = 0}) {
    shown.forEach((view, i) => {
      views[state + i].showPicture(view);
      views[state + i].fade(false);
    });
    if (comparison) {
      $('comparison_answer').replaceChildren(answerElement(comparison.answer));
      showTables($('comparison_tables'), comparison.tables);
      comparisonViews = showFigures($('comparison_figures'), comparison.data, states.view.pipeline);
    }
    showPipelines(shown[shown.length - 1]);
    say(`${seeds} seeds after ${Math.round(elapsed_ms)} ms; more follow.`);
    performance.mark('picture');
    $('views').dataset.seeds = seeds;
  },
  figures(event) {
    views[event.state].showFigures(event);
  },
  tables({state, tables}) {
    views[state].showAllTables(tables);
  },
  beside({state, table, text}) {
    views[state].showBeside(table ?? '', text ?? '');
  },
  levers({answer, levers}) {
    showLevers(answer, levers);
  },
  end({seeds, why}) {
    say(`${seeds} seeds.${why ? ` ${why}.` : ''}`);
    $('stop').hidden = true;
    $('views').dataset.ended = seeds;
  },
  failed({message}) {
    showBanner(message);
    say('');
  },
};

function showRefusal(text) {
  $('refusal').textContent = text;
  $('refusal').hidden = text === '';
}

// Which pipeline the figures of one run are of.
function showPipelines({pipelines}) {
  const options = [['', 'the best'], ...pipelines.map((name) => [name, name])];
  const known = pipelines.includes(states.view.pipeline) ? states.view.pipeline : '';
  fillSelect($('detail'), options, known);
}

function stopLook() {
  look?.abort.abort();
  look = null;
}

async function startLook() {
  stopLook();
  makeViews();
  views.forEach((view) => view.fade(true));
  $('stop').hidden = false;
  const mine = {abort: new AbortController(), lastEvent: performance.now(), ended: false};
  look = mine;
  const onEvent = (event) => {
    if (look !== mine) return;
    mine.lastEvent = performance.now();
    handlers[event.event]?.(event);
  };
  try {
    await server.look(shownStates(), states.view, onEvent, mine.abort.signal);
    mine.ended = true;
    if (look === mine) showBanner('');
  } catch (error) {
    if (mine.abort.signal.aborted || look !== mine) return;
    if (error instanceof Refused) return handlers.refused({state: views.length - 1, pointer: error.pointer, message: error.message});
    lostServer();
  }
}

// Asks again and again until the server is back, and goes on then.
async function lostServer() {
  stopLook();
  showBanner('The server does not answer: was simbench explore ended, or did this machine sleep? Asking again …');
  say('');
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, kRetryMs));
    if (look) return;
    try {
      await server.subject();
      break;
    } catch {
      continue;
    }
  }
  showBanner('');
  startLook();
}

function watchOverLook() {
  setInterval(() => {
    if (!look || look.ended || performance.now() - look.lastEvent < kPatienceMs) return;
    startLook();
  }, 1000);
}

// Changes that are made at once are one look.
let scheduled = false, addressTimer = 0;
function stateChanged() {
  // Browsers take their time for it, and refuse it when it comes too often.
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => history.replaceState(null, '', states.fragment()), kAddressMs);
  if (scheduled) return;
  scheduled = true;
  queueMicrotask(() => {
    scheduled = false;
    showState();
  });
}

async function showState() {
  $('undo').disabled = states.past.length === 0;
  $('redo').disabled = states.future.length === 0;
  $('keep').hidden = states.kept !== null;
  $('drop').hidden = $('swap').hidden = states.kept === null;
  if (states.now.scenario !== shownScenario && !await loadScenario()) return;
  parameters.show(states.now.sets);
  $('first_seed').value = states.now.first_seed;
  $('seeds').value = states.view.seeds;
  showChoices();
  showChanged();
  startLook();
}

async function loadScenario() {
  const {scenario} = states.now;
  try {
    const answer = await server.parameters(emptyState(scenario));
    if (states.now.scenario !== scenario) return false;
    shownScenario = scenario;
    choices = answer.choices;
    parameters.build(answer.parameters);
    $('scenario').value = scenario;
    return true;
  } catch (error) {
    if (error instanceof Refused) showRefusal(error.message);
    else lostServer();
    return false;
  }
}

function showChanged() {
  const count = Object.keys(states.now.sets).length;
  $('changed').textContent = count === 0 ? 'Nothing is changed.' :
      `Changed: ${Object.entries(states.now.sets).map(([pointer, value]) => `${pointer} = ${valueText(value)}`).join(', ')}`;
  $('reset').disabled = count === 0;
}

// The pipelines of the scenario to tick, and a stage for each part of one's own.
function showChoices() {
  const all = choices.pipelines.filter(({programs}) => !programs).map(({name}) => name);
  const own = states.now.pipelines.filter((name) => !all.includes(name));
  const chosen = states.now.pipelines.length ? states.now.pipelines : all;
  $('pipelines').replaceChildren(...[...all, ...own].map((name) => {
    const label = element('label', 'tick');
    const box = element('input');
    box.type = 'checkbox';
    box.checked = chosen.includes(name);
    box.addEventListener('change', () => choosePipeline(name, box.checked, all, chosen));
    label.append(box, ` ${name}`);
    return label;
  }));
}

function choosePipeline(name, isChosen, all, chosen) {
  const order = [...all, ...chosen.filter((each) => !all.includes(each))];
  const wanted = isChosen ? [...chosen, name] : chosen.filter((each) => each !== name);
  if (wanted.length === 0) return showChoices();
  const sorted = order.filter((each) => wanted.includes(each));
  const isAll = sorted.length === all.length && sorted.every((each) => all.includes(each));
  states.change('pipelines', ({now}) => now.pipelines = isAll ? [] : sorted);
}

function buildOwnPipeline() {
  $('own').replaceChildren(...choices.stages.filter(({stage}) => stage !== 'capture_alignment').map(({stage, algorithms}) => {
    const {wrapper, select} = selectElement(
        stage, algorithms.map(({name}) => [name, name]), () => {});
    select.dataset.stage = stage;
    return wrapper;
  }));
}

function addOwnPipeline() {
  const name = Array.from($('own').querySelectorAll('select'), ({value}) => value).join('+');
  const all = choices.pipelines.filter(({programs}) => !programs).map((each) => each.name);
  const chosen = states.now.pipelines.length ? states.now.pipelines : all;
  if (!chosen.includes(name)) states.change('pipelines', ({now}) => now.pipelines = [...chosen, name]);
}

function showLevers(answer, levers) {
  const list = element('ul');
  for (const {what, pipeline, sets, from, to} of levers) {
    const item = element('li', '', `With ${what}: from ${numberText(from)} to ${numberText(to)} ms. `);
    item.append(button('Try it', `Try ${what}`, () => states.change('lever', ({now}) => {
      for (const set of sets) now.sets[set.pointer] = JSON.parse(set.value);
      if (pipeline && now.pipelines.length && !now.pipelines.includes(pipeline)) now.pipelines.push(pipeline);
      if (pipeline && !now.pipelines.length && pipeline.includes('+')) {
        now.pipelines = [...choices.pipelines.filter(({programs}) => !programs).map(({name}) => name), pipeline];
      }
    })));
    list.append(item);
  }
  $('levers').replaceChildren(element('h3', '', 'What would help'), answerElement(answer), list);
  $('levers').hidden = false;
}

async function findLevers() {
  $('levers').hidden = false;
  $('levers').replaceChildren(element('p', 'legend', 'Trying algorithms and changes of the rig …'));
  const abort = new AbortController();
  try {
    await server.look([states.now], {...states.view, seeds: 32, levers: true}, (event) => {
      if (event.event === 'levers') showLevers(event.answer, event.levers);
      if (event.event === 'failed') $('levers').replaceChildren(element('p', 'refusal', event.message));
    }, abort.signal);
  } catch {
    lostServer();
  }
}

async function showText(path, title) {
  try {
    const seeds = Number($('views').dataset.seeds ?? subject.first_seeds);
    const text = await server.text(path, states.now, seeds);
    $('text_title').textContent = title;
    $('text').textContent = text;
    const file = path === 'command.txt' ? 'explored.sh' : path === 'script.py' ? 'explored.py' : 'explored.json';
    $('save').onclick = () => saveFile(file, new Blob([text], {type: 'text/plain'}));
    $('copy').onclick = () => navigator.clipboard?.writeText(text);
    $('texts').showModal();
  } catch (error) {
    if (error instanceof Refused) showRefusal(error.message);
    else lostServer();
  }
}

// The rig that was recorded, as it was.
function showMeasured({inputs, answer, trust, overview, tables, data}) {
  const root = $('measured');
  root.hidden = false;
  const figures = element('div', 'figures');
  const more = element('details', 'more');
  more.append(element('summary', '', 'All tables of the recording'), fragmentOf(tables));
  root.append(element('h2', '', `Measured: ${inputs.join(', ')}`), answerElement(answer),
              element('p', 'legend', `The model: ${trust}`), fragmentOf(overview),
              figures, more);
  makeTablesSortable(root);
  measuredViews = showFigures(figures, data, '');
}

function buildFigureChoice() {
  $('figures').replaceChildren(...[...subject.figures, {id: 'budget', title: 'Error budget'}].map(({id, title}) => {
    const label = element('label', 'tick');
    const box = element('input');
    box.type = 'checkbox';
    box.checked = id === 'budget' ? states.view.budget : states.view.figures.includes(id);
    box.addEventListener('change', () => {
      if (id === 'budget') states.view.budget = box.checked;
      else if (box.checked) states.view.figures.push(id);
      else states.view.figures = states.view.figures.filter((each) => each !== id);
      for (const view of views) view.places[id === 'budget' ? 'budget' : 'run'].replaceChildren();
      stateChanged();
    });
    label.append(box, ` ${title}`);
    return label;
  }));
}

// What only a server can do is not offered without one.
function hideServersPart() {
  for (const id of ['help', 'file', 'python', 'json', 'csv', 'more']) $(id).hidden = true;
  for (const id of ['scenario', 'first_seed', 'seeds']) $(id).parentElement.hidden = true;
  for (const id of ['pipelines', 'figures']) $(id).closest('details').hidden = true;
  document.querySelector('.search').hidden = true;
}

function listen() {
  $('scenario').addEventListener('change', () => states.change('scenario', (all) => all.now = emptyState($('scenario').value)));
  $('undo').addEventListener('click', () => states.undo());
  $('redo').addEventListener('click', () => states.redo());
  $('reset').addEventListener('click', () => states.change('reset', ({now}) => now.sets = {}));
  $('keep').addEventListener('click', () => states.change('keep', (all) => all.kept = structuredClone(all.now)));
  $('drop').addEventListener('click', () => states.change('drop', (all) => all.kept = null));
  $('swap').addEventListener('click', () => states.change('swap', (all) => [all.now, all.kept] = [all.kept, all.now]));
  $('stop').addEventListener('click', () => {
    stopLook();
    $('stop').hidden = true;
    say(`Stopped at ${$('views').dataset.seeds ?? 0} seeds.`);
    views.forEach((view) => view.fade(false));
  });
  $('more').addEventListener('click', () => {
    states.view.seeds = Math.min(subject.most_seeds, 4 * states.view.seeds);
    stateChanged();
  });
  $('first_seed').addEventListener('change', () => {
    const seed = Math.max(0, Math.round(Number($('first_seed').value) || 1));
    states.change('first_seed', ({now}) => now.first_seed = seed);
  });
  $('seeds').addEventListener('change', () => {
    states.view.seeds = Math.min(subject.most_seeds, Math.max(1, Math.round(Number($('seeds').value) || 8)));
    stateChanged();
  });
  $('detail').addEventListener('change', () => {
    states.view.pipeline = $('detail').value;
    stateChanged();
  });
  $('help').addEventListener('click', findLevers);
  $('add_own').addEventListener('click', addOwnPipeline);
  $('command').addEventListener('click', () => showText('command.txt', 'The command'));
  $('file').addEventListener('click', () => showText('scenario.json', 'The scenario file'));
  $('python').addEventListener('click', () => showText('script.py', 'The same in Python'));
  $('json').addEventListener('click', async () => {
    const seeds = Number($('views').dataset.seeds ?? subject.first_seeds);
    saveFile('results.json', new Blob([await server.results(states.now, seeds, 'json')]));
  });
  $('csv').addEventListener('click', async () => {
    const seeds = Number($('views').dataset.seeds ?? subject.first_seeds);
    saveFile('results.csv', new Blob([await server.results(states.now, seeds, 'tidy')]));
  });
  $('close').addEventListener('click', () => $('texts').close());
  document.addEventListener('keydown', pressed);
  $('bar').addEventListener('submit', (event) => event.preventDefault());
  addEventListener('hashchange', () => {
    if (states.restore(location.hash)) showState();
  });
}

function pressed(event) {
  const isTyping = ['INPUT', 'SELECT', 'TEXTAREA'].includes(event.target.tagName) && event.target.type !== 'range';
  if ((event.ctrlKey || event.metaKey) && !isTyping && event.key.toLowerCase() === 'z') {
    event.preventDefault();
    if (event.shiftKey) states.redo();
    else states.undo();
  }
  if (event.key === '/' && !isTyping) {
    event.preventDefault();
    $('search').focus();
  }
}

function showTheme(theme) {
  document.documentElement.dataset.theme = theme;
  $('theme').setAttribute('aria-pressed', String(theme === 'dark'));
  for (const view of [...views, ...measuredViews, ...comparisonViews]) view.redraw();
}

function listenToTheme() {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  showTheme(dark.matches ? 'dark' : 'light');
  dark.addEventListener('change', () => showTheme(dark.matches ? 'dark' : 'light'));
  $('theme').addEventListener('click', () => showTheme(
      document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
}

function followSize() {
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth === width || matchMedia('print').matches) return;
    width = innerWidth;
    for (const view of [...views, ...measuredViews, ...comparisonViews]) view.resize();
  });
  addEventListener('beforeprint', () => views.forEach((view) => view.resize(kPrintWidth)));
  addEventListener('afterprint', () => views.forEach((view) => view.resize()));
}

async function begin() {
  listenToTheme();
  try {
    subject = await server.subject();
  } catch {
    showBanner('The server does not answer. Start simbench explore again and open its address.');
    return;
  }
  states = new States(subject.subject, stateChanged);
  states.now.pipelines = subject.pipelines;
  states.now.first_seed = subject.first_seed;
  states.restore(location.hash);
  if (subject.measured) showMeasured(subject.measured);
  const names = subject.scenarios.map(({name}) => name);
  if (!names.includes(subject.subject)) names.unshift(subject.subject);
  fillSelect($('scenario'), names.map((name) => [name, name]), states.now.scenario);
  buildFigureChoice();
  if (stored) hideServersPart();
  listen();
  followSize();
  watchOverLook();
  await showState();
  buildOwnPipeline();
}

begin();
