// The page of `simbench watch` in a real browser: it is legible, shows a slip and a step soon after
// they happen, and survives files that are truncated, rotated, vanish and come back, and a server
// that is gone.
//
// Run by CTest (label `browser`); by hand:
//   node tests/browser/watch_test.mjs build/release/bin/simbench build/browser
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {appendFileSync, mkdtempSync, renameSync, rmSync, truncateSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';

import * as access from './access.mjs';
import {closeBrowser, openPage} from './browser.mjs';
import {Checks} from './checks.mjs';
import * as look from './look.mjs';

const [simbench, packages] = process.argv.slice(2).map((argument) => path.resolve(argument));
if (!packages) {
  console.error('usage: node watch_test.mjs SIMBENCH FOLDER_OF_NODE_MODULES');
  process.exit(2);
}
const folder = mkdtempSync(path.join(tmpdir(), 'simbench_watch.'));
const file = (name) => path.join(folder, name);
const checks = new Checks();
const check = (name, action) => checks.check(name, action);
const kHeading = 'Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n';
const kPeriodMs = 1000 / 30;

// Cameras that are written as if by a recorder, a piece at a time: data time is not the machine's.
class Recorder {
  pulse = 0;
  laterMs = 0;  // of the camera c1

  constructor(name) {
    this.path = file(name);
    writeFileSync(this.path, kHeading);
  }

  write(pulses) {
    let text = '';
    for (const end = this.pulse + pulses; this.pulse < end; ++this.pulse) {
      for (let camera = 0; camera < 3; ++camera) {
        const ms = this.pulse * kPeriodMs, noise = (this.pulse * 7919 + camera * 104729) % 997 / 997;
        const arrival = ms + 5 + camera + noise + (camera === 1 ? this.laterMs : 0);
        text += `Depth,0,${this.pulse},${(700 + ms).toFixed(3)},${arrival.toFixed(3)},c${camera},pc\n`;
      }
    }
    appendFileSync(this.path, text);
  }
}

async function served(...words) {
  const child = spawn(simbench, ['watch', ...words, '--page', '--interval-s', '0.1', '--format', 'json'],
                      {cwd: folder, stdio: ['ignore', 'pipe', 'pipe']});
  let text = '';
  const address = await new Promise((resolve, reject) => {
    child.stderr.on('data', (piece) => {
      text += piece;
      const found = text.match(/http:\S+\//);
      if (found) resolve(found[0].replace(/metrics$/, ''));
    });
    child.on('exit', (status) => reject(new Error(`watch ended with ${status}`)));
  });
  return {
    address,
    stop: () => new Promise((resolve) => {
      child.on('exit', resolve);
      child.kill('SIGINT');
    }),
  };
}

const recorder = new Recorder('rig.csv');
recorder.write(300);
writeFileSync(file('clock.csv'), 'time_s,offset_us\n');
let second = 0;
function writeClock(samples, microseconds) {
  let text = '';
  for (const end = second + samples; second < end; ++second) {
    text += `${second},${(microseconds + (second * 7919 % 97) / 97).toFixed(3)}\n`;
  }
  appendFileSync(file('clock.csv'), text);
}
writeClock(40, 0);

const server = await served('rig.csv', '--clock-log', 'hostA=clock.csv');
const {page, errors, requests, context} = await openPage(
    packages, server.address, {width: 1400, height: 900, theme: 'light'});
const saying = (selector, text) => page.locator(selector).filter({hasText: text}).waitFor({timeout: 20000});

await check('a rig in order is said to be', () => saying('#status', 'in order'));
await check('every camera and clock has its line', async () => {
  await page.waitForFunction(() => document.querySelectorAll('#cameras tbody tr').length === 3 &&
      document.querySelectorAll('#clocks tbody tr').length === 1);
});
for (const [width, theme] of [[1920, 'light'], [1400, 'dark'], [390, 'light']]) {
  await page.setViewportSize({width, height: 900});
  await page.emulateMedia({colorScheme: theme});
  await page.waitForTimeout(100);
  await check(`watch at ${width}, ${theme}: it fits, is legible and reachable`, async () => {
    await look.fitsWidth(page);
    await access.nothingIsCutOff(page);
    await access.textIsLegible(page);
    await look.controlsAreNamed(page);
  });
}
await check('a slip is shown, with since when', async () => {
  recorder.laterMs = 11;
  recorder.write(60);
  await saying('#alarms', 'camera c1 slipped');
  await saying('#status', 'alarm, for');
});
await check('a step of a clock is shown', async () => {
  writeClock(3, 800);
  await saying('#alarms', 'clock of hostA stepped by +');
});
await check('a file that is truncated and written anew is read on', async () => {
  truncateSync(recorder.path, 0);
  appendFileSync(recorder.path, kHeading);
  recorder.pulse = 0;
  recorder.write(300);
  await page.waitForFunction(() => /^[6-9]\d\d$/.test(document.querySelector('#cameras td:nth-child(7)').innerText));
});
await check('a file that is rotated is read on', async () => {
  renameSync(recorder.path, file('rig.csv.1'));
  writeFileSync(recorder.path, kHeading);
  recorder.write(300);
  await page.waitForFunction(() => /^9\d\d$/.test(document.querySelector('#cameras td:nth-child(7)').innerText));
});
await check('a file that vanishes is an alarm, until it is back', async () => {
  renameSync(recorder.path, file('away.csv'));
  await saying('#alarms', 'rig.csv is not there');
  renameSync(file('away.csv'), recorder.path);
  await page.waitForFunction(() => !document.getElementById('alarms').innerText.includes('is not there'));
  recorder.write(30);
});
await check('metrics are OpenMetrics', async () => {
  const text = await (await fetch(`${server.address}metrics`)).text();
  assert.match(text, /simbench_camera_slips_total\{camera="c1",host="pc",stream="Depth 0"\} 1\n/);
  assert.match(text, /simbench_clock_steps_total\{subject="clock of hostA"/);
  assert.ok(text.endsWith('# EOF\n'));
});
await check('no error was logged, and nothing else was asked', () => {
  assert.deepEqual(errors, []);
  assert.deepEqual(requests.filter((url) => !url.startsWith(server.address)), []);
});
await check('a server that is gone is said', async () => {
  await server.stop();
  await saying('#banner', 'does not answer since');
});
await context.close();
await closeBrowser();
rmSync(folder, {recursive: true});
checks.finish();
