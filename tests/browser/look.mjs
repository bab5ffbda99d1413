// What is checked of a page; each of these throws when it is not so.
import assert from 'node:assert/strict';

const figure = (page, id) => page.locator(`.archive:not([hidden]) [data-figure="${id}"]`);
const chart = (page, id, panel = 0) => figure(page, id).locator('.chart').nth(panel);
const xScale = (locator) => locator.evaluate(({uplot}) => [uplot.scales.x.min, uplot.scales.x.max]);

// All numbers that a figure draws: another figure has others.
const dataOf = (page, id) => figure(page, id).evaluate((root) => JSON.stringify(
    Array.from(root.querySelectorAll('.chart'), ({uplot}) => uplot.data)));

// The pixels of a chart, as far as they differ from an empty canvas; read from a copy, since reading
// a canvas makes Chromium draw it in another way from then on.
const pixelsOf = (locator) => locator.evaluate((host) => {
  const canvas = host.querySelector('canvas');
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext(
      '2d', {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
  let painted = 0, sum = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] === 0) continue;
    ++painted;
    sum = (sum * 31 + data[i] + 3 * data[i + 1] + 7 * data[i + 2] + i) % 1000000007;
  }
  return {painted, sum, share: painted / (data.length / 4)};
});

async function bringUp(page, id) {
  await figure(page, id).scrollIntoViewIfNeeded();
  await figure(page, id).locator('canvas').first().waitFor();
  return chart(page, id);
}

export async function fitsWidth(page) {
  const {page: wide, window: narrow} = await page.evaluate(
      () => ({page: document.documentElement.scrollWidth, window: innerWidth}));
  assert.ok(wide <= narrow, `the page is ${wide} wide, the window ${narrow}`);
}

export async function scrollThrough(page) {
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  for (let y = 0; y < height; y += 800) {
    await page.evaluate((to) => scrollTo(0, to), y);
    await page.waitForTimeout(30);
  }
}

export function visibleFigures(page) {
  return page.locator('.archive:not([hidden]) .figure').evaluateAll(
      (figures) => figures.map(({dataset}) => dataset.figure));
}

