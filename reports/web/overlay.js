// Draws over and under the series of a chart: shaded spans, lines across with their labels, the marked
// pulse.

// The spans in sight, in pixels of the canvas, with the labels that fit.
function placedSpans(chart, panel) {
  const {ctx, bbox} = chart;
  return panel.spans.map((span) => {
    const from = Math.max(bbox.left, chart.valToPos(span.from, 'x', true));
    const to = Math.min(bbox.left + bbox.width, chart.valToPos(span.to, 'x', true));
    return {from, to, label: ctx.measureText(span.label).width < to - from ? span.label : ''};
  }).filter(({from, to}) => to > from);
}

function drawSpans(chart, panel) {
  const {ctx, bbox} = chart;
  for (const {from, to, label} of placedSpans(chart, panel)) {
    ctx.fillStyle = themeColour('--span');
    ctx.fillRect(from, bbox.top, to - from, bbox.height);
    ctx.fillRect(from, bbox.top, uPlot.pxRatio, bbox.height);
    ctx.fillRect(to, bbox.top, uPlot.pxRatio, bbox.height);
    ctx.fillStyle = themeColour('--muted');
    ctx.fillText(label, from + 4, bbox.top + bbox.height - 6);
  }
}

function drawNotes(chart, draw) {
  const {ctx} = chart;
  ctx.save();
  ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  draw();
  ctx.restore();
}

// Where a line at a value of a scale is, nothing if out of sight.
function placeAcross(chart, scale, at) {
  const {min, max, ori} = chart.scales[scale];
  if (!(at >= min && at <= max)) return null;
  return {place: Math.round(chart.valToPos(at, scale, true)), upright: ori === 0};
}

// From edge to edge.
function strokeAcross(chart, {place, upright}, colour, dash) {
  const {ctx, bbox} = chart;
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.5 * uPlot.pxRatio;
  ctx.setLineDash(dash.map((length) => length * uPlot.pxRatio));
  ctx.beginPath();
  ctx.moveTo(upright ? place : bbox.left, upright ? bbox.top : place);
  ctx.lineTo(upright ? place : bbox.left + bbox.width, upright ? bbox.top + bbox.height : place);
  ctx.stroke();
}

// A line at a value of a scale. Returns where it is, nothing if out of sight.
function drawAcross(chart, scale, at, colour, dash) {
  const placed = placeAcross(chart, scale, at);
  if (placed) strokeAcross(chart, placed, colour, dash);
  return placed;
}

// Where a note that begins at x stands inside the chart.
function noteLeft(chart, text, x) {
  const {ctx, bbox} = chart;
  const width = ctx.measureText(text).width;
  return Math.max(bbox.left + 2, Math.min(x, bbox.left + bbox.width - width - 4));
}

// Text with the paper's colour around it, kept inside the chart.
function drawNote(chart, text, x, y) {
  const {ctx} = chart;
  const left = noteLeft(chart, text, x);
  ctx.setLineDash([]);
  ctx.lineWidth = 3 * uPlot.pxRatio;
  ctx.strokeStyle = themeColour('--paper');
  ctx.strokeText(text, left, y);
  ctx.fillStyle = themeColour('--text');
  ctx.fillText(text, left, y);
}

// The lines in sight, in pixels of the canvas. Labels step down (beside upright lines) or up (on
// level ones) where they would meet.
function placedLines(chart, panel) {
  const {bbox} = chart;
  const row = 14 * uPlot.pxRatio;
  const lines = [...panel.lines].sort((a, b) => a.at - b.at).map((line) => ({
    label: line.label,
    colour: line.colour < 0 ? themeColour('--line') : seriesColour(line.colour),
    ...placeAcross(chart, line.vertical ? 'x' : 'y', line.at),
  })).filter(({place}) => place != null);
  let upright = 0, highest = Infinity;
  for (const line of lines) {
    if (line.upright) {
      line.left = noteLeft(chart, line.label, line.place + 5);
      line.bottom = bbox.top + row * ++upright;
    } else {
      highest = Math.max(bbox.top + row, Math.min(line.place - 4, highest - row));
      line.left = noteLeft(chart, line.label, bbox.left + bbox.width);
      line.bottom = highest;
    }
  }
  return lines;
}

// Labels stand over all lines.
function drawLines(chart, panel) {
  const lines = placedLines(chart, panel);
  for (const line of lines) strokeAcross(chart, line, line.colour, [6, 4]);
  for (const {label, left, bottom} of lines) drawNote(chart, label, left, bottom);
}

function drawAbove(chart, panel, marked) {
  drawLines(chart, panel);
  if (panel.x_is_pulse && marked != null) {
    drawAcross(chart, 'x', marked, themeColour('--accent'), []);
  }
}
