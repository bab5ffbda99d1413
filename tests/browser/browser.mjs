// Chromium, driven by playwright-core, and what it reports of a page: errors, and requests for
// anything but the page itself.
import {createRequire} from 'node:module';
import path from 'node:path';

// Nothing of these is about the page: no sandbox where root runs it, and a browser that does not
// call home.
const kArguments = [
  '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
];
let browser = null;

function playwright(packages) {
  try {
    return createRequire(path.join(packages, 'package.json'))('playwright-core');
  } catch {
    throw new Error(`playwright-core is not in ${packages}: run tools/setup check`);
  }
}

// `packages`: the folder in which node_modules is.
async function launched(packages) {
  const {chromium} = playwright(packages);
  browser ??= await chromium.launch(
      {executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: kArguments});
  return browser;
}

function isOwn(url, own) {
  return url.split('#')[0] === own.split('#')[0] || url.startsWith('data:') || url.startsWith('blob:');
}

export async function openPage(packages, url, {width, height, theme, javaScriptEnabled = true}) {
  const context = await (await launched(packages)).newContext(
      {viewport: {width, height}, colorScheme: theme, javaScriptEnabled});
  const page = await context.newPage();
  const requests = [], errors = [];
  page.on('request', (request) => {
    if (!isOwn(request.url(), url)) requests.push(request.url());
  });
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) errors.push(message.text());
  });
  page.on('pageerror', (error) => errors.push(error.stack));
  await page.goto(url);
  return {context, page, requests, errors};
}

export async function closeBrowser() {
  await browser?.close();
}
