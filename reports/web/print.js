// Tables on paper, where nothing scrolls: in letters so small that the table is no wider than the page.

const kPrintWidth = 680;  // CSS pixels: a page of A4 or Letter less its margins
// Letters, in CSS pixels. Down to the middle size cells are kept in one line.
const kLargestOnPaper = 10.7, kMiddleOnPaper = 7, kSmallestOnPaper = 5;
const kPictureOnPaper = 5;  // in letters, as the style has it
const kCellPadding = 6;
const kSafety = 0.98;  // for the rounding of letters of other sizes

// A table's width at letters of one pixel, if cells of its body are divided by `divided`: into words
// that stand in lines of their own, or not at all. Headings always are.
function widthOnPaper(rows, divided) {
  const columns = [];
  for (const {cells, parentElement} of rows) {
    Array.from(cells).forEach((cell, i) => {
      const text = cellText(cell), isHeading = parentElement.nodeName === 'THEAD';
      for (const part of isHeading ? text.split(/\s+/) : divided(text)) {
        const width = widthOf(part, 100, cell.nodeName === 'TH' ? 600 : 400) / 100;
        columns[i] = Math.max(columns[i] ?? 0, width, cell.querySelector('svg') ? kPictureOnPaper : 0);
      }
    });
  }
  return columns.reduce((sum, width) => sum + width, 0);
}

// If the smallest letters are too wide still, words are broken.
function fitOnPaper(table) {
  const rows = [table.tHead.rows[0], ...rowsOf(table)];
  const room = kSafety * kPrintWidth - kCellPadding * rows[0].cells.length;
  const whole = room / widthOnPaper(rows, (text) => [text]);
  const inWords = room / widthOnPaper(rows, (text) => text.split(/\s+/));
  const size = Math.min(kLargestOnPaper, Math.max(whole, Math.min(inWords, kMiddleOnPaper)));
  table.style.setProperty('--print-size', `${Math.max(size, kSmallestOnPaper).toFixed(2)}px`);
  table.classList.toggle('whole', size <= whole);
  table.classList.toggle('breaks', size < kSmallestOnPaper);
}
