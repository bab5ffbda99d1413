// What is checked of a page that is looked at; each of these throws when it is not so.
import assert from 'node:assert/strict';
import {inflateSync} from 'node:zlib';

import {bringUp, figure, pixelsOf} from './page_parts.mjs';

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
      (one) => !(one.getAttribute('aria-label') || one.textContent || one.labels?.length)).length);
  assert.equal(nameless, 0);
  const charts = await page.locator('.chart').evaluateAll((all) => all.filter(
      (one) => !one.getAttribute('aria-label') || one.tabIndex !== 0).length);
  assert.equal(charts, 0);
}

// The figure's own select, of a figure that has both.
// Returns the fragment and what is to be seen again.
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

// What a PDF fills with paint, by its colour: "r g b" -> how often.
function fillsOf(pdf) {
  const fills = new Map();
  const text = pdf.toString('latin1');
  for (const {index, 0: opening} of text.matchAll(/FlateDecode[^>]*>>\s*stream\r?\n/g)) {
    const from = index + opening.length;
    const content = inflateSync(pdf.subarray(from, text.indexOf('endstream', from))).toString('latin1');
    for (const [, colour] of content.matchAll(/([\d.]+ [\d.]+ [\d.]+) rg\b/g)) {
      fills.set(colour, (fills.get(colour) ?? 0) + 1);
    }
  }
  return fills;
}

// As a printer without ink for backgrounds gets it.
const printed = async (page) => fillsOf(await page.pdf({format: 'A4', printBackground: false}));

// The colours of paper, as a PDF writes them.
const coloursOf = (page, selector, property) => page.locator(selector).first().evaluate(
    (element, name) => getComputedStyle(element)[name].match(/[\d.]+/g).slice(0, 3).map(
        (value) => String(+(value / 255).toFixed(4)).replace(/^0\./, '.')).join(' '), property);

// The overview's bands and dots are backgrounds, which a browser leaves out unless it is told otherwise.
export async function printsFirstFigure(page) {
  await page.emulateMedia({media: 'print'});
  const band = await coloursOf(page, '.overview .band', 'backgroundColor');
  const best = await coloursOf(page, '.overview .best .dot', 'backgroundColor');
  await page.emulateMedia({media: null});
  const all = await printed(page);
  await page.evaluate(() => document.querySelectorAll('.overview i').forEach((mark) => mark.style.visibility = 'hidden'));
  const without = await printed(page);
  await page.evaluate(() => document.querySelectorAll('.overview i').forEach((mark) => mark.style.visibility = ''));
  const bands = await page.locator('.archive:not([hidden]) .overview .band').count();
  assert.ok(bands >= 3);
  assert.ok(all.get(band) >= (without.get(band) ?? 0) + bands - 1, `bands: ${all.get(band)}, ${without.get(band)}`);
  assert.ok(all.get(best) >= (without.get(best) ?? 0) + 2, `best: ${all.get(best)}, ${without.get(best)}`);
}

// Every colour of a series is in the PDF, from a light page and from a dark one.
export async function printsSeries(page) {
  const fills = await printed(page);
  for (const colour of ['.1216 .4353 .7059', '.8196 .2863 .1059', '.1647 .5412 .2902']) {
    assert.ok(fills.get(colour) > 5, `${colour}: ${fills.get(colour)}`);
  }
}

// At the width of a page, where nothing scrolls.
export async function printsWholeTables(page) {
  const before = page.viewportSize();
  await page.setViewportSize({width: 680, height: 900});
  await page.emulateMedia({media: 'print'});
  const wide = await page.locator('.scroll > table:visible').evaluateAll((tables) => tables.filter(
      (table) => table.getBoundingClientRect().right > innerWidth + 1 || table.getBoundingClientRect().left < -1)
      .map((table) => `${table.caption.textContent}: ${table.getBoundingClientRect().right}`));
  const buttons = await page.locator('button:visible:not(.sort)').count();
  await page.emulateMedia({media: null});
  await page.setViewportSize(before);
  assert.deepEqual(wide, []);
  assert.equal(buttons, 0, 'buttons on paper');
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

// The comparison of the archives is what the page begins with; the archives follow.
export async function beginsWithComparison(page) {
  assert.match(await page.locator('h2:visible').innerText(), /^wednesday against monday$/);
  assert.deepEqual(await visibleFigures(page), ['compared_distributions', 'paired_differences']);
  await compares(page);
  const names = await page.locator('#archive option').allInnerTexts();
  assert.deepEqual(names, ['wednesday against monday', 'monday', 'wednesday']);
}

export async function saysWhyNotPaired(page) {
  assert.match(await page.locator('main').innerText(), /Not compared seed by seed: .*none in common/);
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
