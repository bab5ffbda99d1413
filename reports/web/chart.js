// One panel of a figure as a uPlot chart: its axes, marks, lines across and shaded spans.
//
// Colours are read from the style sheet at every drawing, so that a change of theme, or printing,
// needs nothing but a redraw.

const kFont = '12px system-ui, sans-serif';
const kBarShare = 0.8;  // of the room of a category
const kRowHeight = 18;  // of a bar that lies

function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function seriesColour(number) {
  const palette = themeColour('--series').split(/\s+/);
  if (number < palette.length) return palette[number];
  return `hsl(${(number * 137.5) % 360} 55% ${themeColour('--series-lightness')})`;
}

function textWidth(text) {
  textWidth.context ??= document.createElement('canvas').getContext('2d');
  textWidth.context.font = kFont;
  return textWidth.context.measureText(text).width;
}

function numberText(value) {
  if (value == null || Number.isNaN(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e7 || size < 1e-4)) return value.toExponential(2);
  return String(+value.toPrecision(6));
}

function shortened(text, width) {
  if (textWidth(text) <= width) return text;
  let kept = text.length;
  while (kept > 1 && textWidth(text.slice(0, kept) + '…') > width) --kept;
  return text.slice(0, kept) + '…';
}

const barSeries = (panel) => panel.series.filter(({mark}) => mark === 'bars');

// Names are read lying: then the categories stand on the left.
function isLying(panel) {
  return panel.categories.some((name) => Number.isNaN(Number.parseFloat(name)));
}

function chartHeight(panel, width) {
  if (!isLying(panel)) return width < 500 ? 240 : 300;
  const rows = Math.max(1.5, barSeries(panel).length);
  return 70 + Math.max(4, panel.categories.length * rows) * kRowHeight;
}

// From the smallest to the largest of the data and of the lines across.
function extent(values, lines) {
  const all = [...values, ...lines.map(({at}) => at)].filter((value) => value != null);
  let low = Math.min(...all), high = Math.max(...all);
  if (!(low <= high)) [low, high] = [0, 1];
  if (low === high) [low, high] = [low - 0.5, high + 0.5];
  return [low, high];
}

// Zoomed in, exactly what was asked for; else everything, with a little room for points.
function xRange(panel) {
  return (chart, min, max) => {
    if (panel.categories.length) return [-0.5, panel.categories.length - 0.5];
    const x = chart.data[0];
    if (min !== x[0] || max !== x[x.length - 1]) {
      if (min != null && max > min) return [min, max];
    }
    const ends = x.length ? [x[0], x[x.length - 1]] : [];
    const [low, high] = extent(ends, panel.lines.filter(({vertical}) => vertical));
    const room = (high - low) * 0.015;
    return [low - room, high + room];
  };
}

function isZoomed(chart) {
  const x = chart.data[0];
  return x.length > 0 && (chart.scales.x.min > x[0] || chart.scales.x.max < x[x.length - 1]);
}

function yRange(panel) {
  return (chart, min, max) => {
    const lines = isZoomed(chart) ? [] : panel.lines.filter(({vertical}) => !vertical);
    const floor = barSeries(panel).length && !panel.log_y ? [0] : [];
    const [low, high] = extent([min, max, ...floor], lines);
    if (panel.log_y) return uPlot.rangeLog(Math.max(low, 1e-12), Math.max(high, 1e-12), 10, false);
    return uPlot.rangeNum(low, high, 0.08, low >= 0);
  };
}

// Bars of several series stand side by side.
function barPaths(panel, place, count) {
  const width = kBarShare / count;
  const x0 = (chart) => chart.data[0].map((x) => x - kBarShare / 2 + place * width);
  return uPlot.paths.bars(
      {disp: {x0: {unit: 1, values: x0}, size: {unit: 1, values: () => [width * 0.94]}}});
}

function markOptions(panel, series, colour, points) {
  if (series.mark === 'bars') {
    const bars = barSeries(panel);
    const paths = barPaths(panel, bars.indexOf(series), bars.length);
    return {paths, fill: colour, width: 0, points: {show: false}};
  }
  if (series.mark === 'points') {
    const size = points > 3000 ? 3 : 5;
    return {paths: () => null, points: {show: true, size, width: 0, fill: colour}};
  }
  const paths = series.mark === 'steps' ? uPlot.paths.stepped({align: 1}) : uPlot.paths.linear();
  return {paths, width: 1.5, points: {size: 4, fill: colour}};
}

