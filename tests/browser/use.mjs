// What is checked of a page that is used: zoom, switches, links. Each of these throws when it is
// not so.
import assert from 'node:assert/strict';

import {bringUp, chart, dataOf, figure, pixelsOf, xScale} from './page_parts.mjs';

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

// A limit far from the data is in sight, until the reader zooms, and again afterwards.
export async function showsLimits(page, id, limit) {
  const host = await bringUp(page, id);
  const top = () => host.evaluate(({uplot}) => uplot.scales.y.max);
  assert.ok(await top() >= limit, `${await top()}`);
  await host.focus();
  await page.keyboard.press('+');
  await page.waitForTimeout(50);
  assert.ok(await top() < limit, `zoomed: ${await top()}`);
  await page.keyboard.press('0');
  await page.waitForTimeout(50);
  assert.ok(await top() >= limit, `again: ${await top()}`);
}
