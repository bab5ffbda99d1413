// Simulated photographs of a millisecond clock: seven-segment digits on a dark display.
//
// A segment is as bright as the share of the exposure in which it was lit, so a picture taken
// across a change of the display is ghosted as a real one is.

const kSegments = {
  a: 'M2 1h8l-1.5 2h-5z', b: 'M10.5 1.5v7.7l-2-1.2v-4.5z', c: 'M10.5 10.8v7.7l-2-2v-4.5z',
  d: 'M2 19h8l-1.5-2h-5z', e: 'M1.5 10.8v7.7l2-2v-4.5z', f: 'M1.5 1.5v7.7l2-1.2v-4.5z',
  g: 'M2.2 10l1.4-1h4.8l1.4 1-1.4 1h-4.8z', dot: 'M1 17h2v2h-2z', colon: 'M1 6h2v2h-2zM1 13h2v2h-2z',
};
const kLit = {
  '0': 'abcdef', '1': 'bc', '2': 'abdeg', '3': 'abcdg', '4': 'bcfg',
  '5': 'acdfg', '6': 'acdefg', '7': 'abc', '8': 'abcdefg', '9': 'abcdfg', '-': 'g',
};
const kSvg = 'http://www.w3.org/2000/svg';

function segmentsOf(character) {
  if (character === '.') return ['dot'];
  if (character === ':') return ['colon'];
  return [...kLit[character] ?? ''];
}

// Of every place of the display: segment -> brightness.
function brightness(readings) {
  const places = [];
  for (const {text, share} of readings) {
    [...text].forEach((character, place) => {
      places[place] ??= {narrow: '.:'.includes(character), lit: {}};
      for (const segment of segmentsOf(character)) {
        places[place].lit[segment] = (places[place].lit[segment] ?? 0) + share;
      }
    });
  }
  return places;
}

function svgElement(name, attributes) {
  const element = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

function displayOf(readings) {
  const places = brightness(readings);
  const width = places.reduce((sum, {narrow}) => sum + (narrow ? 5 : 13), 0);
  const svg = svgElement('svg', {viewBox: `-3 -3 ${width + 6} 26`, 'aria-hidden': 'true'});
  let x = 0;
  for (const {narrow, lit} of places) {
    for (const [segment, share] of Object.entries(lit)) {
      svg.append(svgElement('path', {
        d: kSegments[segment],
        transform: `translate(${x} 0)`,
        opacity: Math.min(1, share).toFixed(3),
      }));
    }
    x += narrow ? 5 : 13;
  }
  return svg;
}

// What can be seen, that is: from half a percent on.
function readingsText(readings) {
  const seen = readings.filter(({share}) => share >= 0.005);
  if (seen.length === 1) return seen[0].text;
  return seen.map(({text, share}) => `${text} (${Math.round(share * 100)} %)`).join(', ');
}

function element(name, className, text = '') {
  const made = document.createElement(name);
  if (className) made.className = className;
  made.textContent = text;
  return made;
}

function photographElement({label, readings}) {
  const picture = element('div', 'photograph');
  const display = element('div', 'display');
  display.append(displayOf(readings));
  picture.append(display, element('div', 'camera', label));
  picture.append(element('div', 'readings', readingsText(readings)));
  return picture;
}

function photographsElement(rows) {
  const all = element('div', 'photographs');
  for (const row of rows) {
    const group = element('div', 'photograph-row');
    const pictures = element('div', 'pictures');
    pictures.append(...row.photographs.map(photographElement));
    group.append(element('h5', '', row.label), pictures);
    all.append(group);
  }
  return all;
}
