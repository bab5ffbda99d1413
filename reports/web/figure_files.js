// Files of a figure: SVG, and PNG, which is the SVG on a canvas.

const kPngScale = 2;  // pixels for each of the page
const kLargestCanvas = 8192;

function svgFile(svg) {
  return new Blob([new XMLSerializer().serializeToString(svg)], {type: 'image/svg+xml'});
}

async function pngFile(svg) {
  const [width, height] = ['width', 'height'].map((name) => Number(svg.getAttribute(name)));
  const scale = Math.min(kPngScale, kLargestCanvas / Math.max(width, height));
  const address = URL.createObjectURL(svgFile(svg));
  const picture = new Image(width, height);
  picture.src = address;
  await picture.decode();
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [width * scale, height * scale];
  canvas.getContext('2d').drawImage(picture, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(address);
  return new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
}

// Buttons that save the figure which `svg()` makes, now or later, under the name that `name(ending)`
// gives it.
function fileButtons(title, svg, name) {
  return [
    button('SVG', `SVG of ${title}`, async () => saveFile(name('svg'), svgFile(await svg()))),
    button('PNG', `PNG of ${title}`, async () => saveFile(name('png'), await pngFile(await svg()))),
  ];
}

// Adds them to the tools of a FigureView.
function addFigureFiles(view) {
  const name = (ending) => fileName(
      [document.title, view.id, view.shown.pipeline, view.shown.seed && `seed ${view.shown.seed}`], ending);
  view.root.querySelector('.figure-tools').append(
      ...fileButtons(view.alternatives[0].title, () => figureSvg(view), name));
}