// Every panel has points and painted more than its axes; photographs have lit segments.
export async function isDrawn(page, id) {
  const root = figure(page, id);
  await root.scrollIntoViewIfNeeded();
  await root.locator('canvas, svg').first().waitFor();
  const panels = await root.locator('.chart').all();
  for (const panel of panels) {
    const points = await panel.evaluate(({uplot}) => uplot.data.slice(1).map(
        (y) => y.filter((value) => value != null).length));
    assert.ok(points.length > 0 && points.every((count) => count > 0), `points: ${points}`);
    const coloured = await panel.evaluate(({uplot}) => uplot.series.slice(1).map((series, i) =>
        series.stroke(uplot, i + 1)));
    assert.ok(coloured.every((colour) => /^(#|hsl)/.test(colour)), `colours: ${coloured}`);
    assert.ok((await pixelsOf(panel)).share > 0.005, 'the canvas is nearly empty');
    const hidden = await pixelsWithoutSeries(panel);
    assert.notEqual((await pixelsOf(panel)).sum, hidden, 'the series leave no trace');
  }
  if (panels.length === 0) assert.ok(await root.locator('svg path').count() > 50, 'no segments');
  assert.notEqual(await root.locator('h4').innerText(), '');
  assert.notEqual(await root.locator('figcaption').innerText(), '');
}

// What remains when all series are switched off; they are on again afterwards.
async function pixelsWithoutSeries(panel) {
  const switchAll = (show) => panel.evaluate(async ({uplot}, shown) => {
    const {min, max} = uplot.scales.y;
    uplot.series.forEach((_, i) => i && uplot.setSeries(i, {show: shown}));
    if (!shown) uplot.setScale('y', {min, max});
    await new Promise(requestAnimationFrame);
  }, show);
  await switchAll(false);
  const {sum} = await pixelsOf(panel);
  await switchAll(true);
  return sum;
}

export async function controlsAreNamed(page) {
  const nameless = await page.locator('button, select, input').evaluateAll((all) => all.filter(
      (one) => !(one.getAttribute('aria-label') || one.innerText || one.labels?.length)).length);
  assert.equal(nameless, 0);
  const charts = await page.locator('.chart').evaluateAll((all) => all.filter(
      (one) => !one.getAttribute('aria-label') || one.tabIndex !== 0).length);
  assert.equal(charts, 0);
}

async function drag(page, host) {
  const box = await host.locator('.u-over').boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + box.width * 0.3, y);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, y, {steps: 5});
  await page.mouse.up();
  return {x: box.x + box.width * 0.5, y};
}

export async function zooms(page) {
  const host = await bringUp(page, 'frame_errors');
  const all = await xScale(host), seen = await pixelsOf(host);
  const middle = await drag(page, host);
  const zoomed = await xScale(host);
  assert.ok(zoomed[1] - zoomed[0] < 0.4 * (all[1] - all[0]), `${all} became ${zoomed}`);
  assert.notEqual((await pixelsOf(host)).sum, seen.sum);
  await page.mouse.dblclick(middle.x, middle.y);
  assert.deepEqual(await xScale(host), all);
  await drag(page, host);
  assert.notDeepEqual(await xScale(host), all);
  await figure(page, 'frame_errors').getByRole('button', {name: 'Reset zoom'}).click();
  assert.deepEqual(await xScale(host), all);
}

export async function zoomsByKey(page) {
  const host = await bringUp(page, 'frame_errors');
  const all = await xScale(host);
  await host.focus();
  await page.keyboard.press('+');
  const zoomed = await xScale(host);
  assert.ok(Math.abs((zoomed[1] - zoomed[0]) / (all[1] - all[0]) - 0.5) < 1e-6);
  await page.keyboard.press('ArrowRight');
  assert.ok((await xScale(host))[0] > zoomed[0]);
  await page.keyboard.press('0');
  assert.deepEqual(await xScale(host), all);
}

export async function showsValues(page) {
  const host = await bringUp(page, 'frame_errors');
  const box = await host.locator('.u-over').boundingBox();
  await page.mouse.move(box.x + box.width / 3, box.y + box.height / 2);
  const values = await host.locator('.u-legend .u-value').allInnerTexts();
  assert.ok(values.length > 1 && values.every((text) => Number.isFinite(Number(text))), `${values}`);
}

// The figure's own select, of a figure that has both.
export async function switches(page, label) {
  const id = 'host_clocks';
  await bringUp(page, id);
  const select = figure(page, id).getByLabel(label);
  const before = await dataOf(page, id), pixels = await pixelsOf(chart(page, id));
  const [chosen, others] = await select.evaluate((element) => [
    element.value, Array.from(element.options, ({value}) => value)]);
  await select.selectOption(others.find((value) => value !== chosen));
  await figure(page, id).locator('canvas').first().waitFor();
  assert.notEqual(await dataOf(page, id), before);
  assert.notEqual((await pixelsOf(chart(page, id))).sum, pixels.sum);
  await select.selectOption(chosen);
  assert.equal(await dataOf(page, id), before);
}

export async function switchesAll(page) {
  await page.locator('#pipeline').selectOption('genlock');
  await page.locator('#seed').selectOption('2');
  assert.match(page.url(), /pipeline=genlock/);
  for (const id of ['stamps', 'host_clocks', 'gathering']) {
    assert.equal(await figure(page, id).getByLabel('Pipeline').inputValue(), 'genlock');
    assert.equal(await figure(page, id).getByLabel('Seed').inputValue(), '2');
  }
  await page.locator('#pipeline').selectOption('');
  await page.locator('#seed').selectOption('');
}

export async function hidesSeries(page) {
  const host = await bringUp(page, 'frame_errors');
  const before = await pixelsOf(host);
  const entry = host.locator('.u-legend .u-series th').nth(1);
  await entry.focus();
  await page.keyboard.press('Enter');
  assert.equal(await host.evaluate(({uplot}) => uplot.series[1].show), false);
  await page.waitForTimeout(50);
  assert.notEqual((await pixelsOf(host)).sum, before.sum);
  await entry.click();
  assert.equal(await host.evaluate(({uplot}) => uplot.series[1].show), true);
}

export async function changesTheme(page) {
  const host = await bringUp(page, 'frame_errors');
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const before = [await background(), (await pixelsOf(host)).sum];
  await page.locator('#theme').click();
  await page.waitForTimeout(50);
  assert.notEqual(await background(), before[0]);
  assert.notEqual((await pixelsOf(host)).sum, before[1]);
}

// Returns the fragment and what is to be seen again.
export async function choosesFrame(page) {
  await page.locator('#pipeline').selectOption('genlock');
  const host = await bringUp(page, 'gathering');
  await figure(page, 'gathering').getByLabel('Seed').selectOption('2');
  const unmarked = (await pixelsOf(host)).sum;
  const box = await host.locator('.u-over').boundingBox();
  await page.mouse.click(box.x + box.width * 0.4, box.y + box.height / 2);
  await page.waitForTimeout(50);
  assert.notEqual((await pixelsOf(host)).sum, unmarked, 'the frame is not marked');
  const fragment = new URL(page.url()).hash;
  const given = new URLSearchParams(fragment.slice(1));
  assert.equal(given.get('figure'), 'gathering');
  assert.equal(given.get('pipeline'), 'genlock');
  assert.equal(given.get('seed'), '2');
  const pulse = Number(given.get('pulse'));
  const [first, last] = await xScale(host);
  const place = (pulse - first) / (last - first);
  assert.ok(Number.isInteger(pulse) && Math.abs(place - 0.4) < 0.02, `pulse ${pulse}`);
  return {fragment, before: {pulse: String(pulse), data: await dataOf(page, 'gathering')}};
}

export async function showsFrame(page, before) {
  const host = await bringUp(page, 'gathering');
  assert.equal(await page.locator('#pulse').inputValue(), before.pulse);
  assert.equal(await dataOf(page, 'gathering'), before.data);
  const {top, bottom} = await figure(page, 'gathering').evaluate((root) => {
    const box = root.getBoundingClientRect();
    return {top: box.top, bottom: box.bottom};
  });
  assert.ok(top < 900 && bottom > 0, `the figure is at ${top} to ${bottom}`);
  const marked = (await pixelsOf(host)).sum;
  await page.locator('#pulse').fill('');
  await page.locator('#pulse').press('Enter');
  await page.waitForTimeout(50);
  assert.notEqual((await pixelsOf(host)).sum, marked, 'the frame is not marked');
}

export async function printsAll(page) {
  await page.waitForTimeout(200);
  for (const id of await visibleFigures(page)) {
    const root = figure(page, id);
    assert.ok(await root.isVisible(), id);
    assert.ok(await root.locator('canvas, svg').count() > 0, `${id} is not drawn`);
    const widths = await root.locator('.chart').evaluateAll((all) => all.map(({uplot}) => uplot.width));
    assert.ok(widths.every((width) => width > 600 && width <= 720), `${id}: ${widths}`);
  }
  assert.equal(await page.locator('#controls').isVisible(), false);
  assert.equal(await page.locator('.figure-tools').first().isVisible(), false);
}

export async function printsLight(page) {
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor),
               'rgb(255, 255, 255)');
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).color), 'rgb(0, 0, 0)');
}

