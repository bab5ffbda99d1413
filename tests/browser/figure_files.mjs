// What is checked of the files of a figure: that they are what the page shows. Each of these throws
// when it is not so.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';

import {bringUp, figure} from './page_parts.mjs';

// Chromium drops the eleventh download within a second.
const kBetweenDownloadsMs = 120;

export const overview = (page) => page.locator('.archive:not([hidden]) .overview');

async function saved(page, root, ending) {
  const made = root.getByRole('button', {name: new RegExp(`^${ending.toUpperCase()} of `)});
  await page.waitForTimeout(kBetweenDownloadsMs);
  const [download] = await Promise.all([page.waitForEvent('download'), made.click()]);
  assert.match(download.suggestedFilename(), new RegExp(`^simbench_[\\w.-]+\\.${ending}$`));
  return readFileSync(await download.path());
}

// What an XML parser and a renderer see in an SVG.
const readSvg = (page, text) => page.evaluate((source) => {
  const parsed = new DOMParser().parseFromString(source, 'image/svg+xml');
  const broken = parsed.querySelector('parsererror')?.textContent ?? '';
  const root = parsed.documentElement;
  const shown = document.body.appendChild(document.importNode(root, true));
  const size = {width: Number(root.getAttribute('width')), height: Number(root.getAttribute('height'))};
  const corner = shown.getBoundingClientRect();
  const outside = Array.from(shown.querySelectorAll('text, path, rect, circle')).filter((one) => {
    if (one.closest('clipPath, [clip-path], svg svg')) return false;
    const {left, right, top, bottom} = one.getBoundingClientRect();
    return left < corner.left - 1 || right > corner.right + 1 || top < corner.top - 1 || bottom > corner.bottom + 1;
  }).map((one) => one.outerHTML.slice(0, 120));
  shown.remove();
  const all = (selector) => Array.from(parsed.querySelectorAll(selector));
  return {
    broken, size, outside,
    names: Array.from(new Set(all('*').map(({localName}) => localName))),
    texts: all('text').map(({textContent}) => textContent),
    series: all('g.series').map((group) => ({
      label: group.querySelector('title').textContent,
      marks: (group.querySelector('.points')?.getAttribute('d').match(/M/g) ?? []).length +
          group.querySelectorAll('.bars rect').length,
      line: group.querySelector('path:not(.points)')?.getAttribute('d') ?? '',
    })),
    marks: all('circle, path').length,
  };
}, text);

async function svgOf(page, root) {
  const svg = await readSvg(page, (await saved(page, root, 'svg')).toString());
  assert.equal(svg.broken, '');
  assert.ok(svg.size.width > 300 && svg.size.height > 100, JSON.stringify(svg.size));
  assert.deepEqual(svg.outside, [], 'beyond the sheet');
  // Vectors only, and nothing that is fetched.
  const known = ['svg', 'title', 'desc', 'rect', 'g', 'text', 'path', 'circle', 'clipPath'];
  assert.deepEqual(svg.names.filter((name) => !known.includes(name)), []);
  return svg;
}

// The texts of axes, titles and legends, and as many points as the chart has.
export async function svgMirrorsFigure(page, id) {
  const root = figure(page, id);
  await root.scrollIntoViewIfNeeded();
  await root.locator('canvas, svg').first().waitFor();
  const svg = await svgOf(page, root);
  const joined = svg.texts.join(' ');
  assert.ok(joined.includes(await root.locator('h4').innerText()), 'the title is missing');
  const shown = await root.locator('.chart').evaluateAll((charts) => charts.map(({uplot}) => ({
    texts: uplot.axes.flatMap(({label, _values}) => [label, ..._values]).filter(Boolean).map(String),
    legend: uplot.series.slice(1).filter((one, i) => one.show && uplot.groups[i] === i).map(({label}) => label),
    points: uplot.series.slice(1).map((one, i) => !one.show ? null : uplot.data[i + 1].filter((y) => y != null).length)
        .filter((count) => count != null),
  })));
  for (const {texts, legend} of shown) {
    for (const text of [...texts, ...legend]) assert.ok(joined.includes(text), `'${text}' is missing in ${id}`);
  }
  const points = shown.flatMap(({points: each}) => each);
  assert.equal(svg.series.length, points.length);
  svg.series.forEach(({label, marks, line}, i) => {
    const drawn = line ? (line.match(/[MLH]/g) ?? []).length : marks;
    assert.equal(drawn, points[i], `${label} of ${id}`);
  });
  if (shown.length === 0) assert.ok(svg.marks > 50, 'no segments');
}

