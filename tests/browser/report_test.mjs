// The HTML pages in a real browser: a report made by the real simbench is opened from the disk, in
// two widths and two themes, looked at, used, and printed; it and the pages of other commands must
// be legible and reachable by keyboard from a telephone's width up.
//
// Run by CTest (label `browser`); by hand:
//   node tests/browser/report_test.mjs build/release/bin/simbench build/browser
// Chromium is the system's (CHROMIUM names another one). The last line counts the checks.
import assert from 'node:assert/strict';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

import {closeBrowser, openPage} from './browser.mjs';
import {makeOtherPages, makeReport} from './make_report.mjs';
import * as access from './access.mjs';
import * as files from './figure_files.mjs';
import * as look from './look.mjs';
import {figure} from './page_parts.mjs';
import * as tables from './tables.mjs';
import * as use from './use.mjs';

const [simbench, packages] = process.argv.slice(2).map((argument) => path.resolve(argument));
if (!packages) {
  console.error('usage: node report_test.mjs SIMBENCH FOLDER_OF_NODE_MODULES');
  process.exit(2);
}

const folder = mkdtempSync(path.join(tmpdir(), 'simbench_report.'));
const kShapes = [
  {width: 1280, height: 900, theme: 'light'}, {width: 1280, height: 900, theme: 'dark'},
  {width: 390, height: 844, theme: 'light'}, {width: 390, height: 844, theme: 'dark'},
];
const kAccessShapes = [
  {width: 1400, height: 900, theme: 'light'}, {width: 1400, height: 900, theme: 'dark'},
  {width: 1024, height: 900, theme: 'light'}, {width: 390, height: 844, theme: 'light'},
];
let passed = 0, failed = 0;

