// What is checked of every page: that all can be read and reached. Each of these throws when it is
// not so, and names the first few culprits.
import assert from 'node:assert/strict';

const kLeastContrast = 4.5;  // WCAG 2.1, success criterion 1.4.3
const kNamed = 4;

function none(culprits, what) {
  assert.equal(culprits.length, 0, `${what}: ${culprits.slice(0, kNamed).join(' | ')}`);
}

// The answer, a figure that is drawn, then a table.
export async function beginsWithTheAnswer(page) {
  const shown = page.locator('.archive:not([hidden])');
  const top = async (selector) => (await shown.locator(selector).first().boundingBox()).y;
  const answer = await top('.answer'), figure = await top('.figure, .overview');
  assert.ok(answer < figure && figure < await top('.scroll table'));
  assert.ok((await shown.locator('.answer p').innerText()).length > 20);
  assert.ok(await shown.locator('.answer dt').count() >= 2);
}

export async function textIsLegible(page) {
  const faint = await page.evaluate((least) => {
    const channels = (text) => {
      const [r, g, b, a = 1] = text.match(/[\d.]+/g).map(Number);
      return {rgb: [r, g, b], a};
    };
    const over = (front, back) => front.rgb.map((c, i) => front.a * c + (1 - front.a) * back[i]);
    // The background behind an element, from the page's up.
    const behind = (element) => {
      const chain = [];
      for (let at = element; at; at = at.parentElement) chain.unshift(at);
      return chain.reduce((back, at) => over(channels(getComputedStyle(at).backgroundColor), back),
                          [255, 255, 255]);
    };
    const luminance = (rgb) => {
      const [r, g, b] = rgb.map((c) => c / 255).map(
          (c) => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const faint = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || !element.checkVisibility()) continue;
      if (element.closest('script, style, noscript, svg')) continue;
      const back = behind(element);
      const front = over(channels(getComputedStyle(element).color), back);
      const [dark, light] = [luminance(front), luminance(back)].sort((a, b) => a - b);
      const contrast = (light + 0.05) / (dark + 0.05);
      if (contrast < least) {
        faint.push(`${contrast.toFixed(2)} '${walker.currentNode.data.trim().slice(0, 30)}'`);
      }
    }
    return faint;
  }, kLeastContrast);
  none(faint, 'too faint');
}

// Beyond the window without a way to scroll there, or hidden by a box that is too small.
export async function nothingIsCutOff(page) {
  const cut = await page.evaluate(() => {
    const scrolls = (element) => ['auto', 'scroll'].includes(getComputedStyle(element).overflowX);
    const canScroll = (element) => {
      for (let at = element; at; at = at.parentElement) if (scrolls(at)) return true;
      return false;
    };
    const name = (element) => `${element.tagName}.${element.className} '${
        element.textContent.trim().slice(0, 30)}'`;
    const cut = [];
    for (const element of document.querySelectorAll('body *')) {
      if (!element.checkVisibility() || element.closest('caption, svg, canvas, script')) continue;
      const {right, left, width} = element.getBoundingClientRect();
      if (width > 0 && (right > innerWidth + 1 || left < -1) && !canScroll(element)) {
        cut.push(name(element));
      }
      const style = getComputedStyle(element);
      if (style.overflowX === 'hidden' && element.scrollWidth > element.clientWidth + 1) {
        cut.push(name(element));
      }
    }
    return cut;
  });
  none(cut, 'cut off');
}

const kReachable = '#sections button, #controls button, #controls select, #controls input, ' +
    '#bar button, #bar select, #bar input, aside input, aside select, aside button, ' +
    '.figure-tools button, .figure-tools select, .table-tools button, .sort, .chart, summary, .scroll[tabindex]';

// Tab goes through everything that can be used, and what has the focus has an outline.
export async function keyboardReachesAll(page) {
  await page.evaluate((selector) => {
    scrollTo(0, 0);
    document.activeElement.blur();
    for (const element of document.querySelectorAll(selector)) {
      if (element.checkVisibility() && !element.disabled) element.dataset.unreached = '';
    }
  }, kReachable);
  const unseen = [];
  for (let i = 0; i < 1500; ++i) {
    await page.keyboard.press('Tab');
    const focused = await page.evaluate(() => {
      const element = document.activeElement;
      if (element === document.body) return null;
      delete element.dataset.unreached;
      const style = getComputedStyle(element);
      return {name: `${element.tagName}.${element.className}`, left: document.querySelectorAll('[data-unreached]').length,
              outlined: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 1};
    });
    if (!focused) break;
    if (!focused.outlined) unseen.push(focused.name);
    if (focused.left === 0) break;
  }
  none(unseen, 'focus cannot be seen');
  none(await page.locator('[data-unreached]').evaluateAll((all) => all.map(
      (element) => `${element.tagName}.${element.className} '${element.innerText.slice(0, 30)}'`)),
       'not reached');
}
