// A chart as vectors: the SVG of what uPlot and overlay.js have on the canvas, at the chart's zoom
// and without the series that are switched off.
//
// Axes are where uPlot laid them out: its _splits, _values, _pos and _lpos.

const kTextSize = 12, kNoteSize = 11, kOnEdge = 2;

const shortNumber = (value) => String(+value.toFixed(2));
// From pixels of the canvas to those of the page.
const onPage = (pixels) => pixels / uPlot.pxRatio;

function svgText(text, x, y, attributes = {}) {
  const made = svgElement('text', {
    x: shortNumber(x), y: shortNumber(y), 'font-size': kTextSize, fill: themeColour('--text'), ...attributes,
  });
  made.textContent = text;
  return made;
}

function svgLine(x1, y1, x2, y2, attributes) {
  const [a, b, c, d] = [x1, y1, x2, y2].map(shortNumber);
  return svgElement('path', {d: `M${a} ${b}L${c} ${d}`, fill: 'none', ...attributes});
}

function svgRect(x, y, width, height, attributes) {
  return svgElement('rect', {
    x: shortNumber(x), y: shortNumber(y), width: shortNumber(width), height: shortNumber(height),
    ...attributes,
  });
}

// The rectangle of the plot on the page.
function plotBox({bbox}) {
  const [left, top, width, height] = [bbox.left, bbox.top, bbox.width, bbox.height].map(onPage);
  return {left, top, width, height, right: left + width, bottom: top + height};
}

// Where the values of an axis stand along it.
const alongAxis = (chart, axis) => axis._splits.map((at) => onPage(chart.valToPos(at, axis.scale, true)));

function axisTexts(chart, axis, along) {
  const {side, gap, ticks, _pos: base} = axis;
  const muted = {fill: themeColour('--muted')};
  const texts = axis._values.map((text, i) => text == null || text === '' ? null :
      side === 2 ? svgText(text, along[i], base + ticks.size + gap + 10, {...muted, 'text-anchor': 'middle'}) :
                   svgText(text, base - ticks.size - gap, along[i] + 4, {...muted, 'text-anchor': 'end'}));
  if (axis.label != null) {
    const {left, width} = plotBox(chart);
    texts.push(svgText(axis.label, left + width / 2, axis._lpos + 10, {...muted, 'text-anchor': 'middle'}));
  }
  return texts.filter(Boolean);
}

function svgAxis(chart, axis) {
  const group = svgElement('g', {class: 'axis'});
  const {left, top, right, bottom} = plotBox(chart);
  const along = alongAxis(chart, axis);
  const look = {stroke: themeColour('--grid'), 'stroke-width': 1};
  along.forEach((at, i) => {
    if (axis._splits[i] == null) return;
    const level = axis.side === 3;
    const end = axis._pos + axis.ticks.size * (level ? -1 : 1);
    const line = (from, to) => level ? svgLine(from, at, to, at, look) : svgLine(at, from, at, to, look);
    if (axis.grid.show) group.append(level ? line(left, right) : line(top, bottom));
    group.append(line(axis._pos, end));
  });
  group.append(...axisTexts(chart, axis, along));
  return group;
}

// The points of a series on the page; null for a gap.
function placedPoints(chart, number) {
  const [x, y] = [chart.data[0], chart.data[number]];
  const lying = chart.scales.x.ori === 1;
  const points = [];
  for (let i = 0; i < x.length; ++i) {
    if (y[i] === undefined) continue;
    if (y[i] === null) {
      points.push(null);
      continue;
    }
    const across = onPage(chart.valToPos(x[i], 'x', true)), up = onPage(chart.valToPos(y[i], 'y', true));
    points.push(lying ? {x: up, y: across} : {x: across, y: up});
  }
  return points;
}

function linePath(points, isStepped) {
  let path = '', last = null;
  for (const point of points) {
    if (point) {
      const [x, y] = [shortNumber(point.x), shortNumber(point.y)];
      path += !last ? `M${x} ${y}` : isStepped ? `H${x}V${y}` : `L${x} ${y}`;
    }
    last = point;
  }
  return path;
}

// Round dots are the ends of lines without length.
function dotPath(points) {
  return points.map(({x, y}) => `M${shortNumber(x)} ${shortNumber(y)}h0`).join('');
}

function svgDots(points, size, colour) {
  return svgElement('path', {
    class: 'points', d: dotPath(points), fill: 'none', stroke: colour, 'stroke-width': size,
    'stroke-linecap': 'round',
  });
}

