// Finding the parts of the page, and reading what a chart draws.

export const figure = (page, id) => page.locator(`.archive:not([hidden]) [data-figure="${id}"]`);
export const chart = (page, id, panel = 0) => figure(page, id).locator('.chart').nth(panel);
export const xScale = (locator) => locator.evaluate(({uplot}) => [uplot.scales.x.min, uplot.scales.x.max]);

// All numbers that a figure draws: another figure has others.
export const dataOf = (page, id) => figure(page, id).evaluate((root) => JSON.stringify(
    Array.from(root.querySelectorAll('.chart'), ({uplot}) => uplot.data)));

// The pixels of a chart, as far as they differ from an empty canvas; read from a copy, since reading
// a canvas makes Chromium draw it in another way from then on.
export const pixelsOf = (locator) => locator.evaluate((host) => {
  const canvas = host.querySelector('canvas');
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext(
      '2d', {willReadFrequently: true});
  copy.drawImage(canvas, 0, 0);
  const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
  let painted = 0, sum = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] === 0) continue;
    ++painted;
    sum = (sum * 31 + data[i] + 3 * data[i + 1] + 7 * data[i + 2] + i) % 1000000007;
  }
  return {painted, sum, share: painted / (data.length / 4)};
});

export async function bringUp(page, id) {
  await figure(page, id).scrollIntoViewIfNeeded();
  await figure(page, id).locator('canvas').first().waitFor();
  return chart(page, id);
}
