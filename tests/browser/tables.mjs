// What is checked of the tables of every page: that they can be sorted and taken away. Each of these
// throws when it is not so.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';

const kValues = new URL('../../reports/web/table_values.js', import.meta.url);

// The functions of reports/web/table_values.js, which need no page.
function tableValues() {
  const text = readFileSync(kValues, 'utf8');
  return new Function(`${text}\nreturn {sortKey, sortedPlaces, csvLine};`)();
}

const sorted = (texts, direction) => {
  const {sortKey, sortedPlaces} = tableValues();
  return sortedPlaces(texts.map(sortKey), direction).map((place) => texts[place]);
};

export function ordersByValue() {
  const rising = [
    '-inf', '-2.5 s', '−3.20 ms', '[-1.5, 9] us', '0', '0.5 ns', '1.34 us [1.15, 1.56]', '0.694 ms',
    '980 us', '[1.0, 2.0] ms', 'from 2.92 to 1.89 ms', '1.61 s', '2 min', 'inf', 'failed', '-', '–',
  ];
  const shuffled = rising.map((_, i) => rising[i * 7 % rising.length]);
  assert.deepEqual(sorted(shuffled, 1).slice(0, -2), rising.slice(0, -2));
  assert.deepEqual(sorted(shuffled, -1).slice(0, 14), rising.slice(0, 14).reverse());
  assert.deepEqual(sorted(['-', 'b', '2', '', 'a', '1'], 1), ['1', '2', 'a', 'b', '-', '']);
  assert.deepEqual(sorted(['-', 'b', '2', '', 'a', '1'], -1), ['2', '1', 'b', 'a', '-', '']);
}

export function knowsUnitsAndWords() {
  assert.deepEqual(sorted(['> 99.9 %', '100 %', '99.9 %', '0.1 %', '0 %', '< 0.1 %'], 1),
                   ['0 %', '< 0.1 %', '0.1 %', '99.9 %', '> 99.9 %', '100 %']);
  assert.deepEqual(sorted(['1 234 567', '12.3 k', '999', '4.56 M'], 1),
                   ['999', '12.3 k', '1 234 567', '4.56 M']);
  assert.deepEqual(sorted(['14 of 16', '9 of 16', '12-14 of 16'], 1), ['9 of 16', '12-14 of 16', '14 of 16']);
  assert.deepEqual(sorted(['1.2e-9', '3e-10', '2.00e+3', '1e2'], 1), ['3e-10', '1.2e-9', '1e2', '2.00e+3']);
  // Names and days are words, in the order of the numbers in them.
  assert.deepEqual(sorted(['18cam_6host', '6cam_2host', '6cam_10host'], 1),
                   ['6cam_2host', '6cam_10host', '18cam_6host']);
  assert.deepEqual(sorted(['2024-09-03T10:32:22Z', '2024-09-03T09:00:00Z'], 1),
                   ['2024-09-03T09:00:00Z', '2024-09-03T10:32:22Z']);
  // Equal values stay in their order, either way.
  const equal = ['1.0 ms', '1 ms', '1000 us'];
  assert.deepEqual(sorted(equal, 1), equal);
  assert.deepEqual(sorted(equal, -1), equal);
}

export function writesCsv() {
  const {csvLine} = tableValues();
  assert.equal(csvLine(['a', 'b,c', 'd "e"', ' f', 'g\nh', '']), 'a,"b,c","d ""e"""," f","g\nh",\r\n');
}

const shownTables = (page) => page.locator('.scroll > table:visible');

// The texts of a table as the reader sees them, its headings first.
const textsOf = (table) => table.evaluate((root) => {
  const text = (node) => node.nodeName === 'svg' ? '' : node.textContent;
  return Array.from(root.rows, ({cells}) => Array.from(
      cells, (cell) => Array.from(cell.childNodes, text).join('').trim()));
});