function svgBars(chart, panel, series, number, colour) {
  const bars = barSeries(panel);
  const width = kBarShare / bars.length, first = bars.indexOf(series) * width - kBarShare / 2;
  const lying = chart.scales.x.ori === 1;
  const foot = onPage(chart.valToPos(panel.log_y ? chart.scales.y.min : 0, 'y', true));
  const group = svgElement('g', {class: 'bars', fill: colour});
  chart.data[0].forEach((x, i) => {
    const y = chart.data[number][i];
    if (y == null) return;
    const [from, to] = [x + first, x + first + width * 0.94].map(
        (at) => onPage(chart.valToPos(at, 'x', true)));
    const end = onPage(chart.valToPos(y, 'y', true));
    const along = [Math.min(from, to), Math.abs(to - from)], up = [Math.min(foot, end), Math.abs(end - foot)];
    group.append(lying ? svgRect(up[0], along[0], up[1], along[1]) :
                         svgRect(along[0], up[0], along[1], up[1]));
  });
  return group;
}

// uPlot has dots on a line where there is room, and where a point stands alone between gaps.
function dotsOfLine(chart, number, points) {
  if (chart.series[number].points.show(chart, number)) return points.filter(Boolean);
  return points.filter((point, i) => point && !points[i - 1] && !points[i + 1]);
}

function svgSeries(chart, panel, series, number) {
  const colour = seriesColour(series.colour);
  const group = svgElement('g', {class: 'series'});
  const title = svgElement('title', {});
  title.textContent = series.label || panel.y_label;
  group.append(title);
  if (series.mark === 'bars') {
    group.append(svgBars(chart, panel, series, number, colour));
    return group;
  }
  const points = placedPoints(chart, number);
  const {size} = chart.series[number].points;
  if (series.mark === 'points') {
    group.append(svgDots(points.filter(Boolean), size, colour));
    return group;
  }
  group.append(svgElement('path', {
    d: linePath(points, series.mark === 'steps'), fill: 'none', stroke: colour, 'stroke-width': 1.5,
    'stroke-linejoin': 'round',
  }));
  group.append(svgDots(dotsOfLine(chart, number, points), size, colour));
  return group;
}

function svgSpans(chart, panel) {
  const {top, height, bottom} = plotBox(chart);
  return placedSpans(chart, panel).flatMap(({from, to, label}) => {
    const [left, right] = [onPage(from), onPage(to)];
    const fill = {fill: themeColour('--span')};
    const note = {'font-size': kNoteSize, fill: themeColour('--muted')};
    return [
      svgRect(left, top, right - left, height, fill), svgRect(left, top, 1, height, fill),
      svgRect(right, top, 1, height, fill),
      ...label ? [svgText(label, left + 4, bottom - 6, note)] : [],
    ];
  });
}

function svgAcross(chart, {place, upright}, colour, dash) {
  const {left, top, right, bottom} = plotBox(chart), at = onPage(place);
  const look = {stroke: colour, 'stroke-width': 1.5, ...(dash ? {'stroke-dasharray': dash} : {})};
  return upright ? svgLine(at, top, at, bottom, look) : svgLine(left, at, right, at, look);
}

function svgAbove(chart, panel, marked) {
  const lines = placedLines(chart, panel);
  const pulse = panel.x_is_pulse && marked != null ? placeAcross(chart, 'x', marked) : null;
  return [
    ...lines.map((line) => svgAcross(chart, line, line.colour, '6 4')),
    ...lines.map(({label, left, bottom}) => svgText(label, onPage(left), onPage(bottom), {
      'font-size': kNoteSize, stroke: themeColour('--paper'), 'stroke-width': 3, 'paint-order': 'stroke',
    })),
    ...pulse ? [svgAcross(chart, pulse, themeColour('--accent'))] : [],
  ];
}

// The chart without its legend. `id`: of its clip, distinct within the file.
function chartSvg(chart, panel, marked, id) {
  const group = svgElement('g', {class: 'panel'});
  const {left, top, width, height} = plotBox(chart);
  const clip = svgElement('clipPath', {id});
  // As on the canvas, half of what lies on the edge is beyond it.
  clip.append(svgRect(left - kOnEdge, top - kOnEdge, width + 2 * kOnEdge, height + 2 * kOnEdge));
  const inside = svgElement('g', {'clip-path': `url(#${id})`});
  inside.append(...panel.series.flatMap(
      (series, i) => chart.series[i + 1].show ? [svgSeries(chart, panel, series, i + 1)] : []));
  group.append(clip);
  // Notes are measured in the font that they are drawn in.
  drawNotes(chart, () => group.append(
      ...svgSpans(chart, panel),
      ...chart.axes.filter(({_splits}) => _splits).map((axis) => svgAxis(chart, axis)), inside,
      ...svgAbove(chart, panel, marked)));
  return group;
}
