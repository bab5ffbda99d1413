// The picture of the report in README.md:
//   node tests/browser/take_picture.mjs REPORT.html PICTURE.png [FOLDER OF node_modules]
// Takes the first figure, over all pipelines.
import path from 'node:path';
import {pathToFileURL} from 'node:url';

import {closeBrowser, openPage} from './browser.mjs';

const [report, picture, packages = 'build/deps/tests/browser'] = process.argv.slice(2);
const {page} = await openPage(
    path.resolve(packages), pathToFileURL(path.resolve(report)).href,
    {width: 1000, height: 1600, theme: 'light'});
const frame = await page.locator('.overview').first().boundingBox();
await page.screenshot({path: picture, clip: frame});
await closeBrowser();
