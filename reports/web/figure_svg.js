// A figure as one SVG: its title, its charts with their legends, its photographs, as the page shows
// them. Its texts are texts; its colours are those of the page's theme.

const kSheetMargin = 14;
const kSheetFont = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif';
const kPhotographWidth = 160, kPhotographGap = 10;

function widthOf(text, size, weight) {
  widthOf.context ??= document.createElement('canvas').getContext('2d');
  widthOf.context.font = `${weight} ${size}px system-ui, sans-serif`;
  return widthOf.context.measureText(text).width;
}

function wrappedText(text, size, weight, width) {
  const lines = [];
  for (const word of text.split(' ')) {
    const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
    if (lines.length && widthOf(longer, size, weight) <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

// Grows downwards; what is added stands below what is there.
class SvgSheet {
  constructor(width, title, description) {
    this.width = width + 2 * kSheetMargin;
    this.inner = width;
    this.y = kSheetMargin;
    this.root = svgElement('svg', {xmlns: kSvg, 'font-family': kSheetFont, role: 'img'});
    this.paper = svgElement('rect', {x: 0, y: 0, fill: themeColour('--paper')});
    const [name, about] = ['title', 'desc'].map((kind) => svgElement(kind, {}));
    [name.textContent, about.textContent] = [title, description];
    this.root.append(name, about, this.paper);
  }

  paragraph(text, {size, weight = 400, colour = '--text', x = 0, width = this.inner}) {
    if (!text) return;
    for (const line of wrappedText(text, size, weight, width)) {
      this.y += size * 1.35;
      this.root.append(svgText(line, kSheetMargin + x, this.y - size * 0.3, {
        'font-size': size, 'font-weight': weight, fill: themeColour(colour),
      }));
    }
  }

  // At (x, the sheet's end), without moving the end.
  place(x, content) {
    const corner = [kSheetMargin + x, this.y].map(shortNumber).join(' ');
    const group = svgElement('g', {transform: `translate(${corner})`});
    group.append(...content);
    this.root.append(group);
  }

  finished() {
    const height = Math.ceil(this.y + kSheetMargin);
    for (const [name, value] of Object.entries({width: this.width, height})) {
      this.root.setAttribute(name, value);
      this.paper.setAttribute(name, value);
    }
    this.root.setAttribute('viewBox', `0 0 ${this.width} ${height}`);
    return this.root;
  }
}

// An entry for each label that is shown, side by side as far as there is room.
function addLegend(sheet, chart, panel) {
  const row = 18, swatch = 12;
  let x = 0;
  const entries = [];
  chart.groups.forEach((first, i) => {
    if (first !== i || !chart.series[i + 1].show) return;
    const label = panel.series[i].label || panel.y_label;
    const wide = swatch + 5 + widthOf(label, kTextSize, 500) + 16;
    if (x > 0 && x + wide > sheet.inner) {
      x = 0;
      entries.push([]);
    }
    if (entries.length === 0) entries.push([]);
    entries.at(-1).push(
        svgRect(x, 3, swatch, swatch, {fill: seriesColour(panel.series[i].colour)}),
        svgText(label, x + swatch + 5, 13, {'font-weight': 500}));
    x += wide;
  });
  for (const line of entries) {
    sheet.place(0, line);
    sheet.y += row;
  }
}

function addPanel(sheet, chart, panel, marked, number) {
  sheet.y += 8;
  sheet.paragraph(panel.title, {size: 14, weight: 600});
  if (!isLying(panel)) sheet.paragraph(panel.y_label, {size: kTextSize, colour: '--muted'});
  sheet.place(0, [chartSvg(chart, panel, marked, `plot${number}`)]);
  sheet.y += chart.height;
  addLegend(sheet, chart, panel);
}

function photographSvg({label, readings}) {
  const display = displayOf(readings);
  const [, , wide, high] = display.getAttribute('viewBox').split(' ').map(Number);
  const width = kPhotographWidth - 18, height = width * high / wide;
  const place = {x: 9, y: 9, width, height: shortNumber(height), fill: '#ff5340'};
  for (const [name, value] of Object.entries(place)) display.setAttribute(name, value);
  const texts = [
    svgText(label, 0, height + 34, {'font-size': 13}),
    ...wrappedText(readingsText(readings), 11, 400, kPhotographWidth).map((line, i) => svgText(
        line, 0, height + 49 + 14 * i, {'font-size': 11, fill: themeColour('--muted')})),
  ];
  const frame = svgRect(2.5, 2.5, kPhotographWidth - 5, height + 13, {
    rx: 5, fill: '#0b0d10', stroke: '#24282e', 'stroke-width': 5,
  });
  return {parts: [frame, display, ...texts], height: height + 24 + 14 * texts.length};
}

function addPhotographs(sheet, row) {
  sheet.y += 8;
  sheet.paragraph(row.label, {size: 14, weight: 600});
  const step = kPhotographWidth + kPhotographGap;
  const columns = Math.max(1, Math.floor((sheet.inner + kPhotographGap) / step));
  for (let i = 0; i < row.photographs.length; i += columns) {
    const pictures = row.photographs.slice(i, i + columns).map(photographSvg);
    pictures.forEach(({parts}, column) => sheet.place(column * step, parts));
    sheet.y += Math.max(...pictures.map(({height}) => height)) + kPhotographGap;
  }
}

function scopeText({pipeline, seed, paper}) {
  return [pipeline, seed == null ? '' : `seed ${seed}`, paper ? `after ${paper} of the paper` : '']
      .filter(Boolean).join(', ');
}

// `view`: a FigureView, which is drawn if it is not yet; uPlot lays out a little later.
async function figureSvg(view) {
  view.draw();
  await Promise.resolve();
  const {shown, charts} = view;
  const sheet = new SvgSheet(charts[0]?.width ?? view.body.clientWidth, shown.title, shown.caption);
  sheet.paragraph(shown.title, {size: 16, weight: 700});
  sheet.paragraph(scopeText(shown), {size: kTextSize, colour: '--muted'});
  sheet.paragraph(shown.absent, {size: 13, colour: '--muted'});
  shown.panels.forEach((panel, i) => addPanel(sheet, charts[i], panel, view.page.marked(), i));
  for (const row of shown.photographs) addPhotographs(sheet, row);
  return sheet.finished();
}