// The vectors are where the pixels are: drawn as a picture, the plots of both agree.
export async function svgLooksLikeCanvas(page, id) {
  const host = await bringUp(page, id);
  const text = (await saved(page, figure(page, id), 'svg')).toString();
  const agreement = await host.evaluate(async ({uplot}, source) => {
    const picture = new Image();
    picture.src = URL.createObjectURL(new Blob([source], {type: 'image/svg+xml'}));
    await picture.decode();
    const place = new DOMParser().parseFromString(source, 'image/svg+xml').querySelector('.panel').parentNode
        .getAttribute('transform').match(/[\d.]+/g).map(Number);
    const paper = (drawing, x, y) => {
      const {width, height} = uplot;
      const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true});
      context.fillStyle = 'white';
      context.fillRect(0, 0, width, height);
      context.drawImage(drawing, -x, -y, drawing.naturalWidth ?? width, drawing.naturalHeight ?? height);
      const {left, top, width: wide, height: high} = uplot.over.getBoundingClientRect();
      const box = uplot.root.querySelector('.u-wrap').getBoundingClientRect();
      const edge = 4;
      return context.getImageData(left - box.left - edge, top - box.top - edge, wide + 2 * edge, high + 2 * edge);
    };
    const inked = ({data, width}) => {
      const found = new Set();
      // Coloured, that is: a series, not the grey of grid and text.
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = data.slice(i, i + 3);
        if (Math.max(r, g, b) - Math.min(r, g, b) > 60) found.add(i / 4);
      }
      return {found, width};
    };
    const canvas = inked(paper(uplot.root.querySelector('canvas'), 0, 0));
    const vector = inked(paper(picture, place[0], place[1]));
    // Each coloured pixel of one has one of the other beside it.
    const near = [-2, -1, 0, 1, 2];
    const isNear = ({found, width}, at) => near.some((dy) => near.some((dx) => found.has(at + dy * width + dx)));
    const met = (one, other) => Array.from(one.found).filter((at) => isNear(other, at)).length / one.found.size;
    return {pixels: canvas.found.size, there: met(canvas, vector), back: met(vector, canvas)};
  }, text);
  assert.ok(agreement.pixels > 100 && agreement.there > 0.98 && agreement.back > 0.98, JSON.stringify(agreement));
}

// A hidden series is in neither the plot nor the legend.
export async function svgLeavesOutHidden(page, id) {
  const host = await bringUp(page, id);
  const before = await svgOf(page, figure(page, id));
  const entry = host.locator('.u-legend .u-series').nth(1).locator('th');
  const label = (await entry.innerText()).trim();
  await entry.click();
  const after = await svgOf(page, figure(page, id));
  await entry.click();
  const entries = ({texts}) => texts.filter((text) => text === label).length;
  assert.ok(after.series.length < before.series.length);
  assert.equal(entries(after), entries(before) - 1);
}

export async function svgHasOverview(page) {
  const root = overview(page);
  const svg = await svgOf(page, root);
  const names = await root.locator('tbody th').allInnerTexts();
  const joined = svg.texts.join('').replace(/\s/g, '');
  for (const name of names) assert.ok(joined.includes(name.replace(/\s/g, '')), name);
  assert.ok(svg.marks >= 2 * names.length);
}

// As large as the SVG, twice as fine, and with much of its colours.
export async function pngShowsFigure(page, root) {
  const {size} = await svgOf(page, root);
  const bytes = await saved(page, root, 'png');
  assert.deepEqual([...bytes.subarray(0, 8)], [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  assert.equal(bytes.readUInt32BE(16), Math.floor(2 * size.width));
  assert.equal(bytes.readUInt32BE(20), Math.floor(2 * size.height));
  const colours = await page.evaluate(async (base64) => {
    const picture = new Image();
    picture.src = `data:image/png;base64,${base64}`;
    await picture.decode();
    const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d', {willReadFrequently: true});
    context.drawImage(picture, 0, 0);
    const {data} = context.getImageData(0, 0, picture.width, picture.height);
    const found = new Set();
    for (let i = 0; i < data.length; i += 4) found.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
    return found.size;
  }, bytes.toString('base64'));
  assert.ok(colours > 20, `${colours} colours`);
}