export async function isWideAgain(page) {
  await page.waitForTimeout(200);
  const host = await bringUp(page, 'frame_errors');
  assert.ok(await host.evaluate(({uplot}) => uplot.width) > 1000);
}

export async function compares(page) {
  const table = page.getByRole('region', {name: 'The archives side by side'});
  assert.equal(await table.locator('tbody tr').count(), 3);
  assert.equal(await table.locator('thead th').count(), 5);
}

export async function switchesArchive(page) {
  const shown = page.locator('.archive:visible');
  assert.equal(await shown.getAttribute('data-name'), 'monday');
  await bringUp(page, 'frame_errors');
  const before = await dataOf(page, 'frame_errors');
  await page.locator('#archive').selectOption('1');
  assert.equal(await shown.getAttribute('data-name'), 'tuesday');
  assert.match(page.url(), /archive=1/);
  await bringUp(page, 'frame_errors');
  assert.notEqual(await dataOf(page, 'frame_errors'), before);
}

export async function isHarmless(page) {
  await scrollThrough(page);
  assert.equal(await page.evaluate(() => window.broken), undefined);
  assert.equal(await page.locator('img').count(), 0);
  assert.match(await page.locator('h2').innerText(), /^<\/script>/);
  await isDrawn(page, 'distributions');
}

export async function hasTables(page) {
  assert.ok(await page.locator('table:visible').count() >= 3);
  assert.match(await page.locator('main').innerText(), /yoon2021_both/);
  assert.match(await page.locator('main').innerText(), /JavaScript/);
}
