// The picture of the report in README.md:
//   node tests/browser/take_picture.mjs REPORT.html PICTURE.png [FOLDER OF node_modules]
// Takes the first panel of the first figure.
import path from 'node:path';
import {pathToFileURL} from 'node:url';

import {closeBrowser, openPage} from './browser.mjs';
import {bringUp, figure} from './page_parts.mjs';

const [report, picture, packages = 'build/deps/tests/browser'] = process.argv.slice(2);
const {page} = await openPage(
    path.resolve(packages), pathToFileURL(path.resolve(report)).href,
    {width: 1000, height: 2400, theme: 'light'});
await bringUp(page, 'distributions');
const frame = await figure(page, 'distributions').boundingBox();
const legend = await figure(page, 'distributions').locator('.u-legend').first().boundingBox();
await page.screenshot({path: picture, clip: {...frame, height: legend.y + legend.height + 8 - frame.y}});
await closeBrowser();
