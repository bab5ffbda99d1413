// One panel of a figure as a uPlot chart: its marks, its legend, its zoom.

const kBarShare = 0.8;  // of the room of a category

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

// Series of one label and colour are one thing to the reader: they share an entry of the legend,
// which has no value.
function alike(panel, {label, colour}) {
  return panel.series.filter((other) => other.label === label && other.colour === colour);
}

const isAlone = (panel, series) => alike(panel, series).length === 1;

function seriesOptions(panel, points) {
  return panel.series.map((series) => {
    const colour = () => seriesColour(series.colour);
    return {
      label: series.label || panel.y_label,
      stroke: colour,
      value: (_, value) => isAlone(panel, series) ? numberText(value) : '',
      ...markOptions(panel, series, colour, points),
    };
  });
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

function hideRepeatedEntries(chart) {
  const rows = chart.root.querySelectorAll('.u-legend .u-series');
  chart.groups.forEach((first, series) => rows[series + 1].hidden = first !== series);
}

// A switched series takes along those that share its entry.
function showAlike(chart, number, show) {
  if (number == null || show == null) return;
  chart.groups.forEach((first, series) => {
    if (first === number - 1 && chart.series[series + 1].show !== show) {
      chart.setSeries(series + 1, {show});
    }
  });
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

// uPlot colours the entries once; themes and paper have colours of their own.
function colourEntries(chart, panel) {
  const rows = chart.root.querySelectorAll('.u-legend .u-series');
  panel.series.forEach(({colour, mark}, i) => {
    const marker = rows[i + 1].querySelector('.u-marker');
    marker.style.borderColor = seriesColour(colour);
    if (mark === 'bars') marker.style.background = seriesColour(colour);
  });
}

// Lines across are in sight unless the reader has zoomed. uPlot forgets what is asked of it here.
function followZoom(chart, scale) {
  if (scale !== 'x' || isZoomed(chart) === chart.yIsOfZoom) return;
  const {min, max} = chart.scales.x;
  queueMicrotask(() => chart.setScale('x', {min, max}));
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
      x: {time: false, range: xRange(panel), distr: panel.log_x ? 3 : 1, ...(lying ? {ori: 1, dir: -1} : {})},
      y: {range: yRange(panel), distr: panel.log_y ? 3 : 1, ...(lying ? {ori: 0} : {})},
    },
    axes: [xAxis(panel, data), yAxis(panel, data)],
    series: [
      {label: panel.x_label || 'name', value: (_, value) => value == null ? '–' : name(value)},
      ...seriesOptions(panel, points),
    ],
    cursor: {
      dataIdx: nearestIndex,
      drag: {x: !panel.categories.length, y: false},
      points: {size: 7},
    },
    hooks: {
      init: [(chart) => chart.groups = panel.series.map(
                 (series) => panel.series.indexOf(alike(panel, series)[0]))],
      drawAxes: [(chart) => drawNotes(chart, () => drawSpans(chart, panel))],
      draw: [
        (chart) => drawNotes(chart, () => drawAbove(chart, panel, marked())),
        (chart) => colourEntries(chart, panel),
      ],
      setScale: [followZoom],
      setSeries: [(chart, number, {show}) => showAlike(chart, number, show)],
      ready: [makeLegendReachable, hideRepeatedEntries],
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
