// The page of a report: one archive at a time, its figures, the reader's choices.
//
// The choices are in the fragment of the address, so that a link shows another reader the same:
//   #archive=0&pipeline=yoon2021_both&seed=1&figure=frame_errors&pulse=312

const controls = Object.fromEntries(
    ['archive', 'pipeline', 'seed', 'jump', 'pulse', 'theme'].map(
        (id) => [id, document.getElementById(id)]));
const state = {archive: 0, pipeline: '', seed: '', figure: '', pulse: null};

function groupedById(figures) {
  const groups = new Map();
  for (const figure of figures) groups.set(figure.id, [...groups.get(figure.id) ?? [], figure]);
  return Array.from(groups.values());
}

function makeArchive(root, script) {
  const {figures, columns} = JSON.parse(script.textContent);
  const page = {columns: new Columns(columns), marked: () => state.pulse, chosen: choseFrame};
  // The figures that belong to the answer stand beside it.
  const lead = root.querySelector('.figures.lead');
  const leading = lead?.dataset.figures.split(' ') ?? [];
  const rest = root.querySelector('.figures:not(.lead)');
  const views = groupedById(figures).map((alternatives) => new FigureView(
      alternatives, {...page, preferred: leading.includes(alternatives[0].id) && lead.dataset.pipeline}));
  for (const view of views) {
    (leading.includes(view.id) ? lead : rest).append(view.root);
    addFigureFiles(view);
  }
  return {root, figures, views};
}

const scripts = document.querySelectorAll('script.data');
const archives = Array.from(
    document.querySelectorAll('.archive'), (root, i) => makeArchive(root, scripts[i]));
const allViews = archives.flatMap(({views}) => views);
const current = () => archives[state.archive];

function writeFragment() {
  const chosen = Object.entries(state).filter(([, value]) => value !== '' && value != null);
  history.replaceState(null, '', `#${new URLSearchParams(chosen)}`);
}

// Handles a click on a frame of a figure, or (without a pulse) on its link.
function choseFrame(view, pulse) {
  state.figure = view.id;
  state.pipeline = view.shown.pipeline || state.pipeline;
  state.seed = String(view.shown.seed ?? state.seed);
  if (pulse != null) state.pulse = pulse;
  controls.pulse.value = state.pulse ?? '';
  writeFragment();
  showControls();
  for (const each of allViews) each.redraw();
}

function fillSelect(select, options, chosen) {
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
  select.value = chosen;
}

function showControls() {
  const {figures, views} = current();
  const pipelines = distinct(figures.map(({pipeline}) => pipeline)).filter(Boolean);
  const seeds = distinct(figures.map(({seed}) => seed)).filter((seed) => seed != null);
  const named = (values) => values.map((value) => [value, value]);
  fillSelect(controls.archive, archives.map(({root}, i) => [i, root.dataset.name]), state.archive);
  fillSelect(controls.pipeline, [['', 'as each figure begins'], ...named(pipelines)], state.pipeline);
  fillSelect(controls.seed, [['', 'first'], ...named(seeds)], state.seed);
  fillSelect(controls.jump, [['', 'go to …'], ...views.map((view) => [view.id, view.shown.title])],
             state.figure);
  const hasPulses = figures.some(({panels}) => panels.some(({x_is_pulse}) => x_is_pulse));
  controls.archive.parentElement.hidden = archives.length < 2;
  controls.jump.parentElement.hidden = views.length < 2;
  controls.pipeline.parentElement.hidden = pipelines.length === 0;
  controls.seed.parentElement.hidden = seeds.length === 0;
  controls.pulse.parentElement.hidden = !hasPulses;
}

// A button for each heading of the archive.
function showSections() {
  const headings = Array.from(current().root.querySelectorAll('h3'));
  document.getElementById('sections').replaceChildren(...headings.map((heading) => {
    const made = element('button', '', heading.textContent);
    made.type = 'button';
    made.addEventListener('click', () => heading.scrollIntoView({block: 'start'}));
    return made;
  }));
}

function showState() {
  archives.forEach(({root}, i) => root.hidden = i !== state.archive);
  for (const view of allViews) view.choose({pipeline: state.pipeline, seed: state.seed});
  controls.pulse.value = state.pulse ?? '';
  showControls();
  showSections();
}

function scrollToFigure() {
  const view = current().views.find(({id}) => id === state.figure);
  if (!view) return;
  view.draw();
  view.root.scrollIntoView({block: 'start'});
}

function readFragment() {
  const given = new URLSearchParams(location.hash.slice(1));
  const archive = Number(given.get('archive') ?? 0);
  state.archive = archives[archive] ? archive : 0;
  for (const name of ['pipeline', 'seed', 'figure']) state[name] = given.get(name) ?? '';
  const pulse = Number.parseInt(given.get('pulse'), 10);
  state.pulse = Number.isNaN(pulse) ? null : pulse;
  showState();
  for (const view of allViews) view.redraw();
  scrollToFigure();
}

function listenToControls() {
  const choose = (name, value) => {
    state[name] = value;
    showState();
    writeFragment();
  };
  controls.archive.addEventListener('change', () => choose('archive', Number(controls.archive.value)));
  controls.pipeline.addEventListener('change', () => choose('pipeline', controls.pipeline.value));
  controls.seed.addEventListener('change', () => choose('seed', controls.seed.value));
  controls.jump.addEventListener('change', () => {
    choose('figure', controls.jump.value);
    scrollToFigure();
  });
  controls.pulse.addEventListener('change', () => {
    const pulse = Number.parseInt(controls.pulse.value, 10);
    choose('pulse', Number.isNaN(pulse) ? null : pulse);
    for (const view of allViews) view.redraw();
  });
  document.getElementById('controls').addEventListener('submit', (event) => event.preventDefault());
}

function showTheme(theme) {
  document.documentElement.dataset.theme = theme;
  controls.theme.setAttribute('aria-pressed', String(theme === 'dark'));
  for (const view of allViews) view.redraw();
}

function listenToTheme() {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  showTheme(dark.matches ? 'dark' : 'light');
  dark.addEventListener('change', () => showTheme(dark.matches ? 'dark' : 'light'));
  controls.theme.addEventListener('click', () => showTheme(
      document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
}

// On paper everything is drawn, at the width of the page; afterwards as before.
function showOnPaper(paper) {
  if (paper) for (const view of current().views) view.draw();
  for (const view of allViews) view.resize(paper ? kPrintWidth : undefined);
}

function listenToPrinter() {
  const print = matchMedia('print');
  print.addEventListener('change', () => showOnPaper(print.matches));
  addEventListener('beforeprint', () => showOnPaper(true));
  addEventListener('afterprint', () => showOnPaper(false));
}

function drawInSight() {
  const observer = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      const view = allViews.find(({root}) => root === target);
      view.inSight = isIntersecting;
      if (isIntersecting) view.draw();
    }
  }, {rootMargin: '600px'});
  for (const view of allViews) observer.observe(view.root);
}

function resizeWithPage() {
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth === width || matchMedia('print').matches) return;
    width = innerWidth;
    for (const view of allViews) view.resize();
  });
}

makeTablesSortable(document.body);
for (const overview of document.querySelectorAll('.overview')) addOverviewFiles(overview);
listenToTheme();
readFragment();
listenToControls();
listenToPrinter();
current().views[0]?.draw();
requestAnimationFrame(() => performance.mark('first figure'));
drawInSight();
resizeWithPage();
addEventListener('hashchange', readFragment);
