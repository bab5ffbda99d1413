// Draws over and under the series of a chart: shaded spans, lines across with their labels, the marked
// pulse.

function drawSpans(chart, panel) {
  const {ctx, bbox} = chart;
  for (const span of panel.spans) {
    const from = Math.max(bbox.left, chart.valToPos(span.from, 'x', true));
    const to = Math.min(bbox.left + bbox.width, chart.valToPos(span.to, 'x', true));
    if (!(to > from)) continue;
    ctx.fillStyle = themeColour('--span');
    ctx.fillRect(from, bbox.top, to - from, bbox.height);
    ctx.fillRect(from, bbox.top, uPlot.pxRatio, bbox.height);
    ctx.fillRect(to, bbox.top, uPlot.pxRatio, bbox.height);
    ctx.fillStyle = themeColour('--muted');
    if (ctx.measureText(span.label).width < to - from) {
      ctx.fillText(span.label, from + 4, bbox.top + bbox.height - 6);
    }
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

// Labels, over all lines, step down (beside upright lines) or up (on level ones) where they would
// meet.
function drawLines(chart, panel) {
  const {bbox} = chart;
  const row = 14 * uPlot.pxRatio;
  const lines = [...panel.lines].sort((a, b) => a.at - b.at).map((line) => ({
    ...line,
    ...drawAcross(chart, line.vertical ? 'x' : 'y', line.at,
        line.colour < 0 ? themeColour('--line') : seriesColour(line.colour), [6, 4]),
  }));
  let upright = 0, highest = Infinity;
  for (const line of lines.filter(({place}) => place != null)) {
    if (line.upright) {
      drawNote(chart, line.label, line.place + 5, bbox.top + row * ++upright);
    } else {
      highest = Math.max(bbox.top + row, Math.min(line.place - 4, highest - row));
      drawNote(chart, line.label, bbox.left + bbox.width, highest);
    }
  }
}

function drawAbove(chart, panel, marked) {
  drawLines(chart, panel);
  if (panel.x_is_pulse && marked != null) {
    drawAcross(chart, 'x', marked, themeColour('--accent'), []);
  }
}