export async function everyTableHasControls(page) {
  const lacking = await page.evaluate(() => Array.from(document.querySelectorAll('.scroll > table')).filter(
      (table) => {
        const needed = table.tBodies[0].rows.length > 1 ? table.tHead.rows[0].cells.length : 0;
        const tools = table.closest('.scroll').nextElementSibling;
        return table.querySelectorAll('thead th > button.sort').length !== needed ||
            tools?.className !== 'table-tools' || tools.querySelector('button')?.textContent !== 'CSV';
      }).map((table) => table.caption.textContent));
  assert.deepEqual(lacking, []);
  assert.ok(await shownTables(page).count() > 0);
}

// Of the values of a column; durations in seconds.
function numbers(texts) {
  const units = {s: 1, ms: 1e-3, us: 1e-6, ns: 1e-9};
  return texts.map((text) => {
    const [, digits, unit] = /^([-\d.e+]+) ?(\w*)/.exec(text) ?? [];
    return digits === undefined ? NaN : Number(digits) * (units[unit] ?? 1);
  });
}

const isRising = (values) => values.every((value, i) => i === 0 || !(values[i - 1] > value));

// `use(heading)`: how the heading is used. Three uses: up, down, as it came.
async function sortsBy(page, name, column, use) {
  const table = page.getByRole('region', {name}).first().locator('table');
  const heading = table.locator('thead th').nth(column);
  const before = await textsOf(table);
  const values = (rows) => numbers(rows.slice(1).map((row) => row[column])).filter((value) => !Number.isNaN(value));
  assert.ok(new Set(values(before)).size > 1, `one value only: ${values(before)}`);
  await use(heading.locator('button'));
  assert.equal(await heading.getAttribute('aria-sort'), 'ascending');
  const up = await textsOf(table);
  assert.ok(isRising(values(up)), `rising: ${values(up)}`);
  await use(heading.locator('button'));
  assert.equal(await heading.getAttribute('aria-sort'), 'descending');
  const down = await textsOf(table);
  assert.ok(isRising(values(down).reverse()), `falling: ${values(down)}`);
  assert.notDeepEqual(up, down);
  assert.deepEqual([...up].sort(), [...before].sort());
  await use(heading.locator('button'));
  assert.equal(await heading.getAttribute('aria-sort'), null);
  assert.deepEqual(await textsOf(table), before);
}

export const sortsByClick = (page, name, column) => sortsBy(page, name, column, (heading) => heading.click());

export async function sortsByKeyboard(page, name, column) {
  for (const key of ['Enter', 'Space']) {
    await sortsBy(page, name, column, async (heading) => {
      await heading.focus();
      await page.keyboard.press(key);
    });
  }
}

// Another column's heading takes over.
export async function marksOneColumn(page, name) {
  const headings = page.getByRole('region', {name}).first().locator('thead th');
  await headings.nth(1).locator('button').click();
  await headings.nth(0).locator('button').click();
  const marks = await headings.evaluateAll((all) => all.map((one) => one.getAttribute('aria-sort')).filter(Boolean));
  assert.deepEqual(marks, ['ascending']);
  assert.equal(await headings.nth(0).getAttribute('aria-sort'), 'ascending');
}

function parsedCsv(text) {
  const rows = [[]];
  for (const [, quoted, bare, end] of text.matchAll(/(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r\n)/g)) {
    rows.at(-1).push(quoted === undefined ? bare : quoted.replaceAll('""', '"'));
    if (end !== ',') rows.push([]);
  }
  assert.deepEqual(rows.pop(), []);
  return rows;
}

// What the button gives is what the table shows, in its present order.
export async function savesCsv(page, name) {
  const region = page.getByRole('region', {name}).first();
  await region.locator('thead button').first().click();
  const tools = region.locator('xpath=following-sibling::*[1]');
  const [download] = await Promise.all([
    page.waitForEvent('download'), tools.getByRole('button', {name: `CSV of ${name}`}).click()]);
  assert.match(download.suggestedFilename(), /^simbench_[\w.-]+\.csv$/);
  const text = readFileSync(await download.path(), 'utf8');
  assert.deepEqual(parsedCsv(text), await textsOf(region.locator('table')));
}