function seriesOptions(panel, points) {
  return panel.series.map((series) => {
    const colour = () => seriesColour(series.colour);
    return {
      label: series.label || panel.y_label,
      stroke: colour,
      value: (_, value) => numberText(value),
      ...markOptions(panel, series, colour, points),
    };
  });
}

const kAxisLook = {
  font: kFont,
  labelFont: kFont,
  labelSize: 18,
  labelGap: 0,
  gap: 4,
  stroke: () => themeColour('--muted'),
  grid: {stroke: () => themeColour('--grid'), width: 1},
  ticks: {stroke: () => themeColour('--grid'), width: 1, size: 4},
};

const tickTexts = (_, splits) => splits.map((value) => value == null ? '' : numberText(value));

function widestText(texts) {
  return Math.max(20, ...(texts ?? []).map((text) => textWidth(String(text))));
}

function categoryAxis(panel) {
  const widest = (chart) => isLying(panel) ? chart.width * 0.42 : Infinity;
  return {
    ...kAxisLook,
    side: isLying(panel) ? 3 : 2,
    splits: () => panel.categories.map((_, i) => i),
    values: (chart) => panel.categories.map((name) => shortened(name, widest(chart))),
    size: (_, values) => isLying(panel) ? widestText(values) + 12 : 26,
    grid: {show: false},
  };
}

function xAxis(panel) {
  if (panel.categories.length) return categoryAxis(panel);
  const whole = [1, 2, 5].flatMap((digit) => [1, 10, 100, 1e3, 1e4, 1e5, 1e6].map((p) => digit * p));
  return {
    ...kAxisLook,
    label: panel.x_label,
    size: 26,
    values: tickTexts,
    ...(panel.x_is_pulse ? {incrs: whole.sort((a, b) => a - b)} : {}),
  };
}

function yAxis(panel) {
  const lying = isLying(panel);
  return {
    ...kAxisLook,
    label: panel.y_label,
    side: lying ? 2 : 3,
    values: tickTexts,
    space: lying ? 60 : 36,
    // A second answer would only start another round of the layout.
    size: (chart, values, axis, round) =>
        lying ? 26 : round > 1 ? chart.axes[axis]._size : widestText(values) + 12,
  };
}

// The nearest point of each series: series of other x have none at the cursor's own place.
function nearestIndex(chart, series, index) {
  const y = chart.data[series];
  if (series === 0 || y[index] != null) return index;
  const x = chart.data[0];
  let left = index, right = index;
  while (left >= 0 && y[left] == null) --left;
  while (right < y.length && y[right] == null) ++right;
  if (left < 0) return right < y.length ? right : index;
  if (right >= y.length) return left;
  return x[index] - x[left] <= x[right] - x[index] ? left : right;
}

function drawSpans(chart, panel) {
  const {ctx, bbox} = chart;
  ctx.save();
  ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
  for (const span of panel.spans) {
    const from = Math.max(bbox.left, chart.valToPos(span.from, 'x', true));
    const to = Math.min(bbox.left + bbox.width, chart.valToPos(span.to, 'x', true));
    if (!(to > from)) continue;
    ctx.fillStyle = themeColour('--span');
    ctx.fillRect(from, bbox.top, to - from, bbox.height);
    ctx.fillStyle = themeColour('--muted');
    if (ctx.measureText(span.label).width < to - from) {
      ctx.fillText(span.label, from + 4, bbox.top + bbox.height - 6);
    }
  }
  ctx.restore();
}

