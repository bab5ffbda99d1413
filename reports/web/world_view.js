// What the page shows of one state: the answer, the overview, the tables and the figures.

function answerElement(answer) {
  const root = element('div', 'answer');
  if (!answer) {
    root.append(element('p', '', 'No answer yet.'));
    return root;
  }
  root.append(element('p', '', answer.lead));
  const points = element('dl');
  for (const {label, text} of answer.lines) {
    const point = element('div');
    point.append(element('dt', '', label), element('dd', '', text));
    points.append(point);
  }
  root.append(points);
  return root;
}

function fragmentOf(html) {
  const template = document.createElement('template');
  template.innerHTML = html;
  return template.content;
}

// What each table is sorted by, so that its successor is too.
function sortsOf(root) {
  return Array.from(root.querySelectorAll('th[aria-sort]'), (heading) => ({
    caption: heading.closest('table').caption?.textContent, column: heading.cellIndex,
    uses: heading.getAttribute('aria-sort') === 'ascending' ? 1 : 2,
  }));
}

function showTables(root, html) {
  const sorts = sortsOf(root);
  root.replaceChildren(fragmentOf(html));
  makeTablesSortable(root);
  for (const table of root.querySelectorAll('table[data-sortable]')) {
    const sort = sorts.find(({caption}) => caption === table.caption?.textContent);
    const head = sort && table.tHead.rows[0].cells[sort.column]?.querySelector('button');
    for (let i = 0; head && i < sort.uses; ++i) head.click();
  }
}

// Figures as data in place of what is there; returns their views.
function showFigures(root, data, preferred) {
  const page = {columns: new Columns(data.columns), marked: () => null, preferred};
  const views = Array.from(groupedBy(data.figures, 'id').values(),
                           (alternatives) => new FigureView(alternatives, page));
  root.replaceChildren(...views.map((view) => view.root));
  for (const view of views) {
    view.draw();
    addFigureFiles(view);
  }
  return views;
}

const kFigurePlaces = ['seeds', 'run', 'budget'];

class WorldView {
  constructor(name) {
    this.root = element('section', 'world');
    this.root.setAttribute('aria-label', name);
    this.head = element('h2', '', name);
    this.world = element('p', 'provenance');
    this.warnings = element('div');
    this.answer = element('div');
    this.overview = element('div');
    this.table = element('div');
    this.beside = element('div');
    this.places = Object.fromEntries(kFigurePlaces.map((of) => [of, element('div', 'figures')]));
    this.more = element('details', 'more');
    this.more.append(element('summary', '', 'All tables'));
    this.tables = element('div');
    this.more.append(this.tables);
    this.more.hidden = true;
    this.more.addEventListener('toggle', () => this.showAllTables(this.allTables));
    this.root.append(this.head, this.world, this.warnings, this.answer, this.overview,
                     this.beside, this.table, this.places.run, this.places.budget, this.places.seeds,
                     this.more);
    this.views = [];
  }

  showWorld(name, {world, warnings, changed}) {
    this.head.textContent = name;
    this.world.textContent = changed ? `${world} ${changed}` : world;
    this.warnings.replaceChildren();
    if (warnings.length === 0) return;
    const list = element('ul', 'notes');
    list.append(...warnings.map((text) => element('li', '', text)));
    this.warnings.append(list);
  }

  showPicture(view) {
    this.answer.replaceChildren(answerElement(view.answer));
    this.overview.replaceChildren(fragmentOf(view.overview));
    for (const overview of this.overview.querySelectorAll('.overview')) addOverviewFiles(overview);
    showTables(this.table, view.table);
  }

  // All tables, once somebody wants them.
  showAllTables(html) {
    this.allTables = html;
    this.more.hidden = false;
    if (this.more.open) showTables(this.tables, html);
  }

  // A recording beside the simulation, or why it is not.
  showBeside(table, text) {
    showTables(this.beside, table);
    if (text) this.beside.append(element('p', 'legend', text));
  }

  showFigures({of, notes, data}) {
    const place = this.places[of];
    // The place keeps its height, so that nothing jumps while figures are exchanged.
    place.style.minHeight = `${place.offsetHeight}px`;
    const views = showFigures(place, data, '');
    place.append(...notes.map((text) => element('p', 'legend', text)));
    place.style.minHeight = '';
    this.views = [...this.views.filter((view) => view.root.isConnected), ...views];
  }

  // What is shown of a state that is no more, until a later event replaces it.
  fade(isOld) {
    this.root.classList.toggle('old', isOld);
  }

  redraw() {
    for (const view of this.views) view.redraw();
  }

  resize(width) {
    for (const view of this.views) view.resize(width);
  }
}
