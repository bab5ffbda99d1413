// One figure of the page, with its alternatives and its own switches.
//
// Figures with one id are alternatives. A view shows the one nearest to the reader's choice {pipeline,
// seed} ('' without a choice). It draws when it becomes visible.

// The default of a figure that exists for single pipelines only: the paper's own.
const kPaperPipeline = 'yoon2021_both';

function nearest(alternatives, wish, preferred) {
  const score = ({pipeline, seed}) => (pipeline === wish.pipeline ? 4 : 0) +
      (String(seed ?? '') === wish.seed ? 2 : 0) + (pipeline === preferred ? 1 : 0);
  return alternatives.reduce((best, each) => score(each) > score(best) ? each : best);
}

function distinct(values) {
  return Array.from(new Set(values));
}

function button(text, label, action) {
  const made = element('button', '', text);
  made.type = 'button';
  made.setAttribute('aria-label', label);
  made.addEventListener('click', action);
  return made;
}

function selectElement(label, options, action) {
  const wrapper = element('label', '', `${label} `);
  const select = document.createElement('select');
  select.append(...options.map(([value, text]) => new Option(text, value)));
  select.addEventListener('change', () => action(select.value));
  wrapper.append(select);
  return {wrapper, select};
}

class FigureView {
  // `page`: {columns, marked(), chosen(view, pulse), preferred: pipeline}; see report.js. A page
  // without links to its figures has no chosen().
  constructor(alternatives, page) {
    this.alternatives = alternatives;
    this.page = page;
    this.id = alternatives[0].id;
    this.wish = {pipeline: '', seed: ''};
    this.charts = [];
    this.inSight = false;
    this.root = this.build();
    this.choose(this.wish);
  }

  build() {
    const root = element('figure', 'figure');
    root.dataset.figure = this.id;
    const head = element('div', 'figure-head');
    this.title = element('h4');
    this.paper = element('span', 'paper');
    head.append(this.title, this.paper, this.buildTools());
    this.body = element('div', 'panels');
    this.caption = element('figcaption');
    root.append(head, this.body, this.caption);
    return root;
  }

  buildTools() {
    const tools = element('div', 'figure-tools');
    const pipelines = distinct(this.alternatives.map(({pipeline}) => pipeline));
    const seeds = distinct(this.alternatives.map(({seed}) => String(seed ?? '')));
    const named = (values, none) => values.map((value) => [value, value || none]);
    this.pipeline = selectElement('Pipeline', named(pipelines, 'together'), (value) => this.choose(
        {...this.wish, pipeline: value}));
    this.seed = selectElement('Seed', named(seeds, 'all'), (value) => this.choose(
        {...this.wish, seed: value}));
    this.pipeline.wrapper.hidden = pipelines.length < 2;
    this.seed.wrapper.hidden = seeds.length < 2;
    this.reset = button('Reset zoom', `Reset zoom of ${this.alternatives[0].title}`,
                        () => this.charts.forEach(resetZoom));
    const link = button('Link', `Link to ${this.alternatives[0].title}`,
                        () => this.page.chosen(this, null));
    link.hidden = !this.page.chosen;
    tools.append(this.pipeline.wrapper, this.seed.wrapper, this.reset, link);
    return tools;
  }

  choose(wish) {
    this.wish = wish;
    const shown = nearest(this.alternatives, wish, this.page.preferred || kPaperPipeline);
    if (shown === this.shown) return;
    this.shown = shown;
    this.pipeline.select.value = shown.pipeline;
    this.seed.select.value = String(shown.seed ?? '');
    this.title.textContent = shown.title;
    this.paper.textContent = shown.paper ? `after ${shown.paper} of the paper` : '';
    this.caption.textContent = shown.caption;
    this.prepare();
    if (this.inSight) this.draw();
  }

  // Empty panels of the right size, so that nothing moves when they are drawn.
  prepare() {
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    this.drawn = false;
    this.body.replaceChildren();
    if (this.shown.absent) this.body.append(element('p', 'absent', this.shown.absent));
    this.hosts = this.shown.panels.map((panel) => this.addPanel(panel));
    this.reset.hidden = this.shown.panels.every(({categories}) => categories.length);
  }

  addPanel(panel) {
    const root = element('div', 'panel');
    const host = element('div', 'chart');
    host.style.minHeight = `${chartHeight(panel, innerWidth) + 30}px`;
    host.tabIndex = 0;
    host.setAttribute('role', 'img');
    const names = panel.series.map(({label}) => label).filter(Boolean).join(', ');
    host.setAttribute('aria-label', `${panel.title || this.shown.title}: ${panel.y_label} over ${
        panel.x_label || 'categories'}. ${names}. Plus and minus zoom, arrows move, 0 resets.`);
    if (panel.title) root.append(element('h5', '', panel.title));
    if (!isLying(panel)) {
      root.append(element('div', 'y-label', panel.y_label));
    }
    root.append(host);
    this.body.append(root);
    return host;
  }

  draw() {
    if (this.drawn) return;
    this.drawn = true;
    this.charts = this.shown.panels.map((panel, i) => this.drawPanel(panel, this.hosts[i]));
    if (this.shown.photographs.length) {
      this.body.append(photographsElement(this.shown.photographs));
    }
  }

  drawPanel(panel, host) {
    const chart = makeChart(host, panel, this.page.columns, this.page.marked);
    host.uplot = chart;
    host.addEventListener('keydown', (event) => this.pressed(event, chart, panel));
    if (panel.x_is_pulse) this.listenForFrames(chart);
    return chart;
  }

  // A click chooses the pulse under it; the end of a drag, which zooms, does not.
  listenForFrames(chart) {
    let from = 0;
    chart.over.addEventListener('mousedown', ({clientX}) => from = clientX);
    chart.over.addEventListener('click', ({clientX}) => {
      if (Math.abs(clientX - from) > 3) return;
      const left = clientX - chart.over.getBoundingClientRect().left;
      this.page.chosen?.(this, Math.round(chart.posToVal(left, 'x')));
    });
  }

  pressed(event, chart, panel) {
    const actions = {
      '+': () => zoomBy(chart, 0.5), '=': () => zoomBy(chart, 0.5), '-': () => zoomBy(chart, 2),
      'ArrowLeft': () => zoomBy(chart, 1, -0.25), 'ArrowRight': () => zoomBy(chart, 1, 0.25),
      '0': () => resetZoom(chart),
    };
    const action = actions[event.key];
    if (!action || panel.categories.length || event.target !== event.currentTarget) return;
    event.preventDefault();
    action();
  }

  redraw() {
    for (const chart of this.charts) chart.redraw();
  }

  // Without a width, as wide as there is room.
  resize(width) {
    this.charts.forEach((chart, i) => {
      const wide = width ?? this.hosts[i].clientWidth;
      if (wide > 0) chart.setSize({width: wide, height: chartHeight(this.shown.panels[i], wide)});
    });
  }
}