// A line at a value of a scale, from edge to edge. Returns where it is, nothing if out of sight.
function drawAcross(chart, scale, at, colour, dash) {
  const {ctx, bbox} = chart;
  const {min, max, ori} = chart.scales[scale];
  if (!(at >= min && at <= max)) return null;
  const place = Math.round(chart.valToPos(at, scale, true));
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.5 * uPlot.pxRatio;
  ctx.setLineDash(dash.map((length) => length * uPlot.pxRatio));
  ctx.beginPath();
  ctx.moveTo(ori === 0 ? place : bbox.left, ori === 0 ? bbox.top : place);
  ctx.lineTo(ori === 0 ? place : bbox.left + bbox.width, ori === 0 ? bbox.top + bbox.height : place);
  ctx.stroke();
  return {place, upright: ori === 0};
}

// Text with the paper's colour around it, kept inside the chart.
function drawNote(chart, text, x, y) {
  const {ctx, bbox} = chart;
  const width = ctx.measureText(text).width;
  const left = Math.max(bbox.left + 2, Math.min(x, bbox.left + bbox.width - width - 4));
  ctx.setLineDash([]);
  ctx.lineWidth = 3 * uPlot.pxRatio;
  ctx.strokeStyle = themeColour('--paper');
  ctx.strokeText(text, left, y);
  ctx.fillStyle = themeColour('--text');
  ctx.fillText(text, left, y);
}

// Labels step down (beside upright lines) or aside (on level ones) where they would meet.
function drawLines(chart, panel) {
  const {ctx, bbox} = chart;
  const row = 14 * uPlot.pxRatio;
  let upright = 0, lowest = Infinity;
  const lines = [...panel.lines].sort((a, b) => a.at - b.at);
  for (const line of lines) {
    const drawn = drawAcross(
        chart, line.vertical ? 'x' : 'y', line.at, themeColour('--line'), [6, 4]);
    if (!drawn) continue;
    if (drawn.upright) {
      drawNote(chart, line.label, drawn.place + 5, bbox.top + row * ++upright);
    } else {
      lowest = Math.max(bbox.top + row, Math.min(drawn.place - 4, lowest - row));
      drawNote(chart, line.label, bbox.left + bbox.width, lowest);
    }
  }
}

function drawAbove(chart, panel, marked) {
  const {ctx} = chart;
  ctx.save();
  ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
  drawLines(chart, panel);
  if (panel.x_is_pulse && marked != null) {
    drawAcross(chart, 'x', marked, themeColour('--accent'), []);
  }
  ctx.restore();
}

// uPlot's legend switches series on a click; so do Enter and the space bar here.
function makeLegendReachable(chart) {
  for (const head of chart.root.querySelectorAll('.u-legend .u-series:not(:first-child) th')) {
    head.tabIndex = 0;
    head.setAttribute('role', 'button');
    head.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      head.click();
    });
  }
}

// `marked()`: the pulse to mark, or null.
function makeChart(host, panel, columns, marked) {
  const data = alignedData(panel, columns);
  const points = data[0].length * (data.length - 1);
  const lying = isLying(panel);
  const name = (value) => panel.categories[value] ?? numberText(value);
  const options = {
    width: host.clientWidth,
    height: chartHeight(panel, host.clientWidth),
    padding: [8, 14, 0, 0],
    scales: {
      x: {time: false, range: xRange(panel), ...(lying ? {ori: 1, dir: -1} : {})},
      y: {range: yRange(panel), distr: panel.log_y ? 3 : 1, ...(lying ? {ori: 0} : {})},
    },
    axes: [xAxis(panel), yAxis(panel)],
    series: [
      {label: panel.x_label || 'of', value: (_, value) => value == null ? '–' : name(value)},
      ...seriesOptions(panel, points),
    ],
    cursor: {
      dataIdx: nearestIndex,
      drag: {x: !panel.categories.length, y: false},
      points: {size: 7},
    },
    hooks: {
      drawAxes: [(chart) => drawSpans(chart, panel)],
      draw: [(chart) => drawAbove(chart, panel, marked())],
      ready: [makeLegendReachable],
    },
  };
  return new uPlot(options, data, host);
}

function resetZoom(chart) {
  chart.setData(chart.data);
}

// `factor` below 1 shows less; `shift` moves by a share of what is shown.
function zoomBy(chart, factor, shift = 0) {
  const {min, max} = chart.scales.x;
  const middle = (min + max) / 2 + shift * (max - min);
  const half = (max - min) * factor / 2;
  chart.setScale('x', {min: middle - half, max: middle + half});
}