async function check(name, action) {
  try {
    await action();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED: ${name}\n  ${String(error.message).replaceAll('\n', '\n  ')}`);
  }
}

// Opens the report, runs the checks, and then asks whether anything went wrong or out.
async function withPage(file, shape, fragment, action) {
  const opened = await openPage(packages, pathToFileURL(file).href + fragment, shape);
  const name = `${path.basename(file)} at ${shape.width}, ${shape.theme}`;
  await action(opened.page, (what, test) => check(`${name}: ${what}`, test));
  await check(`${name}: nothing was asked from outside`, () =>
      assert.deepEqual(opened.requests, []));
  await check(`${name}: no error and no warning was logged`, () => assert.deepEqual(opened.errors, []));
  await opened.context.close();
}

async function checkLook(file, shape) {
  await withPage(file, shape, '', async (page, test) => {
    await test('the theme is what the system asks for', async () =>
        assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), shape.theme));
    await test('the page does not scroll sideways', () => look.fitsWidth(page));
    await look.scrollThrough(page);
    await test('the page does not scroll sideways once all is drawn', () => look.fitsWidth(page));
    for (const id of await look.visibleFigures(page)) {
      await test(`${id} has data and drew it`, () => look.isDrawn(page, id));
    }
    await test('every control has a name', () => look.controlsAreNamed(page));
    const first = await page.evaluate(() => performance.getEntriesByName('first figure')[0].startTime);
    console.log(`${path.basename(file)} at ${shape.width}, ${shape.theme}: first figure after ${
        first.toFixed(0)} ms`);
  });
}

// What everyone needs who reads a page, whichever command made it.
async function checkAccess(file, shape) {
  await withPage(file, shape, '', async (page, test) => {
    await test('it begins with the answer', () => access.beginsWithTheAnswer(page));
    await look.scrollThrough(page);
    await test('the page does not scroll sideways', () => look.fitsWidth(page));
    await test('nothing is cut off', () => access.nothingIsCutOff(page));
    await test('text stands out from what is behind it', () => access.textIsLegible(page));
    await test('the keyboard reaches everything, visibly', () => access.keyboardReachesAll(page));
    await test('every control has a name', () => look.controlsAreNamed(page));
    await test('every table can be sorted and saved', () => tables.everyTableHasControls(page));
    await test('on paper no table is cut off', () => look.printsWholeTables(page));
  });
}

async function checkTables(file, name, column) {
  await check('cells are put in order by value', () => tables.ordersByValue());
  await check('cells have units and words', () => tables.knowsUnitsAndWords());
  await check('lines of CSV are quoted', () => tables.writesCsv());
  await withPage(file, kShapes[0], '', async (page, test) => {
    await test('a heading sorts by its column', () => tables.sortsByClick(page, name, column));
    await test('Enter and the space bar sort, too', () => tables.sortsByKeyboard(page, name, column));
    await test('one column is marked as sorted', () => tables.marksOneColumn(page, name));
    await test('a table is saved as CSV', () => tables.savesCsv(page, name));
  });
}

async function checkFigureFiles(file, shape) {
  await withPage(file, shape, '', async (page, test) => {
    for (const id of await look.visibleFigures(page)) {
      await test(`the SVG of ${id} has what is shown`, () => files.svgMirrorsFigure(page, id));
    }
    for (const id of ['budget', 'distributions', 'frame_errors', 'gathering', 'first_seconds']) {
      await test(`the SVG of ${id} looks like it`, () => files.svgLooksLikeCanvas(page, id));
    }
    await test('the SVG leaves out what is hidden', () => files.svgLeavesOutHidden(page, 'frame_errors'));
    await test('the SVG of the overview has all pipelines', () => files.svgHasOverview(page));
    await test('the PNG of a figure has its colours', () =>
        files.pngShowsFigure(page, figure(page, 'frame_errors')));
    await test('the PNG of the overview has its colours', () =>
        files.pngShowsFigure(page, files.overview(page)));
  });
}

async function checkUse(file) {
  await withPage(file, kShapes[0], '', async (page, test) => {
    await test('dragging zooms, a double click and the button reset', () => use.zooms(page));
    await test('the keyboard zooms', () => use.zoomsByKey(page));
    await test('hovering shows values', () => use.showsValues(page));
    await test('another pipeline changes what is drawn', () => use.switches(page, 'Pipeline'));
    await test('another seed changes what is drawn', () => use.switches(page, 'Seed'));
    await test('the switches above change all figures', () => use.switchesAll(page));
    await test('an entry of the legend hides its series', () => use.hidesSeries(page));
    await test('the button changes the theme and its colours', () => use.changesTheme(page));
  });
}

async function checkLink(file) {
  let fragment = '', before = null;
  await withPage(file, kShapes[0], '', async (page, test) => {
    await test('a click into a frame writes it into the address', async () => {
      ({fragment, before} = await use.choosesFrame(page));
    });
  });
  await withPage(file, kShapes[0], fragment, async (page, test) => {
    await test('a link to a frame shows the same', () => use.showsFrame(page, before));
  });
  await withPage(file, kShapes[0], '#archive=7&pipeline=none&figure=%3Cb%3E&pulse=x', async (page, test) => {
    await test('a fragment of nonsense shows the report', () => look.isDrawn(page, 'frame_errors'));
  });
}

async function checkPrint(file) {
  await withPage(file, kShapes[1], '', async (page, test) => {
    await page.emulateMedia({media: 'print'});
    await test('on paper every figure is drawn, without controls', () => look.printsAll(page));
    await test('on paper all is dark on white', () => look.printsLight(page));
    await page.emulateMedia({media: 'screen'});
    await test('afterwards the figures fill the screen again', () => look.isWideAgain(page));
  });
  for (const shape of [kShapes[0], kShapes[1]]) {
    await withPage(file, shape, '', async (page, test) => {
      await test('without backgrounds the first figure is whole', () => look.printsFirstFigure(page));
      await test('series are printed in the colours of paper', () => look.printsSeries(page));
    });
  }
}

async function checkArchives(file) {
  await withPage(file, kShapes[0], '', async (page, test) => {
    await test('the archives are side by side in a table', () => look.compares(page));
    await test('what has no seed in common is not compared', () => look.saysWhyNotPaired(page));
    await test('a switch shows the other archive', () => use.switchesArchive(page));
  });
}

async function checkPaired(file) {
  await withPage(file, kShapes[0], '', async (page, test) => {
    await test('archives of the same seeds are compared', () => look.beginsWithComparison(page));
    await look.scrollThrough(page);
    for (const id of await look.visibleFigures(page)) {
      await test(`${id} has data and drew it`, () => look.isDrawn(page, id));
      await test(`the SVG of ${id} has what is shown`, () => files.svgMirrorsFigure(page, id));
      await test(`the SVG of ${id} looks like it`, () => files.svgLooksLikeCanvas(page, id));
    }
    await test('the verdicts sort by value', () => tables.sortsByClick(page, 'Verdicts', 2));
  });
}

async function checkStability(file) {
  await withPage(file, kShapes[0], '', async (page, test) => {
    await look.scrollThrough(page);
    await test('a limit is in sight', () => use.showsLimits(page, 'time_error', 2));
    for (const id of ['time_error', 'stability']) {
      await test(`${id} has data and drew it`, () => look.isDrawn(page, id));
      await test(`the SVG of ${id} has what is shown`, () => files.svgMirrorsFigure(page, id));
      await test(`the SVG of ${id} looks like it`, () => files.svgLooksLikeCanvas(page, id));
    }
  });
}

async function checkWithoutScript(file) {
  const opened = await openPage(
      packages, pathToFileURL(file).href, {...kShapes[0], javaScriptEnabled: false});
  await check('without JavaScript the tables are there', () => look.hasTables(opened.page));
  await opened.context.close();
}

const {one, two, paired, hostile} = makeReport(simbench, folder);
const others = makeOtherPages(simbench, folder);
for (const shape of kShapes) await checkLook(one, shape);
for (const file of [one, ...Object.values(others)]) {
  for (const shape of kAccessShapes) await checkAccess(file, shape);
}
await checkTables(one, "The paper's metrics", 1);
await checkFigureFiles(one, kShapes[0]);
await checkFigureFiles(one, kShapes[1]);
await checkUse(one);
await checkLink(one);
await checkPrint(one);
await checkArchives(two);
await checkPaired(paired);
await checkStability(others.stability);
await withPage(hostile, kShapes[0], '', async (page, test) => {
  await test('names with markup are text', () => look.isHarmless(page));
});
await checkWithoutScript(one);
await closeBrowser();
rmSync(folder, {recursive: true});
console.log(`${passed} checks passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
