// The page of `simbench explore` in a real browser, served by the real simbench: legible and
// reachable at every width, steered by keyboard alone, right to the byte, and steady when its server
// is slow, asleep or gone.
//
// Run by CTest (label `browser`); by hand:
//   node tests/browser/explore_test.mjs build/release/bin/simbench build/browser
import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

import * as access from './access.mjs';
import {closeBrowser, openPage} from './browser.mjs';
import {Checks} from './checks.mjs';
import * as look from './look.mjs';

const [simbench, packages] = process.argv.slice(2).map((argument) => path.resolve(argument));
if (!packages) {
  console.error('usage: node explore_test.mjs SIMBENCH FOLDER_OF_NODE_MODULES');
  process.exit(2);
}
const folder = mkdtempSync(path.join(tmpdir(), 'simbench_explore.'));
const kWide = {width: 1400, height: 900, theme: 'light'};
const kShapes = [
  {width: 1920, height: 1080, theme: 'light'}, {width: 1400, height: 900, theme: 'dark'},
  {width: 768, height: 900, theme: 'light'}, {width: 390, height: 844, theme: 'dark'},
];
const kMostServerMb = 150;
const checks = new Checks();
const check = (name, action) => checks.check(name, action);

// A server that runs until stop(): {address, process, stop()}.
async function served(...words) {
  const child = spawn(simbench, ['explore', ...words], {cwd: folder, stdio: ['ignore', 'pipe', 'pipe']});
  let text = '';
  const address = await new Promise((resolve, reject) => {
    child.stdout.on('data', (piece) => {
      text += piece;
      const found = text.match(/http:\S+\//);
      if (found) resolve(found[0]);
    });
    child.on('exit', (status) => reject(new Error(`explore ended with ${status}`)));
  });
  return {
    address, process: child,
    stop: () => new Promise((resolve) => {
      child.on('exit', resolve);
      child.kill('SIGINT');
    }),
  };
}

// A page is at rest when all that it asked for has come.
async function settled(page) {
  await page.waitForFunction(() => document.getElementById('stop').hidden &&
      document.querySelectorAll('.world.old').length === 0 &&
      document.getElementById('views').dataset.ended > 0);
}

async function opened(server, fragment = '', shape = kWide) {
  const page = await openPage(packages, server.address + fragment, shape);
  await settled(page.page);
  return page;
}

const answerOf = (page, world = 0) => page.locator('.world').nth(world).locator('.answer p').innerText();
const fieldOf = (page, pointer) => page.locator(`[data-pointer="${pointer}"] input:not([type="range"])`);

// Types a value into a parameter's field, as somebody does.
async function type(page, pointer, value) {
  await page.locator('#search').fill(pointer);
  await fieldOf(page, pointer).fill(String(value));
  await fieldOf(page, pointer).press('Enter');
}

// Waits until the page shows something else than `before`.
async function changedFrom(page, before) {
  await page.waitForFunction((text) => document.querySelector('.world:not(.old) .answer p') &&
      document.querySelector('.world .answer p').innerText !== text, before);
  await settled(page);
}

async function isLegible(server, shape) {
  const {page, errors, requests, context} = await opened(server, '', shape);
  const name = `explore at ${shape.width}, ${shape.theme}`;
  await check(`${name}: the page does not scroll sideways`, () => look.fitsWidth(page));
  await check(`${name}: nothing is cut off`, () => access.nothingIsCutOff(page));
  await check(`${name}: text stands out from what is behind it`, () => access.textIsLegible(page));
  await check(`${name}: every control has a name`, () => look.controlsAreNamed(page));
  await page.locator('details.group').evaluateAll((all) => all.slice(0, 4).forEach((one) => one.open = true));
  await check(`${name}: the keyboard reaches everything, visibly`, () => access.keyboardReachesAll(page));
  await check(`${name}: no error was logged`, () => assert.deepEqual(errors, []));
  await check(`${name}: nothing but its own server was asked`, () => assert.deepEqual(
      requests.filter((url) => !url.startsWith(server.address)), []));
  await context.close();
}

async function isSteered(server) {
  const {page, context} = await opened(server);
  const first = await answerOf(page);
  await check('a slider that the keyboard moves changes the answer, and undo restores it', async () => {
    const slider = page.locator('[data-pointer="/usb/delivery_jitter_transfers"] input[type="range"]');
    await slider.focus();
    await page.keyboard.press('End');
    await changedFrom(page, first);
    assert.match(await page.locator('#changed').innerText(), /delivery_jitter_transfers = /);
    await page.locator('#undo').click();
    await page.waitForFunction(() => document.getElementById('changed').innerText.startsWith('Nothing'));
    await settled(page);
    assert.equal(await answerOf(page), first);
    await page.locator('#redo').click();
    await changedFrom(page, first);
  });
  await check('a link restores what is shown', async () => {
    const shown = await answerOf(page);
    await page.waitForFunction(() => location.hash.includes('delivery_jitter_transfers'));
    const other = await opened(server, new URL(page.url()).hash);
    assert.equal(await answerOf(other.page), shown);
    await other.context.close();
  });
  await check('the search shows what it finds', async () => {
    await page.locator('#search').fill('spike probability');
    assert.equal(await page.locator('.parameter:visible').count(), 2);
    await page.locator('#search').fill('');
  });
  await check('another scenario is another world', async () => {
    await page.locator('#scenario').selectOption('6cam_2host_30fps');
    await page.waitForFunction(() => document.querySelector('.world h2').innerText === '6cam_2host_30fps');
    await settled(page);
  });
  await context.close();
}

async function isRefusedBesideItsSlider(server) {
  const {page, context} = await opened(server);
  await check('a world that cannot be is refused beside its slider, and what was shown stays', async () => {
    const before = await answerOf(page);
    await type(page, '/usb/spike_probability', 7);
    const message = page.locator('[data-pointer="/usb/spike_probability"] .refusal');
    await message.filter({hasText: 'found 7, allowed a number from 0 to 1'}).waitFor();
    assert.equal(await answerOf(page), before);
    await type(page, '/usb/spike_probability', 'much');
    await message.filter({hasText: "found 'much', allowed a number"}).waitFor();
    await type(page, '/usb/spike_probability', 0.5);
    await page.waitForFunction(() => !document.querySelector('.parameter.refused'));
    await settled(page);
  });
  await context.close();
}

async function isWhatTheCommandPrints(server) {
  const {page, context} = await opened(server);
  await check('results, command and file are those of the command line', async () => {
    const before = await answerOf(page);
    await type(page, '/usb/delivery_jitter_transfers', 0.4);
    await changedFrom(page, before);
    await page.locator('#command').click();
    await page.locator('#text_title').filter({hasText: 'The command'}).waitFor();
    const command = (await page.locator('#text').innerText()).trim().split(' ');
    await page.locator('#close').click();
    const download = page.waitForEvent('download');
    await page.locator('#json').click();
    const file = path.join(folder, 'page.json');
    await (await download).saveAs(file);
    const of_page = JSON.parse(readFileSync(file));
    const words = [...command.slice(1), '--no-levers', '--format', 'json'];
    const of_command = JSON.parse(execFileSync(simbench, words, {cwd: folder, stdio: 'pipe'}));
    for (const each of [of_page, of_command]) delete each.performance;
    assert.equal(JSON.stringify(of_page), JSON.stringify(of_command));
    await page.locator('#file').click();
    await page.locator('#text_title').filter({hasText: 'The scenario file'}).waitFor();
    writeFileSync(path.join(folder, 'again.json'), await page.locator('#text').innerText());
    const again = execFileSync(simbench, ['run', '--scenario', 'again.json', '--seeds', '8', '--format',
                                          'json', '--no-levers'], {cwd: folder, stdio: 'pipe'});
    assert.deepEqual(JSON.parse(again).rows[0].amd_ms.values, of_command.rows[0].amd_ms.values.slice(0, 8));
  });
  await context.close();
}

async function isCompared(server) {
  const {page, context} = await opened(server);
  await check('two states are side by side, with their differences', async () => {
    await page.locator('#keep').click();
    await page.waitForFunction(() => document.querySelectorAll('.world').length === 2);
    await settled(page);
    await type(page, '/usb/delivery_jitter_transfers', 3);
    await page.waitForFunction(() => document.querySelectorAll('.world .answer p').length === 2 &&
        document.querySelector('#comparison_tables table'));
    await settled(page);
    assert.notEqual(await answerOf(page, 0), await answerOf(page, 1));
    assert.ok(await page.locator('#comparison_figures .figure').count() >= 2);
    await page.locator('#drop').click();
    await page.waitForFunction(() => document.querySelectorAll('.world').length === 1);
  });
  await context.close();
}

function megabytes({pid}) {
  return Number(readFileSync(`/proc/${pid}/status`, 'utf8').match(/VmRSS:\s+(\d+)/)[1]) / 1024;
}

async function isSteady(server) {
  const {page, context} = await opened(server);
  const tab = await opened(server);
  await check('a thousand changes end with the last, in two tabs', async () => {
    await page.evaluate(async () => {
      const slider = document.querySelector('[data-pointer="/usb/delivery_jitter_transfers"] input[type="range"]');
      for (let i = 0; i < 1000; ++i) {
        slider.value = i;
        slider.dispatchEvent(new Event('input'));
        if (i % 4 === 0) await new Promise((resolve) => setTimeout(resolve, 1));
      }
    });
    await settled(page);
    const value = await fieldOf(page, '/usb/delivery_jitter_transfers').inputValue();
    assert.match(await page.locator('.world .provenance').innerText(), new RegExp(`→ ${value}`));
    await settled(tab.page);
  });
  await check(`the server takes less than ${kMostServerMb} MB`, () => {
    assert.ok(megabytes(server.process) < kMostServerMb, `${megabytes(server.process)} MB`);
  });
  await tab.context.close();
  await context.close();
}

// As of a machine that slept: the server answers nothing for a while, and then goes on.
async function survivesSleep(server) {
  const {page, context} = await opened(server);
  await check('a server that slept goes on', async () => {
    const before = await answerOf(page);
    server.process.kill('SIGSTOP');
    await type(page, '/usb/delivery_jitter_transfers', 2);
    await page.waitForTimeout(500);
    server.process.kill('SIGCONT');
    await changedFrom(page, before);
  });
  await context.close();
}

async function saysThatItIsLost(server) {
  const {page, context} = await opened(server);
  await check('a server that is gone is said, and what was shown stays', async () => {
    const before = await answerOf(page);
    await server.stop();
    await type(page, '/usb/delivery_jitter_transfers', 1);
    await page.locator('#banner').filter({hasText: 'does not answer'}).waitFor();
    assert.equal(await answerOf(page), before);
  });
  await context.close();
}

async function isPrinted(server) {
  const {page, context} = await opened(server);
  await check('on paper are the answer and the figures, without controls', async () => {
    await page.emulateMedia({media: 'print'});
    assert.equal(await page.locator('#bar:visible, aside:visible').count(), 0);
    assert.ok(await page.locator('.world .answer:visible').count() === 1);
    assert.ok(await page.locator('.world .figure canvas:visible').count() > 3);
    await look.printsLight(page);
  });
  await context.close();
}

// A page of another origin, which knows even the address.
async function keepsOthersOut(server) {
  const other = createServer((_, response) => response.end('<!doctype html><title>other</title>'));
  await new Promise((resolve) => other.listen(0, '127.0.0.1', resolve));
  const {page, context} = await openPage(packages, `http://127.0.0.1:${other.address().port}/`, kWide);
  await check('another page of the browser reads and steers nothing', async () => {
    const tried = await page.evaluate(async (address) => {
      const outcome = (promise) => promise.then(() => 'answered', () => 'refused');
      const frame = document.createElement('iframe');
      frame.src = address;
      document.body.append(frame);
      await new Promise((resolve) => setTimeout(resolve, 300));
      return {
        read: await outcome(fetch(`${address}subject`)),
        post: await outcome(fetch(`${address}look`, {method: 'POST', body: '{}',
                                                      headers: {'Content-Type': 'application/json'}})),
        framed: await outcome(Promise.resolve().then(() => frame.contentWindow.document.title)),
      };
    }, server.address);
    assert.deepEqual(tried, {read: 'refused', post: 'refused', framed: 'refused'});
  });
  await context.close();
  other.close();
}

async function isATour() {
  execFileSync(simbench, ['explore', '3cam_1host_30fps', '--export', 'tour.html', '--seeds', '4', '--sweep',
                          '/cameras/exposure_ms=2,8,20', '--sweep', '/usb/delivery_jitter_transfers=0:1:0.5'],
               {cwd: folder, stdio: 'pipe'});
  const {page, errors, requests, context} = await openPage(
      packages, pathToFileURL(path.join(folder, 'tour.html')).href, kWide);
  await settled(page);
  await check('an exported tour moves within its grid, without a server', async () => {
    const before = await answerOf(page);
    await page.locator('[data-pointer="/usb/delivery_jitter_transfers"] input[type="range"]').focus();
    await page.keyboard.press('End');
    await changedFrom(page, before);
    assert.equal(await page.locator('.parameter').count(), 2);
    assert.deepEqual([errors, requests], [[], []]);
    await look.fitsWidth(page);
    await access.textIsLegible(page);
  });
  await context.close();
}

async function saysHowFast(scenario) {
  const server = await served(scenario);
  const {page, context} = await opened(server);
  const elapsed = await page.evaluate(async () => {
    const slider = document.querySelector('[data-pointer="/usb/delivery_jitter_transfers"] input[type="range"]');
    performance.clearMarks();
    const begin = performance.now();
    slider.value = 700;
    slider.dispatchEvent(new Event('input'));
    while (performance.getEntriesByName('picture').length === 0) await new Promise(requestAnimationFrame);
    return performance.getEntriesByName('picture')[0].startTime - begin;
  });
  console.log(`${scenario}: first picture ${elapsed.toFixed(0)} ms after a change`);
  await context.close();
  await server.stop();
}

const server = await served('3cam_1host_30fps');
for (const shape of kShapes) await isLegible(server, shape);
await isSteered(server);
await isRefusedBesideItsSlider(server);
await isWhatTheCommandPrints(server);
await isCompared(server);
await isSteady(server);
await survivesSleep(server);
await isPrinted(server);
await keepsOthersOut(server);
await saysThatItIsLost(server);
await isATour();
for (const scenario of ['3cam_1host_30fps', '18cam_6host_45fps']) await saysHowFast(scenario);
await closeBrowser();
rmSync(folder, {recursive: true});
checks.finish();
