// Axes of a chart: their ranges, steps and texts, and the texts and colours of all charts.
//
// Colours are read from the style sheet at every drawing, so that a change of theme, or printing,
// needs nothing but a redraw.

const kFont = '12px system-ui, sans-serif';
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
  if (size !== 0 && (size >= 1e9 || size < 1e-4)) return value.toExponential(3);
  return String(+value.toPrecision(8));
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

// The zoomed range exactly; else the whole range, with a margin for points.
function xRange(panel) {
  return (chart, min, max) => {
    if (panel.categories.length) return [-0.5, panel.categories.length - 0.5];
    const x = chart.data[0];
    if (min !== x[0] || max !== x[x.length - 1]) {
      if (min != null && max > min) return [min, max];
    }
    const ends = x.length ? [x[0], x[x.length - 1]] : [];
    const [low, high] = extent(ends, panel.lines.filter(({vertical}) => vertical));
    if (panel.log_x) return [low / 1.3, high * 1.3];
    const room = (high - low) * 0.015;
    return [low - room, high + room];
  };
}

function isZoomed(chart) {
  const x = chart.data[0], {min, max} = chart.scales.x;
  return x.length > 0 && min != null && (min > x[0] || max < x[x.length - 1]);
}

// uPlot asks for it before the new range of x holds: followZoom() of chart.js asks again.
function yRange(panel) {
  return (chart, min, max) => {
    chart.yIsOfZoom = isZoomed(chart);
    const lines = chart.yIsOfZoom ? [] : panel.lines.filter(({vertical}) => !vertical);
    const floor = barSeries(panel).length && !panel.log_y ? [0] : [];
    const [low, high] = extent([min, max, ...floor], lines);
    if (panel.log_y) return uPlot.rangeLog(Math.max(low, 1e-12), Math.max(high, 1e-12), 10, false);
    return uPlot.rangeNum(low, high, 0.08, low >= 0);
  };
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

// Enough decimals to distinguish the steps.
function tickTexts(chart, splits, axis, space, step) {
  const decimals = Math.min(12, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9) + 1));
  const text = (value) => Math.abs(value) >= 1e7 || (value !== 0 && Math.abs(value) < 1e-4) ?
      value.toExponential() : String(+value.toFixed(decimals));
  return splits.map((value) => value == null ? '' : text(+value.toPrecision(12)));
}

// Of a logarithmic axis.
function powerTexts(_, splits) {
  return splits.map((value) => value == null ? '' : numberText(value));
}

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

// Where all values are whole, so are the steps of the axis.
function steps(values) {
  if (!values.every((value) => value == null || Number.isInteger(value))) return {};
  const powers = Array.from({length: 12}, (_, power) => 10 ** power);
  return {incrs: powers.flatMap((power) => [power, 2 * power, 5 * power])};
}

function xAxis(panel, data) {
  if (panel.categories.length) return categoryAxis(panel);
  if (panel.log_x) return {...kAxisLook, label: panel.x_label, size: 26, values: powerTexts};
  return {...kAxisLook, label: panel.x_label, size: 26, values: tickTexts, ...steps(data[0])};
}

// Its label, which may be long, stands above the chart.
function yAxis(panel, data) {
  const lying = isLying(panel);
  return {
    ...kAxisLook,
    ...(lying ? {side: 2, label: panel.y_label} : {side: 3}),
    values: panel.log_y ? powerTexts : tickTexts,
    space: lying ? 60 : 36,
    ...(panel.log_y ? {} : steps(data.slice(1).flat())),
    // A second answer would only start another round of the layout.
    size: (chart, values, axis, round) =>
        lying ? 26 : round > 1 ? chart.axes[axis]._size : widestText(values) + 12,
  };
}
