// The first figure of a report as SVG. It is HTML without a script (reports/page/overview.h), so what
// is drawn is where the browser has put it.

// In the coordinates of the picture: from the corner of the figure.
function boxIn(figure, element) {
  const outer = figure.getBoundingClientRect(), box = element.getBoundingClientRect();
  return {x: box.x - outer.x, y: box.y - outer.y, width: box.width, height: box.height};
}

// Every line of every text of the table.
function overviewTexts(figure, table) {
  const texts = [];
  const walker = document.createTreeWalker(table.tBodies[0], NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const {data, parentElement} = walker.currentNode;
    if (!data.trim() || !parentElement.checkVisibility()) continue;
    const range = document.createRange();
    range.selectNodeContents(walker.currentNode);
    const {x, y, height} = boxIn(figure, range);
    const look = getComputedStyle(parentElement);
    const size = Number.parseFloat(look.fontSize);
    texts.push(svgText(data.trim(), x, y + height - (height - size) / 2 - size * 0.15, {
      'font-size': shortNumber(size), 'font-weight': look.fontWeight, fill: look.color,
    }));
  }
  return texts;
}

function overviewMark(figure, mark) {
  const {x, y, width, height} = boxIn(figure, mark);
  const look = getComputedStyle(mark);
  const [cx, cy] = [x + width / 2, y + height / 2];
  const line = Number.parseFloat(look.borderTopWidth);
  const edge = line ? {stroke: look.borderTopColor, 'stroke-width': line} : {};
  if (mark.className === 'published') {
    // Its box is that of a square on its corner.
    const r = width / 2 - line * 0.7;
    return svgElement('path', {
      d: `M${shortNumber(cx)} ${shortNumber(cy - r)}l${r} ${r}l${-r} ${r}l${-r} ${-r}z`,
      fill: 'none', ...edge,
    });
  }
  const filled = {fill: look.backgroundColor, opacity: look.opacity, ...edge};
  if (mark.className === 'dot') {
    const centre = {cx: shortNumber(cx), cy: shortNumber(cy)};
    return svgElement('circle', {...centre, r: (width - line) / 2, ...filled});
  }
  return svgRect(x, y, width, height, {rx: 3, ...filled});
}

function trackLine(figure, track) {
  const {x, y, width, height} = boxIn(figure, track);
  return svgLine(x, y + height, x + width, y + height, {stroke: themeColour('--grid')});
}

function overviewSvg(figure) {
  const table = figure.querySelector('table');
  const caption = figure.querySelector('figcaption').textContent;
  const sheet = new SvgSheet(figure.clientWidth, table.caption.textContent, caption);
  sheet.paragraph(table.caption.textContent, {size: 16, weight: 700});
  const all = (selector) => Array.from(figure.querySelectorAll(selector));
  sheet.place(0, [
    ...all('tr:not(.axis) .track').map((track) => trackLine(figure, track)),
    ...all('.track i').map((mark) => overviewMark(figure, mark)),
    ...overviewTexts(figure, table),
  ]);
  sheet.y += boxIn(figure, table).y + table.clientHeight + 8;
  sheet.paragraph(caption, {size: kTextSize, colour: '--muted'});
  return sheet.finished();
}

function addOverviewFiles(figure) {
  const tools = element('div', 'figure-tools');
  tools.append(...fileButtons(figure.querySelector('caption').textContent, () => overviewSvg(figure),
                              (ending) => fileName([document.title, 'overview'], ending)));
  figure.querySelector('table').after(tools);
}
