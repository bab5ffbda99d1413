// Tables that a reader sorts by their headings, takes away as CSV, and prints (print.js).
//
//   makeTablesSortable(document.body);   // again for tables that come later: the others stay
//
// A heading is a button: the first use sorts upwards, the second downwards, the third restores the
// order in which the table came.

const kDirections = [[1, 'ascending'], [-1, 'descending'], [0, '']];

// Without the pictures beside the text.
function cellText(cell) {
  const copy = cell.cloneNode(true);
  for (const picture of copy.querySelectorAll('svg')) picture.remove();
  return copy.textContent.trim();
}

const rowsOf = (table) => Array.from(table.tBodies[0].rows);
const headings = (table) => Array.from(table.tHead.rows[0].cells);

function sortRows(table, original, column, direction) {
  let rows = original;
  if (direction !== 0) {
    const isText = headings(table)[column].classList.contains('text');
    const keys = original.map(({cells}) => {
      const key = sortKey(cellText(cells[column]));
      return isText && key.rank === 0 ? {...key, rank: 1} : key;
    });
    rows = sortedPlaces(keys, direction).map((place) => original[place]);
  }
  table.tBodies[0].append(...rows);
}

function addSorting(table) {
  const original = rowsOf(table);
  headings(table).forEach((heading, column) => {
    const made = element('button', 'sort', heading.textContent);
    made.type = 'button';
    heading.replaceChildren(made);
    made.addEventListener('click', () => {
      const now = kDirections.findIndex(([, name]) => name === (heading.getAttribute('aria-sort') ?? ''));
      const [direction, name] = kDirections[(now + 1) % kDirections.length];
      for (const each of headings(table)) each.removeAttribute('aria-sort');
      if (name) heading.setAttribute('aria-sort', name);
      sortRows(table, original, column, direction);
    });
  });
}

// The table as it is shown.
function csvOf(table) {
  const lines = [headings(table), ...rowsOf(table).map(({cells}) => Array.from(cells))];
  return lines.map((cells) => csvLine(cells.map(cellText))).join('');
}

function addCsv(table) {
  const name = table.caption?.textContent.trim() ?? '';
  const tools = element('div', 'table-tools');
  tools.append(button('CSV', name ? `CSV of ${name}` : 'CSV of this table', () => saveFile(
      fileName([document.title, name || 'table'], 'csv'), new Blob([csvOf(table)], {type: 'text/csv'}))));
  table.closest('.scroll').after(tools);
}

function makeTablesSortable(root) {
  for (const table of root.querySelectorAll('.scroll > table:not([data-sortable])')) {
    if (!table.tHead || !table.tBodies.length) continue;
    table.dataset.sortable = '';
    if (rowsOf(table).length > 1) addSorting(table);
    addCsv(table);
    fitOnPaper(table);
  }
}
